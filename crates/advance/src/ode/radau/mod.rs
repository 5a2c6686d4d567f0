//! A step of the implicit method of Radau IIA with three stages: order 5, and stable however fast parts of
//! the system decay.
//!
//! The equations of the stages are solved by a simplified Newton method: the derivatives of the rates are
//! found once a step, by differences. Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations
//! II, 2nd ed., Springer 1996, IV.8 ("HW" in this room).

mod coefficients;
mod linearised;

use super::linear::Factors;
use super::polynomial::{NESTED, SegmentPolynomial};
use super::{Ode, Point};
use coefficients::{BACK, ERROR, FORTH, NODES, PAIR, REAL, STAGES};
use linearised::slopes_of;
use std::ops::Range;

/// Correction left, as a fraction of the acceptable error, at which Newton's method has converged.
const CONVERGED: f64 = 1e-2;
/// Fraction of a correction that is taken to be left to correct, at least, however much smaller it is than the one
/// before: the first is the whole way of the step, and its slow part may hide that the fast part has yet to follow.
const LEAST_LEFT: f64 = 1e-2;
/// Correction, as a fraction of the acceptable error, up to which it counts as none: in a system at rest corrections
/// come from the rounding of its rates, and do not get smaller.
const NEGLIGIBLE: f64 = 1e-6;
/// Largest number of corrections in one step; more mean that a shorter step costs less.
const MOST_CORRECTIONS: usize = 10;
/// Ratio of a correction to the one before above which they do not converge.
const SLOWEST: f64 = 0.9;
/// Acceptable error of a component as a fraction of its size, where no scales are set.
const UNTOLD: f64 = 1e-10;
/// Least length of a difference, as a fraction of a component, so that the rounding of the rates does not matter;
/// otherwise differences are taken over the acceptable error.
const LEAST_DIFFERENCE: f64 = 1e6 * f64::EPSILON;

/// The implicit method, with its last step.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Radau {
    /// Number of components of the state.
    size: usize,
    /// Number of components that rates depend on; they come first.
    active: usize,
    length: f64,
    /// Acceptable errors that the caller has set.
    told: Vec<f64>,
    /// Acceptable errors of the active components.
    scales: Vec<f64>,
    start: Vec<f64>,
    trial: Vec<f64>,
    /// Rates at the stages.
    rates: [Vec<f64>; 3],
    /// Offsets of the stages from the start.
    stages: [Vec<f64>; 3],
    /// Unknowns of the equations: T^-1 times the stages.
    split: [Vec<f64>; 3],
    /// Derivatives of the rates by the active components, row by row.
    jacobian: Vec<f64>,
    /// Rounding of the active components along a step.
    rounding: Vec<f64>,
    /// Size of the rounding of their rates.
    rate_rounding: Vec<f64>,
    real: Factors,
    pair: Factors,
    right: Vec<f64>,
    error: Vec<f64>,
    /// Vector to which the power method has come, for the next step.
    fastest: Vec<f64>,
    stiffness: f64,
    /// True if the equations of the last step were solved.
    solved: bool,
}

impl Radau {
    pub(super) fn set_scales(&mut self, scales: &[f64]) {
        self.told.clear();
        self.told.extend_from_slice(scales);
    }

    /// See [`Stepper::step`](super::Stepper::step).
    pub(super) fn step<S: Ode + ?Sized>(
        &mut self,
        system: &mut S,
        from: Point<'_>,
        step: f64,
        end: &mut [f64],
    ) -> Result<(), S::Error> {
        self.open(from, step);
        if step == 0.0 {
            self.stay(end);
            return Ok(());
        }
        self.differentiate(system, from)?;
        self.solved = self.factorize();
        self.find_rounding();
        self.solved = self.solved && self.solve_stages(system, from)?;
        end.copy_from_slice(from.state);
        self.solved = self.solved && self.stages.iter().flatten().all(|way| way.is_finite());
        if self.solved {
            end.iter_mut().zip(&self.stages[2]).for_each(|(end, way)| *end += way);
            self.estimate_error(from);
            self.find_fastest();
        }
        Ok(())
    }

    /// See [`Stepper::error_norm`](super::Stepper::error_norm).
    pub(super) fn error_norm(&self, scales: &[f64]) -> f64 {
        if self.solved { root_mean_square(&self.error, scales) } else { f64::INFINITY }
    }

