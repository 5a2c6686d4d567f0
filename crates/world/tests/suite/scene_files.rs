//! Scene files: every reference scene is read, both formats say the same, and mistakes are named.

use halfgap::scene::{Scene, SceneFormat, SceneSource};
use std::path::{Path, PathBuf};

fn data_scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/scenes");
    let entries = std::fs::read_dir(folder).expect("the reference scenes are there");
    let mut files: Vec<_> = entries.map(|entry| entry.expect("a readable entry").path()).collect();
    files.sort();
    files
}

/// A small scene; the first replacement of each pair makes it a bad one.
const GOOD: &str = r#"format = "halfgap-scene-1"
title = "Ball over a floor"

[run]
duration = 2.0

[[body]]
name = "floor"
fixed = true
shape = { block = { width = 10.0, height = 1.0 } }

[[body]]
name = "ball"
shape = { disc = { radius = 0.5 } }
position = [0, 2.0]
mass = 1.0
elasticity = 0.5
passes_through = ["floor"]

[[force]]
gravity = { acceleration = [0.0, -9.81] }

[[expected]]
time = 1.0
position_tolerance = 1e-6
[expected.bodies.ball]
position = [0.0, 1.0]
"#;

/// The message for the good scene with one thing replaced.
fn message(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from:?} is part of the scene");
    let text = GOOD.replacen(from, to, 1);
    Scene::parse(&text, SceneFormat::Toml).expect_err("the scene is bad").to_string()
}

#[test]
fn every_reference_scene_is_read() {
    let files = data_scenes();
    assert!(files.len() >= 88, "only {} scenes", files.len());
    for file in files {
        let scene = Scene::read(&file).unwrap_or_else(|error| panic!("{error}"));
        assert!(!scene.bodies.is_empty() && !scene.expected.is_empty(), "{}", file.display());
    }
}

#[test]
fn toml_and_json_say_the_same() {
    for file in data_scenes() {
        let text = std::fs::read_to_string(&file).expect("a readable file");
        let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let toml = toml::to_string(&value).expect("scenes have no nulls");
        let from_toml = Scene::parse(&toml, SceneFormat::Toml).unwrap_or_else(|error| panic!("{error}"));
        let from_json = Scene::parse(&text, SceneFormat::Json).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(from_toml, from_json, "{}", file.display());
    }
}

#[test]
fn defaults_are_those_of_the_format() {
    let scene = Scene::parse(GOOD, SceneFormat::Toml).expect("a good scene");
    assert_eq!(scene.run.tolerance_or_default(), 1e-8);
    assert_eq!(scene.run.output_step_or_default(), 0.005);
    assert!(scene.run.contacts && scene.run.collisions && scene.run.seed.is_none());
    assert_eq!((scene.bodies[0].elasticity, scene.bodies[0].friction), (1.0, 0.0));
}

