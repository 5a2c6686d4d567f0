//! The point of a shape's outline nearest to a given point.

use crate::feature::EdgeId;
use crate::shape::Shape;
use crate::tree::Node;
use glam::DVec2;

/// The nearest point of an outline, in body coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoint {
    /// Nearest point of the outline [m].
    pub point: DVec2,
    /// Edge on which the point lies; at a vertex either of the two.
    pub edge: EdgeId,
    /// Outward unit normal of `edge` at the point. At a vertex it need not point towards the query point.
    pub normal: DVec2,
    /// Signed distance [m] of the query point from the outline, negative inside the solid.
    pub signed_distance: f64,
}

impl Shape {
    /// Finds the point of the outline nearest to a point [m] in body coordinates.
    ///
    /// The sign of the distance is that of [`contains`](Self::contains). Where several points of the outline
    /// are equally near, one of them is returned, on each call the same.
    ///
    /// # Examples
    ///
    /// ```
    /// # use halfgap_geometry::{DVec2, Shape};
    /// let block = Shape::block(2.0, 1.0)?;
    /// let near = block.nearest(DVec2::new(0.3, 0.4));
    /// assert!((near.signed_distance + 0.1).abs() < 1e-15);
    /// assert_eq!(near.normal, DVec2::Y);
    /// # Ok::<(), halfgap_geometry::ShapeError>(())
    /// ```
    ///
    /// # Panics
    /// If a coordinate of the point is not a number, or the square of its distance overflows (from about 1e150 m on).
    #[must_use]
    pub fn nearest(&self, point: DVec2) -> NearestPoint {
        let bound =
            |node: &Node| node.bounds.distance_to(point).max((node.center - point).length() - node.radius);
        let found = self.tree().find_least(f64::INFINITY, &bound, &mut |feature| {
            let id = self.whole_edge(feature)?;
            let nearest = self.edge(id).nearest(point);
            Some(((nearest - point).length(), (nearest, id)))
        });
        let (distance, (nearest, id)) =
            found.expect("a shape has edges, and the point's coordinates are numbers");
        let signed_distance = if self.contains(point) { -distance } else { distance };
        NearestPoint { point: nearest, edge: id, normal: self.edge(id).normal_at(nearest), signed_distance }
    }
}
