//! A body's room to move: a fat box in the broad phase, and when the body could leave it.
//!
//! While a body stays in its box, only bodies whose boxes overlap can meet it. The size of a box follows the number of
//! neighbours found: many make it shrink, few make it grow, between bounds that depend on the body's size. The box of a
//! body in flight has most of its room ahead.

use crate::rigid::bodies::path::Path;
use crate::rigid::bodies::trajectory::Trajectory;
use crate::rigid::search::lane::Lane;
use crate::rigid::search::predictions::LONGEST_SPAN;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{Flight, Motion, Polynomial, first_closing_time};
use halfgap_geometry::Aabb;

/// Number of neighbours above which a box shrinks; it grows below half of that. Fewer neighbours cost more moves of boxes in a gas, more cost more
/// predictions: from 8 to 14 there is little between them.
const MANY: usize = 10;
/// Factor by which a margin grows or shrinks at a time.
const FACTOR: f64 = 1.5;
/// Distance by which a box is set ahead of a body in flight, as a fraction of its margin: a gas has a seventh fewer
/// moves of boxes for it.
const AHEAD: f64 = 0.6;
/// Least margin as a multiple of the body's reach.
const SMALLEST_MARGIN: f64 = 1.0 / 64.0;
/// Largest margin as a multiple of the body's reach, beyond all coordinates: with a smaller one a body that flies off,
/// or is small and far from all others, as a moon, would leave its boxes without end.
const LARGEST_MARGIN: f64 = 1e80;

/// Room of a body around the circle of its reach.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Room {
    /// Distance [m] that the centre of mass may move from where the box was set, along either axis.
    margin: f64,
    reach: f64,
    /// Gap [m] below which bodies are neighbours.
    skin: f64,
}

impl Room {
    pub(crate) fn new(reach: f64, skin: f64) -> Self {
        Self { margin: reach, reach, skin }
    }

    /// Box around the body and its room at a time.
    pub(crate) fn fat_box(&self, lane: &Lane, trajectory: &Trajectory, time: Time) -> Aabb {
        if lane.is_at_rest {
            return trajectory.body().shape.bounds_at(&trajectory.moving_at(time).pose).grown(self.skin);
        }
        let center = match lane.flight_from(time) {
            Some(path) => path.position + self.ahead(path.velocity),
            None => {
                let state = trajectory.state_at(time);
                // Of a body that does not fly only a bound on the speed is known: it has as much room on all sides.
                let ahead = trajectory.flight().map_or(DVec2::ZERO, |_| self.ahead(state.velocity));
                state.position + ahead
            }
        };
        Aabb::around_disc(center, self.reach + self.margin + self.skin)
    }

    /// Offset [m] by which the box of a body in flight is set ahead.
    fn ahead(&self, velocity: DVec2) -> DVec2 {
        velocity.try_normalize().map_or(DVec2::ZERO, |direction| direction * (AHEAD * self.margin))
    }

    /// Fits the margin to the number of neighbours found.
    pub(crate) fn adapt(&mut self, neighbours: usize) {
        if neighbours > MANY {
            self.margin = (self.margin / FACTOR).max(self.reach * SMALLEST_MARGIN);
        } else if 2 * neighbours < MANY {
            self.margin = (self.margin * FACTOR).min(self.reach * LARGEST_MARGIN);
        }
    }

    /// Time before which the body surely stays in the given box; `None` if it stays for as long as its motion is known.
    pub(crate) fn stays_until(
        &self,
        lane: &Lane,
        trajectory: &Trajectory,
        fat_box: &Aabb,
        time: Time,
    ) -> Option<Time> {
        if lane.is_at_rest {
            return None;
        }
        let core = fat_box.grown(-(self.reach + self.skin));
        if core.min.cmpgt(core.max).any() {
            // The tight box of a body that was at rest: it has no room to move in, not even to turn.
            return Some(time);
        }
        if let Some(path) = lane.flight_from(time) {
            return leaving_time(&path, &core).map(|wait| time.plus(wait));
        }
        let offset = trajectory.offset(time);
        let slack = || {
            let position = trajectory.path().state_at(offset).position;
            (position - core.min).min(core.max - position).min_element().max(0.0)
        };
        match trajectory.path() {
            Path::Flight(flight) => {
                let by_axes = damped_leaving_time(flight, offset, &core)?;
                Some(time.plus(by_axes.max(flight.stays_within(slack(), offset)?)))
            }
            Path::Moved(moved) => Some(time.plus(moved.stays_within(slack(), offset, LONGEST_SPAN)?)),
            // The motion after the segment is predicted anew.
            Path::Dense(dense) if core.contains(&dense.center_box()) => None,
            Path::Dense(dense) => {
                let speed = dense.top_speed();
                // A body that does not move stays, even where rounding puts it just outside.
                (speed > 0.0).then(|| time.plus(slack() / speed))
            }
        }
    }
}

