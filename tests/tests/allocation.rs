//! A steady state allocates nothing: neither a gas of discs over many impacts, nor groups over many steps.
#![allow(unsafe_code, reason = "an allocator that counts is the only way to see allocations")]

use halfgap::geometry::{DVec2, Shape};
use halfgap::scene::{RunData, Scene, StrategyData};
use halfgap::{Anchor, BodyId, ConnectorKind, World};
use halfgap_tests::mechanism::{Workshop, at_rest, block, disc};
use halfgap_tests::{data, world_of};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::fmt::Write;

thread_local! {
    /// Allocations of this thread: other tests run at the same time.
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Sixteen discs in a box, each at a speed of its own.
fn gas() -> String {
    let mut scene = String::from(
        "format = \"halfgap-scene-1\"\ntitle = \"gas\"\nrun = { duration = 100.0 }\n[[body]]\nname = \"box\"\n\
         fixed = true\nshape = { outline = { paths = [\
         { start = [-1, -1], edges = [{ line = [9, -1] }, { line = [9, 9] }, { line = [-1, 9] }, { line = [-1, -1] }] },\
         { start = [0, 0], edges = [{ line = [8, 0] }, { line = [8, 8] }, { line = [0, 8] }, { line = [0, 0] }] }] } }\n\
         center_of_mass = [0, 0]\n",
    );
    for index in 0..16 {
        let (x, y) = (1.0 + 2.0 * f64::from(index % 4), 1.0 + 2.0 * f64::from(index / 4));
        let (vx, vy) = (0.3 + 0.17 * f64::from(index), 1.9 - 0.23 * f64::from(index));
        write!(
            scene,
            "[[body]]\nname = \"disc {index}\"\nmass = 1.0\nshape = {{ disc = {{ radius = 0.6 }} }}\n\
             position = [{x}, {y}]\nvelocity = [{vx}, {vy}]\n"
        )
        .expect("a string takes all");
    }
    scene
}

/// Runs a world from a time [s] at which it is warm to another; returns the number of allocations in between, and of
/// events.
fn allocations(world: &mut World, warm: f64, end: f64) -> (u64, u64) {
    world.advance_to(warm, &mut |_| {}).expect("it goes on");
    let before = ALLOCATIONS.get();
    let mut events = 0u64;
    world.advance_to(end, &mut |_| events += 1).expect("it goes on");
    (ALLOCATIONS.get() - before, events)
}

/// Checks that a world whose bodies share their steps allocates nothing over at least `steps` of them.
#[track_caller]
fn steps_allocate_nothing(mut world: World, steps: u64) {
    let (warm, end) = (20.0, 60.0);
    world.advance_to(warm, &mut |_| {}).expect("it goes on");
    let before = world.statistics().steps;
    let (allocations, events) = allocations(&mut world, warm, end);
    let taken = world.statistics().steps - before;
    println!("{taken} steps, {events} events, {allocations} allocations");
    assert!(taken >= steps, "{taken} steps");
    assert_eq!(allocations, 0, "over {taken} steps and {events} events");
}

fn world_point(x: f64, y: f64) -> Anchor {
    Anchor { body: BodyId::WORLD, point: DVec2::new(x, y) }
}

fn center(body: BodyId) -> Anchor {
    Anchor { body, point: DVec2::ZERO }
}

#[test]
fn impacts_of_a_gas_allocate_nothing() {
    let mut world = world_of(&gas());
    let mut impacts = 0u64;
    world.advance_to(400.0, &mut |_| impacts += 1).expect("it goes on");
    assert!(impacts > 10_000, "{impacts} impacts to warm up");
    let (allocations, seen) = allocations(&mut world, 400.0, 500.0);
    assert!(seen > 2_000, "{seen} impacts");
    assert_eq!(allocations, 0, "over {seen} impacts");
}

#[test]
fn a_pendulum_allocates_nothing() {
    let mut shop = Workshop::new(1e-9);
    let bob = shop.body("bob", disc(0.25), 1.0, at_rest(1.0, 0.0));
    shop.connect(ConnectorKind::Rod { a: world_point(0.0, 0.0), b: center(bob), length: 1.0 }, 0.0);
    steps_allocate_nothing(shop.build(), 500);
}

#[test]
fn a_damped_pendulum_of_two_bars_allocates_nothing() {
    let mut shop = Workshop::new(1e-9);
    let places = [DVec2::ZERO, DVec2::new(1.0, 0.0), DVec2::new(1.0, 1.0)];
    let upper = shop.bar("upper", places[0], places[1]);
    let lower = shop.bar("lower", places[1], places[2]);
    shop.pin(BodyId::WORLD, upper, places[0]);
    shop.pin(upper, lower, places[1]);
    shop.builder.add_damping(lower, 1e-3, 0.0);
    steps_allocate_nothing(shop.build(), 500);
}

#[test]
fn a_four_bar_linkage_allocates_nothing() {
    let mut shop = Workshop::new(1e-9);
    // Upright cranks would stand still.
    let joints = [DVec2::ZERO, DVec2::new(0.2, 1.0), DVec2::new(2.0, 1.5), DVec2::new(2.0, 0.0)];
    let bars = [("crank", 0), ("coupler", 1), ("rocker", 2)]
        .map(|(name, place)| shop.bar(name, joints[place], joints[place + 1]));
    shop.pin(BodyId::WORLD, bars[0], joints[0]);
    shop.pin(bars[0], bars[1], joints[1]);
    shop.pin(bars[1], bars[2], joints[2]);
    shop.pin(bars[2], BodyId::WORLD, joints[3]);
    steps_allocate_nothing(shop.build(), 400);
}

#[test]
fn a_disc_that_slides_to_and_fro_in_a_bowl_allocates_nothing() {
    let mut shop = Workshop::new(1e-9);
    shop.fixed("bowl", Shape::ring(4.0, 3.0).expect("a fine ring"), DVec2::ZERO);
    let place = 2.5 * DVec2::from_angle(-1.0);
    shop.dull("disc", disc(0.5), 1.0, at_rest(place.x, place.y));
    steps_allocate_nothing(shop.build(), 200);
}

#[test]
fn a_stack_at_rest_allocates_nothing() {
    let mut shop = Workshop::new(1e-9);
    shop.fixed("floor", block(10.0, 1.0), DVec2::new(0.0, -0.5));
    for index in 0..5 {
        let height = 0.25 + 0.5 * f64::from(index);
        shop.dull(&format!("block {index}"), block(1.0, 0.5), 1.0, at_rest(0.0, height));
    }
    // A step is as long as its accelerations are sound, so steps are long where nothing moves.
    let mut world = shop.build();
    let steps_allocate = allocations(&mut world, 1e4, 1e5);
    assert_eq!(steps_allocate, (0, 0), "{:?}", world.statistics());
    assert!(world.statistics().steps > 20, "{:?}", world.statistics());
}

#[test]
fn a_pendulum_that_hits_a_wall_again_and_again_allocates_nothing() {
    let mut shop = Workshop::new(1e-9);
    shop.fixed("wall", block(1.0, 4.0), DVec2::new(-0.75, 0.0));
    let bob = shop.body("bob", disc(0.25), 1.0, at_rest(1.0, 0.0));
    shop.connect(ConnectorKind::Rod { a: world_point(0.0, 0.0), b: center(bob), length: 1.0 }, 0.0);
    let mut world = shop.build();
    let (allocations, impacts) = allocations(&mut world, 20.0, 60.0);
    assert!(impacts > 20, "{impacts} impacts");
    assert_eq!(allocations, 0, "over {impacts} impacts");
}

/// A block that a drum turns over and over.
fn drum(run: &str) -> World {
    world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"drum\"\nrun = {{ duration = 300.0, strategy = \"steps\", {run} }}\n\
         force = [{{ gravity = {{ acceleration = [0.0, -10.0] }} }}]\n\
         [[body]]\nname = \"drum\"\nfixed = true\nfriction = 1.5\nmotion = {{ angular_velocity = 0.5 }}\n\
         shape = {{ ring = {{ outer = 2.2, inner = 2.0 }} }}\n\
         [[body]]\nname = \"block\"\nmass = 1.0\nelasticity = 0.0\nfriction = 1.5\n\
         shape = {{ block = {{ width = 0.8, height = 0.6 }} }}\n"
    ))
}

