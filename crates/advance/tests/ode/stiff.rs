//! Systems with parts that decay much faster than anything moves.

use halfgap_advance::ode::{Method, Ode, Point, SegmentPolynomial, Stepper, is_kept};
use std::convert::Infallible;

/// Rate [1/s] at which the fast part decays.
const FAST: f64 = 1e6;

/// A body that is dragged along by a medium which moves as `cos t`: position, velocity, and the heat `FAST
/// (v - cos t)^2`.
///
/// v' = -FAST (v - cos t) - sin t, whose slow solution is v = cos t, x = sin t.
#[derive(Default)]
struct Dragged {
    derivatives: usize,
}

impl Ode for Dragged {
    type Error = Infallible;

    fn derivative(&mut self, offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        self.derivatives += 1;
        let lag = state[1] - offset.cos();
        rates.copy_from_slice(&[state[1], -FAST * lag - offset.sin(), FAST * lag * lag]);
        Ok(())
    }
}

impl Dragged {
    fn rates_at(&mut self, offset: f64, state: &[f64; 3]) -> [f64; 3] {
        let mut rates = [0.0; 3];
        let Ok(()) = self.derivative(offset, state, &mut rates);
        rates
    }
}

const TIME: f64 = 10.0;

/// Integrates for [`TIME`] from a velocity, with steps that follow a tolerance. Returns the state, the number of
/// steps, and the largest error of the velocity between the ends of steps once the fast part has decayed.
fn solve(method: Method, velocity: f64, tolerance: f64, most: usize) -> ([f64; 3], usize, f64) {
    let (mut stepper, mut dragged) = (Stepper::new(method), Dragged::default());
    let scales = [tolerance; 2];
    stepper.set_scales(&scales);
    let (mut offset, mut state, mut step, mut steps) = (0.0, [0.0, velocity, 0.0], 1e-8, 0);
    let mut inner: f64 = 0.0;
    while offset < TIME && steps < most {
        step = f64::min(step, TIME - offset);
        let rates = dragged.rates_at(offset, &state);
        let mut end = [0.0; 3];
        let Ok(()) =
            stepper.step(&mut dragged, Point { offset, state: &state, rates: &rates }, step, &mut end);
        let norm = stepper.error_norm(&scales);
        if norm <= 1.0 {
            let rates = dragged.rates_at(offset + step, &end);
            let mut velocity = [SegmentPolynomial::default()];
            let end_point = Point { offset: offset + step, state: &end, rates: &rates };
            let Ok(()) = stepper.dense(&mut dragged, end_point, 1..2, &mut velocity);
            if offset > 1e-3 {
                inner = inner.max((velocity[0].value_at(0.4 * step) - (offset + 0.4 * step).cos()).abs());
            }
            (offset, state, steps) = (offset + step, end, steps + 1);
        }
        step *= method.step_factor(norm);
    }
    (state, steps, inner)
}

#[test]
fn steps_follow_the_slow_motion() {
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let (state, steps, inner) = solve(Method::RadauIia5, 1.0, tolerance, 100_000);
        assert!(steps < 2000, "{tolerance:e}: {steps}");
        assert!((state[0] - TIME.sin()).abs() < 100.0 * tolerance, "{tolerance:e}: {state:?}");
        assert!((state[1] - TIME.cos()).abs() < tolerance, "{tolerance:e}: {state:?}");
        assert!(inner < 10.0 * tolerance, "{tolerance:e}: {inner:e}");
    }
    // An explicit method needs FAST TIME / 6 steps.
    let (_, steps, _) = solve(Method::Dop853, 1.0, 1e-4, 10_000);
    assert_eq!(steps, 10_000);
}

#[test]
fn a_transient_is_followed_as_far_as_the_tolerance_asks() {
    // From rest the velocity goes to 1 within some 1e-6 s; the heat of that transient is 1/2.
    let (state, _, _) = solve(Method::RadauIia5, 0.0, 1e-8, 100_000);
    assert!((state[2] - 0.5).abs() < 1e-7, "{state:?}");
    assert!((state[1] - TIME.cos()).abs() < 1e-8, "{state:?}");
}

#[test]
fn a_transient_that_has_yet_to_decay_is_not_stepped_over() {
    let (mut dragged, mut stepper) = (Dragged::default(), Stepper::new(Method::RadauIia5));
    let scales = [1e-4; 2];
    stepper.set_scales(&scales);
    let state = [0.0; 3];
    let rates = dragged.rates_at(0.0, &state);
    let mut end = [0.0; 3];
    let Ok(()) =
        stepper.step(&mut dragged, Point { offset: 0.0, state: &state, rates: &rates }, 0.1, &mut end);
    // The end is right, but the motion along the step would not be.
    assert!((end[1] - 0.1f64.cos()).abs() < 1e-4, "{end:?}");
    assert!(stepper.error_norm(&scales) > 1.0);
}

