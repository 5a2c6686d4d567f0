//! Shapes made for machines, against what is true of any correct outline of them.

use halfgap::World;
use halfgap::geometry::{DVec2, Shape};
use halfgap::scene::{Scene, SceneFormat};
use halfgap_tests::data;
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};
use std::fs::read_to_string;

/// The world of one body of a shape, about the origin.
fn body_of(shape: &Value) -> Result<World, String> {
    let scene = json!({"format": "halfgap-scene-1", "title": "a shape", "run": {"duration": 1},
        "body": [{"name": "it", "shape": shape, "mass": 1, "origin": [0, 0]}]});
    let scene = Scene::parse(&scene.to_string(), SceneFormat::Json).map_err(|error| error.to_string())?;
    World::from_scene(&scene).map_err(|error| error.to_string())
}

fn shape_of(shape: &Value) -> Shape {
    let world = body_of(shape).unwrap_or_else(|error| panic!("{shape}: {error}"));
    let body = world.bodies().next().expect("one body");
    // Shapes of worlds have their centre of mass at the origin.
    world.shape(body).translated(world.center_of_mass(body))
}

fn cases(name: &str) -> Vec<(Value, Value)> {
    let text = read_to_string(data(&format!("figures/{name}.json"))).expect("a readable file");
    let mut file: Value = serde_json::from_str(&text).expect("JSON");
    let cases = file["cases"].as_array_mut().expect("cases");
    cases.iter_mut().map(|case| (case["shape"].take(), case["figures"].take())).collect()
}

fn number(of: &Value) -> f64 {
    of.as_f64().unwrap_or_else(|| panic!("{of} is a number"))
}

fn point(of: &Value) -> DVec2 {
    DVec2::new(number(&of[0]), number(&of[1]))
}

/// Length [m] of the outline.
fn length(shape: &Shape) -> f64 {
    shape.edges().map(halfgap::geometry::Edge::length).sum()
}

/// Largest distance [m] of points from the outline.
fn off(shape: &Shape, points: impl IntoIterator<Item = DVec2>) -> f64 {
    points.into_iter().map(|point| shape.nearest(point).signed_distance.abs()).fold(0.0, f64::max)
}

#[test]
fn gears_have_their_circles_and_flanks() {
    for (shape, figures) in cases("gears") {
        let wheel = shape_of(&shape);
        let (gear, tolerance) = (&shape["gear"], 1e-4 * number(&shape["gear"]["module"]));
        assert!((wheel.reach() - number(&figures["tip_radius"])).abs() < 1e-12, "{shape}");
        let root = number(&figures["root_radius_full_depth_1.25"]);
        let teeth = number(&gear["teeth"]);
        let least = wheel.nearest(DVec2::ZERO).signed_distance;
        assert!((least + root).abs() < 1e-12, "{shape}: {least}");
        let tip = |side: f64| DVec2::from_angle(side * number(&figures["half_tooth_angle_at_tip"]));
        let ends = [1.0, -1.0].map(|side| tip(side) * number(&figures["tip_radius"]));
        assert!(off(&wheel, ends) < tolerance, "{shape}");
        let flank = figures["flank_points_of_the_tooth_about_the_x_axis"].as_array().expect("points");
        let sides = [1.0, -1.0].map(|side| DVec2::new(1.0, side));
        let flanks = flank.iter().flat_map(|at| sides.map(|side| point(at) * side));
        assert!(off(&wheel, flanks) <= tolerance, "{shape}: {}", off(&wheel, flank.iter().map(point)));
        // What is above a circle is the whole less the disc in it, and less what radial flanks leave below it.
        let area = wheel.mass_properties().area;
        let (expected, below) = match &figures["area_above_base_circle"] {
            Value::Null => (number(&figures["area_above_root_circle"]), PI * root * root),
            above => {
                let base = number(&figures["base_radius"]);
                let base_half = half_tooth_at_base(gear, base);
                (number(above), PI * root * root + teeth * base_half * (base * base - root * root))
            }
        };
        let error = (area - below - expected).abs();
        assert!(error <= tolerance * length(&wheel), "{shape}: {error} m^2");
    }
}

