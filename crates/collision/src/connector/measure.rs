//! The rows of a connector at one moment, by its kind.

use super::coordinate::{in_turns, turning_row};
use super::kind::{ConnectorKind, Turn};
use super::path::RailHint;
use super::row::{ConnectorSample, Ends};
use super::{Anchor, Connector, SlotFrame, rail};
use crate::motion::Moving;
use glam::DVec2;

/// What a row of a connector depends on beside the motions of its two bodies.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// Time [s].
    pub time: f64,
    /// Whole turns that the angles of body a, of body b and of the carrier lack.
    pub turns: [f64; 3],
    /// Motion of the carrier.
    pub carrier: &'a Moving,
    /// Where rails and their stops search the nearest point: near the hint, or on its piece if the hint stays there. A rail that
    /// crosses or nears itself needs the hint, and the search is quicker with it.
    pub hint: Option<&'a RailHint>,
}

impl Default for Surroundings<'_> {
    fn default() -> Self {
        Self { time: 0.0, turns: [0.0; 3], carrier: &Moving::BACKGROUND, hint: None }
    }
}

impl Connector {
    /// Measures a row (pin and weld: 0 along x, 1 along y; last in a weld or slider: of the angle; else 0) for given bodies a and b; the background is
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
        self.measure_in(row, [a, b], &Surroundings { hint, ..Surroundings::default() })
    }

    /// Measures a row as [`Connector::measure`] does, in its surroundings.
    #[must_use]
    #[inline]
    pub fn measure_in(
        &self,
        row: usize,
        [a, b]: [&Moving; 2],
        surroundings: &Surroundings<'_>,
    ) -> ConnectorSample {
        let Surroundings { time, turns, carrier, hint } = *surroundings;
        let own_turns = [turns[0], turns[1]];
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
            ConnectorKind::Weld { a: on_a, b: on_b, turn } => match row {
                0 | 1 => {
                    let normal = if row == 0 { DVec2::X } else { DVec2::Y };
                    let points = [a.pose.point_to_world(on_a.point), b.pose.point_to_world(on_b.point)];
                    Ends::of(points, [a, b]).along(normal.dot(points[0] - points[1]), normal, 0.0)
                }
                _ => turn.row([a, b], own_turns),
            },
            ConnectorKind::Slider { a: on_a, b: on_b, axis, frame, turn } => match row {
                0 => slot_row([on_a, on_b], [a, b], axis.perp(), *frame),
                _ => turn.row([a, b], own_turns),
            },
            ConnectorKind::Gear { ratio, turn, .. } => gear_row(*ratio, turn, [a, b, carrier], turns),
            ConnectorKind::Rack { radius, axis, at, .. } => {
                rack_row((*radius, *axis, *at), [a, b], own_turns)
            }
            ConnectorKind::Pulley { a: on_a, b: on_b, wheels, ratio, length } => {
                pulley_row([on_a, on_b], *wheels, (*ratio, *length), [a, b])
            }
            ConnectorKind::Limit { coordinate, at, upper } => {
                let sign = if *upper { -1.0 } else { 1.0 };
                coordinate.row(sign, *at, [a, b], own_turns)
            }
            ConnectorKind::Drive { coordinate, law, at } => {
                let (told, scale) = (law.at(time), coordinate.scale());
                let mut sample = coordinate.row(1.0, at + told.value, [a, b], own_turns);
                sample.kinematics.rate -= scale * told.rate;
                sample.kinematics.gamma -= scale * told.acceleration;
                sample
            }
            ConnectorKind::Pull { coordinate, speed, .. } => {
                let mut sample = coordinate.row(1.0, 0.0, [a, b], own_turns);
                sample.kinematics.rate -= coordinate.scale() * speed;
                sample
            }
        }
    }

    /// Violation of the connector [m], not negative: the size of a bilateral connector's gap (of several rows, of all of them
    /// together); for the others, the distance beyond their limit; 0 for what pulls.
    ///
    /// With a hint, a rail's point may be on any continuation of the path; without one, as at a start, only where the nearest
    /// place is an end.
    #[must_use]
    pub fn error(&self, a: &Moving, b: &Moving, hint: Option<&RailHint>) -> f64 {
        self.error_in([a, b], &Surroundings { hint, ..Surroundings::default() })
    }

    /// Violation of the connector [m] as [`Connector::error`] tells it, in its surroundings.
    #[must_use]
    pub fn error_in(&self, [a, b]: [&Moving; 2], surroundings: &Surroundings<'_>) -> f64 {
        if self.is_pull() {
            return 0.0;
        }
        if let (ConnectorKind::Rail { a: on_a, path }, Some(_)) = (&self.kind, surroundings.hint) {
            return path.distance(a.pose.point_to_world(on_a.point));
        }
        let off = |row| {
            let gap = self.measure_in(row, [a, b], surroundings).gap;
            if self.is_bilateral() { gap.abs() } else { (-gap).max(0.0) }
        };
        (0..self.row_count()).map(off).fold(0.0, libm::hypot)
    }
}

