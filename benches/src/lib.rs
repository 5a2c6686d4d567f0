//! Scenes that several benches run.

use halfgap::geometry::{DVec2, Shape};
use halfgap::{BodySpec, BodyState, World, WorldBuilder, WorldSettings};

/// A number in [0, 1) that looks random: the fractional part of multiples of an irrational number.
fn scattered(index: usize, irrational: f64) -> f64 {
    (index as f64 * irrational).fract()
}

/// Shapes free in a square box without gravity, fully elastic, on a jittered grid, at a speed of about 1 m/s.
///
/// `spacing` [m] is the distance of neighbours; shapes have a reach of at most 0.4 of it.
///
/// # Panics
/// If the box cannot be built: a fault of the bench.
#[must_use]
pub fn gas(count: usize, spacing: f64, spin: f64, shape: impl Fn(usize) -> Shape) -> World {
    let mut builder = WorldBuilder::new(WorldSettings::default());
    let side = (count as f64).sqrt().ceil();
    let size = side * spacing;
    let wall = |width, height| Shape::block(width, height).expect("fine sides");
    let half = 0.5 * size;
    builder.add(BodySpec::fixed("floor", wall(size + 2.0, 1.0), DVec2::new(half, -0.5)));
    builder.add(BodySpec::fixed("ceiling", wall(size + 2.0, 1.0), DVec2::new(half, size + 0.5)));
    builder.add(BodySpec::fixed("left", wall(1.0, size), DVec2::new(-0.5, half)));
    builder.add(BodySpec::fixed("right", wall(1.0, size), DVec2::new(size + 0.5, half)));
    for index in 0..count {
        let cell = DVec2::new((index as f64 % side).floor(), (index as f64 / side).floor());
        let jitter = DVec2::new(scattered(index, 0.618_033_988_7), scattered(index, 0.754_877_666_2)) - 0.5;
        let heading = std::f64::consts::TAU * scattered(index, 0.569_840_290_9);
        let state = BodyState {
            position: (cell + 0.5 + jitter * 0.1) * spacing,
            angle: heading,
            velocity: DVec2::from_angle(heading) * (0.5 + scattered(index, 0.414_213_562_3)),
            angular_velocity: spin * (scattered(index, 0.302_775_637_7) - 0.5),
        };
        builder.add(BodySpec::movable(&format!("body {index}"), shape(index), 1.0, state));
    }
    builder.build().expect("bodies of a jittered grid are apart")
}

/// Advances until about `impacts` more impacts have happened; returns how many did.
///
/// # Panics
/// If the scene stops: a fault of the bench.
pub fn advance_impacts(world: &mut World, impacts: u64) -> u64 {
    let mut seen = 0;
    let mut step = 1e-3;
    while seen < impacts {
        let before = seen;
        world.advance_to(world.time() + step, &mut |_| seen += 1).expect("a gas goes on");
        if seen - before < impacts / 20 {
            step *= 1.5;
        }
    }
    seen
}
