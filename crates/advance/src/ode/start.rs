//! Proposal of the first step.

use super::explicit::mean_square;
use super::{Ode, Point, Stepper};

/// Fraction of the state's size by which the guess may move it; also the size of the error that the proposed step aims
/// at.
const SMALL_CHANGE: f64 = 0.01;
/// Size of state or rates, relative to the scales, below which they tell nothing about the step.
const TOO_SMALL_TO_TELL: f64 = 1e-5;
/// Guess [s] where state and rates tell nothing.
const BLIND_GUESS: f64 = 1e-6;
/// Size of the derivatives [1/s] below which the solution is taken for a straight line at rest.
const NO_CHANGE: f64 = 1e-15;
/// Largest proposed step as a multiple of the guess.
const LARGEST_GROWTH: f64 = 100.0;
/// Fraction of the guess that is proposed where nothing seems to change.
const AT_REST: f64 = 1e-3;
impl Stepper {
    /// Proposes the length [s] of the first step, at most `limit`, from the sizes of the first two derivatives. A
    /// negative limit asks for a step back: the step is negative then, and no longer than it.
    ///
    /// Source: HNW II.4, "Starting step size", with `scales` as in [`error_norm`](Stepper::error_norm). Costs one
    /// derivative; methods with fixed steps ask for none and return `limit`.
    ///
    /// # Errors
    /// The error of the system.
    pub fn starting_step<S: Ode + ?Sized>(
        &mut self,
        system: &mut S,
        from: Point<'_>,
        scales: &[f64],
        limit: f64,
    ) -> Result<f64, S::Error> {
        let Some(order) = self.method().error_order() else { return Ok(limit) };
        let size = mean_square(from.state, scales).sqrt();
        let rate = mean_square(from.rates, scales).sqrt();
        let blind = size < TOO_SMALL_TO_TELL || rate < TOO_SMALL_TO_TELL;
        let (longest, way) = (limit.abs(), limit.signum());
        let guess = if blind { BLIND_GUESS } else { SMALL_CHANGE * size / rate }.min(longest);
        let second = self.second_derivative(system, from, scales, way * guess)?;
        let largest = rate.max(second);
        let proposed = if largest <= NO_CHANGE {
            BLIND_GUESS.max(AT_REST * guess)
        } else {
            libm::pow(SMALL_CHANGE / largest, 1.0 / f64::from(order + 1))
        };
        Ok(way * proposed.min(LARGEST_GROWTH * guess).min(longest))
    }

    /// Estimates the size of the second derivative [1/s^2] by the change of the rates along a step of Euler.
    fn second_derivative<S: Ode + ?Sized>(
        &mut self,
        system: &mut S,
        from: Point<'_>,
        scales: &[f64],
        step: f64,
    ) -> Result<f64, S::Error> {
        self.trial.clear();
        self.trial.extend(from.state.iter().zip(from.rates).map(|(state, rate)| state + step * rate));
        self.trial_rates.clear();
        self.trial_rates.resize(from.rates.len(), 0.0);
        system.derivative(from.offset + step, &self.trial, &mut self.trial_rates)?;
        let changes = &mut self.trial_rates;
        for (rate, start) in changes.iter_mut().zip(from.rates) {
            *rate -= start;
        }
        Ok(mean_square(changes, scales).sqrt() / step.abs())
    }
}
