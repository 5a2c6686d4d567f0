//! A slider-crank with a crank that is driven at an even rate: the crank's angle is known, and all else by the textbook's
//! formula of the piston.

use crate::on_joint::OnJoint;
use crate::scene::{Body, Check, Connector, End, Scene};
use glam::DVec2;
use halfgap::BodyState;

/// Crank and rod [m].
const LENGTHS: [f64; 2] = [0.2, 0.7];
const WIDTH: f64 = 0.05;
/// Masses of crank, rod and piston [kg].
const MASSES: [f64; 3] = [3.0, 2.0, 4.0];
/// Rate of the crank [rad/s] and its angle at the start [rad].
const RATE: f64 = 10.0;
const START: f64 = 1.1;

fn states(crank: f64) -> [BodyState; 3] {
    let [r, l] = LENGTHS;
    let pin = r * DVec2::from_angle(crank);
    let pin_speed = RATE * pin.perp();
    let along = (l * l - pin.y * pin.y).sqrt();
    let piston = DVec2::new(pin.x + along, 0.0);
    // The rod's angle b has sin b = -pin.y / l, so cos b b' = -pin.y' / l.
    let rod_rate = -pin_speed.y / along;
    let piston_speed = DVec2::new(pin_speed.x - pin.y * pin_speed.y / along, 0.0);
    let bar = |ends: [DVec2; 2], speeds: [DVec2; 2], angle: f64, rate: f64| BodyState {
        position: 0.5 * (ends[0] + ends[1]),
        angle,
        velocity: 0.5 * (speeds[0] + speeds[1]),
        angular_velocity: rate,
    };
    [
        bar([DVec2::ZERO, pin], [DVec2::ZERO, pin_speed], crank, RATE),
        bar([pin, piston], [pin_speed, piston_speed], (-pin.y / l).asin(), rod_rate),
        BodyState { position: piston, velocity: piston_speed, ..BodyState::default() },
    ]
}

pub(super) fn driven() -> Scene {
    let check =
        |time: f64| Check { time, states: states(START + RATE * time).into_iter().enumerate().collect() };
    let [crank, rod, piston] = states(START);
    let bar = |index: usize| DVec2::new(LENGTHS[index], WIDTH);
    let bodies = vec![
        Body::block("crank", bar(0), MASSES[0], crank).with_elasticity(0.0),
        Body::block("rod", bar(1), MASSES[1], rod).with_elasticity(0.0),
        Body::block("piston", DVec2::new(0.16, 0.19), MASSES[2], piston).with_elasticity(0.0),
    ];
    let end = |bar: usize, side: f64| End::body(bar, DVec2::new(side * 0.5 * LENGTHS[bar], 0.0));
    let about = "a slider-crank, its crank driven at an even rate";
    let mut scene = Scene::new("driven_slider_crank", about, bodies);
    scene.connectors = vec![
        Connector::Pin(End::world(DVec2::ZERO), end(0, -1.0)),
        Connector::Pin(end(0, 1.0), end(1, -1.0)),
        Connector::Pin(end(1, 1.0), End::body(2, DVec2::ZERO)),
        Connector::Slider { body: 2, point: DVec2::ZERO, axis: DVec2::X },
    ];
    scene.on_joints = vec![(0, OnJoint::rate(RATE))];
    scene.gravity = DVec2::new(0.0, -9.81);
    scene.collisions = false;
    let checks = [0.5, 1.0, 2.0, 4.0].map(check).to_vec();
    scene.with_checks(0.5, checks).with_reference("closed form in the crank's angle", 1e-14)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_the_derivatives_of_places() {
        let step = 1e-5;
        for crank in [0.3, 2.0, 4.4] {
            let [before, now, after] = [-step, 0.0, step].map(|time| states(crank + RATE * time));
            for body in 0..3 {
                let moved = (after[body].position - before[body].position) / (2.0 * step);
                let turned = (after[body].angle - before[body].angle) / (2.0 * step);
                assert!((moved - now[body].velocity).length() < 1e-7, "{body}");
                assert!((turned - now[body].angular_velocity).abs() < 1e-7, "{body}");
            }
        }
    }
}
