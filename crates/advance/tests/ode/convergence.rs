//! Measured orders.

use crate::problem::{Errors, Planet, SIZE, distance, exact, rates_at, solve_in_steps};
use halfgap_advance::ode::{Method, Ode, Point, Stepper};
use std::convert::Infallible;

const TIME: f64 = 5.0;

/// Orders measured between a number of steps and twice that number.
fn orders(method: Method, steps: u32) -> Errors {
    let (coarse, fine) = (solve_in_steps(method, TIME, steps), solve_in_steps(method, TIME, 2 * steps));
    Errors {
        end: (coarse.end / fine.end).log2(),
        velocity: (coarse.velocity / fine.velocity).log2(),
        position: (coarse.position / fine.position).log2(),
    }
}

/// Numbers of steps at which the leading term of the error rules and rounding does not.
const STEPS: [(Method, u32); 6] = [
    (Method::Dop853, 80),
    (Method::DormandPrince5, 160),
    (Method::Rk4, 320),
    (Method::ModifiedEuler, 320),
    (Method::Euler, 1280),
    (Method::RadauIia5, 160),
];

#[test]
fn ends_converge_with_the_order_of_the_method() {
    for (method, steps) in STEPS {
        let (measured, order) = (orders(method, steps).end, f64::from(method.order()));
        assert!((measured - order).abs() < 0.08 * order, "{method:?}: {measured}");
    }
}

#[test]
fn polynomials_converge_with_the_least_of_their_own_order_and_that_of_the_ends() {
    // Local errors of dense polynomials of degree 7 and 4 fall with the 8th and 5th power of the step, as do the ends
    // of those methods. Cubics do not limit methods of order 4, but they limit Radau's method, which is of order 5 at
    // the ends.
    for (method, steps) in STEPS {
        let cubic = if method == Method::RadauIia5 { 4.0 } else { f64::INFINITY };
        let (measured, order) = (orders(method, steps), f64::from(method.order()).min(cubic));
        assert!((measured.velocity - order).abs() < 0.08 * order, "{method:?}: {}", measured.velocity);
        // The position is the integral of the velocity: its error is of one order more, up to the order of the ends.
        let order = f64::from(method.order());
        assert!((measured.position - order).abs() < 0.08 * order, "{method:?}: {}", measured.position);
    }
}

#[test]
fn a_step_costs_the_derivatives_it_says() {
    let costs = [
        (Method::Dop853, 11, 3),
        (Method::DormandPrince5, 6, 0),
        (Method::Rk4, 3, 0),
        (Method::ModifiedEuler, 1, 0),
        (Method::Euler, 0, 0),
    ];
    for (method, after_the_first, for_dense) in costs {
        let (mut planet, mut stepper) = (Planet::default(), Stepper::new(method));
        let (state, mut end) = (exact(0.0), [0.0; SIZE]);
        let rates = rates_at(0.0, &state);
        let Ok(()) =
            stepper.step(&mut planet, Point { offset: 0.0, state: &state, rates: &rates }, 0.1, &mut end);
        assert_eq!(planet.derivatives, after_the_first, "{method:?}");
        let end_rates = rates_at(0.1, &end);
        let Ok(()) = stepper.dense(
            &mut planet,
            Point { offset: 0.1, state: &end, rates: &end_rates },
            0..1,
            &mut [Default::default()],
        );
        assert_eq!(planet.derivatives, after_the_first + for_dense, "{method:?}");
    }
}

/// A system that notes the times at which its rates are asked for.
#[derive(Default)]
struct Asked(Vec<f64>);

impl Ode for Asked {
    type Error = Infallible;

    fn derivative(&mut self, offset: f64, _state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        self.0.push(offset);
        rates.fill(1.0);
        Ok(())
    }
}

#[test]
fn no_rates_are_asked_for_near_the_middle_of_the_widest_interval() {
    for method in [Method::Dop853, Method::DormandPrince5] {
        let (mut asked, mut stepper, mut end) = (Asked::default(), Stepper::new(method), [0.0]);
        let start = Point { offset: 0.0, state: &[0.0], rates: &[1.0] };
        let Ok(()) = stepper.step(&mut asked, start, 1.0, &mut end);
        let end_point = Point { offset: 1.0, state: &end, rates: &[1.0] };
        let Ok(()) = stepper.dense(&mut asked, end_point, 0..1, &mut [Default::default()]);
        let middle = method.middle_between_stages().expect("it has stages");
        let nearest =
            |place: f64| asked.0.iter().fold(place, |near, offset| near.min((offset - place).abs()));
        assert!(nearest(middle) > 0.13, "{method:?}: {middle}");
        // No other place of the step is farther from them.
        let places = (1..1000).map(|place| f64::from(place) / 1000.0);
        let farthest = places.map(|place| nearest(place).min(1.0 - place)).fold(0.0, f64::max);
        assert!(farthest <= nearest(middle) + 1e-12, "{method:?}: {farthest}");
    }
    for method in [Method::Rk4, Method::Euler, Method::RadauIia5] {
        assert_eq!(method.middle_between_stages(), None, "{method:?}");
    }
}

