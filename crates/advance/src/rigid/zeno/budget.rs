//! The budget of events: what a body may take part in within the resolution time of its region.
//!
//! An event costs as many units as it has records, if it is slow: no contact closes by more than a multiple of the speed
//! that forces give a body in a step of its region. A body may spend so many units at once, and regains some with each
//! span of such a step. Beyond that, its region goes on by steps until its budget is whole again; in a step each contact
//! that begins or ends to press costs what an event of the region would. So what is many but fast, as the blows of a light body
//! between heavy ones, is followed, however often it is; and what is slow is followed as long as it is few.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::shares::{LARGE, SEVERAL};
use crate::rigid::zeno::memory::Zeno;
use crate::time::Time;
use halfgap_collision::{BodyId, Collision};

/// Units that a body may spend at once [-].
const BUDGET: f64 = 2000.0;
/// Units that a body regains in the span of a step of its region [-].
const REGAINED: f64 = 10.0;

/// What a body has spent.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Spent {
    /// Units spent and not yet regained [-].
    units: f64,
    /// Time at which that was so.
    at: Time,
    /// The body goes on by steps until all is regained.
    by_steps: bool,
}

impl Spent {
    fn regain(&mut self, now: Time, span: f64) {
        self.units = (self.units - REGAINED * now.since(self.at) / span).max(0.0);
        self.at = now;
        self.by_steps &= self.units > 0.0;
    }

    fn spend(&mut self, units: f64) {
        self.units += units;
        self.by_steps |= self.units >= BUDGET;
        if self.by_steps {
            // Calm for as long as it takes to regain that, it goes on by events.
            self.units = self.units.min(BUDGET / SEVERAL);
        }
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
    let fastest = records.iter().map(|record| -record.motion.normal_velocity).fold(0.0, f64::max);
    let units = if fastest > LARGE * steps.slow() { 0.0 } else { records.len().max(1) as f64 };
    charge(zeno, bodies.iter().copied(), units, assembly.now(), steps.span)
}

/// Charges units to some bodies; true if any of them goes on by steps.
pub(crate) fn charge(
    zeno: &mut Zeno,
    bodies: impl Iterator<Item = BodyId>,
    units: f64,
    now: Time,
    span: f64,
) -> bool {
    let mut by_steps = false;
    for body in bodies {
        let spent = &mut zeno.spent[body.index()];
        spent.regain(now, span);
        spent.spend(units);
        by_steps |= spent.by_steps;
    }
    by_steps
}

/// Makes some bodies go on by steps.
pub(crate) fn spend_all(zeno: &mut Zeno, bodies: impl Iterator<Item = BodyId>, now: Time) {
    for body in bodies {
        let spent = &mut zeno.spent[body.index()];
        spent.at = now;
        spent.spend(BUDGET);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_spent_at_once_makes_a_body_step_until_it_is_regained() {
        let (mut zeno, body, span) = (Zeno::new(1), [BodyId(0)], 1e-3);
        let mut spends = |units: f64, spans: f64| {
            let now = Time::ZERO.plus(spans * span);
            charge(&mut zeno, body.into_iter(), units, now, span)
        };
        assert!(!spends(0.9 * BUDGET, 0.0), "it has not spent all");
        assert!(!spends(0.9 * BUDGET, BUDGET / REGAINED), "it has regained what it had spent");
        assert!(spends(0.2 * BUDGET, BUDGET / REGAINED));
        let calm = BUDGET / (SEVERAL * REGAINED);
        assert!(spends(0.0, BUDGET / REGAINED + 0.9 * calm), "it is not calm yet");
        assert!(!spends(0.0, BUDGET / REGAINED + 1.1 * calm));
    }
}
