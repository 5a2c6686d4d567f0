//! Dual active-set method for small and medium problems.
//!
//! Closed rows C have zero acceleration, open rows zero force. Forces stay admissible throughout; the open row that
//! closes fastest is closed next, and rows whose force would pull are opened on the way. This is the method of D.
//! Goldfarb, A. Idnani, "A numerically stable dual method for solving strictly convex quadratic programs", Mathematical
//! Programming 27, 1983, 1-33, written in the forces. With contacts it is the pivoting of D. Baraff, SIGGRAPH '94,
//! 23-34, with dependent contacts handled exactly: a row that depends on the closed ones cannot be closed, so forces
//! move along the null direction until one of them vanishes and its row makes room. If none does, the direction
//! certifies that there is no solution.
//!
//! Differences from the papers: bilateral rows are closed at the start and never leave; many rows are closed at once at
//! the start (see `start`); the factor is made anew in a narrow order when pivots have widened it; the final forces are
//! refined.

use crate::check::Checker;
use crate::closed_rows::ClosedRows;
use crate::dependent::{Reconciled, Shift};
use crate::error::{Infeasibility, SettingsError, SolveError};
use crate::exchanges::Exchanges;
use crate::problem::{Problem, pushing};
use crate::settings::{Contradiction, ForceSelection, Settings};
use crate::solution::Solution;
use crate::solver::{Method, Solver};
use crate::start::Start;
use crate::warm::WarmStart;

/// Largest change of a force, per unit step along the response to a row, that is rounding and does not block.
const BLOCKING: f64 = 1e-14;

/// Upper bound of that rounding, however nearly the closed rows depend on each other.
const LARGEST_ROUNDING: f64 = 1e-9;

/// Fraction of the noise to which the closed accelerations are refined, so that they do not use up the allowance.
pub(crate) const REFINED: f64 = 0.125;

/// Least share of a closed connector in a dependent one at which the dependent one takes its place.
const LARGER: f64 = 2.0;

/// Multiple of the noise: a dependent row that closes by no more than this takes the place of a closed one for a slight
/// gain.
const SLIGHT: f64 = 100.0;
/// Cap on exchanges for a slight gain. Of rows that nearly depend on each other, now this, now that one closes by more
/// than noise, for ever.
const MOST_SLIGHT: usize = 10;
/// Cap on exchanges for a slight gain in the strict attempt, as no other attempt is as exact.
const MOST_SLIGHT_AT_LAST: usize = 100;

/// Fraction of the closing acceleration of a row: if more is left after its contradiction was removed, the row is
/// stuck.
const STUCK: f64 = 0.5;

/// Work of a pivot beside that of the factor, in passes over all rows.
const ROW_PASSES: usize = 5;

/// Work, in passes over all rows, in which the interior-point method would be about half done.
const PATIENCE: usize = 400;

/// Dual active-set method with an updated factor, for small and medium symmetric problems.
///
/// Closed rows have zero acceleration, open rows zero force, and all forces are admissible throughout: D. Goldfarb, A.
/// Idnani, Mathematical Programming 27, 1983, 1-33; with contacts the pivoting of D. Baraff, SIGGRAPH '94, 23-34, with
/// dependent contacts handled exactly.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct DualActiveSet {
    pub(crate) settings: Settings,
    pub(crate) closed: ClosedRows,
    /// One flag per row: true if it starts closed; `is_warm` if they are those of an earlier answer.
    pub(crate) start: Vec<bool>,
    pub(crate) is_warm: bool,
    /// Copy of `start` while other rows are tried.
    pub(crate) set_aside: Vec<bool>,
    /// Scaled forces that do not pull, from which a descent starts; `knows_forces` if the caller gave them.
    pub(crate) admissible: Vec<f64>,
    pub(crate) knows_forces: bool,
    /// Buffers while forces are moved to independent rows: the exchanges of rows, and the shares of all rows in a
    /// dependent one.
    pub(crate) exchanges: Exchanges,
    pub(crate) shares: Vec<f64>,
    pub(crate) shift: Shift,
    /// Whether connectors that contradict each other without contacts are left to the contacts, and whether any were.
    pub(crate) leaves_connectors: bool,
    pub(crate) has_left_connectors: bool,
    /// Whether the last answer took nearly dependent rows as independent, with forces as large as that needs.
    pub(crate) is_strained: bool,
    /// Whether contacts contradicted each other in the last attempt, connectors not counted.
    pub(crate) contacts_contradict: bool,
    checker: Checker,
    pub(crate) pivots: usize,
    /// Number of times that a dependent row took the place of a closed one for a slight gain.
    slight_swaps: usize,
    /// Whether to stop where another method is likely to be faster, and the reason if it did.
    pub(crate) may_hand_over: bool,
    pub(crate) handed_over: Option<HandOver>,
    /// Work of pivots and of rows opened before them, in passes over all rows.
    work: usize,
    /// Work after which to stop, in passes over all rows.
    pub(crate) patience: Option<usize>,
}

