//! Rails through points: the error follows the tolerance over all the points that a run passes.

use halfgap_tests::world_of;
use std::fmt::Write as _;

const GRAVITY: f64 = 9.81;
/// Radius [m] of the rolling wheel that draws the cycloid.
const WHEEL: f64 = 0.5;
/// The rail spans wheel angles up to this on both sides [rad]; the bead stays far enough from the ends not to feel
/// them.
const SPAN: f64 = 2.5;
/// Wheel angle [rad] at which the bead starts.
const START: f64 = 1.8;
const DURATION: f64 = 5.0;

fn point(angle: f64) -> [f64; 2] {
    [WHEEL * (angle + angle.sin()), -WHEEL * angle.cos()]
}

/// Place of a bead on the cycloid: its arc length from the lowest point swings like a spring.
fn expected(time: f64) -> [f64; 2] {
    let frequency = (GRAVITY / (4.0 * WHEEL)).sqrt();
    point(2.0 * ((0.5 * START).sin() * (frequency * time).cos()).asin())
}

/// A bead on the spline through points of a cycloid, every second of which is shifted on by the fraction `shift` of a
/// space.
fn scene(points: u32, shift: f64, tolerance: f64) -> String {
    let place = |index: u32| {
        let is_inner = index % 2 == 1 && index + 1 < points;
        let index = f64::from(index) + if is_inner { shift } else { 0.0 };
        point(SPAN * (2.0 * index / f64::from(points - 1) - 1.0))
    };
    let mut list = String::new();
    for [x, y] in (0..points).map(place) {
        write!(list, "[{x:?}, {y:?}], ").expect("a string takes everything");
    }
    let [x, y] = point(START);
    format!(
        "format = \"halfgap-scene-1\"\ntitle = \"cycloid\"\n\
         run = {{ duration = {DURATION}, tolerance = {tolerance:e}, collisions = false }}\n\
         force = [{{ gravity = {{ acceleration = [0.0, -{GRAVITY}] }} }}]\n\n\
         [[body]]\nname = \"bead\"\nshape = {{ disc = {{ radius = 0.05 }} }}\nmass = 1.0\nposition = [{x:?}, {y:?}]\n\n\
         [[connector]]\nrail = {{ a = {{ body = \"bead\", point = [0.0, 0.0] }}, path = {{ points = [{list}] }} }}\n"
    )
}

/// Position at the end [m], and number of steps.
fn run(points: u32, shift: f64, tolerance: f64) -> ([f64; 2], u64) {
    let mut world = world_of(&scene(points, shift, tolerance));
    let bead = world.find("bead").expect("the bead");
    world.advance_to(DURATION, &mut |_| {}).expect("it goes on");
    (world.state(bead).position.to_array(), world.statistics().steps)
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[test]
fn the_error_on_a_rail_through_points_falls_with_the_tolerance() {
    for (points, shift) in [(101, 0.0), (301, 0.0), (301, 0.3)] {
        let (exact, _) = run(points, shift, 1e-14);
        for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
            let (end, steps) = run(points, shift, tolerance);
            let error = distance(end, exact);
            println!("{points} points at {tolerance:e}: {error:e} m in {steps} steps");
            assert!(error < 5.0 * tolerance, "{points} points, shift {shift}: {error} m at {tolerance}");
        }
    }
}

#[test]
fn the_spline_nears_the_curve_of_its_points() {
    let errors = [101, 301].map(|points| distance(run(points, 0.0, 1e-11).0, expected(DURATION)));
    let order = (errors[0] / errors[1]).ln() / 3f64.ln();
    assert!(order > 3.0, "order {order} of {errors:?}");
    assert!(errors[1] < 1e-8, "{errors:?}");
}
