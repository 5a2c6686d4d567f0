//! Tableaux of explicit Runge-Kutta methods, and those of the classical methods with fixed steps.
//!
//! Only coefficients that are not zero are written down. Stage 0 holds the rates at the start of a step, which the
//! caller knows; the next places the rates of `stages`, then comes the place of the rates at the end, then those of
//! `dense_stages`.
//!
//! Dense output has the form of E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd
//! ed., Springer 1993, II.6 (and of the authors' programs), where `x` is the fraction of the step that has passed, and
//! `z` the fraction left:
//!
//! ```text
//! y(x) = y0 + x (c2 + z (c3 + x (c4 + z (c5 + x (c6 + z (c7 + x c8))))))
//! ```
//!
//! Here `c2`, `c3`, `c4` make it the cubic of Hermite, and the others are weighted sums of the stages times the step.

use super::method::Method;

/// A stage and the weight of its rates.
pub(super) type Term = (usize, f64);

/// A stage: at the fraction `node` of the step, from the start along the weighted rates of earlier stages.
#[derive(Debug)]
pub(super) struct Stage {
    pub(super) node: f64,
    pub(super) terms: &'static [Term],
}

/// Error of dense output at the limit of stability, which the error estimate does not show: a part whose rate of decay
/// times the step is `from` or more makes it err by up to `by` times the difference between the last stage and the end.
#[derive(Debug)]
pub(super) struct Swing {
    pub(super) from: f64,
    pub(super) by: f64,
}

/// The coefficients of a method.
#[derive(Debug)]
pub(super) struct Tableau {
    /// The method whose coefficients they are.
    pub(super) method: Method,
    /// Stages 1, 2, ...
    pub(super) stages: &'static [Stage],
    /// Weights that give the end state.
    pub(super) weights: &'static [Term],
    /// Weights of up to two error estimates, the one of higher order first.
    pub(super) errors: &'static [&'static [Term]],
    /// True if an error estimate uses the rates at the end.
    pub(super) needs_end_rates: bool,
    /// Stages that only dense output needs.
    pub(super) dense_stages: &'static [Stage],
    /// Weights of `c5`, `c6`, ...
    pub(super) dense_rows: &'static [&'static [Term]],
    /// Swing of dense output; `None` if it errs by no more than the error estimate there.
    pub(super) swing: Option<Swing>,
}

impl Tableau {
    /// The place of the rates at the end.
    pub(super) fn end_stage(&self) -> usize {
        self.stages.len() + 1
    }

    /// Number of places of rates.
    pub(super) fn places(&self) -> usize {
        self.end_stage() + 1 + self.dense_stages.len()
    }
}

const fn fixed(method: Method, stages: &'static [Stage], weights: &'static [Term]) -> Tableau {
    Tableau {
        method,
        stages,
        weights,
        errors: &[],
        needs_end_rates: false,
        dense_stages: &[],
        dense_rows: &[],
        swing: None,
    }
}

/// Euler's method: along the rates at the start.
pub(super) const EULER: Tableau = fixed(Method::Euler, &[], &[(0, 1.0)]);

/// Heun's method: along the mean of the rates at the start and at the end of a step of Euler (K. Heun 1900).
pub(super) const MODIFIED_EULER: Tableau =
    fixed(Method::ModifiedEuler, &[Stage { node: 1.0, terms: &[(0, 1.0)] }], &[(0, 0.5), (1, 0.5)]);

/// The classical method of order 4 (W. Kutta 1901).
pub(super) const RK4: Tableau = fixed(
    Method::Rk4,
    &[
        Stage { node: 0.5, terms: &[(0, 0.5)] },
        Stage { node: 0.5, terms: &[(1, 0.5)] },
        Stage { node: 1.0, terms: &[(2, 1.0)] },
    ],
    &[(0, 1.0 / 6.0), (1, 1.0 / 3.0), (2, 1.0 / 3.0), (3, 1.0 / 6.0)],
);

#[cfg(test)]
mod tests {
    use super::super::method::Method;
    use super::*;

