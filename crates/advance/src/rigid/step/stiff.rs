//! Groups parts of which decay so fast that an explicit method is held up: their steps are implicit, as long
//! as that costs less. Which steps are made otherwise is in `brief`.

use super::brief::Stepping;
use super::dynamics::Dynamics;
use super::extending::Tools;
use super::group::Group;
use crate::ode::{Method, Point, StiffnessEstimate};
use glam::DVec2;

/// A step counts as held up when the fastest rate times its length comes to this part of the limit of the method.
const HELD_UP: f64 = 0.9;
/// The same where rounding may be what errors are made of: an explicit method feels that of the fastest
/// forces whatever its steps, an implicit one does not.
const ROUGH_HELD_UP: f64 = 0.1;
/// What is less than this part of it is far from held up.
const FAR: f64 = 0.5;
/// Explicit steps over which nobody looks again after one that was far from held up.
const UNTOLD_STEPS: u32 = 15;
/// Somebody looks sooner where steps have shrunk to this part: what ends them may be new.
const SHRUNK: f64 = 0.5;
/// So many more steps are held up than are not before implicit ones are tried; twice as many after each time
/// in vain, and one where implicit ones have served before.
const TELLING_STEPS: u32 = 8;
/// Cap on such doublings.
const MOST_DOUBLINGS: u32 = 6;
/// Groups with more numbers in their state are not tried: the equations would be larger than they are worth.
const MOST_NUMBERS: usize = 600;
/// Explicit steps of the default method ask for so many rates, with their dense output.
const EXPLICIT_COST: f64 = 15.0;
/// An implicit step asks for so many rates beside one for each number of the state.
const IMPLICIT_COST: f64 = 14.0;
/// The equations cost so many rates for each square of the numbers of the state: an estimate, by the
/// operations of both.
const EQUATIONS_COST: f64 = 0.02;
/// So many implicit steps that save nothing are in vain.
const PATIENCE: f64 = 10.0;
/// A step that may grow by no more than this is as long as its error allows.
const FULL_GROWN: f64 = 1.2;

/// Places are moved by so many of their roundings to see how steep forces are.
const PROBE: f64 = 1e6;
/// A probe that finds less than this part of what the last one found is taken for one in an idle direction.
const FADING: f64 = 0.9;

/// What is known of the fastest rate of a group.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Stiffness {
    /// Steps are implicit.
    pub(crate) is_stiff: bool,
    /// Implicit steps have served before.
    is_known: bool,
    /// The fastest rate [1/s], as last told.
    rate: f64,
    /// The rate [1/s] that the steepest forces have, where rounding of places may matter: short steps do not tell it.
    steep: f64,
    /// Steps that were held up, less those that were not.
    held_up: u32,
    /// Steps until somebody looks again.
    wait: u32,
    /// Length of the step [s] at which somebody looked last.
    looked: f64,
    /// Explicit steps that implicit ones have saved so far, less what they cost.
    saved: f64,
    /// How often implicit steps cost more.
    in_vain: u32,
}

impl Stiffness {
    /// The more telling of two, of bodies that come to share their steps.
    pub(crate) fn or(self, other: Self) -> Self {
        let first_tells = (self.is_known, self.rate) >= (other.is_known, other.rate);
        let told = if first_tells { self } else { other };
        Self { in_vain: self.in_vain.max(other.in_vain), ..told }
    }

    /// True if what is fast lets an explicit method go so long a step [s].
    pub(crate) fn allows(&self, step: f64) -> bool {
        self.rate * step < 1.0
    }
}

/// What an implicit step of so many numbers costs, in explicit ones.
fn cost(numbers: usize) -> f64 {
    let numbers = numbers as f64;
    (numbers + IMPLICIT_COST + EQUATIONS_COST * numbers * numbers) / EXPLICIT_COST
}

