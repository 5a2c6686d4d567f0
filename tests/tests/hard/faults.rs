//! Inputs that once went wrong where bodies rest, fit tightly, or collide again and again.

use halfgap::World;
use halfgap::scene::{Scene, SceneFormat};
use halfgap_tests::blows::check_tight;
use halfgap_tests::generate::{all_laws, mixed_stack_of_seed};
use halfgap_tests::{check_at, data};

/// Way [target gaps] that a block of a stack may creep in 20 s.
const CREEP: f64 = 10.0;
/// Tolerances of the command, and of those who want more or less.
const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];

fn fault(name: &str) -> Scene {
    Scene::read(data(&format!("faults/{name}.json"))).expect("a fine scene")
}

/// The world of a scene at a tolerance, advanced to its end.
fn world_at(scene: &Scene, tolerance: f64) -> World {
    let mut scene = scene.clone();
    scene.run.tolerance = Some(tolerance);
    let mut world = World::from_scene(&scene).expect("a fine scene");
    world
        .advance_to(scene.run.end_time(), &mut |_| ())
        .unwrap_or_else(|error| panic!("{tolerance:e}: {error}"));
    world
}

/// Longest way [target gaps] that a body of a scene goes from a time [s] to its end.
fn creep(scene: &Scene, since: f64) -> f64 {
    let mut world = World::from_scene(scene).expect("a fine scene");
    let mut places = |time: f64| -> Vec<_> {
        world.advance_to(time, &mut |_| ()).expect("it can go on");
        world.bodies().map(|body| world.state(body).position).collect()
    };
    let (before, after) = (places(since), places(scene.run.end_time()));
    let ways = before.iter().zip(&after).map(|(a, b)| a.distance(*b));
    ways.fold(0.0, f64::max) / world.tolerances().target_gap
}

#[test]
fn a_box_slides_over_tiles_whose_heights_differ_by_less_than_its_gap() {
    for tolerance in [1e-6, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12] {
        let world = world_at(&fault("F2-stuck-4-tiles"), tolerance);
        let speed = world.state(world.find("box").expect("it is there")).velocity.x;
        assert!((speed - 1.706_435_310_889_814_7).abs() < 1e-12, "{speed} m/s at {tolerance:e}");
    }
}

#[test]
fn stacks_of_light_and_heavy_blocks_stay() {
    let way = creep(&fault("F4-stack-creeps"), 0.0);
    assert!(way < CREEP, "{way} gaps");
    for seed in 0..100 {
        let scene = mixed_stack_of_seed(seed).to_string();
        let scene = Scene::parse(&scene, SceneFormat::Json).expect("scenes of seeds are scenes");
        let way = creep(&scene, 2.0);
        assert!(way < CREEP, "seed {seed}: {way} gaps");
    }
}

#[test]
fn a_ball_at_rest_beside_a_seam_stays() {
    for tolerance in TOLERANCES {
        let report = check_at(&fault("F8-rest-beside-seam"), Some(tolerance));
        assert!(report.ok, "{tolerance:e}: {:?}", report.why);
    }
}

#[test]
fn a_plug_that_rattles_in_a_play_of_a_billionth_comes_to_its_end() {
    for tolerance in TOLERANCES {
        let world = world_at(&fault("F6-little-play-hangs"), tolerance);
        let (statistics, ledger) = (world.statistics(), world.ledger());
        assert!(statistics.impacts < 100_000, "{} impacts at {tolerance:e}", statistics.impacts);
        // What the plug rattles with may be lost in steps, which the ledger tells.
        let left = world.energy().total() - ledger.steps;
        assert!((left - ledger.start).abs() < 1e-9 * ledger.start, "{ledger:?} at {tolerance:e}");
        let ball = world.state(world.find("ball").expect("it is there"));
        assert!(ball.velocity.y > 0.5, "{ball:?} at {tolerance:e}");
    }
}

#[test]
fn no_tolerance_of_a_small_machine_takes_many_times_its_neighbours() {
    let scene = fault("F7-slow-min");
    let steps =
        [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8].map(|tolerance| world_at(&scene, tolerance).statistics().steps);
    for three in steps.windows(3) {
        assert!(three[1] <= 8 * three[0].max(three[2]), "{steps:?}");
    }
}

#[test]
fn bodies_that_fit_with_a_little_play_come_to_their_end_by_every_law() {
    // Seeds 12, 52 and 62: plays of 1e-9 to 1e-7 m, in which bodies once rattled for a million events.
    for seed in (1..=20).chain([52, 62]) {
        for &law in all_laws() {
            for elasticity in [1.0, 0.3] {
                let outcome = check_tight(seed, law, elasticity);
                assert!(outcome.is_ok(), "tight fit {seed} by {law}, elasticity {elasticity}: {outcome:?}");
            }
        }
    }
}
