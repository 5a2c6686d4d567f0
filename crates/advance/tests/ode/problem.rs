//! A problem with a closed form, and loops that solve it.

use halfgap_advance::ode::{Method, Ode, Point, SegmentPolynomial, Stepper};
use std::convert::Infallible;
use std::ops::Range;

/// Number of components: position (2), velocity (2), and a number that grows at the relative rate `cos t`.
pub(crate) const SIZE: usize = 5;
pub(crate) type State = [f64; SIZE];
pub(crate) const POSITION: Range<usize> = 0..2;
pub(crate) const VELOCITY: Range<usize> = 2..4;

const ECCENTRICITY: f64 = 0.5;

/// A planet on an ellipse of half axis 1 about a sun of strength 1, from the pericentre on.
#[derive(Default)]
pub(crate) struct Planet {
    pub(crate) derivatives: usize,
}

impl Ode for Planet {
    type Error = Infallible;

    fn derivative(&mut self, offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        self.derivatives += 1;
        let distance = state[0].hypot(state[1]);
        let pull = distance.powi(-3);
        rates.copy_from_slice(&[
            state[2],
            state[3],
            -pull * state[0],
            -pull * state[1],
            offset.cos() * state[4],
        ]);
        Ok(())
    }
}

/// The state by Kepler's equation.
pub(crate) fn exact(time: f64) -> State {
    let mut anomaly = time;
    for _ in 0..50 {
        anomaly -= (anomaly - ECCENTRICITY * anomaly.sin() - time) / (1.0 - ECCENTRICITY * anomaly.cos());
    }
    let (sin, cos) = anomaly.sin_cos();
    let flatness = (1.0 - ECCENTRICITY * ECCENTRICITY).sqrt();
    let rate = 1.0 / (1.0 - ECCENTRICITY * cos);
    [cos - ECCENTRICITY, flatness * sin, -sin * rate, flatness * cos * rate, time.sin().exp()]
}

pub(crate) fn rates_at(time: f64, state: &State) -> State {
    let mut rates = [0.0; SIZE];
    let Ok(()) = Planet::default().derivative(time, state, &mut rates);
    rates
}

pub(crate) fn distance(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).fold(0.0, |largest, (left, right)| f64::max(largest, (left - right).abs()))
}

/// Errors of a solution: at the end, and of the polynomials in between.
pub(crate) struct Errors {
    pub(crate) end: f64,
    pub(crate) velocity: f64,
    pub(crate) position: f64,
}

/// Solves in equal steps from 0 to a time.
pub(crate) fn solve_in_steps(method: Method, time: f64, steps: u32) -> Errors {
    let (mut stepper, mut planet) = (Stepper::new(method), Planet::default());
    let mut state = exact(0.0);
    let mut errors = Errors { end: 0.0, velocity: 0.0, position: 0.0 };
    let step = time / f64::from(steps);
    for index in 0..steps {
        let offset = f64::from(index) * step;
        let rates = rates_at(offset, &state);
        let mut end = [0.0; SIZE];
        let start = Point { offset, state: &state, rates: &rates };
        let Ok(()) = stepper.step(&mut planet, start, step, &mut end);
        let end_rates = rates_at(offset + step, &end);
        let end_point = Point { offset: offset + step, state: &end, rates: &end_rates };
        let velocities = dense(&mut stepper, end_point);
        for (component, velocity) in velocities.iter().enumerate() {
            let position = SegmentPolynomial::integrated(state[component], end[component], velocity);
            for part in [0.1, 0.3, 0.5, 0.7, 0.9] {
                let now = exact(offset + part * step);
                let at = part * step;
                errors.velocity = errors.velocity.max((velocity.value_at(at) - now[2 + component]).abs());
                errors.position = errors.position.max((position.value_at(at) - now[component]).abs());
            }
        }
        state = end;
    }
    errors.end = distance(&state, &exact(time));
    errors
}

/// The velocities along the last step.
pub(crate) fn dense(stepper: &mut Stepper, end: Point<'_>) -> [SegmentPolynomial; 2] {
    let mut out = [SegmentPolynomial::default(); 2];
    let Ok(()) = stepper.dense(&mut Planet::default(), end, VELOCITY, &mut out);
    out
}

const MOST_STEPS: u32 = 10_000;

/// Outcome of a solution with step control.
pub(crate) struct Controlled {
    pub(crate) error: f64,
    pub(crate) steps: u32,
    pub(crate) rejected: u32,
}

/// Solves from 0 to a time with the given error per step in each component.
pub(crate) fn solve_to_tolerance(method: Method, time: f64, tolerance: f64) -> Controlled {
    let (mut stepper, mut planet) = (Stepper::new(method), Planet::default());
    let scales = [tolerance; SIZE];
    let (mut offset, mut state) = (0.0, exact(0.0));
    let mut solution = Controlled { error: 0.0, steps: 0, rejected: 0 };
    let rates = rates_at(offset, &state);
    let start = Point { offset, state: &state, rates: &rates };
    let Ok(mut step) = stepper.starting_step(&mut planet, start, &scales, time);
    let mut was_rejected = false;
    while offset < time {
        assert!(solution.steps + solution.rejected < MOST_STEPS, "stuck at {offset}");
        let is_last = offset + step >= time;
        let length = if is_last { time - offset } else { step };
        let rates = rates_at(offset, &state);
        let mut end = [0.0; SIZE];
        let start = Point { offset, state: &state, rates: &rates };
        let Ok(()) = stepper.step(&mut planet, start, length, &mut end);
        let norm = stepper.error_norm(&scales);
        let is_accepted = norm <= 1.0;
        step = length
            * if is_accepted && !was_rejected {
                method.step_factor(norm)
            } else {
                method.step_factor_after_rejection(norm)
            };
        was_rejected = !is_accepted;
        if is_accepted {
            state = end;
            offset = if is_last { time } else { offset + length };
            solution.steps += 1;
        } else {
            solution.rejected += 1;
        }
    }
    solution.error = distance(&state, &exact(time));
    solution
}
