//! The motion along a step of an explicit method, as polynomials.
//!
//! The form is that of `tableau`. Its cubic part takes the values and rates at both ends as they are given,
//! so it follows an end state that was changed after the step; what the change `d` adds is `d (3 x^2 - 2
//! x^3)`.

use super::explicit::{Explicit, Lane, WIDTH, weighted_sum};
use super::polynomial::{NESTED, SegmentPolynomial};
use super::{Ode, Point};
use std::ops::Range;

/// Number of the coefficients `c2`, `c3`, `c4` of the form.
const HERMITE: usize = 3;

/// The sums for `c5` to `c8` of the components of one lane.
#[derive(Default)]
struct DenseRows {
    lane: Option<usize>,
    rows: [Lane; 4],
}

impl Explicit {
    /// See [`Stepper::dense`](super::Stepper::dense).
    pub(super) fn dense<S: Ode + ?Sized>(
        &mut self,
        system: &mut S,
        end: Point<'_>,
        components: Range<usize>,
        out: &mut [SegmentPolynomial],
    ) -> Result<(), S::Error> {
        let tableau = self.tableau;
        let end_place = tableau.end_stage();
        self.place_mut(end_place).copy_from_slice(end.rates);
        for (index, stage) in tableau.dense_stages.iter().enumerate() {
            self.evaluate(system, end_place + 1 + index, stage)?;
        }
        let mut rows = DenseRows::default();
        for (component, out) in components.zip(out) {
            if rows.lane != Some(component / WIDTH) {
                rows = self.dense_rows(component / WIDTH);
            }
            *out = self.polynomial(component, end, &rows);
        }
        Ok(())
    }

    fn dense_rows(&self, lane: usize) -> DenseRows {
        let mut rows = DenseRows { lane: Some(lane), ..DenseRows::default() };
        for (row, terms) in rows.rows.iter_mut().zip(self.tableau.dense_rows) {
            *row = weighted_sum(&self.rates, self.lanes, lane, terms);
        }
        rows
    }

    fn polynomial(&self, component: usize, end: Point<'_>, rows: &DenseRows) -> SegmentPolynomial {
        let (lane, place) = (component / WIDTH, component % WIDTH);
        let start = self.start[lane][place];
        let change = end.state[component] - start;
        let bend = self.length * self.rates[lane][place] - change;
        let mut nested = [0.0; NESTED];
        nested[..HERMITE].copy_from_slice(&[
            change,
            bend,
            change - self.length * end.rates[component] - bend,
        ]);
        for (nested, row) in nested[HERMITE..].iter_mut().zip(&rows.rows) {
            *nested = self.length * row[place];
        }
        SegmentPolynomial::from_nested(start, &nested, self.length)
    }
}
