//! The numbers every solver decides by, in one place.

use crate::error::{SettingsError, SolveError};
use crate::matrix::Matrix;
use crate::problem::Problem;

/// Part of its square that a contact must have to itself to be closed with many others: if rounding has a say in the
/// forces, which of them are wrong means nothing. Pivots close what has less.
pub(crate) const WELL: f64 = 1e-7;

/// Part of its square below which what earlier rows leave of a row may be no more than rounding, enlarged by
/// rows of which as little as passes for independent was left: it is measured with care.
pub(crate) const DOUBTFUL: f64 = 1e-4;

/// Leakage of a certificate whose rows depend on each other to the last digit.
const SAME: f64 = 2.0 * f64::EPSILON;

/// Thresholds and caps of the solvers. Each threshold is relative, so that none depends on the units of a problem.
///
/// Rows are compared after scaling: with `s_i = sqrt(A_ii)` (1 where `A_ii = 0`) the scaled acceleration is
/// `a_i / s_i`, the scaled force `s_i f_i`, and the *scale* of a problem is `max |b_i / s_i|`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Largest natural residual, in units of the scale, of an accepted answer.
    pub natural_residual: f64,
    /// Growth from which an answer may be judged by its backward residual instead: there rounding alone, times the
    /// growth, exceeds `natural_residual`.
    pub least_growth: f64,
    /// Growth from which the backward residual no longer counts, for the forces mean nothing any more: such an answer is
    /// accepted only by its natural residual. A proof that every solution has that growth leaves no doubt.
    pub greatest_growth: f64,
    /// Largest backward residual of an accepted answer of great growth.
    pub backward_residual: f64,
    /// A row depends on the closed rows when what they leave of its squared length is at most this part of it.
    ///
    /// Larger treats nearly redundant contacts as redundant, smaller lets forces grow by up to its reciprocal.
    pub dependence: f64,
    /// The same for a second attempt, where rows taken for dependent contradict each other and may only be nearly
    /// dependent: a few roundings of 1.
    pub least_dependence: f64,
    /// What the scaled diagonal of `A`, which is 1, is raised by where contacts contradict each other and are
    /// to be solved as given: a few roundings, and the backward residual of the answer. Forces are about the
    /// contradiction over it.
    pub raise: f64,
    /// Contradiction between dependent rows, in units of the scale, up to which they are solved in the least-squares
    /// sense; beyond it the problem is infeasible.
    pub inconsistency: f64,
    /// An acceleration within this part of the scale of zero counts as zero while the solver looks for a next row.
    pub open_tolerance: f64,
    /// A row whose offset b is below this part of the scale starts closed: contacts between bodies at rest on
    /// each other have b = 0 but for small relative motions.
    pub start_closed: f64,
    /// As `open_tolerance`, in units of the largest sum of terms that an acceleration is made of: a few roundings.
    pub rounding: f64,
    /// Cap on pivots, per row of the problem.
    pub pivots_per_row: usize,
    /// Cap on rounds in which the active-set method exchanges all wrong rows at once.
    pub block_rounds: usize,
    /// How many such rounds may pass without fewer rows being wrong.
    pub block_tries: usize,
    /// Rows from which the automatic choice hands very redundant problems to the proximal method.
    pub hand_over_rows: usize,
    /// Rows from which it hands problems that take many pivots to the same, where forces may be any.
    pub pivoting_rows: usize,
    /// Cap on steps of iterative refinement of the final forces.
    pub refinements: usize,
    /// Cap on outer (multiplier) iterations of the proximal method.
    pub outer_iterations: usize,
    /// Cap on Newton steps of the proximal method, in all.
    pub newton_steps: usize,
    /// Tolerance asked of the interior-point method, on its gap and feasibility, in units of the scale.
    pub interior_point: f64,
    /// Proximal term the least-norm choice of forces is made with, in units of the scaled diagonal of `A`, which is 1.
    pub least_norm_term: f64,
    /// How forces are chosen where the problem leaves a choice.
    pub selection: ForceSelection,
    /// What to do first about contacts that contradict each other by a little.
    pub contradiction: Contradiction,
}

/// What to do first about unilateral rows that contradict each other by less than [`Settings::inconsistency`].
///
/// Nearly redundant contacts can be satisfied as given only by forces of 1e5 times the load and more, which help no
/// one; within rounding they can be satisfied by forces of the size of the load.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Contradiction {
    /// Solve the rows as given, up to rounding of A, if the residual rules allow the forces that takes; otherwise by
    /// least squares.
    #[default]
    SolveExactly,
    /// Solve by least squares and report the inconsistency; as given only if the contradiction is larger.
    LeastSquares,
}

