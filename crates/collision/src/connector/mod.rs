//! Connectors: what ties two bodies, or a body and the world, together.
//!
//! Every connector is one or two rows, each a gap whose target is 0 (see `row`). Pin, slot, rod and rail are bilateral;
//! a rope and a rail stop only keep their gap from closing. Body a is the primary one, body b the normal one; the force
//! on a acts along the row's normal.
//!
//! `rail` has the rows of rails, on paths made of lines and arcs (`edge_path`, of pieces as in `edge_piece`)
//! or on a `spline` of `cubic` pieces (with `spline_nearest` and `spline_length`); `box_tree` finds which
//! piece is near. `align` is what a scene does before its start, `rope` tells when a rope goes taut.

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

/// By how much the length of a unit vector may be off: rounding.
const UNIT_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Index of a connector in its world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ConnectorId(pub u32);

impl ConnectorId {
    /// The index as a number to look up with.
    #[must_use]
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// An end of a connector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// The body; [`BodyId::WORLD`] for the background.
    pub body: BodyId,
    /// The point [m] in body coordinates about the centre of mass; in world coordinates for the background.
    pub point: DVec2,
}

/// What carries the direction of a slot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SlotFrame {
    /// It turns with body a.
    A,
    /// It turns with body b.
    B,
    /// It is fixed in the world.
    #[default]
    World,
}

/// What a connector does.
#[derive(Clone, Debug, PartialEq)]
pub enum ConnectorKind {
    /// Keeps two points together.
    Pin {
        /// One point.
        a: Anchor,
        /// The other point.
        b: Anchor,
    },
    /// Keeps two points together along one direction.
    Slot {
        /// One point.
        a: Anchor,
        /// The other point.
        b: Anchor,
        /// The direction, a unit vector in its frame.
        normal: DVec2,
        /// The frame of the direction.
        frame: SlotFrame,
    },
    /// Keeps two points exactly a length apart.
    Rod {
        /// One point.
        a: Anchor,
        /// The other point.
        b: Anchor,
        /// The length [m].
        length: f64,
    },
    /// Keeps two points at most a length apart.
    Rope {
        /// One point.
        a: Anchor,
        /// The other point.
        b: Anchor,
        /// The length [m].
        length: f64,
    },
    /// Keeps a point on a path that is fixed in the world.
    Rail {
        /// The point.
        a: Anchor,
        /// The path.
        path: Arc<RailPath>,
    },
    /// Ends a rail.
    RailStop {
        /// The point that is on the rail.
        a: Anchor,
        /// The path of the rail.
        path: Arc<RailPath>,
        /// Where the rail ends: arc length from its first point [m].
        at: f64,
        /// The rail ends above that arc length, else below it.
        upper: bool,
    },
}

/// A connector.
#[derive(Clone, Debug, PartialEq)]
pub struct Connector {
    /// What it does.
    pub kind: ConnectorKind,
    /// Share of the closing speed with which an impact in it ends, 0 to 1.
    pub elasticity: f64,
}

impl Connector {
    /// A connector with checked numbers; the normal of a slot is made a unit vector.
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

    /// Checks a connector that was not made by [`new`](Self::new), or changed since.
    ///
    /// # Errors
    /// As of [`new`](Self::new); here the normal of a slot must be a unit vector.
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
                // The length is a sum, and so is where a stop is at its end.
                let length = path.length();
                let fine = (0.0..=(1.0 + SAME_PLACE) * length).contains(at);
                if fine { Ok(()) } else { Err(ConnectorError::BadStop { at: *at, length }) }
            }
            _ => Ok(()),
        }
    }

    /// The points it ties together: `a`, and `b` where there is one.
    #[must_use]
    pub fn anchors(&self) -> (&Anchor, Option<&Anchor>) {
        match &self.kind {
            ConnectorKind::Pin { a, b }
            | ConnectorKind::Slot { a, b, .. }
            | ConnectorKind::Rod { a, b, .. }
            | ConnectorKind::Rope { a, b, .. } => (a, Some(b)),
            ConnectorKind::Rail { a, .. } | ConnectorKind::RailStop { a, .. } => (a, None),
        }
    }

    /// The primary and the normal body; the latter is the background for rails.
    #[must_use]
    pub fn bodies(&self) -> [BodyId; 2] {
        let (a, b) = self.anchors();
        [a.body, b.map_or(BodyId::WORLD, |b| b.body)]
    }

    /// How many rows it has.
    #[must_use]
    #[inline]
    pub fn row_count(&self) -> usize {
        if matches!(self.kind, ConnectorKind::Pin { .. }) { 2 } else { 1 }
    }

    /// True if its gaps may neither close nor open.
    #[must_use]
    #[inline]
    pub fn is_bilateral(&self) -> bool {
        !matches!(self.kind, ConnectorKind::Rope { .. } | ConnectorKind::RailStop { .. })
    }

    /// True for the end of some rail.
    #[must_use]
    pub fn is_stop(&self) -> bool {
        matches!(self.kind, ConnectorKind::RailStop { .. })
    }

    /// True for the end of a given rail: of the same point, and on the same path.
    #[must_use]
    pub fn is_stop_of(&self, rail: &Self) -> bool {
        match (&self.kind, &rail.kind) {
            (ConnectorKind::RailStop { a: end, path: ends, .. }, ConnectorKind::Rail { a, path }) => {
                end == a && (Arc::ptr_eq(ends, path) || ends == path)
            }
            _ => false,
        }
    }

    /// The rail's path, if it has one.
    #[must_use]
    pub fn path(&self) -> Option<&Arc<RailPath>> {
        match &self.kind {
            ConnectorKind::Rail { path, .. } | ConnectorKind::RailStop { path, .. } => Some(path),
            _ => None,
        }
    }

    /// Measures a row (pin: 0 along x, 1 along y) for given bodies a and b; the background is [`Moving::BACKGROUND`].
    #[must_use]
    #[inline]
    pub fn measure(&self, row: usize, a: &Moving, b: &Moving) -> ConnectorSample {
        self.measure_near(row, a, b, None)
    }

    /// Both rows of a pin at once, which have most of their terms in common; `None` for other connectors.
    #[must_use]
    #[inline(always)]
    pub fn measure_pin(&self, a: &Moving, b: &Moving) -> Option<[ConnectorSample; 2]> {
        let ConnectorKind::Pin { a: on_a, b: on_b } = &self.kind else { return None };
        let points = [a.pose.point_to_world(on_a.point), b.pose.point_to_world(on_b.point)];
        let ends = Ends::of(points, [a, b]);
        let off = points[0] - points[1];
        Some([ends.along(off.x, DVec2::X, 0.0), ends.along(off.y, DVec2::Y, 0.0)])
    }

    /// As [`Connector::measure`]; rails look for the nearest point near `hint`, or stay on its piece.
    ///
    /// A rail that crosses or nears itself needs the hint, and with it the search is quicker.
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

    /// True if its normal never turns.
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
                // The left of the path is its outside: a turn to the left is hollow.
                let curvature = path.foot(sample.point_b, None).curvature;
                [POINT, (curvature != 0.0).then(|| -1.0 / curvature)]
            }
        }
    }

    /// How far off it is [m]: the gap of a bilateral connector, of a pin the distance of its points; by how
    /// much the others are beyond their limit.
    ///
    /// `hint` is where a rail or a stop has seen its point last, as in [`Connector::measure_near`]. A rail's
    /// point that has been seen may be on any continuation of the path; otherwise, as at a start, only where
    /// the nearest place is an end.
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

/// The row of a slot: on the body that carries the direction, the foot of the other body's point. The world carries its own.
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
