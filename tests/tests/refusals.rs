//! What is not simulated yet is refused with bodies and time named, never ignored.

use halfgap::scene::{Scene, SceneFormat};
use halfgap::{RunError, World};
use halfgap_tests::{stop_before, world_of};

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

fn on_floor(body: &str) -> String {
    format!("{FLOOR}\n[[body]]\nname = \"body\"\nmass = 1.0\n{body}")
}

fn build_error(toml: &str) -> String {
    let scene = Scene::parse(toml, SceneFormat::Toml).expect("a fine scene");
    World::from_scene(&scene).expect_err("refused").to_string()
}

#[test]
fn a_resting_contact_is_refused_when_it_forms() {
    let mut world =
        world_of(&on_floor("shape = { disc = { radius = 0.5 } }\nposition = [0.0, 1.75]\nelasticity = 0.0"));
    let error = stop_before(&mut world, 10.0);
    assert!(matches!(&error, RunError::RestingContact { time, .. } if (*time - 0.5).abs() < 1e-6), "{error}");
    let message = error.to_string();
    assert!(message.contains("\"body\" comes to rest on \"floor\""), "{message}");
}

#[test]
fn a_body_that_starts_at_rest_on_the_floor_is_refused_at_once() {
    let mut world = world_of(&on_floor("shape = { disc = { radius = 0.5 } }\nposition = [0.0, 0.5]"));
    assert!(matches!(stop_before(&mut world, 10.0), RunError::RestingContact { time, .. } if time < 1e-3));
}

#[test]
fn a_bouncing_ball_stops_when_it_has_lost_its_bounce() {
    let mut world =
        world_of(&on_floor("shape = { disc = { radius = 0.5 } }\nposition = [0.0, 1.75]\nelasticity = 0.5"));
    let error = stop_before(&mut world, 10.0);
    // Drop of 0.5 s, then bounces of 0.5, 0.25, ... s: a geometric series that ends at 1.5 s.
    assert!(matches!(error, RunError::RestingContact { time, .. } if (time - 1.5).abs() < 1e-5), "{error}");
}

#[test]
fn an_impact_of_three_rows_is_refused_with_its_bodies() {
    let discs: String = [(-0.6, 0.0), (0.6, 0.0), (0.0, -0.6)]
        .iter()
        .enumerate()
        .map(|(index, (x, y))| {
            let (vx, vy) = (-x, -y);
            format!(
                "[[body]]\nname = \"disc {index}\"\nmass = 1.0\nshape = {{ disc = {{ radius = 0.1 }} }}\n\
                 position = [{x}, {y}]\nvelocity = [{vx}, {vy}]\n"
            )
        })
        .collect();
    let scene = format!(
        "format = \"halfgap-scene-1\"\ntitle = \"test\"\n[run]\nduration = 2.0\nimpact_law = \"simultaneous\"\n\
         [[body]]\nname = \"middle\"\nmass = 1.0\nshape = {{ disc = {{ radius = 0.1 }} }}\n{discs}"
    );
    let error = stop_before(&mut world_of(&scene), 2.0);
    assert!(matches!(error, RunError::Impact { .. }), "{error}");
    let message = error.to_string();
    for part in ["\"middle\"", "\"disc 0\"", "\"disc 1\"", "\"disc 2\"", "3 rows"] {
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn an_overlap_at_the_start_names_both_bodies_and_its_depth() {
    let message = build_error(&on_floor("shape = { disc = { radius = 0.5 } }\nposition = [0.0, 0.4]"));
    for part in ["\"floor\"", "\"body\"", "overlap by 0.0999"] {
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn a_body_inside_another_overlaps_it() {
    let message = build_error(&on_floor("shape = { disc = { radius = 0.1 } }\nposition = [0.0, -0.5]"));
    assert!(message.contains("overlap by 0.5 m"), "{message}");
}

#[test]
fn a_tiny_overlap_is_lifted_to_the_target_gap() {
    let body = "shape = { disc = { radius = 0.5 } }\nposition = [0.0, 0.4999999]\nvelocity = [0.0, 3.0]";
    let world = world_of(&on_floor(body));
    let disc = world.find("body").expect("it is there");
    let gap = world.state(disc).position.y - 0.5;
    let target = world.tolerances().target_gap;
    assert!((gap - target).abs() < 1e-3 * target, "gap {gap}, target {target}");
    assert!(world.start_correction() > 1e-7);
}
