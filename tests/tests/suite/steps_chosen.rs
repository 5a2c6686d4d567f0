//! Steps whose length a tolerance chooses.

use halfgap::scene::{RunData, Scene, StrategyData};
use halfgap::{BodyState, World, check};
use halfgap_tests::data;

fn scene(name: &str, tolerance: f64) -> Scene {
    let scene = Scene::read(data(&format!("friction/{name}.json"))).expect("the scene can be read");
    let run = RunData {
        strategy: StrategyData::Steps,
        time_step: None,
        tolerance: Some(tolerance),
        ..scene.run.clone()
    };
    Scene { run, ..scene }
}

/// Largest error of a position [m] or an angle, and the number of steps.
fn outcome(name: &str, tolerance: f64) -> (f64, u64) {
    let scene = scene(name, tolerance);
    let mut world = World::from_scene(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    let report = check(&mut world, &scene);
    let error = report.position_error.unwrap_or_else(|| panic!("{name}: {:?}", report.why));
    (error, world.statistics().steps)
}

#[test]
fn errors_fall_with_the_tolerance_where_bodies_hit_each_other_or_roll() {
    for name in [
        "block_rocks",
        "disc_between_plates",
        "disc_bounces_sliding",
        "disc_rolls_down_track",
        "disc_rolls_in_bowl",
        "painleve_rod",
        "ring_topspin",
        "x_double_pendulum_strikes",
        "x_rod_thrown",
        "x_superball_to_and_fro",
    ] {
        let [coarse, fine] = [1e-3, 1e-6].map(|tolerance| outcome(name, tolerance));
        println!("{name}: {coarse:?} {fine:?}");
        assert!(fine.0 < 1e-4 && fine.0 < 0.05 * coarse.0, "{name}: {coarse:?} {fine:?}");
    }
}

#[test]
fn errors_fall_with_the_tolerance_where_hinged_bodies_hit_each_other() {
    // Errors of second order in the length of steps, of which each may be off by the tolerance.
    let mut last = f64::INFINITY;
    for (tolerance, most_error, most_steps) in [(1e-3, 5e-5, 50), (1e-6, 2e-6, 150), (1e-9, 2e-8, 1_000)] {
        let (error, steps) = outcome("hinged_dominoes", tolerance);
        println!("{tolerance:e}: {error:e}, {steps} steps");
        assert!(
            error < most_error && error < 0.1 * last && steps <= most_steps,
            "{tolerance:e}: {error}, {steps} steps"
        );
        last = error;
    }
}

#[test]
fn an_impact_costs_some_steps_and_not_all_of_the_run() {
    // At 1/960 s, with ten times the steps, the error is 1.6e-2.
    let (error, steps) = outcome("x_superball_to_and_fro", 1e-6);
    assert!(error < 1e-5 && steps < 500, "{error}, {steps} steps");
}

fn states(world: &World) -> Vec<BodyState> {
    world.bodies().map(|body| world.state(body)).collect()
}

#[test]
fn stops_and_saving_change_nothing() {
    let scene = scene("disc_bounces_sliding", 1e-5);
    let [mut one, mut other] = [0, 1].map(|_| World::from_scene(&scene).expect("a fine world"));
    one.advance_to(2.0, &mut |_| ()).expect("it bounces");
    for stop in 1..=31 {
        other.advance_to(2.0 * f64::from(stop) / 31.0, &mut |_| ()).expect("it bounces");
        other = World::load(&other.save().expect("it can be saved")).expect("it can be loaded");
    }
    assert_eq!(states(&one), states(&other));
    assert_eq!(one.statistics(), other.statistics());
}
