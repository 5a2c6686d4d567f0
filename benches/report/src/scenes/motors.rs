//! Motors that pull no harder than they can: a wheel that is spun up, an arm that is turned all round against its weight,
//! and a load that is pulled along a slope until it meets a stop.

use super::rod::{self, GRAVITY, LENGTH};
use crate::on_joint::OnJoint;
use crate::reference::phases::{Phased, solve};
use crate::scene::{Body, Check, Connector, End, Scene};
use glam::DVec2;
use halfgap::BodyState;

/// A wheel of 2 kg and 0.5 m at rest, the speed of its motor [rad/s], and the torque of that [N m].
pub(super) fn spins_up() -> Scene {
    const MASS: f64 = 2.0;
    const RADIUS: f64 = 0.5;
    const SPEED: f64 = 12.0;
    const TORQUE: f64 = 1.7;
    let moment = 0.5 * MASS * RADIUS * RADIUS;
    let check = |time: f64| {
        let (way, rate) = ramp(TORQUE / moment, SPEED, time);
        let state = BodyState { angle: way, angular_velocity: rate, ..BodyState::default() };
        Check { time, states: vec![(0, state)] }
    };
    let wheel = Body::disc("wheel", RADIUS, MASS, DVec2::ZERO, DVec2::ZERO);
    let mut scene = Scene::new("motor_spins_up", "a motor spins a wheel up and holds its speed", vec![wheel]);
    scene.connectors = vec![Connector::Pin(End::world(DVec2::ZERO), End::body(0, DVec2::ZERO))];
    scene.on_joints = vec![(0, OnJoint::motor(SPEED, TORQUE))];
    scene.collisions = false;
    scene.with_checks(0.5, [0.5, 1.5, 2.0, 4.0].map(check).to_vec()).with_reference("closed form", 1e-15)
}

/// Way and speed of what starts from rest, accelerates evenly up to a speed, and keeps it.
fn ramp(acceleration: f64, speed: f64, time: f64) -> (f64, f64) {
    let until = speed / acceleration;
    match time < until {
        true => (0.5 * acceleration * time * time, acceleration * time),
        false => (speed * (time - 0.5 * until), speed),
    }
}

/// A load of 2 kg on a way of slope 4:3, the speed of its motor [m/s], the force of that [N], and the stop [m].
pub(super) fn lift_to_stop() -> Scene {
    const MASS: f64 = 2.0;
    const SPEED: f64 = 1.2;
    const FORCE: f64 = 19.0;
    const STOP: f64 = 1.1;
    let axis = DVec2::new(0.6, 0.8);
    let acceleration = FORCE / MASS - GRAVITY * axis.y;
    let check = |time: f64| {
        let (way, speed) = ramp(acceleration, SPEED, time);
        let (way, speed) = if way < STOP { (way, speed) } else { (STOP, 0.0) };
        let state = BodyState { position: way * axis, velocity: speed * axis, ..BodyState::default() };
        Check { time, states: vec![(0, state)] }
    };
    let load = Body::block("load", DVec2::new(0.2, 0.1), MASS, BodyState::default()).with_elasticity(0.0);
    let about = "a motor pulls a load up a slope, at an even speed, and holds it on a stop";
    let mut scene = Scene::new("lift_to_stop", about, vec![load]);
    scene.connectors = vec![Connector::Slider { body: 0, point: DVec2::ZERO, axis }];
    let limits = Some([-0.5, STOP]);
    scene.on_joints = vec![(0, OnJoint { limits, ..OnJoint::motor(SPEED, FORCE) })];
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    scene.collisions = false;
    let times = [0.5, 1.0, 1.5, 3.0];
    scene.with_checks(0.25, times.map(check).to_vec()).with_reference("closed form", 1e-15)
}

/// An arm of 2 kg and its motor: too weak to hold the arm level, but strong enough to be carried past it by its speed.
struct Arm {
    speed: f64,
    torque: f64,
}

const MASS: f64 = 2.0;
/// Torque of the arm's weight where it is level [N m].
const WEIGHT: f64 = 0.5 * MASS * GRAVITY * LENGTH;
/// Moment of inertia about the pin [kg m^2].
const MOMENT: f64 = MASS * LENGTH * LENGTH / 3.0;

/// The arm is slower than the motor would have it, as fast, or faster.
const SLOWER: usize = 0;
const HELD: usize = 1;
const FASTER: usize = 2;

impl Phased for Arm {
    fn rates(&self, phase: usize, state: &[f64], rates: &mut [f64]) {
        let weight = WEIGHT * state[0].sin();
        let torque = match phase {
            SLOWER => self.torque,
            HELD => weight,
            _ => -self.torque,
        };
        rates.copy_from_slice(&[state[1], (torque - weight) / MOMENT]);
    }

    fn guards(&self, phase: usize, state: &[f64]) -> Vec<f64> {
        let weight = WEIGHT * state[0].sin();
        match phase {
            SLOWER => vec![self.speed - state[1]],
            HELD => vec![self.torque - weight, self.torque + weight],
            _ => vec![state[1] - self.speed],
        }
    }

    fn next(&self, phase: usize, guard: usize, state: &mut [f64]) -> usize {
        match (phase, guard) {
            (HELD, 0) => SLOWER,
            (HELD, _) => FASTER,
            // Nowhere in this scene does it pass through the speed with more than the motor can take.
            _ => {
                state[1] = self.speed;
                HELD
            }
        }
    }
}

pub(super) fn turns_arm() -> Scene {
    let arm = Arm { speed: 2.5, torque: 8.0 };
    let times = [1.0, 2.0, 4.0, 6.0];
    let (states, doubt) = solve(&arm, SLOWER, &[0.0, 0.0], &times, 0.01);
    let at = |state: &[f64]| rod::state([DVec2::ZERO; 2], state[0], state[1]);
    let check = |(&time, state): (&f64, &Vec<f64>)| Check { time, states: vec![(0, at(state))] };
    let checks = times.iter().zip(&states).map(check).collect();
    let about = "a motor turns an arm that is too heavy for it where it is level";
    let bodies = vec![rod::body("arm", MASS, at(&[0.0, 0.0]))];
    let mut scene = Scene::new("motor_turns_arm", about, bodies);
    scene.connectors = vec![Connector::Pin(End::world(DVec2::ZERO), End::body(0, rod::ENDS[0]))];
    scene.on_joints = vec![(0, OnJoint::motor(arm.speed, arm.torque))];
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    scene.collisions = false;
    scene.with_checks(0.5, checks).with_reference(
        "integrated in the arm's angle, order 16, between the motor's events",
        doubt.max(1e-14),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_motor_holds_is_overpowered_and_brakes() {
        let arm = Arm { speed: 2.5, torque: 8.0 };
        let times: Vec<f64> = (1..=60).map(|count| 0.1 * f64::from(count)).collect();
        let (states, _) = solve(&arm, SLOWER, &[0.0, 0.0], &times, 0.01);
        let rates = || states.iter().skip(10).map(|state| state[1]);
        assert!(rates().any(|rate| rate < 1.6) && rates().any(|rate| rate > 3.0));
        assert!(rates().any(|rate| rate == arm.speed) && rates().all(|rate| rate > 0.0));
    }
}