    /// See [`Stepper::stiffness`](super::Stepper::stiffness).
    pub(super) fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// See [`Stepper::dense`](super::Stepper::dense): the polynomial through the start, the stages and the
    /// end. It does not have the rates at the ends, which say nothing about the motion where they decay fast.
    pub(super) fn dense(&self, end: Point<'_>, components: Range<usize>, out: &mut [SegmentPolynomial]) {
        let [first, second, _] = NODES;
        for (component, out) in components.zip(out) {
            let [at_first, at_second, way] = [0, 1, 2].map(|stage: usize| self.stages[stage][component]);
            // In the form of `tableau`: x (c2 + (1 - x) (c3 + x c4)).
            let [bend, other] = [(at_first, first), (at_second, second)]
                .map(|(value, node)| (value / node - way) / (1.0 - node));
            let twist = (other - bend) / (second - first);
            let start = self.start[component];
            // A change of the end after the step is put in as 3 x^2 - 2 x^3 of it.
            let change = end.state[component] - (start + way);
            let mut nested = [0.0; NESTED];
            nested[..3].copy_from_slice(&[way + change, bend - first * twist - change, twist + 2.0 * change]);
            *out = SegmentPolynomial::from_nested(start, &nested, self.length);
        }
    }

    /// Takes over the start of a step.
    fn open(&mut self, from: Point<'_>, step: f64) {
        let size = from.state.len();
        let is_told = !self.told.is_empty() && self.told.len() <= size;
        let active = if is_told { self.told.len() } else { size };
        if (self.size, self.active) != (size, active) {
            let rows = self.rates.iter_mut().chain(&mut self.stages).chain(&mut self.split);
            for buffer in rows.chain([&mut self.trial, &mut self.right, &mut self.error]) {
                buffer.clear();
                buffer.resize(size, 0.0);
            }
            self.right.resize(2 * active, 0.0);
            self.fastest.clear();
        }
        (self.size, self.active, self.length) = (size, active, step);
        self.start.clear();
        self.start.extend_from_slice(from.state);
        self.scales.clear();
        if is_told {
            self.scales.extend_from_slice(&self.told);
        } else {
            let sizes =
                from.state.iter().zip(from.rates).map(|(state, rate)| state.abs() + (step * rate).abs());
            self.scales.extend(sizes.map(|size| if size > 0.0 { UNTOLD * size } else { f64::INFINITY }));
        }
    }

    /// A step of no length, whose equations divide by it.
    fn stay(&mut self, end: &mut [f64]) {
        self.stages.iter_mut().for_each(|way| way.fill(0.0));
        self.error.fill(0.0);
        (self.stiffness, self.solved) = (0.0, true);
        end.copy_from_slice(&self.start);
    }

    /// Finds the derivatives of the rates by differences.
    fn differentiate<S: Ode + ?Sized>(&mut self, system: &mut S, from: Point<'_>) -> Result<(), S::Error> {
        let (size, active) = (self.size, self.active);
        self.jacobian.clear();
        self.jacobian.resize(active * active, 0.0);
        self.trial[..size].copy_from_slice(from.state);
        for column in 0..active {
            let value = from.state[column];
            let scale = if self.scales[column].is_finite() { self.scales[column] } else { 0.0 };
            let change = scale.max(LEAST_DIFFERENCE * value.abs());
            // Where nothing tells a size, 1 is as good as any other.
            let moved = value + if change > 0.0 { change } else { 1.0 };
            self.trial[column] = moved;
            system.derivative(from.offset, &self.trial, &mut self.rates[0])?;
            self.trial[column] = value;
            for row in 0..active {
                self.jacobian[row * active + column] =
                    (self.rates[0][row] - from.rates[row]) / (moved - value);
            }
        }
        Ok(())
    }

    /// Factorises the matrices of the split equations, HW (8.4); false if one is singular.
    fn factorize(&mut self) -> bool {
        let (active, length) = (self.active, self.length);
        let real = self.real.clear(active);
        real.iter_mut().zip(&self.jacobian).for_each(|(entry, slope)| *entry = -slope);
        (0..active).for_each(|row| real[row * active + row] += REAL / length);
        let pair = self.pair.clear(2 * active);
        for (row, slopes) in slopes_of(&self.jacobian, active).enumerate() {
            for half in [0, active] {
                let entries = &mut pair[(row + half) * 2 * active..][..2 * active];
                entries[half..half + active]
                    .iter_mut()
                    .zip(slopes)
                    .for_each(|(entry, slope)| *entry = -slope);
                entries[half + row] += PAIR.0 / length;
            }
            pair[row * 2 * active + active + row] = -PAIR.1 / length;
            pair[(row + active) * 2 * active + row] = PAIR.1 / length;
        }
        self.real.factorize() && self.pair.factorize()
    }

