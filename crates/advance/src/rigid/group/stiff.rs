//! Stiff groups: a part of the group decays so fast that the stability limit of the explicit method, not its error,
//! bounds the step. Their steps are implicit as long as that costs less. The choice among explicit methods is in
//! `brief`.
//!
//! The fastest rate [1/s] of a group is the size of its fastest eigenvalue, as estimated after steps. An explicit step
//! is held up if that rate times its length comes near the stability limit of the method.

use crate::ode::{Method, Point, StiffnessEstimate};
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::state::Group;
use crate::rigid::group::stepping::Stepping;
use crate::rigid::group::stiffness::Stiffness;
use crate::rigid::group::tools::Tools;
use crate::rigid::shares::{LARGE, NEARLY_ALL, ROUNDS, SMALL, WORTHWHILE};
use glam::DVec2;

/// Number of explicit steps without an estimate after one that was far from held up.
const UNTOLD_STEPS: u32 = 15;
/// Number by which held-up steps must exceed others before implicit ones are tried: doubled after each trial in vain,
/// and 1 where implicit steps have served before.
const TELLING_STEPS: u32 = 8;
/// Largest number of state components (works excluded) for implicit steps: the equations of more would cost too much.
const MOST_NUMBERS: usize = 600;
/// Number of evaluations of rates in an explicit step of the default method, with its dense output.
const EXPLICIT_COST: f64 = 15.0;
/// Number of evaluations of rates in an implicit step, beside one for each component of the state.
const IMPLICIT_COST: f64 = 14.0;
/// Cost of an implicit step's linear equations, in evaluations of rates per square of the number of components: an
/// estimate from the operations of both.
const EQUATIONS_COST: f64 = 0.02;
/// A step has its full length, which its error allows, if the next one may be longer by no more than this factor.
const FULL_GROWN: f64 = 1.2;

/// Displacement of a probe for the steepness of forces, as a multiple of the rounding of positions.
const PROBE: f64 = 1e6;

/// Cost of an implicit step for a number of state components, in explicit steps.
fn cost(numbers: usize) -> f64 {
    let numbers = numbers as f64;
    (numbers + IMPLICIT_COST + EQUATIONS_COST * numbers * numbers) / EXPLICIT_COST
}

