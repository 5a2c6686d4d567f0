//! A group's segment: an accepted step, its dense output, and its repetition up to an event. Its end is moved
//! onto the held rows in `projection`.

use super::brief::Stepping;
use super::dynamics::{Dynamics, body_state};
use super::energy::Energy;
use super::extending::Tools;
use super::group::Group;
use super::rows::RowSource;
use crate::ode::{Accepted, Point, SegmentPolynomial, Stepper, is_kept};
use halfgap_collision::BodyId;

/// How groups are stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepControl {
    /// Relative error that a step may make.
    pub local_error: f64,
    /// Length [m] to which errors of position are relative.
    pub length: f64,
    /// Speed [m/s] to which errors of velocity are relative in a group that is at rest.
    pub speed: f64,
    /// No step is longer [s]; the step of a method without error estimate.
    pub largest_step: Option<f64>,
}

/// No step is longer [s]: nobody looks so far, and what is read there means nothing.
pub(crate) const LONGEST_STEP: f64 = 1e12;
/// Steps shorter than this many machine epsilons of the clock, or of the time in which what is as fast as the scene
/// crosses it if that is less, mean that the step size has collapsed. The clock itself resolves far less.
const COLLAPSED: f64 = 64.0;
/// Exponent of the error in the first step: one over the order of the default method.
const FIRST_STEP_POWER: f64 = 1.0 / 8.0;
/// A step is divided by this where the state is not a number.
const RETREAT: f64 = 0.1;
/// Smooth motions want steps of even length: after one that grew at once by much, errors follow the tolerance
/// less well.
pub(crate) const STEADY_GROWTH: f64 = 2.0;
/// Part of the accuracy by which rounding may move a body along a step.
pub(crate) const ROUNDING_SHARE: f64 = 1.0 / 8.0;

/// Part of the accuracy by which a step of bodies in contact may err, lest what they fly by is hit too late.
const CLEAR_SHARE: f64 = 0.5;

/// Error norm of a step up to which its dense output counts as exact.
const DENSE_ERROR: f64 = 0.1;
/// What is smooth and begins with the square of the part of a step is at most this times that square of what
/// it is in the middle.
const EARLY_SHARE: f64 = 16.0;

/// Part of the speed of what is at rest from which on a group moves: squares of less are no numbers any more.
const STANDSTILL: f64 = 1e-140;

/// How often a step is made otherwise so that no stage of it comes near a point where its rows depend on each other.
const MOST_PLACEMENTS: usize = 4;

/// Contact forces that vary along a step by no more than such a part of what they are are steady: the next
/// may be longer by so much, wherever it takes the bodies.
const STEADY_PART: f64 = 1e-4;

/// What rounding of positions may add to the energy in a step, in local errors of what is usual in the scene: more, and
/// energy comes from nothing whatever the steps.
const UNRESOLVED: f64 = 1e4;
/// Forces on bodies in contact vary over more target gaps than this, or what contacts are apart by decides on them.
const TOLD_FROM_GAP: f64 = 10.0;

/// What steps without an error estimate have made so many times as fast as what is usual in the scene, they have made
/// of nothing.
const RUNAWAY: f64 = 1e6;

