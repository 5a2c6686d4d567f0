//! The automatic choice of a method.
//!
//! Unsymmetric problems go to Lemke's method. Of the others, independent islands are solved one by one, each by the
//! dual active set, unless it is large and its contacts are so redundant that many pivots are in sight, or were made:
//! then by the proximal method, which begins from an interior point in the second case. If the first choice fails its
//! check, the others are tried, at last Lemke's with twice as many digits. The reasons and the measurements are in the
//! project's `docs/contact.md`.

use crate::check::Checker;
use crate::dual_active_set::{DualActiveSet, HandOver};
use crate::error::{SettingsError, SolveError};
use crate::islands::{Islands, KEPT};
use crate::lemke::Lemke;
use crate::problem::Problem;
use crate::proximal_newton::ProximalNewton;
#[cfg(feature = "qp")]
use crate::qp::Qp;
use crate::settings::{Contradiction, ForceSelection, Settings};
use crate::solution::Solution;
use crate::solver::{Method, Solver};
use crate::start::Start;
use crate::warm::WarmStart;

/// Rows below which looking for islands costs more than it gains: the factor of a few islands is as narrow.
const SPLIT_ROWS: usize = 48;

/// Rows up to which Lemke's method is worth a last try on a symmetric problem.
const LAST_RESORT_ROWS: usize = 400;

/// Rows up to which large forces are compared with those found with twice as many digits: beyond, that takes milliseconds.
const RELAXED_ROWS: usize = 32;

/// Growth from which they are compared: forces that are large because rows nearly depend on each other, and any.
const STRAINED: f64 = 1e6;
const MUCH_STRAINED: f64 = 1e9;

/// Leakage of a proof that is no more than the rounding of its own numbers.
const CLEAR: f64 = 16.0 * f64::EPSILON;

/// Chooses a method, and another if that fails.
#[derive(Clone, Debug, Default)]
pub struct Auto {
    settings: Settings,
    islands: Islands,
    part: Solution,
    part_start: WarmStart,
    /// Rows that carry force in an island that was solved.
    carries: Vec<bool>,
    methods: Methods,
    /// The same for each of the first islands.
    by_island: Vec<Methods>,
    checker: Checker,
}

#[derive(Clone, Debug, Default)]
struct Methods {
    settings: Settings,
    dual: DualActiveSet,
    proximal: ProximalNewton,
    #[cfg(feature = "qp")]
    qp: Qp,
    lemke: Lemke,
    /// The last problem was handed over to the proximal method.
    was_handed_over: bool,
    /// The last answer is one of nearly dependent rows, with forces as large as that takes.
    is_strained: bool,
    /// A second answer, to be compared with the first.
    other: Solution,
}

impl Auto {
    /// A solver with these settings.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] names a number that is not usable.
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        let methods = Methods::new(settings)?;
        Ok(Auto { settings, methods, ..Self::default() })
    }

    fn run(
        &mut self,
        problem: &Problem,
        warm: Option<&WarmStart>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        let islands = if problem.len() < SPLIT_ROWS { 1 } else { self.islands.find(problem) };
        if islands > 1 {
            return self.solve_islands(problem, islands, warm, solution);
        }
        self.methods.solve(problem, warm, solution)?;
        if problem.len() < SPLIT_ROWS && self.methods.is_left_in_doubt(problem, solution) {
            return self.look_at_islands(problem, warm, solution);
        }
        Ok(())
    }

    /// Solves again a problem that was not split, if it can be: its islands may be small enough to be looked at.
    #[cold]
    fn look_at_islands(
        &mut self,
        problem: &Problem,
        warm: Option<&WarmStart>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        let islands = self.islands.find(problem);
        if islands > 1 { self.solve_islands(problem, islands, warm, solution) } else { Ok(()) }
    }

    fn solve_islands(
        &mut self,
        problem: &Problem,
        islands: usize,
        warm: Option<&WarmStart>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        solution.reset(problem.len(), Method::Auto);
        self.carries.clear();
        self.carries.resize(problem.len(), false);
        for island in 0..islands {
            match self.solve_island(problem, island, warm, solution) {
                Err(SolveError::Infeasible(proof)) => {
                    let proof = self.islands.proof_of_whole(problem, island, *proof);
                    // What is a contradiction beside the offsets of an island may be rounding beside those of all rows.
                    let outcome = self.methods.solve(problem, warm, solution);
                    let is_proof = proof.contradiction > self.settings.inconsistency
                        && proof.least_growth() >= self.settings.least_growth;
                    // A solution refutes it if rounding is not all that it leaks by, or with smaller forces than it allows.
                    let is_doubtful =
                        proof.leakage > CLEAR || solution.residuals.growth < proof.least_growth();
                    let is_refuted = outcome.is_ok() && is_doubtful;
                    if is_proof && !is_refuted {
                        return Err(SolveError::Infeasible(Box::new(proof)));
                    }
                    return outcome;
                }
                other => other?,
            }
        }
        solution.active.extend((0..problem.len()).filter(|&row| self.carries[row]));
        solution.residuals = self.checker.check(problem, &solution.force, &mut solution.acceleration);
        if solution.residuals.accepted(&self.settings, solution.inconsistency) {
            return Ok(());
        }
        // Growth is judged against the offsets of all rows: an island's forces may be too small for it.
        self.methods.solve(problem, warm, solution)
    }

    fn solve_island(
        &mut self,
        problem: &Problem,
        island: usize,
        warm: Option<&WarmStart>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        let start = warm.map(|warm| {
            self.part_start.restrict(warm, problem, self.islands.rows(island));
            &self.part_start
        });
        let problem_part = self.islands.part(problem, island);
        let slot = island.min(KEPT - 1);
        while self.by_island.len() <= slot {
            self.by_island.push(Methods::new(self.settings).expect("the settings were checked before"));
        }
        let methods = &mut self.by_island[slot];
        let result = methods.solve(problem_part, start, &mut self.part);
        let rows = self.islands.rows(island);
        result?;
        for (&row, &force) in rows.iter().zip(&self.part.force) {
            solution.force[row as usize] = force;
        }
        self.part.active.iter().for_each(|&at| self.carries[rows[at] as usize] = true);
        solution.iterations += self.part.iterations;
        solution.inconsistency = solution.inconsistency.max(self.part.inconsistency);
        solution.method = match island {
            0 => self.part.method,
            _ if solution.method == self.part.method => solution.method,
            _ => Method::Auto,
        };
        Ok(())
    }
}

