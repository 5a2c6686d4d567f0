//! The motion of a body that is moved: a law for each of its coordinates.

use super::MotionLaw;
use glam::DVec2;

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
}
