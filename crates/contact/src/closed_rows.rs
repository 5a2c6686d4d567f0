//! The closed rows C of an active-set method, with the factor of Â_CC, forces and accelerations.
//!
//! All quantities are the scaled ones of [`System`]. Bilateral rows are free: their force may take any sign, and they
//! never leave C.

use std::ops::Range;

use crate::order::RowOrder;
use crate::problem::{Problem, pushing};
use crate::settings::DOUBTFUL;
use crate::skyline::Skyline;
use crate::system::System;

/// Position of an open row.
const OPEN: u32 = u32::MAX;

/// Fraction of the raise of the diagonal: a Schur complement up to it counts as dependent, as rounding may have taken
/// the rest.
const LOST: f64 = 0.25;

/// Rounding of a scaled Schur complement, in units of 1 + |z|², where z times the closed rows is closest to the row.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// State shared by the phases of the dual active-set method.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ClosedRows {
    pub(crate) system: System,
    /// Order in which rows are closed many at a time.
    pub(crate) order: RowOrder,
    pub(crate) factor: Skyline,
    /// Row at each position.
    pub(crate) rows: Vec<usize>,
    /// Position of each row, or `OPEN`.
    position: Vec<u32>,
    /// Whether the closed rows and the factor are those of the last solve, with the same matrix.
    reusable: bool,
    /// Envelope of the factor when rows were last closed in order.
    pub(crate) narrow_envelope: usize,
    /// Flags and forces while rows are closed anew.
    again: Vec<bool>,
    /// Number of first positions that stay when all others are opened: the bilateral rows, if they were closed first.
    pub(crate) kept: usize,
    /// One flag per row: true if it is bilateral.
    pub(crate) free: Vec<bool>,
    /// Scaled force of every row.
    pub(crate) force: Vec<f64>,
    /// Scaled acceleration of every row.
    pub(crate) acceleration: Vec<f64>,
    /// Largest sum of absolute terms of an acceleration at the last evaluation, or a bound on it.
    pub(crate) terms: f64,
    /// Whether `terms` is only the bound Σ|f̂|, as no entry of Â exceeds 1.
    pub(crate) terms_bound: bool,
    /// L⁻¹ Â_Cd of the row d last [considered](Self::consider).
    reach: Vec<f64>,
    /// Positions where `reach` may not be zero.
    reached: Range<usize>,
    /// Shares of the closed rows in a row that nearly depends on them.
    shares: Vec<f64>,
    /// Solutions of systems with the factor.
    pub(crate) step: Vec<f64>,
    /// Scaled Schur complement up to which a row depends on the closed rows.
    dependence: f64,
    /// Whether a row whose remainder may be rounding counts as dependent, too.
    doubts: bool,
    /// Added to the diagonal of Â: 0, or the proximal term of the least-norm selection.
    pub(crate) proximal: f64,
    /// Added to the diagonal of the factor alone, so that rows that depend on each other can all be closed; refinement
    /// removes the error of the forces.
    pub(crate) spread: f64,
    /// Whether the factor was raised so in the last solve.
    pub(crate) was_spread: bool,
}

/// Relation of a row to the closed rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Relation {
    /// Schur complement Â_dd - Â_dC Â_CC⁻¹ Â_Cd: the remainder of the row's square, 1, that the closed rows leave.
    pub(crate) complement: f64,
    /// Whether the complement is zero up to the dependence of the attempt.
    pub(crate) dependent: bool,
    first: usize,
}

impl ClosedRows {
    /// Loads a problem and sets all forces to zero. The closed rows and their factor stay if only b has changed.
    pub(crate) fn load(&mut self, problem: &Problem, dependence: f64, doubts: bool) {
        let same = self.system.load(problem);
        let n = problem.len();
        self.was_spread = self.spread > 0.0 && self.dependence == dependence;
        for values in [&mut self.force, &mut self.acceleration, &mut self.reach, &mut self.step] {
            values.clear();
            values.resize(n, 0.0);
        }
        self.reached = 0..0;
        let plain =
            self.proximal == 0.0 && self.kept == 0 && (self.dependence, self.doubts) == (dependence, doubts);
        self.reusable = same && plain && self.free == problem.bilateral;
        if self.reusable {
            self.system.form_entries(problem);
            return;
        }
        self.system.prepare_to_gather(problem);
        let (start, column) = self.system.pattern();
        self.order.prepare(start, column, self.system.columns());
        (self.dependence, self.doubts) = (dependence, doubts);
        self.proximal = 0.0;
        self.spread = 0.0;
        self.factor.reset(n);
        self.rows.clear();
        self.rows.reserve(n);
        self.shares.clear();
        self.shares.reserve(n);
        self.kept = 0;
        self.free.clear();
        self.free.extend_from_slice(problem.bilateral());
        self.position.clear();
        self.position.resize(n, OPEN);
    }

