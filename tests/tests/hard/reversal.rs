//! Elastic scenes run backwards: with all velocities turned round they go back to where they came from.

use super::within;
use halfgap::geometry::{DVec2, Shape};
use halfgap::{BodySpec, BodyState, World, WorldBuilder, WorldSettings};
use halfgap_tests::mechanism::{advance, block, disc};

/// Bodies in a room, from given states.
fn room(tolerance: f64, gravity: f64, bodies: &[(Shape, BodyState)]) -> World {
    let mut builder = WorldBuilder::new(WorldSettings { tolerance, ..WorldSettings::default() });
    for (name, shape, at) in [
        ("floor", block(10.0, 1.0), DVec2::new(0.0, -4.5)),
        ("ceiling", block(10.0, 1.0), DVec2::new(0.0, 4.5)),
        ("left", block(1.0, 10.0), DVec2::new(-4.5, 0.0)),
        ("right", block(1.0, 10.0), DVec2::new(4.5, 0.0)),
    ] {
        builder.add(BodySpec::fixed(name, shape, at));
    }
    for (index, (shape, state)) in bodies.iter().enumerate() {
        let body = builder.add(BodySpec::movable(&format!("body{index}"), shape.clone(), 1.0, *state));
        builder.add_gravity(body, DVec2::new(0.0, -gravity));
    }
    builder.build().unwrap_or_else(|error| panic!("{error}"))
}

/// Runs forth and back; how far the bodies are from where they were [m, rad].
fn there_and_back(tolerance: f64, gravity: f64, bodies: &[(Shape, BodyState)], duration: f64) -> (f64, u64) {
    let mut world = room(tolerance, gravity, bodies);
    let movable: Vec<_> = world.bodies().filter(|&body| !world.is_fixed(body)).collect();
    let start: Vec<BodyState> = movable.iter().map(|&body| world.state(body)).collect();
    advance(&mut world, duration);
    let turned: Vec<(Shape, BodyState)> = movable
        .iter()
        .zip(bodies)
        .map(|(&body, (shape, _))| {
            let state = world.state(body);
            let back =
                BodyState { velocity: -state.velocity, angular_velocity: -state.angular_velocity, ..state };
            (shape.clone(), back)
        })
        .collect();
    let mut back = room(tolerance, gravity, &turned);
    advance(&mut back, duration);
    let off = movable.iter().zip(&start).map(|(&body, start)| {
        let state = back.state(body);
        state.position.distance(start.position) + (state.angle - start.angle).abs()
    });
    (off.fold(0.0, f64::max), world.statistics().impacts)
}

fn moving(x: f64, y: f64, vx: f64, vy: f64, spin: f64) -> BodyState {
    BodyState {
        position: DVec2::new(x, y),
        velocity: DVec2::new(vx, vy),
        angular_velocity: spin,
        ..BodyState::default()
    }
}

#[test]
fn discs_go_back_to_where_they_came_from() {
    let bodies = [
        (disc(0.5), moving(-2.0, 0.3, 1.3, 0.7, 0.0)),
        (disc(0.8), moving(1.0, -1.0, -0.8, 0.4, 0.0)),
        (disc(0.3), moving(2.0, 2.0, -0.3, -1.1, 0.0)),
    ];
    let (off, impacts) = there_and_back(1e-12, 0.0, &bodies, 10.0);
    assert!(impacts >= 7, "{impacts} impacts");
    within(&format!("3 discs there and back, {impacts} impacts each way [m]"), off, 1e-8);
    let (off, impacts) = there_and_back(1e-12, 10.0, &bodies, 3.0);
    assert!(impacts >= 7, "{impacts} impacts");
    within(&format!("3 discs under gravity there and back, {impacts} impacts each way [m]"), off, 1e-6);
}

#[test]
fn a_block_and_a_disc_go_back_to_where_they_came_from() {
    let bodies =
        [(block(1.0, 0.6), moving(-2.0, 0.3, 1.3, 0.7, 1.0)), (disc(0.8), moving(1.0, -1.0, -0.8, 0.4, 0.0))];
    let (off, impacts) = there_and_back(1e-12, 0.0, &bodies, 10.0);
    assert!(impacts >= 5, "{impacts} impacts");
    within(&format!("block and disc there and back, {impacts} impacts each way [m]"), off, 1e-7);
}
