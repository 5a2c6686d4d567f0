//! Free flight in closed form: uniform acceleration, with or without damping proportional to velocity.
//!
//! With the damping rate k [1/s] the centre of mass obeys v' = a - k v, so that
//! x = x0 + v0 t p1(k t) + a t^2 p2(k t) and v = v0 e^(-k t) + a t p1(k t), with p1(z) = (1 - e^-z)/z and
//! p2(z) = (1 - p1(z))/z; the angle likewise, without acceleration.

use crate::motion::{Ball, BodyState, Motion, MotionBounds, Moving, Polynomial};
use glam::DVec2;
use halfgap_geometry::{Pose, Rotation};

/// Largest k t [-] for which the functions p1 and p2 are summed as series; above it, closed forms are used.
const SERIES_BELOW: f64 = 0.5;
/// Number of terms of the series: enough for full precision up to [`SERIES_BELOW`].
const SERIES_TERMS: usize = 16;
/// Value of k t [-] below which half of the terms give full precision.
const SMALL: f64 = 1.0 / 64.0;
/// Coefficients (-1)^n/(n + 2)! of p2.
const SERIES: [f64; SERIES_TERMS] = {
    let mut coefficients = [0.5; SERIES_TERMS];
    let mut n = 1;
    while n < SERIES_TERMS {
        coefficients[n] = -coefficients[n - 1] / (n + 2) as f64;
        n += 1;
    }
    coefficients
};

/// The motion of a body on which only uniform forces and linear damping act; also that of a fixed body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Flight {
    start: BodyState,
    start_rotation: Rotation,
    acceleration: DVec2,
    linear_rate: f64,
    angular_rate: f64,
}

impl Flight {
    /// The flight from a state with the given acceleration [m/s^2] and the rates [1/s] at which damping reduces the
    /// linear and the angular velocity. A rate that is negative or not a number counts as 0: damping never adds energy.
    /// An infinite one makes bounds that are not finite, with which nothing can be proven.
    #[must_use]
    #[inline]
    pub fn new(start: BodyState, acceleration: DVec2, linear_rate: f64, angular_rate: f64) -> Self {
        let [linear_rate, angular_rate] = [linear_rate, angular_rate].map(|rate| rate.max(0.0));
        let start_rotation = Rotation::from_angle(start.angle);
        Self { start, start_rotation, acceleration, linear_rate, angular_rate }
    }

    /// Sets another start state; acceleration and rates stay. The rotation is computed again only if the angle differs.
    #[inline]
    pub fn restart(&mut self, start: BodyState) {
        if start.angle != self.start.angle {
            self.start_rotation = Rotation::from_angle(start.angle);
        }
        self.start = start;
    }

    /// The motion of a body that stays at a position [m] and an angle [rad].
    #[must_use]
    #[inline]
    pub fn fixed(position: DVec2, angle: f64) -> Self {
        Self::new(BodyState { position, angle, ..BodyState::default() }, DVec2::ZERO, 0.0, 0.0)
    }

    /// State at offset 0.
    #[must_use]
    #[inline]
    pub fn start(&self) -> &BodyState {
        &self.start
    }

    /// Acceleration [m/s^2] of the centre of mass without damping.
    #[must_use]
    #[inline]
    pub fn acceleration(&self) -> DVec2 {
        self.acceleration
    }

    /// Rates [1/s], not negative, at which damping reduces the linear and the angular velocity.
    #[must_use]
    #[inline]
    pub fn rates(&self) -> [f64; 2] {
        [self.linear_rate, self.angular_rate]
    }

    /// The parabola of the centre of mass from the start on; `None` if damping bends it.
    #[must_use]
    #[inline]
    pub fn parabola(&self) -> Option<Polynomial> {
        let (position, velocity) = (self.start.position, self.start.velocity);
        (self.linear_rate == 0.0).then_some(Polynomial {
            position,
            velocity,
            acceleration: self.acceleration,
        })
    }

