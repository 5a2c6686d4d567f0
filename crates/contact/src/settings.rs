//! Thresholds and caps of all solvers, in one place.

use crate::error::{SettingsError, SolveError};
use crate::matrix::Matrix;
use crate::problem::Problem;

/// Fraction of a contact's square A_ii that the other closed rows must leave of it so that it can be closed together
/// with many others. With less, rounding decides the signs of forces, and these tell nothing about which rows are
/// wrong. Contacts with less are closed by pivots.
pub(crate) const WELL: f64 = 1e-7;

/// Fraction of a row's square A_ii: if earlier rows leave less of it, that remainder may be rounding, enlarged by
/// earlier rows that are barely independent. It is then compared with its own rounding, or computed anew from the row
/// itself.
pub(crate) const DOUBTFUL: f64 = 1e-4;
/// Fraction of a row's square that earlier rows leave, up to which forces are refined [-]: as many digits are lost, and those of
/// several rows add up. In a stack whose masses differ by 1e6 the fractions are 3e-2 or less, and without refinement its lightest
/// block creeps; among equal bodies they are larger, and refinement would take a tenth of the time for nothing.
pub(crate) const DELICATE: f64 = 0.1;

/// Largest leakage [-] of a certificate whose rows depend on each other to the last digit, and largest sum, as a
/// fraction of the sum of its absolute terms, that counts as cancelled to the last digit.
const SAME: f64 = 2.0 * f64::EPSILON;

/// Thresholds and caps of the solvers. Every threshold is dimensionless, so that none depends on the units of a
/// problem.
///
/// Rows are compared after scaling: with `s_i = sqrt(A_ii)` (1 where `A_ii = 0`) the scaled acceleration is
/// `a_i / s_i`, the scaled force `s_i f_i`, and the *scale* of a problem is `max |b_i / s_i|`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Settings {
    /// Largest natural residual of an accepted answer, in units of the scale.
    pub natural_residual: f64,
    /// Growth from which an answer may be judged by its backward residual instead: there rounding times the growth may
    /// exceed `natural_residual`. A contradiction of contacts proves infeasibility only if any solution would have at
    /// least this growth.
    pub least_growth: f64,
    /// Growth from which forces mean nothing: such an answer is accepted by its natural residual only, not by its
    /// backward residual. A proof of infeasibility by which any solution would have at least this growth counts as
    /// certain.
    pub greatest_growth: f64,
    /// Largest backward residual of an accepted answer with a growth from `least_growth` to `greatest_growth`.
    pub backward_residual: f64,
    /// Fraction of a row's square A_ii: the row depends on the closed rows if they leave at most this fraction of it.
    ///
    /// A larger value treats nearly redundant contacts as redundant; a smaller one lets forces grow by up to its
    /// reciprocal.
    pub dependence: f64,
    /// Value of `dependence` in a second attempt, made where rows taken for dependent contradict each other and may be
    /// only nearly dependent: a few roundings of 1.
    pub least_dependence: f64,
    /// Amount added to the scaled diagonal of `A`, which is 1, where contacts contradict each other and are to be
    /// solved as given: a few roundings. The backward residual of the answer is about this amount, and its forces are
    /// about the contradiction divided by it.
    pub raise: f64,
    /// Largest contradiction between dependent rows, in units of the scale, that is solved in the least-squares sense;
    /// with a larger one the problem is infeasible.
    pub inconsistency: f64,
    /// Fraction of the scale: smaller scaled accelerations count as zero when the active-set method selects the next
    /// row to close.
    pub open_tolerance: f64,
    /// Fraction of the scale: a row whose scaled offset b is at most this starts closed. Contacts of bodies at rest on
    /// each other have b near 0, of either sign by small relative motions.
    pub start_closed: f64,
    /// Addition to `open_tolerance` for rounding, as a fraction of the largest sum of absolute terms of an
    /// acceleration: a few roundings.
    pub rounding: f64,
    /// Cap on pivots, per row of the problem plus 5.
    pub pivots_per_row: usize,
    /// Cap on the rounds in which the active-set method exchanges all wrong rows at once.
    pub block_rounds: usize,
    /// Number of rounds of exchanges in succession that may leave no fewer rows wrong than the best before.
    pub block_tries: usize,
    /// Number of rows from which [`Auto`](crate::Auto) hands very redundant problems of bodies to
    /// [`ProximalNewton`](crate::ProximalNewton), unless `selection` is [`ForceSelection::LeastNorm`].
    pub hand_over_rows: usize,
    /// Number of rows from which [`Auto`](crate::Auto) hands problems of bodies that take many pivots to
    /// [`ProximalNewton`](crate::ProximalNewton), unless `selection` is [`ForceSelection::Pivoted`] or
    /// [`ForceSelection::LeastNorm`].
    pub pivoting_rows: usize,
    /// Cap on steps of iterative refinement of the final forces.
    pub refinements: usize,
    /// Cap on outer (multiplier) iterations of the proximal method, and on those of the least-norm selection.
    pub outer_iterations: usize,
    /// Cap on the total number of Newton steps of the proximal method.
    pub newton_steps: usize,
    /// Tolerance on gap and feasibility that `Qp` asks of its interior-point method, in units of the scale.
    pub interior_point: f64,
    /// Proximal term of the least-norm selection of forces, in units of the scaled diagonal of `A`, which is 1.
    pub least_norm_term: f64,
    /// Selection of forces where redundant rows leave a choice.
    pub selection: ForceSelection,
    /// First treatment of contacts that contradict each other by less than `inconsistency`.
    pub contradiction: Contradiction,
}

