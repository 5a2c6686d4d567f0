//! Joints that meet their limits, without bounce: a pendulum between two, and a leg whose knee bends one way only.

use super::rod::{self, GRAVITY, LENGTH};
use crate::on_joint::OnJoint;
use crate::reference::phases::{Phased, solve};
use crate::scene::{Check, Connector, End, Scene};
use glam::DVec2;
use halfgap::BodyState;
use std::f64::consts::FRAC_PI_2;

const MASS: f64 = 1.0;

/// A pendulum between two angles from the downward vertical [rad].
struct Pendulum {
    limits: [f64; 2],
}

impl Phased for Pendulum {
    fn rates(&self, _: usize, state: &[f64], rates: &mut [f64]) {
        rates.copy_from_slice(&[state[1], -1.5 * GRAVITY / LENGTH * state[0].sin()]);
    }

    fn guards(&self, _: usize, state: &[f64]) -> Vec<f64> {
        vec![state[0] - self.limits[0], self.limits[1] - state[0]]
    }

    fn next(&self, phase: usize, guard: usize, state: &mut [f64]) -> usize {
        // Its weight takes it away from either limit at once.
        state.copy_from_slice(&[self.limits[guard], 0.0]);
        phase
    }
}

pub(super) fn pendulum() -> Scene {
    let pendulum = Pendulum { limits: [-0.4, 0.9] };
    let start = [0.0, 6.0];
    let times = [0.25, 0.5, 1.0, 1.5];
    let (states, doubt) = solve(&pendulum, 0, &start, &times, 0.01);
    let at = |state: &[f64]| rod::state([DVec2::ZERO; 2], state[0], state[1]);
    let check = |(&time, state): (&f64, &Vec<f64>)| Check { time, states: vec![(0, at(state))] };
    let checks = times.iter().zip(&states).map(check).collect();
    let about = "a pendulum between two limits of its pin, without bounce";
    let mut scene = Scene::new("pendulum_on_limits", about, vec![rod::body("rod", MASS, at(&start))]);
    scene.connectors = vec![Connector::Pin(End::world(DVec2::ZERO), End::body(0, rod::ENDS[0]))];
    let [lower, upper] = pendulum.limits.map(|limit| limit - FRAC_PI_2);
    scene.on_joints = vec![(0, OnJoint::limits(lower, upper))];
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    scene.collisions = false;
    scene
        .with_checks(0.25, checks)
        .with_reference("integrated in its angle, order 16, between the limits", doubt.max(1e-14))
}

/// A thigh and a shank: angles of both from the downward vertical, and their rates. The shank's angle is not below that
/// of the thigh.
struct Leg;

const BENT: usize = 0;
const STRAIGHT: usize = 1;

impl Leg {
    /// The matrix of inertia, over mass and squared length, and the forces of gravity and rates in the same measure.
    fn terms(state: &[f64]) -> ([f64; 3], [f64; 2]) {
        let [thigh, shank, thigh_rate, shank_rate] = [state[0], state[1], state[2], state[3]];
        let (sin, cos) = (shank - thigh).sin_cos();
        let inertia = [4.0 / 3.0, 0.5 * cos, 1.0 / 3.0];
        let forces = [
            0.5 * sin * shank_rate * shank_rate - 1.5 * GRAVITY / LENGTH * thigh.sin(),
            -0.5 * sin * thigh_rate * thigh_rate - 0.5 * GRAVITY / LENGTH * shank.sin(),
        ];
        (inertia, forces)
    }

    /// Acceleration of both when they turn as one.
    fn as_one(inertia: [f64; 3], forces: [f64; 2]) -> f64 {
        (forces[0] + forces[1]) / (inertia[0] + 2.0 * inertia[1] + inertia[2])
    }
}

impl Phased for Leg {
    fn rates(&self, phase: usize, state: &[f64], rates: &mut [f64]) {
        let (inertia, forces) = Self::terms(state);
        let [a, b, c] = inertia;
        let [thigh, shank] = match phase {
            BENT => {
                let determinant = a * c - b * b;
                [(c * forces[0] - b * forces[1]) / determinant, (a * forces[1] - b * forces[0]) / determinant]
            }
            _ => [Self::as_one(inertia, forces); 2],
        };
        rates.copy_from_slice(&[state[2], state[3], thigh, shank]);
    }

