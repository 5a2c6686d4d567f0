//! Ready-made shapes.

use crate::edge_spec::EdgeSpec;
use crate::error::ShapeError;
use crate::path::{PathSpec, coincidence_tol};
use crate::shape::Shape;
use glam::DVec2;

impl Shape {
    /// A disc of the given radius [m] about the origin.
    ///
    /// # Errors
    /// A radius [m] that is not positive and finite.
    pub fn disc(radius: f64) -> Result<Self, ShapeError> {
        check_length("radius", radius)?;
        Self::from_paths(&[PathSpec::circle(DVec2::ZERO, radius)])
    }

    /// A rectangle of the given width (along x) and height [m] about the origin.
    ///
    /// # Errors
    /// A side [m] that is not positive and finite.
    pub fn block(width: f64, height: f64) -> Result<Self, ShapeError> {
        check_length("width", width)?;
        check_length("height", height)?;
        let corner = DVec2::new(width / 2.0, height / 2.0);
        let flip = DVec2::new(-corner.x, corner.y);
        Self::polygon(&[-corner, -flip, corner, flip])
    }

    /// A rectangle of the given width (along x) and height [m] about the origin whose corners are quarter circles of
    /// the given radius [m].
    ///
    /// # Errors
    /// A side or radius [m] that is not positive and finite, or a radius of more than half a side. Half a side but for
    /// rounding counts as half, and leaves no straight part of that side.
    pub fn rounded_block(width: f64, height: f64, radius: f64) -> Result<Self, ShapeError> {
        check_length("width", width)?;
        check_length("height", height)?;
        check_length("radius", radius)?;
        let half = DVec2::new(width / 2.0, height / 2.0);
        let (largest, rounding) = (half.min_element(), coincidence_tol(2.0 * half.max_element()));
        if radius > largest + rounding {
            let (name, rule, limit) = ("radius", "at most", largest);
            return Err(ShapeError::OutOfRange { name, value: radius, rule, limit });
        }
        let radius = if radius < largest - rounding { radius } else { largest };
        let inner = half - DVec2::splat(radius);
        let mut path = PathSpec { start: DVec2::new(-inner.x, -half.y), edges: Vec::new() };
        let corners = [(1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)];
        for (quarter, &(x, y)) in corners.iter().enumerate() {
            let center = inner * DVec2::new(x, y);
            let (below, beside) =
                (center + DVec2::new(0.0, y * radius), center + DVec2::new(x * radius, 0.0));
            let (first, last) = if quarter % 2 == 0 { (below, beside) } else { (beside, below) };
            let straight = if quarter % 2 == 0 { inner.x } else { inner.y };
            if straight > 0.0 {
                path.edges.push(EdgeSpec::Line { to: first });
            }
            path.edges.push(EdgeSpec::Arc { to: last, center, clockwise: false });
        }
        Self::from_paths(&[path])
    }

    /// The polygon with the given vertices [m], in either direction.
    ///
    /// # Errors
    /// Fewer than three vertices, coincident vertices, or edges that cross.
    pub fn polygon(vertices: &[DVec2]) -> Result<Self, ShapeError> {
        if vertices.len() < 3 {
            return Err(ShapeError::TooFewVertices(vertices.len()));
        }
        Self::from_paths(&[PathSpec::polygon(vertices)])
    }

    /// The ring between two circles about the origin, of the given outer and inner radii [m].
    ///
    /// # Errors
    /// A radius [m] that is not positive and finite, or an inner one that is not less than the outer one.
    pub fn ring(outer: f64, inner: f64) -> Result<Self, ShapeError> {
        check_length("outer", outer)?;
        check_length("inner", inner)?;
        if inner >= outer {
            let (name, rule, limit) = ("inner", "less than", outer);
            return Err(ShapeError::OutOfRange { name, value: inner, rule, limit });
        }
        Self::from_paths(&[PathSpec::circle(DVec2::ZERO, outer), PathSpec::circle(DVec2::ZERO, inner)])
    }
}

pub(crate) fn check_length(name: &'static str, value: f64) -> Result<(), ShapeError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(ShapeError::BadLength { name, value }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_block_has_the_moment_of_a_rectangle() {
        let block = Shape::block(2.0, 3.0).expect("a fine block").mass_properties();
        assert!((block.area - 6.0).abs() < 1e-14 && block.centroid.length() < 1e-15);
        assert!((block.moment_per_mass - 13.0 / 12.0).abs() < 1e-15 * 4.0);
    }

    #[test]
    fn a_ring_has_a_hole() {
        let ring = Shape::ring(2.0, 1.0).expect("a fine ring");
        let mass = ring.mass_properties();
        assert!((mass.area - 3.0 * PI).abs() < 1e-14);
        assert!((mass.moment_per_mass - 2.5).abs() < 1e-14);
        assert_eq!(ring.features().len(), 2);
        assert_eq!(ring.reach(), 2.0);
    }

    #[test]
    fn a_rounded_block_is_smooth() {
        let shape = Shape::rounded_block(3.0, 2.0, 0.5).expect("a fine block");
        assert_eq!(shape.features().len(), 8, "four arcs, four lines and no vertex");
        let expected = 6.0 - (4.0 - PI) * 0.25;
        assert!((shape.mass_properties().area - expected).abs() < 1e-14);
        let stadium = Shape::rounded_block(3.0, 2.0, 1.0).expect("a fine stadium");
        assert_eq!(stadium.features().len(), 6, "a side without a straight part has none");
        // Sums and products are rounded to either side of the half.
        for (side, radius) in [(0.1 + 0.2, 0.15), (0.3, 3.0 * 0.05)] {
            assert!(side / 2.0 != radius);
            let rounded = Shape::rounded_block(1.0, side, radius).expect("a stadium");
            assert_eq!(rounded.features().len(), 6);
        }
    }
}
