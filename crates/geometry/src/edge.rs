//! An edge of an outline: a line or an arc.

use crate::arc::Arc;
use crate::bounds::Aabb;
use crate::line::Line;
use crate::pose::Pose;
use glam::DVec2;

/// An edge, run with the solid on its left.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum Edge {
    /// A straight edge.
    Line(Line),
    /// A circular edge.
    Arc(Arc),
}

impl Edge {
    /// First point [m].
    #[must_use]
    #[inline]
    pub fn from(&self) -> DVec2 {
        match self {
            Edge::Line(line) => line.from(),
            Edge::Arc(arc) => arc.from(),
        }
    }

    /// Last point [m].
    #[must_use]
    #[inline]
    pub fn to(&self) -> DVec2 {
        match self {
            Edge::Line(line) => line.to(),
            Edge::Arc(arc) => arc.to(),
        }
    }

    /// Length [m].
    #[must_use]
    #[inline]
    pub fn length(&self) -> f64 {
        match self {
            Edge::Line(line) => line.length(),
            Edge::Arc(arc) => arc.length(),
        }
    }

    /// Unit vector of travel at the first point.
    #[must_use]
    #[inline]
    pub fn start_direction(&self) -> DVec2 {
        match self {
            Edge::Line(line) => line.direction(),
            Edge::Arc(arc) => arc.start_direction(),
        }
    }

    /// Unit vector of travel at the last point.
    #[must_use]
    #[inline]
    pub fn end_direction(&self) -> DVec2 {
        match self {
            Edge::Line(line) => line.direction(),
            Edge::Arc(arc) => arc.end_direction(),
        }
    }

    /// Signed curvature [1/m]: positive for a convex arc, negative for a concave one, 0 for a line.
    #[must_use]
    #[inline]
    pub fn curvature(&self) -> f64 {
        match self {
            Edge::Line(_) => 0.0,
            Edge::Arc(arc) if arc.is_convex() => 1.0 / arc.radius(),
            Edge::Arc(arc) => -1.0 / arc.radius(),
        }
    }

    /// The edge run the other way.
    #[must_use]
    #[inline]
    pub fn reversed(&self) -> Self {
        match self {
            Edge::Line(line) => Edge::Line(line.reversed()),
            Edge::Arc(arc) => Edge::Arc(arc.reversed()),
        }
    }

    /// The edge shifted by `shift` [m].
    #[must_use]
    #[inline]
    pub fn translated(&self, shift: DVec2) -> Self {
        match self {
            Edge::Line(line) => Edge::Line(line.translated(shift)),
            Edge::Arc(arc) => Edge::Arc(arc.translated(shift)),
        }
    }

    /// The edge in world coordinates, as a body at the given pose carries it.
    #[must_use]
    #[inline]
    pub fn posed(&self, pose: &Pose) -> Self {
        match self {
            Edge::Line(line) => Edge::Line(line.posed(pose)),
            Edge::Arc(arc) => Edge::Arc(arc.posed(pose)),
        }
    }

    /// Outward unit normal at a point [m] of the edge.
    #[must_use]
    #[inline]
    pub fn normal_at(&self, point: DVec2) -> DVec2 {
        match self {
            Edge::Line(line) => line.normal(),
            Edge::Arc(arc) => {
                let away = (point - arc.center()) / arc.radius();
                if arc.is_convex() { away } else { -away }
            }
        }
    }

    /// Signed distance [m] of a point [m] from the edge's infinite line or whole circle, positive away from the solid.
    #[must_use]
    #[inline]
    pub fn signed_distance(&self, point: DVec2) -> f64 {
        match self {
            Edge::Line(line) => line.signed_distance(point),
            Edge::Arc(arc) => arc.signed_distance(point),
        }
    }

    /// Point of the edge nearest to `point` [m].
    #[must_use]
    #[inline]
    pub fn nearest(&self, point: DVec2) -> DVec2 {
        match self {
            Edge::Line(line) => line.nearest(point),
            Edge::Arc(arc) => arc.nearest(point),
        }
    }

    /// Smallest axis-aligned box [m] around the edge.
    #[must_use]
    #[inline]
    pub fn bounds(&self) -> Aabb {
        let ends = Aabb::around(self.from()).including(self.to());
        let Edge::Arc(arc) = self else { return ends };
        let directions = arc.directions();
        [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y]
            .into_iter()
            .filter(|&axis| directions.contains(axis))
            .fold(ends, |bounds, axis| bounds.including(arc.center() + axis * arc.radius()))
    }
}
