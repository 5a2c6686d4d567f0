//! Mechanisms: scenes with known answers.

use halfgap::scene::{RunData, Scene};
use halfgap::{CheckReport, World, check};
use halfgap_tests::{data, names_in};

/// A scene with known answers, run at a tolerance.
fn checked(name: &str, tolerance: f64) -> CheckReport {
    let scene = Scene::read(data(&format!("mechanisms/{name}.json"))).expect("the scene can be read");
    let scene = Scene { run: RunData { tolerance: Some(tolerance), ..scene.run.clone() }, ..scene };
    let mut world = World::from_scene(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    check(&mut world, &scene)
}

#[test]
fn every_mechanism_is_reached_within_its_own_tolerances() {
    for name in names_in("mechanisms") {
        let report = checked(&name, 1e-10);
        assert!(report.ok, "{name}: {:?}", report.why);
    }
}