#[test]
fn the_decay_that_holds_steps_up_is_told() {
    let mut dragged = Dragged::default();
    for (method, step) in [(Method::Dop853, 3e-6), (Method::DormandPrince5, 2e-6), (Method::RadauIia5, 1e-3)]
    {
        let mut stepper = Stepper::new(method);
        let state = [0.0, 1.0 + 1e-6, 0.0];
        let rates = dragged.rates_at(0.0, &state);
        let mut end = [0.0; 3];
        let scales = [1e-8; 2];
        stepper.set_scales(&scales);
        let start = Point { offset: 0.0, state: &state, rates: &rates };
        let Ok(()) = stepper.step(&mut dragged, start, step, &mut end);
        let rates = dragged.rates_at(step, &end);
        let told = stepper.stiffness(Point { offset: step, state: &end, rates: &rates }, &scales).fastest;
        assert!((told / (FAST * step) - 1.0).abs() < 0.1, "{method:?}: {told}");
    }
}

/// y' = -y.
struct Decay;

impl Ode for Decay {
    type Error = Infallible;

    fn derivative(&mut self, _offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        rates[0] = -state[0];
        Ok(())
    }
}

#[test]
fn motion_that_swings_at_the_limit_of_stability_is_told() {
    // Near 5.7 the error estimate of DOP853 all but vanishes, while dense output errs by hundreds of times that.
    for tenth in 50..70 {
        let step = f64::from(tenth) / 10.0;
        let mut stepper = Stepper::new(Method::Dop853);
        let mut end = [0.0];
        let start = Point { offset: 0.0, state: &[1.0], rates: &[-1.0] };
        let Ok(()) = stepper.step(&mut Decay, start, step, &mut end);
        let rates = [-end[0]];
        let end = Point { offset: step, state: &end, rates: &rates };
        let told = stepper.stiffness(end, &[1.0]);
        let mut path = [SegmentPolynomial::default()];
        let Ok(()) = stepper.dense(&mut Decay, end, 0..1, &mut path);
        let places = (0..=100).map(|part| step * f64::from(part) / 100.0);
        let error = places.map(|x| (path[0].value_at(x) - (-x).exp()).abs()).fold(0.0, f64::max);
        assert!((told.fastest / step - 1.0).abs() < 1e-6, "{step}: {told:?}");
        assert!((1.0..2.0).contains(&(told.dense_error / error)), "{step}: {told:?}, {error}");
    }
}

/// A light lever that turns against a medium towards the direction of a force: angle, spin, and the heat `w^2`.
///
/// w' = FAST (PULL cos a - w), so that the heat is PULL (sin a - sin a0) - (w^2 - w0^2)/(2 FAST).
struct Lever;

const PULL: f64 = 60.0;

impl Ode for Lever {
    type Error = Infallible;

    fn derivative(&mut self, _offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        let [angle, spin] = [state[0], state[1]];
        rates.copy_from_slice(&[spin, FAST * (PULL * angle.cos() - spin), spin * spin]);
        Ok(())
    }
}

#[test]
fn the_heat_of_what_follows_a_slow_motion_is_that_of_where_it_comes_to() {
    // The spin follows the angle one correction later. The first correction, of the angle by all that it turns, leaves
    // little in comparison, but this says nothing about the spin.
    let (mut lever, mut stepper) = (Lever, Stepper::new(Method::RadauIia5));
    stepper.set_scales(&[1e-13, 5e-9]);
    let (angle, step) = (0.3f64, 3e-5);
    let start = [angle, PULL * angle.cos(), 0.0];
    let mut rates = [0.0; 3];
    let Ok(()) = lever.derivative(0.0, &start, &mut rates);
    let mut end = [0.0; 3];
    let Ok(()) =
        stepper.step(&mut lever, Point { offset: 0.0, state: &start, rates: &rates }, step, &mut end);
    let kept = (end[1] * end[1] - start[1] * start[1]) / (2.0 * FAST);
    let expected = PULL * (end[0].sin() - angle.sin()) - kept;
    assert!((end[2] - expected).abs() < 1e-10 * expected, "{end:?}: {expected}");
}

/// A system at rest whose rate has a rounding error that differs from call to call.
#[derive(Default)]
struct Trembling {
    times: f64,
}

impl Ode for Trembling {
    type Error = Infallible;

    fn derivative(&mut self, _offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        self.times += 1.0;
        rates[0] = -FAST * state[0] + 1e-12 * self.times * self.times;
        Ok(())
    }
}

