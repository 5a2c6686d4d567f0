//! Pace: how far a group comes with its steps. One that all but stands still, and of which nothing is heard, must not go on
//! for days.
//!
//! Steps may be tiny for good reasons, and for a while: a light body rattles between heavy ones, two centres pass each other
//! closely. So only steps without an impact count, many of them, and only if the time that is to be simulated would take a
//! hopeless number of such.

use super::group::Group;
use super::segment::StepFailure;
use super::system::RigidSystem;
use crate::time::Time;
use halfgap_collision::BodyId;

/// Steps in succession over which the pace is taken.
const STEPS: u32 = 10_000;
/// No run is waited for that would take so many steps.
const HOPELESS: f64 = 1e10;

/// The steps that a group has made lately, noted for its leader.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pace {
    /// When counting began, if it has.
    since: Option<Time>,
    steps: u32,
}

impl Pace {
    /// Notes a step that begins at a time; every so often the mean length [s] of the last ones.
    fn note(&mut self, start: Time) -> Option<f64> {
        let since = *self.since.get_or_insert(start);
        if self.steps < STEPS {
            self.steps += 1;
            return None;
        }
        *self = Self { since: Some(start), steps: 1 };
        Some(start.since(since) / f64::from(STEPS))
    }
}

impl RigidSystem {
    /// Tells for how long [s] the system will be advanced in all. With that, steps are told that will never come to an end
    /// ([`AdvanceError::Crawls`](super::AdvanceError::Crawls)); else one waits for ever.
    pub fn expect(&mut self, duration: f64) {
        self.horizon = duration;
    }

    /// Notes the step that a group has begun, and fails if such steps have become hopeless.
    pub(crate) fn note_pace(&mut self, group: &Group) -> Result<(), StepFailure> {
        let mean = self.paces[group.leader().index()].note(group.start);
        match mean.filter(|mean| mean * HOPELESS < self.horizon) {
            Some(mean) => Err(StepFailure::Crawls(mean)),
            None => Ok(()),
        }
    }

    /// Bodies have taken part in an impact: something happens.
    pub(crate) fn forget_paces(&mut self, bodies: &[BodyId]) {
        bodies.iter().for_each(|body| self.paces[body.index()] = Pace::default());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_that_of_the_steps_since_it_was_last_told() {
        let mut pace = Pace::default();
        let mut told = Vec::new();
        for step in 0..=2 * STEPS {
            // The second half at a tenth of the pace.
            let tenths = if step < STEPS { 10 * step } else { 9 * STEPS + step };
            told.extend(pace.note(Time::from_seconds(0.1 * f64::from(tenths))));
        }
        assert!(
            matches!(told[..], [first, second] if (first - 1.0).abs() < 1e-12 && (second - 0.1).abs() < 1e-12),
            "{told:?}"
        );
    }
}
