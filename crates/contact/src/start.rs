//! The rows with which the dual active-set method starts as closed.
//!
//! These are first the rows that would close without forces, or that were closed before. Then all wrong rows are
//! exchanged at once while that makes fewer of them wrong, which it mostly does (L. Portugal, J. Júdice, L. Vicente, "A
//! comparison of block pivoting and interior-point algorithms for linear least squares problems with nonnegative
//! variables", Mathematics of Computation 63, 1994, 625-643). At last rows whose force would pull are opened, so that
//! pivoting can begin.

use crate::closed_rows::ClosedRows;
use crate::dual_active_set::{DualActiveSet, HandOver};
use crate::error::Infeasibility;
use crate::problem::{Problem, pushing};
use crate::settings::WELL;
use crate::warm::WarmStart;

/// Reciprocal of the fraction of dependent rows from which a problem is so redundant that spreading forces or handing
/// over is worth it.
pub(crate) const REDUNDANT: usize = 5;

/// Reciprocal of the fraction of independent rows below which a problem is a simple one (a box on a floor), where
/// pivots are cheap.
pub(crate) const SUBSTANTIAL: usize = 4;

/// Multiple of the patience: if the pivots in sight are more work than this, the problem is handed over at once. It
/// exceeds 1 because some wrong rows come right with others.
const SURELY: usize = 2;

/// Reciprocal of the fraction of flagged rows up to which open ones may still close: with more, the choice of the
/// closed rows is not arbitrary.
const MOVING: usize = 50;

/// Reciprocal of the fraction of closed rows above which a new factor is cheaper than removing the rows to be opened
/// from the old one.
const MANY: usize = 8;

/// Factor by which the envelope may have grown since the factor was made in a narrow order; with more it is made anew.
const WIDENED: usize = 2;

