//! A group's segment: its start, the repetition of its step up to an event, its dense output. The step itself is made
//! in `attempt`, its end moved onto the active rows in `projection`.

use crate::ode::{Ode, Point, SegmentPolynomial, Stepper};
use crate::rigid::contacts::rows::RowSource;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::stage::body_state;
use crate::rigid::group::state::Group;
use crate::rigid::group::stepping::Stepping;
use crate::rigid::group::tools::Tools;
use crate::rigid::shares::SMALL;

/// Upper bound [s] of all steps: beyond it the clock resolves no motion.
pub(crate) const LONGEST_STEP: f64 = 1e12;
/// An error e(s) that starts as s^2, s the fraction of the step, is taken to satisfy e(s) <= 16 s^2 e(1/2).
const EARLY_SHARE: f64 = 16.0;

impl Dynamics<'_> {
    /// Evaluates the rates at the group's start.
    pub(crate) fn set_out(&mut self) {
        let state = std::mem::take(&mut self.group.state);
        let mut rates = std::mem::take(&mut self.group.rates);
        rates.clear();
        rates.resize(state.len(), 0.0);
        self.evaluate_with_free(0.0, &state, &mut rates);
        self.group.forces.clear();
        self.group.forces.extend_from_slice(&self.stage.forces);
        self.group.state = state;
        self.group.rates = rates;
    }

    /// Evaluates the rates at the group's start anew; true if they differ from those noted.
    pub(super) fn renew_rates(&mut self) -> bool {
        let before = self.group.rates.clone();
        self.set_out();
        self.group.rates != before
    }

    /// Bounds the next step by a multiple of the one just made, unless that was shortened because of a bifurcation
    /// point: then it tells nothing about the next, and only a factor of at most 1 counts.
    pub(crate) fn limit_next_step(&mut self, factor: f64) {
        if factor > 1.0 && self.group.kept.is_led {
            return;
        }
        let longest = self.group.span * factor;
        self.group.next_step = Some(self.group.next_step.map_or(longest, |next| next.min(longest)));
    }

    /// Repeats the step up to an offset [s] within the segment, into the end state; false if the error is more than a
    /// step may make, as where the shorter step ends near a bifurcation point that the whole step has passed astride.
    pub(crate) fn repeat_to(&mut self, tools: &mut Tools<'_>, offset: f64) -> bool {
        self.scale_errors(tools);
        if offset > 0.0 {
            self.step(tools.stepper, offset);
        } else {
            self.group.end_state.clone_from(&self.group.state);
        }
        self.group.span = offset;
        offset <= 0.0 || tools.stepper.needs_end_rates() || self.keeps(tools.stepper.error_norm(tools.scales))
    }

    /// True if the error of dense output at an offset [s] is a small fraction of that which a step may make. Dense
    /// output of explicit methods errs by about the error estimate; since it has the exact values and rates at the
    /// start, its error falls with the square of the offset towards it.
    pub(crate) fn is_dense_exact(&self, offset: f64) -> bool {
        let part = offset / self.group.span;
        let share = (EARLY_SHARE * part * part).min(1.0);
        self.group.stepping() != Stepping::Stiff
            && self.group.accepted.is_some_and(|step| share * step.error <= SMALL)
    }

    /// Ends the segment at an offset [s] within it, by its dense output.
    pub(crate) fn end_by_dense(&mut self, offset: f64) {
        self.place_at(offset);
        let first_work = 2 * self.group.velocities();
        let mut end = std::mem::take(&mut self.group.end_state);
        end.clear();
        end.extend_from_slice(&self.stage.trial[..first_work]);
        end.extend(self.group.work_paths().iter().map(|path| path.value_at(offset)));
        if self.group.tree.is_used() {
            self.fit_to_tree(&mut end);
        }
        self.group.end_state = end;
        self.group.span = offset;
    }

    /// Evaluates the rates and the forces of the rows at the end.
    pub(crate) fn evaluate_end(&mut self) {
        let end = std::mem::take(&mut self.group.end_state);
        let mut rates = std::mem::take(&mut self.group.end_rates);
        rates.clear();
        rates.resize(end.len(), 0.0);
        self.evaluate_with_free(self.group.span, &end, &mut rates);
        self.group.end_forces.clear();
        self.group.end_forces.extend_from_slice(&self.stage.forces);
        (self.group.end_state, self.group.end_rates) = (end, rates);
    }

    /// Notes the places of rails' points on their splines at the end: searches that begin nearby are short, and keep to
    /// their branch where a rail crosses itself. On rails of lines and arcs, events note them.
    pub(crate) fn follow_rails(&mut self) {
        let mechanism = &self.physics.mechanism;
        let Group { rows, bodies, end_state, .. } = &mut *self.group;
        for row in rows {
            let (RowSource::Connector(id, _), Some(hint)) = (row.source, &row.hint) else { continue };
            let on_rail = mechanism.connectors[id.index()].on_rail();
            let Some((anchor, path)) = on_rail.filter(|(_, path)| path.knots().is_empty()) else { continue };
            let Ok(place) = bodies.binary_search(&anchor.body) else { continue };
            let point = body_state(end_state, bodies.len(), place).pose().point_to_world(anchor.point);
            row.set_hint(Some(path.hint_near(point, Some(hint)).staying()));
        }
    }

    /// Writes the dense output of the last step into the group's paths.
    pub(crate) fn make_dense(&mut self, stepper: &mut Stepper) {
        if self.group.tree.is_used() {
            return self.make_dense_of_tree(stepper);
        }
        let (state, end) = (std::mem::take(&mut self.group.state), std::mem::take(&mut self.group.end_state));
        let end_rates = std::mem::take(&mut self.group.end_rates);
        let mut rates = std::mem::take(&mut self.group.rate_paths);
        let first = self.group.velocities();
        rates.resize(state.len() - first, SegmentPolynomial::default());
        let end_point = Point { offset: self.group.span, state: &end, rates: &end_rates };
        self.stage.asks_force_ranges = true;
        let Ok(()) = stepper.dense(self, end_point, first..state.len(), &mut rates);
        self.stage.asks_force_ranges = false;
        let path = |at: usize| SegmentPolynomial::integrated(state[at], end[at], &rates[at]);
        self.group.paths.clear();
        let places = 0..self.group.bodies.len();
        self.group.paths.extend(places.map(|place| [0, 1, 2].map(|k| path(3 * place + k))));
        self.group.rate_paths = rates;
        (self.group.state, self.group.end_state, self.group.end_rates) = (state, end, end_rates);
    }
}

impl Dynamics<'_> {
    /// Evaluates the forces of the rows at an offset [s] of the segment, and leaves them in the stage.
    pub(crate) fn evaluate_at(&mut self, offset: f64) {
        self.find_state_at(offset);
        let trial = std::mem::take(&mut self.stage.trial);
        let mut rates = std::mem::take(&mut self.stage.trial_rates);
        rates.resize(trial.len(), 0.0);
        if self.group.tree.is_used() {
            self.find_rates(offset, &trial, &mut rates, Self::hang_and_tell);
        } else {
            let Ok(()) = self.derivative(offset, &trial, &mut rates);
        }
        (self.stage.trial, self.stage.trial_rates) = (trial, rates);
    }

    /// A number [s] of ticks of the clock at the end of the segment.
    pub(crate) fn clock_ticks(&self, count: f64) -> f64 {
        let span = self.group.span;
        count * f64::EPSILON * (self.start.seconds() + span).abs().max(span)
    }
}
