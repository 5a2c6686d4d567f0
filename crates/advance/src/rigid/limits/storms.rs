//! Storms: more events in a short time than forces can resolve. They are ended by an impact without elasticity.
//!
//! The resolution time is what acceleration takes to make `velocity_tol`; without acceleration, what the
//! fastest body takes to cross the target gap. Events between which bodies go far beyond the target gap are
//! resolved in space all the same: many more of them are no storm, and so are those in which much energy
//! would be lost; more still where both is so. A light body that heavy ones close on takes up all their
//! energy before it turns them back, and to do so it must hit them about as often as the root of the masses'
//! ratio; a die that jams in its slot is turned back by blows between which it goes a gap or two.

use crate::rigid::event::region::Region;
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use halfgap_collision::Tolerances;

/// Events of a body within the resolution time that are always allowed, and those for each row beyond them.
const CALM_EVENTS: usize = 20;
const CALM_EVENTS_PER_ROW: usize = 10;
/// An event is wide if its bodies came towards each other by more than so many target gaps since the one
/// before: a light body between heavy ones that close on it rattles ever faster until it has turned them
/// back. Of wide ones so many times as many are allowed.
const WIDE: f64 = 10.0;
const CALM_WIDE_EVENTS: usize = 50;
/// Events between which bodies come towards each other by less than such a part of the target zone, and which
/// follow each other in less than such a part of the time in which what is usually fast crosses the smallest
/// body, are counted on, however long they go on: forces that nothing at the start foretold press contacts
/// together, of which now the one, now the other gives way.
const STILL: f64 = 1e-6;
const AT_ONCE: f64 = 1e-8;
/// An event is costly if what closes would lose more than such a part of the energy of all that takes part:
/// it counts as a wide one. Of those that are both so many times as many again are allowed.
const COSTLY: f64 = 1e-3;
const CALM_COSTLY_EVENTS: usize = 100;
/// What counts for so many wide and costly ones.
const NARROW: usize = CALM_WIDE_EVENTS * CALM_COSTLY_EVENTS;
/// What counts for so many wide and costly ones is not looked at for what it would cost.
const MANY: usize = 10 * CALM_COSTLY_EVENTS;

/// What does not go farther in the resolution time than such a part of the target zone, and is not faster
/// than so many times `velocity_tol`, is at rest in a storm.
const STORM_WAY: f64 = 1e-3;
const STORM_SLOW: f64 = 10.0;

/// Recent events of one body.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Recent {
    /// When counting began, if it has.
    since: Option<Time>,
    /// Events since then: wide and costly ones as one, others as so many of them.
    events: usize,
    /// The last event, if there was any.
    last: Option<Time>,
}

impl RigidSystem {
    /// Rates [m/s] up to which a row is at rest in a storm: contacts of which now the one, now the other is
    /// left to open by rounding, though they are pressed, go on for ever. With such a rate nothing gets out
    /// of the target zone before the storm is over.
    pub(crate) fn storm_rest(&self) -> f64 {
        let Tolerances { accuracy, velocity_tol, .. } = self.settings.tolerances;
        let slow = (STORM_WAY * accuracy / self.settings.resolution_time).min(STORM_SLOW * velocity_tol);
        slow.max(self.rest_speed())
    }

    /// Counts an event for the bodies of a region; true if it is one too many.
    pub(crate) fn note_events(&mut self, region: &Region) -> bool {
        let (now, window) = (self.now, self.settings.resolution_time);
        let speed = region.records.iter().map(|record| -record.motion.normal_velocity).fold(0.0, f64::max);
        let Tolerances { target_gap, accuracy, .. } = self.settings.tolerances;
        let (wide, still) = (WIDE * target_gap, STILL * accuracy);
        let at_once = AT_ONCE * self.settings.steps.length / self.settings.steps.speed;
        // Of few events it does not matter.
        let is_often = region.bodies.iter().any(|body| self.limits.recent[body.index()].events > MANY);
        let is_costly = is_often && self.is_costly(region);
        let mut most = 0;
        for &body in &region.bodies {
            let recent = &mut self.limits.recent[body.index()];
            let wait = recent.last.map(|last| now.since(last));
            let way = wait.map(|wait| wait * speed);
            let is_still = way.is_some_and(|way| way < still) && wait.is_some_and(|wait| wait < at_once);
            if !is_still && recent.since.is_none_or(|since| now.since(since) > window) {
                *recent = Recent { since: Some(now), events: 0, ..*recent };
            }
            let is_wide = way.is_none_or(|way| way > wide);
            recent.events += match (is_wide, is_costly) {
                (true, true) => 1,
                (true, false) | (false, true) => CALM_COSTLY_EVENTS,
                (false, false) => NARROW,
            };
            recent.last = Some(now);
            most = most.max(recent.events);
        }
        let calm = CALM_EVENTS + CALM_EVENTS_PER_ROW * region.records.len();
        let is_storm = most > NARROW * calm;
        if is_storm {
            self.counts.storms += 1;
            for &body in &region.bodies {
                self.limits.recent[body.index()].events = 0;
            }
        }
        is_storm
    }

    /// True if what closes in a region has a good part of the kinetic energy of its bodies.
    fn is_costly(&self, region: &Region) -> bool {
        let closing = region.records.iter().map(|record| {
            let row = self.row_of(record);
            let (rate, inverse_mass) = (row.rate.min(0.0), row.coupling(&row));
            if inverse_mass > 0.0 { 0.5 * rate * rate / inverse_mass } else { 0.0 }
        });
        let moving = region.bodies.iter().map(|&body| {
            let flyer = self.flyer(body);
            flyer.body().kinetic_energy(&flyer.state_at(self.now))
        });
        closing.fold(0.0, f64::max) > COSTLY * moving.sum::<f64>()
    }
}
