//! Scenes that are refused, or built with a warning, with the field to blame.

use halfgap::World;
use halfgap::scene::{SceneFormat, SceneSource};

const GOOD: &str = r#"format = "halfgap-scene-1"
title = "Ball over a floor"
[run]
duration = 1.0
[[body]]
name = "floor"
fixed = true
shape = { block = { width = 10.0, height = 1.0 } }
position = [0.0, -0.5]
[[body]]
name = "ball"
shape = { disc = { radius = 0.5 } }
position = [0.0, 2.0]
mass = 1.0
"#;

/// Builds the world of the good scene with one thing replaced, or tells why not.
fn built(from: &str, to: &str) -> Result<World, String> {
    assert!(GOOD.contains(from), "{from:?} is part of the scene");
    let source = SceneSource::new(GOOD.replacen(from, to, 1), SceneFormat::Toml);
    let built = source.parse().and_then(|scene| World::from_scene(&scene));
    built.map_err(|error| source.locate(error).to_string())
}

fn message(from: &str, to: &str) -> String {
    built(from, to).expect_err("the scene is bad")
}

/// The message for the good scene with more at its end.
fn message_with(more: &str) -> String {
    message("mass = 1.0\n", &format!("mass = 1.0\n{more}\n"))
}

#[test]
fn numbers_too_large_or_small_to_compute_with_are_named_with_their_field() {
    insta::assert_snapshot!(message_with("[[force]]\ngravity = { acceleration = [0, -1e200] }"), @r#"line 16: force[0].gravity.acceleration: body "ball": gravity must be at most 1e60 in size, got -1e200"#);
    insta::assert_snapshot!(message_with("[[force]]\nconstant = { body = \"ball\", point = [0, 0], force = [1e300, 0] }"), @r#"line 16: force[0].constant: force "force[0].constant" accelerates body "ball" by more than 1e60 m/s^2 at the start"#);
    insta::assert_snapshot!(message("duration = 1.0", "duration = 1e-320"), @"line 4: run.duration: duration must be at least 5e-60 s, got 1e-320 s");
    insta::assert_snapshot!(message("mass = 1.0", "mass = 1.0\ncenter_of_mass = [1e300, 0]"), @r#"line 15: body[1].center_of_mass: body "ball": centre of mass must be at most 1e60 in size, got 1e300"#);
    insta::assert_snapshot!(message("radius = 0.5", "radius = 1e300"), @"line 12: body[1].shape.disc.radius: must lie between 1e-60 and 1e60 m, got 1e300 m");
    insta::assert_snapshot!(message("radius = 0.5", "radius = 1e-300"), @"line 12: body[1].shape.disc.radius: must lie between 1e-60 and 1e60 m, got 1e-300 m");
    insta::assert_snapshot!(message("mass = 1.0", "mass = -1e300"), @"line 14: body[1].mass: must be positive, got -1e300 kg");
    insta::assert_snapshot!(message("duration = 1.0", "duration = 1.0\naccuracy = 1.0"), @"line 5: run.accuracy: accuracy must be less than the target gap of 5e-11 m, got 1 m");
}

#[test]
fn numbers_of_json_beyond_the_doubles_are_too_large() {
    let text = "{\"format\": \"halfgap-scene-1\", \"title\": \"t\",\n\"run\": {\"duration\": 1e400}}";
    let error = SceneSource::new(text, SceneFormat::Json).parse().expect_err("no double is that large");
    insta::assert_snapshot!(error.to_string(), @"line 2: run.duration: the number is too large");
    let text = text.replace("1e400", "true").replace("\"t\"", "5");
    let error = SceneSource::new(text, SceneFormat::Json).parse().expect_err("a title is a string");
    insta::assert_snapshot!(error.to_string(), @"line 1: title: invalid type: integer `5`, expected a string");
}

#[test]
fn arrays_are_no_tables_and_tables_no_names() {
    insta::assert_snapshot!(message("{ disc = { radius = 0.5 } }", "{ disc = [0.5] }"), @"line 12: body[1].shape.disc: invalid type: array, expected a table");
    insta::assert_snapshot!(message("{ disc = { radius = 0.5 } }", "{ disc = 3 }"), @"line 12: body[1].shape.disc: invalid type: integer `3`, expected a table");
    insta::assert_snapshot!(message("{ disc = { radius = 0.5 } }", "[0.5]"), @"line 12: body[1].shape: invalid type: array, expected a table with one key that names the shape");
    insta::assert_snapshot!(message_with("[[connector]]\npin = [[\"world\", [0, 3]], [\"ball\", [0, 1]], 0.5, false, false]"), @"line 16: connector[0].pin: invalid type: array, expected a table");
    insta::assert_snapshot!(message_with("[[force]]\ngravity = [[0, -9.81]]"), @"line 16: force[0].gravity: invalid type: array, expected a table");
    insta::assert_snapshot!(message_with("[[expected]]\ntime = 1.0\n[expected.bodies]\nball = 3"), @"line 18: expected[0].bodies.ball: invalid type: integer `3`, expected a table");
    insta::assert_snapshot!(message("duration = 1.0", "duration = 1.0\nimpact_law = { hybrid = [] }"), @"line 5: run.impact_law: invalid type: table, expected a string");
    insta::assert_snapshot!(message("duration = 1.0", "duration = 1.0\nimpact_law = 3"), @"line 5: run.impact_law: invalid type: integer `3`, expected a string");
    insta::assert_snapshot!(message("duration = 1.0", "duration = 1.0\nstrategy = 3"), @"line 5: run.strategy: invalid type: integer `3`, expected a string");
    insta::assert_snapshot!(message("[run]\nduration = 1.0", "run = [1.0]"), @"line 3: run: invalid type: array, expected a table");
    let error = SceneSource::new("[]", SceneFormat::Json).parse().expect_err("an array");
    insta::assert_snapshot!(error.to_string(), @"line 1: invalid type: array, expected a table");
}

#[test]
fn parts_without_a_meaning_are_refused() {
    let point = "{ body = \"ball\", point = [0, 0] }";
    insta::assert_snapshot!(message_with(&format!("[[force]]\nspring = {{ a = {point}, b = {point}, rest_length = 1, stiffness = 1 }}")), @r#"line 16: force[0].spring: ties "ball" to itself; the two points must be on different bodies"#);
    insta::assert_snapshot!(message("mass = 1.0", "mass = 1.0\npasses_through = [\"floor\", \"ball\"]"), @"line 15: body[1].passes_through[1]: is the body itself, which it cannot meet");
    insta::assert_snapshot!(message_with("[[expected]]\ntime = 1.0\nenergy_tolerance = 1e-9"), @"line 17: expected[0].energy_tolerance: needs an `energy_change`, of which it is the tolerance");
    let all = built(
        "mass = 1.0",
        "mass = 1.0\n[[force]]\ngravity = { acceleration = [0, -9.81], bodies = [\"floor\", \"ball\"] }",
    );
    assert!(all.is_ok_and(|world| world.warnings().is_empty()), "a list of all bodies may have fixed ones");
}

#[test]
fn forces_on_fixed_bodies_and_target_gaps_wider_than_bodies_are_warned_of() {
    let warning = |from: &str, to: &str| built(from, to).expect("a fine scene").warnings().join("; ");
    let push = "mass = 1.0\n[[force]]\nconstant = { body = \"floor\", point = [0, 0], force = [1, 0] }";
    insta::assert_snapshot!(warning("mass = 1.0", push), @r#"force "force[0].constant" acts on fixed bodies only: it moves nothing"#);
    let tied = "mass = 1.0\n[[force]]\nspring = { a = { body = \"world\", point = [0, 9] }, b = { body = \"floor\", point = [0, 0] }, rest_length = 1, stiffness = 1 }";
    insta::assert_snapshot!(warning("mass = 1.0", tied), @r#"force "force[0].spring" acts on fixed bodies only: it moves nothing"#);
    insta::assert_snapshot!(warning("duration = 1.0", "duration = 1.0\ntarget_gap = 10.0"), @"a `target_gap` of 10 m is larger than the smallest moving body, which reaches 0.5 m from its centre of mass: bodies meet at that distance, and those that are nearer at the start are moved apart");
    assert_eq!(warning("duration = 1.0", "duration = 1.0\ntarget_gap = 0.4"), "");
}