/// The reason for which another method is likely to be faster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum HandOver {
    /// Many rows depend on others, so that the closed ones are an arbitrary choice.
    Redundant,
    /// Many pivots were made, or are in sight.
    Pivots,
}

/// Treatment of dependent rows in one attempt.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Attempt {
    /// Scaled Schur complement up to which a row is dependent.
    pub(crate) dependence: f64,
    /// Whether a row of which no more than rounding is left counts as dependent, too: for modest forces, if no other
    /// attempt follows.
    pub(crate) doubts: bool,
    /// Largest contradiction between unilateral rows, in units of the scale, that is settled by least squares.
    pub(crate) contradiction: f64,
    /// Cap on the number of times that a dependent row takes the place of a closed one for a slight gain.
    pub(crate) slight_swaps: usize,
    /// Whether accelerations of bilateral rows that nearly depend on others count as contradictions, too.
    pub(crate) is_last: bool,
}

/// The attempts, which differ in the treatment of dependent and nearly dependent rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Attempts {
    /// Treats contradictions as the settings ask first.
    pub(crate) first: Attempt,
    /// Takes nearly dependent rows as independent, with forces as large as that needs.
    strict: Attempt,
    /// Solves by least squares, including accelerations that bilateral rows are left with.
    last: Attempt,
}

impl Attempts {
    fn in_order(self) -> [Attempt; 3] {
        [self.first, self.strict, self.last]
    }
}

/// The end of the pivoting.
pub(crate) enum End {
    Done,
    Stopped,
    /// Rows seem to contradict each other, by too little to prove it; the forces mean nothing.
    Unproven,
    Infeasible(Box<Infeasibility>),
}

