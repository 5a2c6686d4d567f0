//! The advance of a world, and how it tells its caller what happens. The crate
//! `halfgap-advance` finds and handles the events.

use crate::builder::Joints;
use crate::event::{ContactEvent, Event, ImpactRow};
use crate::run_error::RunError;
use crate::strategy::Strategy;
use crate::world::{World, contact_force};
use glam::DVec2;
use halfgap_advance::rigid::{AdvanceError, ContactChanges, Handled, ImpactReport, RowForce};
use halfgap_advance::{Time, advance_watched};
use halfgap_collision::Collision;
use std::ops::ControlFlow;

impl World {
    /// Advances to a time [s] and reports each event in order; does nothing if the time is in the past.
    ///
    /// A stop does not change the motion: an advance in one call and in many give the same bits. An impact within
    /// time-location error before `time` may be reported by the next call instead, with its own time; one exactly at
    /// `time` may be reported by either call.
    ///
    /// # Errors
    /// [`RunError::NotATime`] for a time that is not finite. [`RunError::Astray`] if connectors have come apart, bodies
    /// overlap or the energy books do not close at that time. Another error if an event or a step cannot be simulated:
    /// the world stays at that time. Both kinds are repeated on every further attempt, except [`RunError::Crawls`]
    /// and [`RunError::TooFast`]: after these an advance over a shorter duration may go on, unless a longer one is
    /// planned ([`WorldSettings::duration`](crate::WorldSettings::duration)).
    pub fn advance_to(&mut self, time: f64, on_event: &mut dyn FnMut(&Event)) -> Result<(), RunError> {
        let outcome = self.advance_while(time, &mut |event| {
            on_event(event);
            ControlFlow::Continue(())
        });
        outcome.map(|_| ())
    }

