//! What a newcomer meets: scenes that are not what their author thinks, and what is said of them.

use halfgap::geometry::{DVec2, Shape};
use halfgap::scene::{Scene, SceneFormat};
use halfgap::{
    BodyId, BodySpec, BodyState, Finding, Record, RunError, RunPlan, RunReport, World, WorldBuilder,
    WorldSettings, run, unwatched,
};
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
        "[[2, 0], [-1, 1.7320508], [-1, -1.7320508]]",
    );
    let centred = centred.replace("position = [0.0, 1.0]", "position = [0.0, 9.0]");
    assert_eq!(world(&centred).warnings(), [""; 0]);
    // Drawn in place, the ball falls onto the horizontal arm, whose top is at y = 0.
    let kept = room.replace("fixed = true", "fixed = true\norigin = [0.0, 0.0]");
    let end = report(&kept).recording.frames.last().map(|frame| frame.states[0].position);
    assert!(end.is_some_and(|end| (end - DVec2::new(0.0, 0.5)).length() < 1e-6), "{end:?}");
}

#[test]
fn a_push_whose_point_has_left_its_body_is_told() {
    let findings = |text: &str| report(text).findings;
    let [Finding::PointLeft { law, body, point, time }] = &findings(&fault("wind.toml"))[..] else {
        panic!("{:?}", findings(&fault("wind.toml")))
    };
    assert_eq!((&**law, &**body, *point), ("force[0].constant", "ball", DVec2::ZERO));
    // The disc has a radius of 0.5 m and moves up at 1 m/s; a run looks fifty times.
    assert!((0.5..=0.54).contains(time), "{time}");
    let told = findings(&fault("wind.toml"))[0].to_string();
    assert!(
        told.starts_with(
            "at 0.52 s the point (0, 0) m at which \"force[0].constant\" pushes \"ball\" is outside"
        ),
        "{told}"
    );
    assert!(told.contains("`frame = \"body\"` keeps the point on the body"), "{told}");
    for fine in
        ["frame = \"body\", force = [1.0, 0.0]", "force = [0.0, 0.0], torque = 1.0", "force = [0.0, 1.0]"]
    {
        let text = fault("wind.toml").replace("force = [1.0, 0.0]", fine);
        // Straight up with the point, it leaves sooner or later; at rest it does not.
        let text = text
            .replace("velocity = [0.0, 1.0]", "velocity = [0.0, 0.1]")
            .replace("duration = 2.0", "duration = 0.5");
        assert_eq!(findings(&text), [], "{fine}");
    }
    // A point in coordinates of the shape, taken for one of the world, lies outside from the start on.
    let far = fault("wind.toml").replace("mass = 1.0", "mass = 1.0\nposition = [5.0, 0.0]");
    assert!(matches!(findings(&far)[..], [Finding::PointLeft { time: 0.0, .. }]), "{:?}", findings(&far));
}

#[test]
fn a_body_too_light_for_what_it_carries_is_named_with_both_masses_before_the_run() {
    let anvil = fault("63_mass_ratio.toml");
    assert_eq!(
        refusal(&anvil),
        "body[1].mass: at the start: at 0 s \"ball\" (1e-12 kg) is held between \"anvil\" (1e12 kg) and another body: what one \
         body presses or pulls on through another may be 1e10 times as heavy as that at most; make \"ball\" heavier or \
         \"anvil\" lighter, or join them into one body"
    );
    // At a ratio of 1e10 the anvil stands.
    let stands = anvil.replace("mass = 1e-12", "mass = 1e2");
    let end = report(&stands).recording.frames.last().map(|frame| frame.states[1]);
    let end = end.expect("an end");
    assert!((end.position.y - 1.0).abs() < 1e-9 && end.velocity.length() < 1e-9, "{end:?}");
    assert!(refusal(&anvil.replace("mass = 1e-12", "mass = 0.9")).contains("(0.9 kg)"));
}

