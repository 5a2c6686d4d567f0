//! The scenes: a file each, with how its answer is known.

mod exact;

use crate::scene::Scene;

/// All scenes, in the order of the report.
#[must_use]
pub fn all() -> Vec<Scene> {
    let mut scenes = exact::scenes();
    scenes.shrink_to_fit();
    scenes
}
