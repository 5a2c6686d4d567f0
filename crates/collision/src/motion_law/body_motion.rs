//! The motion of a body that is moved: a law for each of its coordinates, and the path from where the body is at the start.

use super::{MotionLaw, MotionMoment};
use crate::kinematics::BodyAcceleration;
use crate::motion::{Ball, BodyState, Motion, MotionBounds, Polynomial};
use glam::DVec2;

/// Number of times that the time is shortened for which a body surely stays where it is.
const NARROWINGS: usize = 3;

/// Laws by which a body is moved that nothing else moves.
///
/// They count from their values at the start: the body is where it was then, displaced by how much they have changed since.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyMotion {
    /// Position of the centre of mass along x [m].
    pub x: MotionLaw,
    /// Position of the centre of mass along y [m].
    pub y: MotionLaw,
    /// Angle [rad].
    pub angle: MotionLaw,
}

impl BodyMotion {
    /// Motion at a constant velocity [m/s] of the centre of mass and angular velocity [rad/s].
    #[must_use]
    pub fn uniform(velocity: DVec2, angular_velocity: f64) -> Self {
        let [x, y, angle] = [velocity.x, velocity.y, angular_velocity].map(MotionLaw::Uniform);
        Self { x, y, angle }
    }

    /// The laws of x, y and the angle.
    #[must_use]
    #[inline]
    pub fn laws(&self) -> [&MotionLaw; 3] {
        [&self.x, &self.y, &self.angle]
    }

    /// The first time [s] later than `after` at which a law is not smooth.
    #[must_use]
    pub fn next_kink(&self, after: f64) -> Option<f64> {
        self.laws().into_iter().filter_map(|law| law.next_kink(after)).reduce(f64::min)
    }

    /// True if all numbers of the laws are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.laws().into_iter().all(MotionLaw::is_finite)
    }
    /// True if the body moves at constant velocities.
    #[must_use]
    pub fn is_uniform(&self) -> bool {
        self.laws().into_iter().all(MotionLaw::is_uniform)
    }

    /// True if the body does not move at all.
    #[must_use]
    pub fn is_still(&self) -> bool {
        self.laws().into_iter().all(|law| *law == MotionLaw::Uniform(0.0))
    }

    /// True if no law is one of one's own, which cannot be saved.
    #[must_use]
    pub fn can_be_saved(&self) -> bool {
        self.laws().into_iter().all(|law| !matches!(law, MotionLaw::Own(_)))
    }
}

/// The motion of a moved body, as a function of the offset [s] from the start of it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct MovedPath {
    motion: BodyMotion,
    /// Position [m] and angle [rad] at the start.
    place: [f64; 3],
    /// Values of the laws at the start.
    first: [f64; 3],
    /// Time of the start [s].
    start: f64,
}

impl MovedPath {
    /// The motion of a body that is at a position [m] and an angle [rad] at a time [s].
    #[must_use]
    pub fn new(motion: BodyMotion, position: DVec2, angle: f64, start: f64) -> Self {
        let first = motion.laws().map(|law| law.at(start).value);
        Self { motion, place: [position.x, position.y, angle], first, start }
    }

    /// The laws.
    #[must_use]
    #[inline]
    pub fn motion(&self) -> &BodyMotion {
        &self.motion
    }

    /// Acceleration at an offset [s].
    #[must_use]
    pub fn acceleration_at(&self, offset: f64) -> BodyAcceleration {
        let [x, y, angular] = self.motion.laws().map(|law| law.at(self.start + offset).acceleration);
        BodyAcceleration { linear: DVec2::new(x, y), angular }
    }

    /// Time [s] after an offset [s] for which the centre of mass surely stays within a distance [m] of its position at
    /// the offset; `None` if for ever. No more than `longest` [s] are looked at.
    #[must_use]
    pub fn stays_within(&self, distance: f64, offset: f64, longest: f64) -> Option<f64> {
        let mut wait = longest;
        // Over a shorter time, bounds are nearer to the motion.
        for _ in 0..NARROWINGS {
            let speed = self.bounds(offset, offset + wait).velocity.largest();
            if speed == 0.0 && wait == longest && self.motion.is_uniform() {
                return None;
            }
            let sure = wait.min(distance / speed);
            if sure >= 0.5 * wait {
                return Some(sure);
            }
            wait = 2.0 * sure;
        }
        Some(0.5 * wait)
    }

    /// Position or angle at an offset [s], by the index of its law. What is uniform goes as a parabola tells, to the bit.
    fn value_at(&self, index: usize, law: &MotionLaw, offset: f64) -> [f64; 2] {
        let MotionMoment { value, rate, .. } = law.at(self.start + offset);
        let change =
            if let MotionLaw::Uniform(rate) = law { rate * offset } else { value - self.first[index] };
        [self.place[index] + change, rate]
    }
}