#[test]
fn bodies_of_any_masses_may_meet_and_a_light_one_lie_on_a_heavy_one() {
    let anvil = fault("63_mass_ratio.toml");
    let swapped = anvil
        .replace("mass = 1e-12", "mass = 1e13")
        .replace("mass=1e12", "mass=1e-12")
        .replace("1e13", "1e12");
    let lies = report(&swapped);
    assert_eq!((lies.error, lies.findings.len()), (None, 0));
    let passes = anvil.replace("elasticity=0.0", "elasticity=0.0\npasses_through=[\"ball\",\"floor\"]");
    assert_eq!(report(&passes.replace("duration = 5.0", "duration = 0.5")).error, None);
    // Two that meet in flight: the light one leaves at twice the speed of the other.
    let meet = "format = \"halfgap-scene-1\"\ntitle = \"blow\"\nrun = { duration = 5.0 }\n\
        [[body]]\nname = \"light\"\nmass = 1e-12\nshape = { disc = { radius = 0.5 } }\n\
        [[body]]\nname = \"heavy\"\nmass = 1e12\nposition = [-3.0, 0.0]\nvelocity = [1.0, 0.0]\nshape = { disc = { radius = 0.5 } }\n";
    let end = report(meet).recording.frames.last().map(|frame| frame.states[0].velocity);
    assert!(end.is_some_and(|end| (end - DVec2::new(2.0, 0.0)).length() < 1e-12), "{end:?}");
}

#[test]
fn a_body_that_comes_to_be_squeezed_ends_the_run() {
    // The anvil falls onto the ball.
    let falls = fault("63_mass_ratio.toml").replace("position=[0.0,1.0]", "position=[0.0,1.5]");
    let falls = falls.replace("mass = 1e-12", "mass = 1e-12\nelasticity = 0.0");
    let error = report(&falls).error.expect("the anvil cannot lie on it");
    let RunError::Squeezed { time, light, heavy, masses } = &error else { panic!("{error}") };
    assert!((time - (2.0 * 0.5 / 9.81_f64).sqrt()).abs() < 1e-3, "{time}");
    assert_eq!((&**light, &**heavy), ("ball", "anvil"));
    assert!((masses[0] / 1e-12 - 1.0).abs() < 1e-15 && (masses[1] / 1e12 - 1.0).abs() < 1e-15);
}

#[test]
fn a_world_in_which_nothing_can_move_or_nothing_does_is_told() {
    let empty = "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = { duration = 1.0 }\n";
    assert_eq!(world(empty).warnings(), ["there are no bodies: nothing will happen"]);
    assert_eq!(report(empty).findings, []);
    let fixed =
        format!("{empty}[[body]]\nname = \"floor\"\nfixed = true\nshape = {{ disc = {{ radius = 1.0 }} }}\n");
    assert_eq!(world(&fixed).warnings(), ["all bodies are fixed: nothing can move"]);
    let still =
        format!("{empty}[[body]]\nname = \"ball\"\nmass = 1.0\nshape = {{ disc = {{ radius = 1.0 }} }}\n");
    assert_eq!(report(&still).findings, [Finding::NothingMoved]);
    for moves in ["velocity = [1e-9, 0.0]", "[[force]]\ngravity = { acceleration = [0.0, -1e-9] }"] {
        assert_eq!(report(&format!("{still}{moves}\n")).findings, [], "{moves}");
    }
    // Bodies that forces hold where they are do not move, but something happens.
    let pulled = "constant = { body = \"ball\", point = [0, 0], force = [1, 0] }";
    let held = format!("{still}[[force]]\n{pulled}\n[[force]]\n{}\n", pulled.replace("[1, 0]", "[-1, 0]"));
    assert_eq!(report(&held).findings, []);
}

#[test]
fn forces_without_a_direction_are_told() {
    let same = fault("75_mutual_gravity_same_point.toml");
    let attract = "bodies \"ball\" and \"b2\" start at the same place, where force[0].mutual_gravity has no direction: they do \
                   not attract each other";
    assert_eq!(world(&same).warnings(), [attract]);
    assert_eq!(report(&same).findings, [Finding::NothingMoved]);
    let spring = "spring = { a = { body = \"ball\", point = [0, 0] }, b = { body = \"b2\", point = [0, 0] }, stiffness = 1, \
                  rest_length = 1.0 }";
    let tied = same.replace("mutual_gravity={strength=1.0}", spring);
    let told =
        "the ends of force[0].spring start at the same place, where it has no direction: it does not push";
    assert_eq!(world(&tied).warnings(), [told]);
    assert_eq!(world(&tied.replace("rest_length = 1.0", "rest_length = 0.0")).warnings(), [""; 0]);
    let apart = same.replace("name = \"b2\"", "name = \"b2\"\nposition = [1.0, 0.0]");
    assert_eq!(world(&apart).warnings(), [""; 0]);
}