impl DualActiveSet {
    /// Makes a solver with the given settings.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] names a setting that is not positive and finite.
    #[inline]
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(DualActiveSet { settings, ..Self::default() })
    }

    pub(crate) fn run(
        &mut self,
        problem: &Problem,
        warm: Start<'_>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        problem.require_symmetric(Method::DualActiveSet)?;
        let attempts = self.attempts();
        // At first connectors that contradict each other are left to contacts. If that fails, it does not count as an
        // attempt.
        self.leaves_connectors = true;
        let first = self.attempt(problem, warm, solution, attempts.first);
        self.leaves_connectors = false;
        let goes_on = self.has_left_connectors && self.handed_over.is_none();
        let mut first = Some(first).filter(|outcome| outcome.is_ok() || !goes_on);
        let mut failure = None;
        for attempt in attempts.in_order() {
            let outcome = first.take().unwrap_or_else(|| self.attempt(problem, warm, solution, attempt));
            let error = match outcome {
                Ok(()) if self.owes_to_contacts(solution) => {
                    // An answer within rounding of the rows as given is preferred to one by least squares.
                    return self
                        .raise(problem, warm, solution)
                        .or_else(|_| self.attempt(problem, warm, solution, attempt));
                }
                Ok(()) => {
                    self.is_strained = attempt.dependence == attempts.strict.dependence;
                    return Ok(());
                }
                Err(error) if self.handed_over.is_some() => return Err(error),
                Err(error) => error,
            };
            let proven = self.settings.is_proven(&error, problem);
            // A certificate outweighs a failed attempt.
            if proven || failure.is_none() || matches!(error, SolveError::Infeasible(_)) {
                failure = Some(error);
            }
            if proven {
                break;
            }
        }
        Err(failure.expect("there is at least one attempt, and each gives an answer or an error"))
    }

    /// Makes a single attempt with modest forces; contradictions are settled by least squares.
    pub(crate) fn run_modestly(
        &mut self,
        problem: &Problem,
        start: Start<'_>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        let Settings { dependence, inconsistency, .. } = self.settings;
        let first = self.attempts().first;
        let attempt = Attempt { dependence, doubts: true, contradiction: inconsistency, ..first };
        self.attempt(problem, start, solution, attempt)
    }

    /// Makes only the strict attempt: the rows as given, with forces as large as necessary.
    pub(crate) fn run_strictly(
        &mut self,
        problem: &Problem,
        start: Start<'_>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        self.attempt(problem, start, solution, self.attempts().strict)
    }

    /// Does as [`run`](Self::run), but on a large problem stops if many pivots are in sight or were made, and returns
    /// the reason.
    pub(crate) fn run_or_hand_over(
        &mut self,
        problem: &Problem,
        start: Start<'_>,
        solution: &mut Solution,
    ) -> Result<Option<HandOver>, SolveError> {
        let Settings { hand_over_rows, pivoting_rows, selection, .. } = self.settings;
        self.may_hand_over = problem.len() >= hand_over_rows;
        let is_open = selection != ForceSelection::Pivoted && problem.len() >= pivoting_rows;
        self.patience = is_open.then_some(PATIENCE);
        let result = self.run(problem, start, solution);
        (self.may_hand_over, self.patience) = (false, None);
        match result {
            Err(SolveError::Unsolved { .. }) if self.handed_over.is_some() => Ok(self.handed_over),
            other => other.map(|()| None),
        }
    }

    /// Adds the work of a number of pivots.
    pub(crate) fn count_work(&mut self, pivots: usize) {
        self.work += pivots * self.work_of_pivot();
    }

    /// Work of a pivot, in passes over all rows, including one over the factor.
    pub(crate) fn work_of_pivot(&self) -> usize {
        ROW_PASSES + self.closed.factor.envelope() / self.closed.force.len().max(1)
    }

    /// Notes that another method is likely to be faster, once more work than the patience was done.
    pub(crate) fn is_out_of_patience(&mut self) -> bool {
        let is_out = self.patience.is_some_and(|patience| self.work > patience);
        if is_out {
            self.handed_over = Some(HandOver::Pivots);
        }
        is_out
    }

    /// The attempts by the settings.
    pub(crate) fn attempts(&self) -> Attempts {
        let Settings { dependence, least_dependence, inconsistency, natural_residual, .. } = self.settings;
        let as_given = natural_residual / 2.0;
        let usual = Attempt {
            dependence,
            doubts: false,
            contradiction: as_given,
            slight_swaps: MOST_SLIGHT,
            is_last: false,
        };
        let strict = Attempt { dependence: least_dependence, slight_swaps: MOST_SLIGHT_AT_LAST, ..usual };
        let least_squares = Attempt { contradiction: inconsistency, ..usual };
        let last = Attempt { is_last: true, ..least_squares };
        let first = match self.settings.contradiction {
            Contradiction::SolveExactly => usual,
            Contradiction::LeastSquares => least_squares,
        };
        Attempts { first, strict, last }
    }

    fn attempt(
        &mut self,
        problem: &Problem,
        warm: Start<'_>,
        solution: &mut Solution,
        attempt: Attempt,
    ) -> Result<(), SolveError> {
        self.prepare(problem, warm, solution, attempt);
        let goes_down = self.knows_forces && self.may_descend();
        let certificate = if goes_down { None } else { self.find_start(problem) };
        let end = match certificate {
            Some(certificate) => End::Infeasible(certificate),
            None if self.handed_over.is_some() => End::Stopped,
            None => {
                if goes_down {
                    self.descend()
                } else {
                    self.untangle()
                }
                self.make_forces_admissible();
                if self.is_out_of_patience() { End::Stopped } else { self.pivot(problem, attempt) }
            }
        };
        if attempt.is_last {
            self.shift.count_rest(&self.closed);
        }
        let result = self.finish(problem, solution, end);
        if result.is_ok() && self.settings.selection == ForceSelection::LeastNorm {
            self.select_least_norm(problem, solution, attempt);
        }
        result
    }

    /// Loads the problem and chooses the rows to start with.
    pub(crate) fn prepare(
        &mut self,
        problem: &Problem,
        warm: Start<'_>,
        solution: &mut Solution,
        attempt: Attempt,
    ) {
        solution.reset(problem.len(), Method::DualActiveSet);
        self.closed.load(problem, attempt.dependence, attempt.doubts);
        self.shift.reset();
        self.contacts_contradict = false;
        (self.has_left_connectors, self.is_strained) = (false, false);
        (self.pivots, self.work, self.slight_swaps) = (0, 0, 0);
        self.handed_over = None;
        self.choose_start(problem, warm);
    }

    /// Closes the open row that closes fastest until none closes, then refines.
    pub(crate) fn pivot(&mut self, problem: &Problem, attempt: Attempt) -> End {
        let mut refinements = 0;
        loop {
            let noise = self.noise();
            if let Some(row) = self.worst_open_row(problem, noise) {
                if self.closed.spread > 0.0 {
                    self.gather_forces();
                    continue;
                }
                match self.drive(row, attempt) {
                    End::Done => self.narrow_factor(),
                    other => return other,
                }
            } else if self.closed.terms_bound {
                // No row is wrong beyond the bound on rounding: check again with the rounding itself.
                self.closed.accelerate();
            } else if refinements < self.settings.refinements && self.closed.closed_error() > REFINED * noise
            {
                refinements += 1;
                self.closed.refine();
                self.closed.accelerate();
            } else if self.exchange_connector(noise) {
                refinements = 0;
            } else {
                return End::Done;
            }
        }
    }

    /// Closes the dependent bilateral row with the largest acceleration in place of the closed one with the largest
    /// share in it, if that exceeds `LARGER`. The closed rows are then farther from dependent on each other, by that
    /// factor at least, and magnify the rounding of their forces less (M. Gu, S. Eisenstat, "Efficient algorithms for
    /// computing a strong rank-revealing QR factorization", SIAM Journal on Scientific Computing 17, 1996, 848-869).
    /// Returns whether it did.
    fn exchange_connector(&mut self, noise: f64) -> bool {
        let closed = &mut self.closed;
        let open = (0..closed.free.len()).filter(|&row| closed.free[row] && !closed.is_closed(row));
        let worst =
            open.max_by(|&p, &q| closed.acceleration[p].abs().total_cmp(&closed.acceleration[q].abs()));
        let Some(row) = worst.filter(|&row| closed.acceleration[row].abs() > noise) else { return false };
        closed.consider(row);
        closed.find_response();
        let connectors = (0..closed.len()).filter(|&at| closed.free[closed.rows[at]]);
        let most = connectors.max_by(|&p, &q| closed.step[p].abs().total_cmp(&closed.step[q].abs()));
        let Some(at) = most.filter(|&at| closed.step[at].abs() > LARGER) else { return false };
        self.pivots += 1;
        closed.kept -= usize::from(at < closed.kept);
        closed.open_at(at);
        closed.try_close(row);
        closed.solve_closed();
        closed.accelerate();
        self.make_forces_admissible();
        true
    }

    /// The open row that closes fastest, if any does.
    fn worst_open_row(&self, problem: &Problem, noise: f64) -> Option<usize> {
        let mut worst = -noise;
        let mut found = None;
        for (row, &a) in self.closed.acceleration.iter().enumerate() {
            if a < worst && !self.closed.is_closed(row) && !problem.bilateral[row] {
                worst = a;
                found = Some(row);
            }
        }
        found
    }

    /// Raises the force of an open row until its acceleration is zero, opening rows whose force runs out.
    fn drive(&mut self, row: usize, attempt: Attempt) -> End {
        loop {
            self.pivots += 1;
            self.count_work(1);
            let is_capped = self.pivots > self.settings.pivot_cap(self.closed.force.len());
            if is_capped || self.is_out_of_patience() {
                return End::Stopped;
            }
            let relation = self.closed.consider(row);
            self.closed.find_response();
            let full = if relation.dependent {
                f64::INFINITY
            } else {
                // If rounding has made the acceleration positive, the force goes back, but not below zero.
                (-self.closed.acceleration[row] / relation.complement).max(-self.closed.force[row])
            };
            let rounding = if relation.dependent { self.rounding_of_response() } else { BLOCKING };
            match self.blocking(full, rounding) {
                Some(_) if relation.dependent && self.swaps_in_circles(row, attempt) => return End::Stopped,
                Some((at, length)) => {
                    self.advance(row, length);
                    self.closed.acceleration[row] += length * relation.complement.max(0.0);
                    self.closed.open_at(at);
                }
                None if relation.dependent => return self.resolve_contradiction(row, attempt),
                None => {
                    self.advance(row, full);
                    self.closed.close(row, relation);
                    self.closed.accelerate_roughly();
                    return End::Done;
                }
            }
        }
    }

    /// Counts an exchange of a dependent row for a closed one if its gain is slight; true if there were too many.
    fn swaps_in_circles(&mut self, row: usize, attempt: Attempt) -> bool {
        let is_slight = self.closed.acceleration[row] > -SLIGHT * self.noise();
        self.slight_swaps += usize::from(is_slight);
        self.slight_swaps > attempt.slight_swaps
    }

    /// Rounding of the components of the null direction just found. It is enlarged where the closed rows nearly depend
    /// on each other, by the reciprocal of the least remainder of a closed row's square.
    fn rounding_of_response(&self) -> f64 {
        let closed = &self.closed;
        let largest = closed.step[..closed.len()].iter().fold(1.0, |m: f64, z| m.max(z.abs()));
        let inverse = closed.factor.largest_inverse_diagonal();
        (BLOCKING * (inverse * inverse).max(1.0)).min(LARGEST_ROUNDING) * largest
    }

    /// The first unilateral force to vanish within a step of length `limit`, among those that it changes by more than
    /// `rounding`: its position and the length.
    fn blocking(&self, limit: f64, rounding: f64) -> Option<(usize, f64)> {
        let closed = &self.closed;
        let mut found = None;
        let mut shortest = limit;
        for (at, &row) in closed.rows.iter().enumerate() {
            if closed.step[at] > rounding && !closed.free[row] {
                let length = closed.force[row] / closed.step[at];
                if length < shortest {
                    shortest = length;
                    found = Some((at, length));
                }
            }
        }
        found
    }

    fn advance(&mut self, row: usize, length: f64) {
        let closed = &mut self.closed;
        for (at, &other) in closed.rows.iter().enumerate() {
            closed.force[other] -= length * closed.step[at];
        }
        closed.force[row] += length;
    }

    /// Settles a contradiction along the null direction just found if it is rounding, or returns the proof that there
    /// is no solution.
    fn resolve_contradiction(&mut self, row: usize, attempt: Attempt) -> End {
        let limit = attempt.contradiction * self.closed.system.scale;
        match self.shift.reconcile(&mut self.closed, row, limit, self.settings.least_growth) {
            Reconciled::Infeasible(certificate) => End::Infeasible(certificate),
            Reconciled::Unproven => End::Unproven,
            Reconciled::Shifted => {
                self.contacts_contradict = true;
                let (held, before) = (self.closed.len(), self.closed.acceleration[row]);
                let had_force = std::mem::take(&mut self.closed.force[row]) > 0.0;
                self.closed.solve_closed();
                self.closed.accelerate();
                self.make_forces_admissible();
                // A shift that leaves this row and all others as they were would be repeated for ever.
                let is_as_before = !had_force && self.closed.len() == held;
                let is_stuck = is_as_before && self.closed.acceleration[row] < STUCK * before;
                if is_stuck { End::Stopped } else { End::Done }
            }
        }
    }

    /// Scaled acceleration that may be rounding, or is too small to matter.
    pub(crate) fn noise(&self) -> f64 {
        let scale = self.closed.system.scale;
        self.settings.rounding * (scale + self.closed.terms) + self.settings.open_tolerance * scale
    }

    /// Turns the scaled forces into an answer and checks it.
    pub(crate) fn finish(
        &mut self,
        problem: &Problem,
        solution: &mut Solution,
        end: End,
    ) -> Result<(), SolveError> {
        let is_answer = match end {
            End::Infeasible(certificate) => return Err(SolveError::Infeasible(certificate)),
            End::Done | End::Stopped => true,
            End::Unproven => false,
        };
        let closed = &self.closed;
        for (row, out) in solution.force.iter_mut().enumerate() {
            let force = closed.force[row] / closed.system.row_scale[row];
            // A unilateral force that rounding has left below zero is zero.
            *out = if closed.free[row] { force } else { pushing(force) };
        }
        solution.active.extend_from_slice(&closed.rows);
        solution.active.sort_unstable();
        solution.iterations = self.pivots;
        solution.inconsistency = self.shift.inconsistency(closed.system.scale);
        let Solution { force, acceleration, .. } = solution;
        solution.residuals =
            self.checker.check_with(&self.closed.system.entries, problem, force, acceleration);
        if is_answer && solution.residuals.accepted(&self.settings, solution.inconsistency) {
            return Ok(());
        }
        Err(SolveError::Unsolved {
            method: Method::DualActiveSet,
            residuals: solution.residuals,
            iterations: self.pivots,
        })
    }
}

