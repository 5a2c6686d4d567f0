//! Free flight in closed form: uniform acceleration, with or without damping proportional to velocity.
//!
//! With the damping rate k [1/s] the centre of mass obeys v' = a - k v, so that
//! x = x0 + v0 t p1(k t) + a t^2 p2(k t) and v = v0 e^(-k t) + a t p1(k t), with p1(z) = (1 - e^-z)/z and
//! p2(z) = (1 - p1(z))/z; the angle likewise, without acceleration.

use crate::motion::{Ball, BodyState, Motion, MotionBounds, Moving, Polynomial};
use glam::DVec2;
use halfgap_geometry::{Pose, Rotation};

/// Below this value of k t the functions p1 and p2 are summed as series, above in closed form.
const SERIES_BELOW: f64 = 0.5;
/// Terms of these series: enough for full precision below `SERIES_BELOW`, below `SMALL`, and below `TINY`.
const SERIES_TERMS: usize = 16;
const SMALL: f64 = 1.0 / 64.0;
const SMALL_TERMS: usize = 8;
const TINY: f64 = 1.0 / 1024.0;
const TINY_TERMS: usize = 5;
/// 1/(n + 3): a chain of divisions would take most of the time.
const RECIPROCALS: [f64; SERIES_TERMS] = {
    let mut reciprocals = [0.0; SERIES_TERMS];
    let mut n = 0;
    while n < SERIES_TERMS {
        reciprocals[n] = 1.0 / (n + 3) as f64;
        n += 1;
    }
    reciprocals
};

/// The motion of a body on which only uniform forces and linear damping act; also that of a fixed body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    start: BodyState,
    start_rotation: Rotation,
    acceleration: DVec2,
    linear_rate: f64,
    angular_rate: f64,
}

impl Flight {
    /// The flight from a state with the given acceleration [m/s^2] and rates [1/s] at which damping takes the linear and
    /// the angular velocity.
    #[must_use]
    pub fn new(start: BodyState, acceleration: DVec2, linear_rate: f64, angular_rate: f64) -> Self {
        let start_rotation = Rotation::from_angle(start.angle);
        Self { start, start_rotation, acceleration, linear_rate, angular_rate }
    }

    /// Goes on from another state; a rotation that stays the same is not computed again.
    pub fn restart(&mut self, start: BodyState) {
        if start.angle != self.start.angle {
            self.start_rotation = Rotation::from_angle(start.angle);
        }
        self.start = start;
    }

    /// A body that stays where it is.
    #[must_use]
    pub fn fixed(position: DVec2, angle: f64) -> Self {
        Self::new(BodyState { position, angle, ..BodyState::default() }, DVec2::ZERO, 0.0, 0.0)
    }

    /// State at offset 0.
    #[must_use]
    pub fn start(&self) -> &BodyState {
        &self.start
    }

    /// The parabola of the centre of mass from the start on; `None` if damping bends it.
    #[must_use]
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
    pub fn acceleration_at(&self, offset: f64) -> DVec2 {
        self.acceleration - self.velocity_at(offset) * self.linear_rate
    }

    /// Angular acceleration [rad/s^2] at an offset [s]: of damping alone.
    #[must_use]
    pub fn angular_acceleration_at(&self, offset: f64) -> f64 {
        -self.angular_rate * self.angular_velocity_at(offset)
    }