/// Rates that are powers of the offset alone.
struct Powers;

impl Ode for Powers {
    type Error = Infallible;

    fn derivative(&mut self, offset: f64, _state: &[f64], rates: &mut [f64]) -> Result<(), Infallible> {
        for (power, rate) in (0..).zip(rates) {
            *rate = offset.powi(power);
        }
        Ok(())
    }
}

#[test]
fn powers_are_integrated_exactly_also_in_between() {
    // Exact: t^(k+1) / (k + 1), at the ends for k below the order, and in between for k below the degree of the
    // polynomials.
    let degrees = [
        (Method::Dop853, 7),
        (Method::DormandPrince5, 4),
        (Method::Rk4, 3),
        (Method::Euler, 1),
        (Method::RadauIia5, 3),
    ];
    for (method, degree) in degrees {
        let size = method.order() as usize;
        let (mut stepper, mut end) = (Stepper::new(method), vec![0.0; size]);
        let (state, mut rates) = (vec![0.0; size], vec![0.0; size]);
        let Ok(()) = Powers.derivative(0.0, &state, &mut rates);
        let start = Point { offset: 0.0, state: &state, rates: &rates };
        let Ok(()) = stepper.step(&mut Powers, start, 2.0, &mut end);
        let integral = |power: usize, time: f64| time.powi(power as i32 + 1) / (power as f64 + 1.0);
        for (power, end) in end.iter().enumerate() {
            assert!((end - integral(power, 2.0)).abs() < 1e-14 * 256.0, "{method:?}: t^{power}");
        }
        let (mut end_rates, mut out) = (vec![0.0; size], vec![Default::default(); size]);
        let Ok(()) = Powers.derivative(2.0, &end, &mut end_rates);
        let end_point = Point { offset: 2.0, state: &end, rates: &end_rates };
        let Ok(()) = stepper.dense(&mut Powers, end_point, 0..size, &mut out);
        for (power, polynomial) in out.iter().enumerate().take(degree) {
            for at in [0.2, 0.7, 1.3, 1.9] {
                let error = (polynomial.value_at(at) - integral(power, at)).abs();
                assert!(error < 1e-14 * 256.0, "{method:?}: t^{power} at {at}: {error:e}");
            }
        }
    }
}

#[test]
fn going_back_returns_to_the_start() {
    // DOP853 in 160 steps is good to 1e-12 one way (see the closed form in the other tests of this module).
    let (steps, step) = (160, TIME / 160.0);
    let (mut stepper, mut planet) = (Stepper::new(Method::Dop853), Planet::default());
    let mut state = exact(0.0);
    for index in 0..2 * steps {
        let (offset, step) = if index < steps {
            (f64::from(index) * step, step)
        } else {
            (f64::from(2 * steps - index) * step, -step)
        };
        let rates = rates_at(offset, &state);
        let mut end = [0.0; SIZE];
        let Ok(()) =
            stepper.step(&mut planet, Point { offset, state: &state, rates: &rates }, step, &mut end);
        state = end;
        if index == steps - 1 {
            assert!(distance(&state, &exact(0.0)) > 0.5, "the planet moves");
        }
    }
    assert!(distance(&state, &exact(0.0)) < 3e-12, "{:e}", distance(&state, &exact(0.0)));
}

#[test]
fn one_stepper_serves_systems_of_changing_size() {
    let mut shared = Stepper::new(Method::Dop853);
    for size in [8, 3, 5, 1, 9] {
        let (state, rates) = (vec![1.0; size], vec![0.5; size]);
        let start = Point { offset: 0.5, state: &state, rates: &rates };
        let (mut end, mut end_alone) = (vec![0.0; size], vec![0.0; size]);
        let mut alone = Stepper::new(Method::Dop853);
        let Ok(()) = shared.step(&mut Powers, start, 0.25, &mut end);
        let Ok(()) = alone.step(&mut Powers, start, 0.25, &mut end_alone);
        assert_eq!(end, end_alone);
        let scales = vec![1e-9; size];
        assert_eq!(shared.error_norm(&scales), alone.error_norm(&scales));
    }
}
