//! Probes: what they read from a recording.

use halfgap::scene::{Scene, SceneFormat};
use halfgap::{Probe, ProbeTable, Record, RunPlan, World, run};
use std::fmt::Write;
use std::ops::ControlFlow;

/// What the probes of a scene tell, column by column.
fn told(text: &str) -> Vec<(String, Vec<f64>)> {
    let scene = Scene::parse(text, SceneFormat::Toml).unwrap_or_else(|error| panic!("{error}"));
    let mut world = World::from_scene(&scene).unwrap_or_else(|error| panic!("{error}"));
    let plan = RunPlan::of_scene(&scene, Record::Everything);
    let report = run(&mut world, &plan, &mut |_| ControlFlow::Continue(()));
    assert!(report.error.is_none(), "{:?}", report.error);
    let probes = Probe::of_scene(&scene, &world).unwrap_or_else(|error| panic!("{error}"));
    let table = ProbeTable::of(&probes, &world, &report.recording);
    let columns = table.columns().iter().enumerate();
    columns
        .map(|(place, (name, (quantity, unit)))| {
            (format!("{name} {quantity} [{unit}]"), table.column(place).collect())
        })
        .collect()
}

/// A pendulum of 2 m and 3 kg on a pin with a name, a bead in a slot, and a block on a slope, with probes.
const SCENE: &str = r#"
format = "halfgap-scene-1"
title = "t"
run = { duration = 2.0, tolerance = 1e-11, output_step = 0.5 }
[[body]]
name = "bob"
shape = { disc = { radius = 0.1 } }
mass = 3.0
position = [2.0, 0.0]
[[body]]
name = "bead"
shape = { disc = { radius = 0.1 } }
mass = 1.0
position = [5.0, 1.0]
velocity = [0.5, 0.0]
[[body]]
name = "floor"
fixed = true
friction = 0.5
shape = { block = { width = 4.0, height = 1.0 } }
position = [10.0, -0.5]
[[body]]
name = "block"
friction = 0.5
shape = { block = { width = 0.5, height = 0.5 } }
mass = 2.0
elasticity = 0.0
position = [10.0, 0.25]
[[connector]]
name = "pivot"
pin = { a = { body = "world", point = [0.0, 0.0] }, b = { body = "bob", point = [-2.0, 0.0] } }
[[connector]]
slot = { a = { body = "world", point = [4.0, 1.0] }, b = { body = "bead", point = [0.0, 0.0] }, normal = [0.0, 1.0]}
[[force]]
name = "weight"
gravity = { acceleration = [0.0, -10.0] }
[[force]]
name = "pull"
push = { body = "block", force = [4.0, 0.0] }
"#;

fn scene(probes: &str) -> String {
    format!("{SCENE}{probes}")
}

#[test]
fn probes_tell_points_angles_distances_connectors_and_contacts() {
    let columns = told(&scene(
        r#"
        [[probe]]
        name = "tip"
        point = { body = "bob", point = [-1.0, 0.0] }
        [[probe]]
        name = "swing"
        angle = { a = "world", b = "bob" }
        [[probe]]
        name = "apart"
        distance = { a = { body = "bob", point = [0.0, 0.0] }, b = { body = "world", point = [0.0, 0.0] } }
        [[probe]]
        name = "pin"
        connector = "pivot"
        [[probe]]
        name = "rail"
        connector = 1
        [[probe]]
        name = "block on floor"
        contact = ["block", "floor"]
        "#,
    ));
    let column = |name: &str| {
        let found = columns.iter().find(|(other, _)| other == name);
        &found.unwrap_or_else(|| panic!("{name} of {columns:?}")).1
    };
    let near = |name: &str, of: &dyn Fn(usize) -> f64, within: f64| {
        for (frame, value) in column(name).iter().enumerate() {
            assert!((value - of(frame)).abs() <= within, "{name} {frame}: {value} for {}", of(frame));
        }
    };
    assert_eq!(columns.len(), 4 + 2 + 2 + 5 + 5 + 2);
    let (angle, rate) = (column("swing angle [rad]"), column("swing rate [rad/s]"));
    assert!(angle[0].abs() < 1e-15 && angle[1] < -0.1 && rate[1] < -0.1, "{angle:?} {rate:?}");
    near("tip x [m]", &|frame| angle[frame].cos(), 1e-9);
    near("tip vy [m/s]", &|frame| rate[frame] * angle[frame].cos(), 1e-9);
    near("apart distance [m]", &|_| 2.0, 1e-9);
    near("apart rate [m/s]", &|_| 0.0, 1e-9);
    near("pin angle [rad]", &|frame| angle[frame], 0.0);
    // The bob pulls the pivot, body a, away from it: m (g + r w^2) along the rod, less what turns the bob itself.
    let moment = 0.5 * 3.0 * 0.1 * 0.1;
    let force = |frame: usize| {
        let (sin, cos) = angle[frame].sin_cos();
        let turning = -3.0 * 10.0 * 2.0 * cos / (3.0 * 4.0 + moment);
        let along = -3.0 * 2.0 * rate[frame].powi(2);
        let across = 3.0 * 2.0 * turning;
        [-(along * cos - across * sin), -(along * sin + across * cos + 30.0)]
    };
    near("pin fx [N]", &|frame| force(frame)[0], 1e-7);
    near("pin fy [N]", &|frame| force(frame)[1], 1e-7);
    near("pin torque [N m]", &|_| 0.0, 1e-9);
    near("rail coordinate [m]", &|frame| 1.0 + 0.25 * frame as f64, 1e-10);
    near("rail rate [m/s]", &|_| 0.5, 1e-12);
    near("rail fy [N]", &|_| -10.0, 1e-9);
    near("block on floor fx [N]", &|_| -4.0, 1e-9);
    near("block on floor fy [N]", &|_| 20.0, 1e-9);
}