impl Motion for MovedPath {
    fn state_at(&self, offset: f64) -> BodyState {
        let (position, velocity) = self.center_at(offset);
        let [angle, angular_velocity] = self.value_at(2, &self.motion.angle, offset);
        BodyState { position, angle, velocity, angular_velocity }
    }

    fn center_at(&self, offset: f64) -> (DVec2, DVec2) {
        let [x, u] = self.value_at(0, &self.motion.x, offset);
        let [y, v] = self.value_at(1, &self.motion.y, offset);
        (DVec2::new(x, y), DVec2::new(u, v))
    }

    fn bounds(&self, from: f64, to: f64) -> MotionBounds {
        let [x, y, angle] = self.motion.laws().map(|law| law.spread(self.start + from, self.start + to));
        let ball = |[x0, x1]: [f64; 2], [y0, y1]: [f64; 2]| {
            let (least, most) = (DVec2::new(x0, y0), DVec2::new(x1, y1));
            Ball { center: 0.5 * (least + most), radius: 0.5 * (most - least).length() }
        };
        let largest = |[least, most]: [f64; 2]| least.abs().max(most.abs());
        MotionBounds {
            velocity: ball(x.rate, y.rate),
            acceleration: ball(x.acceleration, y.acceleration),
            angular_speed: largest(angle.rate),
            angular_acceleration: largest(angle.acceleration),
        }
    }

    fn polynomial_from(&self, offset: f64) -> Option<Polynomial> {
        let is_straight = [&self.motion.x, &self.motion.y].into_iter().all(MotionLaw::is_uniform);
        is_straight.then(|| {
            let (position, velocity) = self.center_at(offset);
            Polynomial { position, velocity, acceleration: DVec2::ZERO }
        })
    }

    fn is_rotation_free(&self) -> bool {
        self.motion.angle == MotionLaw::Uniform(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::laws;
    use super::*;
    use proptest::prelude::*;

    fn paths() -> impl Strategy<Value = MovedPath> {
        let place = (-3.0..3.0, -3.0..3.0, -4.0..4.0, -2.0..2.0);
        (laws(), laws(), laws(), place).prop_map(|(x, y, angle, (a, b, turned, start))| {
            MovedPath::new(BodyMotion { x, y, angle }, DVec2::new(a, b), turned, start)
        })
    }

    #[test]
    fn a_uniform_motion_is_a_parabola_to_the_bit() {
        let motion = BodyMotion::uniform(DVec2::new(0.3, -1.7), 0.0);
        let path = MovedPath::new(motion, DVec2::new(1.1, 0.2), 0.5, 7.3);
        let Some(Polynomial { position, velocity, acceleration }) = path.polynomial_from(0.0) else {
            panic!("it goes straight on")
        };
        assert!(acceleration == DVec2::ZERO && path.is_rotation_free());
        for offset in [0.0, 0.1, 3.7] {
            assert_eq!(path.state_at(offset).position, position + velocity * offset);
        }
        assert_eq!(path.stays_within(1.0, 0.0, 1e6).map(|wait| wait * velocity.length() <= 1.0), Some(true));
        let still = MovedPath::new(BodyMotion::uniform(DVec2::ZERO, 2.0), DVec2::ZERO, 0.0, 0.0);
        assert_eq!(still.stays_within(0.1, 3.0, 1e6), None);
    }

    proptest! {
        #[test]
        fn motions_start_at_their_place_and_keep_to_their_bounds(
            path in paths(),
            from in 0.0..5.0,
            span in 1e-3..2.0,
            distance in 1e-3..1.0,
        ) {
            let state = path.state_at(0.0);
            prop_assert_eq!([state.position.x, state.position.y, state.angle], path.place);
            let bounds = path.bounds(from, from + span);
            let start = path.state_at(from);
            let stay = path.stays_within(distance, from, 1e3).unwrap_or(span);
            let rounding = 1e-12;
            for part in 0..=16 {
                let share = f64::from(part) / 16.0;
                let (state, acceleration) =
                    (path.state_at(from + share * span), path.acceleration_at(from + share * span));
                let off = |ball: &Ball, value: DVec2| (value - ball.center).length() - ball.radius;
                prop_assert!(off(&bounds.velocity, state.velocity) <= rounding);
                prop_assert!(off(&bounds.acceleration, acceleration.linear) <= rounding);
                prop_assert!(state.angular_velocity.abs() <= bounds.angular_speed + rounding);
                prop_assert!(acceleration.angular.abs() <= bounds.angular_acceleration + rounding);
                let way = path.state_at(from + share * stay).position - start.position;
                prop_assert!(way.length() <= distance + rounding, "{way} in {stay} s");
            }
        }
    }
}