impl Methods {
    fn new(settings: Settings) -> Result<Self, SettingsError> {
        Ok(Methods {
            settings,
            dual: DualActiveSet::new(settings)?,
            proximal: ProximalNewton::new(settings)?,
            #[cfg(feature = "qp")]
            qp: Qp::new(settings)?,
            lemke: Lemke::new(settings)?,
            was_handed_over: false,
            is_strained: false,
            other: Solution::new(),
        })
    }

    fn solve(
        &mut self,
        problem: &Problem,
        warm: Option<&WarmStart>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        if !problem.is_symmetric() {
            return self.lemke.solve(problem, solution);
        }
        let start = warm.map_or(Start::Nothing, Start::Earlier);
        let may_hand_over = problem.has_bodies() && self.settings.selection != ForceSelection::LeastNorm;
        // What was handed over a step ago is so again: the redundancy lies in the rows, which are the same.
        let was_handed_over = std::mem::take(&mut self.was_handed_over);
        let again = may_hand_over && was_handed_over && warm.is_some() && self.proximal.is_loaded(problem);
        let first = if again {
            Ok(Some(HandOver::Redundant))
        } else if may_hand_over {
            self.dual.run_or_hand_over(problem, start, solution)
        } else {
            self.dual.run(problem, start, solution).map(|()| None)
        };
        self.is_strained = first.is_ok() && self.dual.is_strained;
        let outcome = match first {
            Ok(None) => Ok(()),
            Ok(Some(reason)) => {
                self.was_handed_over = true;
                let found = match (reason, warm) {
                    (HandOver::Pivots, warm) => self.proximal.solve_inside(problem, warm, solution),
                    (HandOver::Redundant, Some(warm)) => self.proximal.solve_from(problem, warm, solution),
                    (HandOver::Redundant, None) => self.proximal.solve(problem, solution),
                };
                found
                    .and_then(|()| self.cross_over(problem, solution))
                    .or_else(|_| self.dual.run(problem, start, solution))
                    .or_else(|error| self.try_others(problem, solution, error))
            }
            Err(error) => self.try_others(problem, solution, error),
        };
        outcome.and_then(|()| self.relax(problem, solution))
    }

    /// Whether forces are so large that they are to be compared with those found with twice as many digits.
    fn is_to_be_relaxed(&self, solution: &Solution) -> bool {
        let least = if self.is_strained { STRAINED } else { MUCH_STRAINED };
        solution.residuals.growth >= least && self.settings.contradiction == Contradiction::SolveExactly
    }

    /// The same of the last answer, where the problem was too large for it.
    fn is_left_in_doubt(&self, problem: &Problem, solution: &Solution) -> bool {
        problem.is_symmetric() && problem.len() > RELAXED_ROWS && self.is_to_be_relaxed(solution)
    }

