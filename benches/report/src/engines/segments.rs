//! Outlines cut into segments, for engines that know no arcs.

use glam::DVec2;
use halfgap::geometry::{Edge, PathSpec, Shape};
use std::f64::consts::TAU;

/// The corners of each closed path of an outline, with the solid on the left of the walk along them; arcs are cut into
/// pieces of a turn over `per_turn` or less, with corners on the arc.
///
/// # Errors
/// The outline is none.
pub(super) fn corners(paths: &[PathSpec], per_turn: usize) -> Result<Vec<Vec<DVec2>>, String> {
    let shape = Shape::from_paths(paths).map_err(|error| error.to_string())?;
    let walk = |edges: &[Edge]| edges.iter().flat_map(|edge| pieces(edge, per_turn)).collect();
    Ok(shape.paths().iter().map(|path| walk(path.edges())).collect())
}

/// The first corner of each piece of an edge.
fn pieces(edge: &Edge, per_turn: usize) -> Vec<DVec2> {
    match edge {
        Edge::Line(_) => vec![edge.from()],
        Edge::Arc(arc) => {
            let sweep = arc.sweep_angle();
            let count = (sweep.abs() / TAU * per_turn as f64).ceil().max(1.0);
            let angle = |index: u32| arc.start_angle() + sweep * f64::from(index) / count;
            let inner =
                (1..count as u32).map(|index| arc.center() + DVec2::from_angle(angle(index)) * arc.radius());
            std::iter::once(edge.from()).chain(inner).collect()
        }
    }
}
