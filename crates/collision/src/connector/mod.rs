//! Connectors, which tie two bodies, or a body and the world, together.
//!
//! Every connector is one or two rows, each a gap whose target is 0 (see `row`). Pin, slot, rod and rail are bilateral;
//! a rope and a rail stop only keep their gap from closing. Body a is the primary one, body b the normal one; the force
//! on a acts along the row's normal.
//!
//! `rail` has the rows of rails, on paths made of lines and arcs (`edge_path`, of pieces as in `edge_piece`) or on a
//! `spline` of `cubic` pieces (with `spline_nearest` and `spline_length`); `box_tree` finds the piece nearest to a
//! point. `align` moves bodies to satisfy a connector before a start, `rope` finds the time at which a rope goes taut.

mod align;
mod box_tree;
mod cubic;
mod edge_path;
mod edge_piece;
mod error;
mod path;
mod rail;
mod rope;
mod row;
mod spline;
mod spline_length;
mod spline_nearest;

pub use align::Alignment;
pub use error::{ConnectorError, RailError};
use path::SAME_PLACE;
pub use path::{RailHint, RailKnot, RailPath, RailPlace, SplineJoint};
pub use rope::{Rope, RopeSearch, rope_contact};
pub use row::ConnectorSample;

use crate::body::BodyId;
use crate::motion::Moving;
use glam::DVec2;
use row::Ends;
use std::sync::Arc;

/// Largest deviation of the length of a unit vector from 1 [-]: rounding.
const UNIT_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Index of a connector in its world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ConnectorId(pub u32);

impl ConnectorId {
    /// The index as a `usize`, for lists of connectors.
    #[must_use]
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// An end of a connector.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Anchor {
    /// Id of the body; [`BodyId::WORLD`] for the background.
    pub body: BodyId,
    /// Point [m] in body coordinates about the centre of mass; in world coordinates for the background.
    pub point: DVec2,
}

/// Frame in which the direction of a slot is fixed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum SlotFrame {
    /// The direction turns with body a.
    A,
    /// The direction turns with body b.
    B,
    /// The direction is fixed in the world.
    #[default]
    World,
}

/// Kind of a connector, with its points and numbers.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum ConnectorKind {
    /// Keeps two points together.
    Pin {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
    },
    /// Keeps two points together along one direction.
    Slot {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
        /// Direction along which the points stay together, a unit vector in `frame`.
        normal: DVec2,
        /// Frame of the direction.
        frame: SlotFrame,
    },
    /// Keeps two points exactly a length apart.
    Rod {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
        /// Length [m].
        length: f64,
    },
    /// Keeps two points at most a length apart.
    Rope {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
        /// Length [m].
        length: f64,
    },
    /// Keeps a point on a path that is fixed in the world. An open path goes on straight beyond its ends, unless a stop ends
    /// it. At a corner of the path the point loses the velocity across the piece that it goes on along, whatever the
    /// elasticity of the connector, and stays there if that piece leads back.
    Rail {
        /// Point of body a.
        a: Anchor,
        /// Path in world coordinates.
        path: Arc<RailPath>,
    },
    /// Keeps a point on one side of a place of a rail, at which the rail ends.
    RailStop {
        /// Point of body a that is on the rail.
        a: Anchor,
        /// Path of the rail.
        path: Arc<RailPath>,
        /// Arc length [m] from the path's first point at which the rail ends.
        at: f64,
        /// True if the rail ends above `at`, so that the point stays at or below it; false for the other way round.
        upper: bool,
    },
}

/// A connector of two bodies, or of a body and the world.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Connector {
    /// Kind of the connector, with its points and numbers.
    pub kind: ConnectorKind,
    /// Coefficient of restitution [-], 0 to 1: the fraction of the closing speed that remains after an impact in the
    /// connector.
    pub elasticity: f64,
}

impl Connector {
    /// Builds a connector with checked numbers; the normal of a slot is made a unit vector.
    ///
    /// # Errors
    /// Ends on the same body, or a number out of its range.
    pub fn new(mut kind: ConnectorKind, elasticity: f64) -> Result<Self, ConnectorError> {
        if let ConnectorKind::Slot { normal, .. } = &mut kind {
            // By its larger component first, so that no square overflows or vanishes.
            let scaled = *normal / normal.abs().max_element();
            if !scaled.is_finite() || scaled == DVec2::ZERO {
                return Err(ConnectorError::BadNormal(normal.x, normal.y));
            }
            *normal = scaled.normalize();
        }
        let connector = Self { kind, elasticity };
        connector.check().map(|()| connector)
    }

    /// Checks a connector that was not made by [`new`](Self::new), or was changed since.
    ///
    /// # Errors
    /// The errors of [`new`](Self::new); also a normal of a slot that is not a unit vector.
    pub fn check(&self) -> Result<(), ConnectorError> {
        if !(0.0..=1.0).contains(&self.elasticity) {
            return Err(ConnectorError::BadElasticity(self.elasticity));
        }
        self.check_numbers()?;
        let [a, b] = self.bodies();
        if a == b { Err(ConnectorError::SameBody) } else { Ok(()) }
    }

