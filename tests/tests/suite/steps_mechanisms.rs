//! Mechanisms by steps: all connectors and what acts on their coordinates, against known answers and against events.

use halfgap::scene::{RunData, Scene, StrategyData};
use halfgap::{CheckReport, ConnectorId, World, check};
use halfgap_tests::{data, names_in};

/// Error below which a scene is exact but for rounding and the target gap [m, rad].
const EXACT: f64 = 1e-9;

/// Bounds on the errors of positions [m, rad] and of velocities [m/s, rad/s] at a 960th of a second.
const BOUNDS: [(&str, f64, f64); 44] = [
    ("arm_swung_carries_rod", 7e-4, 2e-3),
    ("atwood", 1e-9, 1e-9),
    ("ball_on_piston", 6e-2, 4e0),
    ("block_on_conveyor", 7e-7, 1e-9),
    ("brake_holds_on_slope", 1.1e-3, 8e-3),
    ("cam_roller_follower", 1e-8, 9e-6),
    ("crank_shaper", 5e-8, 5e-5),
    ("disc_on_sloping_belt", 3e-7, 1e-9),
    ("disc_rides_shaker", 7e-6, 7e-5),
    ("door_between_stops", 1.1e-4, 3e-4),
    ("double_pendulum_motor", 9e-6, 1.1e-5),
    ("four_bar_driven", 2e-8, 2e-5),
    ("gear_pair_torque", 1e-9, 1e-9),
    ("gear_struck", 1e-9, 1e-9),
    ("geneva_engaged", 2e-7, 2e-4),
    ("mass_between_stops", 1e-9, 1e-9),
    ("motor_lifts_arm", 5e-7, 2e-6),
    ("motor_stalls", 3e-6, 4e-5),
    ("motor_up_slope", 4e-8, 1e-9),
    ("paddle_hits_ball", 2.1e-2, 1.3e-2),
    ("pantograph_driven", 1.1e-8, 1.5e-5),
    ("pendulum_dry_friction", 7e-5, 4e-3),
    ("pendulum_hits_stop_dead", 2e-3, 1.2e-2),
    ("pendulum_hits_stop_half", 2.1e-3, 9e-3),
    ("pendulum_on_shaken_pivot", 2e-6, 3e-5),
    ("planetary_gear_torque", 5e-5, 9e-5),
    ("puck_and_wall_by_table", 2e-2, 4e-3),
    ("pulley_goes_slack", 1e-9, 1e-9),
    ("push_at_a_point", 7e-6, 1.2e-5),
    ("push_by_table", 5e-7, 1e-9),
    ("push_sine", 2e-5, 7e-6),
    ("push_window", 2.1e-3, 2e-3),
    ("rack_and_pinion_spring", 1.1e-4, 1e-4),
    ("rod_on_pin_spring", 8e-5, 5e-4),
    ("rod_on_rocking_body", 7e-6, 6e-5),
    ("scotch_yoke_driven", 2.1e-8, 2e-5),
    ("slider_crank_driven", 1.5e-8, 1.4e-5),
    ("slot_dry_friction", 1e-9, 1e-9),
    ("spring_on_slider", 2e-5, 5e-5),
    ("torsion_wheel", 5e-4, 5e-4),
    ("torsion_wheel_dry_friction", 6e-6, 4e-5),
    ("welded_bar_struck", 7e-6, 1.5e-5),
    ("welded_l_thrown", 9e-5, 2e-4),
    ("wheel_by_table_turns_wheel", 1e-9, 3e-5),
];

fn scene(name: &str) -> Scene {
    Scene::read(data(&format!("mechanisms/{name}.json"))).expect("the scene can be read")
}

/// A scene by steps of a length [s], solved to a residual.
fn stepped(name: &str, step: f64, tolerance: f64) -> Scene {
    let scene = scene(name);
    let run = RunData {
        strategy: StrategyData::Steps,
        time_step: Some(step),
        tolerance: Some(tolerance),
        ..scene.run.clone()
    };
    Scene { run, ..scene }
}

