//! A straight edge.

use crate::error::LineError;
use crate::pose::Pose;
use glam::DVec2;

/// A straight edge from one point to another, with the solid on its left.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Line {
    from: DVec2,
    to: DVec2,
    direction: DVec2,
    length: f64,
}

impl Line {
    /// The edge between two points [m].
    ///
    /// # Errors
    /// A point that is not finite, two points that coincide, or points so far apart that the square of their distance
    /// overflows.
    pub fn new(from: DVec2, to: DVec2) -> Result<Self, LineError> {
        if !(from.is_finite() && to.is_finite()) {
            return Err(LineError::NotFinite);
        }
        let length = (to - from).length();
        if length == 0.0 {
            return Err(LineError::ZeroLength(from.x, from.y));
        }
        if !length.is_finite() {
            return Err(LineError::NotFinite);
        }
        Ok(Self { from, to, direction: (to - from) / length, length })
    }

    /// First point [m].
    #[must_use]
    #[inline]
    pub fn from(&self) -> DVec2 {
        self.from
    }

    /// Last point [m].
    #[must_use]
    #[inline]
    pub fn to(&self) -> DVec2 {
        self.to
    }

    /// Unit vector of travel.
    #[must_use]
    #[inline]
    pub fn direction(&self) -> DVec2 {
        self.direction
    }

    /// Outward unit normal: on the right of the direction of travel.
    #[must_use]
    #[inline]
    pub fn normal(&self) -> DVec2 {
        DVec2::new(self.direction.y, -self.direction.x)
    }

    /// Length [m].
    #[must_use]
    #[inline]
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The edge run the other way.
    #[must_use]
    #[inline]
    pub fn reversed(&self) -> Self {
        Self { from: self.to, to: self.from, direction: -self.direction, length: self.length }
    }

    /// The edge shifted by `shift` [m].
    #[must_use]
    #[inline]
    pub fn translated(&self, shift: DVec2) -> Self {
        Self { from: self.from + shift, to: self.to + shift, ..*self }
    }

    /// The edge in world coordinates, as a body at the given pose carries it.
    #[must_use]
    #[inline]
    pub fn posed(&self, pose: &Pose) -> Self {
        Self {
            from: pose.point_to_world(self.from),
            to: pose.point_to_world(self.to),
            direction: pose.vector_to_world(self.direction),
            ..*self
        }
    }

    /// Signed distance [m] of a point [m] from the infinite line, positive on the side away from the solid.
    #[must_use]
    #[inline]
    pub fn signed_distance(&self, point: DVec2) -> f64 {
        self.normal().dot(point - self.from)
    }

    /// Point of the edge nearest to `point` [m].
    #[must_use]
    #[inline]
    pub fn nearest(&self, point: DVec2) -> DVec2 {
        let along = self.direction.dot(point - self.from);
        if along <= 0.0 {
            self.from
        } else if along >= self.length {
            self.to
        } else {
            self.from + self.direction * along
        }
    }
}
