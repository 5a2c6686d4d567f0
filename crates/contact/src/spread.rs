//! Forces spread over rows that depend on each other, instead of a choice among them.
//!
//! Where many contacts are redundant, as in a pyramid of blocks, more rows would close than can be independent. The
//! choice of those that carry the forces is then arbitrary, and pivoting to a choice without negative forces takes as
//! many pivots as there are redundant rows. With the diagonal of the factor raised by a small δ all of them can be
//! closed at once. The forces are then nearly those of least norm, which the weight of the bodies mostly leaves
//! positive. Their error is removed by refinement, the proximal point method in the forces: each step leaves δ/(δ + λ)
//! of the accelerations in the direction of an eigenvalue λ of Â, and in a direction of λ = 0 there are none if the
//! rows do not contradict each other. Source of the method: R. T. Rockafellar, "Monotone operators and the proximal
//! point algorithm", SIAM Journal on Control and Optimization 14, 1976, 877-898.

use crate::dual_active_set::{DualActiveSet, REFINED};
use crate::settings::ForceSelection;
use crate::start::{REDUNDANT, SUBSTANTIAL};

/// Amount δ by which the diagonal of the factor, which is 1 in Â, is raised: small beside the least nonzero eigenvalue
/// of piles, so that few steps of refinement are needed, and large beside rounding.
const RAISE: f64 = 1e-9;

/// Cap on the steps of refinement.
const STEPS: usize = 6;

/// Fraction of the scale up to which the acceleration of a row that depends on closed ones counts as zero.
const REST: f64 = 1e-4;
/// Reciprocal of the fraction of dependent rows that must have zero acceleration: with fewer they contradict the closed
/// rows, and some must open.
const CONSISTENT: usize = 2;

/// Largest sum of terms, in units of the scale, at which accelerations of dependent rows mean something; beyond it the
/// closed rows nearly depend on each other, as in a chain on a floor.
const UNUSABLE: f64 = 1e6;

/// Number of exchanges in succession that may leave no fewer rows wrong.
const TRIES: usize = 2;
/// Largest number of rows that are exchanged one by one; for more all are closed anew.
const FEW: usize = 6;

/// Reciprocal of the fraction of rows that may be wrong with all closed. With more wrong rows they are only nearly
/// redundant, and forces are large.
const WRONG: usize = 4;

impl DualActiveSet {
    /// Whether many of the `flagged` rows that are to be closed depend on the closed ones without contradicting them,
    /// and some closed row pulls.
    pub(crate) fn is_worth_spreading(&self, flagged: usize) -> bool {
        let closed = self.closed.len();
        let pulls = |&row: &usize| self.closed.force[row] < 0.0 && !self.closed.free[row];
        let rest = REST * self.closed.system.scale;
        let rests = |&row: &usize| {
            self.start[row] && !self.closed.is_closed(row) && self.closed.acceleration[row].abs() <= rest
        };
        self.settings.selection == ForceSelection::Quickest
            && self.closed.proximal == 0.0
            && self.closed.kept == 0
            && (flagged - closed) * REDUNDANT >= flagged.max(1)
            && closed * SUBSTANTIAL >= flagged
            && self.closed.rows.iter().any(pulls)
            && (self.closed.terms > UNUSABLE * self.closed.system.scale
                || (0..self.start.len()).filter(rests).count() * CONSISTENT >= flagged - closed)
    }

    /// Closes all flagged rows, redundant ones too, and exchanges wrong ones while that leaves fewer. Returns whether
    /// that ended at admissible forces; if not, no rows are closed.
    pub(crate) fn spread_forces(&mut self) -> bool {
        self.try_spread(Self::exchange_spread)
    }

    /// Whether forces were spread in the last solve and can be spread again with the rows that start closed now. If
    /// that was tried and failed, no rows are closed. It is not tried if connectors were closed first, as the factor of
    /// all rows would be wide.
    pub(crate) fn is_still_spread(&mut self) -> bool {
        let closed = &self.closed;
        let was_spread = closed.was_spread && self.is_warm && closed.proximal == 0.0 && closed.kept == 0;
        (self.closed.spread > 0.0 || was_spread)
            && self.try_spread(|solver| {
                if solver.closed.spread > 0.0 && solver.closed.still_closed(&solver.start) {
                    return solver.go_on_spread();
                }
                was_spread && solver.exchange_spread()
            })
    }

    /// Runs `something`; if that fails, restores the rows to start with and the factor without a raise.
    fn try_spread(&mut self, something: impl FnOnce(&mut Self) -> bool) -> bool {
        let mut set_aside = std::mem::take(&mut self.set_aside);
        set_aside.clear();
        set_aside.extend_from_slice(&self.start);
        let ended_well = something(self);
        if !ended_well {
            self.start.copy_from_slice(&set_aside);
            self.gather_rows();
        }
        self.set_aside = set_aside;
        ended_well
    }

    fn exchange_spread(&mut self) -> bool {
        self.closed.open_all();
        self.closed.spread = RAISE;
        self.closed.close_flagged(&self.start);
        self.go_on_spread()
    }