#[test]
fn unknown_missing_and_mistyped_fields_are_named_with_their_line() {
    insta::assert_snapshot!(message("mass = 1.0", "mas = 1.0"), @"line 16: body[1].mas: unknown field `mas` (did you mean `mass`?), expected one of `name`, `fixed`, `shape`, `mass`, `density`, `moment`, `center_of_mass`, `position`, `origin`, `angle`, `velocity`, `angular_velocity`, `elasticity`, `friction`, `static_friction`, `surface_velocity`, `rolling_resistance`, `tangential_elasticity`, `motion`, `passes_through`");
    insta::assert_snapshot!(message("duration = 2.0\n", "\n"), @"line 4: run: missing field `duration`");
    insta::assert_snapshot!(message("shape = { disc = { radius = 0.5 } }\n", "\n"), @"line 12: body[1]: missing field `shape`");
    insta::assert_snapshot!(message("radius = 0.5", "radius = \"half\""), @r#"line 14: body[1].shape.disc.radius: invalid type: string "half", expected a number, or an expression that begins with `=`"#);
    insta::assert_snapshot!(message("position = [0, 2.0]", "position = [0, 2.0, 1.0]"), @"line 15: body[1].position: invalid length 3, expected an array [x, y] of two numbers");
    insta::assert_snapshot!(message("radius = 0.5", "diameter = 0.5"), @"line 14: body[1].shape.disc.diameter: unknown field `diameter`, expected `radius`");
    insta::assert_snapshot!(message("title = \"Ball over a floor\"", ""), @"line 1: missing field `title`");
    insta::assert_snapshot!(message("scene-1", "scene-7"), @"line 1: format: unknown variant `halfgap-scene-7` (did you mean `halfgap-scene-1`?), expected `halfgap-scene-1`");
    insta::assert_snapshot!(message("fixed = true", "fixed = 1"), @"line 9: body[0].fixed: invalid type: integer `1`, expected a boolean");
    insta::assert_snapshot!(message("duration = 2.0", "duration = 2.0\nseed = -1"), @"line 6: run.seed: invalid value: integer `-1`, expected a whole number that is not negative");
    insta::assert_snapshot!(message("duration = 2.0", "duration = 2.0\nimpact_law = \"soft\""), @"line 6: run.impact_law: unknown variant `soft`, expected one of `simultaneous`, `hybrid`, `serial_separate`, `serial_grouped`, `serial_separate_lastpass`, `serial_grouped_lastpass`");
}

#[test]
fn a_table_with_one_key_must_have_exactly_one() {
    insta::assert_snapshot!(message("{ disc = { radius = 0.5 } }", "{}"), @"line 14: body[1].shape: must have exactly one key, one of `disc`, `block`, `rounded_block`, `polygon`, `ring`, `capsule`, `regular`, `gear`, `rack_bar`, `ratchet`, `geneva`, `cam`, `outline`");
    insta::assert_snapshot!(message("{ disc = { radius = 0.5 } }", "{ egg = 3 }"), @"line 14: body[1].shape: unknown field `egg`, expected one of `disc`, `block`, `rounded_block`, `polygon`, `ring`, `capsule`, `regular`, `gear`, `rack_bar`, `ratchet`, `geneva`, `cam`, `outline`");
    let both = "{ disc = { radius = 0.5 }, block = { width = 1, height = 1 } }";
    insta::assert_snapshot!(message("{ disc = { radius = 0.5 } }", both), @"line 14: body[1].shape: must have exactly one key, found `disc` and `block`");
    insta::assert_snapshot!(message("[0.0, -9.81] }", "[0.0, -9.81] }\nbodies = [\"ball\"]"), @"line 20: force[0]: must have exactly one key, found `gravity` and `bodies`: what belongs to `gravity` goes into its table");
}

#[test]
fn syntax_errors_have_a_line() {
    insta::assert_snapshot!(message("mass = 1.0", "mass = = 1.0"), @"line 16: not valid TOML: extra `=`, expected nothing");
    insta::assert_snapshot!(message("[[body]]\nname = \"ball\"", "[[body\nname = \"ball\""), @"line 12: not valid TOML: unclosed array table, expected `]]`");
    insta::assert_snapshot!(message("mass = 1.0", "mass = 1.0\nmass = 2.0"), @"line 17: not valid TOML: duplicate key");
}

#[test]
fn values_out_of_range_are_named_with_their_line() {
    insta::assert_snapshot!(message("mass = 1.0", "mass = -2"), @"line 16: body[1].mass: must be positive, got -2 kg");
    insta::assert_snapshot!(message("mass = 1.0", "mass = 1.0\ndensity = 3"), @"line 17: body[1].density: give mass or density, not both");
    insta::assert_snapshot!(message("mass = 1.0\n", "\n"), @r#"line 12: body[1]: missing mass or density: body "ball" is not fixed"#);
    insta::assert_snapshot!(message("elasticity = 0.5", "elasticity = 2"), @"line 17: body[1].elasticity: must lie between 0 and 1, got 2");
    insta::assert_snapshot!(message("[0, 2.0]", "[0, nan]"), @"line 15: body[1].position[1]: must be a finite number, got NaN");
}

#[test]
fn names_must_be_known_and_unique() {
    insta::assert_snapshot!(message("name = \"ball\"", "name = \"floor\""), @r#"line 13: body[1].name: "floor" is already the name of body[0]"#);
    insta::assert_snapshot!(message("name = \"ball\"", "name = \"world\""), @r#"line 13: body[1].name: "world" is reserved for the immovable background"#);
    insta::assert_snapshot!(message("[\"floor\"]", "[\"flor\"]"), @r#"line 18: body[1].passes_through[0]: there is no body named "flor" (did you mean "floor"?)"#);
    insta::assert_snapshot!(message("bodies.ball", "bodies.\"the bal\""), @r#"line 26: expected[0].bodies."the bal": there is no body named "the bal""#);
    insta::assert_snapshot!(message("[0.0, -9.81] }", "[0.0, -9.81], bodies = [\"world\"] }"), @r#"line 21: force[0].gravity.bodies[0]: must be a body, not the background "world""#);
}

#[test]
fn times_must_make_sense() {
    insta::assert_snapshot!(message("duration = 2.0", "duration = 0"), @"line 5: run.duration: must be positive, got 0 s");
    insta::assert_snapshot!(message("duration = 2.0", "duration = inf"), @"line 5: run.duration: must be a finite number, got inf");
    insta::assert_snapshot!(message("duration = 2.0", "duration = 2.0\noutput_step = 1e-12"), @"line 6: run.output_step: would record 2000000000000 states, at most 10000000 are allowed");
    insta::assert_snapshot!(message("duration = 2.0", "duration = 2.0\nstart_time = 1e30"), @"line 5: run.duration: is lost in rounding: 1000000000000000000000000000000 s + 2 s is 1000000000000000000000000000000 s");
    insta::assert_snapshot!(message("duration = 2.0", "duration = 2.0\ntolerance = 0.0"), @"line 6: run.tolerance: must be positive, got 0");
    insta::assert_snapshot!(message("time = 1.0", "time = 3.0"), @"line 24: expected[0].time: must be at most the end of the run (2 s), got 3 s");
    insta::assert_snapshot!(message("time = 1.0", "time = -1.0"), @"line 24: expected[0].time: must be at least the start time (0 s), got -1 s");
    insta::assert_snapshot!(message("position_tolerance = 1e-6\n", "\n"), @"line 23: expected[0]: missing field `position_tolerance`");
}

#[test]
fn connectors_and_forces_are_checked() {
    let with = |text: &str| message("[[force]]", &format!("{text}\n[[force]]"));
    let pin = "[[connector]]\npin = { a = { body = \"world\", point = [0, 2] }, b = { body = \"bal\", point = [0, 0] } }";
    insta::assert_snapshot!(with(pin), @r#"line 21: connector[0].pin.b.body: there is no body named "bal" (did you mean "ball"?)"#);
    let rope = "[[connector]]\nrope = { a = { body = \"world\", point = [0, 2] }, b = { body = \"ball\", point = [0, 0] }, length = 0 }";
    insta::assert_snapshot!(with(rope), @"line 21: connector[0].rope.length: must be positive, got 0 m");
    let rail = "[[connector]]\nrail = { a = { body = \"ball\", point = [0, 0] }, path = { start = [0, 0], points = [[0, 0], [1, 1]] } }";
    insta::assert_snapshot!(with(rail), @"line 21: connector[0].rail.path: must have either `points`, or `start` and `edges`");
    insta::assert_snapshot!(with("[[force]]\nspring = { a = { body = \"world\", point = [0, 2] } }"), @"line 21: force[0].spring: missing field `b`");
}

#[test]
fn json_messages_have_lines_too() {
    let bad = |text: &str| Scene::parse(text, SceneFormat::Json).expect_err("a bad scene").to_string();
    let scene = |body: &str| {
        format!(
            "{{\"format\": \"halfgap-scene-1\",\n \"title\": \"t\", \"run\": {{\"duration\": 1}},\n \"body\": [\n  {body}]}}"
        )
    };
    let disc = "\"shape\": {\"disc\": {\"radius\": 1}}";
    insta::assert_snapshot!(bad(&scene(&format!("{{\"name\": \"a\", {disc},\n   \"mass\": -1}}"))), @"line 5: body[0].mass: must be positive, got -1 kg");
    insta::assert_snapshot!(bad(&scene(&format!("{{\"name\": \"a\", {disc},\n   \"mas\": -1}}"))), @"line 5: body[0].mas: unknown field `mas` (did you mean `mass`?), expected one of `name`, `fixed`, `shape`, `mass`, `density`, `moment`, `center_of_mass`, `position`, `origin`, `angle`, `velocity`, `angular_velocity`, `elasticity`, `friction`, `static_friction`, `surface_velocity`, `rolling_resistance`, `tangential_elasticity`, `motion`, `passes_through`");
    insta::assert_snapshot!(bad(&scene(&format!("{{{disc},\n   \"mass\": 1}}"))), @"line 4: body[0]: missing field `name`");
    insta::assert_snapshot!(bad(&scene("{\"name\": \"a\",, }")), @"line 4: not valid JSON: key must be a string");
    insta::assert_snapshot!(bad(&scene(&format!("{{\"name\": \"a\", {disc},\n   \"mass\": NaN}}"))), @"line 5: not valid JSON: expected value");
    let of_law = |law: &str| {
        format!(
            "\u{feff}{{\"format\": \"halfgap-scene-1\", \"title\": \"t\",\n\"run\": {{\"duration\": 1, \"impact_law\": {law}}}}}"
        )
    };
    insta::assert_snapshot!(bad(&of_law("1")), @"line 2: run.impact_law: invalid type: integer `1`, expected a string");
    assert!(
        Scene::parse(&of_law("\"hybrid\""), SceneFormat::Json).is_ok(),
        "a mark before the text is none of it"
    );
    insta::assert_snapshot!(bad(&format!("{}x", scene(&format!("{{\"name\": \"a\", {disc}, \"mass\": 1}}")))), @"line 4: not valid JSON: text after the end of the scene");
}

#[test]
fn what_is_not_simulated_yet_is_refused_by_name() {
    let refusal = |from: &str, to: &str| {
        let source = SceneSource::new(GOOD.replacen(from, to, 1), SceneFormat::Toml);
        let scene = source.parse().expect("a valid scene");
        source.locate(scene.check_supported().expect_err("not supported")).to_string()
    };
    let impulses = "duration = 2.0\ntime_step = 0.01\ncontacts = false";
    let rolls = GOOD.replacen("mass = 1.0", "mass = 1.0\nrolling_resistance = 0.3", 1);
    let source = SceneSource::new(rolls.replacen("duration = 2.0", impulses, 1), SceneFormat::Toml);
    let refused = source
        .parse()
        .expect("a valid scene")
        .check_supported()
        .expect_err("impulses alone resist no rolling");
    insta::assert_snapshot!(source.locate(refused), @"line 19: body[1].rolling_resistance: rolling resistance needs contacts that carry forces and are projected: leave `contacts` out of `[run]`, or set `strategy` to `steps`");
    let steps = "duration = 2.0\nstrategy = \"steps\"\ntime_step = 0.01\ncontacts = false";
    insta::assert_snapshot!(refusal("duration = 2.0", steps), @"line 8: run.contacts: steps know no contacts without forces: leave `contacts` out, or set `strategy` to `events`");
}

#[test]
fn all_else_in_the_format_is_simulated() {
    let spring = "spring = { a = { body = \"world\", point = [0, 2] }, b = { body = \"ball\", point = [0, 0] }, rest_length = 1, stiffness = 1, damping = 1 }";
    let rod = "[[connector]]\nrod = { a = { body = \"world\", point = [0, 1] }, b = { body = \"ball\", point = [0, 0] }, length = 1 }\n[[force]]";
    for (from, to) in [
        ("duration = 2.0", "duration = 2.0\nintegrator = \"rk4\""),
        ("duration = 2.0", "duration = 2.0\nintegrator = \"euler\""),
        ("duration = 2.0", "duration = 2.0\nstabilization = \"velocity\""),
        ("duration = 2.0", "duration = 2.0\nstrategy = \"events\""),
        ("duration = 2.0", "duration = 2.0\nstrategy = \"steps\"\ntime_step = 0.01"),
        ("gravity = { acceleration = [0.0, -9.81] }", "mutual_gravity = { strength = 1 }"),
        ("gravity = { acceleration = [0.0, -9.81] }", spring),
        ("[[force]]", rod),
    ] {
        assert!(GOOD.contains(from));
        let scene = Scene::parse(&GOOD.replacen(from, to, 1), SceneFormat::Toml).expect("a valid scene");
        scene.check_supported().unwrap_or_else(|error| panic!("{to}: {error}"));
        let mut world = halfgap::World::from_scene(&scene).unwrap_or_else(|error| panic!("{to}: {error}"));
        world.advance_to(0.1, &mut |_| {}).unwrap_or_else(|error| panic!("{to}: {error}"));
    }
}

#[test]
fn files_that_cannot_be_scenes_are_refused() {
    let folder = std::env::temp_dir().join(format!("halfgap-scene-files-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the test");
    let bad = |name: &str| {
        let error = Scene::read(folder.join(name)).expect_err("a bad file").to_string();
        error.replace(&format!("{}/", folder.display()), "")
    };
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).expect("a test file");
    write("scene.yaml", b"title: x");
    write("latin.toml", b"title = \"Stra\xdfe\"");
    write("empty.json", b"");
    insta::assert_snapshot!(bad("none.toml"), @"none.toml: cannot be read: No such file or directory (os error 2)");
    insta::assert_snapshot!(bad("scene.yaml"), @"scene.yaml: a scene file's name must end in .toml or .json");
    insta::assert_snapshot!(bad("latin.toml"), @"latin.toml: is not UTF-8 text: byte 13 is not");
    insta::assert_snapshot!(bad("empty.json"), @"empty.json:1: not valid JSON: EOF while parsing a value");
    std::fs::create_dir_all(folder.join("folder.toml")).expect("a folder");
    insta::assert_snapshot!(bad("folder.toml"), @"folder.toml: is a directory, not a scene file");
    // A sparse file has the size without the bytes.
    let large = std::fs::File::create(folder.join("large.json")).expect("a test file");
    large.set_len(100 << 20).expect("a sparse file");
    insta::assert_snapshot!(bad("large.json"), @"large.json: has 104857600 bytes; a scene file may have at most 67108864");
    std::fs::remove_dir_all(&folder).expect("the test's own folder");
}

#[test]
fn large_garbage_ends_in_a_short_message() {
    for pattern in ["[", "a", "a=", "{", "\"", "[[x]]\n", "é\n", "1 ", "a.b.c\n", "\0"] {
        for (format, size) in [(SceneFormat::Toml, 8 << 20), (SceneFormat::Json, 60 << 20)] {
            let text = pattern.repeat(size / pattern.len());
            let error = Scene::parse(&text, format).expect_err("garbage");
            assert!(error.to_string().len() < 1000, "a message of {} bytes", error.to_string().len());
        }
    }
}