fn world(name: &str, scene: &Scene) -> World {
    World::from_scene(scene).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn checked(name: &str, step: f64, tolerance: f64) -> CheckReport {
    let scene = stepped(name, step, tolerance);
    check(&mut world(name, &scene), &scene)
}

/// Largest errors of positions and of velocities.
fn errors(name: &str, step: f64, tolerance: f64) -> [f64; 2] {
    let report = checked(name, step, tolerance);
    [report.position_error, report.velocity_error]
        .map(|error| error.unwrap_or_else(|| panic!("{name}: {:?}", report.why)))
}

#[test]
fn every_mechanism_comes_near_its_answer_by_steps() {
    let names = names_in("mechanisms");
    assert!(names.iter().eq(BOUNDS.iter().map(|(name, ..)| name)), "a bound for each of {names:?}");
    for (name, position, velocity) in BOUNDS {
        let [of_position, of_velocity] = errors(name, 1.0 / 960.0, 1e-10);
        println!("{name}: {of_position:e} of {position:e}, {of_velocity:e} of {velocity:e}");
        assert!(of_position <= position, "{name}: {of_position} beyond {position}");
        assert!(of_velocity <= velocity, "{name}: velocities off by {of_velocity}, beyond {velocity}");
    }
}

#[test]
fn errors_of_mechanisms_fall_with_the_square_of_the_step() {
    for name in [
        "slider_crank_driven",
        "four_bar_driven",
        "motor_stalls",
        "rack_and_pinion_spring",
        "planetary_gear_torque",
        "pendulum_on_shaken_pivot",
        "spring_on_slider",
        "rod_on_rocking_body",
    ] {
        let [coarse, fine] = [240.0, 960.0].map(|steps: f64| errors(name, 1.0 / steps, 1e-10));
        println!("{name}: {coarse:?} {fine:?}");
        for (coarse, fine) in coarse.into_iter().zip(fine) {
            assert!(coarse / fine > 8.0, "{name}: {coarse}, {fine}");
        }
    }
}

#[test]
fn errors_of_mechanisms_fall_where_joints_stick_and_stops_are_met() {
    for name in [
        "motor_lifts_arm",
        "pendulum_dry_friction",
        "torsion_wheel_dry_friction",
        "brake_holds_on_slope",
        "pendulum_hits_stop_dead",
        "pendulum_hits_stop_half",
    ] {
        let [coarse, fine] = [60.0, 960.0].map(|steps: f64| errors(name, 1.0 / steps, 1e-10)[0]);
        println!("{name}: {coarse:e} {fine:e}");
        assert!(coarse / fine > 6.0, "{name}: {coarse}, {fine}");
    }
}

#[test]
fn errors_of_mechanisms_fall_with_the_tolerance_by_which_steps_are_chosen() {
    let error = |name: &str, tolerance: f64| {
        let scene = stepped(name, 1.0, tolerance);
        let run = RunData { time_step: None, ..scene.run.clone() };
        let scene = Scene { run, ..scene };
        check(&mut world(name, &scene), &scene).position_error.expect("positions are compared")
    };
    for (name, bound) in [
        ("slider_crank_driven", 2e-8),
        ("motor_lifts_arm", 2e-7),
        ("pendulum_dry_friction", 9e-5),
        ("rack_and_pinion_spring", 8e-5),
        ("planetary_gear_torque", 7e-5),
        ("pendulum_hits_stop_dead", 3e-6),
        ("wheel_by_table_turns_wheel", 7e-8),
    ] {
        let [coarse, fine] = [1e-4, 1e-6].map(|tolerance| error(name, tolerance));
        assert!(fine < bound && fine < 0.1 * coarse, "{name}: {coarse}, {fine} of {bound}");
    }
}

#[test]
fn ropes_over_wheels_are_exact_by_steps() {
    for name in ["atwood", "pulley_goes_slack", "gear_pair_torque", "slot_dry_friction"] {
        let [position, velocity] = errors(name, 1.0 / 60.0, 1e-10);
        assert!(position < EXACT && velocity < EXACT, "{name}: {position}, {velocity}");
    }
}

#[test]
fn mechanisms_are_solved_by_sweeps_as_well() {
    // With a residual of a hundredth nothing is solved exactly.
    for (name, bound) in [
        ("slider_crank_driven", 1e-4),
        ("motor_lifts_arm", 1e-4),
        ("motor_stalls", 1e-4),
        ("double_pendulum_motor", 1e-4),
        ("rack_and_pinion_spring", 1e-3),
        ("planetary_gear_torque", 1e-4),
        ("pendulum_dry_friction", 1e-3),
        ("atwood", EXACT),
        ("slot_dry_friction", EXACT),
    ] {
        let [position, _] = errors(name, 1.0 / 960.0, 1e-2);
        assert!(position < bound, "{name}: {position}");
    }
}

/// A mechanism by steps at a time, and by events.
fn both(name: &str, step: f64, time: f64) -> [World; 2] {
    [stepped(name, step, 1e-10), scene(name)].map(|scene| {
        let mut world = world(name, &scene);
        world.advance_to(time, &mut |_| ()).unwrap_or_else(|error| panic!("{name}: {error}"));
        world
    })
}

#[test]
fn the_books_of_mechanisms_close_and_tell_what_drives_and_what_rubs() {
    for name in [
        "slider_crank_driven",
        "four_bar_driven",
        "motor_lifts_arm",
        "motor_stalls",
        "double_pendulum_motor",
        "pendulum_dry_friction",
        "torsion_wheel_dry_friction",
        "pendulum_on_shaken_pivot",
        "rod_on_rocking_body",
    ] {
        let [steps, events] = both(name, 1.0 / 960.0, 1.5).map(|world| world.ledger());
        println!("{name}: {} {} of {} {}", steps.drives, steps.friction, events.drives, events.friction);
        let size = events.drives.abs() + events.friction.abs() + events.now.kinetic.abs();
        let open = steps.integration_error().abs();
        assert!(open < 1e-4 * size, "{name}: {open} J of {size} J, {steps:?}");
        for (own, other) in [(steps.drives, events.drives), (steps.friction, events.friction)] {
            assert!((own - other).abs() < 1e-3 * size, "{name}: {own} for {other}");
        }
        assert!((events.drives == 0.0) == (steps.drives == 0.0), "{name}: {steps:?}");
        assert!((events.friction == 0.0) == (steps.friction == 0.0), "{name}: {steps:?}");
        // What is left to the steps is their error.
        let left = steps.steps + steps.projections + steps.impacts;
        assert!(left.abs() < 1e-3 * size, "{name}: {left} J of {size} J");
    }
}

/// Sum of the forces [N] on the first body of a connector, and of the torques [N m].
fn pull(world: &World, connector: ConnectorId) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for contact in world.contact_forces().iter().filter(|contact| contact.connector == Some(connector)) {
        let force = contact.force * contact.normal;
        let parts = [force.x, force.y, contact.torque.unwrap_or(0.0)];
        sum.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
    }
    sum
}