    /// Whether the flagged rows are exactly those that are still closed from the last solve.
    pub(crate) fn still_closed(&mut self, flags: &[bool]) -> bool {
        let reusable = std::mem::take(&mut self.reusable);
        reusable && flags.iter().zip(&self.position).all(|(flag, position)| *flag == (*position != OPEN))
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(crate) fn is_closed(&self, row: usize) -> bool {
        self.position[row] != OPEN
    }

    /// Position of a row, if it is closed.
    pub(crate) fn position_of(&self, row: usize) -> Option<usize> {
        self.is_closed(row).then(|| self.position[row] as usize)
    }

    /// Finds how an open row relates to the closed ones, for [`close`](Self::close) or, if it depends on
    /// them, for the null direction by which [`Shift`](crate::dependent::Shift) reconciles them.
    pub(crate) fn consider(&mut self, row: usize) -> Relation {
        let closed = self.len();
        // Only the range of the row considered before is not zero.
        self.reach[self.reached.clone()].fill(0.0);
        let first = self.system.gather(row, &self.position, closed, &mut self.reach);
        self.reached = first..closed;
        let square = self.factor.forward(&mut self.reach[..closed], first);
        let diagonal = if self.system.movable[row] { 1.0 + self.proximal + self.spread } else { 0.0 };
        let complement = diagonal - square;
        let dependence = if self.spread > 0.0 { LOST * self.spread } else { self.dependence };
        let relation = Relation { complement, dependent: complement <= dependence, first };
        Relation { dependent: relation.dependent || (self.doubts && self.is_doubtful(relation)), ..relation }
    }

    /// True if the row just found doubtful nearly depends on bilateral rows: all its shares of contacts are below 1.
    fn depends_on_bilateral(&self) -> bool {
        let mut shares = self.shares.iter().zip(&self.rows);
        shares.all(|(share, &row)| self.free[row] || share.abs() < 1.0)
    }

    /// Rounding of the Schur complement of the row just considered. It is that of Â, enlarged where the closed rows
    /// nearly depend on each other.
    fn rounding(&mut self, closed: usize) -> f64 {
        let shares = &mut self.shares;
        shares.clear();
        shares.extend_from_slice(&self.reach[..closed]);
        self.factor.backward(shares);
        ROUNDINGS * shares.iter().fold(1.0, |sum: f64, share| sum + share * share)
    }

    /// Closes the row last considered, which must be independent.
    pub(crate) fn close(&mut self, row: usize, relation: Relation) {
        let closed = self.len();
        self.factor.push(&self.reach[..closed], relation.first, relation.complement.sqrt());
        self.system.close(row);
        self.position[row] = closed as u32;
        self.rows.push(row);
    }

    /// Closes a row if it is independent of the closed ones.
    pub(crate) fn try_close(&mut self, row: usize) -> bool {
        let relation = self.consider(row);
        if !relation.dependent {
            self.close(row, relation);
        }
        !relation.dependent
    }

    /// Closes the flagged rows that are independent, in the order that keeps the factor narrow. Returns whether every
    /// bilateral one is.
    pub(crate) fn close_flagged(&mut self, flags: &[bool]) -> bool {
        self.close_independent(flags, 0.0)
    }

    /// Does as [`close_flagged`](Self::close_flagged), but closes a unilateral row only if more than the fraction
    /// `least` of its square is left.
    pub(crate) fn close_independent(&mut self, flags: &[bool], least: f64) -> bool {
        let mut independent = true;
        for place in 0..self.order.rows.len() {
            let row = self.order.rows[place] as usize;
            if !flags[row] || self.is_closed(row) {
                continue;
            }
            let relation = self.consider(row);
            if relation.dependent
                || (self.free[row] && self.is_doubtful(relation) && self.depends_on_bilateral())
            {
                independent &= !self.free[row];
            } else if relation.complement > least || self.free[row] {
                self.close(row, relation);
            }
        }
        self.narrow_envelope = self.factor.envelope();
        independent
    }

    /// Closes the bilateral rows that are independent, those of which little is left after all others. If one of these
    /// were closed too early, its rounding, enlarged, would make rows that depend on it pass for independent. Returns
    /// whether every bilateral row is independent.
    pub(crate) fn close_bilateral(&mut self) -> bool {
        let mut independent = true;
        for least in [DOUBTFUL, 0.0] {
            for place in 0..self.order.rows.len() {
                let row = self.order.rows[place] as usize;
                if !self.free[row] || self.is_closed(row) {
                    continue;
                }
                let relation = self.consider(row);
                if relation.dependent || self.is_doubtful(relation) {
                    independent = false;
                } else if relation.complement > least {
                    self.close(row, relation);
                }
            }
        }
        self.narrow_envelope = self.factor.envelope();
        independent
    }

    /// True if the remainder of the row just considered may be rounding. Never with a raised factor, as the raise is
    /// far more than rounding.
    fn is_doubtful(&mut self, relation: Relation) -> bool {
        self.spread == 0.0
            && relation.complement <= DOUBTFUL
            && relation.complement <= self.rounding(self.len())
    }

    /// Closes the same rows anew, in the narrow order, with their forces. Returns false if rounding made one dependent,
    /// which is then open and has no force.
    pub(crate) fn refactor(&mut self) -> bool {
        let closed = self.len();
        let mut again = std::mem::take(&mut self.again);
        again.clear();
        again.extend(self.position.iter().map(|&position| position != OPEN));
        self.open_unflagged(&again);
        self.again = again;
        self.len() == closed
    }

    /// Opens the row at a position; its force becomes zero.
    pub(crate) fn open_at(&mut self, at: usize) {
        let row = self.rows.remove(at);
        self.factor.remove(at);
        self.system.open(row);
        self.position[row] = OPEN;
        self.force[row] = 0.0;
        for &later in &self.rows[at..] {
            self.position[later] -= 1;
        }
    }

    /// Opens all rows except the `kept` ones, whose factor stays.
    pub(crate) fn open_all(&mut self) {
        for at in self.kept..self.rows.len() {
            let row = self.rows[at];
            self.system.open(row);
            self.position[row] = OPEN;
            self.force[row] = 0.0;
        }
        self.rows.truncate(self.kept);
        self.factor.truncate(self.kept);
    }

    /// Writes Â_CC⁻¹ Â_Cd to `step[..closed]`: minus the change of the closed forces that keeps the closed
    /// accelerations while the force of the row last considered grows by one.
    pub(crate) fn find_response(&mut self) {
        let closed = self.len();
        self.step[..closed].copy_from_slice(&self.reach[..closed]);
        self.factor.backward(&mut self.step[..closed]);
    }

    /// Sets the closed forces to those with zero acceleration of the closed rows; they may be negative.
    pub(crate) fn solve_closed(&mut self) {
        let closed = self.len();
        for (at, &row) in self.rows.iter().enumerate() {
            self.step[at] = -self.system.b[row];
        }
        self.factor.solve(&mut self.step[..closed]);
        for (at, &row) in self.rows.iter().enumerate() {
            self.force[row] = self.step[at];
        }
    }

    /// Makes one step of iterative refinement of the closed forces; unilateral ones stay admissible.
    pub(crate) fn refine(&mut self) {
        let closed = self.len();
        for (at, &row) in self.rows.iter().enumerate() {
            self.step[at] = -self.acceleration[row];
        }
        self.factor.solve(&mut self.step[..closed]);
        for (at, &row) in self.rows.iter().enumerate() {
            let force = self.force[row] + self.step[at];
            self.force[row] = if self.free[row] { force } else { pushing(force) };
        }
    }

    /// Evaluates all accelerations.
    pub(crate) fn accelerate(&mut self) {
        self.terms = self.system.accelerate(&self.force, &mut self.acceleration);
        self.terms_bound = false;
        self.add_proximal();
    }

    /// Evaluates all accelerations in less time, with only a bound on the sums of their terms.
    pub(crate) fn accelerate_roughly(&mut self) {
        if !self.system.evaluate(&self.force, &mut self.acceleration) {
            return self.accelerate();
        }
        self.terms = self.force.iter().map(|f| f.abs()).sum();
        self.terms_bound = true;
        self.add_proximal();
    }

    fn add_proximal(&mut self) {
        if self.proximal > 0.0 {
            for (a, f) in self.acceleration.iter_mut().zip(&self.force) {
                *a += self.proximal * f;
            }
        }
    }

    /// Opens the rows without a flag. The forces of the others stay.
    pub(crate) fn open_unflagged(&mut self, flags: &[bool]) {
        self.step.copy_from_slice(&self.force);
        self.open_all();
        self.close_flagged(flags);
        for &row in &self.rows {
            self.force[row] = self.step[row];
        }
    }

    /// Largest |â| of a closed row.
    pub(crate) fn closed_error(&self) -> f64 {
        self.rows.iter().fold(0.0, |m: f64, &row| m.max(self.acceleration[row].abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ProblemError;

    #[test]
    fn with_a_raise_no_connector_is_doubtful() -> Result<(), ProblemError> {
        let mut problem = Problem::from_rows(&[(0, 0, 1.0), (1, 0, 1.0)], &[1.0], &[-1.0, -1.0])?;
        problem.set_bilateral(&[true, true])?;
        let mut closed = ClosedRows::default();
        closed.load(&problem, 1e-11, false);
        closed.spread = 1e-9;
        assert!(closed.close_flagged(&[true, true]));
        // The rounding, which takes a pass over the factor for each row, was not computed.
        assert_eq!((closed.len(), closed.shares.len()), (2, 0));
        Ok(())
    }
}
