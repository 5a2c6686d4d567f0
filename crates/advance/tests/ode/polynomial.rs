//! Evaluation and bounds of polynomials along a step.

use crate::problem::{Planet, SIZE, dense, exact, rates_at};
use halfgap_advance::ode::{Method, Point, SegmentPolynomial, Spread, Stepper};

const STEP: f64 = 0.4;

/// The position of the planet over a step, with all powers up to 8.
fn position() -> SegmentPolynomial {
    let (mut stepper, start, mut end) = (Stepper::new(Method::Dop853), exact(0.0), [0.0; SIZE]);
    let rates = rates_at(0.0, &start);
    let Ok(()) = stepper.step(
        &mut Planet::default(),
        Point { offset: 0.0, state: &start, rates: &rates },
        STEP,
        &mut end,
    );
    let end_rates = rates_at(STEP, &end);
    let velocities = dense(&mut stepper, Point { offset: STEP, state: &end, rates: &end_rates });
    SegmentPolynomial::integrated(start[0], end[0], &velocities[0])
}

/// The derivative of a given order by its definition.
fn derivative_by_powers(polynomial: &SegmentPolynomial, order: usize, offset: f64) -> f64 {
    let s = 2.0 * offset / polynomial.step() - 1.0;
    let unit = (2.0 / polynomial.step()).powi(order as i32);
    let terms = polynomial.coefficients().iter().enumerate().skip(order).map(|(power, coefficient)| {
        let falling: f64 = (0..order).map(|less| (power - less) as f64).product();
        falling * coefficient * s.powi((power - order) as i32)
    });
    unit * terms.sum::<f64>()
}

fn offsets() -> impl Iterator<Item = f64> {
    (0..=40).map(|index| STEP * f64::from(index) / 40.0)
}

#[test]
fn all_coefficients_take_part() {
    assert!(position().coefficients().iter().all(|coefficient| coefficient.abs() > 1e-12));
}

#[test]
fn values_and_derivatives_are_those_of_the_definition() {
    let polynomial = position();
    for offset in offsets() {
        let jet = polynomial.jet_at(offset);
        let found = [
            [polynomial.value_at(offset), jet.value],
            [polynomial.derivative_at(offset), jet.derivative],
            [polynomial.second_derivative_at(offset), jet.second_derivative],
        ];
        for (order, found) in found.into_iter().enumerate() {
            let expected = derivative_by_powers(&polynomial, order, offset);
            for found in found {
                let rounding = 1e-14 * (2.0 / STEP).powi(order as i32);
                assert!((found - expected).abs() < rounding, "derivative {order}: {found} for {expected}");
            }
        }
    }
}

#[test]
fn spreads_hold_along_the_step_and_are_not_idle() {
    let polynomial = position();
    let spreads: [Spread; 4] = [
        polynomial.value_spread(),
        polynomial.derivative_spread(),
        polynomial.second_derivative_spread(),
        polynomial.third_derivative_spread(),
    ];
    for (order, spread) in spreads.into_iter().enumerate() {
        let values = || offsets().map(|offset| derivative_by_powers(&polynomial, order, offset));
        let farthest = values().map(|value| (value - spread.center).abs()).fold(0.0, f64::max);
        assert!(farthest <= spread.radius * (1.0 + 1e-13), "derivative {order}");
        assert!(spread.radius < 2.0 * farthest, "derivative {order}: {} for {farthest}", spread.radius);
        assert!(values().all(|value| value.abs() <= spread.largest() * (1.0 + 1e-13)), "derivative {order}");
    }
}
