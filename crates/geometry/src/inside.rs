//! Is a point inside a shape?
//!
//! Paths run with the solid on their left, so they wind once around each point of the solid and not at all
//! around any other. The winding number is counted along the ray from the point towards +x; an arc counts as
//! its chord and the circular segment between arc and chord, so that no crossing is ever computed. The tree skips edges
//! that the ray does not meet; its boxes hold the exact ends of the edges, so that nothing is lost to rounding.

use crate::path::winding;
use crate::shape::Shape;
use crate::tree::Node;
use glam::DVec2;

impl Shape {
    /// True if the point [m], in body coordinates, lies in the solid: not in a hole, and not outside.
    ///
    /// On the outline itself the answer is either.
    ///
    /// # Examples
    ///
    /// ```
    /// # use halfgap_geometry::{DVec2, Shape};
    /// let ring = Shape::ring(2.0, 1.0)?;
    /// assert!(ring.contains(DVec2::new(0.0, 1.5)));
    /// assert!(!ring.contains(DVec2::new(0.0, 0.5)));
    /// # Ok::<(), halfgap_geometry::ShapeError>(())
    /// ```
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        let is_met = |node: &Node| {
            let bounds = &node.bounds;
            bounds.max.x >= point.x && bounds.min.y <= point.y && bounds.max.y >= point.y
        };
        let mut turns = 0;
        self.tree().visit_where(&is_met, &mut |feature| {
            if let Some(id) = self.whole_edge(feature) {
                turns += winding(self.edge(id), point);
            }
        });
        turns != 0
    }
}
