//! A pendulum whose pin has dry friction: it swings less and less, and stays where its weight pulls less than that.

use super::rod::{self, GRAVITY, LENGTH};
use crate::on_joint::OnJoint;
use crate::reference::phases::{Phased, solve};
use crate::scene::{Check, Connector, End, Scene};
use glam::DVec2;

const MASS: f64 = 1.0;
/// Torque of its weight where it is level [N m].
const WEIGHT: f64 = 0.5 * MASS * GRAVITY * LENGTH;
/// Moment of inertia about the pin [kg m^2].
const MOMENT: f64 = MASS * LENGTH * LENGTH / 3.0;
/// Torque of the friction [N m].
const FRICTION: f64 = 0.6;
/// Angle from the downward vertical at the start [rad].
const START: f64 = 1.5;

const FORWARD: usize = 0;
const BACK: usize = 1;
const STUCK: usize = 2;

struct Pendulum;

impl Phased for Pendulum {
    fn rates(&self, phase: usize, state: &[f64], rates: &mut [f64]) {
        let weight = -WEIGHT * state[0].sin();
        let torque = match phase {
            FORWARD => weight - FRICTION,
            BACK => weight + FRICTION,
            _ => 0.0,
        };
        rates.copy_from_slice(&[state[1], torque / MOMENT]);
    }

    fn guards(&self, phase: usize, state: &[f64]) -> Vec<f64> {
        match phase {
            FORWARD => vec![state[1]],
            BACK => vec![-state[1]],
            _ => Vec::new(),
        }
    }

    fn next(&self, phase: usize, _: usize, state: &mut [f64]) -> usize {
        state[1] = 0.0;
        if (WEIGHT * state[0].sin()).abs() < FRICTION {
            return STUCK;
        }
        if phase == FORWARD { BACK } else { FORWARD }
    }
}

pub(super) fn scene() -> Scene {
    let times = [1.0, 2.0, 4.0, 8.0];
    let (states, doubt) = solve(&Pendulum, BACK, &[START, 0.0], &times, 0.01);
    let at = |state: &[f64]| rod::state([DVec2::ZERO; 2], state[0], state[1]);
    let check = |(&time, state): (&f64, &Vec<f64>)| Check { time, states: vec![(0, at(state))] };
    let checks = times.iter().zip(&states).map(check).collect();
    let about = "a pendulum with dry friction in its pin comes to rest beside its lowest place";
    let bodies = vec![rod::body("rod", MASS, at(&[START, 0.0]))];
    let mut scene = Scene::new("joint_friction_stops", about, bodies);
    scene.connectors = vec![Connector::Pin(End::world(DVec2::ZERO), End::body(0, rod::ENDS[0]))];
    scene.on_joints = vec![(0, OnJoint::friction(FRICTION))];
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    scene.collisions = false;
    scene
        .with_checks(0.5, checks)
        .with_reference("integrated in its angle, order 16, between its turning points", doubt.max(1e-14))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_comes_to_rest_off_its_lowest_place_and_not_at_the_edge_of_what_friction_holds() {
        let (states, _) = solve(&Pendulum, BACK, &[START, 0.0], &[7.0, 8.0], 0.01);
        let pull = (WEIGHT * states[1][0].sin()).abs();
        assert_eq!(states[0], states[1]);
        assert!(pull > 0.1 * FRICTION && pull < 0.9 * FRICTION, "{pull}");
    }
}
