//! From path specifications to oriented paths: nesting by the even-odd rule, the solid on the left of every edge.

use crate::error::ShapeError;
use crate::path::{Path, PathSpec, build_path, coincidence_tol, outline_size};
use crate::simple::find_meeting;

/// Builds the paths of an outline, turned so that the solid lies on the left of every edge.
pub(crate) fn build_outline(specs: &[PathSpec]) -> Result<Vec<Path>, ShapeError> {
    if specs.is_empty() {
        return Err(ShapeError::NoPaths);
    }
    for (path, spec) in specs.iter().enumerate() {
        if let Some(edge) = spec.first_not_finite() {
            return Err(ShapeError::NotFinite { path, edge });
        }
    }
    let size = outline_size(specs);
    let drawn: Vec<Path> = specs
        .iter()
        .enumerate()
        .map(|(index, spec)| build_path(spec, index, size))
        .collect::<Result<_, _>>()?;
    if let Some(meeting) = find_meeting(&drawn, coincidence_tol(size)) {
        return Err(meeting.into());
    }
    Ok(drawn.iter().enumerate().map(|(index, path)| oriented(path, index, &drawn)).collect())
}

/// Returns the path run so that the solid is on its left. The solid lies inside of a path that an even number of other
/// paths surround.
fn oriented(path: &Path, index: usize, all: &[Path]) -> Path {
    let start = path.edges()[0].from();
    let depth =
        all.iter().enumerate().filter(|&(other, around)| other != index && around.surrounds(start)).count();
    let solid_inside = depth % 2 == 0;
    if runs_counter_clockwise(path) == solid_inside { path.clone() } else { path.reversed() }
}

fn runs_counter_clockwise(path: &Path) -> bool {
    crate::mass::MassProperties::of_paths(std::slice::from_ref(path), path.bounds().center()).area > 0.0
}
