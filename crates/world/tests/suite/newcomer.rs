//! What a newcomer meets: scenes that are not what their author thinks, and what is said of them.

use halfgap::geometry::{DVec2, Shape};
use halfgap::scene::{Scene, SceneFormat};
use halfgap::{BodyId, BodySpec, BodyState, Record, RunPlan, RunReport, World, run, unwatched};
use std::path::Path;

/// Text of a scene that went wrong once.
fn fault(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/faults");
    std::fs::read_to_string(folder.join(name)).expect("the scene is there")
}

fn scene(text: &str) -> Scene {
    Scene::parse(text, SceneFormat::Toml).unwrap_or_else(|error| panic!("{error}"))
}

fn world(text: &str) -> World {
    World::from_scene(&scene(text)).unwrap_or_else(|error| panic!("{error}"))
}

fn refusal(text: &str) -> String {
    let parsed = Scene::parse(text, SceneFormat::Toml);
    parsed.and_then(|scene| World::from_scene(&scene)).expect_err("it is refused").to_string()
}

/// Runs a scene without a recording of everything.
fn report(text: &str) -> RunReport {
    run(&mut world(text), &RunPlan::of_scene(&scene(text), Record::Ends), &mut unwatched)
}

const L: [[f64; 2]; 6] = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]];

/// An L at an origin and an angle, with or without a centre of mass of its own.
fn angle_iron(place: &str) -> World {
    world(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"angle iron\"\nrun = {{ duration = 1.0 }}\n[[body]]\nname = \"iron\"\n\
         mass = 1.0\nshape = {{ polygon = {{ vertices = {L:?} }} }}\n{place}"
    ))
}

#[test]
fn the_origin_of_a_shape_is_put_where_the_scene_says() {
    let corner = |world: &World| {
        let (state, center) = (world.state(BodyId(0)), world.center_of_mass(BodyId(0)));
        state.pose().point_to_world(-center)
    };
    for place in [
        "origin = [2.0, -5.0]",
        "origin = [2.0, -5.0]\nangle = 0.7",
        "origin = [2.0, -5.0]\nangle = -2.0\ncenter_of_mass = [0.5, 0.25]",
    ] {
        let found = corner(&angle_iron(place));
        assert!((found - DVec2::new(2.0, -5.0)).length() < 1e-14, "{place}: {found}");
    }
    assert_eq!(angle_iron("position = [2.0, -5.0]").state(BodyId(0)).position, DVec2::new(2.0, -5.0));
    assert_eq!(angle_iron("angle = 1.0").state(BodyId(0)).position, DVec2::ZERO);
    let vertices = L.map(DVec2::from);
    let state = BodyState { angle: 0.7, ..BodyState::default() };
    let shape = Shape::polygon(&vertices).expect("an L");
    let iron = BodySpec::movable("iron", shape, 1.0, state).with_origin(DVec2::new(2.0, -5.0));
    assert_eq!(
        iron.state.position,
        angle_iron("origin = [2.0, -5.0]\nangle = 0.7").state(BodyId(0)).position
    );
}

#[test]
fn a_body_has_a_position_or_an_origin() {
    let both =
        fault("offset_room.toml").replace("fixed = true", "fixed = true\nposition = [0, 0]\norigin = [0, 0]");
    assert_eq!(refusal(&both), "line 9: body[0].origin: give position or origin, not both");
    let nan = fault("offset_room.toml").replace("fixed = true", "fixed = true\norigin = [nan, 0]");
    assert_eq!(refusal(&nan), "line 8: body[0].origin[0]: must be a finite number, got NaN");
    let far = fault("offset_room.toml").replace("fixed = true", "fixed = true\norigin = [1e70, 0]");
    assert!(refusal(&far).contains("body[0].origin: "), "{}", refusal(&far));
    let on_it = fault("offset_room.toml").replace("fixed = true", "fixed = true\norigin = [0, 0]");
    let on_it =
        on_it.replace("mass = 1.0", "mass = 1.0\norigin = [0.0, 0.2]").replace("position = [0.0, 1.0]\n", "");
    assert!(
        refusal(&on_it).contains("body[1].origin: bodies \"wall\" and \"ball\" overlap"),
        "{}",
        refusal(&on_it)
    );
}

#[test]
fn a_room_that_is_moved_from_where_it_is_drawn_is_told() {
    let room = fault("offset_room.toml");
    let told = world(&room).warnings().to_vec();
    assert_eq!(
        told,
        [
            "fixed body \"wall\" is not where it is drawn: without `position` or `origin` its centroid, (0.264, -0.318) m in \
             the drawing, is put at (0, 0); `origin = [0.0, 0.0]` keeps the drawing in place, `position = [0.0, 0.0]` says \
             that it is meant"
        ]
    );
    for place in ["origin = [0.0, 0.0]", "position = [0.0, 0.0]", "center_of_mass = [0.0, 0.0]"] {
        let placed = room.replace("fixed = true", &format!("fixed = true\n{place}"));
        assert_eq!(world(&placed).warnings(), [""; 0], "{place}");
    }
    // A drawing about its centroid, but for the seven digits with which it is written.
    let centred = room.replace(
        "[[-3,-1],[3,-1],[3,3],[2.8,3],[2.8,0],[-3,0]]",
        "[[1, 0], [-0.5, 0.8660254], [-0.5, -0.8660254]]",
    );
    assert_eq!(world(&centred).warnings(), [""; 0]);
    // Drawn in place, the ball falls onto the horizontal arm, whose top is at y = 0.
    let kept = room.replace("fixed = true", "fixed = true\norigin = [0.0, 0.0]");
    let end = report(&kept).recording.frames.last().map(|frame| frame.states[0].position);
    assert!(end.is_some_and(|end| (end - DVec2::new(0.0, 0.5)).length() < 1e-6), "{end:?}");
}