/// Which forces to report when redundant contacts leave a choice; the accelerations do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ForceSelection {
    /// Whatever is found soonest: where many rows are redundant, all of them may carry force.
    #[default]
    Quickest,
    /// Whatever the pivoting ends at, however long that takes: few rows carry force. Only where so many rows
    /// are redundant that the choice among them is arbitrary, all of them may. For those who go on with the
    /// rows that carry force, as an integrator does: of rows that share, none that holds something is idle.
    Pivoted,
    /// Those of rows that do not depend on each other, as the pivoting ends at, or as others are moved to. Some of
    /// these rows may have no force, by chance, as the second corner of a block that is balanced on the first.
    Vertex,
    /// The least sum of squares of the scaled forces `s_i f_i` among those that hold the same rows at rest:
    /// symmetric scenes show symmetric forces. Where masses are thousands of times apart, which rows are at
    /// rest is known to rounding only, and others may hold them with less.
    LeastNorm,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            natural_residual: 1e-12,
            least_growth: 1e3,
            greatest_growth: 1e12,
            backward_residual: 1e-14,
            dependence: 1e-11,
            least_dependence: 1e-15,
            raise: 4e-15,
            inconsistency: 1e-8,
            open_tolerance: 1e-13,
            start_closed: 1e-2,
            rounding: 1e-15,
            pivots_per_row: 20,
            block_rounds: 12,
            block_tries: 0,
            hand_over_rows: 150,
            pivoting_rows: 80,
            refinements: 3,
            outer_iterations: 60,
            newton_steps: 3000,
            interior_point: 1e-12,
            least_norm_term: 1e-5,
            selection: ForceSelection::Quickest,
            contradiction: Contradiction::SolveExactly,
        }
    }
}

impl Settings {
    /// Checks every number.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] names the first field that is not a positive, finite number.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let numbers = [
            ("natural_residual", self.natural_residual),
            ("least_growth", self.least_growth),
            ("greatest_growth", self.greatest_growth),
            ("backward_residual", self.backward_residual),
            ("dependence", self.dependence),
            ("least_dependence", self.least_dependence),
            ("raise", self.raise),
            ("inconsistency", self.inconsistency),
            ("open_tolerance", self.open_tolerance),
            ("start_closed", self.start_closed),
            ("rounding", self.rounding),
            ("interior_point", self.interior_point),
            ("least_norm_term", self.least_norm_term),
        ];
        match numbers.iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
            Some(&(field, value)) => Err(SettingsError { field, value }),
            None => Ok(()),
        }
    }

    /// Whether an error is a certificate that leaves no doubt: every solution would have forces beyond all
    /// bounds, or it is bilateral rows, dependent to the last digit, that contradict each other by more than
    /// may be settled.
    pub(crate) fn is_proven(&self, error: &SolveError, problem: &Problem) -> bool {
        let SolveError::Infeasible(proof) = error else { return false };
        let is_bilateral = || proof.direction.iter().zip(problem.bilateral()).all(|(z, is)| *is || *z == 0.0);
        let is_exact = proof.leakage <= SAME
            && proof.contradiction > self.inconsistency
            && cancels(problem, &proof.direction);
        proof.least_growth() >= self.greatest_growth || (is_exact && is_bilateral())
    }

    /// Cap on pivots for a problem of `rows` rows: small problems get a little more per row.
    pub(crate) fn pivot_cap(&self, rows: usize) -> usize {
        self.pivots_per_row.saturating_mul(rows + 5)
    }
}

/// True if a combination of rows moves no body, to the last digit; where bodies are not known, that is for A to say. A z
/// is of second order in what it moves, and may be rounding where that is not.
fn cancels(problem: &Problem, direction: &[f64]) -> bool {
    let Matrix::Bodies(bodies) = &problem.matrix else { return true };
    let mut moved = vec![[0.0; 2]; bodies.inverse_mass.len()];
    for (i, &z) in direction.iter().enumerate().filter(|(_, z)| **z != 0.0) {
        let (columns, values) = bodies.rows.row(i);
        for (&k, &v) in columns.iter().zip(values) {
            let [sum, terms] = &mut moved[k];
            (*sum, *terms) = (*sum + z * v, *terms + (z * v).abs());
        }
    }
    let movable = moved.iter().zip(&bodies.inverse_mass).filter(|(_, mass)| **mass > 0.0);
    movable.into_iter().all(|([sum, terms], _)| sum.abs() <= SAME * terms)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid() {
        assert_eq!(Settings::default().validate(), Ok(()));
    }

    #[test]
    fn a_bad_number_is_named() {
        let settings = Settings { dependence: f64::NAN, ..Settings::default() };
        assert_eq!(settings.validate().map_err(|e| e.field), Err("dependence"));
    }
}