/// Half of the angle [rad] of a tooth where its flanks begin, without backlash.
fn half_tooth_at_base(gear: &Value, base: f64) -> f64 {
    let (module, teeth) = (number(&gear["module"]), number(&gear["teeth"]));
    let tangent = ((0.5 * module * teeth / base).powi(2) - 1.0).sqrt();
    PI / (2.0 * teeth) + tangent - tangent.atan()
}

#[test]
fn ratchets_have_their_corners() {
    for (shape, figures) in cases("ratchet") {
        let wheel = shape_of(&shape);
        let mass = wheel.mass_properties();
        assert!(
            (mass.area - number(&figures["area"])).abs() < 1e-13 && mass.centroid.length() < 1e-13,
            "{shape}"
        );
        assert_eq!(Some(wheel.edges().count() as u64), figures["corners"].as_u64());
        let radii: Vec<f64> = wheel.edges().map(|edge| edge.from().length()).collect();
        let [least, largest] =
            [f64::min, f64::max].map(|of: fn(f64, f64) -> f64| radii.iter().copied().fold(radii[0], of));
        assert!((largest - number(&figures["largest_radius"])).abs() < 1e-12);
        assert!((least - number(&figures["smallest_radius_of_a_corner"])).abs() < 1e-12);
    }
}

#[test]
fn geneva_wheels_let_the_pin_in_and_through() {
    for (shape, figures) in cases("geneva") {
        // The figures tell a wheel by its radius and the width of its slots.
        let (slots, width) = (number(&shape["geneva"]["slots"]), number(&shape["geneva"]["slot_width"]));
        let distance = number(&figures["center_distance"]);
        let wheel = shape_of(
            &json!({"geneva": {"slots": slots as u64, "center_distance": distance, "pin_radius": width / 2.0}}),
        );
        assert!(wheel.mass_properties().centroid.length() < 1e-12, "{shape}");
        assert!(
            wheel.reach() <= number(&figures["largest_radius_at_most"]) * (1.0 + 1e-12),
            "{shape}: {}",
            wheel.reach()
        );
        let (from, half_width) =
            (number(&figures["free_along_each_slot_from"]), number(&figures["free_half_width"]));
        for slot in 0..slots as u32 {
            let direction = DVec2::from_angle(f64::from(slot) * TAU / slots);
            for step in 0..=50 {
                let at = from + (distance - from) * f64::from(step) / 50.0;
                assert!(
                    wheel.nearest(at * direction).signed_distance >= half_width - 1e-12,
                    "{shape} at {at}"
                );
            }
        }
    }
}

#[test]
fn cams_lift_their_rollers() {
    for (shape, figures) in cases("cam") {
        let cam = shape_of(&shape);
        let (roller, tolerance) = (number(&shape["cam"]["roller"]), 1e-4 * number(&shape["cam"]["base"]));
        for at in figures["points"].as_array().expect("points") {
            let room = cam.nearest(point(&at["roller_center"])).signed_distance;
            assert!((room - roller).abs() <= tolerance, "{at}: {room} m");
            assert!(off(&cam, [point(&at["profile"])]) <= tolerance, "{at}");
        }
    }
}

#[test]
fn capsules_and_polygons_are_those_written_out() {
    for name in ["capsule", "regular"] {
        let worlds = ["toml", "json"].map(|ending| {
            let scene = Scene::read(data(&format!("language/{name}.{ending}"))).expect("a good scene");
            World::from_scene(&scene).expect("a good world")
        });
        let [written, plain] = &worlds;
        let (body, same) = (written.bodies().next().expect("one"), plain.bodies().next().expect("one"));
        let [mass, expected] =
            [(written, body), (plain, same)].map(|(world, body)| world.shape(body).mass_properties());
        assert!(
            (mass.area - expected.area).abs() < 1e-15
                && (mass.moment_per_mass - expected.moment_per_mass).abs() < 1e-15
        );
        let corners = |shape: &Shape| shape.edges().map(halfgap::geometry::Edge::from).collect::<Vec<_>>();
        assert!(off(written.shape(body), corners(plain.shape(same))) < 1e-15, "{name}");
        assert_eq!(corners(written.shape(body)).len(), corners(plain.shape(same)).len());
        assert!((written.state(body).position - plain.state(same).position).length() < 1e-15);
    }
}

