//! Connectors, which tie two bodies, or a body and the world, together.
//!
//! Every connector is one to three rows, each a gap whose target is 0 (see `row`). Ropes, pulleys, limits and rail stops only
//! keep their gap from closing; a motor or brake bounds its force; all others are bilateral. Body a is the primary one, body b
//! the normal one; the force on a acts along the row's normal.
//!
//! `kind` lists the kinds, `check` refuses numbers out of range, and `measure` has the rows of each.
//! `coordinate` has the free coordinate of a joint, which limits, drives and motors act on, and rows of angles alone.
//! `rail` has the rows of rails, on paths made of lines and arcs (`edge_path`, of pieces as in `edge_piece`) or on a
//! `spline` of `cubic` pieces (with `spline_nearest` and `spline_length`); `box_tree` finds the piece nearest to a
//! point. `align` moves bodies to satisfy a connector before a start, `rope` finds the time at which a rope goes taut.

mod align;
mod box_tree;
mod check;
mod coordinate;
mod cubic;
mod edge_path;
mod edge_piece;
mod error;
mod kind;
mod measure;
mod path;
mod rail;
mod rope;
mod row;
mod spline;
mod spline_length;
mod spline_nearest;

pub use align::Alignment;
pub use coordinate::Coordinate;
pub use error::{ConnectorError, RailError};
pub use kind::{ConnectorKind, Turn};
pub use measure::Surroundings;
pub use path::{RailHint, RailKnot, RailPath, RailPlace, SplineJoint};
pub use rope::{Rope, RopeSearch, rope_contact};
pub use row::ConnectorSample;

