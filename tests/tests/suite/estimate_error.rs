//! The error estimate against errors that are known: at most ten times too large, at least a third of the truth.

use halfgap::scene::Scene;
use halfgap::{ErrorEstimate, Record, RunPlan, TimedDifference, World, estimate_error, run, unwatched};
use halfgap_tests::{check_at, reference_scene};

/// Errors below this fraction of the scene's size are rounding.
const ROUNDING: f64 = 1e-12;
/// Bounds on the estimate, as multiples of the true error.
const LEAST: f64 = 1.0 / 3.0;
const MOST: f64 = 10.0;

fn estimate_of(scene: &Scene) -> ErrorEstimate {
    let mut world = World::from_scene(scene).expect("a world that can be built");
    let plan = RunPlan::of_scene(scene, Record::Everything);
    let report = run(&mut world, &plan, &mut unwatched);
    assert_eq!(report.error, None);
    estimate_error(scene, &plan, &world, &report, &mut unwatched).expect("the tighter world can be built")
}

/// The largest differences that the estimate gives at the times of the scene's expected states: of positions
/// and angles, and of velocities and spins.
fn at_expected(scene: &Scene, estimate: &ErrorEstimate) -> [f64; 2] {
    let nearest = |time: f64| {
        let far = |timed: &&TimedDifference| (timed.time - time).abs();
        estimate.curve.iter().min_by(|a, b| far(a).total_cmp(&far(b))).expect("there are outputs").difference
    };
    let differences = scene.expected.iter().map(|expected| nearest(expected.time));
    differences.fold([0.0, 0.0], |[near, slow], one| {
        [near.max(one.position).max(one.angle), slow.max(one.velocity).max(one.angular_velocity)]
    })
}

/// Compares estimate and truth at tolerances from 1e-3 to 1e-13; `size` [m] and `speed` [m/s] are the scene's.
fn compare(name: &str, size: f64, speed: f64) {
    let mut compared = 0;
    for power in 3..=13 {
        let mut scene = reference_scene(name);
        let tolerance = 10f64.powi(-power);
        scene.set_tolerance(tolerance, "tolerance").expect("a fine tolerance");
        let estimate = estimate_of(&scene);
        let report = check_at(&scene, None);
        let truth =
            [report.position_error, report.velocity_error].map(|error| error.expect("it is compared"));
        let estimated = at_expected(&scene, &estimate);
        println!("{name} at {tolerance:e}: truth {truth:?}, estimate {estimated:?}");
        for (truth, (estimated, scale)) in truth.into_iter().zip(estimated.into_iter().zip([size, speed])) {
            if truth > ROUNDING * scale {
                let ratio = estimated / truth;
                assert!((LEAST..=MOST).contains(&ratio), "at {tolerance:e}: {estimated:e} for {truth:e}");
                compared += 1;
            }
        }
        assert!(!estimate.chaotic, "at {tolerance:e}: {:?}", estimate.largest);
    }
    assert!(compared >= 7, "{compared} errors were compared");
}

#[test]
fn of_a_pendulum() {
    compare("exact__pendulum", 1.0, 6.0);
}

#[test]
fn of_a_double_pendulum() {
    compare("exact__double_pendulum", 1.0, 10.0);
}

#[test]
fn of_a_disc_in_a_bowl() {
    compare("exact__disc_in_bowl", 1.0, 5.0);
}

#[test]
fn of_newtons_cradle() {
    compare("exact__newtons_cradle", 1.0, 5.0);
}

#[test]
fn of_a_ball_that_bounces() {
    compare("exact__ball_bounce", 1.0, 6.0);
}

#[test]
fn of_two_discs() {
    compare("exact__two_discs_e1", 1.0, 2.0);
}

/// Ten discs in a box without loss: neighbouring runs part exponentially, as in any gas of hard discs.
#[test]
fn chaos_is_named_with_the_time_until_which_the_answer_is_worth_something() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/discs_in_a_box.toml");
    let mut scene = Scene::read(path).expect("a scene to look at");
    scene.set_duration(10.0, "duration").expect("a fine duration");
    let mut trusted = Vec::new();
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        scene.set_tolerance(tolerance, "tolerance").expect("a fine tolerance");
        let estimate = estimate_of(&scene);
        println!("{tolerance:e}: until {:?}, {:?}", estimate.trusted_until, estimate.event_time);
        trusted.push(estimate.trusted_until.expect("it does not hold to the end"));
        assert!(estimate.chaotic, "at {tolerance:e}: {:?}", estimate.largest);
        assert!(estimate.event_time.is_some_and(|time| time < 1e-2), "{:?}", estimate.event_time);
    }
    assert!(
        trusted.is_sorted() && trusted[3] > 1.5 * trusted[0],
        "each tolerance buys some time: {trusted:?}"
    );
}

/// At the moment of an impact a body has two velocities, which the ends of the two runs may take one each.
#[test]
fn an_impact_at_an_output_time_is_not_an_error_of_velocity() {
    let text = "format = \"halfgap-scene-1\"\ntitle = \"wall\"\nrun = { duration = 2.0, output_step = 0.5 }\n\
        [[body]]\nname = \"wall\"\nfixed = true\nshape = { block = { width = 1.0, height = 4.0 } }\n\
        position = [2.5, 0.0]\n\
        [[body]]\nname = \"disc\"\nmass = 1.0\nshape = { disc = { radius = 1.0 } }\nvelocity = [1.0, 0.0]\n";
    let scene = Scene::parse(text, halfgap::scene::SceneFormat::Toml).expect("a fine scene");
    let estimate = estimate_of(&scene);
    // The disc arrives at 1 s, a target gap before the wall: a hundredth of the tolerance, times its radius.
    assert!((estimate.event_time.expect("one impact") - 0.99e-10).abs() < 1e-14, "{estimate:?}");
    assert!(estimate.largest.velocity < 1e-12, "{estimate:?}");
    assert!((estimate.end.position - 2.0 * 0.99e-10).abs() < 1e-14, "{estimate:?}");
}
