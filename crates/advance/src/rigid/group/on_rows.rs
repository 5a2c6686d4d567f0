//! Stages of a step, moved onto active rows of which some depend on others, permanently or near a bifurcation point.
//!
//! In a state on the rows dependent rows are consistent: one holds if the others do. A stage lies off the rows, by far
//! more than the error of its step; there they are nearly dependent and contradict each other a little, which makes
//! large spurious forces. Moving a stage does not change the motion, which is on the rows. Ends of steps are moved in
//! `projection`, with more care.

use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::projection::ALL_OF_IT;
use crate::rigid::shares::ROUNDS;

impl Dynamics<'_> {
    /// The state at an offset [s] of the segment, moved onto the active rows: dense output is off them by its error.
    pub(crate) fn state_on_rows(&mut self, offset: f64) -> &[f64] {
        self.find_state_at(offset);
        let mut state = std::mem::take(&mut self.stage.trial);
        self.move_onto_rows(&mut state, offset);
        self.stage.trial = state;
        &self.stage.trial
    }

    /// Finds the rates of a state once it is moved onto the active rows.
    pub(crate) fn find_rates_on_rows(&mut self, offset: f64, state: &[f64], rates: &mut [f64]) {
        if !self.physics.projects {
            return self.find_rates(offset, state, rates, Self::solve_rows);
        }
        let mut on_rows = std::mem::take(&mut self.stage.on_rows);
        on_rows.clear();
        on_rows.extend_from_slice(state);
        self.move_onto_rows(&mut on_rows, offset);
        self.find_rates(offset, &on_rows, rates, Self::solve_rows);
        self.stage.on_rows = on_rows;
    }

    /// Moves a state at an offset [s] onto the active rows, and takes out the velocities that would move it off them.
    fn move_onto_rows(&mut self, state: &mut Vec<f64>, offset: f64) {
        let length = self.physics.steps.length;
        let is_passing = self.passes_by_rows();
        let noise = if is_passing { self.noise(state, length) } else { 0.0 };
        // Near a bifurcation point every digit counts; elsewhere the next round adds what rough forces lack.
        let every_digit = self.group.kept.may_near_singular() || self.group.tree.is_used();
        let respond = if every_digit { Self::respond } else { Self::respond_roughly };
        let mut row_rates = std::mem::take(&mut self.stage.rates);
        for _ in 0..ROUNDS {
            let error = self.measure_errors(state, offset, &mut row_rates);
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
            // Near a bifurcation point changes are larger than errors, and so are the errors that they leave.
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
