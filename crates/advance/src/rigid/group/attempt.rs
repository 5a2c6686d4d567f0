//! One accepted step of a group: lengths are tried until the step errs by little enough.

use crate::ode::{Accepted, Method, Point, Stepper, is_kept};
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::energy::Energy;
use crate::rigid::group::segment::LONGEST_STEP;
use crate::rigid::group::state::Group;
use crate::rigid::group::stepping::Stepping;
use crate::rigid::group::tools::Tools;
use crate::rigid::remedies::Remedy;
use crate::rigid::settings::StepControl;
use crate::rigid::shares::{ROUNDINGS, ROUNDS, SMALL, TINY};
use halfgap_collision::{BodyId, ConnectorId};

/// Largest factor by which steps of smooth motions grow at once: after larger ones errors follow the tolerance less
/// well.
pub(crate) const STEADY_GROWTH: f64 = 2.0;
/// Fixed steps have failed if a body is faster than this multiple of [`StepControl::speed`].
const RUNAWAY: f64 = 1e6;

/// Why a group could not be stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum StepFailure {
    /// The step size has collapsed to this [s].
    Collapsed(f64),
    /// Steps without an error estimate have made a body this fast [m/s], which nothing in the scene explains.
    RanAway(f64),
    /// The rope of a pulley has been pulled in on the side of a body.
    RanOut(ConnectorId, BodyId),
    /// Forces vary over this length [m], which rounding of positions does not resolve.
    Unresolved(f64),
}

impl StepFailure {
    fn ran_out((pulley, body): (ConnectorId, BodyId)) -> Self {
        Self::RanOut(pulley, body)
    }
}

/// A step on trial.
struct Attempt {
    /// Its length [s].
    step: f64,
    /// The length [s] that errors ask for; the step is made shorter if a bifurcation point of a loop is near.
    natural: f64,
    /// Number of times that the step was placed around a bifurcation point.
    placements: u32,
    /// It is shorter than errors ask for, because of a bifurcation point.
    is_led: bool,
    /// A longer one has erred by too much.
    is_rejected: bool,
}

impl Attempt {
    fn new(step: f64) -> Self {
        Self { step, natural: step, placements: 0, is_led: false, is_rejected: false }
    }
}