    /// Rounding of sums whose terms are as large as the weights.
    fn rounding(terms: &[Term]) -> f64 {
        4.0 * f64::EPSILON * terms.iter().fold(1.0, |sum, term| sum + term.1.abs())
    }

    /// The node of every place, and the stages in their places.
    fn places(tableau: &Tableau) -> Vec<(f64, &[Term])> {
        let start = [(0.0, [].as_slice())];
        let end = [(1.0, tableau.weights)];
        let stages = tableau.stages.iter().map(|stage| (stage.node, stage.terms));
        let dense = tableau.dense_stages.iter().map(|stage| (stage.node, stage.terms));
        start.into_iter().chain(stages).chain(end).chain(dense).collect()
    }

    /// `sum_i w_i c_i^power`
    fn moment(tableau: &Tableau, terms: &[Term], power: i32) -> f64 {
        let places = places(tableau);
        terms.iter().map(|&(stage, weight)| weight * places[stage].0.powi(power)).sum()
    }

    const METHODS: [Method; 5] =
        [Method::Dop853, Method::DormandPrince5, Method::Rk4, Method::ModifiedEuler, Method::Euler];

    #[test]
    fn rows_use_earlier_stages_and_sum_to_their_nodes() {
        for method in METHODS {
            let tableau = method.tableau().expect("it is explicit");
            let places = places(tableau);
            assert_eq!(places.len(), tableau.places());
            for (place, (node, terms)) in places.into_iter().enumerate() {
                assert!(terms.iter().all(|term| term.0 < place), "{method:?}, stage {place}");
                let sum: f64 = terms.iter().map(|term| term.1).sum();
                assert!((sum - node).abs() <= rounding(terms), "{method:?}, stage {place}: {sum} for {node}");
            }
        }
    }

    /// Least defect that is not rounding.
    const SMALLEST_DEFECT: f64 = 1e-6;

    #[test]
    fn weights_integrate_polynomials_up_to_the_order_and_no_further() {
        for method in METHODS {
            let tableau = method.tableau().expect("it is explicit");
            let defect =
                |power: u32| moment(tableau, tableau.weights, power as i32) - 1.0 / f64::from(power + 1);
            for power in 0..method.order() {
                assert!(defect(power).abs() <= rounding(tableau.weights), "{method:?}: t^{power}");
            }
            assert!(defect(method.order()).abs() > SMALLEST_DEFECT, "{method:?}");
        }
    }

    #[test]
    fn weights_meet_the_conditions_of_two_levels() {
        // sum b_i c_i^m a_ij c_j^n = 1 / ((n + 1) (m + n + 2)) for m + n + 2 up to the order.
        for method in METHODS {
            let tableau = method.tableau().expect("it is explicit");
            let places = places(tableau);
            for order in 2..=method.order() as i32 {
                for power in 0..=order - 2 {
                    let outer = order - 2 - power;
                    let sum: f64 = tableau
                        .weights
                        .iter()
                        .map(|&(stage, weight)| {
                            let (node, terms) = places[stage];
                            weight * node.powi(outer) * moment(tableau, terms, power)
                        })
                        .sum();
                    let exact = 1.0 / f64::from((power + 1) * order);
                    assert!(
                        (sum - exact).abs() <= 8.0 * rounding(tableau.weights),
                        "{method:?}: {outer}, {power}"
                    );
                }
            }
        }
    }

    #[test]
    fn error_estimates_vanish_up_to_their_order_and_no_further() {
        let orders: [(Method, &[i32]); 2] = [(Method::Dop853, &[5, 3]), (Method::DormandPrince5, &[4])];
        for (method, orders) in orders {
            let tableau = method.tableau().expect("it is explicit");
            assert_eq!(tableau.errors.len(), orders.len());
            for (terms, &order) in tableau.errors.iter().zip(orders) {
                for power in 0..order {
                    assert!(moment(tableau, terms, power).abs() <= rounding(terms), "{method:?}: t^{power}");
                }
                assert!(moment(tableau, terms, order).abs() > 1e-4, "{method:?}, estimate of order {order}");
            }
        }
    }
}