#[test]
fn forces_of_drives_motors_racks_and_pulleys_are_told_as_by_events() {
    for (name, time) in [
        ("slider_crank_driven", 1.5),
        ("motor_lifts_arm", 1.5),
        ("motor_stalls", 1.5),
        ("pendulum_dry_friction", 1.5),
        ("rack_and_pinion_spring", 1.5),
        ("atwood", 0.75),
        ("planetary_gear_torque", 1.5),
        ("slot_dry_friction", 0.5),
    ] {
        let [steps, events] = both(name, 1.0 / 960.0, time);
        for index in 0..events.connectors().len() {
            let id = ConnectorId(index as u32);
            let [own, other] = [&steps, &events].map(|world| pull(world, id));
            for (own, other) in own.into_iter().zip(other) {
                let size = other.abs().max(1.0);
                assert!((own - other).abs() < 1e-2 * size, "{name}, connector {index}: {own} for {other}");
            }
        }
    }
}

#[test]
fn a_driven_mechanism_that_was_saved_goes_on_with_the_same_bits() {
    for name in ["slider_crank_driven", "double_pendulum_motor", "rack_and_pinion_spring", "atwood"] {
        let end = |is_saved: bool| {
            let mut world = world(name, &stepped(name, 1.0 / 240.0, 1e-6));
            world.advance_to(0.51, &mut |_| ()).expect("it runs");
            if is_saved {
                let bytes = world.save().expect("all laws of scenes are the crate's");
                world = World::load(&bytes).expect("they are sound");
            }
            world.advance_to(0.9, &mut |_| ()).expect("it runs");
            world.bodies().map(|body| world.state(body)).collect::<Vec<_>>()
        };
        assert_eq!(end(true), end(false), "{name}");
    }
}
