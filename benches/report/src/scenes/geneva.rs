//! A Geneva drive: the pin of a crank enters a slot of a wheel, turns it by a sixth, and leaves it at rest.
//!
//! The slots are true edges, a little wider than the pin, and end where the crank is square to them. Nothing
//! locks the wheel in its dwell: it rests because it was left at rest. How the answer is known is said with
//! the reference.

use crate::on_joint::OnJoint;
use crate::reference::geneva::Geneva;
use crate::scene::{Body, Check, Connector, End, Inertia, Scene, Shape, Surface};
use glam::DVec2;
use halfgap::BodyState;
use halfgap::geometry::{EdgeSpec, PathSpec};
use std::f64::consts::PI;

/// Radius of the pin [m].
const PIN: f64 = 0.06;
/// Width of the rim beside a slot [m].
const TIP: f64 = 0.05;
/// How far from the wheel's pivot the slots end [m]: the pin comes no nearer than 0.442.
const BOTTOM: f64 = 0.43;
const PIN_INERTIA: Inertia = Inertia { mass: 4.0, moment: 1.0 };
const WHEEL: Inertia = Inertia { mass: 2.0, moment: 0.3 };
/// The crank at the start, from the line of pivots [rad], and its rate [rad/s].
const START: f64 = -1.6;
const RATE: f64 = 2.0;

fn drive() -> Geneva {
    let drive = Geneva { slots: 6, distance: 1.0, play: 0.002, moments: [0.0, WHEEL.moment] };
    let crank = PIN_INERTIA.moment + PIN_INERTIA.mass * drive.radius() * drive.radius();
    Geneva { moments: [crank, WHEEL.moment], ..drive }
}

pub(super) fn scene() -> Scene {
    built("geneva_drive", "a pin turns a wheel of six slots by steps", drive())
        .with_method("closed form of the slot's angle, energy and quadrature")
}

/// The same with a crank that is driven at its rate.
pub(super) fn driven() -> Scene {
    let drive = drive();
    let drive = Geneva { moments: [f64::INFINITY, drive.moments[1]], ..drive };
    let about = "a driven pin turns a wheel of six slots by steps";
    let mut scene = built("driven_geneva", about, drive).with_method("closed form of the slot's angle");
    // The crank turns clockwise.
    scene.on_joints = vec![(0, OnJoint::rate(-RATE))];
    scene
}

fn built(name: &str, about: &str, drive: Geneva) -> Scene {
    let pivot = DVec2::new(drive.distance, 0.0);
    let mut error = 1e-14_f64;
    let mut states_at = |time: f64| {
        let (turned, doubt) = drive.at(time, START, RATE);
        error = error.max(doubt);
        // The crank turns the other way.
        let arm = DVec2::from_angle(PI - turned.crank) * drive.radius();
        let pin = BodyState {
            position: pivot + arm,
            angle: PI - turned.crank,
            velocity: -arm.perp() * turned.rates[0],
            angular_velocity: -turned.rates[0],
        };
        let wheel =
            BodyState { angle: turned.wheel, angular_velocity: turned.rates[1], ..BodyState::default() };
        [pin, wheel]
    };
    let [pin_start, wheel_start] = states_at(0.0);
    // In the first slot, in the dwell after it, in the second slot, and in the dwell after the third.
    let checks = [0.75, 2.0, 4.0, 8.5].map(|time| {
        let states = states_at(time).into_iter().enumerate().collect();
        Check { time, states }
    });
    let shape = Shape::Disc { radius: PIN };
    let pin = Body {
        name: "crank".to_owned(),
        shape,
        inertia: Some(PIN_INERTIA),
        start: pin_start,
        elasticity: 0.0,
        surface: Surface::SMOOTH,
        spin: 0.0,
    };
    let shape = Shape::Outline(vec![outline(&drive)]);
    let wheel = Body {
        name: "wheel".to_owned(),
        shape,
        inertia: Some(WHEEL),
        start: wheel_start,
        elasticity: 0.0,
        surface: Surface::SMOOTH,
        spin: 0.0,
    };
    let mut scene = Scene::new(name, about, vec![pin, wheel]);
    scene.connectors = vec![
        Connector::Pin(End::world(pivot), End::body(0, DVec2::new(-drive.radius(), 0.0))),
        Connector::Pin(End::world(DVec2::ZERO), End::body(1, DVec2::ZERO)),
    ];
    scene.with_checks(0.25, checks.to_vec()).with_reference("", error)
}

/// Round the wheel: along each slot and its rim, then straight to the next. The pin touches nothing but the
/// slots' walls, so that straight lines will do for the rest, and engines of segments have the wheel as it
/// is.
fn outline(drive: &Geneva) -> PathSpec {
    let half = PIN + drive.play;
    // Where the crank is square to the slot.
    let mouth = drive.distance * drive.half_pitch().cos();
    let corners = [(mouth, -half), (BOTTOM, -half), (BOTTOM, half), (mouth, half), (mouth, half + TIP)];
    let turned = |slot: u32, (x, y): (f64, f64)| {
        DVec2::from_angle(2.0 * drive.half_pitch() * f64::from(slot)).rotate(DVec2::new(x, y))
    };
    let rim = (mouth, -half - TIP);
    let walk = |slot| corners.map(|corner| turned(slot, corner)).into_iter().chain([turned(slot + 1, rim)]);
    let edges = (0..drive.slots).flat_map(walk).map(|to| EdgeSpec::Line { to }).collect();
    PathSpec { start: turned(0, rim), edges }
}
