//! A disc slides over a round hill, leaves it where gravity no longer bends its path enough, and flies on.

use crate::reference::one_freedom::OneFreedom;
use crate::scene::{Body, Check, Scene, Shape};
use glam::DVec2;
use halfgap::BodyState;

const GRAVITY: f64 = 9.81;
const HILL: f64 = 1.0;
const DISC: f64 = 0.25;
/// Rate of the angle from the top at the start [rad/s].
const RATE: f64 = 0.5;

pub(super) fn scene() -> Scene {
    let reach = HILL + DISC;
    let rate = |angle: f64| (RATE * RATE + 2.0 * GRAVITY / reach * (1.0 - angle.cos())).sqrt();
    let sliding = OneFreedom { rate: &rate, start: 0.0, kinks: Vec::new(), piece: 0.02 };
    // The contact opens where g cos a = (R + r) a'^2.
    let leaving = (2.0 / 3.0 + RATE * RATE * reach / (3.0 * GRAVITY)).acos();
    let left_at = sliding.time_of(leaving);
    let on_hill = |angle: f64| BodyState {
        position: reach * DVec2::new(angle.sin(), angle.cos()),
        velocity: reach * rate(angle) * DVec2::new(angle.cos(), -angle.sin()),
        ..BodyState::default()
    };
    let state = |time: f64| {
        if time < left_at {
            return on_hill(sliding.at(time).0);
        }
        let (start, since) = (on_hill(leaving), time - left_at);
        let fall = DVec2::new(0.0, -GRAVITY);
        BodyState {
            position: start.position + since * (start.velocity + 0.5 * since * fall),
            velocity: start.velocity + since * fall,
            ..start
        }
    };
    let error = sliding.at(0.9 * left_at).1.max(1e-14);
    let check = |time: f64| Check { time, states: vec![(0, state(time))] };
    let disc = Body::disc("disc", DISC, 1.0, DVec2::new(0.0, reach), DVec2::new(RATE * reach, 0.0))
        .with_elasticity(0.0);
    let hill = Body::fixed("hill", Shape::Disc { radius: HILL }, DVec2::ZERO).with_elasticity(0.0);
    let mut scene =
        Scene::new("disc_off_hill", "a disc slides over a round hill and leaves it", vec![disc, hill]);
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    scene
        .with_checks(0.1, vec![check(0.3), check(0.6), check(1.0), check(1.4)])
        .with_reference("energy and quadrature, then a parabola", error)
}
