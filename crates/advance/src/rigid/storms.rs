//! Storms: more events in a short time than forces can resolve. They are ended by an impact without elasticity.
//!
//! The resolution time is what acceleration takes to make `velocity_tol`; without acceleration, what the fastest body takes
//! to cross the target gap.

use super::region::Region;
use super::system::RigidSystem;
use crate::time::Time;

/// Events of a body within the resolution time that are always allowed, and those for each row beyond them.
const CALM_EVENTS: usize = 20;
const CALM_EVENTS_PER_ROW: usize = 10;

/// Recent events of one body.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Recent {
    /// When counting began, if it has.
    since: Option<Time>,
    /// Events since then.
    events: usize,
}

impl RigidSystem {
    /// Counts an event for the bodies of a region; true if it is one too many.
    pub(crate) fn note_events(&mut self, region: &Region) -> bool {
        let (now, window) = (self.now, self.settings.resolution_time);
        let mut most = 0;
        for &body in &region.bodies {
            let recent = &mut self.recent[body.index()];
            if recent.since.is_none_or(|since| now.since(since) > window) {
                *recent = Recent { since: Some(now), events: 0 };
            }
            recent.events += 1;
            most = most.max(recent.events);
        }
        let is_storm = most > CALM_EVENTS + CALM_EVENTS_PER_ROW * region.records.len();
        if is_storm {
            self.counts.storms += 1;
            for &body in &region.bodies {
                self.recent[body.index()].events = 0;
            }
        }
        is_storm
    }
}
