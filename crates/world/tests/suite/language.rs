//! Names, expressions and repetition in scene files.

use halfgap::World;
use halfgap::scene::{ConnectorRef, ProbeData, Scene, SceneError, SceneFormat, SceneSource, VariedScene};

const ROW: &str = r#"format = "halfgap-scene-1"
title = "A row of discs, two high"
[let]
n = 4
r = "= pitch/4"
pitch = 0.5
[run]
duration = "= n/4"
[[body]]
repeat = { i = [0, "= n - 1"], j = [0, 1] }
name = "disc {i} {j}"
shape = { disc = { radius = "= r" } }
mass = "= 1 + i"
position = ["= pitch*i", "= 1 + pitch*j"]
[[body]]
name = "floor"
fixed = true
shape = { block = { width = 10.0, height = 1.0 } }
position = [0.0, -0.5]
[[connector]]
repeat = { i = [0, 1] }
rod = { a = { body = "disc 0 {i}", point = [0, 0] }, b = { body = "floor", point = [0, 0] }, length = 1 }
"#;

fn source(from: &str, to: &str) -> SceneSource {
    assert!(ROW.contains(from), "{from:?} is part of the scene");
    SceneSource::new(ROW.replacen(from, to, 1), SceneFormat::Toml)
}

fn parsed(from: &str, to: &str) -> Result<Scene, SceneError> {
    source(from, to).parse()
}

fn message(from: &str, to: &str) -> String {
    parsed(from, to).expect_err("the scene is bad").to_string()
}

#[test]
fn repeated_elements_are_made_one_by_one_the_last_name_fastest() {
    let scene = parsed("", "").expect("a good scene");
    let names: Vec<_> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
    let expected =
        ["0 0", "0 1", "1 0", "1 1", "2 0", "2 1", "3 0", "3 1"].map(|name| format!("disc {name}"));
    assert_eq!(names[..8], expected);
    assert_eq!(names[8..], ["floor"]);
    assert_eq!(scene.run.duration, 1.0);
    let last = &scene.bodies[7];
    assert_eq!((last.mass, last.position.map(|at| (at.x, at.y))), (Some(4.0), Some((1.5, 1.5))));
    assert_eq!(scene.connectors.len(), 2);
}

#[test]
fn a_range_may_be_empty_by_one() {
    let scene = parsed("i = [0, 1] }\nrod", "i = [0, -1] }\nrod").expect("there are no connectors");
    assert_eq!((scene.connectors.len(), scene.bodies.len()), (0, 9));
    insta::assert_snapshot!(message("i = [0, 1] }\nrod", "i = [0, -2] }\nrod"), @"line 21: connector[0].repeat.i: runs from 0 to -2: the last must not be less than the first (by one: none is made)");
}

