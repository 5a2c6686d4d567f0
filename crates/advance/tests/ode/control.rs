//! Step control: errors follow the tolerance, steps follow the errors.

use crate::problem::{Planet, SIZE, exact, rates_at, solve_to_tolerance};
use halfgap_advance::ode::{Accepted, Method, Ode, Point, Stepper};
use std::convert::Infallible;

const TIME: f64 = 10.0;

/// Slope of the line of least squares.
fn slope(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let (mean_x, mean_y) =
        points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / count, sum.1 + p.1 / count));
    let xy: f64 = points.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum();
    let xx: f64 = points.iter().map(|p| (p.0 - mean_x) * (p.0 - mean_x)).sum();
    xy / xx
}

#[test]
fn errors_fall_with_the_tolerance_as_the_orders_say() {
    for method in [Method::Dop853, Method::DormandPrince5, Method::RadauIia5] {
        let points: Vec<(f64, f64)> = (5..=12)
            .map(|digits| {
                let solution = solve_to_tolerance(method, TIME, 10_f64.powi(-digits));
                assert!(solution.rejected < solution.steps / 2, "{method:?}: {} rejected", solution.rejected);
                (-f64::from(digits), solution.error.log10())
            })
            .collect();
        let slope = slope(&points);
        // The error falls in proportion to the tolerance, unless the estimate is more than one order below the method.
        let expected =
            method.error_order().map_or(1.0, |order| f64::from(method.order()) / f64::from(order + 1));
        assert!((slope - expected).abs() < 0.2, "{method:?}: {slope}, {expected} expected");
    }
}

#[test]
fn the_estimate_falls_with_its_order() {
    for (method, step) in [(Method::Dop853, 0.02), (Method::DormandPrince5, 0.02), (Method::RadauIia5, 0.02)]
    {
        let norm = |step: f64| {
            let (mut stepper, state, mut end) = (Stepper::new(method), exact(1.0), [0.0; SIZE]);
            let rates = rates_at(1.0, &state);
            let start = Point { offset: 1.0, state: &state, rates: &rates };
            let Ok(()) = stepper.step(&mut Planet::default(), start, step, &mut end);
            stepper.error_norm(&[1e-9; SIZE])
        };
        let order = (norm(4.0 * step) / norm(2.0 * step)).log2();
        let expected = method.error_order().map(|order| f64::from(order + 1));
        assert!(expected.is_some_and(|expected| (order - expected).abs() < 0.5), "{method:?}: {order}");
    }
}

#[test]
fn an_open_step_that_is_closed_is_a_step() {
    for method in [Method::Dop853, Method::DormandPrince5, Method::RadauIia5] {
        let (state, mut end, mut open_end) = (exact(1.0), [0.0; SIZE], [0.0; SIZE]);
        let rates = rates_at(1.0, &state);
        let start = Point { offset: 1.0, state: &state, rates: &rates };
        let (mut stepper, mut opened) = (Stepper::new(method), Stepper::new(method));
        let (mut planet, mut saving) = (Planet::default(), Planet::default());
        let Ok(()) = stepper.step(&mut planet, start, 0.1, &mut end);
        let Ok(()) = opened.step_open(&mut saving, start, 0.1, &mut open_end);
        assert_eq!(open_end, end, "{method:?}");
        let saved = usize::from(opened.needs_end_rates());
        assert_eq!(saving.derivatives + saved, planet.derivatives, "{method:?}");
        opened.close(&rates_at(1.1, &end));
        let scales = [1e-9; SIZE];
        assert_eq!(opened.error_norm(&scales), stepper.error_norm(&scales), "{method:?}");
    }
    assert!(Stepper::new(Method::DormandPrince5).needs_end_rates());
}

#[test]
fn the_norm_is_measured_by_the_scales() {
    let (mut stepper, state, mut end) = (Stepper::new(Method::Dop853), exact(1.0), [0.0; SIZE]);
    let rates = rates_at(1.0, &state);
    let start = Point { offset: 1.0, state: &state, rates: &rates };
    let Ok(()) = stepper.step(&mut Planet::default(), start, 0.3, &mut end);
    let norm = stepper.error_norm(&[1e-9; SIZE]);
    assert!(norm > 0.0);
    assert!((stepper.error_norm(&[1e-8; SIZE]) / norm - 0.1).abs() < 1e-12);
    assert_eq!(stepper.error_norm(&[]), 0.0);
}

#[test]
fn methods_with_fixed_steps_keep_their_step() {
    let (mut stepper, state, mut end) = (Stepper::new(Method::Rk4), exact(1.0), [0.0; SIZE]);
    let rates = rates_at(1.0, &state);
    let start = Point { offset: 1.0, state: &state, rates: &rates };
    let Ok(proposed) = stepper.starting_step(&mut Planet::default(), start, &[1e-9; SIZE], 0.25);
    assert_eq!(proposed, 0.25);
    let Ok(()) = stepper.step(&mut Planet::default(), start, 0.25, &mut end);
    assert_eq!(stepper.error_norm(&[1e-9; SIZE]), 0.0);
    assert_eq!(Method::Rk4.step_factor(0.0), 1.0);
}