impl Dynamics<'_> {
    /// Estimates the fastest rate of the group from the last step, with the rates at its end; `None` if no estimate is
    /// due.
    pub(crate) fn tell_stiffness(&mut self, tools: &mut Tools<'_>) -> Option<StiffnessEstimate> {
        if !tools.settings.method.is_adaptive() || self.group.is_brief || self.group.is_determined() {
            return None;
        }
        let Stiffness { wait, looked, rate, .. } = self.group.stiffness;
        let rate = rate.max(self.damping_rate());
        let is_far = |limit: f64| rate * self.group.span < WORTHWHILE * limit;
        let is_far = tools.stepper.method().stability_limit().is_none_or(is_far);
        if wait > 0 && is_far && self.group.span >= WORTHWHILE * looked {
            self.group.stiffness.wait -= 1;
            return None;
        }
        self.group.stiffness.looked = self.group.span;
        Some(if self.group.tree.is_used() {
            self.stiffness_of_tree(tools.stepper, tools.scales)
        } else {
            let Group { end_state, end_rates, span, .. } = &*self.group;
            tools.stepper.stiffness(Point { offset: *span, state: end_state, rates: end_rates }, tools.scales)
        })
    }

    /// The largest damping rate [1/s] of a body of the group. Estimates from steps do not show it in bodies at rest.
    fn damping_rate(&self) -> f64 {
        let force_laws = self
            .group
            .bodies
            .iter()
            .map(|&body| self.physics.mechanism.trajectories[body.index()].free_motion());
        force_laws.map(|law| law.linear_rate.max(law.angular_rate)).fold(0.0, f64::max)
    }

    /// Raises the fastest rate of the group to its damping rate, which may not have been estimated yet.
    pub(crate) fn note_damping(&mut self) {
        let rate = self.damping_rate();
        let stiffness = &mut self.group.stiffness;
        stiffness.rate = stiffness.rate.max(rate);
    }

    /// The longest step [s] for which a method is stable under damping. A longer step from rest may end at rest, too,
    /// but rounding errors grow within it, and its dense output is far off.
    pub(crate) fn longest_stable_step(&self, method: Method) -> f64 {
        let rate = self.damping_rate();
        let limit = method.stability_limit().filter(|_| rate > 0.0 && method.is_adaptive());
        limit.map_or(f64::INFINITY, |limit| limit / rate)
    }

    /// Notes the estimate of the fastest rate of the group after a step, if there is one.
    pub(crate) fn note_stiffness(&mut self, tools: &mut Tools<'_>, told: Option<StiffnessEstimate>) {
        let Some(StiffnessEstimate { fastest: told, .. }) = told else { return };
        self.probe(tools);
        let told = told.max(self.damping_rate() * self.group.span);
        let numbers = self.group.numbers();
        let rate = told / self.group.span;
        // Rounding of positions becomes accelerations by the square of this rate.
        let steep = rate.max(self.group.stiffness.steep);
        let is_rough =
            steep * steep * self.group.span * self.rounding() >= self.velocity_scale(&tools.settings.steps);
        // Steep forces amplify rounding in an explicit method however short its steps, but not in an implicit one.
        let held_up = if is_rough { SMALL } else { NEARLY_ALL };
        let stiffness = &mut self.group.stiffness;
        stiffness.rate = rate;
        match (tools.stepper.method().stability_limit(), tools.settings.method.stability_limit()) {
            (Some(limit), _) if told >= held_up * limit => stiffness.held_up += 1,
            (Some(limit), _) => {
                stiffness.held_up = stiffness.held_up.saturating_sub(1);
                stiffness.wait = if told < WORTHWHILE * limit { UNTOLD_STEPS } else { 0 };
            }
            (None, limit) => {
                let saved = stiffness.saved + told / limit.unwrap_or(told) - cost(numbers);
                stiffness.saved = saved.min(LARGE * cost(numbers));
            }
        }
    }
}

impl Dynamics<'_> {
    /// Probes the steepness of forces at the end of an explicit step, if its errors may be rounding: by the change of
    /// accelerations as the bodies are moved a little, in other directions each time.
    fn probe(&mut self, tools: &Tools<'_>) {
        let (rounding, span) = (self.rounding(), self.group.span);
        let scale = self.velocity_scale(&tools.settings.steps);
        let Some(limit) = tools.stepper.method().stability_limit() else { return };
        // Forces steep enough to matter would have bounded the step by the stability limit.
        if limit * limit * rounding < scale * span {
            self.group.stiffness.steep = 0.0;
            self.group.roughness.clear();
            return;
        }
        let moved = PROBE * rounding;
        let turn = self.group.stiffness.probes;
        self.group.stiffness.probes = turn.wrapping_add(1);
        let mut trial = std::mem::take(&mut self.stage.trial);
        let mut rates = std::mem::take(&mut self.stage.trial_rates);
        trial.clone_from(&self.group.end_state);
        rates.clear();
        rates.resize(trial.len(), 0.0);
        for (place, &body) in self.group.bodies.iter().enumerate() {
            let way = moved * DVec2::from_angle(f64::from(turn) + place as f64);
            let reach = self.physics.mechanism.trajectories[body.index()].reach();
            trial[3 * place] += way.x;
            trial[3 * place + 1] += way.y;
            trial[3 * place + 2] += (way.x + way.y) / reach;
        }
        let gap_error = self.stage.gap_error;
        self.find_rates_at(span, &trial, &mut rates);
        self.stage.gap_error = gap_error;
        let end = std::mem::take(&mut self.group.end_state);
        self.load(&end, span);
        self.group.end_state = end;
        let velocities = self.group.velocities();
        let Group { bodies, end_rates, roughness, .. } = &mut *self.group;
        roughness.resize(bodies.len(), 0.0);
        let mut most: f64 = 0.0;
        for (place, (&body, rough)) in bodies.iter().zip(roughness).enumerate() {
            let reach = self.physics.mechanism.trajectories[body.index()].reach();
            let change = |k: usize| {
                let at = velocities + 3 * place + k;
                (rates[at] - end_rates[at]).abs()
            };
            let changed = change(0).max(change(1)).max(change(2) * reach);
            // It is the square of a rate, so it fades by the square of the factor.
            *rough = (changed / moved).max(NEARLY_ALL * NEARLY_ALL * *rough);
            most = most.max(changed);
        }
        if self.group.rows.iter().any(|row| !row.bilateral) {
            // Contact forces have a rounding of their own, which a displacement does not show.
            self.group.roughness.clear();
        }
        (self.stage.trial, self.stage.trial_rates) = (trial, rates);
        let found = (most / moved).sqrt();
        let known = &mut self.group.stiffness.steep;
        *known = found.max(NEARLY_ALL * *known);
    }
}

