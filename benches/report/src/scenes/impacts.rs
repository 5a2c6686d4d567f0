//! Two discs that meet off-centre with restitution, and a disc that bounces to rest while it slides down a slope.

use crate::scene::{Body, Check, Scene, Shape};
use glam::DVec2;
use halfgap::BodyState;

pub(super) fn oblique() -> Scene {
    let (elasticity, radii, masses) = (0.6, [0.5, 0.3], [1.0, 3.0]);
    let places = [DVec2::new(-2.0, 0.0), DVec2::new(1.0, 0.4)];
    let velocities = [DVec2::new(3.0, 0.25), DVec2::new(-1.0, 0.0)];
    // They touch when the square of their distance is that of the sum of the radii.
    let (offset, approach) = (places[1] - places[0], velocities[1] - velocities[0]);
    let (a, b) = (approach.length_squared(), offset.dot(approach));
    let reach: f64 = radii.iter().sum();
    let meeting = (-b - (b * b - a * (offset.length_squared() - reach * reach)).sqrt()) / a;
    let normal = (offset + approach * meeting) / reach;
    let impulse = -(1.0 + elasticity) * approach.dot(normal) / (1.0 / masses[0] + 1.0 / masses[1]);
    let after = [velocities[0] - normal * impulse / masses[0], velocities[1] + normal * impulse / masses[1]];
    let state = |body: usize, time: f64| BodyState {
        position: places[body] + velocities[body] * meeting + after[body] * (time - meeting),
        velocity: after[body],
        ..BodyState::default()
    };
    let check = |time: f64| Check { time, states: vec![(0, state(0, time)), (1, state(1, time))] };
    let disc = |body: usize| {
        let name = ["small", "heavy"][body];
        Body::disc(name, radii[body], masses[body], places[body], velocities[body])
            .with_elasticity(elasticity)
    };
    Scene::new(
        "oblique_discs",
        "two discs of unlike size and mass meet off-centre, e = 0.6",
        vec![disc(0), disc(1)],
    )
    .with_checks(0.5, vec![check(1.0), check(2.0), check(4.0)])
    .with_reference("closed form", 1e-15)
}

pub(super) fn to_rest() -> Scene {
    let (radius, height, elasticity): (f64, f64, f64) = (0.25, 1.0, 0.6);
    // A slope of 3 : 4, turned so that it lies along x.
    let gravity = DVec2::new(6.0, -8.0);
    let state = |time: f64| {
        let (y, rise) = height_at(time, height, elasticity, -gravity.y);
        BodyState {
            position: DVec2::new(0.5 * gravity.x * time * time, radius + y),
            velocity: DVec2::new(gravity.x * time, rise),
            ..BodyState::default()
        }
    };
    let check = |time: f64| Check { time, states: vec![(0, state(time))] };
    let ball = Body::disc("ball", radius, 1.0, DVec2::new(0.0, radius + height), DVec2::ZERO);
    let slope = Shape::Block { width: 80.0, height: 1.0 };
    let slope = Body::fixed("slope", slope, DVec2::new(20.0, -0.5)).with_elasticity(elasticity);
    let mut scene = Scene::new(
        "bounce_to_rest",
        "a disc bounces to rest on a slope, infinitely often within 2 s, and slides on",
        vec![ball.with_elasticity(elasticity), slope],
    );
    scene.gravity = gravity;
    scene
        .with_checks(0.1, vec![check(1.0), check(1.8), check(2.1), check(3.0)])
        .with_reference("closed form: a geometric series of bounces", 1e-14)
}

/// Height over the floor and its rate at a time, dropped from rest.
fn height_at(time: f64, height: f64, elasticity: f64, gravity: f64) -> (f64, f64) {
    let mut speed = (2.0 * gravity * height).sqrt();
    let mut landing = speed / gravity;
    if time < landing {
        return (height - 0.5 * gravity * time * time, -gravity * time);
    }
    if time >= landing * (1.0 + 2.0 * elasticity / (1.0 - elasticity)) {
        return (0.0, 0.0);
    }
    loop {
        speed *= elasticity;
        let flight = 2.0 * speed / gravity;
        if time < landing + flight {
            let since = time - landing;
            return (speed * since - 0.5 * gravity * since * since, speed - gravity * since);
        }
        landing += flight;
    }
}