#[test]
fn steps_shrink_after_large_errors_and_grow_after_small_ones_within_limits() {
    for method in [Method::Dop853, Method::DormandPrince5] {
        assert!(method.is_adaptive());
        let factors =
            [f64::NAN, f64::INFINITY, 1e30, 2.0, 1.0, 0.1, 1e-30, 0.0].map(|norm| method.step_factor(norm));
        assert!(factors.is_sorted(), "{factors:?}");
        assert_eq!(factors[0], factors[2]);
        assert_eq!(factors[6], factors[7]);
        assert!(factors[3] < factors[4] && factors[4] < 1.0 && factors[6] > 1.0);
        assert_eq!(method.step_factor_after_rejection(0.0), 1.0);
        // An error 2^(order + 1) times smaller allows twice the step.
        let smaller = method.error_order().map_or(0.0, |order| 0.5_f64.powi(order as i32 + 1));
        assert!((method.step_factor(smaller) - 2.0 * method.step_factor(1.0)).abs() < 1e-12);
    }
}

#[test]
fn an_error_that_grows_from_step_to_step_is_foreseen() {
    let method = Method::Dop853;
    let before = Accepted { length: 0.2, error: 0.5 };
    // Step 0.16 has the error of step 0.2, a fifth longer: the next step is to be shorter by the same ratio, 0.8.
    let step = Accepted { length: 0.16, error: 0.5 };
    let ratio = method.factor_after(step, Some(before)) / method.factor_after(step, None);
    assert!((ratio - 0.8).abs() < 1e-12, "{ratio}");
    // An error that falls, or is too small to tell, lets the step grow as usual.
    let calm = Accepted { length: 0.2, error: 1e-9 };
    for step in [Accepted { length: 0.2, error: 0.3 }, calm] {
        assert_eq!(method.factor_after(step, Some(before)), method.step_factor(step.error));
    }
    assert_eq!(Method::Rk4.factor_after(step, Some(before)), 1.0);
}

#[test]
fn the_first_step_is_nearly_acceptable_and_not_far_too_short() {
    for tolerance in [1e-5, 1e-8, 1e-11] {
        let (mut stepper, state, mut end) = (Stepper::new(Method::Dop853), exact(0.0), [0.0; SIZE]);
        let rates = rates_at(0.0, &state);
        let start = Point { offset: 0.0, state: &state, rates: &rates };
        let scales = [tolerance; SIZE];
        let Ok(step) = stepper.starting_step(&mut Planet::default(), start, &scales, 1.0);
        let Ok(()) = stepper.step(&mut Planet::default(), start, step, &mut end);
        let ideal = step * Method::Dop853.step_factor(stepper.error_norm(&scales));
        assert!(ideal > 0.5 * step && ideal <= 6.0 * step, "{tolerance}: {step} for {ideal}");
        let Ok(limited) = stepper.starting_step(&mut Planet::default(), start, &scales, 1e-3);
        assert!(limited <= 1e-3);
    }
}

#[test]
fn the_first_step_back_is_as_long_as_the_one_ahead() {
    let mut stepper = Stepper::new(Method::Dop853);
    let (state, rates) = (exact(0.0), rates_at(0.0, &exact(0.0)));
    let start = Point { offset: 0.0, state: &state, rates: &rates };
    let mut first = |limit: f64| {
        let Ok(step) = stepper.starting_step(&mut Planet::default(), start, &[1e-9; SIZE], limit);
        step
    };
    let (ahead, back) = (first(10.0), first(-10.0));
    assert!(back < 0.0 && (ahead / -back - 1.0).abs() < 0.1, "{ahead} s ahead, {back} s back");
    assert_eq!(first(-1e-6), -1e-6);
}

#[test]
fn the_first_step_follows_the_tolerance_as_the_estimate_does() {
    // For DOP853 the error of a step falls as its 8th power.
    let proposed = |tolerance: f64| {
        let (mut stepper, state) = (Stepper::new(Method::Dop853), exact(0.0));
        let rates = rates_at(0.0, &state);
        let start = Point { offset: 0.0, state: &state, rates: &rates };
        let Ok(step) = stepper.starting_step(&mut Planet::default(), start, &[tolerance; SIZE], 1.0);
        step
    };
    assert!((proposed(1e-5) / proposed(1e-13) - 10.0).abs() < 1e-9);
}

/// A fall along a line, or a system in which nothing moves.
struct Fall {
    gravity: f64,
}

impl Ode for Fall {
    type Error = Infallible;

    fn derivative(&mut self, _offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        rates.copy_from_slice(&[state[1], -self.gravity]);
        Ok(())
    }
}

#[test]
fn the_first_step_from_rest_is_short_but_positive() {
    for gravity in [9.81, 0.0] {
        let mut stepper = Stepper::new(Method::Dop853);
        let start = Point { offset: 0.0, state: &[0.0, 0.0], rates: &[0.0, -gravity] };
        let Ok(step) = stepper.starting_step(&mut Fall { gravity }, start, &[1e-9; 2], 1.0);
        assert!(step > 0.0 && step <= 1e-4, "{gravity}: {step:e}");
    }
}

#[test]
fn an_error_of_the_system_is_passed_on() {
    struct Refusing;
    impl Ode for Refusing {
        type Error = f64;
        fn derivative(&mut self, offset: f64, _state: &[f64], rates: &mut [f64]) -> Result<(), f64> {
            rates.fill(1.0);
            if offset > 0.5 { Err(offset) } else { Ok(()) }
        }
    }
    let start = Point { offset: 0.0, state: &[0.0], rates: &[1.0] };
    let mut stepper = Stepper::new(Method::Rk4);
    assert_eq!(stepper.step(&mut Refusing, start, 1.0, &mut [0.0]), Err(1.0));
    let mut end = [0.0];
    assert_eq!(stepper.step(&mut Refusing, start, 0.5, &mut end), Ok(()));
    assert!((end[0] - 0.5).abs() < 1e-15);
}