    /// Exchanges wrong rows until none is left. Returns whether the forces are admissible and the closed rows at rest.
    fn go_on_spread(&mut self) -> bool {
        let mut fewest = self.start.len() / WRONG;
        let mut tries = 0;
        loop {
            let wrong = self.mark_wrong_spread();
            if wrong == 0 {
                return self.refine_spread();
            }
            if wrong < fewest {
                fewest = wrong;
                tries = 0;
            } else {
                tries += 1;
            }
            if tries > TRIES || fewest == self.start.len() / WRONG {
                return false;
            }
            self.close_marked(wrong);
        }
    }

    /// Closes exactly the flagged rows; `wrong` flags differ from the closed rows.
    fn close_marked(&mut self, wrong: usize) {
        if wrong > FEW {
            self.closed.open_all();
            self.closed.close_flagged(&self.start);
            return;
        }
        for at in (0..self.closed.len()).rev() {
            if !self.start[self.closed.rows[at]] {
                self.closed.open_at(at);
            }
        }
        for row in 0..self.start.len() {
            if self.start[row] && !self.closed.is_closed(row) {
                self.closed.try_close(row);
            }
        }
    }

    /// Solves the closed rows, and flags the rows that should be closed instead. Returns the number of wrong rows.
    fn mark_wrong_spread(&mut self) -> usize {
        self.closed.solve_closed();
        self.closed.accelerate();
        // Accelerations are known up to the raise times the forces.
        self.mark_wrong(-self.noise() - RAISE * self.closed.terms)
    }

    /// Refines the forces until the closed rows are at rest. Returns whether they are, with all forces admissible.
    fn refine_spread(&mut self) -> bool {
        for _ in 0..STEPS {
            if self.closed.closed_error() <= REFINED * self.noise() {
                break;
            }
            self.closed.refine();
            self.closed.accelerate();
        }
        self.closed.closed_error() <= self.noise()
    }

    /// Opens all rows, and ends the raise of the factor.
    fn gather_rows(&mut self) {
        self.closed.open_all();
        self.closed.spread = 0.0;
    }

    /// Closes only independent rows from here on.
    pub(crate) fn gather_forces(&mut self) {
        self.start.clear();
        self.start.extend((0..self.closed.force.len()).map(|row| self.closed.is_closed(row)));
        self.gather_rows();
        self.closed.close_flagged(&self.start);
        self.closed.solve_closed();
        self.closed.accelerate();
        self.make_forces_admissible();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solution::Solution;
    use crate::solver::Solver;
    use crate::test_problems::{crooked_pyramid, pyramid};
    use crate::warm::WarmStart;

    #[test]
    fn redundant_contacts_of_a_pyramid_carry_force_without_a_pivot() {
        let (mut solver, mut solution, mut warm) =
            (DualActiveSet::default(), Solution::new(), WarmStart::new());
        let problem = pyramid(8, 0.5);
        solver.solve(&problem, &mut solution).expect("forces of a pyramid");
        // Each of the 36 blocks can rise and turn, so two rows per block can be independent.
        let independent = 2 * 36;
        assert!(solution.iterations == 0 && solution.active.len() > independent);
        let ground: f64 = solution.force[..16].iter().sum();
        assert!((ground - 36.0 / 0.8 * 9.81).abs() < 1e-10, "the floor carries {ground} N of 36 blocks");
        // Wider blocks have another J, as redundant as this one; the next step of the same blocks has the same factor.
        warm.remember(&problem, &solution);
        let wider = pyramid(8, 0.51);
        for next in [&wider, &wider, &problem] {
            solver.solve_from(next, &warm, &mut solution).expect("forces of a pyramid");
            assert!(solution.iterations == 0 && solution.active.len() > independent);
        }
    }

    #[test]
    fn contacts_that_are_nearly_redundant_are_solved_by_pivots() {
        let problem = crooked_pyramid(8);
        let (mut solver, mut solution) = (DualActiveSet::default(), Solution::new());
        solver.solve(&problem, &mut solution).expect("forces of a pyramid");
        assert!(solution.iterations > 0 && solution.active.len() < problem.len());
    }

    #[test]
    fn spreading_is_not_tried_again_where_connectors_came_first() {
        let (mut solver, mut solution, mut warm) =
            (DualActiveSet::default(), Solution::new(), WarmStart::new());
        let problem = pyramid(8, 0.5);
        solver.solve(&problem, &mut solution).expect("forces of a pyramid");
        warm.remember(&problem, &solution);
        solver.solve_from(&problem, &warm, &mut solution).expect("forces of a pyramid");
        let closed = solver.closed.len();
        // A state in which the last solve was spread, this one is not, and two connectors were closed first.
        (solver.closed.was_spread, solver.closed.spread, solver.closed.kept) = (true, 0.0, 2);
        assert!(!solver.is_still_spread());
        assert_eq!((solver.closed.len(), solver.closed.spread), (closed, 0.0));
    }
}
