//! Scenes that cannot be solved end at once with an error that gives the reason.

use halfgap::World;
use halfgap::scene::{Scene, SceneFormat};
use std::time::{Duration, Instant};

const HEAD: &str = "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = { duration = 1.0 }\n";

/// The error of a scene, which must come within a second.
fn error_of(rest: &str) -> String {
    let started = Instant::now();
    let scene = Scene::parse(&format!("{HEAD}{rest}"), SceneFormat::Toml).expect("a scene that can be read");
    let error = match World::from_scene(&scene) {
        Ok(mut world) => world.advance_to(1.0, &mut |_| {}).expect_err("it cannot be solved").to_string(),
        Err(error) => error.to_string(),
    };
    let took = started.elapsed();
    println!("REACHED | {error} | 1 s | {took:.1?}");
    assert!(took < Duration::from_secs(1), "{took:?}");
    error
}

#[test]
fn a_body_crushed_by_two_fixed_jaws_is_refused_by_name() {
    let jaw = |name: &str, x: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\nfixed = true\nposition = [{x}, 0.0]\n\
             shape = {{ block = {{ width = 1.0, height = 4.0 }} }}\n"
        )
    };
    let disc = "[[body]]\nname = \"disc\"\nmass = 1.0\nshape = { disc = { radius = 0.5 } }\n";
    // The jaws are 0.9999996 m apart: each overlap is allowed to be lifted, but not both.
    let error = error_of(&format!("{}{}{disc}", jaw("left", -0.999_999_8), jaw("right", 0.999_999_8)));
    assert!(error.contains("disc") && error.contains("apart"), "{error}");
    let error = error_of(&format!("{}{}{disc}", jaw("left", -0.9), jaw("right", 0.9)));
    assert!(error.contains("disc") && error.contains("overlap"), "{error}");
}

#[test]
fn a_pin_pulled_two_ways_is_refused_by_name() {
    let bar = "[[body]]\nname = \"bar\"\nmass = 1.0\nshape = { block = { width = 2.0, height = 0.1 } }\n";
    let pin = |x: f64, at: f64| {
        format!(
            "[[connector]]\npin = {{ a = {{ body = \"world\", point = [{at}, 0.0] }}, b = {{ body = \"bar\", point = [{x}, 0.0] }} }}\n"
        )
    };
    let error = error_of(&format!("{bar}{}{}", pin(-1.0, -1.0), pin(1.0, 1.5)));
    assert!(error.contains("pin"), "{error}");
    // The pins are off by so little that either may be put right, but each correction undoes the other.
    let error = error_of(&format!("{bar}{}{}", pin(-1.0, -1.0), pin(1.0, 1.000_000_5)));
    assert!(error.contains("pin"), "{error}");
}
