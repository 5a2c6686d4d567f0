//! Nothing passes through anything: fast bodies, and what they hit, before a thin wall.

use halfgap::geometry::{DVec2, Shape};
use halfgap::{AdvanceBy, BodySpec, BodyState, Surface, World, WorldBuilder, WorldSettings};
use halfgap_tests::random::Random;

/// Speed of what is shot [m/s], place of the wall [m], and thickness of it [m].
const SPEED: f64 = 300.0;
const WALL: f64 = 5.0;
const THIN: f64 = 0.02;

fn shape(random: &mut Random, size: f64) -> Shape {
    let corner = |x: f64, y: f64| DVec2::new(size * x, size * y);
    let corners = [corner(-1.0, -1.0), corner(1.0, -0.8), corner(0.2, 1.0)];
    let shape = match random.below(3) {
        0 => Shape::disc(size),
        1 => Shape::block(2.0 * size, 1.2 * size),
        _ => Shape::polygon(&corners),
    };
    shape.expect("a fine shape")
}

/// Up to three bodies on their way to a wall, the first of which is fast; sometimes it spins by a third of a turn in a step or more.
fn shot(seed: u64, hertz: f64) -> World {
    let mut random = Random::new(seed);
    let settings = WorldSettings {
        strategy: AdvanceBy::Steps { step: Some(1.0 / hertz), residual: 1e-6 },
        ..WorldSettings::default()
    };
    let surface = Surface { friction: 0.3, static_friction: 0.3, ..Surface::default() };
    let mut builder = WorldBuilder::new(settings);
    let wall = Shape::block(THIN, 400.0).expect("a fine shape");
    builder.add(BodySpec { surface, ..BodySpec::fixed("wall", wall, DVec2::new(WALL, 0.0)) });
    let mut x = -6.0;
    for index in 0..=random.below(3) {
        let size = random.between(0.05, 0.3);
        let shape = shape(&mut random, size);
        let mut state = BodyState {
            position: DVec2::new(x, random.between(-0.2, 0.2)),
            angle: random.between(0.0, 6.0),
            ..BodyState::default()
        };
        if index == 0 {
            state.velocity = DVec2::new(SPEED, random.between(-20.0, 20.0));
            let spins = [0.0, random.between(-50.0, 50.0), random.between(-2000.0, 2000.0)];
            state.angular_velocity = spins[random.below(3)];
        }
        let mass = [0.1, 1.0, 10.0][random.below(3)];
        let elasticity = [0.0, 0.5, 1.0][random.below(3)];
        let spec = BodySpec::movable(&format!("body {index}"), shape, mass, state);
        builder.add(BodySpec { surface, elasticity, ..spec });
        x += random.between(1.5, 5.0);
    }
    builder.build().expect("a fine world")
}

#[test]
fn nothing_passes_through_a_thin_wall_at_300_metres_a_second() {
    for seed in 0..1000 {
        let hertz = [60.0, 240.0, 960.0][seed as usize % 3];
        let mut world = shot(seed, hertz);
        let start = world.energy().kinetic;
        world.advance_to(0.2, &mut |_| ()).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let kinetic = world.energy().kinetic;
        assert!(kinetic <= 1.01 * start, "seed {seed}: {kinetic} J of {start} J");
        for body in world.bodies().skip(1) {
            let BodyState { position, .. } = world.state(body);
            assert!(position.x < WALL, "seed {seed}: {body:?} at {position}");
        }
    }
}