    fn check_numbers(&self) -> Result<(), ConnectorError> {
        let (a, b) = self.anchors();
        if !(a.point.is_finite() && b.is_none_or(|b| b.point.is_finite())) {
            return Err(ConnectorError::NotFinite);
        }
        match &self.kind {
            ConnectorKind::Rod { length, .. } | ConnectorKind::Rope { length, .. } => {
                let fine = *length > 0.0 && length.is_finite();
                if fine { Ok(()) } else { Err(ConnectorError::BadLength(*length)) }
            }
            ConnectorKind::Slot { normal, .. } => {
                let fine = (normal.length() - 1.0).abs() <= UNIT_ROUNDING;
                if fine { Ok(()) } else { Err(ConnectorError::BadNormal(normal.x, normal.y)) }
            }
            ConnectorKind::RailStop { at, path, .. } => {
                // The length is a sum that is rounded, and so is the arc length of a stop at the path's end.
                let length = path.length();
                let fine = (0.0..=(1.0 + SAME_PLACE) * length).contains(at);
                if fine { Ok(()) } else { Err(ConnectorError::BadStop { at: *at, length }) }
            }
            _ => Ok(()),
        }
    }

    /// The points that the connector ties together: `a`, and `b` if there is one (not for rails and their stops).
    #[must_use]
    #[inline]
    pub fn anchors(&self) -> (&Anchor, Option<&Anchor>) {
        match &self.kind {
            ConnectorKind::Pin { a, b }
            | ConnectorKind::Slot { a, b, .. }
            | ConnectorKind::Rod { a, b, .. }
            | ConnectorKind::Rope { a, b, .. } => (a, Some(b)),
            ConnectorKind::Rail { a, .. } | ConnectorKind::RailStop { a, .. } => (a, None),
        }
    }

    /// Ids of the primary body a and of the normal body b; the latter is the background for rails and their stops.
    #[must_use]
    #[inline]
    pub fn bodies(&self) -> [BodyId; 2] {
        let (a, b) = self.anchors();
        [a.body, b.map_or(BodyId::WORLD, |b| b.body)]
    }

    /// Number of rows: 2 for a pin, else 1.
    #[must_use]
    #[inline]
    pub fn row_count(&self) -> usize {
        if matches!(self.kind, ConnectorKind::Pin { .. }) { 2 } else { 1 }
    }

    /// True if the gaps of the connector may neither close nor open: for all kinds but ropes and rail stops.
    #[must_use]
    #[inline]
    pub fn is_bilateral(&self) -> bool {
        !matches!(self.kind, ConnectorKind::Rope { .. } | ConnectorKind::RailStop { .. })
    }

    /// True for a rail stop, of whichever rail.
    #[must_use]
    #[inline]
    pub fn is_stop(&self) -> bool {
        matches!(self.kind, ConnectorKind::RailStop { .. })
    }

    /// True for a stop of the given rail: of the same point, and on the same path.
    #[must_use]
    #[inline]
    pub fn is_stop_of(&self, rail: &Self) -> bool {
        match (&self.kind, &rail.kind) {
            (ConnectorKind::RailStop { a: end, path: ends, .. }, ConnectorKind::Rail { a, path }) => {
                end == a && (Arc::ptr_eq(ends, path) || ends == path)
            }
            _ => false,
        }
    }

    /// The path of a rail or of a rail stop; `None` for other connectors.
    #[must_use]
    #[inline]
    pub fn path(&self) -> Option<&Arc<RailPath>> {
        match &self.kind {
            ConnectorKind::Rail { path, .. } | ConnectorKind::RailStop { path, .. } => Some(path),
            _ => None,
        }
    }

    /// Measures a row (pin: 0 along x, 1 along y; else 0) for given bodies a and b; the background is
    /// [`Moving::BACKGROUND`].
    #[must_use]
    #[inline]
    pub fn measure(&self, row: usize, a: &Moving, b: &Moving) -> ConnectorSample {
        self.measure_near(row, a, b, None)
    }

    /// Measures both rows of a pin at once, which share most of their terms; `None` for other connectors.
    #[must_use]
    #[inline(always)]
    pub fn measure_pin(&self, a: &Moving, b: &Moving) -> Option<[ConnectorSample; 2]> {
        let ConnectorKind::Pin { a: on_a, b: on_b } = &self.kind else { return None };
        let points = [a.pose.point_to_world(on_a.point), b.pose.point_to_world(on_b.point)];
        let ends = Ends::of(points, [a, b]);
        let off = points[0] - points[1];
        Some([ends.along(off.x, DVec2::X, 0.0), ends.along(off.y, DVec2::Y, 0.0)])
    }

