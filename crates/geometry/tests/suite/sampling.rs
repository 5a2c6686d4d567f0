//! Points along outlines, computed apart from the code under test.

use halfgap_geometry::{DVec2, Edge, Shape};

/// Sampled points per edge.
pub(crate) const SAMPLES: u32 = 64;

/// The point of an edge at a fraction of its length.
pub(crate) fn point_at(edge: &Edge, share: f64) -> DVec2 {
    match edge {
        Edge::Line(line) => line.from() + (line.to() - line.from()) * share,
        Edge::Arc(arc) => {
            let angle = arc.start_angle() + arc.sweep_angle() * share;
            arc.center() + DVec2::new(angle.cos(), angle.sin()) * arc.radius()
        }
    }
}

/// Points along one edge, both ends included.
pub(crate) fn edge_points(edge: &Edge) -> impl Iterator<Item = DVec2> {
    (0..=SAMPLES).map(|step| point_at(edge, f64::from(step) / f64::from(SAMPLES)))
}

/// Points along the whole outline.
pub(crate) fn outline_points(shape: &Shape) -> Vec<DVec2> {
    shape.edges().flat_map(edge_points).collect()
}

/// Largest distance [m] of a point of the outline from the next sample.
pub(crate) fn coarseness(shape: &Shape) -> f64 {
    let longest = shape.edges().map(Edge::length).fold(0.0, f64::max);
    0.5 * longest / f64::from(SAMPLES)
}

/// True if an odd number of the sampled outline's chords cross the ray from the point towards +x.
pub(crate) fn sampled_contains(shape: &Shape, point: DVec2) -> bool {
    let crosses = |pair: &[DVec2]| {
        let (from, to) = (pair[0] - point, pair[1] - point);
        (from.y > 0.0) != (to.y > 0.0) && from.x + (to.x - from.x) * from.y / (from.y - to.y) > 0.0
    };
    let mut odd = false;
    for edge in shape.edges() {
        let mut points: Vec<DVec2> = edge_points(edge).collect();
        // The exact ends, so that neighbours leave no chink.
        points[0] = edge.from();
        points[SAMPLES as usize] = edge.to();
        odd ^= points.windows(2).filter(|pair| crosses(pair)).count() % 2 == 1;
    }
    odd
}
