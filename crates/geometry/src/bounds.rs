//! Axis-aligned boxes.

use glam::DVec2;

/// An axis-aligned box, never empty.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Aabb {
    /// Lower left corner [m].
    pub min: DVec2,
    /// Upper right corner [m].
    pub max: DVec2,
}

impl Aabb {
    /// The box that holds only one point [m].
    #[must_use]
    #[inline]
    pub fn around(point: DVec2) -> Self {
        Self { min: point, max: point }
    }

    /// The box around a disc of the given center and radius [m].
    #[must_use]
    #[inline]
    pub fn around_disc(center: DVec2, radius: f64) -> Self {
        Self { min: center - DVec2::splat(radius), max: center + DVec2::splat(radius) }
    }

    /// The least box around this one and a point [m].
    #[must_use]
    #[inline]
    pub fn including(self, point: DVec2) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The least box around this one and another.
    #[must_use]
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The box grown by `margin` [m] on every side.
    #[must_use]
    #[inline]
    pub fn grown(self, margin: f64) -> Self {
        Self { min: self.min - DVec2::splat(margin), max: self.max + DVec2::splat(margin) }
    }

    /// True if the boxes share a point.
    #[must_use]
    #[inline]
    pub fn overlaps(&self, other: &Self) -> bool {
        // Without branches: near a tree's leaves none of the four comparisons is predictable.
        (self.min.x <= other.max.x)
            & (other.min.x <= self.max.x)
            & (self.min.y <= other.max.y)
            & (other.min.y <= self.max.y)
    }

    /// True if all of `other` lies inside.
    #[must_use]
    #[inline]
    pub fn contains(&self, other: &Self) -> bool {
        self.min.x <= other.min.x
            && self.min.y <= other.min.y
            && self.max.x >= other.max.x
            && self.max.y >= other.max.y
    }

    /// Middle of the box [m].
    #[must_use]
    #[inline]
    pub fn center(&self) -> DVec2 {
        0.5 * (self.min + self.max)
    }

    /// Width and height [m].
    #[must_use]
    #[inline]
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// Half of the perimeter [m]: the cost that a tree of boxes keeps small.
    #[must_use]
    #[inline]
    pub fn half_perimeter(&self) -> f64 {
        self.size().element_sum()
    }

    /// Distance [m] of a point [m] from the box, 0 inside.
    #[must_use]
    #[inline]
    pub fn distance_to(&self, point: DVec2) -> f64 {
        self.distance_squared_to(point).sqrt()
    }

    /// Square [m^2] of the distance of a point from the box, 0 inside.
    #[must_use]
    #[inline]
    pub(crate) fn distance_squared_to(&self, point: DVec2) -> f64 {
        let outside = (self.min - point).max(point - self.max).max(DVec2::ZERO);
        outside.length_squared()
    }
}