    /// Solves the equations of the stages; false if the corrections do not converge.
    fn solve_stages<S: Ode + ?Sized>(&mut self, system: &mut S, from: Point<'_>) -> Result<bool, S::Error> {
        self.stages.iter_mut().chain(&mut self.split).for_each(|row| row.fill(0.0));
        let mut before: Option<f64> = None;
        for _ in 0..MOST_CORRECTIONS {
            for ((stage, rates), node) in self.stages.iter().zip(&mut self.rates).zip(NODES) {
                let ways = stage.iter().zip(from.state);
                self.trial.iter_mut().zip(ways).for_each(|(trial, (way, start))| *trial = start + way);
                system.derivative(from.offset + node * self.length, &self.trial, rates)?;
            }
            let correction = self.correct();
            self.integrate_others();
            if !correction.is_finite() {
                return Ok(false);
            }
            if correction <= NEGLIGIBLE {
                return Ok(true);
            }
            let Some(last) = before.replace(correction) else { continue };
            let factor = (correction / last).max(LEAST_LEFT);
            if factor / (1.0 - factor).max(0.0) * correction <= CONVERGED {
                return Ok(true);
            }
            if factor > SLOWEST {
                return Ok(false);
            }
        }
        Ok(false)
    }

    /// Corrects the stages by Newton's method; returns the size of the correction in acceptable errors, less its
    /// rounding.
    fn correct(&mut self) -> f64 {
        let (active, length) = (self.active, self.length);
        let (rates, rounding) = (&self.rates, &self.rounding);
        let mixed =
            |row: &[f64; 3], at: usize| (0..3).map(|stage| row[stage] * rates[stage][at]).sum::<f64>();
        let mut sum = 0.0;
        let mut note = |at: usize, correction: f64| {
            let size = beyond(correction, rounding[at]) / self.scales[at];
            sum += size * size;
        };
        let [first, second, third] = &mut self.split;
        let right = &mut self.right[..active];
        for (at, right) in right.iter_mut().enumerate() {
            *right = mixed(&FORTH[0], at) - REAL / length * first[at];
        }
        self.real.solve(right);
        for (at, (value, correction)) in first.iter_mut().zip(right.iter()).enumerate() {
            *value += correction;
            note(at, *correction);
        }
        let right = &mut self.right[..2 * active];
        for at in 0..active {
            let (a, b) = (second[at], third[at]);
            right[at] = mixed(&FORTH[1], at) - (PAIR.0 * a - PAIR.1 * b) / length;
            right[active + at] = mixed(&FORTH[2], at) - (PAIR.1 * a + PAIR.0 * b) / length;
        }
        self.pair.solve(right);
        for at in 0..active {
            second[at] += right[at];
            third[at] += right[active + at];
            note(at, right[at]);
            note(at, right[active + at]);
        }
        for (stage, weights) in self.stages.iter_mut().zip(&BACK) {
            for (at, way) in stage[..active].iter_mut().enumerate() {
                *way = (0..3).map(|part| weights[part] * self.split[part][at]).sum();
            }
        }
        (sum / (3 * active).max(1) as f64).sqrt()
    }

    /// Finds the stages of the components that are only integrated, from the rates at the last stages.
    fn integrate_others(&mut self) {
        for (stage, weights) in self.stages.iter_mut().zip(&STAGES) {
            for (at, way) in stage.iter_mut().enumerate().skip(self.active) {
                *way = self.length * (0..3).map(|other| weights[other] * self.rates[other][at]).sum::<f64>();
            }
        }
    }

    /// Estimates the error, HW (8.19). Their second filter, (8.20), is left out: it would take the error of parts that
    /// have yet to decay for none, and the motion along the step would not be that of the system.
    fn estimate_error(&mut self, from: Point<'_>) {
        for at in 0..self.active {
            let stages: f64 = (0..3).map(|stage| ERROR[stage] * self.stages[stage][at]).sum();
            self.error[at] = from.rates[at] + stages / self.length;
        }
        self.real.solve(&mut self.error[..self.active]);
        for (error, rounding) in self.error.iter_mut().zip(&self.rounding) {
            *error = beyond(*error, *rounding);
        }
    }
}

/// Excess of a number's size over its rounding, 0 if there is none; NaN stays NaN.
fn beyond(number: f64, rounding: f64) -> f64 {
    if number.abs() <= rounding { 0.0 } else { number.abs() - rounding }
}

/// Root of the mean of the squares of the first numbers, each divided by its scale.
fn root_mean_square(numbers: &[f64], scales: &[f64]) -> f64 {
    super::explicit::mean_square(&numbers[..scales.len()], scales).sqrt()
}
