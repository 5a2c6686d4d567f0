//! Tests common to the laws: forces are gradients of the potential, forces and torques of a pair cancel.

use super::{ForceLaw, Moving, Snapshot, Wrench, Wrenches};
use glam::DVec2;
use halfgap_collision::BodyState;

/// Step of finite differences [m, rad].
const STEP: f64 = 1e-4;
/// Least size [N] of the largest force in a test.
const NOTICEABLE: f64 = 1e-3;
/// Error allowed in a finite difference, as a fraction of the largest force [-, m for torques].
const DIFFERENCE_ERROR: f64 = 1e-6;
/// Rounding allowed in a sum that is zero, as a fraction of the largest force [-, m for torques].
const SUM_ROUNDING: f64 = 1e-14;

pub(super) type Pushed = Wrench;

/// Three bodies in no special position.
pub(super) fn states() -> [BodyState; 3] {
    let state = |x, y, angle, vx, vy, angular_velocity| BodyState {
        position: DVec2::new(x, y),
        angle,
        velocity: DVec2::new(vx, vy),
        angular_velocity,
    };
    [
        state(0.3, -1.1, 0.4, 0.7, 0.2, -1.3),
        state(2.1, 0.9, -2.0, -0.4, 1.6, 0.8),
        state(-1.7, 1.4, 5.0, 0.0, 0.0, 0.0),
    ]
}

pub(super) fn wrenches(law: &dyn ForceLaw, states: &[BodyState; 3]) -> [Pushed; 3] {
    wrenches_at(law, states, 0.0)
}

pub(super) fn wrenches_at(law: &dyn ForceLaw, states: &[BodyState; 3], time: f64) -> [Pushed; 3] {
    let moving = states.map(|state| Moving::from(&state));
    let mut sums = [Wrench::default(); 3];
    law.apply(&Snapshot::new(time, &moving), &mut Wrenches::new(&mut sums));
    sums
}

/// Power of the law's forces [W].
pub(super) fn power(law: &dyn ForceLaw, states: &[BodyState; 3]) -> f64 {
    let power = |(sum, state): (Pushed, &BodyState)| {
        sum.force.dot(state.velocity) + sum.torque * state.angular_velocity
    };
    wrenches(law, states).into_iter().zip(states).map(power).sum()
}

/// Compares forces and torques on the bodies that the law lets move with central differences of its potential.
///
/// A pair of fixed bodies has no potential, so the difference is right for them too where the law names them movable.
pub(super) fn assert_gradient(law: &dyn ForceLaw, states: &[BodyState; 3]) {
    let potential = |states: &[BodyState; 3]| {
        let moving = states.map(|state| Moving::from(&state));
        law.potential(&Snapshot::new(0.0, &moving)).expect("the law has a potential")
    };
    let sums = wrenches(law, states);
    let size = sums.iter().map(|sum| sum.force.length()).fold(0.0, f64::max);
    assert!(size > NOTICEABLE, "there is a force to compare");
    for (body, sum) in sums.iter().enumerate() {
        let slope = |change: fn(&mut BodyState, f64)| {
            let at = |step: f64| {
                let mut moved = *states;
                change(&mut moved[body], step);
                potential(&moved)
            };
            (at(STEP) - at(-STEP)) / (2.0 * STEP)
        };
        let expected = [
            slope(|state, step| state.position.x += step),
            slope(|state, step| state.position.y += step),
            slope(|state, step| state.angle += step),
        ];
        for (slope, push) in expected.into_iter().zip([sum.force.x, sum.force.y, sum.torque]) {
            assert!(
                (slope + push).abs() < DIFFERENCE_ERROR * size,
                "body {body}: slope {slope}, push {push}"
            );
        }
    }
}

/// Checks that the sums of the forces, and of their torques about the world's origin, are zero.
pub(super) fn assert_pushes_cancel(law: &dyn ForceLaw, states: &[BodyState; 3]) {
    let sums = wrenches(law, states);
    let size = sums.iter().map(|sum| sum.force.length()).fold(0.0, f64::max);
    assert!(size > NOTICEABLE, "there are forces that could cancel");
    let force: DVec2 = sums.iter().map(|sum| sum.force).sum();
    let about_origin = |(sum, state): (&Pushed, &BodyState)| state.position.perp_dot(sum.force) + sum.torque;
    let torque: f64 = sums.iter().zip(states).map(about_origin).sum();
    assert!(force.length() < SUM_ROUNDING * size, "{force}");
    assert!(torque.abs() < SUM_ROUNDING * size, "{torque}");
}
