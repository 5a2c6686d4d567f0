//! The automatic choice of a method; see [`Auto`].
//!
//! The reasons for the choices and the measurements are in the project's `docs/contact.md`.

use crate::check::Checker;
use crate::dual_active_set::{DualActiveSet, HandOver};
use crate::error::{SettingsError, SolveError};
use crate::friction::{FrictionMethods, Recognised};
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

/// Number of rows from which islands are looked for first. With fewer rows that costs more than it gains, as the factor
/// of a few islands together is as narrow.
const SPLIT_ROWS: usize = 48;

/// Number of rows from which contacts with friction are looked for in a general problem: with fewer Lemke's method is as
/// fast.
const RECOGNISED_ROWS: usize = 24;

/// Largest number of rows of a symmetric problem on which Lemke's method is tried last.
const LAST_RESORT_ROWS: usize = 400;

/// Largest number of rows for which large forces are compared with those found with twice as many digits; with more
/// rows that takes milliseconds.
const RELAXED_ROWS: usize = 32;

/// Growth from which forces are so compared if they are large because rows nearly depend on each other.
const STRAINED: f64 = 1e6;
/// Growth from which any forces are so compared.
const MUCH_STRAINED: f64 = 1e9;

/// Largest leakage [-] of a proof that may be the rounding of its own numbers.
const CLEAR: f64 = 16.0 * f64::EPSILON;

/// Solver that chooses a method by size and structure, and another one if that fails.
///
/// Problems with friction go to [`Modes`](crate::Modes), then to [`Lemke`], which unsymmetric ones go to at once unless they are
/// contacts with friction written out. Others are split into independent islands, solved one by one by the
/// [`DualActiveSet`]. Large islands whose contacts are so redundant that many pivots are in sight, or were made, go to
/// [`ProximalNewton`], in the second case from an interior point. If an answer fails its check, the other methods are
/// tried, at last Lemke's with twice as many digits.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Auto {
    settings: Settings,
    islands: Islands,
    part: Solution,
    part_start: WarmStart,
    /// Rows that carry force in an island that was solved.
    carries: Vec<bool>,
    methods: Methods,
    /// Solvers for each of the first islands.
    by_island: Vec<Methods>,
    checker: Checker,
    friction: FrictionMethods,
}

#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Methods {
    settings: Settings,
    dual: DualActiveSet,
    proximal: ProximalNewton,
    #[cfg(feature = "qp")]
    qp: Qp,
    lemke: Lemke,
    /// True if the last problem was handed over to the proximal method.
    was_handed_over: bool,
    /// True if the last answer took nearly dependent rows as independent, with forces as large as that needs.
    is_strained: bool,
    /// A second answer, to be compared with the first.
    other: Solution,
}

impl Auto {
    /// Makes a solver with the given settings.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] names a setting that is not positive and finite.
    #[inline]
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        let (methods, friction) = (Methods::new(settings)?, FrictionMethods::new(settings)?);
        Ok(Auto { settings, methods, friction, ..Self::default() })
    }

    fn run(
        &mut self,
        problem: &Problem,
        warm: Option<&WarmStart>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        if !problem.is_plain() {
            return self.friction.solve(problem, warm, solution);
        }
        if !problem.is_symmetric() && problem.len() >= RECOGNISED_ROWS && self.recognise(problem, solution) {
            return Ok(());
        }
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

    /// Solves a general problem by the contacts with friction that it is made of. False if it is none, or none is found.
    #[cold]
    fn recognise(&mut self, problem: &Problem, solution: &mut Solution) -> bool {
        let Some(recognised) = Recognised::of(problem) else { return false };
        solution.reset(problem.len(), Method::Modes);
        if !self.friction.solve_recognised(&recognised, &mut solution.force) {
            return false;
        }
        solution.active.extend((0..problem.len()).filter(|&row| solution.force[row] != 0.0));
        solution.residuals = self.checker.check(problem, &solution.force, &mut solution.acceleration);
        solution.residuals.accepted(&self.settings, 0.0)
    }

    /// Solves a problem that was not split again by islands, if it has several: they may be small enough for a
    /// comparison with more digits.
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
                    // A contradiction in units of an island's offsets may be rounding in units of those of all rows.
                    let outcome = self.methods.solve(problem, warm, solution);
                    let is_proof = proof.contradiction > self.settings.inconsistency
                        && proof.least_growth() >= self.settings.least_growth;
                    // A solution refutes the proof if the proof leaks more than rounding, or if the forces are smaller
                    // than it allows.
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
        // Growth is measured by the offsets of all rows, and may then be too small for the backward residual to count.
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
        // A problem whose matrix was handed over in the last solve is handed over again: the redundancy lies in the
        // rows.
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

    /// Whether the forces are so large that they must be compared with those found with twice as many digits.
    fn is_to_be_relaxed(&self, solution: &Solution) -> bool {
        let least = if self.is_strained { STRAINED } else { MUCH_STRAINED };
        solution.residuals.growth >= least && self.settings.contradiction == Contradiction::SolveExactly
    }

    /// Whether the last answer should have been compared so, but had too many rows.
    fn is_left_in_doubt(&self, problem: &Problem, solution: &Solution) -> bool {
        problem.is_symmetric() && problem.len() > RELAXED_ROWS && self.is_to_be_relaxed(solution)
    }

    /// Compares large forces with those found with twice as many digits, and takes the better answer or the proof that
    /// there is none. With large forces, the rounding of these may have decided which contacts are closed; with even
    /// larger ones, rows that have no solution may seem satisfied.
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

    /// Moves shared forces to independent rows if the settings ask for a vertex.
    fn cross_over(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError> {
        if self.settings.selection != ForceSelection::Vertex {
            return Ok(());
        }
        self.dual.cross_over(problem, solution)
    }

    /// Tries the other methods after the first one failed with `error`, which is returned if none helps.
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
        // If there is no solution, the forces of the proximal method have grown along a direction that proves it.
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

    /// Returns the proof as an error if a doubtful one can be refined to a certain one.
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
        // With `Vertex`, forces are moved to independent rows.
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
        // A box on a floor has many wrong rows, too, but a single pivot rights many of them.
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
    fn a_problem_that_takes_no_pivots_is_not_handed_over() {
        let (mut auto, mut solution) = (Auto::default(), Solution::new());
        auto.solve(&pyramid(14, 0.5), &mut solution).expect("forces of a pyramid");
        assert_eq!((solution.method, solution.iterations), (Method::DualActiveSet, 0));
    }
}
