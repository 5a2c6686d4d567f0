//! The least-norm selection among the forces that redundant contacts leave open.
//!
//! The proximal point method from zero forces: R. T. Rockafellar, "Monotone operators and the proximal point
//! algorithm", SIAM Journal on Control and Optimization 14, 1976. Its iterates have no component in the null space of
//! the closed rows, so it ends at the forces of least norm among those with these rows closed, up to an error of the
//! size of the proximal term.

use crate::dual_active_set::{Attempt, DualActiveSet, End};
use crate::problem::Problem;
use crate::solution::Solution;

impl DualActiveSet {
    /// Moves the forces of an accepted answer to those of least norm: proximal point iterations from zero forces, each
    /// a problem with a positive definite matrix Â + ε. Keeps the answer if they do not pass the check.
    pub(crate) fn select_least_norm(&mut self, problem: &Problem, solution: &mut Solution, attempt: Attempt) {
        let limit = self.noise();
        for (row, start) in self.start.iter_mut().enumerate() {
            let at_rest = self.closed.acceleration[row] <= limit && self.closed.system.movable[row];
            *start = problem.bilateral[row] || at_rest;
        }
        let epsilon = self.settings.least_norm_term;
        self.closed.proximal = epsilon;
        self.closed.force.fill(0.0);
        self.closed.kept = 0;
        self.closed.open_all();
        let offset = self.closed.system.b.clone();
        let mut center = vec![0.0; problem.len()];
        for _ in 0..self.settings.outer_iterations {
            for ((b, offset), f) in self.closed.system.b.iter_mut().zip(&offset).zip(&center) {
                *b = offset - epsilon * f;
            }
            self.exchange_blocks();
            self.make_forces_admissible();
            if !matches!(self.pivot(problem, attempt), End::Done) {
                return;
            }
            let moved =
                center.iter().zip(&self.closed.force).fold(0.0, |m: f64, (c, f)| m.max((c - f).abs()));
            center.copy_from_slice(&self.closed.force);
            if epsilon * moved <= self.settings.open_tolerance * self.closed.system.scale {
                break;
            }
            for (row, start) in self.start.iter_mut().enumerate() {
                *start = self.closed.is_closed(row);
            }
        }
        let mut selected = solution.clone();
        selected.active.clear();
        if self.finish(problem, &mut selected, End::Done).is_ok() {
            *solution = selected;
        }
    }
}
