//! Big piles at the accuracy of games, without friction: nothing is known of them but what they cost.

use crate::scene::{Body, Scene, Shape};
use glam::DVec2;
use halfgap::BodyState;

const GRAVITY: f64 = 9.81;

pub(super) fn discs() -> Scene {
    let (radius, across, count) = (0.25, 10, 200);
    let width = 2.2 * radius * f64::from(across);
    let mut bodies = vec![
        Body::fixed("floor", Shape::Block { width: width + 4.0, height: 1.0 }, DVec2::new(0.5 * width, -0.5)),
        Body::fixed("left", Shape::Block { width: 1.0, height: 30.0 }, DVec2::new(-0.5, 15.0)),
        Body::fixed("right", Shape::Block { width: 1.0, height: 30.0 }, DVec2::new(width + 0.5, 15.0)),
    ];
    for index in 0..count {
        let (column, row) = (f64::from(index % across), f64::from(index / across));
        // Rows alternate to the sides, so that discs do not stand on top of each other.
        let shift = if index / across % 2 == 0 { -0.04 } else { 0.04 };
        let place = DVec2::new((column + 0.5) * 2.2 * radius + shift * radius, (row + 0.5) * 2.4 * radius);
        bodies.push(Body::disc(&format!("disc {index}"), radius, 1.0, place, DVec2::ZERO));
    }
    pile("settling_discs", "200 discs settle in a box", bodies, 0.2, 2.0)
}

pub(super) fn stack() -> Scene {
    let mut bodies =
        vec![Body::fixed("floor", Shape::Block { width: 20.0, height: 1.0 }, DVec2::new(0.0, -0.5))];
    for index in 0..100 {
        let start = BodyState { position: DVec2::new(0.0, f64::from(index) + 0.5), ..BodyState::default() };
        bodies.push(Body::block(&format!("box {index}"), DVec2::ONE, 1.0, start));
    }
    pile("stack_of_boxes", "100 boxes stand on each other", bodies, 0.0, 2.0)
}

fn pile(name: &str, about: &str, bodies: Vec<Body>, elasticity: f64, duration: f64) -> Scene {
    let bodies = bodies.into_iter().map(|body| body.with_elasticity(elasticity)).collect();
    let mut scene = Scene::new(name, about, bodies);
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    (scene.duration, scene.check_grid) = (duration, 0.05);
    scene
}