/// Why a group could not be stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum StepFailure {
    /// The step size has collapsed to this [s].
    Collapsed(f64),
    /// Steps without an error estimate have made bodies so fast [m/s].
    RanAway(f64),
    /// Forces vary over this length [m], which rounding of positions does not resolve.
    Unresolved(f64),
}

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

    /// Evaluates the rates at the group's start anew; true if they are others.
    fn renew_rates(&mut self) -> bool {
        let before = self.group.rates.clone();
        self.set_out();
        self.group.rates != before
    }

    /// Extends the group by one accepted step from its state and rates; its end is projected, and the rates
    /// there are known. Returns the energy at the end, if anybody had to look.
    pub(crate) fn extend(&mut self, tools: &mut Tools<'_>) -> Result<Option<Energy>, StepFailure> {
        let control = &tools.settings.steps;
        if !self.is_resolved(control) {
            return Err(StepFailure::Unresolved(self.group.force_length));
        }
        if !self.is_better_on_rows() {
            self.leave_tree(false);
        }
        self.scale_errors(tools);
        let method = tools.stepper.method();
        let turning = self.longest_turning_step();
        let longest = self.longest_sound_step().min(self.longest_watched_step()).min(turning);
        let longest = longest.min(self.longest_smooth_step(control));
        let longest = longest.min(self.longest_stable_step(method));
        self.note_damping();
        let limit = control.largest_step.unwrap_or(LONGEST_STEP).min(longest);
        // Without an error estimate a step is as long as it is said to be.
        let said = control.largest_step.filter(|_| !method.is_adaptive());
        let mut step = said.or(self.group.next_step).unwrap_or_else(|| self.first_step(control)).min(limit);
        let shortest =
            COLLAPSED * f64::EPSILON * self.start.seconds().abs().min(control.length / control.speed);
        let work_scale = self.work_scale(control);
        let proposed = step;
        // What errors ask for, wherever steps are led.
        let mut natural = step;
        let (mut rejected, mut placements, mut is_led) = (false, 0, false);
        let mut may_ask_again = true;
        loop {
            if step.is_nan() || step <= shortest {
                // What the clock tells where one step ends may be a last digit less than where the next begins, and a law
                // change branch between: then the rates there are another branch's.
                if !std::mem::take(&mut may_ask_again) || !self.renew_rates() {
                    return Err(StepFailure::Collapsed(step));
                }
                step = proposed;
                continue;
            }
            self.group.span = step;
            self.step(tools.stepper, step);
            // Steps that are kept short on demand err by little in angles, and on the rows by rounding.
            if self.group.tree.is_used() && control.largest_step.is_none() && self.is_better_on_rows() {
                self.leave_tree(true);
                self.scale_errors(tools);
                continue;
            }
            // Without a tree a step that begins near such a point is the better the longer it is: it errs by rounding.
            let most = if self.group.tree.exists() { step } else { natural };
            if placements < MOST_PLACEMENTS
                && let Some(better) = self.group.kept.better_length(step, most, method)
            {
                (step, placements, is_led) = (better, placements + 1, true);
                continue;
            }
            // Where the error takes the rates at the end, they are asked for once: where the end is in the end.
            let closed = tools.stepper.needs_end_rates().then(|| self.close_step(tools));
            let mut error = tools.stepper.error_norm(tools.scales);
            if self.keeps(error) {
                error = error.max(self.work_error(tools.stepper, tools.scales.len(), work_scale));
            }
            if !error.is_finite() {
                (step, rejected) = (step * RETREAT, true);
                continue;
            }
            if self.keeps(error) || self.group.kept.passes_astride(step, error, control.local_error) {
                self.group.kept.note_accepted(step);
                self.group.kept.is_led = is_led;
                // What laws do elsewhere nothing here foretells.
                let is_steady = self.group.laws.is_empty() && STEADY_PART * self.growth_by_forces() >= 1.0;
                self.group.steady_step = is_steady.then_some(step);
                let accepted = Accepted { length: step, error };
                // A step that was made short of such a point tells nothing about those after it.
                let before = self.group.accepted.replace(accepted).filter(|_| !is_led);
                self.group.next_step = Some(if is_led {
                    natural
                } else {
                    let most = if rejected { 1.0 } else { self.largest_growth() };
                    step * method.factor_after(accepted, before).min(most)
                });
                let energy = closed.unwrap_or_else(|| self.end_with_rates(tools));
                let speed = self.top_speed(&self.group.end_state);
                if !method.is_adaptive() && control.speed > 0.0 && speed > RUNAWAY * control.speed {
                    return Err(StepFailure::RanAway(speed));
                }
                self.follow_rails();
                return Ok(energy);
            }
            [natural, step] = self.group.kept.shorter_lengths(step, method.step_factor(error), method);
            (rejected, is_led) = (true, is_led || step < natural);
        }
    }

    /// Steps the group as it is, from the last step on, or as a tree again.
    fn leave_tree(&mut self, is_left: bool) {
        let Group { tree, kept, .. } = &mut *self.group;
        if tree.leave(is_left) {
            kept.measure_otherwise(is_left);
        }
    }

    /// Tells the stepper how much the numbers that are stepped may err by.
    fn scale_errors(&mut self, tools: &mut Tools<'_>) {
        self.set_scales(&tools.settings.steps, tools.scales);
        tools.stepper.set_scales(tools.scales);
    }

    /// True if stages of the last step came so near a point where loops could go on in two ways that they are to be
    /// on the rows: in angles they are off those beside the pins, and what a few loops are off by there makes large
    /// forces of nothing.
    fn is_better_on_rows(&self) -> bool {
        let Group { tree, kept, .. } = &*self.group;
        kept.is_near_singular() && tree.has_few_loops() && self.group.stepping() != Stepping::Stiff
    }

    /// True if a step with such an error is kept. Where nothing touches, errors follow the step, and it is
    /// not by chance that one errs.
    fn keeps(&self, error: f64) -> bool {
        let any_contact = self.group.rows.iter().any(|row| !row.bilateral);
        if any_contact { is_kept(error) } else { error <= 1.0 }
    }

    /// Projects the end and evaluates the rates there. Returns the energy at the end, if anybody had to look.
    fn end_with_rates(&mut self, tools: &Tools<'_>) -> Option<Energy> {
        let energy = self.end_on_rows(tools);
        self.evaluate_end();
        energy
    }

    /// The same of a step whose error takes these rates.
    fn close_step(&mut self, tools: &mut Tools<'_>) -> Option<Energy> {
        let energy = self.end_with_rates(tools);
        if self.group.tree.is_used() {
            self.close_step_of_tree(tools.stepper);
        } else {
            tools.stepper.close(&self.group.end_rates);
        }
        energy
    }

    /// Goes a step from the group's state and rates to its end state, in the coordinates that the group is stepped in.
    fn step(&mut self, stepper: &mut Stepper, step: f64) {
        self.group.kept.open();
        if self.group.tree.is_used() {
            self.step_tree(stepper, step);
        } else {
            self.step_rows(stepper, step);
        }
        self.group.kept.close();
    }

    /// The same in the numbers of the group's state.
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

    /// By how much a step may be longer than the one before. Contacts soon cut steps short anyway, and where
    /// something has decayed steps are much longer at once.
    fn largest_growth(&self) -> f64 {
        let is_smooth = self.group.rows.iter().all(|row| row.bilateral);
        if is_smooth && self.group.stepping() != Stepping::Stiff {
            STEADY_GROWTH
        } else {
            self.growth_by_forces()
        }
    }

    /// The factor by which a step may grow so that no contact's force varies along it by more than it is, if
    /// it goes on to vary as along the last. Forces that hold bodies where they are show in no error, and
    /// along a step that is longer than they take to come and go, none could tell when they vanish.
    fn growth_by_forces(&self) -> f64 {
        let contacts = self.group.rows.iter().zip(&self.stage.force_ranges).filter(|(row, _)| !row.bilateral);
        let growths = contacts.map(|(_, &[least, largest])| {
            let (size, spread) = (least.abs().max(largest.abs()), largest - least);
            if spread > 0.0 { (size / spread).max(1.0) } else { f64::INFINITY }
        });
        growths.fold(f64::INFINITY, f64::min)
    }

    /// The next step is at most by a factor longer than the one just made, unless that says nothing about it.
    pub(crate) fn limit_next_step(&mut self, factor: f64) {
        if factor > 1.0 && self.group.kept.is_led {
            return;
        }
        let longest = self.group.span * factor;
        self.group.next_step = Some(self.group.next_step.map_or(longest, |next| next.min(longest)));
    }

    /// Repeats the segment up to an offset [s] within it, into the end state; false if that is seen to err by
    /// more than a step may, as where it ends at what the whole step has passed astride.
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

    /// True if dense output errs at an offset [s] by little of what a step may err by: that of explicit
    /// methods is of the order of the error estimate, and since it has the values and the rates at the start,
    /// near that by less with the square of the offset.
    pub(crate) fn is_dense_exact(&self, offset: f64) -> bool {
        let part = offset / self.group.span;
        let share = (EARLY_SHARE * part * part).min(1.0);
        self.group.stepping() != Stepping::Stiff
            && self.group.accepted.is_some_and(|step| share * step.error <= DENSE_ERROR)
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

    /// The longest step [s] over which rounding does not matter: that of accelerations, which grows with its
    /// square and which no error estimate sees of a group at rest, and that of the places where it ends,
    /// which all of it shares.
    fn longest_sound_step(&self) -> f64 {
        let allowed = ROUNDING_SHARE * self.physics.mechanism.tolerances.accuracy / f64::EPSILON;
        let of_places = allowed / self.top_speed(&self.group.state);
        (2.0 * allowed / self.group.free_acceleration).sqrt().min(of_places)
    }

    pub(crate) fn reach(&self, body: BodyId) -> f64 {
        self.physics.mechanism.flyers[body.index()].reach()
    }

    /// True unless rounding of positions, where forces vary over a short length, changes the energy by more than the
    /// tolerance allows.
    fn is_resolved(&self, control: &StepControl) -> bool {
        if self.group.force_length >= control.length || control.speed == 0.0 {
            return true;
        }
        let any_contact = self.group.rows.iter().any(|row| !row.bilateral);
        let gap = self.physics.mechanism.tolerances.target_gap;
        if any_contact && self.group.force_length <= TOLD_FROM_GAP * gap {
            return false;
        }
        let rounding = self.rounding() * self.group.free_acceleration;
        rounding <= UNRESOLVED * control.local_error * control.speed * control.speed
    }

    /// Rounding [m] of the positions of the group's bodies.
    pub(crate) fn rounding(&self) -> f64 {
        self.rounding_in(&self.group.state)
    }

    /// The same in a state.
    pub(crate) fn rounding_in(&self, state: &[f64]) -> f64 {
        let positions = state[..self.group.velocities()].chunks_exact(3);
        f64::EPSILON * positions.flat_map(|q| [q[0].abs(), q[1].abs()]).fold(0.0, f64::max)
    }

    /// The part of errors that is acceptable where forces vary over less than the length asked for, as near a
    /// centre of attraction. The bodies are faster there than before and after by much: an error that is
    /// small for that speed is not for the others. Energy as of a pull by the inverse square is told from
    /// less to the same part.
    fn depth_share(&self, control: &StepControl) -> f64 {
        (self.group.force_length / control.length).min(1.0)
    }

    /// The length [m] to which errors of position are relative: that over which forces vary, if it is less
    /// than asked for.
    fn length(&self, control: &StepControl) -> f64 {
        control.length.min(self.group.force_length)
    }

    /// A speed [m/s] of the group: of its fastest point now, or what forces would make of it over the length.
    /// What forces of rows cancel counts too, so that a group at rest is not held to its rounding.
    pub(crate) fn speed(&self, control: &StepControl) -> f64 {
        self.speed_in(&self.group.state, control)
    }

    /// The same of a state.
    pub(crate) fn speed_in(&self, state: &[f64], control: &StepControl) -> f64 {
        let forced = (self.group.free_acceleration * self.length(control)).sqrt();
        let speed = forced.max(self.top_speed(state));
        if speed > STANDSTILL * control.speed { speed } else { control.speed }
    }

    /// Speed [m/s] of the fastest point of the group in a state.
    fn top_speed(&self, state: &[f64]) -> f64 {
        let count = self.group.bodies.len();
        let speeds = self.group.bodies.iter().enumerate().map(|(place, &body)| {
            let at = 3 * (count + place);
            self.physics.mechanism.flyers[body.index()].fastest_point([
                state[at],
                state[at + 1],
                state[at + 2],
            ])
        });
        speeds.fold(0.0, f64::max)
    }

    /// Error of a velocity [m/s] that is just acceptable.
    pub(crate) fn velocity_scale(&self, control: &StepControl) -> f64 {
        control.local_error * self.speed(control)
    }

    /// A first step [s] where nothing is known: what takes the group its length, shorter for small errors.
    fn first_step(&self, control: &StepControl) -> f64 {
        let speed = self.speed(control);
        let time = if speed > 0.0 { self.length(control) / speed } else { 1.0 };
        time * libm::pow(control.local_error, FIRST_STEP_POWER)
    }

    /// Error [J] of a work that is just acceptable: what errors of velocities, just acceptable too, make of
    /// the energy. Works mostly err by far less, but where the motion is simple, as under a constant force,
    /// nothing else may err at all.
    fn work_scale(&self, control: &StepControl) -> f64 {
        let masses = self.group.bodies.iter().map(|&body| self.mass(body));
        let speed = self.speed(control);
        control.local_error * speed * speed * masses.sum::<f64>()
    }

    /// The error norm of the works, which follow so many components, by the scale [J] of each; 0 where nothing moves.
    fn work_error(&self, stepper: &Stepper, first: usize, scale: f64) -> f64 {
        if scale.is_nan() || scale <= 0.0 {
            return 0.0;
        }
        let error_of = |work: usize| stepper.error_norm_from(first + work, &[scale]);
        (0..self.group.works.len()).map(error_of).fold(0.0, f64::max)
    }

    /// Errors that are just acceptable, of positions and velocities.
    fn set_scales(&self, control: &StepControl, scales: &mut Vec<f64>) {
        let (length, speed) = (self.length(control), self.speed(control));
        let share = self.depth_share(control);
        let least = self.least_errors(share, speed);
        let any_contact = self.group.rows.iter().any(|row| !row.bilateral);
        let clearance = any_contact.then_some(CLEAR_SHARE * self.physics.mechanism.tolerances.accuracy);
        // Where nothing moves there is nothing to be wrong about.
        let or_infinite = |scale: f64| if scale > 0.0 { scale } else { f64::INFINITY };
        scales.clear();
        let linear = [(length, least[0]), (speed, least[1])].map(|(size, least)| {
            let linear = or_infinite(control.local_error * size * share);
            clearance.map_or(linear, |clearance| linear.min(clearance * size / length)).max(least)
        });
        let rounding = self.rounding();
        if self.group.tree.is_used() {
            let places = 0..self.group.bodies.len();
            let roughest = places.map(|place| self.group.rough_velocity(place, rounding)).fold(0.0, f64::max);
            return self.scale_tree([linear[0], linear[1].max(roughest)], scales);
        }
        for (linear, is_velocity) in linear.into_iter().zip([false, true]) {
            for (place, &body) in self.group.bodies.iter().enumerate() {
                let rough = if is_velocity { self.group.rough_velocity(place, rounding) } else { 0.0 };
                let linear = linear.max(rough);
                scales.extend([linear, linear, linear / self.reach(body)]);
            }
        }
    }

    /// Errors of positions and velocities that are no errors of a step: what rounding of positions makes of
    /// them where the group is fast because forces are steep. What else it makes of velocities is a matter of
    /// each body.
    fn least_errors(&self, share: f64, speed: f64) -> [f64; 2] {
        let rounding = self.rounding();
        let steep = if share < 1.0 { self.group.free_acceleration / speed } else { 0.0 };
        [rounding, rounding * steep]
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

    /// Notes where on splines the points of rails are at the end: searches from nearby are short, and do not
    /// stray where a rail crosses itself. On other rails events tell.
    pub(crate) fn follow_rails(&mut self) {
        let mechanism = &self.physics.mechanism;
        let Group { rows, bodies, end_state, .. } = &mut *self.group;
        for row in rows {
            let (RowSource::Connector(id, _), Some(hint)) = (row.source, &row.hint) else { continue };
            let connector = &mechanism.connectors[id.index()];
            let Some(path) = connector.path().filter(|path| path.knots().is_empty()) else { continue };
            let anchor = connector.anchors().0;
            let Ok(place) = bodies.binary_search(&anchor.body) else { continue };
            let point = body_state(end_state, bodies.len(), place).pose().point_to_world(anchor.point);
            row.hint = Some(path.hint_near(point, Some(hint)).staying());
        }
    }

    /// Dense output of the last step, into the group's paths.
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