    /// Where nearly dependent rows were solved by large forces, contacts may have been judged by what rounding leaves of
    /// these, and by forces that are larger still rows that have no solution at all: looks with twice as many digits.
    fn relax(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError> {
        if problem.len() > RELAXED_ROWS || !self.is_to_be_relaxed(solution) {
            return Ok(());
        }
        let is_found = self.lemke.solve_twofold(problem, &mut self.other);
        if is_found.map_err(|proof| SolveError::Infeasible(Box::new(proof)))?
            && self.other.inconsistency == 0.0
            && self.other.residuals.natural < solution.residuals.natural
        {
            std::mem::swap(solution, &mut self.other);
        }
        Ok(())
    }

    /// Moves forces that are shared to independent rows, if they are to be those of a vertex.
    fn cross_over(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError> {
        if self.settings.selection != ForceSelection::Vertex {
            return Ok(());
        }
        self.dual.cross_over(problem, solution)
    }

    /// Another method, where the first one came to nothing; its error stands if none helps.
    fn try_others(
        &mut self,
        problem: &Problem,
        solution: &mut Solution,
        error: SolveError,
    ) -> Result<(), SolveError> {
        if self.settings.is_proven(&error, problem) {
            return Err(error);
        }
        self.refine(problem, &error)?;
        if self.proximal.solve(problem, solution).is_ok() {
            return Ok(());
        }
        // Where there is no solution, its forces have grown along a direction that proves it.
        if solution.residuals.growth >= self.settings.least_growth {
            self.refine_direction(problem, &solution.force)?;
        }
        #[cfg(feature = "qp")]
        if self.qp.solve(problem, solution).is_ok() {
            return Ok(());
        }
        if problem.len() <= LAST_RESORT_ROWS {
            match self.lemke.solve(problem, solution) {
                Ok(()) => return Ok(()),
                Err(proof) if self.lemke.is_certain || self.settings.is_proven(&proof, problem) => {
                    return Err(proof);
                }
                Err(proof) => self.refine(problem, &proof)?,
            }
        }
        Err(error)
    }

    /// An error if a proof that leaves doubt can be refined to one that leaves none.
    #[cold]
    fn refine(&mut self, problem: &Problem, error: &SolveError) -> Result<(), SolveError> {
        match error {
            SolveError::Infeasible(proof) => self.refine_direction(problem, &proof.direction),
            _ => Ok(()),
        }
    }

    #[cold]
    fn refine_direction(&mut self, problem: &Problem, direction: &[f64]) -> Result<(), SolveError> {
        let proof = self.proximal.refine_proof(problem, direction);
        proof.map_or(Ok(()), |proof| Err(SolveError::Infeasible(Box::new(proof))))
    }
}

impl Solver for Auto {
    fn method(&self) -> Method {
        Method::Auto
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::{InverseInertia, Row};
    use crate::test_problems::{crooked_pyramid, pyramid};

    #[test]
    fn contacts_that_would_take_hundreds_of_pivots_are_handed_over() {
        let problem = crooked_pyramid(14);
        let (mut auto, mut dual) = (Auto::default(), DualActiveSet::default());
        let (mut found, mut pivoted) = (Solution::new(), Solution::new());
        auto.solve(&problem, &mut found).expect("forces of a pyramid");
        dual.solve(&problem, &mut pivoted).expect("forces of a pyramid");
        assert_eq!(found.method, Method::ProximalNewton);
        assert!(10 * found.iterations < pivoted.iterations, "{}, {}", found.iterations, pivoted.iterations);
        let errors = found.acceleration.iter().zip(&pivoted.acceleration).map(|(a, b)| (a - b).abs());
        assert!(errors.fold(0.0, f64::max) < 1e-9);
        // Forces that are to be those of independent rows are moved to such.
        let settings = Settings { selection: ForceSelection::Vertex, ..Settings::default() };
        let mut auto = Auto::new(settings).expect("fine settings");
        auto.solve(&problem, &mut found).expect("forces of a pyramid");
        assert_eq!(found.method, Method::DualActiveSet);
        assert!(10 * found.iterations < pivoted.iterations, "{}, {}", found.iterations, pivoted.iterations);
        let carrying = found.force.iter().filter(|force| **force > 0.0).count();
        assert_eq!(carrying, pivoted.active.len());
        let errors = found.acceleration.iter().zip(&pivoted.acceleration).map(|(a, b)| (a - b).abs());
        assert!(errors.fold(0.0, f64::max) < 1e-9);
    }

    #[test]
    fn pivots_in_sight_are_not_waited_for() {
        let (mut dual, mut found) = (DualActiveSet::default(), Solution::new());
        let outcome = dual.run_or_hand_over(&crooked_pyramid(14), Start::Nothing, &mut found);
        assert!(matches!(outcome, Ok(Some(HandOver::Pivots))), "{outcome:?}");
        assert_eq!(dual.pivots, 0);
        // A box on a floor has many wrong rows, too, but a pivot rights many of them.
        let mut floor = Problem::new();
        let body = floor.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 6.0 }).expect("a body");
        for place in 0..200 {
            let arm = f64::from(place) / 199.0 - 0.5;
            let unevenness = 1e-3 * f64::from(place % 7);
            floor.add_row(&Row::new(body, [0.0, 1.0, arm], unevenness - 9.81)).expect("a row");
        }
        Auto::default().solve(&floor, &mut found).expect("forces of a box");
        assert_eq!(found.method, Method::DualActiveSet);
    }

    #[test]
    fn what_takes_no_pivots_is_not() {
        let (mut auto, mut solution) = (Auto::default(), Solution::new());
        auto.solve(&pyramid(14, 0.5), &mut solution).expect("forces of a pyramid");
        assert_eq!((solution.method, solution.iterations), (Method::DualActiveSet, 0));
    }
}
