//! Proximal augmented Lagrangian with semismooth Newton steps in body space, for large problems.
//!
//! In the scaled quantities of [`System`], with u the change of the bodies' scaled velocities and multipliers g,
//!
//! ```text
//! minimise over u   ½|u|² + ε/2 Σ_i max(0, g_i - â_i/ε)²,   â = Ĵ u + b̂   (no max on bilateral rows)
//! then              g_i := max(0, g_i - â_i/ε)
//! ```
//!
//! Each minimum is found by Newton steps with the matrix I + Ĵ_Cᵀ Ĵ_C/ε, C the rows inside the max, and an exact line
//! search. The outer iteration is the proximal point method on the forces, which works with redundant contacts and ends
//! near the forces of least norm. Sources: B. Hermans, A. Themelis, P. Patrinos, "QPALM", CDC 2019; A. Bambade et al.,
//! "PROX-QP", RSS 2022; R. T. Rockafellar, "Augmented Lagrangians and applications of the proximal point algorithm",
//! Mathematics of Operations Research 1, 1976. The first step goes straight to the minimum for a guessed C.

use crate::body_factor::BodyFactor;
use crate::certificate::refine;
use crate::check::{Checker, Residuals};
use crate::error::{Infeasibility, SettingsError, SolveError};
use crate::interior_point::InteriorPoint;
use crate::line_search::PiecewiseLinear;
use crate::problem::{Problem, pushing};
use crate::settings::Settings;
use crate::solution::Solution;
use crate::solver::{Method, Solver};
use crate::system::System;
use crate::warm::WarmStart;
use crate::words;

/// Proximal term ε of the first outer iteration without an earlier answer, in units of the diagonal of Â, which is 1.
const FIRST_TERM: f64 = 1e-4;
/// Proximal term ε of the first outer iteration from an earlier answer, whose closed rows are mostly right.
const WARM_TERM: f64 = 1e-6;
/// Least proximal term ε: with a smaller one the Newton matrix is too ill-conditioned to help.
const LEAST_TERM: f64 = 1e-11;
/// Factor on ε after an outer iteration that did not gain much.
const TERM_FACTOR: f64 = 1e-2;
/// Ratio of a residual to the previous one up to which ε need not fall.
const GOOD_GAIN: f64 = 1e-3;
/// Residual, in units of the scale, that ends the iteration.
const TARGET: f64 = 1e-13;
/// Residual, in units of the largest scaled force, that ends the iteration: rounding.
const ROUNDING: f64 = 4e-16;
/// Ratio of a residual to the previous one above which an outer iteration counts as stalled.
const STALLED: f64 = 0.5;
/// Number of stalled outer iterations that are allowed at the least ε.
const STALLS: usize = 3;
/// Largest gradient that is rounding, in units of the largest scaled force.
const STATIONARY: f64 = 1e-14;
/// Cap on Newton steps between two updates of the multipliers.
const INNER_STEPS: usize = 200;
/// Largest deviation of a step length from 1 that is rounding.
const FULL_STEP: f64 = 1e-9;

/// Term δ of the interior-point method, in units of the diagonal of Â, that keeps forces modest after a run without it
/// went beyond all bounds.
const JAMMED_TERM: f64 = 1e-9;

/// Number of Newton steps after which the interior-point method is likely to end sooner.
const PATIENCE: usize = 15;

/// The start of the iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Begin {
    /// At an earlier answer, or at zero forces without one.
    Guess,
    /// At the forces that the interior-point method finds, itself started from an earlier answer if there is one.
    Inside,
}

/// Proximal augmented Lagrangian with semismooth Newton steps in body space, for large symmetric problems of bodies.
///
/// The number of steps hardly depends on the number of redundant contacts, and the forces are near those of least norm.
/// Sources: QPALM (B. Hermans et al., CDC 2019) and PROX-QP (A. Bambade et al., RSS 2022).
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ProximalNewton {
    settings: Settings,
    system: System,
    factor: BodyFactor,
    /// The proximal term ε of the present factor, if there is one; its rows are `inside`.
    factored: Option<f64>,
    epsilon: f64,
    inside: Vec<bool>,
    guess: Vec<bool>,
    /// u; `step` is its change, or minus the gradient.
    motion: Vec<f64>,
    step: Vec<f64>,
    /// â and its change.
    acceleration: Vec<f64>,
    change: Vec<f64>,
    multiplier: Vec<f64>,
    force: Vec<f64>,
    unscaled: Vec<f64>,
    derivative: PiecewiseLinear,
    checker: Checker,
    interior: InteriorPoint,
    steps: usize,
    /// Number of Newton steps after which the iteration stops for now, and number of steps made earlier or by the
    /// interior-point method.
    most_steps: usize,
    interior_steps: usize,
    /// Number of factorisations in the last solve.
    pub(crate) factorizations: usize,
}