    fn guards(&self, phase: usize, state: &[f64]) -> Vec<f64> {
        let (inertia, forces) = Self::terms(state);
        match phase {
            BENT => vec![state[1] - state[0]],
            // The knee pushes the shank on; it cannot hold it back.
            _ => vec![(inertia[1] + inertia[2]) * Self::as_one(inertia, forces) - forces[1]],
        }
    }

    fn next(&self, phase: usize, _: usize, state: &mut [f64]) -> usize {
        if phase == STRAIGHT {
            return BENT;
        }
        // What both have together is kept.
        let ([a, b, c], _) = Self::terms(state);
        let rate = ((a + b) * state[2] + (b + c) * state[3]) / (a + 2.0 * b + c);
        state[1] = state[0];
        (state[2], state[3]) = (rate, rate);
        STRAIGHT
    }
}

fn leg_states(state: &[f64]) -> [BodyState; 2] {
    let hip = [DVec2::ZERO; 2];
    let knee = rod::tip(hip, state[0], state[2]);
    [rod::state(hip, state[0], state[2]), rod::state(knee, state[1], state[3])]
}

/// Angles of thigh and shank at the start, and their rates.
const LEG_START: [f64; 4] = [1.3, 1.9, 0.0, 0.0];

pub(super) fn knee() -> Scene {
    let times = [0.5, 1.0, 2.0, 3.0];
    let (states, doubt) = solve(&Leg, BENT, &LEG_START, &times, 0.01);
    let check = |(&time, state): (&f64, &Vec<f64>)| Check {
        time,
        states: leg_states(state).into_iter().enumerate().collect(),
    };
    let checks = times.iter().zip(&states).map(check).collect();
    let [thigh, shank] = leg_states(&LEG_START);
    let bodies = vec![rod::body("thigh", MASS, thigh), rod::body("shank", MASS, shank)];
    let about = "a leg swings, and its knee does not bend forward: it straightens with a blow, stays so, and bends again";
    let mut scene = Scene::new("knee_on_limit", about, bodies);
    scene.connectors = vec![
        Connector::Pin(End::world(DVec2::ZERO), End::body(0, rod::ENDS[0])),
        Connector::Pin(End::body(0, rod::ENDS[1]), End::body(1, rod::ENDS[0])),
    ];
    scene.on_joints = vec![(1, OnJoint::limits(0.0, 2.5))];
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    scene.collisions = false;
    scene
        .with_checks(0.5, checks)
        .with_reference("integrated in the angles, order 16, between the knee's events", doubt.max(1e-14))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_knee_is_bent_then_straight_then_bent_and_stays_below_its_other_limit() {
        let times: Vec<f64> = (0..=300).map(|count| 0.01 * f64::from(count)).collect();
        let (states, _) = solve(&Leg, BENT, &LEG_START, &times, 0.01);
        let bends: Vec<f64> = states.iter().map(|state| state[1] - state[0]).collect();
        let is_straight: Vec<bool> = bends.iter().map(|&bend| bend < 1e-12).collect();
        let changes = is_straight.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert_eq!(changes, 2);
        assert!(bends.iter().all(|&bend| (-1e-9..2.4).contains(&bend)), "{bends:?}");
    }

    #[test]
    fn a_leg_whose_knee_never_meets_its_limit_keeps_its_energy() {
        let energy = |state: &[f64]| {
            let ([a, b, c], _) = Leg::terms(state);
            let kinetic = 0.5 * (a * state[2] * state[2] + c * state[3] * state[3]) + b * state[2] * state[3];
            kinetic - GRAVITY / LENGTH * (1.5 * state[0].cos() + 0.5 * state[1].cos())
        };
        let (states, doubt) = solve(&Leg, BENT, &LEG_START, &[0.2], 0.01);
        assert!((energy(&states[0]) - energy(&LEG_START)).abs() < 1e-12 && doubt < 1e-12, "{doubt}");
    }
}