#[test]
fn errors_name_the_expression_and_what_the_names_stand_for() {
    insta::assert_snapshot!(message(r#"mass = "= 1 + i""#, r#"mass = "= i""#), @"line 13: body[0].mass: must be positive, got 0 kg (from `= i`, with i = 0, j = 0)");
    insta::assert_snapshot!(message(r#""= pitch*i""#, r#""= 1/(i - 2)""#), @"line 14: body[0].position[0]: in `= 1/(i - 2)`: divides by zero (with i = 2, j = 0)");
    insta::assert_snapshot!(message(r#""= pitch*i""#, r#""= pich*i""#), @"line 14: body[0].position[0]: in `= pich*i`: there is no `pich` in `[let]` (did you mean `pitch`?) (with i = 0, j = 0)");
    insta::assert_snapshot!(message("disc 0 {i}", "disc {i} {i}!"), @r#"line 22: connector[0].rod.a.body: there is no body named "disc 0 0!" (did you mean "disc 0 0"?) (with i = 0)"#);
    insta::assert_snapshot!(message("width = 10.0", r#"width = "= -r""#), @"line 18: body[1].shape.block.width: must be positive, got -0.125 m (from `= -r`)");
    insta::assert_snapshot!(message("width = 10.0", r#"width = "wide""#), @r#"line 18: body[1].shape.block.width: invalid type: string "wide", expected a number, or an expression that begins with `=`"#);
}

#[test]
fn errors_of_names_are_at_the_names() {
    insta::assert_snapshot!(message("pitch = 0.5", r#"pitch = "= 2*r""#), @"line 5: let.r: in `= pitch/4`: `pitch` is defined by itself");
    insta::assert_snapshot!(message("n = 4", "n = true"), @r#"line 4: let.n: must be a number or an expression such as "= 2*pi/12", got boolean `true`"#);
    insta::assert_snapshot!(message("n = 4", "pi = 4"), @"line 4: let.pi: `pi` is part of the language: take another name");
    insta::assert_snapshot!(message("n = 4", "\"2n\" = 4"), @"line 4: let.2n: a name has letters a to z, digits and `_`, no digit first");
    insta::assert_snapshot!(message("n = 4", "n = 4\ni = 3"), @"line 11: body[0].repeat.i: `i` is a name in `[let]`: take another name");
    insta::assert_snapshot!(message("repeat = { i = [0, \"= n - 1\"]", "repeat = { i = [0, 1.5]"), @"line 10: body[0].repeat.i[1]: must be a whole number, got 1.5");
    insta::assert_snapshot!(message("i = [0, 1] }\nrod", "i = 10 }\nrod"), @"line 21: connector[0].repeat.i: must be [first, last], both included, got integer `10`");
    insta::assert_snapshot!(message("n = 4", "n = 1e6"), @"line 10: body[0].repeat: a scene has at most 1000000 bodies, connectors, forces, pairs and probes together");
}

#[test]
fn only_lists_at_the_top_repeat() {
    insta::assert_snapshot!(message("shape = { disc = { radius = \"= r\" } }", "shape = { disc = { radius = 1, repeat = { k = [0, 1] } } }"), @"line 12: body[0].shape.disc.repeat: unknown field `repeat`, expected `radius` (with i = 0, j = 0)");
    insta::assert_snapshot!(message("[run]", "[run]\nrepeat = { k = [0, 1] }"), @"line 8: run.repeat: unknown field `repeat`, expected one of `duration`, `start_time`, `output_step`, `tolerance`, `strategy`, `restitution`, `impact_law`, `seed`, `contacts`, `collisions`, `target_gap`, `velocity_tol`, `accuracy`, `time_step`, `integrator`, `stabilization`, `joint_small_impacts`, `start_overlap`, `start_connector_error`");
}

#[test]
fn names_can_be_set_and_varied() {
    let scene = source("", "").with_let("pitch", "1").with_let("n", "= 2").parse().expect("a good scene");
    assert_eq!(scene.bodies.len(), 5);
    assert_eq!(scene.bodies[2].position.map(|at| at.x), Some(1.0));
    let error = source("", "").with_let("pich", "1").parse().expect_err("there is no such name");
    insta::assert_snapshot!(error, @"line 3: let: there is no `pich` in `[let]` that could be set (did you mean `pitch`?)");
    let error = source("", "").with_let("r", "1/").parse().expect_err("an unfinished expression");
    insta::assert_snapshot!(error, @"line 5: let.r: in `=1/`: ends where a number, a name or `(` should stand");
    for (field, radius) in [("let.pitch", 0.25), ("let.r", 1.0), ("body[0].shape.disc.radius", 1.0)] {
        let field = field.parse().expect("a path");
        // Discs that are to be as large overlap; that is for the world to say.
        let scene = VariedScene::new(source("", ""), &field)
            .and_then(|varied| varied.with(1.0))
            .expect("a good scene");
        let halfgap::scene::ShapeData::Disc(disc) = &scene.bodies[3].shape else { panic!("it is a disc") };
        assert_eq!(disc.radius, radius, "{field}");
    }
}

#[test]
fn a_fault_of_the_world_is_led_back_to_the_repeated_element() {
    let source = source(r#"r = "= pitch/4""#, r#"r = "= 0.6*pitch""#);
    let scene = source.parse().expect("all numbers are fine");
    let error = World::from_scene(&scene).map(|_| ()).expect_err("the discs overlap");
    insta::assert_snapshot!(source.locate(error), @r#"line 14: body[0].position: bodies "disc 0 0" and "disc 0 1" overlap by 0.1 m at the start; at most 3e-7 m are allowed (with i = 0, j = 1)"#);
}

#[test]
fn braces_hold_expressions_so_that_neighbours_can_be_tied() {
    let rods = r#"repeat = { i = [0, 1] }
rod = { a = { body = "disc {i} {n-3}", point = [0, 0] }, b = { body = "disc {i + 1} 1", point = [0, 0] }, length = "= pitch" }
"#;
    let rope = &ROW[ROW.find("repeat = { i = [0, 1] }").expect("it is there")..];
    let scene = parsed(rope, rods).expect("a good scene");
    let halfgap::scene::ConnectorData::Rod(rod) = &scene.connectors[1].data else { panic!("it is a rod") };
    assert_eq!((rod.a.body.as_str(), rod.b.body.as_str()), ("disc 1 1", "disc 2 1"));
    insta::assert_snapshot!(message("disc 0 {i}", "disc 0 {k}"), @"line 22: connector[0].rod.a.body: in `{k}`: there is no `k` in `[let]` (did you mean `n`?) (with i = 0)");
    insta::assert_snapshot!(message("disc 0 {i}", "disc 0 {i/2}"), @"line 22: connector[0].rod.a.body: in `{i/2}`: must be a whole number, got 0.5 (with i = 1)");
    assert_eq!(
        parsed("A row of discs", "A {row").expect("titles are not repeated").title,
        "A {row, two high"
    );
}

#[test]
fn a_probe_may_name_a_connector_by_an_expression() {
    let probes = r#"[[probe]]
repeat = { i = [0, 1] }
name = "rod {i}"
connector = "= 1 - i"
"#;
    let scene = SceneSource::new(format!("{ROW}{probes}"), SceneFormat::Toml).parse().expect("a good scene");
    let connector = |probe: usize| match &scene.probes[probe].data {
        ProbeData::Connector(ConnectorRef::Index(index)) => *index,
        other => panic!("{other:?} is no place"),
    };
    assert_eq!([0, 1].map(connector), [1, 0]);
}

#[test]
fn a_field_that_is_unknown_is_named_whatever_is_in_it() {
    let text = r#"{"format": "halfgap-scene-1", "title": "dot", "run": {"duration": 1}, "body": [{"name": "dot", "shape": {"egg": null}, "mass": 1}]}"#;
    let error = Scene::parse(text, SceneFormat::Json).expect_err("no egg is a shape").to_string();
    assert!(error.contains("body[0].shape: unknown field `egg`"), "{error}");
}

#[test]
fn what_is_expected_to_be_a_text_is_no_expression() {
    let scene =
        parsed(r#"title = "A row of discs, two high""#, r#"title = "= 1/0""#).expect("a title is any text");
    assert_eq!(scene.title, "= 1/0");
}

#[test]
fn json_knows_the_language_too() {
    let text = r#"{"format": "halfgap-scene-1", "title": "dots", "run": {"duration": 1}, "let": {"a": "= b/2", "b": 1},
        "body": [{"repeat": {"k": [1, 2]}, "name": "dot {k}", "shape": {"disc": {"radius": "= a/8"}}, "mass": 1, "position": ["= k", 0]}]}"#;
    let scene = Scene::parse(text, SceneFormat::Json).expect("a good scene");
    assert_eq!(scene.bodies.iter().map(|body| body.name.as_str()).collect::<Vec<_>>(), ["dot 1", "dot 2"]);
    assert_eq!(SceneFormat::of_text(text), SceneFormat::Json);
    assert_eq!(SceneFormat::of_text(ROW), SceneFormat::Toml);
}

#[test]
fn names_are_defined_by_names_to_a_depth() {
    let chain = |count: usize| {
        let names: String = (1..count).map(|k| format!("a{k} = \"= a{} + 1\"\n", k - 1)).collect();
        parsed("[let]\n", &format!("[let]\na0 = 1\n{names}")).map(|_| ())
    };
    assert!(chain(90).is_ok());
    insta::assert_snapshot!(chain(2000).expect_err("that is a long chain"), @"line 904: let.a900: in `= a899 + 1`: is defined by more than 100 names, one by the other");
}