impl Turn {
    /// The row that keeps the angle of body b less that of body a.
    fn row(&self, movings: [&Moving; 2], turns: [f64; 2]) -> ConnectorSample {
        turning_row([-self.lever, self.lever], movings, turns, self.lever * self.angle)
    }
}

/// The row of a gear, whose gap is lever (angle of a - ratio angle of b + (ratio - 1) angle of the carrier - constant).
fn gear_row(ratio: f64, turn: &Turn, [a, b, carrier]: [&Moving; 3], turns: [f64; 3]) -> ConnectorSample {
    let Turn { angle, lever } = *turn;
    let (own_turns, share) = ([turns[0], turns[1]], (ratio - 1.0) * lever);
    let mut sample = turning_row([lever, -ratio * lever], [a, b], own_turns, lever * angle);
    sample.gap += share * (carrier.angle + in_turns(turns[2]));
    sample.kinematics.rate += share * carrier.angular_velocity;
    sample
}

/// The row of a rack: a force on the bar at its centre of mass, and a torque on the wheel.
fn rack_row(
    (radius, axis, at): (f64, DVec2, f64),
    [bar, wheel]: [&Moving; 2],
    turns: [f64; 2],
) -> ConnectorSample {
    let mut sample = turning_row([0.0, -radius], [bar, wheel], turns, at);
    sample.gap += axis.dot(bar.pose.position);
    sample.kinematics.rate += axis.dot(bar.velocity);
    [sample.kinematics.jacobian[0], sample.kinematics.jacobian[1]] = axis.to_array();
    sample.normal = axis;
    sample
}

/// The row of a pulley: a rope to either wheel, and the sum of what is left of both.
fn pulley_row(
    anchors: [&Anchor; 2],
    wheels: [DVec2; 2],
    (ratio, length): (f64, f64),
    movings: [&Moving; 2],
) -> ConnectorSample {
    let side = |side: usize, length: f64| {
        let points = [movings[side].pose.point_to_world(anchors[side].point), wheels[side]];
        Ends::of(points, [movings[side], &Moving::BACKGROUND]).between(length, -1.0)
    };
    let (mut sample, other) = (side(0, length), side(1, 0.0));
    sample.gap += ratio * other.gap;
    sample.point_b = other.point_a;
    let (own, theirs) = (&mut sample.kinematics, &other.kinematics);
    own.rate += ratio * theirs.rate;
    own.gamma += ratio * theirs.gamma;
    (0..3).for_each(|k| own.jacobian[3 + k] = ratio * theirs.jacobian[k]);
    sample
}

/// The row of a slot. On the body that carries the direction, the force acts at the foot of the other body's point; a
/// direction of the world is carried by an end on the background, if there is one.
#[inline]
pub(super) fn slot_row(
    anchors: [&Anchor; 2],
    [a, b]: [&Moving; 2],
    normal: DVec2,
    frame: SlotFrame,
) -> ConnectorSample {
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
