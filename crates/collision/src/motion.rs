//! Position and velocity of a body, at a moment and over an interval.

use glam::DVec2;
use halfgap_geometry::Pose;

/// Position, angle and velocities of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyState {
    /// Centre of mass [m].
    pub position: DVec2,
    /// Angle [rad], counter-clockwise positive, not reduced to one turn.
    pub angle: f64,
    /// Velocity of the centre of mass [m/s].
    pub velocity: DVec2,
    /// Angular velocity [rad/s].
    pub angular_velocity: f64,
}

impl BodyState {
    /// The pose at the state's position and angle.
    #[must_use]
    #[inline]
    pub fn pose(&self) -> Pose {
        Pose::new(self.position, self.angle)
    }
}

/// Pose and velocities of a body at one moment: a [`BodyState`] whose rotation is already computed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Moving {
    /// Pose of the body, its origin at the centre of mass.
    pub pose: Pose,
    /// Angle [rad] of the pose, which may include whole turns.
    pub angle: f64,
    /// Velocity of the centre of mass [m/s].
    pub velocity: DVec2,
    /// Angular velocity [rad/s].
    pub angular_velocity: f64,
}

impl Moving {
    /// The immovable background, at rest at the origin.
    pub const BACKGROUND: Moving =
        Moving { pose: Pose::IDENTITY, angle: 0.0, velocity: DVec2::ZERO, angular_velocity: 0.0 };

    /// Velocity [m/s] of the material point with the given arm from the centre of mass [m].
    #[must_use]
    #[inline]
    pub fn velocity_at(&self, arm: DVec2) -> DVec2 {
        self.velocity + arm.perp() * self.angular_velocity
    }
}

impl From<&BodyState> for Moving {
    #[inline]
    fn from(state: &BodyState) -> Self {
        let BodyState { angle, velocity, angular_velocity, .. } = *state;
        Self { pose: state.pose(), angle, velocity, angular_velocity }
    }
}

/// All vectors within some distance of a centre: a bound with a direction, so that parts common to two bodies cancel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Ball {
    /// Centre, in the unit of the bounded quantity.
    pub center: DVec2,
    /// Radius, in the unit of the bounded quantity.
    pub radius: f64,
}

impl Ball {
    /// Largest size of the difference between a vector of this ball and one of the other, in the unit of the quantity.
    #[must_use]
    #[inline]
    pub fn largest_difference(&self, other: &Ball) -> f64 {
        (self.center - other.center).length() + self.radius + other.radius
    }

    /// All differences of a vector of this ball and a vector of the other.
    #[must_use]
    #[inline]
    pub fn minus(&self, other: &Ball) -> Ball {
        Ball { center: self.center - other.center, radius: self.radius + other.radius }
    }

    /// The ball of the opposite vectors.
    #[must_use]
    #[inline]
    pub fn mirrored(&self) -> Ball {
        Ball { center: -self.center, radius: self.radius }
    }

    /// Largest size of a vector of the ball, in the unit of the quantity.
    #[must_use]
    #[inline]
    pub fn largest(&self) -> f64 {
        self.center.length() + self.radius
    }
}

/// Bounds on a body's motion over an interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct MotionBounds {
    /// Velocity of the centre of mass [m/s].
    pub velocity: Ball,
    /// Acceleration of the centre of mass [m/s^2].
    pub acceleration: Ball,
    /// Largest angular speed [rad/s].
    pub angular_speed: f64,
    /// Largest angular acceleration in size [rad/s^2].
    pub angular_acceleration: f64,
}

impl MotionBounds {
    /// True if all numbers are finite.
    pub(crate) fn are_finite(&self) -> bool {
        let balls = [self.velocity, self.acceleration];
        balls.iter().all(|ball| ball.center.is_finite() && ball.radius.is_finite())
            && self.angular_speed.is_finite()
            && self.angular_acceleration.is_finite()
    }
}

/// A motion in which the centre of mass follows a parabola: position + velocity t + acceleration t^2/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial {
    /// Position at the start [m].
    pub position: DVec2,
    /// Velocity at the start [m/s].
    pub velocity: DVec2,
    /// Acceleration [m/s^2].
    pub acceleration: DVec2,
}

/// The motion of a body along a segment, as a function of the offset [s] from the segment's start.
pub trait Motion {
    /// Position and velocity at an offset [s].
    fn state_at(&self, offset: f64) -> BodyState;

    /// Pose and velocities at an offset [s].
    fn moving_at(&self, offset: f64) -> Moving {
        Moving::from(&self.state_at(offset))
    }

    /// Position [m] and velocity [m/s] of the centre of mass at an offset [s].
    fn center_at(&self, offset: f64) -> (DVec2, DVec2) {
        let state = self.state_at(offset);
        (state.position, state.velocity)
    }

    /// Bounds that hold between two offsets [s].
    fn bounds(&self, from: f64, to: f64) -> MotionBounds;

    /// The parabola of the centre of mass from an offset [s] on, its t = 0 at the offset; `None` if it follows another
    /// curve.
    fn polynomial_from(&self, offset: f64) -> Option<Polynomial>;

    /// True if the body does not turn during the segment.
    fn is_rotation_free(&self) -> bool;
}

/// The motion of a body's centre of mass, without the body's turning.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Center<'a, M>(pub(crate) &'a M);

impl<M: Motion> Motion for Center<'_, M> {
    fn state_at(&self, offset: f64) -> BodyState {
        let (position, velocity) = self.0.center_at(offset);
        BodyState { position, velocity, ..BodyState::default() }
    }

    fn moving_at(&self, offset: f64) -> Moving {
        let (position, velocity) = self.0.center_at(offset);
        let pose = Pose { position, ..Pose::IDENTITY };
        Moving { pose, velocity, ..Moving::BACKGROUND }
    }

    fn center_at(&self, offset: f64) -> (DVec2, DVec2) {
        self.0.center_at(offset)
    }

    fn bounds(&self, from: f64, to: f64) -> MotionBounds {
        MotionBounds { angular_speed: 0.0, angular_acceleration: 0.0, ..self.0.bounds(from, to) }
    }

    fn polynomial_from(&self, offset: f64) -> Option<Polynomial> {
        self.0.polynomial_from(offset)
    }

    fn is_rotation_free(&self) -> bool {
        true
    }
}