#[test]
fn a_system_at_rest_takes_long_steps_however_its_rates_are_rounded() {
    let (mut trembling, mut stepper) = (Trembling::default(), Stepper::new(Method::RadauIia5));
    let scales = [1e-8];
    stepper.set_scales(&scales);
    for step in [1e-2, 1.0, 1e2].map(|times| times / FAST) {
        let (start, mut rates, mut end) = ([0.0], [0.0], [0.0]);
        let Ok(()) = trembling.derivative(0.0, &start, &mut rates);
        let from = Point { offset: 0.0, state: &start, rates: &rates };
        let Ok(()) = stepper.step(&mut trembling, from, step, &mut end);
        assert!(stepper.error_norm(&scales) < 1e-3, "{step}: {}", stepper.error_norm(&scales));
    }
}

/// A system whose rates are NaN.
struct Nothing;

impl Ode for Nothing {
    type Error = Infallible;

    fn derivative(&mut self, _offset: f64, _state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        rates.fill(f64::NAN);
        Ok(())
    }
}

#[test]
fn a_state_that_is_not_found_is_told_and_is_the_start() {
    let (mut stepper, mut end) = (Stepper::new(Method::RadauIia5), [0.0]);
    let start = Point { offset: 0.0, state: &[2.0], rates: &[1.0] };
    let Ok(()) = stepper.step(&mut Nothing, start, 0.1, &mut end);
    assert_eq!((end, stepper.error_norm(&[1.0])), ([2.0], f64::INFINITY));
}

/// A tank that runs dry: its rate is NaN below zero.
struct Tank;

impl Ode for Tank {
    type Error = Infallible;

    fn derivative(&mut self, _offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        rates[0] = -state[0].sqrt();
        Ok(())
    }
}

#[test]
fn a_step_to_where_there_are_no_rates_is_none() {
    for method in [Method::RadauIia5, Method::Dop853, Method::DormandPrince5] {
        let mut stepper = Stepper::new(method);
        let mut end = [0.0];
        let start = Point { offset: 0.0, state: &[1.0], rates: &[-1.0] };
        for step in [1.5, f64::INFINITY] {
            let Ok(()) = stepper.step(&mut Tank, start, step, &mut end);
            let error = stepper.error_norm(&[1e-9]);
            assert!(!is_kept(error), "{method:?}, {step} s: {error}, {end:?}");
        }
        let Ok(()) = stepper.step(&mut Tank, start, 1e-3, &mut end);
        assert!(is_kept(stepper.error_norm(&[1e-9])), "{method:?}");
        // A step of no length is exact.
        let Ok(()) = stepper.step(&mut Tank, start, 0.0, &mut end);
        assert_eq!((end, stepper.error_norm(&[1e-9])), ([1.0], 0.0), "{method:?}");
    }
}

#[test]
fn an_empty_system_goes_on_by_any_method() {
    for method in [Method::RadauIia5, Method::Dop853, Method::DormandPrince5, Method::Euler] {
        let mut stepper = Stepper::new(method);
        stepper.set_scales(&[]);
        let from = Point { offset: 0.0, state: &[], rates: &[] };
        let Ok(_) = stepper.step(&mut Nothing, from, 0.1, &mut []);
        assert_eq!(stepper.error_norm(&[]), 0.0, "{method:?}");
    }
}

/// Two components that decay, each at its rate [1/s].
struct Pair([f64; 2]);

impl Ode for Pair {
    type Error = Infallible;

    fn derivative(&mut self, _offset: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        for (rate, (&value, &decay)) in rates.iter_mut().zip(state.iter().zip(&self.0)) {
            *rate = -decay * value;
        }
        Ok(())
    }
}

#[test]
fn a_component_that_becomes_fast_in_place_of_another_is_told() {
    let (mut stepper, step, scales) = (Stepper::new(Method::RadauIia5), 1e-2, [1e-6; 2]);
    stepper.set_scales(&scales);
    let mut told = |decay: [f64; 2], steps: usize| {
        let mut fastest = 0.0;
        for _ in 0..steps {
            let (state, rates, mut end) = ([1.0; 2], decay.map(|decay| -decay), [0.0; 2]);
            let start = Point { offset: 0.0, state: &state, rates: &rates };
            let Ok(()) = stepper.step(&mut Pair(decay), start, step, &mut end);
            let rates = [-decay[0] * end[0], -decay[1] * end[1]];
            fastest = stepper.stiffness(Point { offset: step, state: &end, rates: &rates }, &scales).fastest;
        }
        fastest
    };
    for decay in [[1e6, 1.0], [1.0, 1e6], [1e6, 1.0]] {
        let fastest = told(decay, 60);
        assert!((fastest / (1e6 * step) - 1.0).abs() < 1e-2, "{decay:?}: {fastest}");
    }
}