#[test]
fn measures_that_make_no_shape_are_told_at_their_field() {
    let message = |shape: Value| body_of(&shape).expect_err("it is impossible");
    for (shape, expected) in [
        (
            json!({"gear": {"module": 0.1, "teeth": 2}}),
            "line 1: body[0].shape.gear.teeth: must lie between 3 and 100000, got 2",
        ),
        (
            json!({"gear": {"module": 0.125, "teeth": 12, "addendum": 3}}),
            "body[0].shape: addendum times module is 0.375 m, but must be less than 0.1752923 m",
        ),
        (
            json!({"cam": {"base": 1, "roller": 0.1, "lift": {"speed": 1}}}),
            "body[0].shape: the lift is another after a turn, by 1 m: it must come back to where it began",
        ),
        (
            json!({"cam": {"base": 1, "roller": 0.1, "lift": {"table": {"times": [0, 0.5], "values": [0, 1]}}}}),
            "line 1: body[0].shape.cam.lift.table.times: go from 0 to 0.5, but a turn from 0 to 1",
        ),
        (
            json!({"ratchet": {"teeth": 12, "outer": 1, "inner": 2}}),
            "line 1: body[0].shape.ratchet.inner: must be less than outer (1 m), got 2 m",
        ),
        (
            json!({"geneva": {"slots": 4, "center_distance": 1, "pin_radius": 0.5}}),
            "body[0].shape: pin_radius and clearance is 0.5 m, but must be less than 0.2071068 m",
        ),
    ] {
        assert_eq!(message(shape), expected);
    }
}

/// Two gears of 20 and 30 teeth with some play, of which the first is driven at a constant speed and friction in its pin holds the second
/// against it.
fn mesh(tolerance: f64, backlash: f64) -> Scene {
    let (module, ends) = (0.02, [20.0, 30.0]);
    let gear = |teeth: f64| json!({"gear": {"module": module, "teeth": teeth as u64, "tolerance": tolerance, "backlash": backlash}});
    let distance = 0.5 * module * (ends[0] + ends[1]);
    // A space of the second looks at the tooth of the first.
    let scene = json!({"format": "halfgap-scene-1", "title": "two gears", "run": {"duration": 2.0, "tolerance": 1e-9},
        "body": [
            {"name": "driver", "shape": gear(ends[0]), "mass": 1, "elasticity": 0, "angular_velocity": 1.0},
            {"name": "driven", "shape": gear(ends[1]), "mass": 1, "elasticity": 0, "position": [distance, 0], "angle": PI + PI / ends[1],
             "angular_velocity": -ends[0] / ends[1]}],
        "connector": [
            {"pin": {"a": {"body": "world", "point": [0, 0]}, "b": {"body": "driver", "point": [0, 0]}, "drive": {"speed": 1.0}}},
            {"pin": {"a": {"body": "world", "point": [distance, 0]}, "b": {"body": "driven", "point": [0, 0]}, "friction_torque": 0.05}}]});
    Scene::parse(&scene.to_string(), SceneFormat::Json).expect("a good scene")
}

#[test]
fn a_wheel_driven_by_another_turns_evenly_within_the_tolerance_of_the_flanks() {
    let (tolerance, backlash) = (2e-5, 1e-4);
    let scene = mesh(tolerance, backlash);
    let mut world = World::from_scene(&scene).unwrap_or_else(|error| panic!("{error}"));
    let driven = world.bodies().nth(1).expect("two bodies");
    let before = world.state(driven).angle;
    let pitch = 0.3;
    let base = pitch * (PI / 9.0).cos();
    // Half of the play is left behind: within a tenth of a second friction has brought flank to flank.
    let lag = 0.5 * backlash / pitch;
    for step in 10..=200 {
        let time = 0.01 * f64::from(step);
        world.advance_to(time, &mut |_| ()).unwrap_or_else(|error| panic!("{time} s: {error}"));
        let off = world.state(driven).angle - before + time * 20.0 / 30.0 - lag;
        assert!(off.abs() <= 2.0 * tolerance / base, "{time} s: {off} rad");
    }
}
