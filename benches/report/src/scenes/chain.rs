//! A chain of twenty links, hung at one end and let go level.
//!
//! The answer is integrated in the links' angles, its minimal coordinates.

use crate::reference::extrapolation::solve;
use crate::scene::{Body, Check, Connector, End, Scene};
use glam::DVec2;
use halfgap::BodyState;
use std::ops::Range;

const GRAVITY: f64 = 9.81;
/// Steps at which truncation has just gone below rounding, which grows with their number [s].
const STEP: f64 = 1.0 / 512.0;
/// A second run has steps shorter by this: what it differs by is the error.
const SHORTER: f64 = 0.75;

/// A chain of like links of 1 kg: bars of a length and width [m].
pub(super) struct Chain {
    pub(super) links: usize,
    pub(super) length: f64,
    pub(super) width: f64,
}

impl Chain {
    fn moment(&self) -> f64 {
        (self.length * self.length + self.width * self.width) / 12.0
    }

    /// Mass times levers of two links: how strongly the angle of one moves what hangs at the other.
    fn coupling(&self, a: usize, b: usize) -> f64 {
        let below = (self.links - 1 - a.max(b)) as f64;
        let own = if a == b { 0.25 } else { 0.5 };
        self.length * self.length * (below + own)
    }

    /// Rates of angles and angular velocities: `M a = -C w^2 - G`, with `M` by its Cholesky factor.
    fn rates(&self, state: &[f64], rates: &mut [f64]) {
        let count = self.links;
        let (angles, turns) = state.split_at(count);
        let (angle_rates, accelerations) = rates.split_at_mut(count);
        angle_rates.copy_from_slice(turns);
        let mut matrix = vec![0.0; count * count];
        for row in 0..count {
            let hanging = (count - 1 - row) as f64 + 0.5;
            let mut force = -GRAVITY * self.length * hanging * angles[row].cos();
            for column in 0..count {
                let (sin, cos) = (angles[row] - angles[column]).sin_cos();
                let coupling = self.coupling(row, column);
                matrix[row * count + column] = coupling * cos;
                force -= coupling * sin * turns[column] * turns[column];
            }
            matrix[row * count + row] += self.moment();
            accelerations[row] = force;
        }
        solve_positive(&mut matrix, accelerations);
    }

    /// States of the links.
    pub(super) fn states(&self, state: &[f64]) -> Vec<(usize, BodyState)> {
        let (mut end, mut speed) = (DVec2::ZERO, DVec2::ZERO);
        let mut states = Vec::with_capacity(self.links);
        for link in 0..self.links {
            let (angle, turn) = (state[link], state[self.links + link]);
            let half = 0.5 * self.length * DVec2::from_angle(angle);
            let half_speed = turn * half.perp();
            let pose = BodyState {
                position: end + half,
                angle,
                velocity: speed + half_speed,
                angular_velocity: turn,
            };
            states.push((link, pose));
            (end, speed) = (end + 2.0 * half, speed + 2.0 * half_speed);
        }
        states
    }

    /// Known states at times, from rest at given angles, and how far their places may be off [m].
    pub(super) fn checks(&self, angles: &[f64], times: &[f64], step: f64) -> (Vec<Check>, f64) {
        let mut start = angles.to_vec();
        start.resize(2 * self.links, 0.0);
        let run = |step: f64| solve(&|state, rates| self.rates(state, rates), &start, times, step);
        let (states, others) = (run(step), run(SHORTER * step));
        let mut error = 0.0_f64;
        let mut checks = Vec::with_capacity(times.len());
        for ((&time, state), other) in times.iter().zip(&states).zip(&others) {
            let check = Check { time, states: self.states(state) };
            for ((_, a), (_, b)) in check.states.iter().zip(&self.states(other)) {
                error = error.max((a.position - b.position).length());
            }
            checks.push(check);
        }
        (checks, error)
    }
}

/// Solves `A x = b` in place for a symmetric positive definite matrix by rows.
fn solve_positive(matrix: &mut [f64], right: &mut [f64]) {
    let count = right.len();
    let dot = |matrix: &[f64], a: usize, b: usize, columns: Range<usize>| -> f64 {
        columns.map(|column| matrix[a * count + column] * matrix[b * count + column]).sum()
    };
    for row in 0..count {
        for column in 0..row {
            let rest = matrix[row * count + column] - dot(matrix, row, column, 0..column);
            matrix[row * count + column] = rest / matrix[column * count + column];
        }
        let rest = matrix[row * count + row] - dot(matrix, row, row, 0..row);
        matrix[row * count + row] = rest.sqrt();
    }
    for row in 0..count {
        let known: f64 = (0..row).map(|column| matrix[row * count + column] * right[column]).sum();
        right[row] = (right[row] - known) / matrix[row * count + row];
    }
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|below| matrix[below * count + row] * right[below]).sum();
        right[row] = (right[row] - known) / matrix[row * count + row];
    }
}

pub(super) fn scene() -> Scene {
    let chain = Chain { links: 20, length: 0.2, width: 0.05 };
    let (checks, error) = chain.checks(&vec![0.0; chain.links], &[0.5, 1.0, 1.5, 2.0], STEP);
    let body = |link: usize| {
        let position = DVec2::new(chain.length * (link as f64 + 0.5), 0.0);
        let start = BodyState { position, ..BodyState::default() };
        Body::block(&format!("link {link}"), DVec2::new(chain.length, chain.width), 1.0, start)
            .with_elasticity(0.0)
    };
    let end = |link: usize, side: f64| End::body(link, DVec2::new(side * 0.5 * chain.length, 0.0));
    let pin = |link: usize| {
        let above = if link == 0 { End::world(DVec2::ZERO) } else { end(link - 1, 1.0) };
        Connector::Pin(above, end(link, -1.0))
    };
    let bodies = (0..chain.links).map(body).collect();
    let mut scene =
        Scene::new("falling_chain", "a chain of 20 links, hung at one end and let go level", bodies);
    scene.connectors = (0..chain.links).map(pin).collect();
    scene.gravity = DVec2::new(0.0, -GRAVITY);
    scene.collisions = false;
    scene.with_checks(0.5, checks).with_reference("integrated in the links' angles, order 16", error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_links_are_the_double_pendulum_of_the_tests() {
        let known = super::super::exact::read("double_pendulum", 0.5);
        let angles: Vec<f64> = known.bodies.iter().map(|body| body.start.angle).collect();
        let times: Vec<f64> = known.checks.iter().map(|check| check.time).collect();
        let (checks, error) = Chain { links: 2, length: 1.0, width: 0.1 }.checks(&angles, &times, 1.0 / 64.0);
        assert!(error < 1e-12, "{error:e}");
        for (check, known_check) in checks.iter().zip(&known.checks) {
            let states: Vec<_> = check.states.iter().map(|&(_, state)| state).collect();
            let difference = known.error(known_check, &states);
            assert!(difference < 1e-12, "at {} s: {difference:e}", check.time);
        }
    }
}