/// First treatment of unilateral rows that contradict each other by less than [`Settings::inconsistency`].
///
/// Nearly redundant contacts can be satisfied exactly as given only by forces of 1e5 times the load and more, which are
/// of no use. Up to rounding, forces of the size of the load satisfy them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum Contradiction {
    /// Solve the rows as given, up to rounding of A, if the residual rules accept the large forces of that answer;
    /// otherwise by least squares.
    #[default]
    SolveExactly,
    /// Solve by least squares and report the inconsistency; solve as given only if the contradiction is larger.
    LeastSquares,
}

/// Selection among the forces that redundant contacts leave open. The accelerations do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum ForceSelection {
    /// The forces that are found soonest. Where many rows are redundant, all of them may carry force.
    #[default]
    Quickest,
    /// The forces at which the pivoting ends, however long that takes: few rows carry force. Only where so many rows
    /// are redundant that the choice among them is arbitrary, all of them may. For callers that go on with the rows
    /// that carry force, as an integrator does: where rows share a load, none of those that are needed has zero force.
    Pivoted,
    /// Forces on rows that do not depend on each other: those at which the pivoting ends, or those of another method
    /// moved to such rows. Some of these rows may have zero force by chance, such as the second corner of a block that
    /// is balanced on the first.
    Vertex,
    /// The forces with the least sum of squares of the scaled forces `s_i f_i` among those that hold the same rows at
    /// rest, so that symmetric scenes show symmetric forces. Where masses are thousands of times apart, the rows at
    /// rest are known up to rounding only, and another set of rows might do with smaller forces.
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
    /// Checks that every threshold is positive and finite. The caps may have any value.
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

    /// Whether an error is a certificate that leaves no doubt: any solution would have a growth of at least
    /// `greatest_growth`, or the rows are bilateral, depend on each other to the last digit, and contradict each other
    /// by more than `inconsistency`.
    pub(crate) fn is_proven(&self, error: &SolveError, problem: &Problem) -> bool {
        let SolveError::Infeasible(proof) = error else { return false };
        let is_bilateral = || proof.direction.iter().zip(problem.bilateral()).all(|(z, is)| *is || *z == 0.0);
        let is_exact = proof.leakage <= SAME
            && proof.contradiction > self.inconsistency
            && cancels(problem, &proof.direction);
        proof.least_growth() >= self.greatest_growth || (is_exact && is_bilateral())
    }

    /// Cap on pivots for a problem of `rows` rows; small problems get a little more per row.
    pub(crate) fn pivot_cap(&self, rows: usize) -> usize {
        self.pivots_per_row.saturating_mul(rows + 5)
    }
}

/// True if a combination z of rows moves no body, to the last digit, or if the problem has no bodies. A z is of second
/// order in the motion Jᵀ z, so it may be rounding where the motion is not.
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
