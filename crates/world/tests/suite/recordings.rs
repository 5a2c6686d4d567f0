//! Runs, their recordings, and pictures of recordings that have nothing much to show.

use halfgap::picture::{energy_picture, events_picture, scene_picture};
use halfgap::scene::{Scene, SceneFormat};
use halfgap::{
    BodyId, BodyState, ConnectorId, ContactChange, ContactEvent, ContactForce, ContactRecord, Energy, Frame,
    Impact, ImpactRow, Reached, Record, Recording, RunError, RunPlan, World, run, unwatched,
};
use std::ops::ControlFlow;

fn scene(duration: f64, run: &str, position: &str) -> Scene {
    let text = format!(
        "format = \"halfgap-scene-1\"\ntitle = \"A <b> & co\"\n[run]\nduration = {duration}\n{run}\n\
         [[body]]\nname = \"rim, \\\"fixed\\\"\"\nfixed = true\nshape = {{ ring = {{ outer = 3.0, inner = 2.5 }} }}\n\
         [[body]]\nname = \"disc\"\nshape = {{ disc = {{ radius = 0.5 }} }}\nmass = 2.0\n\
         position = {position}\nvelocity = [0.25, 0.0]\n"
    );
    Scene::parse(&text, SceneFormat::Toml).unwrap_or_else(|error| panic!("{error}"))
}

fn world(scene: &Scene) -> World {
    World::from_scene(scene).unwrap_or_else(|error| panic!("{error}"))
}

fn times(recording: &Recording) -> Vec<f64> {
    recording.frames.iter().map(|frame| frame.time).collect()
}

#[test]
fn output_times_are_counted_from_the_start_and_include_the_end() {
    let scene = scene(1.0, "start_time = 5.0\noutput_step = 0.4", "[0, 0]");
    let plan = RunPlan::of_scene(&scene, Record::Everything);
    let mut parts = Vec::new();
    let report = run(&mut world(&scene), &plan, &mut |reached| {
        parts.push(*reached);
        ControlFlow::Continue(())
    });
    assert_eq!(times(&report.recording), [5.0, 5.4, 5.8, 6.0]);
    assert_eq!(parts.last(), Some(&Reached { fraction: 1.0, time: 6.0, events: 0 }));
    let ends = RunPlan::of_scene(&scene, Record::Ends);
    assert_eq!(times(&run(&mut world(&scene), &ends, &mut unwatched).recording), [5.0, 6.0]);
}

#[test]
fn a_step_that_divides_the_duration_leaves_no_sliver_at_the_end() {
    let scene = scene(0.3, "output_step = 0.1", "[0, 0]");
    let plan = RunPlan::of_scene(&scene, Record::Everything);
    let recording = run(&mut world(&scene), &plan, &mut unwatched).recording;
    assert_eq!(recording.frames.len(), 4);
    assert_eq!(recording.frames[3].time, 0.3);
}

#[test]
fn stops_are_hit_exactly_at_both_ends_and_between() {
    let scene = scene(1.0, "output_step = 0.4", "[0, 0]");
    let mut plan = RunPlan::of_scene(&scene, Record::Everything);
    plan.stops = vec![0.0, 0.3, 0.3, 0.4, 1.0];
    let report = run(&mut world(&scene), &plan, &mut unwatched);
    let stops: Vec<f64> = report.stops.iter().map(|frame| frame.time).collect();
    assert_eq!(stops, plan.stops);
    assert_eq!(times(&report.recording), [0.0, 0.4, 0.8, 1.0]);
}

