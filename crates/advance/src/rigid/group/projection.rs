//! Projection of the end of a step onto the active rows, with all care; stages of steps are moved in `on_rows`.
//!
//! Rows that are redundant all along, or nearly dependent near a bifurcation point, may be soft: they share their
//! force, and projections converge more slowly.

use crate::rigid::contacts::rows::ActiveRow;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::measures::ROUNDING_SHARE;
use crate::rigid::group::state::Group;
use crate::rigid::remedies::Remedy;
use crate::rigid::settings::StepControl;
use crate::rigid::shares::{ROUNDINGS, ROUNDS, TINY, WORTHWHILE};

/// Largest number of Newton steps where rows are soft or a bifurcation point may be near.
const SOFT_PROJECTIONS: u32 = 20;
/// Multiple of the rows' error: where bodies were moved by more, the rates of the rows are measured anew. Rows that
/// nearly depend on each other carry forces that would do work on the difference.
const FAR: f64 = 8.0;
/// Error of a gap by rounding, as a multiple of the rounding of positions.
const GAP_ROUNDINGS: f64 = 4.0;
/// Largest change of velocities by a projection, as a multiple of the group's speed; a larger one corrects nothing. To
/// stop a group altogether, some points change by a little more than the speed of the fastest.
pub(crate) const ALL_OF_IT: f64 = 2.0;

impl Dynamics<'_> {
    /// Makes the rows of connectors soft, so that they share their force, if some depend on others at the end.
    pub(crate) fn soften_dependent(&mut self) {
        // With friction forces that are not unique are prescribed.
        if !self.group.rows.iter().any(ActiveRow::is_joint) || self.group.is_rough() {
            return;
        }
        let end = std::mem::take(&mut self.group.end_state);
        self.load(&end, self.group.span);
        self.group.end_state = end;
        let dependent = self.factorize(|_, _| ());
        let Group { rows, active, .. } = &mut *self.group;
        let mut connectors = (0..rows.len()).filter(|&row| rows[row].is_joint());
        let has_dependent = dependent > 0 && connectors.any(|row| active.is_dependent(row));
        if has_dependent && self.physics.remedies.act(Remedy::SoftRows) {
            active.soften(|row| rows[row].is_joint());
            self.group.dependent = dependent;
        }
    }

    /// Moves the end state onto the active rows, each to the gap at which it is held, by the least displacement and the
    /// least change of velocities in the metric of the masses.
    pub(crate) fn project_end(&mut self, control: &StepControl) {
        let length = control.length;
        let mut end = std::mem::take(&mut self.group.end_state);
        let zone = self.physics.mechanism.tolerances.accuracy;
        let speed = self.speed_in(&end, control);
        let velocities = self.group.velocities();
        let mut rates = std::mem::take(&mut self.stage.rates);
        // At a bifurcation point the errors of a loop would decide its branch unless they are hardly any.
        let is_singular = self.group.kept.may_near_singular();
        let is_soft = self.group.active.is_soft() || is_singular;
        // Small errors of several loops are corrected as long as that does not change the motion.
        let noise = self.passes_by_rows().then(|| self.noise(&end, length));
        let rounds = if is_soft { SOFT_PROJECTIONS } else { ROUNDS };
        let (mut before, mut is_far) = (f64::INFINITY, false);
        for round in 0..rounds {
            let error = self.measure_errors(&end, self.group.span, &mut rates);
            self.respond();
            // A change by x leaves errors of the order of x^2/L. Rows that nearly depend on each other ask for changes
            // beyond this linear range, and for changes that only rounding of their gaps makes: errors far within the
            // target zone do not justify a change beyond it.
            let way = self.largest_change();
            let is_little = error < ROUNDING_SHARE * zone && way > zone;
            let is_sound = noise.is_some_and(|noise| error >= noise && way.powi(2) <= TINY * error * length);
            if way.powi(2) > error * length || (is_little && !is_sound) {
                break;
            }
            self.change(&mut end, 0);
            is_far = if is_singular { way > ROUNDINGS * f64::EPSILON * length } else { way > FAR * error };
            // Newton's method squares the relative error.
            let is_enough = if is_soft {
                error <= f64::EPSILON * length || (round > 0 && error > WORTHWHILE * before)
            } else {
                error <= f64::EPSILON.sqrt() * length
            };
            if is_enough || round + 1 == rounds {
                break;
            }
            before = error;
        }
        if is_far {
            self.load(&end, self.group.span);
            rates.clear();
            self.factorize(|_, rate| rates.push(rate));
        }
        self.stage.offsets.clear();
        self.stage.offsets.extend_from_slice(&rates);
        self.respond();
        if self.largest_change() <= ALL_OF_IT * speed {
            self.change(&mut end, velocities);
        }
        self.stage.rates = rates;
        self.group.end_state = end;
    }

    /// Error [m] of a row that rounding may leave in a state on the rows.
    pub(crate) fn noise(&self, state: &[f64], length: f64) -> f64 {
        (ROUNDINGS * f64::EPSILON * length).max(GAP_ROUNDINGS * self.rounding_in(state))
    }

    /// Measures the rows in a state at an offset [s] of the segment and factorises. Leaves the error [m] of each gap in the stage's offsets, its rate
    /// [m/s] in `rates`; returns the largest error [m].
    pub(crate) fn measure_errors(&mut self, state: &[f64], offset: f64, rates: &mut Vec<f64>) -> f64 {
        self.load(state, offset);
        let mut offsets = std::mem::take(&mut self.stage.offsets);
        offsets.clear();
        rates.clear();
        self.factorize(|gap, rate| {
            offsets.push(gap);
            rates.push(rate);
        });
        let error = offsets.iter().fold(0.0f64, |most, gap| most.max(gap.abs()));
        self.stage.offsets = offsets;
        error
    }

    /// Largest displacement [m], or change of velocity [m/s], of a point of a body by the changes in the stage.
    pub(crate) fn largest_change(&self) -> f64 {
        let sizes =
            self.group.bodies.iter().zip(&self.stage.changes).map(|(&body, &change)| {
                self.physics.mechanism.trajectories[body.index()].fastest_point(change)
            });
        sizes.fold(0.0, f64::max)
    }

    /// Adds the changes in the stage to the components of a state from index `at` on: positions or velocities.
    pub(crate) fn change(&mut self, state: &mut Vec<f64>, at: usize) {
        for (value, change) in state[at..].iter_mut().zip(self.stage.changes.iter().flatten()) {
            *value += change;
        }
        if self.group.tree.is_used() {
            self.fit_to_tree(state);
        }
    }

    /// Changes the velocities at the end such that the rates of bilateral rows vanish and those of the others stay.
    pub(crate) fn fit_joint_velocities(&mut self) {
        let mut end = std::mem::take(&mut self.group.end_state);
        self.load(&end, self.group.span);
        let mut offsets = std::mem::take(&mut self.stage.offsets);
        offsets.clear();
        self.factorize(|_, rate| offsets.push(rate));
        for (offset, row) in offsets.iter_mut().zip(&self.group.rows) {
            *offset = if row.bilateral { *offset } else { 0.0 };
        }
        self.stage.offsets = offsets;
        self.respond();
        let velocities = self.group.velocities();
        self.change(&mut end, velocities);
        self.group.end_state = end;
    }
}