/// Time [s] from its start at which a point on a parabola first leaves a box; `None` if it never does.
fn leaving_time(path: &Polynomial, core: &Aabb) -> Option<f64> {
    let (x, v, a) = (path.position, path.velocity, path.acceleration);
    if a == DVec2::ZERO {
        // Straight on: along each axis towards one of two sides, or neither where the velocity along it is zero.
        let wait =
            |low: f64, high: f64, v: f64| if v == 0.0 { f64::INFINITY } else { (low / v).max(high / v) };
        let [along_x, along_y] =
            [wait(core.min.x - x.x, core.max.x - x.x, v.x), wait(core.min.y - x.y, core.max.y - x.y, v.y)];
        let wait = along_x.min(along_y).max(0.0);
        return wait.is_finite().then_some(wait);
    }
    leaving_time_within(path, [a, a], core)
}

/// Time [s] before which a damped flight from an offset [s] surely stays in a box: its acceleration keeps its direction
/// and dies away, so that along each axis the flight is between a straight line and a parabola.
fn damped_leaving_time(flight: &Flight, offset: f64, core: &Aabb) -> Option<f64> {
    let state = flight.state_at(offset);
    let acceleration = flight.acceleration_at(offset);
    let path = Polynomial { position: state.position, velocity: state.velocity, acceleration };
    leaving_time_within(&path, [acceleration.min(DVec2::ZERO), acceleration.max(DVec2::ZERO)], core)
}

/// Earliest time [s] at which a point may leave a box, if its accelerations [m/s^2] lie between a least and a greatest
/// along each axis.
fn leaving_time_within(path: &Polynomial, [least, greatest]: [DVec2; 2], core: &Aabb) -> Option<f64> {
    let (x, v) = (path.position, path.velocity);
    [
        first_closing_time(core.max.x - x.x, -v.x, -greatest.x),
        first_closing_time(x.x - core.min.x, v.x, least.x),
        first_closing_time(core.max.y - x.y, -v.y, -greatest.y),
        first_closing_time(x.y - core.min.y, v.y, least.y),
    ]
    .into_iter()
    .flatten()
    .min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {

    use super::*;
    use halfgap_collision::BodyState;

    const CORE: Aabb = Aabb { min: DVec2::new(-1.0, -2.0), max: DVec2::new(2.0, 5.0) };

    fn leaves(velocity: DVec2, acceleration: DVec2) -> Option<f64> {
        leaving_time(&Polynomial { position: DVec2::ZERO, velocity, acceleration }, &CORE)
    }

    #[test]
    fn a_body_that_flies_off_leaves_few_boxes_however_fast_it_is() {
        for distance in [1e6, 1e20, 1e50] {
            let mut room = Room::new(0.5, 1e-9);
            let (mut way, mut boxes) = (0.0, 0);
            while way < distance && boxes < 1000 {
                way += room.margin;
                room.adapt(0);
                boxes += 1;
            }
            assert!(boxes < 300, "{boxes} boxes on {distance} m");
        }
    }

    #[test]
    fn a_straight_path_leaves_by_the_side_it_comes_to_first() {
        assert_eq!(leaves(DVec2::new(3.0, -4.0), DVec2::ZERO), Some(0.5));
        assert_eq!(leaves(DVec2::new(-4.0, 4.0), DVec2::ZERO), Some(0.25));
        assert_eq!(leaves(DVec2::new(0.0, 2.0), DVec2::ZERO), Some(2.5));
        assert_eq!(leaves(DVec2::ZERO, DVec2::ZERO), None);
    }

    #[test]
    fn a_damped_flight_stays_as_long_as_it_is_said_to() {
        for (velocity, acceleration) in
            [(DVec2::new(3.0, 4.0), DVec2::new(0.0, -9.81)), (DVec2::new(-0.5, 0.0), DVec2::new(2.0, -1.0))]
        {
            for rate in [1e-9, 0.05, 1.0, 30.0] {
                let start = BodyState { velocity, ..BodyState::default() };
                let flight = Flight::new(start, acceleration, rate, 0.0);
                let leaving = damped_leaving_time(&flight, 0.0, &CORE).expect("it falls out");
                let is_inside = |part: f64| {
                    CORE.contains(&Aabb::around_disc(flight.state_at(part * leaving).position, 0.0))
                };
                assert!(leaving > 0.0 && (0..100).all(|step| is_inside(f64::from(step) / 100.0)));
                // Where damping hardly bends the path, the time is that of the parabola.
                let undamped = leaves(velocity, acceleration).expect("it falls out");
                assert!(rate > 1e-6 || (leaving / undamped - 1.0).abs() < 1e-6, "{leaving} {undamped}");
            }
        }
    }

    #[test]
    fn a_path_that_is_all_but_straight_leaves_at_the_same_time() {
        for velocity in [DVec2::new(3.0, -4.0), DVec2::new(-0.5, 2.0), DVec2::new(0.0, -1.0)] {
            let straight = leaves(velocity, DVec2::ZERO).expect("it moves");
            let bent = leaves(velocity, DVec2::new(1e-20, -1e-20)).expect("it moves");
            assert!((straight - bent).abs() < 1e-15 * 4.0, "{straight} {bent}");
        }
    }
}
