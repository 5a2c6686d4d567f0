//! Placements of a body in the plane: a rotation about the body's origin, then a shift.

use crate::sine::sin_cos;
use glam::DVec2;

/// A rotation, kept as its cosine and sine.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Rotation {
    /// Cosine of the angle.
    pub cos: f64,
    /// Sine of the angle.
    pub sin: f64,
}

impl Rotation {
    /// No rotation.
    pub const IDENTITY: Rotation = Rotation { cos: 1.0, sin: 0.0 };

    /// The rotation by `angle` [rad], counter-clockwise.
    #[must_use]
    #[inline]
    pub fn from_angle(angle: f64) -> Self {
        // Most bodies of most scenes do not turn: spare them the reduction of the argument.
        if angle == 0.0 {
            return Self::IDENTITY;
        }
        let (sin, cos) = sin_cos(angle);
        Self { cos, sin }
    }

    /// Turns a vector by the rotation.
    #[must_use]
    #[inline]
    pub fn apply(self, v: DVec2) -> DVec2 {
        DVec2::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }

    /// Turns a vector back: the inverse of [`apply`](Self::apply).
    #[must_use]
    #[inline]
    pub fn unapply(self, v: DVec2) -> DVec2 {
        DVec2::new(self.cos * v.x + self.sin * v.y, self.cos * v.y - self.sin * v.x)
    }
}

/// Placement of a body: body coordinates are turned about the body's origin, then shifted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Pose {
    /// World position [m] of the body's origin.
    pub position: DVec2,
    /// Rotation from body to world coordinates.
    pub rotation: Rotation,
}

impl Pose {
    /// The pose at which body coordinates are world coordinates.
    pub const IDENTITY: Pose = Pose { position: DVec2::ZERO, rotation: Rotation::IDENTITY };

    /// The pose at `position` [m], turned by `angle` [rad] counter-clockwise.
    #[must_use]
    #[inline]
    pub fn new(position: DVec2, angle: f64) -> Self {
        Self { position, rotation: Rotation::from_angle(angle) }
    }

    /// True if all numbers of the pose are finite.
    #[must_use]
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.rotation.cos.is_finite() && self.rotation.sin.is_finite()
    }

    /// World coordinates [m] of a point given in body coordinates [m].
    #[must_use]
    #[inline]
    pub fn point_to_world(&self, body_point: DVec2) -> DVec2 {
        self.position + self.rotation.apply(body_point)
    }

    /// Body coordinates [m] of a point given in world coordinates [m].
    #[must_use]
    #[inline]
    pub fn point_to_body(&self, world_point: DVec2) -> DVec2 {
        self.rotation.unapply(world_point - self.position)
    }

    /// This pose in the body coordinates of another pose.
    #[must_use]
    #[inline]
    pub fn seen_from(&self, other: &Pose) -> Self {
        let (own, its) = (self.rotation, other.rotation);
        let direction = its.unapply(DVec2::new(own.cos, own.sin));
        let rotation = Rotation { cos: direction.x, sin: direction.y };
        Self { position: other.point_to_body(self.position), rotation }
    }

    /// World components of a vector given in body coordinates.
    #[must_use]
    #[inline]
    pub fn vector_to_world(&self, body_vector: DVec2) -> DVec2 {
        self.rotation.apply(body_vector)
    }

    /// Body components of a vector given in world coordinates.
    #[must_use]
    #[inline]
    pub fn vector_to_body(&self, world_vector: DVec2) -> DVec2 {
        self.rotation.unapply(world_vector)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn going_to_the_world_and_back_is_the_identity() {
        let pose = Pose::new(DVec2::new(3.0, -2.0), 0.7);
        let p = DVec2::new(0.3, 1.9);
        assert!((pose.point_to_body(pose.point_to_world(p)) - p).length() < 1e-15 * 8.0);
        assert!((pose.vector_to_body(pose.vector_to_world(p)) - p).length() < 1e-15 * 8.0);
    }

    #[test]
    fn seen_from_another_pose_points_are_where_they_are() {
        let (pose, other) = (Pose::new(DVec2::new(3.0, -2.0), 0.7), Pose::new(DVec2::new(-1.0, 0.5), -2.1));
        let p = DVec2::new(0.3, 1.9);
        let seen = pose.seen_from(&other).point_to_world(p);
        assert!((other.point_to_world(seen) - pose.point_to_world(p)).length() < 1e-15 * 8.0);
    }

    #[test]
    fn a_quarter_turn_takes_x_to_y() {
        let turned = Rotation::from_angle(std::f64::consts::FRAC_PI_2).apply(DVec2::X);
        assert!((turned - DVec2::Y).length() < 1e-15);
    }
}