    /// Acceleration of the centre of mass [m/s^2] at an offset [s], damping included.
    #[must_use]
    #[inline]
    pub fn acceleration_at(&self, offset: f64) -> DVec2 {
        self.acceleration - self.velocity_at(offset) * self.linear_rate
    }

    /// Angular acceleration [rad/s^2] at an offset [s], which is due to damping alone.
    #[must_use]
    #[inline]
    pub fn angular_acceleration_at(&self, offset: f64) -> f64 {
        -self.angular_rate * self.angular_velocity_at(offset)
    }

    /// True if the body neither moves nor is accelerated.
    #[must_use]
    #[inline]
    pub fn is_at_rest(&self) -> bool {
        self.start.velocity == DVec2::ZERO
            && self.start.angular_velocity == 0.0
            && self.acceleration == DVec2::ZERO
    }

    /// Time [s] after an offset [s] for which the centre of mass surely stays within a distance [m] of its position at
    /// the offset; `None` if for ever.
    #[must_use]
    pub fn stays_within(&self, distance: f64, offset: f64) -> Option<f64> {
        let velocity = self.velocity_at(offset);
        let speed = velocity.length();
        // Under damping, accelerations only fade.
        let acceleration = self.acceleration_at(offset).length();
        if speed == 0.0 && acceleration == 0.0 {
            return None;
        }
        if distance == 0.0 {
            return Some(0.0);
        }
        let by_acceleration =
            2.0 * distance / (speed + (speed * speed + 2.0 * acceleration * distance).sqrt());
        // A damped velocity changes along a straight line towards its final value.
        let is_damped = self.linear_rate > 0.0;
        let fastest = is_damped.then(|| speed.max(self.acceleration.length() / self.linear_rate));
        Some(fastest.map_or(by_acceleration, |fastest| by_acceleration.max(distance / fastest)))
    }

    fn position_at(&self, t: f64) -> DVec2 {
        if self.linear_rate == 0.0 {
            return self.start.position + (self.start.velocity + self.acceleration * (0.5 * t)) * t;
        }
        self.decayed_position(&Decay::new(self.linear_rate * t), t)
    }

    fn velocity_at(&self, t: f64) -> DVec2 {
        if t == 0.0 {
            return self.start.velocity;
        }
        if self.linear_rate == 0.0 {
            return self.start.velocity + self.acceleration * t;
        }
        self.decayed_velocity(&Decay::new(self.linear_rate * t), t)
    }

    fn decayed_position(&self, decay: &Decay, t: f64) -> DVec2 {
        self.start.position + (self.start.velocity * decay.p1 + self.acceleration * (t * decay.p2)) * t
    }

    fn decayed_velocity(&self, decay: &Decay, t: f64) -> DVec2 {
        self.start.velocity * decay.left + self.acceleration * (t * decay.p1)
    }

    fn angle_at(&self, t: f64) -> f64 {
        self.start.angle + self.start.angular_velocity * t * self.angular_decay(t).p1
    }

    fn angular_velocity_at(&self, t: f64) -> f64 {
        self.start.angular_velocity * self.angular_decay(t).left
    }

    /// The decay of the angular motion; [`Decay::NONE`] without damping or turning.
    fn angular_decay(&self, t: f64) -> Decay {
        let is_damped = t != 0.0 && self.angular_rate != 0.0 && self.start.angular_velocity != 0.0;
        if is_damped { Decay::new(self.angular_rate * t) } else { Decay::NONE }
    }
}

impl Motion for Flight {
    fn state_at(&self, offset: f64) -> BodyState {
        BodyState {
            position: self.position_at(offset),
            angle: self.angle_at(offset),
            velocity: self.velocity_at(offset),
            angular_velocity: self.angular_velocity_at(offset),
        }
    }

