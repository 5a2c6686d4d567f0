//! Contacts that surely stay on their features along a segment. Bounds on the motion prove it for most of them, and
//! then `watch` need not sample how far they are from running off.
//!
//! Let f be the place of a contact: that of the foot along a line, or the direction of a normal as a body sees it. From
//! the middle of a segment of length h it changes by no more than |f'| h/2 + max |f''| h^2/8, and with c the centre of
//! the round feature, r its offset from the line's body, which turns at w, and d the offset between two round features,
//!
//! * along a line |f''| <= |r''| + 2 |w| |r'| + (|w'| + w^2) |r|, of r as it turns with the body;
//! * of a direction of d |f''| <= |d''|/|d| + (|d'|/|d|)^2, and |w'| more as a body sees it.

use crate::rigid::bodies::path::bounds_along;
use crate::rigid::contacts::rows::{RowSource, moving_of};
use crate::rigid::group::dynamics::Dynamics;
use glam::DVec2;
use halfgap_collision::{Arms, BodyId, Motion, MotionBounds, Moving};
use halfgap_geometry::{Feature, GapSample, LineFeature};

/// One side of a contact, in the middle of a segment.
struct Side<'a> {
    feature: &'a Feature,
    moving: &'a Moving,
    /// Arm [m] of the feature's centre, or of the foot on a line.
    arm: DVec2,
    bounds: MotionBounds,
}

impl Side<'_> {
    /// Bounds on the velocity [m/s] and acceleration [m/s^2] of the end of the arm that turning adds.
    fn turning(&self) -> [f64; 2] {
        let (arm, speed) = (self.arm.length(), self.bounds.angular_speed);
        [speed * arm, (self.bounds.angular_acceleration + speed * speed) * arm]
    }
}

/// Bounds on the rate [m/s] and the second derivative [m/s^2] of an offset.
struct OffsetBounds {
    rate: f64,
    second: f64,
}

impl OffsetBounds {
    /// Bounds for the offset between the ends of two arms; where only the primary one turns with its body, for that
    /// between its end and the centre of mass of the other body.
    fn between(primary: &Side<'_>, other: &Side<'_>, other_turns: bool) -> Self {
        let [mut rate, mut second] = primary.turning();
        if other_turns {
            let [more_rate, more_second] = other.turning();
            (rate, second) = (rate + more_rate, second + more_second);
        }
        Self {
            rate: rate + primary.bounds.velocity.largest_difference(&other.bounds.velocity),
            second: second + primary.bounds.acceleration.largest_difference(&other.bounds.acceleration),
        }
    }
}

/// Bound on the change of a quantity from the middle of a segment to its ends, by its rate there and a bound on its
/// second derivative.
pub(crate) fn way(rate: f64, second: f64, half: f64) -> f64 {
    (rate.abs() + 0.5 * second * half) * half
}

/// Finds bounds on the motion of the group's bodies along the segment.
pub(crate) fn find_bounds(dynamics: &mut Dynamics<'_>) {
    dynamics.stage.set_bounds(dynamics.group.paths().iter().map(bounds_along));
}

/// True if an active contact surely stays on its features along the segment. The bodies must be placed in its middle,
/// and their bounds known.
pub(crate) fn stays(dynamics: &Dynamics<'_>, row: usize) -> bool {
    let active = &dynamics.group.rows()[row];
    let RowSource::Contact(features) = active.source else { return false };
    let mechanism = &dynamics.physics.mechanism;
    let movings = active.bodies.map(|body| moving_of(dynamics.stage.movings(), body));
    let sample = mechanism.sample(active.bodies, features, movings);
    let arms = Arms::of(&sample, movings[0], movings[1]);
    let side = |index: usize, arm: DVec2| Side {
        feature: mechanism.feature(active.bodies[index], features[index]),
        moving: movings[index],
        arm,
        bounds: match dynamics.group.sides()[row][index] {
            Some(place) => dynamics.stage.bounds()[place as usize],
            None => bounds_of_other(dynamics, active.bodies[index]),
        },
    };
    let (primary, other) = (side(0, arms.primary), side(1, arms.normal));
    let half = 0.5 * dynamics.group.span();
    match other.feature {
        Feature::Line(line) => stays_on_line(&sample, line, &primary, &other, half),
        Feature::Round(_) => stays_between_ends(&sample, &primary, &other, half),
    }
}

/// Bounds along the segment on the motion of a body that cannot move, but may be moved.
fn bounds_of_other(dynamics: &Dynamics<'_>, body: BodyId) -> MotionBounds {
    let trajectory = dynamics.physics.mechanism.trajectories.get(body.index());
    let moved = trajectory.and_then(|trajectory| trajectory.moved().map(|moved| (trajectory, moved)));
    moved.map_or(MotionBounds::default(), |(trajectory, moved)| {
        let from = trajectory.offset(dynamics.start);
        moved.bounds(from, from + dynamics.group.span())
    })
}

