//! Polynomials along a step: ends as given, derivatives, bounds.

use crate::problem::{POSITION, Planet, SIZE, State, VELOCITY, dense, exact, rates_at};
use halfgap_advance::ode::{Method, Point, SegmentPolynomial, Stepper};

const METHODS: [Method; 5] =
    [Method::Dop853, Method::DormandPrince5, Method::Rk4, Method::ModifiedEuler, Method::Euler];
const OFFSET: f64 = 0.3;
const STEP: f64 = 0.2;

/// A step whose end was changed by a projection.
struct Changed {
    start: State,
    end: State,
    end_rates: State,
    velocities: [SegmentPolynomial; 2],
}

fn changed_step(method: Method, change: f64) -> Changed {
    let mut stepper = Stepper::new(method);
    let start = exact(OFFSET);
    let rates = rates_at(OFFSET, &start);
    let mut end = [0.0; SIZE];
    let from = Point { offset: OFFSET, state: &start, rates: &rates };
    let Ok(()) = stepper.step(&mut Planet::default(), from, STEP, &mut end);
    for (component, end) in end.iter_mut().enumerate() {
        *end += change * (1.0 + component as f64);
    }
    let end_rates = rates_at(OFFSET + STEP, &end);
    let velocities = dense(&mut stepper, Point { offset: OFFSET + STEP, state: &end, rates: &end_rates });
    Changed { start, end, end_rates, velocities }
}

/// Rounding of numbers of the size of the motion.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

#[test]
fn ends_and_their_rates_are_those_given_whatever_the_change() {
    for method in METHODS {
        for change in [0.0, 1e-9, -1e-3] {
            let step = changed_step(method, change);
            let start_rates = rates_at(OFFSET, &step.start);
            for (component, velocity) in VELOCITY.zip(&step.velocities) {
                assert!((velocity.value_at(0.0) - step.start[component]).abs() < ROUNDING, "{method:?}");
                assert!((velocity.value_at(STEP) - step.end[component]).abs() < ROUNDING, "{method:?}");
                // A derivative is a difference of numbers of order 1 over the step.
                let slopes = [velocity.derivative_at(0.0), velocity.derivative_at(STEP)];
                assert!((slopes[0] - start_rates[component]).abs() < 8.0 * ROUNDING / STEP, "{method:?}");
                assert!((slopes[1] - step.end_rates[component]).abs() < 8.0 * ROUNDING / STEP, "{method:?}");
            }
        }
    }
}

#[test]
fn positions_follow_velocities_and_meet_both_ends() {
    for method in METHODS {
        for (change, mismatch) in [(0.0, None), (1e-6, Some(1e-6))] {
            let step = changed_step(method, change);
            for (component, velocity) in POSITION.zip(&step.velocities) {
                let position =
                    SegmentPolynomial::integrated(step.start[component], step.end[component], velocity);
                assert!((position.value_at(0.0) - step.start[component]).abs() < ROUNDING, "{method:?}");
                assert!((position.value_at(STEP) - step.end[component]).abs() < ROUNDING, "{method:?}");
                for at in [0.0, STEP] {
                    let difference = position.derivative_at(at) - velocity.value_at(at);
                    assert!(difference.abs() < 8.0 * ROUNDING / STEP, "{method:?} at {at}: {difference:e}");
                }
                let Some(mismatch) = mismatch else { continue };
                if method == Method::Dop853 {
                    // The correction is steepest in the middle: 3/2 of the missing difference over the step.
                    let difference = position.derivative_at(0.5 * STEP) - velocity.value_at(0.5 * STEP);
                    assert!(difference.abs() < 3.0 * 1.5 * mismatch / STEP, "{difference:e}");
                    assert!(difference.abs() > 0.1 * mismatch / STEP, "{difference:e}");
                }
            }
        }
    }
}

#[test]
fn far_away_the_motion_keeps_its_digits() {
    // The coordinate is about 1e6, the motion 0.2: its differences are right to the last place of the coordinate.
    let step = changed_step(Method::Dop853, 0.0);
    let velocity = step.velocities[1];
    let motion = step.end[1] - step.start[1];
    let near = SegmentPolynomial::integrated(0.0, motion, &velocity);
    let place = f64::EPSILON * 1e6;
    for far in (0..50).map(|index| 1e6 + 0.123 * f64::from(index)) {
        let shifted = SegmentPolynomial::integrated(far, far + motion, &velocity);
        assert_eq!(shifted.value_at(0.0), far);
        assert!((shifted.value_at(STEP) - (far + motion)).abs() <= 2.0 * f64::EPSILON * far);
        for index in 0..=20 {
            let at = STEP * f64::from(index) / 20.0;
            assert!((shifted.value_at(at) - far - near.value_at(at)).abs() <= place, "at {at}");
            assert!(
                (shifted.derivative_at(at) - near.derivative_at(at)).abs() < 8.0 * place / STEP,
                "at {at}"
            );
        }
    }
}