    #[inline]
    fn moving_at(&self, t: f64) -> Moving {
        let start = &self.start;
        if t == 0.0 || self.is_at_rest() {
            let pose = Pose { position: start.position, rotation: self.start_rotation };
            let BodyState { angle, velocity, angular_velocity, .. } = *start;
            return Moving { pose, angle, velocity, angular_velocity };
        }
        let linear = if self.linear_rate == 0.0 { None } else { Some(Decay::new(self.linear_rate * t)) };
        let (position, velocity) = match &linear {
            Some(decay) => (self.decayed_position(decay, t), self.decayed_velocity(decay, t)),
            None => (self.position_at(t), self.velocity_at(t)),
        };
        if start.angular_velocity == 0.0 {
            let pose = Pose { position, rotation: self.start_rotation };
            let BodyState { angle, angular_velocity, .. } = *start;
            return Moving { pose, angle, velocity, angular_velocity };
        }
        // Mostly both velocities are damped alike.
        let shared = linear.filter(|_| self.angular_rate == self.linear_rate);
        let angular = shared.unwrap_or_else(|| self.angular_decay(t));
        let angle = start.angle + start.angular_velocity * t * angular.p1;
        Moving {
            pose: Pose { position, rotation: Rotation::from_angle(angle) },
            angle,
            velocity,
            angular_velocity: start.angular_velocity * angular.left,
        }
    }

    #[inline]
    fn center_at(&self, t: f64) -> (DVec2, DVec2) {
        if t == 0.0 || self.is_at_rest() {
            return (self.start.position, self.start.velocity);
        }
        if self.linear_rate == 0.0 {
            return (self.position_at(t), self.velocity_at(t));
        }
        let decay = Decay::new(self.linear_rate * t);
        (self.decayed_position(&decay, t), self.decayed_velocity(&decay, t))
    }

    fn bounds(&self, from: f64, to: f64) -> MotionBounds {
        if self.is_at_rest() {
            return MotionBounds::default();
        }
        // With and without damping the velocity changes along a straight line (when damped, towards the final
        // velocity), so the ball over the two end velocities holds all between them.
        let (first, last) = (self.velocity_at(from), self.velocity_at(to));
        let velocity = Ball { center: 0.5 * (first + last), radius: 0.5 * (last - first).length() };
        let k = self.linear_rate;
        let acceleration =
            Ball { center: self.acceleration - velocity.center * k, radius: velocity.radius * k };
        let angular_speed = self.angular_velocity_at(from).abs();
        let angular_acceleration = angular_speed * self.angular_rate;
        MotionBounds { velocity, acceleration, angular_speed, angular_acceleration }
    }

    #[inline]
    fn polynomial_from(&self, offset: f64) -> Option<Polynomial> {
        (self.linear_rate == 0.0).then(|| Polynomial {
            position: self.position_at(offset),
            velocity: self.velocity_at(offset),
            acceleration: self.acceleration,
        })
    }

    #[inline]
    fn is_rotation_free(&self) -> bool {
        self.start.angular_velocity == 0.0
    }
}

/// Factors by which damping changes a motion up to the time t, as functions of z = k t [-].
struct Decay {
    /// e^-z: the fraction of a velocity that is left.
    left: f64,
    p1: f64,
    p2: f64,
}

impl Decay {
    const NONE: Self = Self { left: 1.0, p1: 1.0, p2: 0.5 };

    #[inline]
    fn new(z: f64) -> Self {
        if z.abs() > SERIES_BELOW {
            return Self::closed(z);
        }
        let (z2, z4) = (z * z, (z * z) * (z * z));
        let eight = |n: usize| {
            let pair = |k: usize| SERIES[n + k] + z * SERIES[n + k + 1];
            (pair(0) + z2 * pair(2)) + z4 * (pair(4) + z2 * pair(6))
        };
        let p2 = if z.abs() < SMALL { eight(0) } else { eight(0) + z4 * z4 * eight(8) };
        let p1 = 1.0 - z * p2;
        Self { left: 1.0 - z * p1, p1, p2 }
    }