/// True if the foot of the primary feature's centre surely stays on a line, and the line's direction in the feature's
/// range.
fn stays_on_line(
    sample: &GapSample,
    line: &LineFeature,
    primary: &Side<'_>,
    other: &Side<'_>,
    half: f64,
) -> bool {
    let Feature::Round(round) = primary.feature else { return false };
    let toward = primary.moving.pose.vector_to_body(-sample.normal);
    let turning = primary.moving.angular_velocity - other.moving.angular_velocity;
    let turning_second = primary.bounds.angular_acceleration + other.bounds.angular_acceleration;
    if round.range.margin(toward) <= way(turning, turning_second, half) {
        return false;
    }
    let offset = sample.center_primary - other.moving.pose.position;
    let along = sample.normal.perp();
    let rate = along.dot(primary.moving.velocity_at(primary.arm) - other.moving.velocity_at(offset));
    let bounds = OffsetBounds::between(primary, other, false);
    let (speed, farthest) = (other.bounds.angular_speed, offset.length() + bounds.rate * half);
    let seen = bounds.second
        + 2.0 * speed * bounds.rate
        + (other.bounds.angular_acceleration + speed * speed) * farthest;
    let place = along.dot(offset);
    (place - line.start).min(line.end - place) > way(rate, seen, half)
}

/// True if the direction from one round feature to another surely stays in the ranges of both.
fn stays_between_ends(sample: &GapSample, primary: &Side<'_>, other: &Side<'_>, half: f64) -> bool {
    let (Feature::Round(round), Feature::Round(other_round)) = (primary.feature, other.feature) else {
        return false;
    };
    let offset = sample.center_primary - sample.center_normal;
    let bounds = OffsetBounds::between(primary, other, true);
    let nearest = offset.length() - bounds.rate * half;
    if nearest <= 0.0 {
        return false;
    }
    let velocity = primary.moving.velocity_at(primary.arm) - other.moving.velocity_at(other.arm);
    let rate = offset.perp_dot(velocity) / offset.length_squared();
    let second = bounds.second / nearest + (bounds.rate / nearest).powi(2);
    let stays = |side: &Side<'_>, margin: f64| {
        margin > way(rate - side.moving.angular_velocity, second + side.bounds.angular_acceleration, half)
    };
    let toward = |side: &Side<'_>, direction: DVec2| side.moving.pose.vector_to_body(direction);
    stays(primary, round.range.margin(toward(primary, sample.normal * -round.sign())))
        && stays(other, other_round.range.margin(toward(other, sample.normal * other_round.sign())))
}

#[cfg(test)]
mod tests {
    use super::{find_bounds, stays};
    use crate::rigid::event::rooms::Rooms;
    use crate::rigid::group::groups::with_group;
    use crate::rigid::group::state::Group;
    use crate::rigid::test_scene::{block_on_its_corner, resting_discs, turn_on_its_corner};
    use crate::rigid::watch::early_ends::way_to_end;
    use halfgap_collision::BodyId;

    /// Runs the contact of body 1 along a segment from a changed start. Returns whether it is said to stay on its
    /// features, and whether it does.
    fn said_and_done(mut rooms: Rooms, set_out: impl FnOnce(&mut Group)) -> [bool; 2] {
        let mut group = rooms.groups.take(BodyId(1)).expect("it is in a group");
        set_out(&mut group);
        group.set_next_step(Some(0.125));
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, tools| {
            dynamics.set_out();
            dynamics.extend(tools).expect("it slides");
            dynamics.make_dense(tools.stepper);
            let span = dynamics.group.span();
            find_bounds(dynamics);
            dynamics.place_at(0.5 * span);
            let said = stays(dynamics, 0);
            let done = (0..=64).all(|part| {
                dynamics.place_at(span * f64::from(part) / 64.0);
                way_to_end(dynamics, 0) >= 0.0
            });
            [said, done]
        })
    }

    #[test]
    fn a_disc_that_slides_along_a_floor_stays_up_to_its_end() {
        // The floor ends 1 m from the disc, which neither speeds up nor turns.
        for speed in [-150.0, 0.0, 1.0, 7.5, 7.99, 8.01, 9.0, 50.0] {
            let expected = speed * 0.125 < 1.0;
            assert_eq!(
                said_and_done(resting_discs(&[9.0]), |disc| disc.state_mut()[3] = speed),
                [expected; 2],
                "{speed} m/s"
            );
        }
    }

    #[test]
    fn a_block_that_rolls_over_a_round_corner_stays_up_to_its_ends() {
        let spins = (0..=60).map(|index| 0.25 * f64::from(index));
        let answers = spins.map(|spin| {
            let [said, done] = said_and_done(block_on_its_corner(), |block| {
                turn_on_its_corner(block, block.state()[2], spin)
            });
            assert!(done || !said, "{spin} rad/s");
            [said, done]
        });
        let counts = answers
            .fold([0, 0], |[said, done], answer| [said + i32::from(answer[0]), done + i32::from(answer[1])]);
        // Bounds say so of most of the contacts that stay.
        assert!(counts[1] < 60 && 4 * counts[0] > 3 * counts[1], "{counts:?}");
    }
}