/// The start of a solve.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Start<'a> {
    /// The rows are closed that would close without forces.
    Nothing,
    /// The rows are closed that were closed in an earlier answer, or are guessed to be.
    Earlier(&'a WarmStart),
    /// The flagged rows are closed, one flag per row.
    #[cfg(feature = "qp")]
    Closed(&'a [bool]),
}

impl DualActiveSet {
    /// Closes the rows to start with. Bilateral rows are mixed with the others in the order that keeps the factor
    /// narrow. If some turn out dependent, all bilateral rows are closed first, so that they contradict only each
    /// other.
    pub(crate) fn find_start(&mut self, problem: &Problem) -> Option<Box<Infeasibility>> {
        if self.exchange_blocks() {
            return None;
        }
        self.closed.open_all();
        let certificate = self.close_connectors(problem);
        if certificate.is_none() {
            self.exchange_blocks();
        }
        certificate
    }

    /// Closes the bilateral rows. Those that depend on others must agree with them, unless that is left to contacts:
    /// these may hold a body that two pins nearly at the same place could hold only by huge forces.
    pub(crate) fn close_connectors(&mut self, problem: &Problem) -> Option<Box<Infeasibility>> {
        let independent = self.closed.close_bilateral();
        self.closed.kept = self.closed.len();
        if independent {
            return None;
        }
        self.closed.solve_closed();
        self.closed.accelerate();
        let noise = self.noise();
        let limit = self.settings.inconsistency * self.closed.system.scale;
        if self.leaves_connectors {
            let least = noise.max(self.settings.natural_residual * self.closed.system.scale);
            let moves = |row: usize| problem.bilateral[row] && self.closed.acceleration[row].abs() > least;
            self.has_left_connectors = (0..problem.len()).any(moves);
            if self.has_left_connectors {
                return None;
            }
        }
        self.shift.reconcile_connectors(&mut self.closed, problem, noise, limit)
    }

    /// Flags the rows to start with: those that `start` gives, and of the rows it does not know those that would close.
    pub(crate) fn choose_start(&mut self, problem: &Problem, start: Start<'_>) {
        let system = &self.closed.system;
        let limit = self.settings.start_closed * system.scale;
        self.is_warm = match start {
            Start::Nothing => false,
            Start::Earlier(warm) => !warm.is_guess(),
            #[cfg(feature = "qp")]
            Start::Closed(_) => true,
        };
        let lookup = match start {
            Start::Earlier(warm) => Some(warm.lookup(problem)),
            Start::Nothing => None,
            #[cfg(feature = "qp")]
            Start::Closed(_) => None,
        };
        self.knows_forces = matches!(start, Start::Earlier(warm) if warm.has_forces());
        if self.knows_forces {
            let earlier = |row| lookup.as_ref().and_then(|lookup| lookup.find(row));
            let scaled =
                |row| earlier(row).map_or(0.0, |earlier| pushing(earlier.force) * system.row_scale[row]);
            self.admissible.clear();
            self.admissible.extend((0..problem.len()).map(scaled));
        }
        self.start.clear();
        self.start.extend((0..problem.len()).map(|row| {
            let earlier = lookup.as_ref().and_then(|lookup| lookup.find(row));
            let closed = match (start, earlier) {
                #[cfg(feature = "qp")]
                (Start::Closed(rows), _) => rows[row],
                (_, Some(earlier)) => earlier.closed,
                (_, None) => system.b[row] <= limit,
            };
            problem.bilateral[row] || (closed && system.movable[row])
        }));
    }

    /// Exchanges all wrong rows at once, while that leaves fewer of them. Returns false if a bilateral row depends on
    /// others and the bilateral rows were not closed first.
    pub(crate) fn exchange_blocks(&mut self) -> bool {
        if self.is_still_spread() {
            return true;
        }
        let mut fewest = usize::MAX;
        let mut tries = 0;
        // The closed rows of an earlier answer stay, unless its forces were spread over dependent rows.
        let kept = self.is_warm && !self.closed.was_spread;
        for round in 0..self.settings.block_rounds {
            let independent = self.closed.still_closed(&self.start) || {
                self.closed.open_all();
                self.closed.close_independent(&self.start, if kept && round == 0 { 0.0 } else { WELL })
            };
            let flagged = self.start.iter().filter(|start| **start).count();
            self.closed.solve_closed();
            self.closed.accelerate();
            if round == 0 && self.is_worth_spreading(flagged) {
                if self.spread_forces() {
                    return true;
                }
                self.closed.close_independent(&self.start, WELL);
                self.closed.solve_closed();
                self.closed.accelerate();
            }
            let wrong = self.mark_wrong(-self.noise());
            if self.may_hand_over && fewest == usize::MAX && wrong > 0 && self.is_redundant(flagged) {
                self.handed_over = Some(HandOver::Redundant);
                return true;
            }
            if !independent && self.closed.kept == 0 {
                // With connectors first the factor would be wide as well.
                self.look_ahead(wrong);
                return self.handed_over.is_some();
            }
            if wrong < fewest {
                fewest = wrong;
                tries = 0;
            } else {
                tries += 1;
            }
            if wrong == 0 || tries > self.settings.block_tries {
                self.look_ahead(wrong);
                break;
            }
        }
        true
    }

    /// Flags the unilateral rows that should be closed next. Wrong are closed rows whose force pulls and open rows
    /// whose acceleration is below `limit`. Returns the number of wrong rows.
    pub(crate) fn mark_wrong(&mut self, limit: f64) -> usize {
        let mut wrong = 0;
        let closed = &self.closed;
        for (row, start) in self.start.iter_mut().enumerate().filter(|(row, _)| !closed.free[*row]) {
            let is_closed = closed.is_closed(row);
            let bad = if is_closed { closed.force[row] < 0.0 } else { closed.acceleration[row] < limit };
            *start = is_closed != bad;
            wrong += usize::from(bad);
        }
        wrong
    }

    /// Notes that another method is likely to be faster, if the pivots of the wrong rows, at least one each, are more
    /// work than the patience allows. If few rows are closed, as under a box on a floor, a pivot rights many wrong
    /// ones, and none is noted.
    fn look_ahead(&mut self, wrong: usize) {
        let is_much = self.patience.is_some_and(|patience| wrong * self.work_of_pivot() > SURELY * patience);
        if is_much && self.closed.len() * SUBSTANTIAL >= wrong {
            self.handed_over = Some(HandOver::Pivots);
        }
    }

    /// Whether a large part of the flagged rows depends on the closed ones, which alone keep nearly all others from
    /// closing. The closed rows are then an arbitrary choice among many, and most pivots would only improve it. False
    /// if few are closed (a box on a floor), for then pivots are cheap.
    fn is_redundant(&self, flagged: usize) -> bool {
        let closed = self.closed.len();
        let moving =
            (0..self.start.len()).filter(|&row| self.start[row] && !self.closed.is_closed(row)).count();
        let dependent = flagged - closed;
        dependent >= flagged / REDUNDANT && closed >= flagged / SUBSTANTIAL && moving <= flagged / MOVING
    }

    /// Whether pivots have widened the factor much.
    pub(crate) fn is_factor_wide(&self) -> bool {
        self.closed.factor.envelope() > WIDENED * (self.closed.narrow_envelope + self.closed.force.len())
    }

    /// Makes the factor anew, in the order that keeps it narrow, when pivots have widened it.
    pub(crate) fn narrow_factor(&mut self) {
        if self.is_factor_wide() && !self.closed.refactor() {
            self.closed.solve_closed();
            self.closed.accelerate();
            self.make_forces_admissible();
        }
    }

    /// Opens closed rows until no unilateral force is negative. Before and after, the forces must be those with zero
    /// acceleration of the closed rows, and all accelerations up to date.
    pub(crate) fn make_forces_admissible(&mut self) {
        let before = self.closed.len();
        while !self.is_out_of_patience() {
            let closed = &mut self.closed;
            let pulls = |closed: &ClosedRows, at: usize| {
                let row = closed.rows[at];
                closed.force[row] < 0.0 && !closed.free[row]
            };
            let count = (0..closed.len()).filter(|&at| pulls(closed, at)).count();
            if count == 0 {
                break;
            }
            if count > closed.len() / MANY && closed.proximal == 0.0 && closed.kept == 0 {
                self.start.clear();
                self.start.extend(
                    (0..closed.force.len())
                        .map(|row| closed.is_closed(row) && (closed.force[row] >= 0.0 || closed.free[row])),
                );
                closed.open_unflagged(&self.start);
            } else {
                for at in (0..closed.len()).rev() {
                    if pulls(closed, at) {
                        closed.open_at(at);
                    }
                }
            }
            closed.solve_closed();
            self.pivots += count;
            self.count_work(count);
        }
        if self.closed.len() != before {
            self.closed.accelerate();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::{InverseInertia, Row};
    use crate::solution::Solution;
    use crate::solver::Solver;

    #[test]
    fn the_rows_of_an_answer_are_kept_those_of_a_guess_must_be_well_independent() {
        let mut problem = Problem::new();
        let body =
            problem.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 6.0 }).expect("a body");
        for arm in [-0.5, 0.5] {
            problem.add_row(&Row::new(body, [0.0, 1.0, arm], -9.81)).expect("a row");
        }
        let (mut solver, mut solution, mut warm) =
            (DualActiveSet::default(), Solution::new(), WarmStart::new());
        warm.guess([Some(true), Some(true)]);
        solver.solve_from(&problem, &warm, &mut solution).expect("forces of a block");
        assert!(!solver.is_warm);
        warm.remember(&problem, &solution);
        solver.solve_from(&problem, &warm, &mut solution).expect("forces of a block");
        assert!(solver.is_warm);
    }

    #[test]
    fn connectors_do_not_come_first_where_pivots_would_not_end() {
        // A chain on a floor, whose links touch it with both ends: rows that would depend on each other are off by a
        // thousandth.
        const LINKS: usize = 500;
        let off = |k: usize| 1.0 + 1e-3 * (k as f64 * 2.4).sin();
        let mut problem = Problem::new();
        let mut before = None;
        for link in 0..LINKS {
            let body =
                problem.add_body(InverseInertia { inverse_mass: 5.0, inverse_moment: 57.7 }).expect("a body");
            let arm = |k: usize| 0.5 * off(5 * link + k);
            for (k, side) in [(2, -1.0), (3, 1.0)] {
                let offset = 6.0 * ((7 * link + 3 * k) as f64).sin() - 3.0;
                problem.add_row(&Row::new(body, [0.0, 1.0, side * arm(k)], offset)).expect("a row");
            }
            // The contacts before the pin hold all of its link.
            let pin = Row::new(body, [0.0, 1.0, -arm(0)], 0.0);
            let pin = before.map_or(pin, |before| pin.against(before, [0.0, -1.0, -arm(1)]));
            problem.add_row(&pin.bilateral()).expect("a row");
            before = Some(body);
        }
        let (mut solver, mut solution) = (DualActiveSet::default(), Solution::new());
        let outcome = solver.run_or_hand_over(&problem, Start::Nothing, &mut solution);
        assert!(matches!(outcome, Ok(Some(HandOver::Pivots))), "{outcome:?}");
        assert_eq!(solver.closed.kept, 0);
    }
}
