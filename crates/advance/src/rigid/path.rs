//! The motion of a body along its segment: a flight in closed form, or the dense output of an integrator's step.

use crate::ode::{Jet, SegmentPolynomial, Spread};
use glam::DVec2;
use halfgap_collision::{Ball, BodyState, Flight, Motion, MotionBounds, Moving, Polynomial};
use halfgap_geometry::Aabb;

/// Bounds over a whole segment on what polynomials say: x, y, angle.
pub(crate) fn bounds_along(polynomials: &[SegmentPolynomial; 3]) -> MotionBounds {
    let [x, y, angle] = polynomials;
    let ball = |x: Spread, y: Spread| Ball {
        center: DVec2::new(x.center, y.center),
        radius: DVec2::new(x.radius, y.radius).length(),
    };
    MotionBounds {
        velocity: ball(x.derivative_spread(), y.derivative_spread()),
        acceleration: ball(x.second_derivative_spread(), y.second_derivative_spread()),
        angular_speed: angle.derivative_spread().largest(),
        angular_acceleration: angle.second_derivative_spread().largest(),
    }
}

/// Largest size of a vector, by the spreads of its components.
fn largest(x: Spread, y: Spread) -> f64 {
    DVec2::new(x.largest(), y.largest()).length()
}

/// Dense output: polynomials in time for the centre of mass and the angle.
#[derive(Clone, Debug, Default)]
pub(crate) struct DensePath {
    x: SegmentPolynomial,
    y: SegmentPolynomial,
    angle: SegmentPolynomial,
    /// Bounds over the whole segment on the accelerations [m/s^2, rad/s^2] and their rates [m/s^3, rad/s^3].
    acceleration: f64,
    jerk: f64,
    angular_acceleration: f64,
    angular_jerk: f64,
}

impl DensePath {
    /// Takes other polynomials: x, y, angle.
    pub(crate) fn set(&mut self, polynomials: &[SegmentPolynomial; 3]) {
        let [x, y, angle] = *polynomials;
        *self = Self {
            acceleration: largest(x.second_derivative_spread(), y.second_derivative_spread()),
            jerk: largest(x.third_derivative_spread(), y.third_derivative_spread()),
            angular_acceleration: angle.second_derivative_spread().largest(),
            angular_jerk: angle.third_derivative_spread().largest(),
            x,
            y,
            angle,
        };
    }

    /// A speed [m/s] that the centre of mass does not exceed during the segment.
    pub(crate) fn top_speed(&self) -> f64 {
        largest(self.x.derivative_spread(), self.y.derivative_spread())
    }

    /// The box in which the centre of mass stays during the segment.
    pub(crate) fn center_box(&self) -> Aabb {
        let [x, y] = [self.x.value_spread(), self.y.value_spread()];
        let (center, half) = (DVec2::new(x.center, y.center), DVec2::new(x.radius, y.radius));
        Aabb { min: center - half, max: center + half }
    }

    fn jets_at(&self, offset: f64) -> [Jet; 3] {
        [self.x.jet_at(offset), self.y.jet_at(offset), self.angle.jet_at(offset)]
    }
}

impl Motion for DensePath {
    fn state_at(&self, offset: f64) -> BodyState {
        let (position, velocity) = self.center_at(offset);
        let (angle, angular_velocity) = self.angle.value_and_rate_at(offset);
        BodyState { position, angle, velocity, angular_velocity }
    }

    fn center_at(&self, offset: f64) -> (DVec2, DVec2) {
        let ((x, x_rate), (y, y_rate)) = (self.x.value_and_rate_at(offset), self.y.value_and_rate_at(offset));
        (DVec2::new(x, y), DVec2::new(x_rate, y_rate))
    }

    fn bounds(&self, from: f64, to: f64) -> MotionBounds {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let [x, y, angle] = self.jets_at(middle);
        let angular_acceleration =
            (angle.second_derivative.abs() + self.angular_jerk * half).min(self.angular_acceleration);
        let velocity = DVec2::new(x.derivative, y.derivative);
        let acceleration = DVec2::new(x.second_derivative, y.second_derivative);
        MotionBounds {
            velocity: Ball { center: velocity, radius: self.acceleration * half },
            acceleration: Ball { center: acceleration, radius: self.jerk * half },
            angular_speed: angle.derivative.abs() + angular_acceleration * half,
            angular_acceleration,
        }
    }

    fn polynomial_from(&self, _offset: f64) -> Option<Polynomial> {
        None
    }

    fn is_rotation_free(&self) -> bool {
        false
    }
}

/// A body's motion along its present segment.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Path<'a> {
    /// In closed form.
    Flight(&'a Flight),
    /// By an integrator.
    Dense(&'a DensePath),
}

macro_rules! either {
    ($path:expr, $motion:ident => $answer:expr) => {
        match $path {
            Path::Flight($motion) => $answer,
            Path::Dense($motion) => $answer,
        }
    };
}

impl Motion for Path<'_> {
    fn state_at(&self, offset: f64) -> BodyState {
        either!(self, motion => motion.state_at(offset))
    }

    fn moving_at(&self, offset: f64) -> Moving {
        either!(self, motion => motion.moving_at(offset))
    }

    fn center_at(&self, offset: f64) -> (DVec2, DVec2) {
        either!(self, motion => motion.center_at(offset))
    }

    fn bounds(&self, from: f64, to: f64) -> MotionBounds {
        either!(self, motion => motion.bounds(from, to))
    }

    fn polynomial_from(&self, offset: f64) -> Option<Polynomial> {
        either!(self, motion => motion.polynomial_from(offset))
    }

    fn is_rotation_free(&self) -> bool {
        either!(self, motion => motion.is_rotation_free())
    }
}