    /// True if the body neither moves nor is accelerated.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.start.velocity == DVec2::ZERO
            && self.start.angular_velocity == 0.0
            && self.acceleration == DVec2::ZERO
    }

    /// For how long [s] after an offset [s] the centre of mass surely stays within a distance [m] of where it is then;
    /// `None` if for ever.
    #[must_use]
    pub fn stays_within(&self, distance: f64, offset: f64) -> Option<f64> {
        let velocity = self.velocity_at(offset);
        let speed = velocity.length();
        // Damping lets accelerations only fade.
        let acceleration = self.acceleration_at(offset).length();
        if speed == 0.0 && acceleration == 0.0 {
            return None;
        }
        if distance == 0.0 {
            return Some(0.0);
        }
        let by_acceleration =
            2.0 * distance / (speed + (speed * speed + 2.0 * acceleration * distance).sqrt());
        // Damped velocities run straight towards their final value.
        let is_damped = self.linear_rate > 0.0;
        let fastest = is_damped.then(|| speed.max(self.acceleration.length() / self.linear_rate));
        Some(fastest.map_or(by_acceleration, |fastest| by_acceleration.max(distance / fastest)))
    }

    fn position_at(&self, t: f64) -> DVec2 {
        if self.linear_rate == 0.0 {
            return self.start.position + (self.start.velocity + self.acceleration * (0.5 * t)) * t;
        }
        let decay = Decay::new(self.linear_rate * t);
        self.start.position + (self.start.velocity * decay.p1 + self.acceleration * (t * decay.p2)) * t
    }

    fn velocity_at(&self, t: f64) -> DVec2 {
        if self.linear_rate == 0.0 {
            return self.start.velocity + self.acceleration * t;
        }
        let z = self.linear_rate * t;
        let decay = Decay::new(z);
        self.start.velocity * (1.0 - z * decay.p1) + self.acceleration * (t * decay.p1)
    }

    fn angle_at(&self, t: f64) -> f64 {
        if self.angular_rate == 0.0 {
            return self.start.angle + self.start.angular_velocity * t;
        }
        self.start.angle + self.start.angular_velocity * t * Decay::new(self.angular_rate * t).p1
    }

    fn angular_velocity_at(&self, t: f64) -> f64 {
        if self.angular_rate == 0.0 {
            return self.start.angular_velocity;
        }
        self.start.angular_velocity * libm::exp(-self.angular_rate * t)
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
    fn moving_at(&self, offset: f64) -> Moving {
        let rotation = if self.start.angular_velocity == 0.0 || offset == 0.0 {
            self.start_rotation
        } else {
            Rotation::from_angle(self.angle_at(offset))
        };
        let (position, velocity) = self.center_at(offset);
        Moving {
            pose: Pose { position, rotation },
            velocity,
            angular_velocity: self.angular_velocity_at(offset),
        }
    }

    #[inline]
    fn center_at(&self, t: f64) -> (DVec2, DVec2) {
        if self.linear_rate == 0.0 {
            return (self.position_at(t), self.velocity_at(t));
        }
        // For less than one by one: e^-z = 1 - z p1.
        let z = self.linear_rate * t;
        let decay = Decay::new(z);
        let (v, a) = (self.start.velocity, self.acceleration);
        let position = self.start.position + (v * decay.p1 + a * (t * decay.p2)) * t;
        (position, v * (1.0 - z * decay.p1) + a * (t * decay.p1))
    }

    fn bounds(&self, from: f64, to: f64) -> MotionBounds {
        // Both curves of velocities are straight in the plane (a ray towards the final velocity when damped), so the
        // ball over the two end velocities holds all between them.
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

/// The functions p1 and p2 of damped motion.
struct Decay {
    p1: f64,
    p2: f64,
}

impl Decay {
    fn new(z: f64) -> Self {
        if z > SERIES_BELOW {
            let p1 = -libm::expm1(-z) / z;
            return Self { p1, p2: (1.0 - p1) / z };
        }
        let p2 = match z.abs() {
            size if size < TINY => Self::series::<TINY_TERMS>(z),
            size if size < SMALL => Self::series::<SMALL_TERMS>(z),
            _ => Self::series::<SERIES_TERMS>(z),
        };
        Self { p1: 1.0 - z * p2, p2 }
    }

    /// p2(z) = sum of (-z)^n / (n + 2)!, by Horner's rule from the last term; p1 = 1 - z p2.
    #[inline]
    fn series<const TERMS: usize>(z: f64) -> f64 {
        0.5 * RECIPROCALS[..TERMS].iter().rev().fold(1.0, |sum, reciprocal| 1.0 - sum * (z * reciprocal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_of_damping_meet_the_closed_forms() {
        for z in [SERIES_BELOW, 0.4999999, 0.1, SMALL, 0.999 * SMALL, TINY, 0.999 * TINY, 1e-4] {
            let series = Decay::new(z);
            let p1 = -(-z).exp_m1() / z;
            assert!((series.p1 - p1).abs() < 1e-15, "p1({z})");
            assert!((series.p2 - (1.0 - p1) / z).abs() < 1e-15 / z, "p2({z})");
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
    fn what_is_hardly_damped_stays_as_long_as_what_is_not() {
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
    fn what_does_not_move_stays_for_ever() {
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
