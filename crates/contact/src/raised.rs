//! Contacts that contradict each other slightly, satisfied as far as rounding of A allows.
//!
//! Contacts that depend on each other up to rounding and contradict each other by 1e-11 of the scale have no solution
//! with modest forces. The last digits of A, which are rounding, decide whether they have one with large forces. Within
//! those digits lies the problem with the diagonal of Â raised by δ, a few roundings. Â + δ is positive definite, so
//! that there is exactly one solution; its forces leave accelerations δ f̂ in the original rows, a backward residual of
//! at most δ. The forces are about the contradiction divided by δ, so contradictions are bounded before this is tried.
//! Source: the regularised problem of R. Cottle, J.-S. Pang, R. Stone, "The Linear Complementarity Problem", 1992, 5.6.

use crate::dual_active_set::{Attempt, DualActiveSet, End};
use crate::error::SolveError;
use crate::problem::Problem;
use crate::settings::Contradiction;
use crate::solution::Solution;
use crate::start::Start;

/// Fraction of the raise: a Schur complement up to it counts as dependent, as rounding may have taken the rest.
const LOST: f64 = 0.25;

impl DualActiveSet {
    /// Whether an answer was accepted only with the allowance for contradictions, these are between contacts alone, and
    /// the settings ask for the rows as given.
    pub(crate) fn owes_to_contacts(&self, solution: &Solution) -> bool {
        self.settings.contradiction == Contradiction::SolveExactly
            && self.contacts_contradict
            && !self.shift.connectors
            && !solution.residuals.accepted(&self.settings, 0.0)
    }

    /// Solves the problem with the raised diagonal. The answer must pass the check of the original problem without
    /// allowance.
    pub(crate) fn raise(
        &mut self,
        problem: &Problem,
        warm: Start<'_>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        let raise = self.settings.raise;
        let attempt = Attempt {
            dependence: LOST * raise,
            doubts: false,
            contradiction: self.settings.natural_residual / 2.0,
            ..self.attempts().first
        };
        self.prepare(problem, warm, solution, attempt);
        self.closed.proximal = raise;
        let end = match self.find_start(problem) {
            Some(certificate) => End::Infeasible(certificate),
            None => {
                self.make_forces_admissible();
                self.pivot(problem, attempt)
            }
        };
        self.finish(problem, solution, end)
    }
}