/// A block that turns at a rate, above a floor onto which it falls.
fn spinning_block(rate: f64) -> String {
    format!(
        "format = \"halfgap-scene-1\"\ntitle = \"spin\"\nrun = {{ duration = 1.0 }}\n\
         [[body]]\nname = \"floor\"\nfixed = true\nshape = {{ block = {{ width = 10.0, height = 1.0 }} }}\nposition = [0.0, -2.0]\n\
         [[body]]\nname = \"spinner\"\nmass = 1.0\nangular_velocity = {rate:?}\nshape = {{ block = {{ width = 1.0, height = 0.5 }} }}\n\
         [[force]]\ngravity = {{ acceleration = [0.0, -9.81] }}\n"
    )
}

#[test]
fn a_body_that_turns_too_fast_to_be_followed_is_named_and_others_are_not() {
    let error = report(&spinning_block(1e9)).error.expect("it cannot be followed");
    let RunError::TooFast { body, angular_velocity: 1e9, duration: 1.0, .. } = &error else {
        panic!("{error}")
    };
    assert_eq!(body, "spinner");
    assert!(
        error.to_string().contains("body \"spinner\" turns at 1e9 rad/s: too fast to follow for the 1 s"),
        "{error}"
    );
    // Half a million turns are followed; any number of a disc, or of a block that has nothing to hit.
    assert_eq!(report(&spinning_block(3e6)).error, None);
    let disc = spinning_block(1e10)
        .replace("{ block = { width = 1.0, height = 0.5 } }", "{ disc = { radius = 0.5 } }");
    assert_eq!(report(&disc).error, None);
    let alone = spinning_block(1e12).replace("fixed = true", "fixed = true\npasses_through = [\"spinner\"]");
    assert_eq!(report(&alone).error, None);
}

#[test]
fn a_tied_body_that_turns_too_fast_is_named_and_a_shorter_run_goes_on() {
    let pinned = spinning_block(1e9).replace("mass = 1.0", "mass = 1.0\npasses_through = [\"floor\"]")
        + "[[connector]]\npin = { a = { body = \"world\", point = [0, 0] }, b = { body = \"spinner\", point = [0, 0] } }\n";
    // A planned duration would count for the shorter run, too.
    let mut spinner = world(&pinned.replace("duration = 1.0", "duration = 1e-3"));
    let error = spinner.advance_to(1.0, &mut |_| ()).expect_err("it cannot be followed");
    assert!(matches!(error, RunError::TooFast { .. }), "{error}");
    let soon = spinner.time() + 1e-3;
    spinner.advance_to(soon, &mut |_| ()).expect("so many turns are followed");
    assert_eq!(spinner.time(), soon);
    let mut builder = WorldBuilder::new(WorldSettings::default());
    builder.add(BodySpec::movable(
        "free",
        Shape::block(1.0, 0.5).expect("a block"),
        1.0,
        BodyState { angular_velocity: 1e12, ..BodyState::default() },
    ));
    builder.build().expect("it turns").advance_to(100.0, &mut |_| ()).expect("nobody follows it");
}

#[test]
fn a_pendulum_that_swings_to_and_fro_for_years_does_not_turn_without_end() {
    let text = "format = \"halfgap-scene-1\"\ntitle = \"clock\"\nrun = { duration = 6e8 }\n\
        [[body]]\nname = \"bob\"\nmass = 1.0\nposition = [0.3, -0.4]\nshape = { disc = { radius = 0.1 } }\n\
        [[connector]]\npin = { a = { body = \"world\", point = [0, 0] }, b = { body = \"bob\", point = [-0.3, 0.4] } }\n\
        [[force]]\ngravity = { acceleration = [0.0, -9.81] }\n";
    let mut clock = world(text);
    // Ten means of its steps, at which it turns at some 3 rad/s.
    clock.advance_to(1.5e4, &mut |_| ()).expect("it swings");
    assert!(clock.statistics().steps > 100_000, "{}", clock.statistics().steps);
}
