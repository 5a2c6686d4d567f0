//! Mass properties against numerical integration around the outline.

use crate::sampling::point_at;
use crate::shapes::any_shape;
use halfgap_geometry::{DVec2, Edge, Shape};
use proptest::prelude::*;

/// Area, first moments and polar second moment about the origin, by Green's theorem and the three-point Gauss
/// rule along each edge.
fn integrate(shape: &Shape) -> (f64, DVec2, f64) {
    const PANELS: u32 = 400;
    let node = 0.15_f64.sqrt();
    let (mut area, mut first, mut polar) = (0.0, DVec2::ZERO, 0.0);
    for edge in shape.edges() {
        for panel in 0..PANELS {
            let share = |part: f64| (f64::from(panel) + part) / f64::from(PANELS);
            for (part, weight) in [(0.5 - node, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + node, 5.0 / 18.0)] {
                let p = point_at(edge, share(part));
                let d = derivative(edge, p) * (weight / f64::from(PANELS));
                area += 0.5 * (p.x * d.y - p.y * d.x);
                first += DVec2::new(p.x * p.x / 2.0 * d.y, -p.y * p.y / 2.0 * d.x);
                polar += p.x * p.x * p.x / 3.0 * d.y - p.y * p.y * p.y / 3.0 * d.x;
            }
        }
    }
    (area, first, polar)
}

/// Derivative of the point of an edge by the fraction of its length.
fn derivative(edge: &Edge, point: DVec2) -> DVec2 {
    match edge {
        Edge::Line(line) => line.to() - line.from(),
        Edge::Arc(arc) => (point - arc.center()).perp() * arc.sweep_angle(),
    }
}

proptest! {
    #[test]
    fn mass_properties_match_quadrature(shape in any_shape()) {
        let mass = shape.mass_properties();
        let (area, first, polar) = integrate(&shape);
        // The mass properties of a flat arc are as exact as the place of its far center.
        let radius = |edge: &Edge| if let Edge::Arc(arc) = edge { arc.radius() } else { 0.0 };
        let flatness = 1e-3 * shape.edges().map(radius).fold(0.0, f64::max);
        let scale = 1.0 + shape.reach() * shape.reach() + flatness;
        prop_assert!(area > 0.0 && (mass.area - area).abs() < 1e-12 * scale, "{} {area}", mass.area);
        prop_assert!((mass.centroid * area - first).length() < 1e-12 * scale * scale);
        let about_origin = mass.moment_per_mass + mass.centroid.length_squared();
        prop_assert!((about_origin * area - polar).abs() < 1e-12 * scale * scale);
    }

    #[test]
    fn a_shift_moves_the_centroid_and_nothing_else(shape in any_shape(), x in -1e3..1e3) {
        let (here, there) = (shape.mass_properties(), shape.translated(DVec2::new(x, 2.0)).mass_properties());
        prop_assert!((here.area - there.area).abs() < 1e-12 * (1.0 + x.abs()));
        prop_assert!((here.centroid + DVec2::new(x, 2.0) - there.centroid).length() < 1e-11 * (1.0 + x.abs()));
        prop_assert!((here.moment_per_mass - there.moment_per_mass).abs() < 1e-10 * (1.0 + x.abs()));
    }
}