    /// Measures a row as [`Connector::measure`] does, where rails and their stops search the nearest point near `hint`,
    /// or on its piece if the hint stays there.
    ///
    /// A rail that crosses or nears itself needs the hint, and the search is quicker with it.
    #[must_use]
    #[inline]
    pub fn measure_near(
        &self,
        row: usize,
        a: &Moving,
        b: &Moving,
        hint: Option<&RailHint>,
    ) -> ConnectorSample {
        match &self.kind {
            ConnectorKind::Pin { a: on_a, b: on_b } => {
                let normal = if row == 0 { DVec2::X } else { DVec2::Y };
                let points = [a.pose.point_to_world(on_a.point), b.pose.point_to_world(on_b.point)];
                Ends::of(points, [a, b]).along(normal.dot(points[0] - points[1]), normal, 0.0)
            }
            ConnectorKind::Slot { a: on_a, b: on_b, normal, frame } => {
                slot_row([on_a, on_b], [a, b], *normal, *frame)
            }
            ConnectorKind::Rod { a: on_a, b: on_b, length } => {
                let points = [a.pose.point_to_world(on_a.point), b.pose.point_to_world(on_b.point)];
                Ends::of(points, [a, b]).between(*length, 1.0)
            }
            ConnectorKind::Rope { a: on_a, b: on_b, length } => {
                let points = [a.pose.point_to_world(on_a.point), b.pose.point_to_world(on_b.point)];
                Ends::of(points, [a, b]).between(*length, -1.0)
            }
            ConnectorKind::Rail { a: on_a, path } => rail::rail_row(on_a.point, a, path, hint),
            ConnectorKind::RailStop { a: on_a, path, at, upper } => {
                let sign = if *upper { -1.0 } else { 1.0 };
                rail::stop_row(on_a.point, a, path, hint, (*at, sign))
            }
        }
    }

    /// True if the normals of the rows never turn.
    #[must_use]
    pub(crate) fn has_fixed_normal(&self) -> bool {
        match &self.kind {
            ConnectorKind::Pin { .. } => true,
            ConnectorKind::Slot { a, b, frame, .. } => match frame {
                SlotFrame::A => a.body.is_world(),
                SlotFrame::B => b.body.is_world(),
                SlotFrame::World => true,
            },
            _ => false,
        }
    }

    /// Signed radii of curvature [m] of the two sides at a measured row: 0 for a point, `None` for a straight line.
    pub(crate) fn radii(&self, sample: &ConnectorSample) -> [Option<f64>; 2] {
        const POINT: Option<f64> = Some(0.0);
        match &self.kind {
            ConnectorKind::Slot { frame: SlotFrame::A, .. } => [None, POINT],
            ConnectorKind::Slot { frame: SlotFrame::B, .. } => [POINT, None],
            ConnectorKind::Pin { .. } | ConnectorKind::Slot { .. } | ConnectorKind::RailStop { .. } => {
                [POINT, POINT]
            }
            ConnectorKind::Rod { length, .. } => [POINT, Some(*length)],
            ConnectorKind::Rope { length, .. } => [POINT, Some(-length)],
            ConnectorKind::Rail { path, .. } => {
                // The left of the path is its outside: a path that turns to the left is concave.
                let curvature = path.foot(sample.point_b, None).curvature;
                [POINT, (curvature != 0.0).then(|| -1.0 / curvature)]
            }
        }
    }

    /// Violation of the connector [m], not negative: the size of a bilateral connector's gap (of a pin, the distance of
    /// its points); for the others, the distance beyond their limit.
    ///
    /// `hint` is the place at which a rail or a stop last found its point, as in [`Connector::measure_near`]. With a
    /// hint, a rail's point may be on any continuation of the path; without one, as at a start, only where the nearest
    /// place is an end.
    #[must_use]
    pub fn error(&self, a: &Moving, b: &Moving, hint: Option<&RailHint>) -> f64 {
        if let (ConnectorKind::Rail { a: on_a, path }, Some(_)) = (&self.kind, hint) {
            return path.distance(a.pose.point_to_world(on_a.point));
        }
        let off = |row| {
            let gap = self.measure_near(row, a, b, hint).gap;
            if self.is_bilateral() { gap.abs() } else { (-gap).max(0.0) }
        };
        (0..self.row_count()).map(off).fold(0.0, libm::hypot)
    }
}

/// The row of a slot. On the body that carries the direction, the force acts at the foot of the other body's point; a
/// direction of the world is carried by an end on the background, if there is one.
#[inline]
fn slot_row(anchors: [&Anchor; 2], [a, b]: [&Moving; 2], normal: DVec2, frame: SlotFrame) -> ConnectorSample {
    let [on_a, on_b] = [a.pose.point_to_world(anchors[0].point), b.pose.point_to_world(anchors[1].point)];
    let carrier = match frame {
        SlotFrame::A => a,
        SlotFrame::B => b,
        SlotFrame::World => &Moving::BACKGROUND,
    };
    let normal = carrier.pose.vector_to_world(normal);
    let gap = normal.dot(on_a - on_b);
    let carries = |side: usize, own: SlotFrame| {
        frame == own || (frame == SlotFrame::World && anchors[side].body.is_world())
    };
    let points = if carries(0, SlotFrame::A) {
        [on_b + normal * gap, on_b]
    } else if carries(1, SlotFrame::B) {
        [on_a, on_a - normal * gap]
    } else {
        [on_a, on_b]
    };
    Ends::of(points, [a, b]).along(gap, normal, carrier.angular_velocity)
}
