//! The end of a step, moved onto the held rows, with all care; stages of steps are moved in `on_rows`.

use super::dynamics::Dynamics;
use super::group::Group;
use super::measures::ROUNDING_SHARE;
use super::segment::StepControl;

/// Newton steps of one projection.
const PROJECTIONS: usize = 5;
/// The same where rows share what they hold, which converges more slowly, while each leaves less than so much
/// of the error.
const SOFT_PROJECTIONS: usize = 20;
const WORTHWHILE: f64 = 0.5;
/// Bodies that move by so many times the error of their rows have other rates there: rows that all but depend
/// on each other carry forces that do work on what is left of them.
const FAR: f64 = 8.0;
/// What bodies of loops move by for less than this part of the length changes none of their rates.
const ROUNDED: f64 = 64.0 * f64::EPSILON;
/// A row that keeps the square of s moves bodies by its error over s: no more than this part of s L, or the motion there
/// is another one.
const BENT: f64 = 1e-4;
/// A gap is off by up to so many roundings of positions.
const GAP_ROUNDINGS: f64 = 4.0;
/// A change of velocities by more than so many times what is fast corrects nothing: to stop a group
/// altogether, some points change by a little more than the fastest moves.
pub(crate) const ALL_OF_IT: f64 = 2.0;

impl Dynamics<'_> {
    /// Lets connectors share what they hold, if some depend on others at the end.
    pub(crate) fn soften_dependent(&mut self) {
        if !self.group.rows.iter().any(|row| row.bilateral) {
            return;
        }
        let end = std::mem::take(&mut self.group.end_state);
        self.stage.load(&self.group.bodies, &end);
        self.group.end_state = end;
        let dependent = self.factorize(|_, _| ());
        let Group { rows, held, .. } = &mut *self.group;
        let mut connectors = (0..rows.len()).filter(|&row| rows[row].bilateral);
        if dependent > 0 && connectors.any(|row| held.is_dependent(row)) {
            held.soften(|row| rows[row].bilateral);
            self.group.dependent = dependent;
        }
    }

    /// Moves the end state onto the held rows, by the least displacement and the least change of velocities
    /// in the metric of the masses; each row to the gap at which it formed.
    pub(crate) fn project_end(&mut self, control: &StepControl) {
        let length = control.length;
        let mut end = std::mem::take(&mut self.group.end_state);
        let zone = self.physics.mechanism.tolerances.accuracy;
        let speed = self.speed_in(&end, control);
        let velocities = self.group.velocities();
        let mut rates = std::mem::take(&mut self.stage.rates);
        // Errors of loops decide which way they go on from where they could go both, unless there are hardly any.
        let is_singular = self.group.kept.may_near_singular();
        let is_soft = self.group.held.is_soft() || is_singular;
        // What is off by little in several loops is made good as long as that bends no motion.
        let noise = self.passes_by_rows().then(|| self.noise(&end, length));
        let rounds = if is_soft { SOFT_PROJECTIONS } else { PROJECTIONS };
        let (mut before, mut is_far) = (f64::INFINITY, false);
        for round in 0..rounds {
            let error = self.measure_errors(&end, &mut rates);
            self.respond();
            // A change by x leaves errors of the order of x^2/L. Rows that all but depend on each other ask
            // for more than what holds near here, and for what rounding makes of their gaps: errors far
            // within the zone are not worth more.
            let way = self.largest_change();
            let is_little = error < ROUNDING_SHARE * zone && way > zone;
            let is_sound = noise.is_some_and(|noise| error >= noise && way.powi(2) <= BENT * error * length);
            if way.powi(2) > error * length || (is_little && !is_sound) {
                break;
            }
            self.change(&mut end, 0);
            is_far = if is_singular { way > ROUNDED * length } else { way > FAR * error };
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
            self.stage.load(&self.group.bodies, &end);
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

    /// By how far [m] a row may be off in a state that is as near as rounding allows.
    pub(crate) fn noise(&self, state: &[f64], length: f64) -> f64 {
        (ROUNDED * length).max(GAP_ROUNDINGS * self.rounding_in(state))
    }

    /// Measures the rows in a state and factorises: by how far [m] each gap is off, left in the stage's
    /// offsets, and its rate. Returns the largest error.
    pub(crate) fn measure_errors(&mut self, state: &[f64], rates: &mut Vec<f64>) -> f64 {
        self.stage.load(&self.group.bodies, state);
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

    /// How far [m], or by how much [m/s], the changes in the stage move a point of a body at most.
    pub(crate) fn largest_change(&self) -> f64 {
        let sizes = self
            .group
            .bodies
            .iter()
            .zip(&self.stage.changes)
            .map(|(&body, &change)| self.physics.mechanism.flyers[body.index()].fastest_point(change));
        sizes.fold(0.0, f64::max)
    }

    /// Adds the changes in the stage to the numbers of a state that begin at a place: positions or velocities.
    pub(crate) fn change(&mut self, state: &mut Vec<f64>, at: usize) {
        for (value, change) in state[at..].iter_mut().zip(self.stage.changes.iter().flatten()) {
            *value += change;
        }
        if self.group.tree.is_used() {
            self.fit_to_tree(state);
        }
    }

    /// Brings the rates of bilateral rows to zero at the end and leaves those of the others as they are.
    pub(crate) fn fit_joint_velocities(&mut self) {
        let mut end = std::mem::take(&mut self.group.end_state);
        self.stage.load(&self.group.bodies, &end);
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
