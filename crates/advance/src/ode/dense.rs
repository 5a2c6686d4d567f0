//! The motion along a step as polynomials.
//!
//! The form is that of `tableau`. Its cubic part takes the values and rates at both ends as they are given, so it follows
//! an end state that was changed after the step; what the change `d` adds is `d (3 x^2 - 2 x^3)`.

use super::polynomial::SegmentPolynomial;
use super::stepper::{Stepper, weighted_sum};
use super::{Ode, Point};
use std::ops::Range;

/// Coefficients `c2` to `c8` of the form.
const NESTED: usize = 7;

impl Stepper {
    /// Writes some components of the motion along the last step as polynomials, one of `out` for each.
    ///
    /// `end` is the state at the end, as the step gave it or changed by about its error, with its rates; at both ends the
    /// polynomials have exactly the values and rates given. The degree is 7 for DOP853, which asks for three more
    /// derivatives, 4 for Dormand-Prince 5, and 3 for the others.
    ///
    /// # Errors
    /// The first error of the system; then `out` is unchanged.
    pub fn dense<S: Ode + ?Sized>(
        &mut self,
        system: &mut S,
        end: Point<'_>,
        components: Range<usize>,
        out: &mut [SegmentPolynomial],
    ) -> Result<(), S::Error> {
        let tableau = self.method().tableau();
        let end_place = tableau.end_stage();
        self.place_mut(end_place).copy_from_slice(end.rates);
        for (index, stage) in tableau.dense_stages.iter().enumerate() {
            self.evaluate(system, end_place + 1 + index, stage)?;
        }
        for (component, out) in components.zip(out) {
            *out = self.polynomial(component, end);
        }
        Ok(())
    }

    fn polynomial(&self, component: usize, end: Point<'_>) -> SegmentPolynomial {
        let tableau = self.method().tableau();
        let (lane, place) = (component / 4, component % 4);
        let start = self.start[lane][place];
        let change = end.state[component] - start;
        let bend = self.length * self.rates[lane][place] - change;
        let mut nested = [0.0; NESTED];
        nested[0] = change;
        nested[1] = bend;
        nested[2] = change - self.length * end.rates[component] - bend;
        for (nested, terms) in nested[3..].iter_mut().zip(tableau.dense_rows) {
            *nested = self.length * weighted_sum(&self.rates, self.lanes, lane, terms)[place];
        }
        SegmentPolynomial::from_nested(start, &nested[..3 + tableau.dense_rows.len()], self.length)
    }
}
