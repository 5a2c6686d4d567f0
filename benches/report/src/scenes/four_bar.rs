//! A four-bar linkage whose crank turns all round under gravity.
//!
//! One degree of freedom: energy gives the crank's rate from its angle, quadrature the time. With a driven crank the
//! angle is known at once.

use crate::on_joint::OnJoint;
use crate::reference::one_freedom::OneFreedom;
use crate::scene::{Body, Check, Connector, End, Scene};
use glam::DVec2;
use halfgap::BodyState;

const GRAVITY: f64 = 9.81;
/// Crank, coupler, rocker, ground [m].
const LENGTHS: [f64; 4] = [0.5, 1.5, 1.25, 1.75];
const WIDTH: f64 = 0.1;
/// Masses of crank, coupler and rocker [kg].
const MASSES: [f64; 3] = [2.0, 1.0, 1.0];
/// Rate of the crank at the start [rad/s].
const RATE: f64 = 8.0;
/// Angle of the crank at the start [rad].
const START: f64 = 0.5;
/// Times of the checks [s].
const TIMES: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// Poses of the three bars and their rates per rate of the crank.
struct Configuration {
    bars: [BodyState; 3],
}

fn configuration(crank: f64) -> Configuration {
    let [a, b, c, d] = LENGTHS;
    let pin = a * DVec2::from_angle(crank);
    let ground = DVec2::new(d, 0.0);
    // The joint of coupler and rocker lies on two circles; it stays on the left of the line from pin to ground.
    let line = ground - pin;
    let distance = line.length();
    let foot = (distance * distance + b * b - c * c) / (2.0 * distance);
    let rise = (b * b - foot * foot).sqrt();
    let joint = pin + (line * foot + line.perp() * rise) / distance;
    let (coupler, rocker) = (joint - pin, joint - ground);
    // The joint's velocity as coupler and as rocker: a u + w_b coupler^perp = w_c rocker^perp.
    let speed = pin.perp();
    let turn_rocker = speed.dot(coupler) / rocker.perp().dot(coupler);
    let turn_coupler = (turn_rocker * rocker.perp() - speed).dot(coupler.perp()) / coupler.length_squared();
    let bar = |from: DVec2, to: DVec2, velocity: DVec2, turn: f64| BodyState {
        position: 0.5 * (from + to),
        angle: (to - from).to_angle(),
        velocity,
        angular_velocity: turn,
    };
    let crank_bar = BodyState { angle: crank, ..bar(DVec2::ZERO, pin, 0.5 * speed, 1.0) };
    let joint_speed = turn_rocker * rocker.perp();
    Configuration {
        bars: [
            crank_bar,
            bar(pin, joint, 0.5 * (speed + joint_speed), turn_coupler),
            bar(ground, joint, 0.5 * joint_speed, turn_rocker),
        ],
    }
}

fn moment(bar: usize) -> f64 {
    MASSES[bar] * (LENGTHS[bar] * LENGTHS[bar] + WIDTH * WIDTH) / 12.0
}

/// Effective moment of inertia at the crank [kg m^2], and potential energy [J].
fn inertia_and_potential(crank: f64) -> (f64, f64) {
    let bars = configuration(crank).bars;
    let mut sums = (0.0, 0.0);
    for (bar, state) in bars.iter().enumerate() {
        let turn = state.angular_velocity;
        sums.0 += MASSES[bar] * state.velocity.length_squared() + moment(bar) * turn * turn;
        sums.1 += MASSES[bar] * GRAVITY * state.position.y;
    }
    sums
}

fn state(bar: &BodyState, rate: f64) -> BodyState {
    BodyState { velocity: bar.velocity * rate, angular_velocity: bar.angular_velocity * rate, ..*bar }
}

pub(super) fn scene() -> Scene {
    let (inertia, potential) = inertia_and_potential(START);
    let energy = 0.5 * inertia * RATE * RATE + potential;
    let rate = |crank: f64| {
        let (inertia, potential) = inertia_and_potential(crank);
        (2.0 * (energy - potential) / inertia).sqrt()
    };
    let motion = OneFreedom { rate: &rate, start: START, kinks: Vec::new(), piece: 0.05 };
    let mut error = 1e-14_f64;
    let known = |time: f64| {
        let (crank, doubt) = motion.at(time);
        error = error.max(doubt);
        check(time, crank, rate(crank))
    };
    let checks = TIMES.map(known).to_vec();
    linkage("four_bar", "a four-bar linkage, its crank turning all round", checks)
        .with_reference("energy and quadrature in the crank's angle", error)
}

/// The same with a crank that is driven at its rate.
pub(super) fn driven() -> Scene {
    let checks = TIMES.map(|time| check(time, START + RATE * time, RATE)).to_vec();
    let mut scene =
        linkage("driven_four_bar", "a four-bar linkage, its crank driven at an even rate", checks);
    scene.on_joints = vec![(0, OnJoint::rate(RATE))];
    scene.with_reference("closed form in the crank's angle", 1e-14)
}

fn check(time: f64, crank: f64, rate: f64) -> Check {
    let bars = configuration(crank).bars;
    let states = bars.iter().enumerate().map(|(bar, pose)| (bar, state(pose, rate)));
    Check { time, states: states.collect() }
}

fn linkage(name: &str, about: &str, checks: Vec<Check>) -> Scene {
    let start = configuration(START).bars;
    let names = ["crank", "coupler", "rocker"];
    let body = |bar: usize| {
        let size = DVec2::new(LENGTHS[bar], WIDTH);
        Body::block(names[bar], size, MASSES[bar], state(&start[bar], RATE)).with_elasticity(0.0)
    };
    let end = |bar: usize, side: f64| End::body(bar, DVec2::new(side * 0.5 * LENGTHS[bar], 0.0));
    let mut scene = Scene::new(name, about, vec![body(0), body(1), body(2)]);
    scene.connectors = vec![
        Connector::Pin(End::world(DVec2::ZERO), end(0, -1.0)),
        Connector::Pin(end(0, 1.0), end(1, -1.0)),
        Connector::Pin(end(1, 1.0), end(2, 1.0)),
        Connector::Pin(End::world(DVec2::new(LENGTHS[3], 0.0)), end(2, -1.0)),
    ];
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    scene.collisions = false;
    scene.with_checks(0.5, checks)
}
