//! The solver by modes: by those of an earlier answer, else by descent from its forces or from none, then by the modes
//! found.

use super::descent::Descent;
use super::equations::Equations;
use super::mode;
use super::scaled_rows::ScaledRows;
use super::settle::Settle;
use crate::check::Checker;
use crate::error::{SettingsError, SolveError};
use crate::kind::RowKind;
use crate::problem::{Problem, pushing};
use crate::settings::Settings;
use crate::solution::Solution;
use crate::solver::{Method, Solver};
use crate::warm::WarmStart;

/// ε [-] with which modes are solved: rows are scaled to 1, and with less the digits of M would be lost beside those of
/// Jᵀ J/ε; with more, dependent rows would take more corrections.
const LEAST: f64 = 1e-8;
/// ε [-] of a new start, the most, and the finest of a descent, whose forces have their rounding over ε.
const FIRST: f64 = 1.0;
const MOST: f64 = 1e3;
const FINEST: f64 = 1e-4;
/// ε [-] from which on forces tell the modes of the problem: those of rows at rest are known to this share of the load.
const TELLING: f64 = 1e-3;
/// Factor of ε after a round that succeeds, after one that fails, and of the ε that failed with each later success.
const EASIER: f64 = 3.0;
const HARDER: f64 = 0.2;
const FORGOTTEN: f64 = 0.7;
/// Imbalance [-] in units of ε, of the residual before, and of the load, at which a round ends: modes change with less only
/// where they do not matter.
const ENOUGH: f64 = 1e-3;
/// Cap on rounds. Walls and heaps take some tens; from a thousand on none was seen to end.
const ROUNDS: usize = 1000;
/// Cap on rounds with few rows, for which there are other methods; and how many rows are few.
const FEW_ROUNDS: usize = 40;
const FEW_ROWS: usize = 64;
/// Cap on repeated corrections of forces with the right modes: one does, unless masses are far apart.
const CORRECTIONS: usize = 10;

/// Modes of friction by Newton's method, for problems with rows of all kinds.
///
/// A mode tells whether a row is open, held (closed, sticking) or at a bound (slipping). With modes known the forces are
/// linear equations, solved in the space of the bodies, where rows that depend on each other do no harm. From an earlier
/// answer whose modes are still right a single factorisation does. Not every solution is found; problems at velocity
/// level always have one. The sources are named in the modules.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Modes {
    settings: Settings,
    rows: ScaledRows,
    equations: Equations,
    settle: Settle,
    descent: Descent,
    /// Scaled forces, and those to go back to.
    force: Vec<f64>,
    kept: Vec<f64>,
    checker: Checker,
    iterations: usize,
}

