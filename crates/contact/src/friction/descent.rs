//! Newton's method with a line search on the proximal form of a problem with friction, in the space of the columns.
//!
//! With forces near û sought as u = P(û - a/ε), where P cuts each force to its bounds, the motion v solves
//!
//! ```text
//! F(v) = v - Σ_j d_j P_j(û - (c_j v + b_j)/ε) = 0.
//! ```
//!
//! F is piecewise linear, with the matrix of `equations` over ε as its derivative. Full steps cycle; steps that reduce |F|
//! do not, and full ones end at the exact solution of a piece. An ε of 1 makes every problem as tame as its load. Where
//! û is replaced by u and ε reduced, round by round, the forces come to those of the problem; where a round fails, ε is
//! raised again. Sources: P. Alart, A. Curnier, "A mixed formulation for frictional contact problems prone to Newton
//! like solution methods", CMAME 92, 1991; R. T. Rockafellar, "Monotone operators and the proximal point algorithm", SIAM
//! J. Control 14, 1976; J.-S. Pang, "Newton's method for B-differentiable equations", Math. Oper. Res. 15, 1990.

use super::equations::Equations;
use super::mode::{self, Mode};
use super::scaled_rows::ScaledRows;

/// Cap on Newton steps of one round; where it ends at all, thirty do.
const STEPS: usize = 100;
/// Share [-] of a step by which |F| must fall at least: L. Armijo, Pacific J. Math. 16, 1966.
const ARMIJO: f64 = 1e-4;
/// Least share of a step [-], and the number of steps so short that a round may have: the way out of a kink is short.
const SHORT: f64 = 1e-4;
const SHORT_STEPS: usize = 3;

/// The motion of a round, and what belongs to it.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Descent {
    modes: Vec<Mode>,
    /// The modes of the step before.
    last: Vec<Mode>,
    force: Vec<f64>,
    wanted: Vec<f64>,
    motion: Vec<f64>,
    /// The motion before the step.
    before: Vec<f64>,
    /// F, and the step.
    imbalance: Vec<f64>,
    step: Vec<f64>,
}

impl Descent {
    /// Replaces the forces `center` by those of their proximal form. False, with `center` as it was, if |F| does not fall
    /// to `enough`.
    pub(super) fn run(
        &mut self,
        rows: &ScaledRows,
        equations: &mut Equations,
        center: &mut Vec<f64>,
        [epsilon, enough]: [f64; 2],
        iterations: &mut usize,
    ) -> bool {
        self.motion.clear();
        self.motion.resize(rows.first.len(), 0.0);
        for (row, &force) in center.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            rows.directions().add_to(row, force, &mut self.motion);
        }
        let mut size = self.find_imbalance(rows, center, epsilon);
        let (mut short, mut share) = (0, 0.0);
        for _ in 0..STEPS {
            if size <= enough {
                std::mem::swap(center, &mut self.force);
                return true;
            }
            *iterations += 1;
            mode::of_forces(rows, &self.wanted, &mut self.modes);
            // A full step within one piece ends at its solution, up to rounding.
            if share == 1.0 && self.modes == self.last {
                std::mem::swap(center, &mut self.force);
                return true;
            }
            self.last.clone_from(&self.modes);
            if !equations.factorise(rows, &self.modes, epsilon, |_, _| {}) {
                return false;
            }
            self.step.clear();
            self.step.extend(self.imbalance.iter().map(|f| -epsilon * f));
            equations.solve(&mut self.step);
            (share, size) = self.search(rows, center, epsilon, size);
            short += usize::from(share < SHORT);
            if short > SHORT_STEPS {
                return false;
            }
        }
        false
    }

    /// Goes along the step until |F| has fallen; returns the share of the step and |F|.
    fn search(&mut self, rows: &ScaledRows, center: &[f64], epsilon: f64, size: f64) -> (f64, f64) {
        self.before.clone_from(&self.motion);
        let mut share = 1.0;
        loop {
            self.motion.clone_from(&self.before);
            self.motion.iter_mut().zip(&self.step).for_each(|(v, step)| *v += share * step);
            let now = self.find_imbalance(rows, center, epsilon);
            if now <= (1.0 - ARMIJO * share) * size || share < SHORT {
                return (share, now);
            }
            share *= 0.5;
        }
    }

    /// Sets F and the forces at the present motion. Returns |F|.
    fn find_imbalance(&mut self, rows: &ScaledRows, center: &[f64], epsilon: f64) -> f64 {
        self.wanted.clear();
        self.wanted.extend((0..rows.len()).map(|row| {
            let acceleration = rows.offset[row] + rows.measured().times(row, &self.motion);
            center[row] - acceleration / epsilon
        }));
        self.force.clear();
        self.imbalance.clone_from(&self.motion);
        for row in 0..rows.len() {
            let force = mode::cut(rows, row, &self.wanted);
            if force != 0.0 {
                rows.directions().add_to(row, -force, &mut self.imbalance);
            }
            self.force.push(force);
        }
        self.imbalance.iter().map(|f| f * f).sum::<f64>().sqrt()
    }
}
