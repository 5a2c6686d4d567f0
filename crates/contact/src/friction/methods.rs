//! The order of methods for problems with friction.

use super::enumeration::{Tried, enumerate};
use super::modes::Modes;
use super::recognition::Recognised;
use crate::error::{SettingsError, SolveError};
use crate::lemke::Lemke;
use crate::problem::Problem;
use crate::settings::Settings;
use crate::solution::Solution;
use crate::solver::Solver;
use crate::warm::WarmStart;

/// Largest number of rows that Lemke's method tries: its tableau is full, and with more it takes minutes.
const LEMKE_ROWS: usize = 1000;

/// The methods for problems with friction, one after the other.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct FrictionMethods {
    settings: Settings,
    modes: Modes,
    lemke: Lemke,
    warm: WarmStart,
    refined: Solution,
}

impl FrictionMethods {
    pub(crate) fn new(settings: Settings) -> Result<Self, SettingsError> {
        Ok(Self { settings, modes: Modes::new(settings)?, lemke: Lemke::new(settings)?, ..Self::default() })
    }

    /// Accepts answers with a natural residual up to this.
    pub(crate) fn set_natural_residual(&mut self, natural_residual: f64) {
        self.settings.natural_residual = natural_residual;
        self.modes.set_natural_residual(natural_residual);
        self.lemke.set_natural_residual(natural_residual);
    }

    /// Solves a problem that was recognised, by modes.
    pub(crate) fn solve_recognised(&mut self, recognised: &Recognised, force: &mut [f64]) -> bool {
        recognised.solve(&mut self.modes, force)
    }

    /// Solves by Lemke's method alone; false if it finds no answer.
    pub(crate) fn solve_by_lemke(&mut self, problem: &Problem, solution: &mut Solution) -> bool {
        let is_solved = self.lemke.solve(problem, solution).is_ok();
        if is_solved {
            self.refine(problem, solution);
        }
        is_solved
    }

    /// Replaces an answer by that of its modes, if these have one: rows at rest are so to rounding then.
    fn refine(&mut self, problem: &Problem, solution: &mut Solution) {
        self.warm.guess_forces(solution.force.iter().map(|&force| Some(force)));
        if self.modes.solve_near(problem, &self.warm, &mut self.refined).is_ok() {
            let method = solution.method;
            std::mem::swap(solution, &mut self.refined);
            solution.method = method;
        }
    }

    /// Solves by modes; else by Lemke's method, which may prove that there is no solution; else by trying all modes.
    pub(crate) fn solve(
        &mut self,
        problem: &Problem,
        warm: Option<&WarmStart>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        let found = match warm {
            Some(warm) => self.modes.solve_from(problem, warm, solution),
            None => self.modes.solve(problem, solution),
        };
        let Err(error) = found else { return Ok(()) };
        if problem.len() > LEMKE_ROWS {
            return Err(error);
        }
        let error = match self.lemke.solve(problem, solution) {
            Ok(()) => {
                self.refine(problem, solution);
                return Ok(());
            }
            Err(proof @ SolveError::Infeasible(_)) => return Err(proof),
            Err(_) => error,
        };
        match enumerate(problem, &self.settings, solution) {
            Tried::Found => Ok(()),
            Tried::None(combinations) => Err(SolveError::NoModes { combinations }),
            Tried::TooMany => Err(error),
        }
    }
}