impl Solver for DualActiveSet {
    fn method(&self) -> Method {
        Method::DualActiveSet
    }

    fn solve(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError> {
        self.run(problem, Start::Nothing, solution)
    }

    fn solve_from(
        &mut self,
        problem: &Problem,
        start: &WarmStart,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        self.run(problem, Start::Earlier(start), solution)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::{InverseInertia, Row};

    #[test]
    fn rows_that_all_but_depend_on_each_other_do_not_swap_for_ever() {
        /// Distance [m] by which the second row acts farther out; its square is the remainder of the row.
        const FARTHER: f64 = 2.5e-6;
        /// Forces [N] of the two rows.
        const FORCES: [f64; 2] = [4.0, 6.0];
        let mut problem = Problem::new();
        let inertia = InverseInertia { inverse_mass: 1.0, inverse_moment: 1.0 };
        let body = problem.add_body(inertia).expect("a body");
        let together = FORCES[0] + FORCES[1];
        for (arm, own) in [(0.0, 0.0), (FARTHER, FARTHER * FARTHER * FORCES[1])] {
            problem.add_row(&Row::new(body, [0.0, 1.0, arm], -together - own)).expect("a row");
        }
        let (mut solver, mut solution) = (DualActiveSet::default(), Solution::new());
        let first = solver.attempts().first;
        assert!(solver.attempt(&problem, Start::Nothing, &mut solution, first).is_err());
        assert!(solver.pivots < 40, "{} pivots", solver.pivots);
        solver.solve(&problem, &mut solution).expect("two independent rows");
        let errors = [0, 1].map(|row: usize| (solution.force[row] / FORCES[row] - 1.0).abs());
        assert!(errors.iter().all(|error| *error < 1e-3), "{:?}", solution.force);
    }
}