impl Group {
    /// Error [m/s] that the rounding of positions [m] makes in the velocity of a body, given by its place, in a step as
    /// short as the fastest rate of the group asks for. A body that was not probed may be the fastest part of the
    /// group. 0 for implicit steps, whose method accounts for rounding.
    pub(crate) fn rough_velocity(&self, place: usize, rounding: f64) -> f64 {
        let rate = self.stiffness.rate.max(self.stiffness.steep);
        if rate == 0.0 || self.stepping() == Stepping::Stiff {
            return 0.0;
        }
        rounding * self.roughness.get(place).map_or(rate, |roughness| roughness / rate)
    }

    /// Changes to implicit steps if explicit ones are held up. Changes back if that costs more, or if steps are short
    /// enough for explicit ones: as a motion begins to decay, a higher order serves better.
    pub(crate) fn choose_stiffness(&mut self, asked: Method) {
        let numbers = self.numbers();
        let cost = cost(numbers);
        let known = &mut self.stiffness;
        if !known.is_stiff {
            let needed = if known.is_known { 1 } else { TELLING_STEPS << known.in_vain.min(ROUNDS) };
            if known.held_up >= needed && numbers <= MOST_NUMBERS {
                *known = Stiffness { is_stiff: true, is_known: true, held_up: 0, saved: 0.0, ..*known };
                self.accepted = None;
            }
            return;
        }
        let Some(next) = self.next_step else { return };
        let is_lost = known.saved < -LARGE * cost;
        if next > FULL_GROWN * self.span {
            return;
        }
        if is_lost {
            self.leave_stiffness(asked);
        } else if asked.stability_limit().is_some_and(|limit| known.rate * self.span < limit) {
            known.is_stiff = false;
            known.in_vain = if known.saved > 0.0 { 0 } else { known.in_vain };
            self.make_stable(asked);
        }
    }

    /// Changes back to explicit steps because implicit ones cost more.
    pub(crate) fn leave_stiffness(&mut self, asked: Method) {
        let known = &mut self.stiffness;
        *known = Stiffness { is_stiff: false, is_known: false, in_vain: known.in_vain + 1, ..*known };
        self.make_stable(asked);
    }

    /// Makes the next step short enough for an explicit method.
    fn make_stable(&mut self, asked: Method) {
        let stable = asked.stability_limit().map_or(f64::INFINITY, |limit| limit / self.stiffness.rate);
        self.next_step = self.next_step.map(|next| next.min(stable));
        self.accepted = None;
    }

    /// Number of components of its state, works excluded.
    fn numbers(&self) -> usize {
        if self.tree.is_used() { 2 * self.tree.count() } else { 2 * self.velocities() }
    }
}
