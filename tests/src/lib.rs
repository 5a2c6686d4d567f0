//! Scenarios that cross the layers of halfgap, and the scenes that they run.
//!
//! `mechanism` places bodies by hand; `generate` makes scenes from seeds, `invariants` runs them and checks them
//! (`touching` their contacts), `mirror` mirrors them, `shrink` makes failing scenes smaller, `random` makes the random
//! numbers.

pub mod blows;
pub mod generate;
pub mod invariants;
pub mod mechanism;
pub mod mirror;
pub mod random;
pub mod shrink;
mod touching;

use halfgap::scene::Scene;
use halfgap::{CheckReport, World, check};
use std::path::{Path, PathBuf};

/// Path of a file below the repository's `tests/data`.
#[must_use]
pub fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name)
}

/// Reads one of the reference scenes.
///
/// # Panics
/// If it cannot be read: the test fails.
#[must_use]
pub fn reference_scene(name: &str) -> Scene {
    Scene::read(data(&format!("scenes/{name}.json"))).expect("a reference scene can be read")
}

/// One of the reference scenes as its file holds it.
///
/// # Panics
/// If it cannot be read: the test fails.
#[must_use]
pub fn reference_scene_file(name: &str) -> serde_json::Value {
    let text = std::fs::read_to_string(data(&format!("scenes/{name}.json")));
    serde_json::from_str(&text.expect("a reference scene can be read")).expect("it is JSON")
}

/// Parses a scene and builds its world.
///
/// # Panics
/// If that fails: the test fails.
#[must_use]
pub fn world_of(toml: &str) -> World {
    let scene = Scene::parse(toml, halfgap::scene::SceneFormat::Toml).expect("a fine scene");
    World::from_scene(&scene).expect("a world that can be built")
}

/// Runs a scene to its expected states at the given tolerance.
///
/// # Panics
/// If its world cannot be built: the test fails.
#[must_use]
pub fn check_at(scene: &Scene, tolerance: Option<f64>) -> CheckReport {
    let mut scene = scene.clone();
    if let Some(tolerance) = tolerance {
        scene.set_tolerance(tolerance, "tolerance").expect("a fine tolerance");
    }
    let mut world = World::from_scene(&scene).expect("a world that can be built");
    check(&mut world, &scene)
}

/// Names of all reference scenes, sorted.
///
/// # Panics
/// If their folder cannot be read: the test fails.
#[must_use]
pub fn reference_scene_names() -> Vec<String> {
    names_in("scenes")
}

/// Names of all scenes in a folder of the data, sorted.
///
/// # Panics
/// If the folder cannot be read: the test fails.
#[must_use]
pub fn names_in(folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(data(folder)).expect("the scenes are there");
    let name = |path: PathBuf| path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let mut names: Vec<String> =
        entries.filter_map(|entry| name(entry.expect("a readable entry").path())).collect();
    names.sort();
    names
}

/// A floor under gravity.
const FLOOR: &str = r#"
format = "halfgap-scene-1"
title = "test"
run = { duration = 10.0 }
force = [{ gravity = { acceleration = [0.0, -10.0] } }]

[[body]]
name = "floor"
fixed = true
shape = { block = { width = 20.0, height = 1.0 } }
position = [0.0, -0.5]
"#;

/// A scene file with one body, given by its other fields, above a floor whose top is at 0.
#[must_use]
pub fn on_floor(body: &str) -> String {
    format!("{FLOOR}\n[[body]]\nname = \"body\"\nmass = 1.0\n{body}")
}
