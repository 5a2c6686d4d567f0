//! A gas of discs in its steady state allocates nothing, however many impacts go by.
#![allow(unsafe_code, reason = "an allocator that counts is the only way to see allocations")]

use halfgap_tests::world_of;
use std::alloc::{GlobalAlloc, Layout, System};
use std::fmt::Write;
use std::sync::atomic::{AtomicU64, Ordering};

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);

struct Counting;

// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
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

#[test]
fn a_steady_state_allocates_nothing() {
    let mut world = world_of(&gas());
    let mut impacts = 0u64;
    world.advance_to(400.0, &mut |_| impacts += 1).expect("it goes on");
    assert!(impacts > 10_000, "{impacts} impacts to warm up");
    let before = ALLOCATIONS.load(Ordering::Relaxed);
    let mut seen = 0u64;
    world.advance_to(500.0, &mut |_| seen += 1).expect("it goes on");
    let allocations = ALLOCATIONS.load(Ordering::Relaxed) - before;
    assert!(seen > 2_000, "{seen} impacts");
    assert_eq!(allocations, 0, "over {seen} impacts");
}