use crate::body::BodyId;
use crate::motion::BodyState;
use crate::motion_law::MotionMoment;
use glam::DVec2;
use halfgap_geometry::Pose;
use std::sync::Arc;

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
    /// Builds a connector with checked numbers; directions are made unit vectors.
    ///
    /// # Errors
    /// Ends on the same body, or a number out of its range.
    pub fn new(mut kind: ConnectorKind, elasticity: f64) -> Result<Self, ConnectorError> {
        if let Some(direction) = kind.direction_mut() {
            // By its larger component first, so that no square overflows or vanishes.
            let scaled = *direction / direction.abs().max_element();
            if !scaled.is_finite() || scaled == DVec2::ZERO {
                let (x, y) = (direction.x, direction.y);
                return Err(kind.bad_direction(x, y));
            }
            *direction = scaled.normalize();
        }
        let connector = Self { kind, elasticity };
        connector.check().map(|()| connector)
    }

    /// The points that the connector ties together: of body a and of body b, so far as it has such points. Rails and their stops have
    /// one, gears and racks none, and what acts on an angle has none.
    #[must_use]
    #[inline]
    pub fn anchors(&self) -> [Option<&Anchor>; 2] {
        match &self.kind {
            ConnectorKind::Pin { a, b }
            | ConnectorKind::Slot { a, b, .. }
            | ConnectorKind::Rod { a, b, .. }
            | ConnectorKind::Rope { a, b, .. }
            | ConnectorKind::Weld { a, b, .. }
            | ConnectorKind::Slider { a, b, .. }
            | ConnectorKind::Pulley { a, b, .. } => [Some(a), Some(b)],
            ConnectorKind::Rail { a, .. } | ConnectorKind::RailStop { a, .. } => [Some(a), None],
            ConnectorKind::Gear { .. } | ConnectorKind::Rack { .. } => [None, None],
            ConnectorKind::Limit { coordinate, .. }
            | ConnectorKind::Drive { coordinate, .. }
            | ConnectorKind::Pull { coordinate, .. } => match coordinate {
                Coordinate::Angle { .. } => [None, None],
                Coordinate::Along { a, b, .. } => [Some(a), Some(b)],
            },
        }
    }

    /// Ids of the primary body a and of the normal body b; the latter is the background for rails and their stops.
    #[must_use]
    #[inline]
    pub fn bodies(&self) -> [BodyId; 2] {
        match &self.kind {
            ConnectorKind::Gear { a, b, .. } => [*a, *b],
            ConnectorKind::Rack { wheel, bar, .. } => [*bar, *wheel],
            ConnectorKind::Limit { coordinate, .. }
            | ConnectorKind::Drive { coordinate, .. }
            | ConnectorKind::Pull { coordinate, .. } => coordinate.bodies(),
            _ => self.anchors().map(|end| end.map_or(BodyId::WORLD, |anchor| anchor.body)),
        }
    }

    /// The third body of the connector's row, if it has one, with the coefficient [m] of its angular velocity in the row's rate: the carrier
    /// of a gear.
    #[must_use]
    #[inline]
    pub fn third(&self) -> Option<(BodyId, f64)> {
        match &self.kind {
            ConnectorKind::Gear { carrier, ratio, turn, .. } if !carrier.is_world() => {
                Some((*carrier, (ratio - 1.0) * turn.lever))
            }
            _ => None,
        }
    }

    /// Ids of all bodies that its rows depend on: both ends, and the third body, if there is one.
    pub fn all_bodies(&self) -> impl Iterator<Item = BodyId> + use<> {
        self.bodies().into_iter().chain(self.third().map(|(body, _)| body))
    }

    /// Number of rows.
    #[must_use]
    #[inline]
    pub fn row_count(&self) -> usize {
        match self.kind {
            ConnectorKind::Weld { .. } => 3,
            ConnectorKind::Pin { .. } | ConnectorKind::Slider { .. } => 2,
            _ => 1,
        }
    }

    /// True if the gaps of the connector may neither close nor open: for all kinds but ropes, pulleys, limits, rail stops and what pulls.
    #[must_use]
    #[inline]
    pub fn is_bilateral(&self) -> bool {
        !(self.is_unilateral() || self.is_pull())
    }

    /// True if the connector only keeps its gap from closing.
    #[must_use]
    #[inline]
    pub fn is_unilateral(&self) -> bool {
        matches!(
            self.kind,
            ConnectorKind::Rope { .. }
                | ConnectorKind::RailStop { .. }
                | ConnectorKind::Pulley { .. }
                | ConnectorKind::Limit { .. }
        )
    }

    /// True for a pin.
    #[must_use]
    #[inline]
    pub fn is_pin(&self) -> bool {
        matches!(self.kind, ConnectorKind::Pin { .. })
    }

    /// True if the force of the connector is bounded.
    #[must_use]
    #[inline]
    pub fn is_pull(&self) -> bool {
        matches!(self.kind, ConnectorKind::Pull { .. })
    }

    /// True if what the connector keeps depends on the time.
    #[must_use]
    #[inline]
    pub fn is_driven(&self) -> bool {
        matches!(self.kind, ConnectorKind::Drive { .. })
    }

    /// What is prescribed of a connector's row at a time [s]: the parts of its gap [m], rate [m/s] and acceleration [m/s^2] that it has
    /// without any motion of its bodies. A drive counts from its law's zero; nothing of a gap is prescribed to what pulls.
    #[must_use]
    #[inline]
    pub fn prescribed(&self, time: f64) -> MotionMoment {
        match &self.kind {
            ConnectorKind::Drive { coordinate, law, .. } => {
                let (scale, MotionMoment { value, rate, acceleration }) = (coordinate.scale(), law.at(time));
                MotionMoment {
                    value: -scale * value,
                    rate: -scale * rate,
                    acceleration: -scale * acceleration,
                }
            }
            ConnectorKind::Pull { coordinate, speed, .. } => {
                MotionMoment { rate: -coordinate.scale() * speed, ..MotionMoment::default() }
            }
            _ => MotionMoment::default(),
        }
    }

    /// The part [m/s] of the rate of a connector's row that is prescribed at a time [s]: the rate without any motion of its bodies.
    #[must_use]
    #[inline]
    pub fn prescribed_rate(&self, time: f64) -> f64 {
        self.prescribed(time).rate
    }

    /// Largest size of the force [N] along the row: infinite but for what pulls.
    #[must_use]
    #[inline]
    pub fn most_force(&self) -> f64 {
        match &self.kind {
            ConnectorKind::Pull { coordinate, most, .. } => most / coordinate.scale(),
            _ => f64::INFINITY,
        }
    }

    /// The first time [s] later than `after` at which what the connector keeps is not smooth.
    #[must_use]
    #[inline]
    pub fn next_kink(&self, after: f64) -> Option<f64> {
        match &self.kind {
            ConnectorKind::Drive { law, .. } => law.next_kink(after),
            _ => None,
        }
    }

    /// True if rows of the connector count whole turns of its bodies.
    #[must_use]
    #[inline]
    pub fn counts_turns(&self) -> bool {
        match &self.kind {
            ConnectorKind::Weld { .. }
            | ConnectorKind::Slider { .. }
            | ConnectorKind::Gear { .. }
            | ConnectorKind::Rack { .. } => true,
            ConnectorKind::Limit { coordinate, .. }
            | ConnectorKind::Drive { coordinate, .. }
            | ConnectorKind::Pull { coordinate, .. } => matches!(coordinate, Coordinate::Angle { .. }),
            _ => false,
        }
    }

    /// True for what is met along a motion that others lead: a rail stop, of whichever rail, a pulley, or a limit.
    #[must_use]
    #[inline]
    pub fn is_stop(&self) -> bool {
        self.is_unilateral() && !matches!(self.kind, ConnectorKind::Rope { .. })
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

    /// The free coordinate of a pin, slot or slider, on which limits, drives and motors act; `None` for other connectors. An angle has a
    /// lever of 1 m.
    #[must_use]
    pub fn coordinate(&self) -> Option<Coordinate> {
        match &self.kind {
            ConnectorKind::Pin { a, b } => Some(Coordinate::angle(a.body, b.body)),
            ConnectorKind::Slot { a, b, normal, frame } => {
                Some(Coordinate::Along { a: *a, b: *b, axis: -normal.perp(), frame: *frame })
            }
            ConnectorKind::Slider { a, b, axis, frame, .. } => {
                Some(Coordinate::Along { a: *a, b: *b, axis: *axis, frame: *frame })
            }
            _ => None,
        }
    }

    /// Lets the connector keep the angles and places that bodies have, and a drive set out from there at a time [s]; `lever` [m]
    /// makes angles lengths. Other connectors stay as they are.
    pub fn begin_from(&mut self, [a, b, carrier]: [&BodyState; 3], lever: f64, time: f64) {
        match &mut self.kind {
            ConnectorKind::Weld { turn, .. } | ConnectorKind::Slider { turn, .. } => {
                *turn = Turn { angle: b.angle - a.angle, lever };
            }
            ConnectorKind::Gear { ratio, turn, .. } => {
                let angle = a.angle - *ratio * b.angle + (*ratio - 1.0) * carrier.angle;
                *turn = Turn { angle, lever };
            }
            ConnectorKind::Rack { radius, axis, at, .. } => *at = axis.dot(a.position) - *radius * b.angle,
            ConnectorKind::Drive { coordinate, law, at } => {
                *at = coordinate.value([a, b]) - law.at(time).value;
            }
            _ => (),
        }
        let (ConnectorKind::Limit { coordinate, .. }
        | ConnectorKind::Drive { coordinate, .. }
        | ConnectorKind::Pull { coordinate, .. }) = &mut self.kind
        else {
            return;
        };
        if let Coordinate::Angle { lever: own, .. } = coordinate {
            *own = lever;
        }
    }

    /// The points of the world [m] over which a pulley goes; `None` for other connectors.
    #[must_use]
    #[inline]
    pub fn wheels(&self) -> Option<[DVec2; 2]> {
        match &self.kind {
            ConnectorKind::Pulley { wheels, .. } => Some(*wheels),
            _ => None,
        }
    }

    /// The vectors [m] from the wheels of a pulley to the points of its bodies, where these are; `None` for other connectors.
    #[must_use]
    pub fn sides(&self, [a, b]: [&Pose; 2]) -> Option<[DVec2; 2]> {
        match &self.kind {
            ConnectorKind::Pulley { a: on_a, b: on_b, wheels, .. } => {
                Some([a.point_to_world(on_a.point) - wheels[0], b.point_to_world(on_b.point) - wheels[1]])
            }
            _ => None,
        }
    }

    /// The point of a rail or of a rail stop, and its path; `None` for other connectors.
    #[must_use]
    #[inline]
    pub fn on_rail(&self) -> Option<(&Anchor, &Arc<RailPath>)> {
        match &self.kind {
            ConnectorKind::Rail { a, path } | ConnectorKind::RailStop { a, path, .. } => Some((a, path)),
            _ => None,
        }
    }

    /// The two points that a pin or weld keeps together, by its first two rows; `None` for other connectors.
    #[must_use]
    #[inline]
    pub fn held_together(&self) -> Option<(&Anchor, &Anchor)> {
        match &self.kind {
            ConnectorKind::Pin { a, b } | ConnectorKind::Weld { a, b, .. } => Some((a, b)),
            _ => None,
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
            ConnectorKind::Weld { .. } | ConnectorKind::Gear { .. } | ConnectorKind::Rack { .. } => true,
            _ => false,
        }
    }

    /// Signed radii of curvature [m] of the two sides at a measured row: 0 for a point, `None` for a straight line.
    pub(crate) fn radii(&self, sample: &ConnectorSample) -> [Option<f64>; 2] {
        const POINT: Option<f64> = Some(0.0);
        match &self.kind {
            ConnectorKind::Slot { frame: SlotFrame::A, .. } => [None, POINT],
            ConnectorKind::Slot { frame: SlotFrame::B, .. } => [POINT, None],
            ConnectorKind::Pin { .. }
            | ConnectorKind::Slot { .. }
            | ConnectorKind::RailStop { .. }
            | ConnectorKind::Weld { .. }
            | ConnectorKind::Pulley { .. } => [POINT, POINT],
            // What turns or slides as a whole has no curvature.
            ConnectorKind::Slider { .. }
            | ConnectorKind::Gear { .. }
            | ConnectorKind::Rack { .. }
            | ConnectorKind::Limit { .. }
            | ConnectorKind::Drive { .. }
            | ConnectorKind::Pull { .. } => [None, None],
            ConnectorKind::Rod { length, .. } => [POINT, Some(*length)],
            ConnectorKind::Rope { length, .. } => [POINT, Some(-length)],
            ConnectorKind::Rail { path, .. } => {
                // The left of the path is its outside: a path that turns to the left is concave.
                let curvature = path.foot(sample.point_b, None).curvature;
                [POINT, (curvature != 0.0).then(|| -1.0 / curvature)]
            }
        }
    }
}
