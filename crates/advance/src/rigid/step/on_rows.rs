//! Stages of a step, moved onto held rows of which some depend on others, for ever or for a moment.
//!
//! Where states are on the rows, what one of them asks for the others give already. A stage is off them, by
//! far more than the error of its step: there the rows all but depend on each other, and what they disagree
//! in makes large forces of nothing. To move a stage changes nothing of the motion, which is on the rows.
//! Ends of steps are moved in `projection`, with more care.

use super::dynamics::Dynamics;
use super::projection::ALL_OF_IT;

/// Newton steps of one stage.
const MOST_ROUNDS: usize = 8;

impl Dynamics<'_> {
    /// Rates where a state lies once it is moved onto the held rows.
    pub(crate) fn find_rates_on_rows(&mut self, offset: f64, state: &[f64], rates: &mut [f64]) {
        if !self.physics.projects {
            return self.find_rates(offset, state, rates, Self::solve_rows);
        }
        let mut on_rows = std::mem::take(&mut self.stage.on_rows);
        on_rows.clear();
        on_rows.extend_from_slice(state);
        self.move_onto_rows(&mut on_rows);
        self.find_rates(offset, &on_rows, rates, Self::solve_rows);
        self.stage.on_rows = on_rows;
    }

    /// Moves a state onto the held rows, and stops what its velocities would move it off them by.
    fn move_onto_rows(&mut self, state: &mut Vec<f64>) {
        let length = self.physics.steps.length;
        let is_passing = self.passes_by_rows();
        let noise = if is_passing { self.noise(state, length) } else { 0.0 };
        // Near a point where loops could go on in two ways every digit counts; else what is lacking comes
        // with the next round.
        let respond = if self.group.kept.may_near_singular() { Self::respond } else { Self::respond_roughly };
        let mut row_rates = std::mem::take(&mut self.stage.rates);
        for _ in 0..MOST_ROUNDS {
            let error = self.measure_errors(state, &mut row_rates);
            if is_passing && error <= noise {
                break;
            }
            respond(self);
            // A change by x leaves errors of the order of x^2/L.
            let change = self.largest_change();
            if change.powi(2) > error * length {
                break;
            }
            self.change(state, 0);
            // And near such a point that is as much larger as the change is.
            let left = if is_passing { change } else { error };
            if left <= f64::EPSILON.sqrt() * length {
                break;
            }
        }
        let speed = self.speed_in(state, self.physics.steps);
        let largest = row_rates.iter().fold(0.0f64, |most, rate| most.max(rate.abs()));
        self.stage.offsets.clear();
        self.stage.offsets.extend_from_slice(&row_rates);
        self.stage.rates = row_rates;
        if is_passing && largest <= noise / length * speed {
            return;
        }
        respond(self);
        if self.largest_change() <= ALL_OF_IT * speed {
            self.change(state, self.group.velocities());
        }
    }
}