    /// Advances like [`advance_to`](Self::advance_to), but stops after the first event for which `on_event` returns
    /// [`ControlFlow::Break`], at the time of that event, and returns that `Break`. One event may have several reports (an
    /// impact, then contacts that end and begin): those that remain are still delivered. A later call continues as if
    /// there had been no stop, and reports further events of the same time.
    ///
    /// # Errors
    /// Those of [`advance_to`](Self::advance_to).
    pub fn advance_while(
        &mut self,
        time: f64,
        on_event: &mut dyn FnMut(&Event) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, RunError> {
        self.advance_watched(time, on_event, &mut |_| ControlFlow::Continue(()))
    }

    /// Advances like [`advance_to`](Self::advance_to), but handles at most `budget` events, those included that are not
    /// reported, such as the ends of steps. Returns [`ControlFlow::Break`] if the budget was used up before `time`: the
    /// world is then at the time of its last event, and a later call continues as if there had been no stop. A page that
    /// must answer its user asks its clock between calls of some hundred events each.
    ///
    /// # Errors
    /// Those of [`advance_to`](Self::advance_to).
    pub fn advance_for(
        &mut self,
        time: f64,
        budget: u64,
        on_event: &mut dyn FnMut(&Event),
    ) -> Result<ControlFlow<()>, RunError> {
        if budget == 0 && time > self.time() {
            return Ok(ControlFlow::Break(()));
        }
        let mut left = budget;
        let mut on_each = |event: &Event| {
            on_event(event);
            ControlFlow::Continue(())
        };
        self.advance_each(time, &mut on_each, &mut |_, _| {
            left = left.saturating_sub(1);
            if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    }

    /// Advances like [`advance_while`](Self::advance_while); `on_quiet` is called with the present time [s] after each
    /// step that is no event for callers, and may stop the advance there.
    pub(crate) fn advance_watched(
        &mut self,
        time: f64,
        on_event: &mut dyn FnMut(&Event) -> ControlFlow<()>,
        on_quiet: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, RunError> {
        self.advance_each(time, on_event, &mut |now, is_quiet| {
            if is_quiet { on_quiet(now) } else { ControlFlow::Continue(()) }
        })
    }

    /// Advances like [`advance_while`](Self::advance_while); `after_each` is called after each event and its reports with
    /// the present time [s], and with true if nothing was reported. It may stop the advance there.
    fn advance_each(
        &mut self,
        time: f64,
        on_event: &mut dyn FnMut(&Event) -> ControlFlow<()>,
        after_each: &mut dyn FnMut(f64, bool) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, RunError> {
        if !time.is_finite() {
            return Err(RunError::NotATime);
        }
        if time >= self.time() {
            self.ask_guard()?;
        }
        let has_failed = self.strategy.failure().is_some();
        let until = Time::from_seconds(time);
        self.strategy.set_duration(self.monitor.duration.max(time - self.time()));
        if self.tell_start(on_event).is_break() {
            return self.conclude(Ok(ControlFlow::Break(())), self.strategy.now());
        }
        let (strategy, told, joints) = (&mut self.strategy, &mut self.told, &self.joints);
        let outcome = advance_watched(strategy, until, |strategy, handled| {
            let told = handled.map_or(ControlFlow::Continue(()), |&handled| {
                tell(told, (strategy, joints), handled, on_event)
            });
            let after = after_each(strategy.now().seconds(), handled.is_none());
            if told.is_break() { told } else { after }
        });
        let reached =
            if matches!(outcome, Ok(ControlFlow::Continue(()))) { until } else { self.strategy.now() };
        if !has_failed {
            self.tell_last_words(on_event);
        }
        self.conclude(outcome, reached)
    }

    /// Reports what happened at the start, an impact or jams, if it has not been reported.
    pub(crate) fn tell_start(
        &mut self,
        on_event: &mut dyn FnMut(&Event) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if !std::mem::take(&mut self.owes_first_report) {
            return ControlFlow::Continue(());
        }
        let mut stops = false;
        if self.strategy.counts().impacts > 0 {
            write_impact(&mut self.told, self.strategy.last_impact(), &self.joints);
            stops |= on_event(&self.told).is_break();
        }
        stops |=
            tell_oddities(self.strategy.contact_changes(), (self.strategy.now(), &self.joints), on_event);
        if stops { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// Reports the impact after which the system cannot go on, if it has come to one. Not to be called for a system
    /// that had failed before: its last impact has been reported then.
    pub(crate) fn tell_last_words(&mut self, on_event: &mut dyn FnMut(&Event) -> ControlFlow<()>) {
        if let Some(impact) = self.strategy.untold_impact() {
            write_impact(&mut self.told, impact, &self.joints);
            // The world cannot go on, whatever the caller answers.
            let _ = on_event(&self.told);
        }
    }

    /// Notes how far the system has come, and lets the monitor check it.
    pub(crate) fn conclude(
        &mut self,
        outcome: Result<ControlFlow<()>, AdvanceError>,
        reached: Time,
    ) -> Result<ControlFlow<()>, RunError> {
        self.now = self.now.max(reached);
        self.strategy.write_driven_states(self.now, &mut self.driven);
        let outcome = outcome.map_err(|error| RunError::new(error, &self.bodies, &self.joints));
        self.stand_guard(outcome)
    }
}

/// Reports an event that was handled, its impact in a reused buffer. Returns `Break` if a callback did.
pub(crate) fn tell(
    told: &mut Event,
    (strategy, joints): (&Strategy, &Joints),
    handled: Handled,
    on_event: &mut dyn FnMut(&Event) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let mut stops = false;
    if handled.impact {
        write_impact(told, strategy.last_impact(), joints);
        stops |= on_event(told).is_break();
    }
    let changes = strategy.contact_changes();
    let told_of = |row: &RowForce| contact_event(row, changes.time, joints);
    stops |= tell_oddities(changes, (changes.time, joints), on_event);
    let ends = changes.end.iter().map(|row| Event::ContactEnds(told_of(row)));
    let begins = changes.begin.iter().map(|row| Event::ContactBegins(told_of(row)));
    let turns = changes.turn.iter().map(|row| match row.friction {
        Some(friction) if friction.sticks => Event::Sticks(told_of(row)),
        _ => Event::Slips(told_of(row)),
    });
    for event in ends.chain(begins).chain(turns) {
        stops |= on_event(&event).is_break();
    }
    if stops { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

fn contact_event(row: &RowForce, time: Time, joints: &Joints) -> ContactEvent {
    ContactEvent {
        time: time.seconds(),
        contact: contact_force(row, joints),
        bouncing: row.bouncing,
        energy_change: row.jump,
    }
}

/// Reports contacts that jam, and those whose motion is not unique. True if a callback stops the advance.
fn tell_oddities(
    changes: &ContactChanges,
    (time, joints): (Time, &Joints),
    on_event: &mut dyn FnMut(&Event) -> ControlFlow<()>,
) -> bool {
    let jams = changes.jam.iter().map(|row| Event::Jams(contact_event(row, time, joints)));
    let undecided = changes.undecided.iter().map(|row| Event::Undecided(contact_event(row, time, joints)));
    jams.chain(undecided).fold(false, |stops, event| stops | on_event(&event).is_break())
}

/// Writes the report of an impact into a reused buffer, as an [`Impact`].
fn write_impact(told: &mut Event, report: &ImpactReport, joints: &Joints) {
    let Event::Impact(impact) = told else { return };
    impact.time = report.time.seconds();
    impact.energy_change = report.energy_change;
    impact.rows.clear();
    impact.rows.extend(report.rows.iter().map(|row| {
        let Collision { parties, geometry, motion, .. } = &row.collision;
        // A row without a normal is a torque, in units of an angle.
        let is_torque = geometry.normal == DVec2::ZERO;
        let lever = if is_torque { motion.kinematics.jacobian[2] } else { 1.0 };
        ImpactRow {
            primary: parties.primary.body,
            normal_body: parties.normal.body,
            connector: row.collision.connector().map(|id| joints.whole(id)),
            point: (!is_torque).then_some(geometry.point_primary),
            normal: geometry.normal,
            gap: geometry.distance / lever,
            velocity_before: row.rate_before / lever,
            velocity_after: row.rate_after / lever,
            impulse: row.impulse * lever,
        }
    }));
    impact.states.clone_from(&report.states);
}
