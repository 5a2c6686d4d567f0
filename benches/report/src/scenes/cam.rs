//! A cam of a base circle, a nose circle and two tangent flanks turns under a roller that is guided upright.
//!
//! One degree of freedom: the lift is known in closed form for base, flank and nose; energy gives the rate of the cam,
//! quadrature the time, cut where the contact passes from one edge to the next.

use crate::reference::one_freedom::OneFreedom;
use crate::scene::{Body, Check, Connector, Inertia, Scene, Shape, Surface};
use glam::DVec2;
use halfgap::BodyState;
use halfgap::geometry::{EdgeSpec, PathSpec};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const GRAVITY: f64 = 9.81;
const BASE: f64 = 0.5;
const NOSE: f64 = 0.2;
/// Distance of the two centres [m].
const REACH: f64 = 0.6;
const ROLLER: f64 = 0.15;
const CAM: Inertia = Inertia { mass: 5.0, moment: 1.0 };
const ROLLER_MASS: f64 = 0.2;
/// Rate of the cam at the start [rad/s].
const RATE: f64 = 2.0;
/// The nose points down at the start.
const START: f64 = -FRAC_PI_2;

/// Angle between the nose and the normal of a flank [rad].
fn flank() -> f64 {
    ((BASE - NOSE) / REACH).acos()
}

/// Angle from the nose at which the contact passes from nose to flank [rad].
fn flank_end() -> f64 {
    flank() - (REACH * flank().sin() / (BASE + ROLLER)).atan()
}

/// Height of the roller over the pivot [m], and its derivative by the cam's angle [m/rad].
fn lift(cam: f64) -> (f64, f64) {
    // Where the roller is, seen from the nose.
    let seen = (FRAC_PI_2 - cam + PI).rem_euclid(TAU) - PI;
    let (angle, side) = (seen.abs(), seen.signum());
    if angle >= flank() {
        (BASE + ROLLER, 0.0)
    } else if angle >= flank_end() {
        let (sin, cos) = (flank() - angle).sin_cos();
        ((BASE + ROLLER) / cos, side * (BASE + ROLLER) * sin / (cos * cos))
    } else {
        let (sin, cos) = angle.sin_cos();
        let root = ((NOSE + ROLLER).powi(2) - (REACH * sin).powi(2)).sqrt();
        (REACH * cos + root, side * (REACH * sin + REACH * REACH * sin * cos / root))
    }
}

fn rate(cam: f64) -> f64 {
    let (height, slope) = lift(cam);
    let energy = 0.5 * CAM.moment * RATE * RATE - ROLLER_MASS * GRAVITY * (height - BASE - ROLLER);
    (2.0 * energy / (CAM.moment + ROLLER_MASS * slope * slope)).sqrt()
}

pub(super) fn scene() -> Scene {
    let places = [-flank(), -flank_end(), flank_end(), flank()];
    let kinks = (0..4).flat_map(|lap| places.map(|place| FRAC_PI_2 + place + f64::from(lap) * TAU)).collect();
    let motion = OneFreedom { rate: &rate, start: START, kinks, piece: 0.05 };
    let mut error = 1e-14_f64;
    let check = |time: f64| {
        let (cam, doubt) = motion.at(time);
        error = error.max(doubt);
        let ((height, slope), rate) = (lift(cam), rate(cam));
        let cam = BodyState { angle: cam, angular_velocity: rate, ..BodyState::default() };
        let roller = BodyState {
            position: DVec2::new(0.0, height),
            velocity: DVec2::new(0.0, slope * rate),
            ..BodyState::default()
        };
        Check { time, states: vec![(0, cam), (1, roller)] }
    };
    let checks = [1.5, 2.0, 4.0, 8.0].map(check).to_vec();
    let start = BodyState { angle: START, angular_velocity: RATE, ..BodyState::default() };
    let shape = Shape::Outline(vec![outline()]);
    let cam = Body {
        name: "cam".to_owned(),
        shape,
        inertia: Some(CAM),
        start,
        elasticity: 0.0,
        surface: Surface::SMOOTH,
        spin: 0.0,
    };
    let roller = Body::disc("roller", ROLLER, ROLLER_MASS, DVec2::new(0.0, BASE + ROLLER), DVec2::ZERO);
    let mut scene =
        Scene::new("cam_and_roller", "a cam turns under a roller", vec![cam, roller.with_elasticity(0.0)]);
    let pivot = crate::scene::End::world(DVec2::ZERO);
    scene.connectors = vec![
        Connector::Pin(pivot, crate::scene::End::body(0, DVec2::ZERO)),
        Connector::Guide { body: 1, point: DVec2::ZERO, axis: DVec2::Y },
    ];
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    scene.with_checks(0.5, checks).with_reference("closed form of the lift, energy and quadrature", error)
}

fn outline() -> PathSpec {
    let (nose, up, down) = (DVec2::new(REACH, 0.0), DVec2::from_angle(flank()), DVec2::from_angle(-flank()));
    PathSpec {
        start: BASE * up,
        edges: vec![
            EdgeSpec::Arc { to: BASE * down, center: DVec2::ZERO, clockwise: false },
            EdgeSpec::Line { to: nose + NOSE * down },
            EdgeSpec::Arc { to: nose + NOSE * up, center: nose, clockwise: false },
            EdgeSpec::Line { to: BASE * up },
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lift_and_its_slope_are_continuous_and_fit() {
        for cam in [-flank(), -flank_end(), flank_end(), flank()].map(|place| FRAC_PI_2 + place) {
            let ((a, slope_a), (b, slope_b)) = (lift(cam - 1e-9), lift(cam + 1e-9));
            assert!((a - b).abs() < 1e-8 && (slope_a - slope_b).abs() < 1e-7, "{cam}: {slope_a} {slope_b}");
        }
        for cam in [0.1, 0.6, 1.2, 1.7, 2.4] {
            let slope = (lift(cam + 1e-6).0 - lift(cam - 1e-6).0) / 2e-6;
            assert!((slope - lift(cam).1).abs() < 1e-8, "{cam}: {slope} {}", lift(cam).1);
        }
    }

    #[test]
    fn the_roller_never_leaves_the_cam() {
        let step = 1e-4;
        for index in 0..62_832 {
            let cam = START + step * f64::from(index);
            let speed = |cam: f64| lift(cam).1 * rate(cam);
            let acceleration = (speed(cam + step) - speed(cam)) / step * rate(cam);
            assert!(acceleration > -GRAVITY, "at {cam}: {acceleration}");
        }
    }
}
