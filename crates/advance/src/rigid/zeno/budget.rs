//! The budget of events: what a body may take part in within the resolution time of its region.
//!
//! An event is charged if it is slow or unresolved: no contact closes by more than a multiple of the speed that forces give a body
//! in a step of its region, or it comes before the body has gone as far as a step may be off. It costs as many units as its records
//! squared, about as its time grows. A body may spend so many units at once, and regains some with each span of a step. Beyond that,
//! its region goes on by steps, until in some steps running no contact begins or ends to press. So what is many but fast, as the blows
//! of a light body between heavy ones, is followed, however often it is; and what is slow is followed as long as it is few.
//!
//! *Invariant*: a body that goes by steps has some of them still to go.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::shares::LARGE;
use crate::rigid::zeno::memory::Zeno;
use crate::time::Time;
use halfgap_collision::{BodyId, Collision};

/// Units that a body may spend at once [-]. With five times as many, frames of a pile of a hundred discs take 45 ms instead of 12; a
/// ball that bounces 24,500 times between tiles that hardly differ in slope spends nearly all, and would lose speed in steps.
const BUDGET: f64 = 2.5e4;
/// Units that a body regains in the span of a step of its region [-]. With five times as many a plug with a play of 1e-9 m rattles on
/// event by event.
const REGAINED: f64 = 10.0;
/// Number of steps running without a change after which bodies go on by events.
const CALM_STEPS: u32 = 10;

/// What a body has spent.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Spent {
    /// Units spent and not yet regained [-].
    units: f64,
    /// Time at which that was so; `None` before the first event.
    at: Option<Time>,
    /// Number of steps without a change still to go, if the body goes by steps; else 0.
    steps: u32,
}

impl Spent {
    /// Time [s] since the last event.
    fn since_last(&self, now: Time) -> f64 {
        self.at.map_or(f64::INFINITY, |at| now.since(at))
    }

    /// Regains what it does by now, and spends units; true if the body is to go on by steps.
    fn charge(&mut self, units: f64, now: Time, span: f64) -> bool {
        self.units = (self.units - REGAINED * self.since_last(now) / span).max(0.0) + units;
        self.at = Some(now);
        if self.units >= BUDGET {
            self.units = 0.0;
            self.steps = CALM_STEPS;
        }
        self.steps > 0
    }
}

/// Charges an event to some bodies, given the records of their contacts; true if they are to go on by steps.
pub(crate) fn charge_event(
    assembly: &Assembly,
    zeno: &mut Zeno,
    bodies: &[BodyId],
    records: &[Collision],
) -> bool {
    let Some(steps) = assembly.settings().region_steps else { return false };
    let now = assembly.now();
    let fastest = records.iter().map(|record| -record.motion.normal_velocity).fold(0.0, f64::max);
    let is_slow = fastest <= LARGE * steps.slow;
    let units = (records.len().max(1) as f64).powi(2);
    let mut by_steps = false;
    for &body in bodies {
        let spent = &mut zeno.spent[body.index()];
        let is_unresolved = fastest * spent.since_last(now) <= steps.slack;
        by_steps |= spent.charge(if is_slow || is_unresolved { units } else { 0.0 }, now, steps.span);
    }
    by_steps
}

/// Notes a step of some bodies, in which contacts have begun or ended to press or not; true if they go on by steps.
pub(crate) fn note_step(
    zeno: &mut Zeno,
    bodies: impl Iterator<Item = BodyId>,
    changes: bool,
    now: Time,
) -> bool {
    let mut by_steps = false;
    for body in bodies {
        let spent = &mut zeno.spent[body.index()];
        spent.at = Some(now);
        if spent.steps > 0 {
            spent.steps = if changes { CALM_STEPS } else { spent.steps - 1 };
        }
        by_steps |= spent.steps > 0;
    }
    by_steps
}

/// Makes some bodies go on by steps.
pub(crate) fn spend_all(zeno: &mut Zeno, bodies: impl Iterator<Item = BodyId>) {
    for body in bodies {
        zeno.spent[body.index()].steps = CALM_STEPS;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_spent_at_once_makes_a_body_step_until_nothing_changes() {
        let (mut spent, span) = (Spent::default(), 1e-3);
        let mut spends = |units: f64, spans: f64| spent.charge(units, Time::ZERO.plus(spans * span), span);
        let spans = BUDGET / REGAINED;
        assert!(!spends(0.9 * BUDGET, 0.0), "it has not spent all");
        assert!(!spends(0.9 * BUDGET, spans), "it has regained what it had spent");
        assert!(spends(0.2 * BUDGET, spans));
        let (mut zeno, body, now) = (Zeno::new(1), [BodyId(0)], Time::ZERO);
        zeno.spent[0] = spent;
        let mut steps = |changes: bool| note_step(&mut zeno, body.into_iter(), changes, now);
        for changes in [false, false, true] {
            assert!(steps(changes));
        }
        for _ in 1..CALM_STEPS {
            assert!(steps(false), "it is not calm yet");
        }
        assert!(!steps(false) && !steps(true));
    }
}
