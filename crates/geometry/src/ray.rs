//! The first point at which a ray meets the outline of a shape.
//!
//! A line is met if its ends lie on different sides of the ray (the end itself counts, and neighbours share their end,
//! so no ray slips through between them); a circle is met half a chord before and after the centre's foot on the ray,
//! and the point counts if it lies on the arc, to rounding. The tree skips boxes that the ray misses.

use crate::arc::Arc;
use crate::bounds::Aabb;
use crate::edge::Edge;
use crate::feature::EdgeId;
use crate::line::Line;
use crate::shape::Shape;
use crate::tree::Node;
use glam::DVec2;

/// Rounding of a meeting point, as a fraction of the lengths involved [-]: for an arc, the distances of the ray's
/// origin and the arc's centre from the body's origin plus the radius, over the slope of the crossing; for a box, the
/// distance of the ray's origin from the body's origin plus that from the farthest side of the box.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A ray in body coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start of the ray [m].
    pub origin: DVec2,
    /// Direction of the ray, of any length but zero.
    pub direction: DVec2,
}

/// A point at which a ray meets an outline, in body coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Distance [m] from the ray's origin.
    pub distance: f64,
    /// Point at which the ray meets the outline [m].
    pub point: DVec2,
    /// Outward unit normal of the edge at the point: it points against a ray that enters the solid and along one that
    /// leaves it.
    pub normal: DVec2,
    /// Edge that the ray meets.
    pub edge: EdgeId,
}

impl Shape {
    /// Finds the first point within `max_distance` [m] at which a ray meets the outline, from outside or inside.
    ///
    /// A ray whose direction is zero or not finite meets nothing. Rounding decides whether a ray that starts on the
    /// outline meets it at once, and whether one that only touches an arc meets it.
    ///
    /// # Examples
    ///
    /// ```
    /// # use halfgap_geometry::{DVec2, Ray, Shape};
    /// let ring = Shape::ring(2.0, 1.0)?;
    /// let ray = Ray { origin: DVec2::ZERO, direction: DVec2::X };
    /// let hit = ring.cast_ray(&ray, f64::INFINITY).expect("it leaves the hole");
    /// assert!((hit.distance - 1.0).abs() < 1e-15 && hit.normal.x < 0.0);
    /// assert_eq!(ring.cast_ray(&ray, 0.5), None);
    /// # Ok::<(), halfgap_geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn cast_ray(&self, ray: &Ray, max_distance: f64) -> Option<RayHit> {
        let ray = ray.of_unit_direction()?;
        let inverse = ray.direction.recip();
        let bound = |node: &Node| ray.entry_into_box(&node.bounds, inverse);
        let limit = max_distance.next_up();
        let found = self.tree().find_least(limit, &bound, &mut |feature| {
            let id = self.whole_edge(feature)?;
            Some((ray.along_to(self.edge(id))?, id))
        });
        let (distance, edge) = found?;
        let point = ray.origin + ray.direction * distance;
        Some(RayHit { distance, point, normal: self.edge(edge).normal_at(point), edge })
    }
}

impl Ray {
    /// Distance [m] along the ray at which it first meets an edge; `None` if it misses, or if its direction is zero or
    /// not finite.
    #[must_use]
    #[inline]
    pub fn distance_to(&self, edge: &Edge) -> Option<f64> {
        self.of_unit_direction()?.along_to(edge)
    }

    /// The ray with its direction normalized; `None` if the direction is zero or not finite.
    fn of_unit_direction(&self) -> Option<Self> {
        // The square of a very long or very short direction over- or underflows.
        let size = self.direction.abs().max_element();
        let direction = (self.direction / size).try_normalize()?;
        Some(Self { direction, ..*self })
    }

    /// [`distance_to`](Self::distance_to) of a ray whose direction is a unit vector.
    fn along_to(&self, edge: &Edge) -> Option<f64> {
        match edge {
            Edge::Line(line) => self.distance_to_line(line),
            Edge::Arc(arc) => self.distance_to_arc(arc),
        }
    }

    fn distance_to_line(&self, line: &Line) -> Option<f64> {
        let (from, to) = (line.from() - self.origin, line.to() - self.origin);
        let (from_side, to_side) = (self.direction.perp_dot(from), self.direction.perp_dot(to));
        if from_side * to_side > 0.0 {
            return None;
        }
        let (from_along, to_along) = (self.direction.dot(from), self.direction.dot(to));
        if from_side == to_side {
            // The line lies along the ray.
            let (first, last) = (from_along.min(to_along), from_along.max(to_along));
            return (last >= 0.0).then(|| first.max(0.0));
        }
        let share = from_side / (from_side - to_side);
        let along = from_along + (to_along - from_along) * share;
        (along >= 0.0).then_some(along)
    }

    fn distance_to_arc(&self, arc: &Arc) -> Option<f64> {
        let to_center = arc.center() - self.origin;
        let across = self.direction.perp_dot(to_center).abs();
        let half_chord_sq = (arc.radius() - across) * (arc.radius() + across);
        if half_chord_sq < 0.0 {
            return None;
        }
        let foot = self.direction.dot(to_center);
        let half_chord = half_chord_sq.sqrt();
        let size = self.origin.length() + arc.center().length() + arc.radius();
        // The flatter the ray crosses the arc, the less exactly the crossing is known.
        let slope = (half_chord / arc.radius()).max(ROUNDING.sqrt());
        let slack = ROUNDING * size / slope;
        let is_met = |along: f64| {
            let direction = (self.direction * along - to_center) / arc.radius();
            along >= 0.0 && arc.directions().excess(direction) * arc.radius() <= slack
        };
        [foot - half_chord, foot + half_chord].into_iter().find(|&along| is_met(along))
    }

    /// Distance [m] along the ray at which it enters a box, reduced by rounding; infinite if it misses. `inverse` holds
    /// the reciprocals of the direction's components.
    fn entry_into_box(&self, bounds: &Aabb, inverse: DVec2) -> f64 {
        let reach = (bounds.min - self.origin).abs().max((bounds.max - self.origin).abs()).max_element();
        let slack = ROUNDING * (self.origin.length() + reach);
        let bounds = bounds.grown(slack);
        let (mut entry, mut exit) = (0.0_f64, f64::INFINITY);
        for axis in 0..2 {
            if self.direction[axis] == 0.0 {
                if self.origin[axis] < bounds.min[axis] || self.origin[axis] > bounds.max[axis] {
                    return f64::INFINITY;
                }
                continue;
            }
            let to_min = (bounds.min[axis] - self.origin[axis]) * inverse[axis];
            let to_max = (bounds.max[axis] - self.origin[axis]) * inverse[axis];
            entry = entry.max(to_min.min(to_max));
            exit = exit.min(to_min.max(to_max));
        }
        if entry - slack <= exit + slack { (entry - slack).max(0.0) } else { f64::INFINITY }
    }
}
