//! A bead on a cycloid, the curve of quickest descent, on which every swing takes the same time.
//!
//! The arc length from the lowest point swings like a spring: `s = s0 cos(w t)` with `w^2 = g / 4a`. The rail
//! is the cubic spline through points of the cycloid; with `h` between them it is off by `h^4 / 384` times
//! the fourth derivative.

use crate::scene::{Body, Check, Connector, Scene};
use glam::DVec2;
use halfgap::BodyState;

const GRAVITY: f64 = 9.81;
/// Radius of the wheel that rolls the cycloid out [m].
const WHEEL: f64 = 0.5;
/// The rail spans wheel angles up to this on both sides [rad]; the bead stays where the ends are no longer felt.
const SPAN: f64 = 2.5;
const POINTS: usize = 1001;
/// The bead starts at this wheel angle [rad].
const START: f64 = 1.8;

fn point(angle: f64) -> DVec2 {
    WHEEL * DVec2::new(angle + angle.sin(), -angle.cos())
}

pub(super) fn scene() -> Scene {
    let amplitude = 4.0 * WHEEL * (0.5 * START).sin();
    let frequency = (GRAVITY / (4.0 * WHEEL)).sqrt();
    let state = |time: f64| {
        let (sin, cos) = (frequency * time).sin_cos();
        let angle = 2.0 * (amplitude * cos / (4.0 * WHEEL)).asin();
        let tangent = DVec2::from_angle(0.5 * angle);
        BodyState {
            position: point(angle),
            velocity: -amplitude * frequency * sin * tangent,
            ..BodyState::default()
        }
    };
    let check = |time: f64| Check { time, states: vec![(0, state(time))] };
    let bead = Body::disc("bead", 0.05, 1.0, point(START), DVec2::ZERO);
    let knot = |index: usize| point(SPAN * (2.0 * index as f64 / (POINTS - 1) as f64 - 1.0));
    let mut scene = Scene::new("brachistochrone", "a bead on a rail along a cycloid", vec![bead]);
    scene.connectors = vec![Connector::Rail { body: 0, points: (0..POINTS).map(knot).collect() }];
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    scene.collisions = false;
    scene.with_checks(0.5, vec![check(0.5), check(2.0), check(5.0)]).with_reference(
        "closed form of the cycloid; the spline through its points differs by about this",
        SPLINE_ERROR,
    )
}

/// What the spline and its slope do to the motion [m]: `h = 2 SPAN / 1000`, `h^4 / 384` is 1.6e-12.
const SPLINE_ERROR: f64 = 2e-12;
