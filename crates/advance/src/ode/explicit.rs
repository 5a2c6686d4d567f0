//! A step of an explicit method, from the tableau of its coefficients.

use super::tableau::{Stage, Tableau, Term};
use super::{Ode, Point, StiffnessEstimate};

/// Components that are handled together. The last lane is padded with numbers that are never read.
pub(super) type Lane = [f64; WIDTH];

/// Number of components in a lane.
pub(super) const WIDTH: usize = 4;

/// Weight of the error estimate of order 3 beside that of order 5 in DOP853, HNW II.10.
const THIRD_ORDER_SHARE: f64 = 0.01;

/// An explicit method, with its last step.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Explicit {
    #[cfg_attr(feature = "save", serde(with = "super::saved"))]
    pub(super) tableau: &'static Tableau,
    /// Number of components of the state.
    pub(super) size: usize,
    /// Number of lanes of a state.
    pub(super) lanes: usize,
    /// Offset [s] of the start of the last step.
    pub(super) offset: f64,
    /// Length [s] of the last step.
    pub(super) length: f64,
    /// State at the start of the step.
    pub(super) start: Vec<Lane>,
    /// State at which rates are asked for.
    trial: Vec<Lane>,
    /// Rates, a row of lanes per place of the tableau.
    pub(super) rates: Vec<Lane>,
    /// Error estimates of the last step, a row of lanes for each.
    errors: Vec<Lane>,
}

impl Explicit {
    pub(super) fn new(tableau: &'static Tableau) -> Self {
        Self {
            tableau,
            size: 0,
            lanes: 0,
            offset: 0.0,
            length: 0.0,
            start: Vec::new(),
            trial: Vec::new(),
            rates: Vec::new(),
            errors: Vec::new(),
        }
    }

    /// See [`Stepper::step_open`](super::Stepper::step_open).
    pub(super) fn step<S: Ode + ?Sized>(
        &mut self,
        system: &mut S,
        from: Point<'_>,
        step: f64,
        end: &mut [f64],
    ) -> Result<(), S::Error> {
        let tableau = self.tableau;
        self.open(from, step);
        for (index, stage) in tableau.stages.iter().enumerate() {
            self.evaluate(system, index + 1, stage)?;
        }
        self.move_along(tableau.weights);
        end.copy_from_slice(&self.trial.as_flattened()[..self.size]);
        if !tableau.needs_end_rates {
            self.estimate_errors();
        }
        Ok(())
    }

    /// See [`Stepper::close`](super::Stepper::close).
    pub(super) fn close(&mut self, end_rates: &[f64]) {
        if self.tableau.needs_end_rates {
            self.place_mut(self.tableau.end_stage()).copy_from_slice(end_rates);
            self.estimate_errors();
        }
    }

    /// See [`Stepper::error_norm`](super::Stepper::error_norm), of the components from `first` on. DOP853 has
    /// two estimates, which are combined as in HNW II.10.
    pub(super) fn error_norm(&self, first: usize, scales: &[f64]) -> f64 {
        let mean = |row: usize| mean_square(&self.error(row)[first..first + scales.len()], scales);
        match self.tableau.errors.len() {
            0 => 0.0,
            1 => mean(0).sqrt(),
            _ => {
                let (fifth, third) = (mean(0), mean(1));
                if fifth == 0.0 { 0.0 } else { fifth / (fifth + THIRD_ORDER_SHARE * third).sqrt() }
            }
        }
    }

    /// Takes over the start of a step.
    pub(super) fn open(&mut self, from: Point<'_>, step: f64) {
        if self.size != from.state.len() {
            self.resize(from.state.len());
        }
        self.offset = from.offset;
        self.length = step;
        self.start.as_flattened_mut()[..self.size].copy_from_slice(from.state);
        self.place_mut(0).copy_from_slice(from.rates);
    }

    fn resize(&mut self, size: usize) {
        let tableau = self.tableau;
        self.size = size;
        self.lanes = size.div_ceil(WIDTH);
        let rows = [
            (&mut self.start, 1),
            (&mut self.trial, 1),
            (&mut self.rates, tableau.places()),
            (&mut self.errors, tableau.errors.len()),
        ];
        for (buffer, rows) in rows {
            buffer.clear();
            buffer.resize(rows * self.lanes, Lane::default());
        }
    }