#[test]
fn a_run_can_be_broken_off_at_its_start_at_an_event_and_at_an_output() {
    let scene = scene(1.0, "output_step = 0.25", "[1.9, 0]");
    let plan = RunPlan::of_scene(&scene, Record::Everything);
    let whole = run(&mut world(&scene), &plan, &mut unwatched).recording;
    let bounce = whole.impacts[0].time;
    for (calls, time) in [(1, 0.0), (2, 0.25), (3, bounce), (4, 0.5)] {
        let mut left = calls;
        let report = run(&mut world(&scene), &plan, &mut |_| {
            left -= 1;
            if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert_eq!(report.error, Some(RunError::Interrupted { time }));
        let recording = report.recording;
        assert_eq!(recording.frames.last().map(|frame| frame.time), Some(time));
        assert_eq!(recording.impacts.len(), usize::from(time >= bounce));
    }
    let mut last = 0.0;
    let report = run(&mut world(&scene), &plan, &mut |reached| {
        last = reached.fraction;
        if last < 1.0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    assert_eq!((report.error, last), (None, 1.0), "a run that has arrived is complete");
}

#[test]
fn a_plan_that_ends_before_it_starts_is_refused() {
    let scene = scene(1.0, "", "[0, 0]");
    let plan = RunPlan { end_time: -1.0, ..RunPlan::of_scene(&scene, Record::Ends) };
    let report = run(&mut world(&scene), &plan, &mut unwatched);
    let message = report.error.map(|error| error.to_string());
    assert_eq!(message.as_deref(), Some("the plan's end_time must be no earlier than start_time, got -1 s"));
}

#[test]
fn names_are_escaped_wherever_they_are_written() {
    let scene = scene(1.0, "", "[0, 0]");
    let world = world(&scene);
    let mut recording = Recording::new(scene.title.clone(), &world);
    recording.frames.push(recording.frame_of(&world));
    recording.impacts.push(impact(0.5, 2.0));
    let mut csv = Vec::new();
    recording.write_impacts_csv(&mut csv).expect("memory takes everything");
    let csv = String::from_utf8(csv).expect("text");
    assert_eq!(
        csv.lines().nth(1),
        Some("0,0.5,disc,\"rim, \"\"fixed\"\"\",1.0,0.0,-1.0,0.0,0.01,-1.0,1.0,2.0,0.0,")
    );
    let picture = scene_picture(&world, &recording, &recording.frames[0]);
    assert!(picture.contains("A &lt;b&gt; &amp; co"), "{picture}");
}

#[test]
fn a_ring_is_drawn_as_four_true_half_circles() {
    let scene = scene(1.0, "", "[0, 0]");
    let world = world(&scene);
    let mut recording = Recording::new("", &world);
    recording.frames.push(recording.frame_of(&world));
    let picture = scene_picture(&world, &recording, &recording.frames[0]);
    let ring = picture.lines().find(|line| line.contains("#d8dbd6")).expect("the fixed ring");
    assert_eq!(ring.matches('A').count(), 4, "{ring}");
    assert_eq!(ring.matches('Z').count(), 2, "{ring}");
    assert!(picture.contains("fill-rule=\"evenodd\""));
}

#[test]
fn connectors_are_drawn() {
    let text = "format = \"halfgap-scene-1\"\ntitle = \"ties\"\n[run]\nduration = 1.0\n\
        [[body]]\nname = \"a\"\nshape = { disc = { radius = 0.1 } }\nmass = 1.0\nposition = [1.0, 0.0]\n\
        [[body]]\nname = \"b\"\nshape = { disc = { radius = 0.1 } }\nmass = 1.0\nposition = [2.0, 0.0]\n\
        [[connector]]\nrod = { a = { body = \"world\", point = [0.0, 0.0] }, b = { body = \"a\", point = [0.0, 0.0] }, length = 1.0 }\n\
        [[connector]]\nrope = { a = { body = \"a\", point = [0.0, 0.0] }, b = { body = \"b\", point = [0.0, 0.0] }, length = 1.5 }\n\
        [[connector]]\nslot = { a = { body = \"world\", point = [2.0, 0.0] }, b = { body = \"b\", point = [0.0, 0.0] }, normal = [0.0, 1.0] }\n\
        [[connector]]\nrail = { a = { body = \"b\", point = [0.0, 0.0] }, path = { points = [[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]] } }\n\
        [[connector]]\nrail_stop = { a = { body = \"b\", point = [0.0, 0.0] }, path = { points = [[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]] }, at = 1.5, upper = true }\n\
        [[force]]\nspring = { a = { body = \"a\", point = [0.0, 0.0] }, b = { body = \"b\", point = [0.0, 0.0] }, rest_length = 1.0, stiffness = 2.0, damping = 0.5 }\n";
    let scene = Scene::parse(text, SceneFormat::Toml).unwrap_or_else(|error| panic!("{error}"));
    let world = world(&scene);
    let mut recording = Recording::new("", &world);
    recording.frames.push(recording.frame_of(&world));
    let picture = scene_picture(&world, &recording, &recording.frames[0]);
    assert_drawable(&picture);
    let ties: Vec<&str> = picture.lines().filter(|line| line.contains("#4c5459")).collect();
    // The rail, through many points, and its stop, then the rod, the rope with its dashes, the slot's line
    // and ring, and the spring, whose dashpot lies beside it.
    assert_eq!(ties.len(), 7, "{ties:?}");
    assert!(ties[0].matches('L').count() > 200, "{}", ties[0]);
    for bar in [ties[1], ties[2], ties[4]] {
        assert!(bar.contains("<path") && bar.matches('L').count() == 1 && !bar.contains("dash"), "{bar}");
    }
    assert!(ties[3].contains("dash") && ties[5].contains("<circle"), "{ties:?}");
    assert_eq!(ties[6].matches('L').count(), 11, "{}", ties[6]);
}

fn impact(time: f64, impulse: f64) -> Impact {
    let row = ImpactRow {
        primary: BodyId(1),
        normal_body: BodyId(0),
        connector: None,
        point: Some(glam::DVec2::X),
        normal: glam::DVec2::NEG_X,
        gap: 0.01,
        velocity_before: -1.0,
        velocity_after: 1.0,
        impulse,
    };
    Impact { time, rows: vec![row], energy_change: 0.0, states: Vec::new() }
}

/// Pictures must hold no number that a viewer cannot read.
fn assert_drawable(picture: &str) {
    assert!(picture.starts_with("<svg ") && picture.ends_with("</svg>\n"), "{picture}");
    for word in ["NaN", "inf", "e+", "e30"] {
        assert!(!picture.contains(word), "{word} in {picture}");
    }
    assert!(picture.len() < 2_000_000, "{} bytes", picture.len());
}

#[test]
fn pictures_survive_recordings_with_nothing_to_show() {
    let world = world(&scene(1.0, "", "[0, 0]"));
    for (x, y) in [(0.0, 0.0), (1e30, -1e30), (1e-300, 0.0), (1.7e308, -1.7e308)] {
        let mut recording = Recording::new("", &world);
        assert_drawable(&energy_picture(&recording));
        assert_drawable(&events_picture(&recording));
        let mut frame = recording.frame_of(&world);
        frame.states[0].position = glam::DVec2::new(x, y);
        recording.frames.push(frame);
        for impulse in [0.0, 1.0, f64::NAN, f64::INFINITY] {
            recording.impacts.push(impact(0.0, impulse));
        }
        assert_drawable(&scene_picture(&world, &recording, &recording.frames[0]));
        assert_drawable(&energy_picture(&recording));
        assert_drawable(&events_picture(&recording));
    }
}

#[test]
fn pictures_survive_a_million_impacts_and_broken_numbers() {
    let scene = scene(1.0, "", "[0, 0]");
    let world = world(&scene);
    let mut recording = Recording::new("", &world);
    recording.frames.push(recording.frame_of(&world));
    for index in 0..20_000 {
        let bad = if index % 1000 == 7 { f64::NAN } else { 0.0 };
        let state = BodyState { position: glam::DVec2::new(bad, 1.0), ..world.state(BodyId(1)) };
        let energy = Energy { kinetic: f64::from(index), potential: bad };
        recording.frames.push(Frame {
            time: f64::from(index),
            states: vec![state],
            energy,
            forces: Vec::new(),
        });
    }
    recording.impacts = (0..1_000_000).map(|index| impact(f64::from(index) * 0.02, 1.0)).collect();
    assert_drawable(&scene_picture(&world, &recording, &recording.frames[0]));
    assert_drawable(&energy_picture(&recording));
    assert_drawable(&events_picture(&recording));
}

fn contact(connector: Option<u32>, normal: glam::DVec2, force: f64) -> ContactForce {
    let normal_body = if connector.is_some() { BodyId::WORLD } else { BodyId(0) };
    let connector = connector.map(ConnectorId);
    ContactForce {
        bodies: [BodyId(1), normal_body],
        connector,
        point: Some(glam::DVec2::NEG_Y),
        torque: None,
        normal,
        force,
        friction: None,
        rolling_moment: None,
        heat: None,
    }
}

/// A recording of one frame with a contact, and a pin whose two rows are one force.
fn with_forces(world: &World) -> Recording {
    let mut recording = Recording::new("Forces", world);
    recording.frames.push(recording.frame_of(world));
    recording.frames[0].forces = vec![
        contact(None, glam::DVec2::Y, 5.0),
        contact(Some(3), glam::DVec2::X, -6.0),
        contact(Some(3), glam::DVec2::Y, 8.0),
    ];
    let event = ContactEvent {
        time: 0.5,
        contact: contact(None, glam::DVec2::Y, 2.5),
        bouncing: Some(0.25),
        energy_change: None,
    };
    recording.contacts.push(ContactRecord { change: ContactChange::Begins, event });
    recording
        .contacts
        .push(ContactRecord { change: ContactChange::Ends, event: ContactEvent { time: 0.75, ..event } });
    recording
}

#[test]
fn forces_and_contacts_are_written_as_tables() {
    let recording = with_forces(&world(&scene(1.0, "", "[0, 0]")));
    let mut csv = Vec::new();
    recording.write_forces_csv(&mut csv).expect("memory takes everything");
    recording.write_contacts_csv(&mut csv).expect("memory takes everything");
    insta::assert_snapshot!(String::from_utf8(csv).expect("text"), @r#"
    time [s],primary,normal_body,connector,x [m],y [m],normal_x,normal_y,force [N]
    0.0,disc,"rim, ""fixed""",,0.0,-1.0,0.0,1.0,5.0
    0.0,disc,world,3,0.0,-1.0,1.0,0.0,-6.0
    0.0,disc,world,3,0.0,-1.0,0.0,1.0,8.0
    change,time [s],primary,normal_body,connector,x [m],y [m],normal_x,normal_y,force [N]
    begins,0.5,disc,"rim, ""fixed""",,0.0,-1.0,0.0,1.0,2.5
    ends,0.75,disc,"rim, ""fixed""",,0.0,-1.0,0.0,1.0,2.5
    "#);
}

#[test]
fn moments_against_rolling_are_written_where_any_contact_has_one() {
    let mut recording = with_forces(&world(&scene(1.0, "", "[0, 0]")));
    recording.frames[0].forces.truncate(2);
    recording.frames[0].forces[0].rolling_moment = Some(-0.5);
    let (mut csv, mut text) = (Vec::new(), Vec::new());
    recording.write_forces_csv(&mut csv).expect("memory takes everything");
    insta::assert_snapshot!(String::from_utf8(csv).expect("text"), @r#"
    time [s],primary,normal_body,connector,x [m],y [m],normal_x,normal_y,force [N],rolling_moment [N m]
    0.0,disc,"rim, ""fixed""",,0.0,-1.0,0.0,1.0,5.0,-0.5
    0.0,disc,world,3,0.0,-1.0,1.0,0.0,-6.0,
    "#);
    recording.write_json(&mut text).expect("memory takes everything");
    let json: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    assert_eq!(json["frames"][0]["forces"][0]["rolling_moment"], -0.5);
    assert!(json["frames"][0]["forces"][1].get("rolling_moment").is_none());
}

#[test]
fn the_heat_of_contacts_is_written_where_any_makes_some() {
    let mut recording = with_forces(&world(&scene(1.0, "", "[0, 0]")));
    recording.contacts[1].event.contact.heat = Some(0.125);
    let (mut csv, mut text) = (Vec::new(), Vec::new());
    recording.write_contacts_csv(&mut csv).expect("memory takes everything");
    insta::assert_snapshot!(String::from_utf8(csv).expect("text"), @r#"
    change,time [s],primary,normal_body,connector,x [m],y [m],normal_x,normal_y,force [N],heat [J]
    begins,0.5,disc,"rim, ""fixed""",,0.0,-1.0,0.0,1.0,2.5,
    ends,0.75,disc,"rim, ""fixed""",,0.0,-1.0,0.0,1.0,2.5,0.125
    "#);
    recording.write_json(&mut text).expect("memory takes everything");
    let json: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    assert_eq!(json["contacts"][1]["heat"], 0.125);
    assert!(json["contacts"][0].get("heat").is_none());
}

#[test]
fn the_energy_of_jams_is_written_where_there_are_any() {
    let mut recording = with_forces(&world(&scene(1.0, "", "[0, 0]")));
    recording.contacts[1].change = ContactChange::Jams;
    recording.contacts[1].event.energy_change = Some(-0.5);
    let (mut csv, mut text) = (Vec::new(), Vec::new());
    recording.write_contacts_csv(&mut csv).expect("memory takes everything");
    insta::assert_snapshot!(String::from_utf8(csv).expect("text"), @r#"
    change,time [s],primary,normal_body,connector,x [m],y [m],normal_x,normal_y,force [N],energy_change [J]
    begins,0.5,disc,"rim, ""fixed""",,0.0,-1.0,0.0,1.0,2.5,
    jams,0.75,disc,"rim, ""fixed""",,0.0,-1.0,0.0,1.0,2.5,-0.5
    "#);
    recording.write_json(&mut text).expect("memory takes everything");
    let json: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    assert_eq!(json["contacts"][1]["energy_change"], -0.5);
    assert!(json["contacts"][0].get("energy_change").is_none());
}

#[test]
fn forces_contacts_and_the_ledger_are_written_as_json() {
    let recording = with_forces(&world(&scene(1.0, "", "[0, 0]")));
    let mut text = Vec::new();
    recording.write_json(&mut text).expect("memory takes everything");
    let json: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    assert_eq!(json["frames"][0]["forces"][1]["force"], -6.0);
    assert_eq!(json["frames"][0]["forces"][1]["connector"], 3);
    assert_eq!(json["frames"][0]["forces"][0]["connector"], serde_json::Value::Null);
    assert_eq!(json["contacts"][1]["change"], "ends");
    assert_eq!(json["contacts"][1]["primary"], "disc");
    assert_eq!(json["ledger"]["kinetic"], 0.0625);
    assert_eq!(json["ledger"]["integration_error"], 0.0);
}

#[test]
fn forces_are_drawn_as_arrows_and_the_rows_of_a_pin_as_one() {
    let world = world(&scene(1.0, "", "[0, 0]"));
    let recording = with_forces(&world);
    let picture = scene_picture(&world, &recording, &recording.frames[0]);
    assert_drawable(&picture);
    // Two forces on the disc and the key; the fixed rim and the background get no arrows.
    assert_eq!(picture.matches("stroke=\"none\"").count(), 3, "{picture}");
    assert!(picture.contains(">5 N</text>"), "{picture}");
    let mut broken = recording.clone();
    broken.frames[0].forces[0].force = f64::NAN;
    broken.frames[0].forces[1].force = f64::INFINITY;
    assert_drawable(&scene_picture(&world, &broken, &broken.frames[0]));
    broken.frames[0].forces.clear();
    let bare = scene_picture(&world, &broken, &broken.frames[0]);
    assert!(!bare.contains(" N</text>"), "no forces, no key");
}

#[test]
fn the_ledger_books_impacts() {
    // Elasticity 1/2 in a ring: each impact leaves a quarter of the energy.
    let mut scene = scene(50.0, "", "[0, 0]");
    scene.bodies[1].elasticity = 0.5;
    let mut world = world(&scene);
    let plan = RunPlan::of_scene(&scene, Record::Everything);
    let report = run(&mut world, &plan, &mut unwatched);
    let ledger = &report.recording.ledger;
    assert_eq!(report.recording.impacts.len(), 2);
    let booked: f64 = report.recording.impacts.iter().map(|impact| impact.energy_change).sum();
    assert!(ledger.impacts < 0.0 && ledger.impacts == booked, "{ledger:?}");
    assert!(ledger.integration_error().abs() < 1e-15, "{ledger:?}");
    assert_eq!(ledger.start, 0.0625);
}

#[test]
fn a_run_without_events_can_be_broken_off_between_its_outputs() {
    // A stiff spring takes thousands of steps to the first of fifty reports.
    let text = "format = \"halfgap-scene-1\"\ntitle = \"stiff\"\nrun = { duration = 1.0 }\n\
        [[body]]\nname = \"bob\"\nmass = 1.0\nposition = [1.5, 0.0]\nshape = { disc = { radius = 0.5 } }\n\
        [[force]]\nspring = { a = { body = \"world\", point = [0, 0] }, b = { body = \"bob\", point = [0, 0] }, \
        rest_length = 1.0, stiffness = 1e10 }\n";
    let scene = Scene::parse(text, SceneFormat::Toml).expect("a good scene");
    let plan = RunPlan::of_scene(&scene, Record::Ends);
    let mut broken = World::from_scene(&scene).expect("a spring");
    let report = run(&mut broken, &plan, &mut |reached| {
        if reached.time > 0.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let Some(RunError::Interrupted { time }) = report.error else { panic!("{:?}", report.error) };
    assert!(time > 0.0 && time < 0.01, "{time}");
    assert_eq!(report.recording.frames.last().map(|frame| frame.time), Some(time));
    // It goes on from there as if it had not stopped.
    let mut whole = World::from_scene(&scene).expect("a spring");
    for world in [&mut broken, &mut whole] {
        world.advance_to(0.02, &mut |_| ()).expect("it swings");
    }
    let state = |world: &World| world.bodies().map(|body| world.state(body)).collect::<Vec<_>>();
    assert_eq!(state(&broken), state(&whole));
}