impl ProximalNewton {
    /// Makes a solver with the given settings.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] names a setting that is not positive and finite.
    #[inline]
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(ProximalNewton { settings, ..Self::default() })
    }

    /// Whether the last problem solved had the matrix of this one, so that its factor is of use.
    pub(crate) fn is_loaded(&self, problem: &Problem) -> bool {
        self.system.is_loaded(problem)
    }

    /// Refines a direction along which forces have grown, or that of a doubtful proof, to a certain proof that there is
    /// no solution; `None` if that fails.
    pub(crate) fn refine_proof(&mut self, problem: &Problem, direction: &[f64]) -> Option<Infeasibility> {
        if !problem.has_bodies() {
            return None;
        }
        self.load(problem, None);
        let is_ready = self.factor.prepare(&self.system, self.motion.len());
        let Self { system, factor, settings, .. } = self;
        is_ready.then(|| refine(problem, system, factor, direction, settings)).flatten()
    }

    /// Solves a problem in which many pivots or steps are in sight: begins at the forces that the interior-point method
    /// finds, from an earlier answer if there is one.
    pub(crate) fn solve_inside(
        &mut self,
        problem: &Problem,
        warm: Option<&WarmStart>,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        self.run(problem, warm, Begin::Inside, solution)
    }

    fn run(
        &mut self,
        problem: &Problem,
        warm: Option<&WarmStart>,
        begin: Begin,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        let method = Method::ProximalNewton;
        solution.reset(problem.len(), method);
        problem.require_plain(method)?;
        if !problem.has_bodies() {
            let reason = words::BODIES_ONLY;
            return Err(SolveError::NotApplicable { method, reason });
        }
        self.load(problem, warm);
        let columns = self.motion.len();
        let is_ready = self.factor.prepare(&self.system, columns);
        self.interior_steps = 0;
        if is_ready {
            self.approach(problem, warm, begin);
        }
        self.answer(problem, solution);
        let Settings { natural_residual, least_growth, .. } = self.settings;
        let Residuals { natural, growth, .. } = solution.residuals;
        if self.interior_steps > 0 && natural > natural_residual && growth >= least_growth {
            self.approach_modestly(problem);
            self.answer(problem, solution);
        }
        if solution.residuals.accepted(&self.settings, 0.0) {
            return Ok(());
        }
        let Solution { residuals, iterations, .. } = *solution;
        Err(SolveError::Unsolved { method, residuals, iterations })
    }

    /// Writes the forces as the answer, unless `solution` already holds a better one.
    fn answer(&mut self, problem: &Problem, solution: &mut Solution) {
        let steps = self.steps + self.interior_steps;
        let is_first = solution.iterations == 0;
        solution.iterations = steps;
        let before = solution.residuals.natural;
        self.unscaled.clear();
        let scaled = self.force.iter().zip(&self.system.row_scale);
        self.unscaled.extend(scaled.map(|(force, scale)| force / scale));
        let residuals = self.checker.check(problem, &self.unscaled, &mut self.change);
        if !is_first && residuals.natural >= before {
            return;
        }
        solution.residuals = residuals;
        solution.force.copy_from_slice(&self.unscaled);
        solution.acceleration.copy_from_slice(&self.change);
        solution.active.clear();
        solution.active.extend((0..problem.len()).filter(|&row| solution.force[row] != 0.0));
    }

    /// Starts again from the interior-point method where the forces of jammed bodies went beyond all bounds, with a
    /// term that keeps them modest. It is not used at once, as contacts that contradict each other slightly end in
    /// worse forces with it.
    fn approach_modestly(&mut self, problem: &Problem) {
        let before = self.steps + self.interior_steps;
        self.load(problem, None);
        self.interior.term = JAMMED_TERM;
        let is_near = self.interior.run(&self.system, &mut self.factor, &problem.bilateral, None);
        self.interior.term = 0.0;
        self.interior_steps = before + self.interior.steps;
        self.factored = None;
        if is_near {
            self.begin_inside(problem);
            self.iterate(problem);
        }
    }

    fn load(&mut self, problem: &Problem, warm: Option<&WarmStart>) {
        let n = problem.len();
        let same = self.system.load(problem);
        let columns = self.system.columns();
        for values in [&mut self.acceleration, &mut self.change, &mut self.multiplier, &mut self.force] {
            values.clear();
            values.resize(n, 0.0);
        }
        for values in [&mut self.motion, &mut self.step] {
            values.clear();
            values.resize(columns, 0.0);
        }
        // The factor stays if only b has changed; with an earlier answer, its proximal term serves as well as
        // `WARM_TERM`.
        if !same || warm.is_none() {
            self.inside.clear();
            self.inside.resize(n, false);
            self.factored = None;
        }
        self.steps = 0;
        self.factorizations = 0;
        self.epsilon = if warm.is_some() { self.factored.unwrap_or(WARM_TERM) } else { FIRST_TERM };
        let limit = self.settings.start_closed * self.system.scale;
        let lookup = warm.map(|warm| warm.lookup(problem));
        self.guess.clear();
        for row in 0..n {
            let earlier = lookup.as_ref().and_then(|lookup| lookup.find(row));
            let closed = earlier.map_or(self.system.b[row] <= limit, |earlier| earlier.closed);
            self.guess.push(problem.bilateral[row] || closed);
            self.multiplier[row] = earlier.map_or(0.0, |earlier| earlier.force * self.system.row_scale[row]);
        }
        self.move_by_multipliers();
    }

    /// Iterates from the guess, or from the interior point if `begin` says so or the guess does not end soon. If no
    /// interior point is found, the iteration from a guess goes on.
    fn approach(&mut self, problem: &Problem, warm: Option<&WarmStart>, begin: Begin) {
        if begin == Begin::Guess {
            self.most_steps = PATIENCE.min(self.settings.newton_steps);
            self.iterate(problem);
            if self.steps < self.most_steps {
                return;
            }
        }
        self.most_steps = self.settings.newton_steps;
        let mut is_near = false;
        if begin == Begin::Inside && warm.is_some() {
            let known = Some(self.multiplier.as_slice());
            is_near = self.interior.run(&self.system, &mut self.factor, &problem.bilateral, known);
            self.interior_steps += self.interior.steps;
        }
        if !is_near {
            is_near = self.interior.run(&self.system, &mut self.factor, &problem.bilateral, None);
            self.interior_steps += self.interior.steps;
        }
        self.interior_steps += self.steps;
        self.factored = None;
        if begin == Begin::Guess {
            self.load(problem, warm);
        }
        if is_near {
            self.begin_inside(problem);
        }
        if is_near || begin == Begin::Guess {
            self.iterate(problem);
        }
    }

    /// Takes the forces of the interior-point method for those of an earlier answer.
    fn begin_inside(&mut self, problem: &Problem) {
        self.epsilon = WARM_TERM;
        for row in 0..problem.len() {
            let (force, acceleration) = (self.interior.force[row], self.interior.acceleration[row]);
            self.guess[row] = problem.bilateral[row] || force > acceleration;
            self.multiplier[row] = if self.guess[row] { force } else { 0.0 };
        }
        self.move_by_multipliers();
    }

    /// Sets the motion and the accelerations to those of the multipliers.
    fn move_by_multipliers(&mut self) {
        self.system.push(&self.multiplier, &mut self.motion);
        self.system.pull(&self.motion, &mut self.acceleration);
        self.acceleration.iter_mut().zip(&self.system.b).for_each(|(a, b)| *a += b);
    }

    /// Runs the outer iteration.
    fn iterate(&mut self, problem: &Problem) {
        let mut previous = f64::INFINITY;
        let mut stalls = 0;
        for outer in 0..self.settings.outer_iterations {
            if !self.minimise(problem, outer == 0) {
                return;
            }
            let (residual, largest) = self.update_multipliers(problem);
            let scale = self.system.scale;
            if residual <= TARGET * scale || residual <= ROUNDING * largest {
                return;
            }
            if residual > STALLED * previous && self.epsilon <= LEAST_TERM {
                stalls += 1;
                if stalls > STALLS {
                    return;
                }
            }
            if largest > self.settings.greatest_growth * scale {
                return;
            }
            if residual > GOOD_GAIN * previous {
                self.epsilon = (self.epsilon * TERM_FACTOR).max(LEAST_TERM);
            }
            previous = residual;
        }
    }

    /// Minimises the augmented Lagrangian for the present multipliers. Returns false if the iteration cannot go on.
    fn minimise(&mut self, problem: &Problem, first: bool) -> bool {
        let mut guessed = first;
        let last = self.most_steps.min(self.steps + INNER_STEPS);
        while self.steps < last {
            self.steps += 1;
            let mut changed = self.factored != Some(self.epsilon);
            for row in 0..problem.len() {
                let force = self.multiplier[row] - self.acceleration[row] / self.epsilon;
                let inside = if guessed { self.guess[row] } else { problem.bilateral[row] || force > 0.0 };
                self.force[row] = if inside { force } else { 0.0 };
                changed |= inside != self.inside[row];
                self.inside[row] = inside;
            }
            if changed {
                self.factorizations += 1;
                self.factored = None;
                let (inside, weight) = (&self.inside, self.epsilon.recip());
                if !self.factor.factor(&self.system, |row| if inside[row] { weight } else { 0.0 }) {
                    return false;
                }
                self.factored = Some(self.epsilon);
            }
            // Newton step: minus the gradient u - Ĵᵀ f, through the factor.
            self.system.push(&self.force, &mut self.step);
            self.step.iter_mut().zip(&self.motion).for_each(|(s, u)| *s -= u);
            if !changed && self.is_stationary() {
                return true;
            }
            self.factor.solve(&mut self.step);
            self.system.pull(&self.step, &mut self.change);
            let length = if guessed { 1.0 } else { self.step_length(problem) };
            for (u, s) in self.motion.iter_mut().zip(&self.step) {
                *u += length * s;
            }
            for (a, d) in self.acceleration.iter_mut().zip(&self.change) {
                *a += length * d;
            }
            guessed = false;
            if (length - 1.0).abs() < FULL_STEP && self.same_rows_inside(problem) {
                return true;
            }
        }
        // A row at the edge of the max may change sides for ever; the outer iteration moves the edge.
        self.steps < self.most_steps
    }

    /// Whether the gradient, in `step`, is rounding beside the forces.
    fn is_stationary(&self) -> bool {
        let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        largest(&self.step) <= STATIONARY * largest(&self.force).max(self.system.scale)
    }

    fn same_rows_inside(&self, problem: &Problem) -> bool {
        (0..problem.len()).all(|row| {
            let force = self.multiplier[row] - self.acceleration[row] / self.epsilon;
            self.inside[row] == (problem.bilateral[row] || force > 0.0)
        })
    }

    /// Length of the step to the exact minimum along it.
    fn step_length(&mut self, problem: &Problem) -> f64 {
        let (mut value, mut slope) = (0.0, 0.0);
        for (u, s) in self.motion.iter().zip(&self.step) {
            value += u * s;
            slope += s * s;
        }
        self.derivative.reset(value, slope);
        for row in 0..problem.len() {
            let change = self.change[row];
            let force = self.multiplier[row] - self.acceleration[row] / self.epsilon;
            let inside = problem.bilateral[row] || force > 0.0;
            let (value, slope) = (-force * change, change * change / self.epsilon);
            if inside {
                self.derivative.add(value, slope);
            }
            if !problem.bilateral[row] && change != 0.0 {
                let at = force * self.epsilon / change;
                if at > 0.0 {
                    let sign = if inside { -1.0 } else { 1.0 };
                    self.derivative.add_beyond(at, sign * value, sign * slope);
                }
            }
        }
        self.derivative.find_zero().unwrap_or(1.0)
    }

    /// Makes the forces the multipliers, and updates motion and accelerations. Returns the largest residual and the
    /// largest force.
    fn update_multipliers(&mut self, problem: &Problem) -> (f64, f64) {
        for row in 0..problem.len() {
            let force = self.multiplier[row] - self.acceleration[row] / self.epsilon;
            self.multiplier[row] = if problem.bilateral[row] { force } else { pushing(force) };
        }
        self.force.copy_from_slice(&self.multiplier);
        self.system.push(&self.force, &mut self.motion);
        self.system.pull(&self.motion, &mut self.acceleration);
        let (mut residual, mut largest) = (0.0_f64, 0.0_f64);
        for row in 0..problem.len() {
            let acceleration = self.acceleration[row] + self.system.b[row];
            self.acceleration[row] = acceleration;
            let force = self.force[row];
            let wrong = if problem.bilateral[row] { acceleration } else { force.min(acceleration) };
            residual = residual.max(wrong.abs());
            largest = largest.max(force.abs());
        }
        (residual, largest)
    }
}

impl Solver for ProximalNewton {
    fn method(&self) -> Method {
        Method::ProximalNewton
    }

    fn solve(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError> {
        self.run(problem, None, Begin::Guess, solution)
    }

    fn solve_from(
        &mut self,
        problem: &Problem,
        start: &WarmStart,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        let outcome = self.run(problem, Some(start), Begin::Guess, solution);
        let Err(SolveError::Unsolved { iterations, .. }) = outcome else { return outcome };
        // An earlier answer, or a guess, that is far off may lead nowhere.
        let outcome = self.run(problem, None, Begin::Guess, solution);
        solution.iterations += iterations;
        outcome
    }
}
