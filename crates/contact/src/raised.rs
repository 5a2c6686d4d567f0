//! Contacts that contradict each other by a little, satisfied as far as rounding of A allows.
//!
//! Contacts that depend on each other up to rounding and contradict each other by 1e-11 of the scale have no
//! solution in modest forces. Whether they have one in large forces is decided by the last digits of A, which
//! are rounding. What is within those digits is the problem with the diagonal of Â raised by δ, a few
//! roundings: Â + δ is positive definite, so that there is one solution, and its forces leave accelerations δ
//! f̂ in the original rows, a backward residual of at most δ. Forces are about the contradiction over δ,
//! hence the bound on contradictions before this is tried. Source: the regularised problem of R. Cottle,
//! J.-S. Pang, R. Stone, "The Linear Complementarity Problem", 1992, 5.6.

use crate::dual_active_set::{Attempt, DualActiveSet, End};
use crate::error::SolveError;
use crate::problem::Problem;
use crate::settings::Contradiction;
use crate::solution::Solution;
use crate::start::Start;

/// Part of the raise that a row's Schur complement may lose to rounding before it counts as dependent.
const LOST: f64 = 0.25;

impl DualActiveSet {
    /// Whether an accepted answer owes its acceptance to a contradiction between contacts, while connectors agree, and
    /// the settings ask for the rows as given.
    pub(crate) fn owes_to_contacts(&self, solution: &Solution) -> bool {
        self.settings.contradiction == Contradiction::SolveExactly
            && self.contacts_contradict
            && !self.shift.connectors
            && !solution.residuals.accepted(&self.settings, 0.0)
    }

    /// Solves the problem with the raised diagonal; the answer must pass the check without allowance.
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
