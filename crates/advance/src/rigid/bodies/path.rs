//! The motion of a body along its segment: a flight in closed form, the dense output of an integrator's step, or a prescribed motion.

use crate::ode::{Jet, SegmentPolynomial, Spread};
use glam::DVec2;
use halfgap_collision::{Ball, BodyState, Flight, Motion, MotionBounds, MovedPath, Moving, Polynomial};
use halfgap_geometry::Aabb;

/// Bounds over a whole segment on a motion given by the polynomials of x, y and angle.
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

/// Bound on the size of a vector, from the spreads of its components.
pub(crate) fn largest(x: Spread, y: Spread) -> f64 {
    DVec2::new(x.largest(), y.largest()).length()
}

/// Dense output: polynomials in time for the centre of mass and the angle.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct DensePath {
    x: SegmentPolynomial,
    y: SegmentPolynomial,
    angle: SegmentPolynomial,
    /// Bound [m/s^2] on the acceleration over the whole segment.
    acceleration: f64,
    /// Bound [m/s^3] on the rate of the acceleration over the whole segment.
    jerk: f64,
    /// Bound [rad/s^2] on the angular acceleration over the whole segment.
    angular_acceleration: f64,
    /// Bound [rad/s^3] on the rate of the angular acceleration over the whole segment.
    angular_jerk: f64,
    known: Known,
}

/// Answers that the searches of all pairs of a body need first: its motion at the start and in the middle of its
/// segment, and bounds along all of it.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Known {
    /// Length of the segment [s].
    span: f64,
    at_start: Moving,
    at_middle: Moving,
    bounds: MotionBounds,
}

impl Default for Known {
    fn default() -> Self {
        let rest = Moving::BACKGROUND;
        Self { span: 0.0, at_start: rest, at_middle: rest, bounds: MotionBounds::default() }
    }
}

impl DensePath {
    /// Sets the polynomials of x, y and angle, and the length `span` [s] of the segment.
    pub(crate) fn set(&mut self, polynomials: &[SegmentPolynomial; 3], span: f64) {
        let [x, y, angle] = *polynomials;
        *self = Self {
            acceleration: largest(x.second_derivative_spread(), y.second_derivative_spread()),
            jerk: largest(x.third_derivative_spread(), y.third_derivative_spread()),
            angular_acceleration: angle.second_derivative_spread().largest(),
            angular_jerk: angle.third_derivative_spread().largest(),
            x,
            y,
            angle,
            known: Known::default(),
        };
        self.known = Known {
            span,
            at_start: self.find_moving(0.0),
            at_middle: self.find_moving(0.5 * span),
            bounds: self.find_bounds(0.0, span),
        };
    }

    fn find_moving(&self, offset: f64) -> Moving {
        Moving::from(&self.state_at(offset))
    }

    fn find_bounds(&self, from: f64, to: f64) -> MotionBounds {
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

    /// Bound [m/s] on the speed of the centre of mass during the segment.
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

    #[inline]
    fn moving_at(&self, offset: f64) -> Moving {
        if offset == 0.0 {
            self.known.at_start
        } else if offset == 0.5 * self.known.span {
            self.known.at_middle
        } else {
            self.find_moving(offset)
        }
    }

    fn center_at(&self, offset: f64) -> (DVec2, DVec2) {
        let ((x, x_rate), (y, y_rate)) = (self.x.value_and_rate_at(offset), self.y.value_and_rate_at(offset));
        (DVec2::new(x, y), DVec2::new(x_rate, y_rate))
    }

    #[inline]
    fn bounds(&self, from: f64, to: f64) -> MotionBounds {
        if from == 0.0 && to == self.known.span { self.known.bounds } else { self.find_bounds(from, to) }
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
    /// A flight in closed form.
    Flight(&'a Flight),
    /// Dense output of an integrator.
    Dense(&'a DensePath),
    /// As prescribed.
    Moved(&'a MovedPath),
}

macro_rules! either {
    ($path:expr, $motion:ident => $answer:expr) => {
        match $path {
            Path::Flight($motion) => $answer,
            Path::Dense($motion) => $answer,
            Path::Moved($motion) => $answer,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::test_scene::block_on_its_corner;
    use halfgap_collision::BodyId;

    #[test]
    fn motion_and_bounds_of_a_segment_are_those_of_its_polynomials() {
        let mut rooms = block_on_its_corner();
        let group = rooms.groups.take(BodyId(1)).expect("it is in a group");
        let mut dense = DensePath::default();
        for part in [1.0, 0.7, 0.1, 0.0] {
            let span = part * group.span();
            dense.set(&group.paths()[0], span);
            for offset in [0.0, 0.5 * span, span] {
                assert_eq!(dense.moving_at(offset), Moving::from(&dense.state_at(offset)));
            }
            let bounds = dense.bounds(0.0, span);
            assert_eq!(bounds, dense.find_bounds(0.0, span));
            for eighth in 0..=8 {
                let moving = dense.moving_at(span * f64::from(eighth) / 8.0);
                let away = (moving.velocity - bounds.velocity.center).length();
                assert!(away <= bounds.velocity.radius * (1.0 + 1e-12) + 1e-15);
                assert!(moving.angular_velocity.abs() <= bounds.angular_speed * (1.0 + 1e-12));
            }
        }
    }
}