impl Dynamics<'_> {
    /// How fast the fastest part of the group is, as a step tells whose end has its rates; `None` where nobody looks.
    pub(crate) fn tell_stiffness(&mut self, tools: &mut Tools<'_>) -> Option<StiffnessEstimate> {
        if !tools.settings.method.is_adaptive() || self.group.is_brief {
            return None;
        }
        let Stiffness { wait, looked, rate, .. } = self.group.stiffness;
        let rate = rate.max(self.damping_rate());
        let is_far = |limit: f64| rate * self.group.span < FAR * limit;
        let is_far = tools.stepper.method().stability_limit().is_none_or(is_far);
        if wait > 0 && is_far && self.group.span >= SHRUNK * looked {
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

    /// The fastest rate [1/s] at which damping lets a body of the group come to rest. What is at rest already
    /// does not show it.
    fn damping_rate(&self) -> f64 {
        let laws = self.group.bodies.iter().map(|&body| self.physics.mechanism.flyers[body.index()].law());
        laws.map(|law| law.linear_rate.max(law.angular_rate)).fold(0.0, f64::max)
    }

    /// Notes how fast damping is, where nobody has looked how fast the fastest part of the group is.
    pub(crate) fn note_damping(&mut self) {
        let rate = self.damping_rate();
        let stiffness = &mut self.group.stiffness;
        stiffness.rate = stiffness.rate.max(rate);
    }

    /// The longest step [s] of a method that is stable under damping. A longer one from rest ends at rest,
    /// too, by luck, but what rounding sets in motion grows on the way, and dense output is far off.
    pub(crate) fn longest_stable_step(&self, method: Method) -> f64 {
        let rate = self.damping_rate();
        let limit = method.stability_limit().filter(|_| rate > 0.0 && method.is_adaptive());
        limit.map_or(f64::INFINITY, |limit| limit / rate)
    }

    /// Notes how fast the fastest part of the group is, after a step that told it.
    pub(crate) fn note_stiffness(&mut self, tools: &mut Tools<'_>, told: Option<StiffnessEstimate>) {
        let Some(StiffnessEstimate { fastest: told, .. }) = told else { return };
        self.probe(tools);
        let told = told.max(self.damping_rate() * self.group.span);
        let numbers = self.group.numbers();
        let rate = told / self.group.span;
        // What is fast makes this of the rounding of positions in a step.
        let steep = rate.max(self.group.stiffness.steep);
        let is_rough =
            steep * steep * self.group.span * self.rounding() >= self.velocity_scale(&tools.settings.steps);
        let held_up = if is_rough { ROUGH_HELD_UP } else { HELD_UP };
        let stiffness = &mut self.group.stiffness;
        stiffness.rate = rate;
        match (tools.stepper.method().stability_limit(), tools.settings.method.stability_limit()) {
            (Some(limit), _) if told >= held_up * limit => stiffness.held_up += 1,
            (Some(limit), _) => {
                stiffness.held_up = stiffness.held_up.saturating_sub(1);
                stiffness.wait = if told < FAR * limit { UNTOLD_STEPS } else { 0 };
            }
            (None, limit) => {
                let saved = stiffness.saved + told / limit.unwrap_or(told) - cost(numbers);
                stiffness.saved = saved.min(PATIENCE * cost(numbers));
            }
        }
    }
}

impl Dynamics<'_> {
    /// Finds how steep forces are at the end of an explicit step, if rounding may be what its errors are made
    /// of: by what they change where bodies are moved a little, each time in other directions.
    fn probe(&mut self, tools: &Tools<'_>) {
        let (rounding, span) = (self.rounding(), self.group.span);
        let scale = self.velocity_scale(&tools.settings.steps);
        let Some(limit) = tools.stepper.method().stability_limit() else { return };
        // What is steeper than this would have ended the step.
        if limit * limit * rounding < scale * span {
            self.group.stiffness.steep = 0.0;
            self.group.roughness.clear();
            return;
        }
        let moved = PROBE * rounding;
        let turn = self.stage.evaluations;
        let mut trial = std::mem::take(&mut self.stage.trial);
        let mut rates = std::mem::take(&mut self.stage.trial_rates);
        trial.clone_from(&self.group.end_state);
        rates.clear();
        rates.resize(trial.len(), 0.0);
        for (place, &body) in self.group.bodies.iter().enumerate() {
            let way = moved * DVec2::from_angle((turn + place as u64) as f64);
            let reach = self.physics.mechanism.flyers[body.index()].reach();
            trial[3 * place] += way.x;
            trial[3 * place + 1] += way.y;
            trial[3 * place + 2] += (way.x + way.y) / reach;
        }
        let gap_error = self.stage.gap_error;
        self.find_rates_at(span, &trial, &mut rates);
        self.stage.gap_error = gap_error;
        self.stage.load(&self.group.bodies, &self.group.end_state);
        let velocities = self.group.velocities();
        let Group { bodies, end_rates, roughness, .. } = &mut *self.group;
        roughness.resize(bodies.len(), 0.0);
        let mut most: f64 = 0.0;
        for (place, (&body, rough)) in bodies.iter().zip(roughness).enumerate() {
            let reach = self.physics.mechanism.flyers[body.index()].reach();
            let change = |k: usize| {
                let at = velocities + 3 * place + k;
                (rates[at] - end_rates[at]).abs()
            };
            let changed = change(0).max(change(1)).max(change(2) * reach);
            // The square of a rate: it fades twice.
            *rough = (changed / moved).max(FADING * FADING * *rough);
            most = most.max(changed);
        }
        if self.group.rows.iter().any(|row| !row.bilateral) {
            // Forces of contacts have a rounding of their own, which places do not tell.
            self.group.roughness.clear();
        }
        (self.stage.trial, self.stage.trial_rates) = (trial, rates);
        let found = (most / moved).sqrt();
        let known = &mut self.group.stiffness.steep;
        *known = found.max(FADING * *known);
    }
}

impl Group {
    /// What rounding of places [m] makes of the velocity [m/s] of a body, by its place, in a step as short as
    /// the fastest part of the group asks for. Where it is not known how rough each body is, it may be of
    /// that part. An implicit method knows what is rounding itself.
    pub(crate) fn rough_velocity(&self, place: usize, rounding: f64) -> f64 {
        let rate = self.stiffness.rate.max(self.stiffness.steep);
        if rate == 0.0 || self.stepping() == Stepping::Stiff {
            return 0.0;
        }
        rounding * self.roughness.get(place).map_or(rate, |roughness| roughness / rate)
    }

    /// Goes over to implicit steps where explicit ones are held up. Goes back where that costs more, and
    /// where steps are short enough for explicit ones: as something begins to decay, a higher order serves
    /// better.
    pub(crate) fn choose_stiffness(&mut self, asked: Method) {
        let numbers = self.numbers();
        let cost = cost(numbers);
        let known = &mut self.stiffness;
        if !known.is_stiff {
            let needed = if known.is_known { 1 } else { TELLING_STEPS << known.in_vain.min(MOST_DOUBLINGS) };
            if known.held_up >= needed && numbers <= MOST_NUMBERS {
                *known = Stiffness { is_stiff: true, is_known: true, held_up: 0, saved: 0.0, ..*known };
                self.accepted = None;
            }
            return;
        }
        let Some(next) = self.next_step else { return };
        let is_lost = known.saved < -PATIENCE * cost;
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

    /// Goes back to explicit steps because implicit ones do not serve.
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

    /// Numbers of its state without works.
    fn numbers(&self) -> usize {
        if self.tree.is_used() { 2 * self.tree.count() } else { 2 * self.velocities() }
    }
}
