//! Storms: more events in a short time than forces can resolve. They are ended by an impact without elasticity.
//!
//! The resolution time is what acceleration takes to make `velocity_tol`; without acceleration, what the fastest body takes
//! to cross the target gap. Events between which bodies go far beyond the target gap are resolved in space all the same: many
//! more of them are no storm.

use super::region::Region;
use super::system::RigidSystem;
use crate::time::Time;

/// Events of a body within the resolution time that are always allowed, and those for each row beyond them.
const CALM_EVENTS: usize = 20;
const CALM_EVENTS_PER_ROW: usize = 10;
/// An event is wide if its bodies came towards each other by more than so many target gaps since the one before: a light body between
/// heavy ones that close on it rattles ever faster until it has turned them back. Of wide ones so many times as many are allowed.
const WIDE: f64 = 100.0;
const CALM_WIDE_EVENTS: usize = 50;

/// Recent events of one body.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Recent {
    /// When counting began, if it has.
    since: Option<Time>,
    /// Events since then, wide ones as one and others as so many of them.
    events: usize,
    /// The last event, if there was any.
    last: Option<Time>,
}

impl RigidSystem {
    /// Counts an event for the bodies of a region; true if it is one too many.
    pub(crate) fn note_events(&mut self, region: &Region) -> bool {
        let (now, window) = (self.now, self.settings.resolution_time);
        let speed = region.records.iter().map(|record| -record.motion.normal_velocity).fold(0.0, f64::max);
        let wide = WIDE * self.settings.tolerances.target_gap;
        let mut most = 0;
        for &body in &region.bodies {
            let recent = &mut self.recent[body.index()];
            if recent.since.is_none_or(|since| now.since(since) > window) {
                *recent = Recent { since: Some(now), events: 0, ..*recent };
            }
            let is_wide = recent.last.is_none_or(|last| now.since(last) * speed > wide);
            recent.events += if is_wide { 1 } else { CALM_WIDE_EVENTS };
            recent.last = Some(now);
            most = most.max(recent.events);
        }
        let is_storm = most > CALM_WIDE_EVENTS * (CALM_EVENTS + CALM_EVENTS_PER_ROW * region.records.len());
        if is_storm {
            self.counts.storms += 1;
            for &body in &region.bodies {
                self.recent[body.index()].events = 0;
            }
        }
        is_storm
    }
}