impl Modes {
    /// Makes a solver with the given settings.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] names a setting that is not positive and finite.
    #[inline]
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings, ..Self::default() })
    }

    /// Solves a problem from forces near those of its answer, and gives up soon where their modes, corrected a few times, are not those
    /// of an answer: for callers that have another way.
    ///
    /// # Errors
    ///
    /// [`SolveError::Unsolved`].
    pub fn solve_near(
        &mut self,
        problem: &Problem,
        start: &WarmStart,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        self.load(problem, start);
        if self.settle(problem, solution) { Ok(()) } else { Err(self.unsolved(solution)) }
    }

    /// Accepts answers with a natural residual up to this.
    pub(crate) fn set_natural_residual(&mut self, natural_residual: f64) {
        self.settings.natural_residual = natural_residual;
    }

    fn run(
        &mut self,
        problem: &Problem,
        warm: Option<&WarmStart>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        if let Some(warm) = warm {
            self.load(problem, warm);
            self.kept.clone_from(&self.force);
            if self.settle(problem, solution) {
                return Ok(());
            }
            self.force.clone_from(&self.kept);
            if self.descend(problem, solution) {
                return Ok(());
            }
        } else {
            self.iterations = 0;
            self.rows.load(problem);
        }
        self.force.clear();
        self.force.resize(problem.len(), 0.0);
        if self.descend(problem, solution) {
            return Ok(());
        }
        Err(self.unsolved(solution))
    }

    /// Loads a problem, and the forces from which it is solved.
    fn load(&mut self, problem: &Problem, warm: &WarmStart) {
        self.iterations = 0;
        self.rows.load(problem);
        let lookup = warm.lookup(problem);
        let earlier = |row: usize| lookup.find(row).map_or(0.0, |earlier| earlier.force);
        self.force.clear();
        self.force.extend((0..problem.len()).map(|row| earlier(row) * self.rows.scale[row]));
    }

    fn unsolved(&self, solution: &Solution) -> SolveError {
        let (residuals, iterations) = (solution.residuals, self.iterations);
        SolveError::Unsolved { method: Method::Modes, residuals, iterations }
    }

    /// Goes on from the modes of the present forces. True if that ends with an accepted answer.
    fn settle(&mut self, problem: &Problem, solution: &mut Solution) -> bool {
        let enough = 0.1 * self.settings.natural_residual;
        let mut best = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            let found = self.settle.run(
                &self.rows,
                &mut self.equations,
                &mut self.force,
                [LEAST, enough],
                &mut self.iterations,
            );
            let Some(residual) = found else { return false };
            if self.is_accepted(problem, solution) {
                return true;
            }
            // Corrections that no longer help.
            if residual.is_nan() || residual >= 0.5 * best {
                return false;
            }
            best = residual;
        }
        false
    }

    /// Starts from the present forces, or from none, and makes ε less round by round.
    #[cold]
    fn descend(&mut self, problem: &Problem, solution: &mut Solution) -> bool {
        let load = self.rows.load_size();
        let (mut epsilon, mut floor, mut rest) = (FIRST, FINEST, 1.0);
        for _ in 0..if problem.len() > FEW_ROWS { ROUNDS } else { FEW_ROUNDS } {
            let enough = ENOUGH * epsilon.min(TELLING).min(rest) * load;
            let (rows, equations) = (&self.rows, &mut self.equations);
            let numbers = [epsilon, enough];
            if !self.descent.run(rows, equations, &mut self.force, numbers, &mut self.iterations) {
                if epsilon > MOST {
                    break;
                }
                epsilon *= EASIER;
                floor = epsilon;
                continue;
            }
            if epsilon <= TELLING {
                self.kept.clone_from(&self.force);
                let is_accepted = self.is_accepted(problem, solution);
                rest = solution.residuals.natural;
                // With modes, rows at rest are so to rounding.
                if self.settle(problem, solution) {
                    return true;
                }
                self.force.clone_from(&self.kept);
                if is_accepted {
                    return self.is_accepted(problem, solution);
                }
            }
            epsilon = (HARDER * epsilon).max(floor);
            floor = (FORGOTTEN * floor).max(FINEST);
        }
        self.is_accepted(problem, solution)
    }

    /// Checks the forces, cut to their bounds, as the answer.
    fn is_accepted(&mut self, problem: &Problem, solution: &mut Solution) -> bool {
        solution.reset(problem.len(), Method::Modes);
        if self.force.iter().any(|force| !force.is_finite()) {
            return false;
        }
        for row in 0..problem.len() {
            let force = mode::cut(&self.rows, row, &self.force);
            solution.force[row] = force / self.rows.scale[row];
        }
        for (row, kind) in problem.further.kinds() {
            if let RowKind::Friction { normal, coefficient } = kind {
                let most = coefficient * pushing(solution.force[normal]);
                solution.force[row] = solution.force[row].clamp(-most, most);
            }
        }
        solution.residuals = self.checker.check(problem, &solution.force, &mut solution.acceleration);
        solution.iterations = self.iterations;
        let is_accepted = solution.residuals.accepted(&self.settings, 0.0);
        if is_accepted {
            solution.active.extend((0..problem.len()).filter(|&row| {
                let (least, most) = mode::bounds(&self.rows, row, &self.force);
                problem.bilateral[row] || (least < self.force[row] && self.force[row] < most)
            }));
        }
        is_accepted
    }
}

impl Solver for Modes {
    fn method(&self) -> Method {
        Method::Modes
    }

    fn solve(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError> {
        self.run(problem, None, solution)
    }

    fn solve_from(
        &mut self,
        problem: &Problem,
        start: &WarmStart,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        self.run(problem, Some(start), solution)
    }
}