    /// The closed forms, for z above [`SERIES_BELOW`]. Not inlined, since few flights last so long.
    #[inline(never)]
    fn closed(z: f64) -> Self {
        let p1 = -libm::expm1(-z) / z;
        Self { left: libm::exp(-z), p1, p2: (1.0 - p1) / z }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_of_damping_meet_the_closed_forms() {
        for z in [SERIES_BELOW, 0.4999999, 0.1, SMALL, 0.999 * SMALL, 1e-4, 3.0, 40.0] {
            let series = Decay::new(z);
            let p1 = -(-z).exp_m1() / z;
            assert!((series.p1 - p1).abs() < 1e-15, "p1({z})");
            assert!((series.p2 - (1.0 - p1) / z).abs() < 1e-15 / z, "p2({z})");
            assert!((series.left / (-z).exp() - 1.0).abs() < 1e-15, "left of {z}");
        }
    }

    #[test]
    fn damped_flight_obeys_its_equation() {
        let start = BodyState {
            position: DVec2::new(1.0, 2.0),
            angle: 0.3,
            velocity: DVec2::new(-2.0, 5.0),
            angular_velocity: 3.0,
        };
        let flight = Flight::new(start, DVec2::new(0.0, -9.81), 0.7, 0.2);
        for t in [0.0, 0.2, 1.0, 5.0] {
            let h = 1e-5;
            let (before, after) = (flight.state_at(t - h), flight.state_at(t + h));
            let velocity = (after.position - before.position) / (2.0 * h);
            let acceleration = (after.velocity - before.velocity) / (2.0 * h);
            let spin_up = (after.angular_velocity - before.angular_velocity) / (2.0 * h);
            assert!((velocity - flight.state_at(t).velocity).length() < 1e-8);
            assert!((acceleration - flight.acceleration_at(t)).length() < 1e-8);
            assert!((spin_up - flight.angular_acceleration_at(t)).abs() < 1e-8);
        }
    }

    #[test]
    fn a_hardly_damped_body_stays_as_long_as_an_undamped_one() {
        let start = BodyState { velocity: DVec2::new(1.0, 4.0), ..BodyState::default() };
        let gravity = DVec2::new(0.0, -10.0);
        for linear_rate in [0.0, 1e-12, 1e-7, 1e-3, 1.0, 30.0] {
            let flight = Flight::new(start, gravity, linear_rate, 0.0);
            for offset in [0.0, 0.3, 2.0] {
                let wait = flight.stays_within(0.2, offset).expect("it falls");
                let moved = |t: f64| {
                    (flight.state_at(offset + t).position - flight.state_at(offset).position).length()
                };
                assert!((0..=50).all(|part| moved(wait * f64::from(part) / 50.0) <= 0.2 * (1.0 + 1e-9)));
                assert!(moved(2.0 * wait) > 0.05, "a wait of {wait} s at rate {linear_rate}");
            }
        }
    }

    #[test]
    fn a_body_that_does_not_move_stays_for_ever() {
        for linear_rate in [0.0, 0.5] {
            let flight = Flight::new(BodyState::default(), DVec2::ZERO, linear_rate, 0.0);
            assert_eq!(flight.stays_within(0.2, 1.0), None);
            assert_eq!(flight.stays_within(0.0, 1.0), None);
        }
    }

    #[test]
    fn without_damping_flight_is_a_parabola() {
        let start = BodyState { velocity: DVec2::new(1.0, 4.0), ..BodyState::default() };
        let flight = Flight::new(start, DVec2::new(0.0, -10.0), 0.0, 0.0);
        assert_eq!(flight.state_at(0.5).position, DVec2::new(0.5, 0.75));
        assert_eq!(flight.state_at(0.5).velocity, DVec2::new(1.0, -1.0));
    }
}