    /// The rates at a place of the tableau.
    pub(super) fn place_mut(&mut self, place: usize) -> &mut [f64] {
        &mut self.rates.as_flattened_mut()[WIDTH * place * self.lanes..][..self.size]
    }

    /// Asks for the rates of a stage.
    pub(super) fn evaluate<S: Ode + ?Sized>(
        &mut self,
        system: &mut S,
        place: usize,
        stage: &Stage,
    ) -> Result<(), S::Error> {
        self.move_along(stage.terms);
        self.ask(system, place, stage.node)
    }

    /// Sets the trial state to the start plus the step along weighted rates.
    pub(super) fn move_along(&mut self, terms: &[Term]) {
        for (lane, (trial, start)) in self.trial.iter_mut().zip(&self.start).enumerate() {
            let sum = weighted_sum(&self.rates, self.lanes, lane, terms);
            *trial = std::array::from_fn(|k| start[k] + self.length * sum[k]);
        }
    }

    /// Asks for the rates of the trial state at a node.
    pub(super) fn ask<S: Ode + ?Sized>(
        &mut self,
        system: &mut S,
        place: usize,
        node: f64,
    ) -> Result<(), S::Error> {
        let rates = &mut self.rates.as_flattened_mut()[WIDTH * place * self.lanes..][..self.size];
        let state = &self.trial.as_flattened()[..self.size];
        system.derivative(self.offset + node * self.length, state, rates)
    }

    fn estimate_errors(&mut self) {
        for (row, terms) in self.tableau.errors.iter().enumerate() {
            for lane in 0..self.lanes {
                let sum = weighted_sum(&self.rates, self.lanes, lane, terms);
                self.errors[row * self.lanes + lane] = sum.map(|sum| self.length * sum);
            }
        }
    }

    /// Size of the system's fastest rate times the step, by the difference between the last stage and the end, both of
    /// which are at the end of the step: HNW's (2.26) in "Solving Ordinary Differential Equations II", IV.2.
    pub(super) fn stiffness(&mut self, end: Point<'_>, scales: &[f64]) -> StiffnessEstimate {
        let Some(last) = self.tableau.stages.last() else { return StiffnessEstimate::default() };
        let place = self.tableau.stages.len();
        self.move_along(last.terms);
        let rates = &self.rates.as_flattened()[WIDTH * place * self.lanes..][..self.size];
        let (mut of_rates, mut of_states) = (0.0, 0.0);
        for (component, scale) in scales.iter().enumerate() {
            let rate = (rates[component] - end.rates[component]) / scale;
            let state = (self.trial.as_flattened()[component] - end.state[component]) / scale;
            (of_rates, of_states) = (of_rates + rate * rate, of_states + state * state);
        }
        let told = if of_states > 0.0 { self.length.abs() * (of_rates / of_states).sqrt() } else { 0.0 };
        let swing = self.tableau.swing.as_ref().filter(|swing| told >= swing.from);
        let dense_error = swing.map_or(0.0, |swing| swing.by * (of_states / scales.len() as f64).sqrt());
        StiffnessEstimate { fastest: told, dense_error }
    }

    fn error(&self, row: usize) -> &[f64] {
        &self.errors.as_flattened()[WIDTH * row * self.lanes..][..self.size]
    }
}

/// Sum of the rates of one lane over some stages, in the order of the stages.
#[inline]
pub(super) fn weighted_sum(rates: &[Lane], lanes: usize, lane: usize, terms: &[Term]) -> Lane {
    let mut sum = Lane::default();
    for &(stage, weight) in terms {
        let rates = &rates[stage * lanes + lane];
        for (sum, rate) in sum.iter_mut().zip(rates) {
            *sum += weight * rate;
        }
    }
    sum
}

/// Mean of the squares of numbers, each divided by its scale.
pub(super) fn mean_square(numbers: &[f64], scales: &[f64]) -> f64 {
    let squares = numbers.iter().zip(scales).map(|(number, scale)| (number / scale) * (number / scale));
    squares.sum::<f64>() / scales.len() as f64
}
