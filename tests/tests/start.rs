//! What overlaps at the start is refused with bodies and depth.

use halfgap::World;
use halfgap::scene::{Scene, SceneFormat};
use halfgap_tests::{on_floor, world_of};

fn build_error(toml: &str) -> String {
    let scene = Scene::parse(toml, SceneFormat::Toml).expect("a fine scene");
    World::from_scene(&scene).expect_err("refused").to_string()
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

#[test]
fn the_background_has_a_name_where_an_error_needs_one() {
    let world =
        halfgap_tests::world_of("format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = { duration = 1.0 }");
    assert_eq!(world.name(halfgap::BodyId::WORLD), "world");
}

#[test]
fn a_mass_whose_inverse_overflows_is_refused() {
    let scene = halfgap::scene::Scene::parse(
        "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = { duration = 1.0 }\n\
         [[body]]\nname = \"mote\"\nmass = 1e-309\nshape = { disc = { radius = 1.0 } }",
        halfgap::scene::SceneFormat::Toml,
    );
    let error = halfgap::World::from_scene(&scene.expect("it can be read")).expect_err("nothing is so light");
    assert!(error.to_string().contains("mote") && error.to_string().contains("inverse"), "{error}");
}