#[test]
fn tables_have_a_line_for_each_state() {
    let text = scene("[[probe]]\nname = \"a, b\"\nangle = { a = \"bob\", b = \"world\" }\n");
    let scene = Scene::parse(&text, SceneFormat::Toml).expect("it is fine");
    let mut world = World::from_scene(&scene).expect("it can be built");
    let report =
        run(&mut world, &RunPlan::of_scene(&scene, Record::Everything), &mut |_| ControlFlow::Continue(()));
    let probes = Probe::of_scene(&scene, &world).expect("it is fine");
    let mut csv = Vec::new();
    let table = ProbeTable::of(&probes, &world, &report.recording);
    table.write_csv(&mut csv).expect("memory takes everything");
    let csv = String::from_utf8(csv).expect("it is text");
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines[0], "time [s],\"a, b angle [rad]\",\"a, b rate [rad/s]\"");
    assert!(lines.len() == 6 && lines[1].starts_with("0.0,") && lines[5].starts_with("2.0,"), "{csv}");
    let picture = halfgap::picture::probes_picture("swing", &table);
    assert!(picture.contains("a, b: rate [rad/s]") && picture.matches("<path").count() > 4);
}

#[test]
fn what_is_not_there_is_refused_by_its_field() {
    let mut told = String::new();
    for probe in [
        "point = { body = \"bob\", point = [0.0, 0.0] }",
        "name = \"\"\nangle = { a = \"world\", b = \"bob\" }",
        "name = \"p\"\npoint = { body = \"bop\", point = [0.0, 0.0] }",
        "name = \"p\"\nconnector = 2",
        "name = \"p\"\nconnector = \"pivo\"",
        "name = \"p\"\ncontact = [\"bob\", \"bob\"]",
        "name = \"p\"\ncontact = [\"bob\", \"world\"]",
        "name = \"p\"\nangle = { a = \"world\", b = \"bob\" }\ncontact = [\"bob\", \"bead\"]",
        "name = \"p\"\nconnector = 0\n[[probe]]\nname = \"p\"\nconnector = 1",
        "name = \"p\"\nconnector = 0\n[[connector]]\nname = \"pivot\"\nrod = { a = { body = \"bob\", point = [0.0, 0.0] }, b = { body = \"bead\", point = [0.0, 0.0] }, length = 1.0 }",
    ] {
        let text = scene(&format!("[[probe]]\n{probe}\n"));
        let error = Scene::parse(&text, SceneFormat::Toml).expect_err(probe);
        writeln!(told, "{error}").expect("memory takes everything");
    }
    insta::assert_snapshot!(told, @r#"
    line 40: probe[0].name: is missing: a probe has a name, under which it is told
    line 41: probe[0].name: must not be empty
    line 42: probe[0].point.body: there is no body named "bop" (did you mean "bob"?)
    line 42: probe[0].connector: there is no connector 2; the scene has 2, counted from 0
    line 42: probe[0].connector: there is no connector named "pivo" (did you mean "pivot"?)
    line 42: probe[0].contact: a body makes no contact with itself
    line 42: probe[0].contact[1]: must be a body, not the background "world"
    line 40: probe[0]: must have exactly one key, found `angle` and `contact`
    line 44: probe[1].name: "p" is the name of number 0 already
    line 44: connector[2].name: "pivot" is the name of number 0 already
    "#);
}