impl Dynamics<'_> {
    /// Extends the group by one accepted step from its state and rates; its end is projected, and the rates
    /// there are known. Returns the energy at the end, if a force law or the projection asked for it.
    pub(crate) fn extend(&mut self, tools: &mut Tools<'_>) -> Result<Option<Energy>, StepFailure> {
        let control = &tools.settings.steps;
        if !self.is_resolved(control) {
            return Err(StepFailure::Unresolved(self.group.force_length));
        }
        if !self.is_better_on_rows() {
            self.return_to_tree();
        }
        self.scale_errors(tools);
        let method = tools.stepper.method();
        let proposed = self.proposed_step(control, method);
        let shortest =
            ROUNDINGS * f64::EPSILON * self.start.seconds().abs().min(control.length / control.speed);
        let work_scale = self.work_scale(control);
        let mut attempt = Attempt::new(proposed);
        let mut may_ask_again = true;
        loop {
            if attempt.step.is_nan() || attempt.step <= shortest {
                // The clock may round the time at which one step ends to below that at which the next begins, with a
                // law's change of branch between: then the rates noted there are those of another branch.
                let asks = std::mem::take(&mut may_ask_again) && self.renew_rates();
                if !asks || !self.physics.remedies.act(Remedy::RenewedRates) {
                    let collapsed = StepFailure::Collapsed(attempt.step);
                    return Err(self.ran_out(false).map_or(collapsed, StepFailure::ran_out));
                }
                attempt.step = proposed;
                continue;
            }
            self.group.span = attempt.step;
            self.step(tools.stepper, attempt.step);
            // Steps that are kept short on demand err by little in angles, and on the rows by rounding.
            if self.group.tree.is_used() && control.largest_step.is_none() && self.is_better_on_rows() {
                self.bypass_tree();
                self.scale_errors(tools);
                continue;
            }
            if self.places_better(&mut attempt, method) {
                continue;
            }
            // A method whose error takes the rates at the end needs them of the projected end, and only once.
            let closed = tools.stepper.needs_end_rates().then(|| self.close_step(tools));
            let mut error = tools.stepper.error_norm(tools.scales);
            if self.keeps(error) {
                error = error.max(self.work_error(tools.stepper, tools.scales.len(), work_scale));
            }
            if !error.is_finite() {
                (attempt.step, attempt.is_rejected) = (attempt.step * SMALL, true);
                continue;
            }
            if self.keeps(error) || self.group.kept.passes_astride(attempt.step, error, control.local_error) {
                self.accept(&attempt, error, method);
                let energy = closed.unwrap_or_else(|| self.end_with_rates(tools));
                let speed = self.top_speed(&self.group.end_state);
                if !method.is_adaptive() && control.speed > 0.0 && speed > RUNAWAY * control.speed {
                    return Err(StepFailure::RanAway(speed));
                }
                self.follow_rails();
                return self.ran_out(true).map_or(Ok(energy), |gone| Err(StepFailure::ran_out(gone)));
            }
            let factor = method.step_factor(error);
            [attempt.natural, attempt.step] = self.group.kept.shorter_lengths(attempt.step, factor, method);
            attempt.is_led |= attempt.step < attempt.natural;
            attempt.is_rejected = true;
        }
    }

    /// The length [s] of the next step: as the last one asks for, or as fixed steps are said to be, within all bounds.
    fn proposed_step(&mut self, control: &StepControl, method: Method) -> f64 {
        let longest = self
            .longest_sound_step()
            .min(self.longest_watched_step())
            .min(self.longest_turning_step())
            .min(self.longest_smooth_step(control))
            .min(self.longest_lawful_step())
            .min(self.longest_stable_step(method));
        self.note_damping();
        let limit = control.largest_step.unwrap_or(LONGEST_STEP).min(longest);
        let said = control.largest_step.filter(|_| !method.is_adaptive());
        said.or(self.group.next_step).unwrap_or_else(|| self.first_step(control)).min(limit)
    }

    /// Finds a length with which the step is placed better around a bifurcation point; true if there is one and another
    /// length is to be tried.
    fn places_better(&mut self, attempt: &mut Attempt, method: Method) -> bool {
        // Without a tree the errors of a step that begins near a bifurcation point are rounding, and fall as it grows.
        let most = if self.group.tree.exists() { attempt.step } else { attempt.natural };
        if attempt.placements >= ROUNDS {
            return false;
        }
        let Some(better) = self.group.kept.better_length(attempt.step, most, method) else { return false };
        (attempt.step, attempt.is_led) = (better, true);
        attempt.placements += 1;
        true
    }

    /// Notes an accepted step, and the length of the next one.
    fn accept(&mut self, attempt: &Attempt, error: f64, method: Method) {
        let &Attempt { step, natural, is_rejected, is_led, .. } = attempt;
        self.group.kept.note_accepted(step);
        self.group.kept.is_led = is_led;
        // Force laws may change elsewhere in a way that nothing here foretells.
        let is_steady = self.group.force_laws.is_empty() && TINY * self.growth_by_forces() >= 1.0;
        self.group.steady_step = is_steady.then_some(step);
        let accepted = Accepted { length: step, error };
        // A step that was shortened because of a bifurcation point tells nothing about those after it.
        let before = self.group.accepted.replace(accepted).filter(|_| !is_led);
        self.group.next_step = Some(if is_led {
            natural
        } else {
            let most = if is_rejected { 1.0 } else { self.largest_growth() };
            step * method.factor_after(accepted, before).min(most)
        });
    }

    /// Steps the group as it is, from the last step on, although it has a tree.
    fn bypass_tree(&mut self) {
        let Group { tree, kept, .. } = &mut *self.group;
        if tree.bypass() {
            kept.change_measure();
        }
    }

    /// Steps the group as its tree again, if it has one.
    fn return_to_tree(&mut self) {
        let Group { tree, kept, .. } = &mut *self.group;
        if tree.use_again() {
            kept.restore_measure();
        }
    }

    /// True if stages of the last step came so near a bifurcation point that they have to lie on the rows. Stages in
    /// angles are off the rows that close loops, and near a bifurcation point small errors of a few loops make large
    /// spurious forces.
    fn is_better_on_rows(&self) -> bool {
        let Group { tree, kept, .. } = &*self.group;
        kept.is_near_singular() && tree.has_few_loops() && self.group.stepping() != Stepping::Stiff
    }

    /// True if a step of this error norm is kept. Without contacts errors follow the step length smoothly, and no step
    /// beyond the tolerance is kept.
    pub(super) fn keeps(&self, error: f64) -> bool {
        let any_contact = self.group.rows.iter().any(|row| !row.bilateral);
        if any_contact { is_kept(error) } else { error <= 1.0 }
    }

    /// Projects the end and evaluates the rates there. Returns the energy at the end, if the projection asked for it.
    fn end_with_rates(&mut self, tools: &Tools<'_>) -> Option<Energy> {
        let energy = self.end_on_rows(tools);
        self.evaluate_end();
        energy
    }

    /// Projects the end and evaluates the rates there, for a method whose error estimate takes them.
    fn close_step(&mut self, tools: &mut Tools<'_>) -> Option<Energy> {
        let energy = self.end_with_rates(tools);
        if self.group.tree.is_used() {
            self.close_step_of_tree(tools.stepper);
        } else {
            tools.stepper.close(&self.group.end_rates);
        }
        energy
    }

    /// Makes a step from the group's state and rates to its end state, in the coordinates that the group is stepped in.
    pub(super) fn step(&mut self, stepper: &mut Stepper, step: f64) {
        self.group.kept.open();
        if self.group.tree.is_used() {
            self.step_tree(stepper, step);
        } else {
            self.step_rows(stepper, step);
        }
        self.group.kept.close();
    }

    /// Makes a step in the positions and velocities of the bodies.
    fn step_rows(&mut self, stepper: &mut Stepper, step: f64) {
        let (state, rates) = (std::mem::take(&mut self.group.state), std::mem::take(&mut self.group.rates));
        let mut end = std::mem::take(&mut self.group.end_state);
        end.clear();
        end.resize(state.len(), 0.0);
        let from = Point { offset: 0.0, state: &state, rates: &rates };
        self.stage.clear_force_ranges(self.group.rows.len());
        self.stage.asks_force_ranges = true;
        let Ok(()) = stepper.step_open(self, from, step, &mut end);
        self.stage.asks_force_ranges = false;
        (self.group.state, self.group.rates, self.group.end_state) = (state, rates, end);
    }

    /// Factor by which a step may be longer than the one before. In groups with contacts, whose steps are soon cut by
    /// events anyway, and in stiff groups, whose steps grow much at once when a fast part has decayed, only contact
    /// forces bound it.
    fn largest_growth(&self) -> f64 {
        if self.group.stepping() == Stepping::Stiff {
            return self.growth_by_forces();
        }
        let is_smooth = self.group.rows.iter().all(|row| row.bilateral);
        let of_forces = if is_smooth { STEADY_GROWTH } else { self.growth_by_forces() };
        // What is moved may begin to move. On a body that is held still a force law may change much faster than along the last step, unseen by errors,
        // unless the laws tell a length over which they vary.
        let is_blind = !self.group.force_laws.is_empty()
            && self.group.force_length.is_infinite()
            && self.any_rests(&self.group.end_state);
        let is_blind = is_blind || !self.group.moved.is_empty();
        if is_blind { of_forces.min(STEADY_GROWTH) } else { of_forces }
    }

    /// Factor by which a step may grow so that no contact force varies along it by more than its size, at the rate of
    /// variation of the last step. Forces that hold bodies in place show in no error estimate, and along a step that is
    /// longer than such a force lasts, the time at which it vanishes would be missed.
    fn growth_by_forces(&self) -> f64 {
        let contacts = self.group.rows.iter().zip(&self.stage.force_ranges).filter(|(row, _)| !row.bilateral);
        let growths = contacts.map(|(_, &[least, largest])| {
            let (size, spread) = (least.abs().max(largest.abs()), largest - least);
            if spread > 0.0 { (size / spread).max(1.0) } else { f64::INFINITY }
        });
        growths.fold(f64::INFINITY, f64::min)
    }
}
