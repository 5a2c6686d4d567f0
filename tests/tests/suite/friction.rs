//! Friction in events: scenes with known answers, rest, rolling, books, and what callers are told.

use halfgap::scene::{RunData, Scene};
use halfgap::{BodyId, CheckReport, Event, World, check};
use halfgap_tests::{data, names_in};

/// The world of a scene that lacks but its format and its title.
fn world_of(text: &str) -> World {
    halfgap_tests::world_of(&format!("format = \"halfgap-scene-1\"\ntitle = \"friction\"\n{text}"))
}

/// A scene with known answers, run at a tolerance.
fn checked(name: &str, tolerance: f64) -> CheckReport {
    let scene = Scene::read(data(&format!("friction/{name}.json"))).expect("the scene can be read");
    let scene = Scene { run: RunData { tolerance: Some(tolerance), ..scene.run.clone() }, ..scene };
    let mut world = World::from_scene(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    check(&mut world, &scene)
}

#[test]
fn every_scene_with_friction_is_reached_within_its_own_tolerances() {
    let names = names_in("friction");
    assert!(names.len() >= 35, "{} scenes", names.len());
    for name in &names {
        let report = checked(name, 1e-10);
        assert!(report.ok, "{name}: {:?}", report.why);
    }
}

#[test]
fn errors_fall_with_the_tolerance() {
    // At coarse tolerances the correction of the start lets the undecided rod close a little, and it jams.
    for name in names_in("friction").iter().filter(|name| *name != "painleve_rod_undecided") {
        let errors = [1e-4, 1e-5, 1e-6, 1e-7].map(|tolerance| {
            checked(name, tolerance).position_error.unwrap_or_else(|| panic!("{name} at {tolerance}"))
        });
        assert!(errors[0] < 1e-4, "{name}: {errors:?}");
        for pair in errors.windows(2) {
            assert!(pair[0] > 5.0 * pair[1] && pair[1] > 0.0, "{name}: {errors:?}");
        }
    }
}

#[test]
fn a_pile_that_is_struck_again_and_again_goes_by_steps() {
    // 200 discs are dropped: event by event this takes minutes.
    let scene = Scene::read(data("scenes/exact__pile_200.json")).expect("the scene can be read");
    let run = RunData { tolerance: Some(1e-4), duration: 0.5, ..scene.run.clone() };
    let scene = Scene { run, expected: Vec::new(), ..scene };
    let mut world = World::from_scene(&scene).expect("it can be built");
    world.advance_to(0.5, &mut |_| ()).expect("it goes on");
    let (statistics, ledger) = (world.statistics(), world.ledger());
    assert!(statistics.region_steps > 10, "{} steps", statistics.region_steps);
    assert!(ledger.steps < 0.0 && ledger.friction < 0.0 && ledger.impact_friction < 0.0, "{ledger:?}");
    assert!(ledger.integration_error().abs() < 1e-6 * world.energy().total().abs(), "{ledger:?}");
}

/// A disc on a floor, with friction.
fn disc(speed: f64, spin: f64, more: &str) -> World {
    world_of(&format!(
        r#"
        run = {{ duration = 10.0, tolerance = 1e-10 }}
        [[body]]
        name = "floor"
        fixed = true
        friction = 0.5
        {more}
        shape = {{ block = {{ width = 2e4, height = 1.0 }} }}
        position = [0.0, -0.5]
        [[body]]
        name = "disc"
        friction = 0.5
        elasticity = 0.0
        mass = 1.0
        shape = {{ disc = {{ radius = 0.5 }} }}
        position = [0.0, 0.5]
        velocity = [{speed:?}, 0.0]
        angular_velocity = {spin:?}
        [[force]]
        gravity = {{ acceleration = [0.0, -10.0] }}
        "#
    ))
}

#[test]
fn a_disc_rolls_without_drift_and_without_loss() {
    let mut world = disc(3.0, -6.0, "");
    let disc = BodyId(1);
    world.advance_to(3000.0, &mut |_| ()).expect("it rolls");
    let state = world.state(disc);
    assert!((state.position.x - 9000.0).abs() < 1e-9 * 9000.0, "{state:?}");
    assert!((state.angle + 18_000.0).abs() < 1e-9 * 18_000.0, "{state:?}");
    let ledger = world.ledger();
    let change = ledger.now.total() - ledger.start;
    assert!(change.abs() < 1e-9 && ledger.friction == 0.0, "{ledger:?}");
}

#[test]
fn what_slips_heats_and_callers_are_told_when_it_sticks() {
    let mut world = disc(3.0, 0.0, "");
    let mut told = Vec::new();
    let mut tell = |event: &Event| match event {
        Event::Sticks(contact) => told.push(("sticks", contact.time)),
        Event::Slips(contact) => told.push(("slips", contact.time)),
        _ => (),
    };
    world.advance_to(1.0, &mut tell).expect("it slides, then rolls");
    // With mu g = 5 m/s^2 the speed falls to two thirds after 0.2 s.
    assert!(matches!(told[..], [("sticks", time)] if (time - 0.2).abs() < 1e-9), "{told:?}");
    let ledger = world.ledger();
    let heat = 0.5 * 9.0 - 0.5 * 4.0 - 0.5 * 0.125 * 16.0;
    assert!((ledger.friction + heat).abs() < 1e-9 && ledger.integration_error().abs() < 1e-10, "{ledger:?}");
    let [force] = world.contact_forces()[..] else { panic!("one contact") };
    let friction = force.friction.expect("its surfaces have some");
    assert!(friction.sticks && friction.mode() == "stick" && friction.cone_use() < 1e-9, "{friction:?}");
}

#[test]
fn a_belt_carries_a_disc_and_its_work_is_booked() {
    // The top of the floor runs to the right: counter-clockwise would be to the left.
    let mut world = disc(0.0, 0.0, "surface_velocity = -1.5");
    let disc = BodyId(1);
    world.advance_to(2.0, &mut |_| ()).expect("it is carried");
    let state = world.state(disc);
    // It rolls on the belt: v + w r = 1.5 with m v = I w/r.
    assert!((state.velocity.x - 0.5).abs() < 1e-9, "{state:?}");
    let ledger = world.ledger();
    assert!(
        ledger.surfaces > 0.0 && ledger.friction < 0.0 && ledger.integration_error().abs() < 1e-10,
        "{ledger:?}"
    );
}

/// A wall of blocks, each on the joint of two below it, for as many rows as blocks in the lowest.
fn pyramid(rows: u32) -> World {
    let mut bodies = String::new();
    for row in 0..rows {
        for place in 0..rows - row {
            let x = 1.05 * (f64::from(place) - 0.5 * f64::from(rows - row - 1));
            let y = f64::from(row) + 0.5;
            bodies += &format!(
                "[[body]]\nname = \"{row}.{place}\"\nfriction = 0.5\nelasticity = 0.0\nmass = 1.0\n\
                 shape = {{ block = {{ width = 1.0, height = 1.0 }} }}\nposition = [{x:?}, {y:?}]\n"
            );
        }
    }
    world_of(&format!(
        "run = {{ duration = 1.0 }}\n[[force]]\ngravity = {{ acceleration = [0.0, -9.81] }}\n[[body]]\nname = \"floor\"\nfixed = true\n\
         friction = 0.5\nshape = {{ block = {{ width = 100.0, height = 1.0 }} }}\nposition = [0.0, -0.5]\n{bodies}"
    ))
}

#[test]
fn a_pyramid_rests_without_events_and_its_forces_lie_in_their_cones() {
    let mut world = pyramid(8);
    let before: Vec<_> = world.bodies().map(|body| world.state(body)).collect();
    let mut events = 0;
    world.advance_to(1000.0, &mut |_| events += 1).expect("it rests");
    assert_eq!(events, 0);
    for (body, before) in world.bodies().zip(before) {
        assert!((world.state(body).position - before.position).length() < 1e-9);
    }
    let forces = world.contact_forces();
    assert_eq!(forces.len(), 2 * 8 + 4 * 28, "two contacts of each block with each below it");
    let weight: f64 = forces
        .iter()
        .filter(|force| force.bodies.iter().any(|&body| world.is_fixed(body)))
        .map(|force| force.force)
        .sum();
    assert!((weight - 36.0 * 9.81).abs() < 1e-6, "{weight}");
    for force in forces {
        let friction = force.friction.expect("all are rough");
        assert!(force.force > 0.0 && friction.sticks && friction.cone_use() <= 1.0, "{force:?}");
    }
}

#[test]
fn contacts_that_slip_against_each_other_without_forces_jam_and_go_on() {
    let mut world = Scene::read(data("friction/painleve_rod.json"))
        .and_then(|scene| World::from_scene(&scene))
        .expect("the rod jams at the start");
    world.advance_to(0.1, &mut |_| ()).expect("it tips");
    let ledger = world.ledger();
    assert!((ledger.jams + 0.2).abs() < 1e-9 && ledger.integration_error().abs() < 1e-10, "{ledger:?}");
}