#[test]
fn steps_of_one_length_and_chosen_ones_allocate_nothing() {
    for run in ["time_step = 0.01, tolerance = 1e-2", "tolerance = 1e-2"] {
        let mut world = drum(run);
        let (allocations, events) = allocations(&mut world, 100.0, 200.0);
        println!("{run}: {allocations} allocations over {events} events");
        assert!(events > 100, "{run}: {events} changes");
        assert_eq!(allocations, 0, "{run}: over {events} events");
    }
}

#[test]
fn mechanisms_by_steps_allocate_nothing() {
    for name in [
        "slider_crank_driven",
        "double_pendulum_motor",
        "pendulum_dry_friction",
        "rack_and_pinion_spring",
        "planetary_gear_torque",
    ] {
        // Exactly, and by sweeps.
        for tolerance in [1e-6, 1e-2] {
            let scene = Scene::read(data(&format!("mechanisms/{name}.json"))).expect("it can be read");
            let run = RunData {
                strategy: StrategyData::Steps,
                time_step: Some(0.01),
                tolerance: Some(tolerance),
                ..scene.run.clone()
            };
            let mut world = World::from_scene(&Scene { run, ..scene }).expect("a fine scene");
            let (allocations, _) = allocations(&mut world, 5.0, 10.0);
            assert_eq!(allocations, 0, "{name} at {tolerance}");
        }
    }
}

#[test]
fn steps_that_are_chosen_over_impacts_allocate_nothing() {
    let mut world = world_of(
        "format = \"halfgap-scene-1\"\ntitle = \"ball\"\n\
         run = { duration = 200.0, strategy = \"steps\", tolerance = 1e-3 }\n\
         force = [{ gravity = { acceleration = [0.0, -10.0] } }]\n\
         [[body]]\nname = \"floor\"\nfixed = true\nshape = { block = { width = 10.0, height = 1.0 } }\n\
         [[body]]\nname = \"ball\"\nmass = 1.0\nshape = { disc = { radius = 0.2 } }\nposition = [0.0, 1.5]\n",
    );
    let (allocations, events) = allocations(&mut world, 50.0, 150.0);
    assert!(events > 50, "{events} impacts");
    assert_eq!(allocations, 0, "over {events} impacts");
}
