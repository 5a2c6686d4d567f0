//! Rigid bodies as an event-driven system: what callers may ask and do.
//!
//! Kinds of events: a body leaves its box, a pair's search goes on or finds a contact, a rope goes taut, a group's
//! segment ends, sunk contacts are put back. Between events nothing is computed; an event touches only its bodies and
//! their neighbours.

use crate::rigid::bodies::force_law::ForceLaw;
use crate::rigid::bodies::trajectory::Trajectory;
use crate::rigid::books::counts::Counts;
use crate::rigid::books::driven::write_driven_states;
use crate::rigid::books::forces::row_forces;
use crate::rigid::books::ledger::Ledger;
use crate::rigid::books::report::{ContactChanges, Handled, ImpactReport, RowForce};
use crate::rigid::books::works::write_ledger;
use crate::rigid::due::events::establish;
use crate::rigid::due::handling::{finish, handle, happen};
use crate::rigid::error::AdvanceError;
use crate::rigid::event::intervention::{
    ForceLawChange, VelocityChange, change_force_laws, change_velocities, check_finite,
};
use crate::rigid::event::rooms::{Rooms, with_work};
use crate::rigid::event::work::EventWork;
use crate::rigid::parts::{RigidParts, check_bodies_of_force_law};
use crate::rigid::region::cause::Cause;
use crate::rigid::remedies::RemedyCounts;
use crate::rigid::settings::RigidSettings;
use crate::rigid::shares::NEGLIGIBLE;
use crate::rigid::sinking::depth::room_to_sink;
use crate::rigid::stepping::ending::work_within;
use crate::system::EventDriven;
use crate::time::Time;
use halfgap_collision::{BodyId, BodyState, Connector, ConnectorId, RailHint};
use std::sync::Arc;

/// System of rigid bodies that fly, collide, rest on each other, and are tied by connectors.
///
/// With the feature `save` it can be serialised without its force laws, and read back as a [`SavedSystem`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize))]
pub struct RigidSystem {
    rooms: Rooms,
}

impl RigidSystem {
    /// Makes the system of the given parts at a time. The caller must see to it that bodies do not overlap and that
    /// connectors fit the states: neither is checked.
    ///
    /// # Errors
    /// Parts or settings out of range, or forces at the start that cannot be found.
    pub fn new(parts: RigidParts, settings: RigidSettings, start: Time) -> Result<Self, AdvanceError> {
        parts.check(&settings, start)?;
        let mut rooms = Rooms::new(parts, settings, start);
        if settings.collisions {
            rooms.searching().set_up_boxes();
        }
        establish(&mut rooms)?;
        finish(&mut rooms);
        Ok(Self { rooms })
    }

    /// The system of rooms that were saved.
    #[cfg(feature = "save")]
    pub(super) fn of_rooms(rooms: Rooms) -> Self {
        Self { rooms }
    }

    /// The rooms, for tests of what happens in them.
    #[cfg(test)]
    pub(crate) fn into_rooms(self) -> Rooms {
        self.rooms
    }

    /// Number of bodies.
    #[must_use]
    #[inline]
    pub fn body_count(&self) -> usize {
        self.rooms.assembly.body_count()
    }

    /// Returns a body with its present segment.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    #[inline]
    pub fn trajectory(&self, body: BodyId) -> &Trajectory {
        self.rooms.assembly.trajectory(body)
    }

    /// Counts and extremes of the system since its start.
    #[must_use]
    #[inline]
    pub fn counts(&self) -> Counts {
        let (stage, counts) = (self.rooms.groups.stage(), self.rooms.books.counts());
        let contact_solves = counts.contact_solves + stage.solves();
        Counts { evaluations: stage.evaluations(), contact_solves, ..counts }
    }

    /// How often each remedy has acted since the start.
    #[must_use]
    pub fn remedies(&self) -> RemedyCounts {
        self.rooms.assembly.remedies().counts()
    }

    /// The settings of the system.
    #[must_use]
    #[inline]
    pub fn settings(&self) -> &RigidSettings {
        self.rooms.assembly.settings()
    }

    /// Report of the last impact; empty if there was none.
    #[must_use]
    #[inline]
    pub fn last_impact(&self) -> &ImpactReport {
        self.rooms.books.told().last_impact()
    }

    /// The impact of the event that then failed, if it got that far: booked in the ledger, not reported.
    #[must_use]
    #[inline]
    pub fn untold_impact(&self) -> Option<&ImpactReport> {
        let told = self.rooms.books.told();
        (told.failure().is_some() && told.has_hit()).then_some(told.last_impact())
    }

    /// Unilateral rows whose holding began or ended in the last event.
    #[must_use]
    #[inline]
    pub fn contact_changes(&self) -> &ContactChanges {
        self.rooms.books.told().changes()
    }

    /// Error of the last event, if it could not be handled: the system cannot go on from it.
    #[must_use]
    #[inline]
    pub fn failure(&self) -> Option<&AdvanceError> {
        self.rooms.books.told().failure().as_ref()
    }

    /// Time of the last event handled.
    #[must_use]
    #[inline]
    pub fn now(&self) -> Time {
        self.rooms.assembly.now()
    }

    /// True if the force law at an index has a potential; the work of a law without one is in the ledger.
    ///
    /// # Panics
    /// If there is no such law.
    #[must_use]
    #[inline]
    pub fn has_potential(&self, law: usize) -> bool {
        self.rooms.assembly.force_laws().has_potential[law]
    }

    /// Force laws, in the order of their indices, those that were removed included.
    #[must_use]
    pub fn force_laws(&self) -> &[Arc<dyn ForceLaw>] {
        &self.rooms.assembly.force_laws().all
    }

    /// Connectors, in the order of their ids.
    #[must_use]
    #[inline]
    pub fn connectors(&self) -> &[Connector] {
        self.rooms.connectors.all()
    }

    /// Place on its path near which the point of a rail or of a rail's stop is sought at a time, which must not be
    /// before the last event; `None` for other connectors.
    #[must_use]
    #[inline]
    pub fn rail_hint(&self, connector: ConnectorId, time: Time) -> Option<RailHint> {
        self.rooms.connectors.hint_at(&self.rooms.assembly, connector, 0, time)
    }

    /// Pairs of bodies that never collide with each other, the lesser id first, sorted.
    #[must_use]
    #[inline]
    pub fn excluded(&self) -> &[(BodyId, BodyId)] {
        self.rooms.search.excluded()
    }

    /// Depth [m] by which a pair of bodies may sink below the target gap until it is put back: where contacts
    /// carry impulses only, and in a step of their region.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    #[inline]
    pub fn room_to_sink(&self, bodies: [BodyId; 2]) -> f64 {
        let assembly = &self.rooms.assembly;
        let reach = bodies.map(|body| assembly.trajectory(body).reach());
        let in_step = if assembly.share_step(bodies) { NEGLIGIBLE * reach[0].min(reach[1]) } else { 0.0 };
        room_to_sink(assembly, bodies) + in_step
    }

    /// Evaluates the forces of all active rows at a time within the present segments. Allocates.
    #[must_use]
    pub fn row_forces(&self, time: Time) -> Vec<RowForce> {
        let Rooms { assembly, connectors, groups, books, .. } = &self.rooms;
        row_forces(assembly, connectors, groups, books, time)
    }

    /// Writes the states at a time within the present segments of all bodies that step together with one that a drive
    /// moves, over `states`, in ascending order of bodies. They are exactly where drives move them, which
    /// [`Trajectory::state_at`] is only up to the error of dense output. Allocates if there are any.
    pub fn write_driven_states(&self, time: Time, states: &mut Vec<(BodyId, BodyState)>) {
        let Rooms { assembly, connectors, groups, .. } = &self.rooms;
        write_driven_states(assembly, connectors, groups, time, states);
    }

    /// Energy ledger at a time within the present segments.
    #[must_use]
    pub fn ledger_at(&self, time: Time) -> Ledger {
        let mut ledger = Ledger::default();
        self.write_ledger(time, &mut ledger);
        ledger
    }

    /// Writes the energy ledger at a time within the present segments over `ledger`, whose buffer is used again.
    pub fn write_ledger(&self, time: Time, ledger: &mut Ledger) {
        let Rooms { assembly, groups, books, zeno, .. } = &self.rooms;
        write_ledger(assembly, groups, books, time, ledger);
        ledger.steps -=
            zeno.stepped().iter().map(|stepped| work_within(assembly, stepped, time)).sum::<f64>();
    }

    /// Sets the total time [s] to be simulated; without it [`AdvanceError::Crawls`] and [`AdvanceError::TooFast`] are
    /// never returned. These errors leave the system valid: with a lesser duration set, it can be advanced further.
    #[inline]
    pub fn set_duration(&mut self, duration: f64) {
        self.rooms.zeno.set_duration(duration);
    }

    /// Changes velocities of bodies at a time, all at once: connectors and contacts against which they move then
    /// respond by the impact law. Handle all earlier events first; a time before that of the last event counts as that.
    /// The change of energy is in the ledger's `interventions`. Returns the report, or `None` if nothing is to be
    /// reported.
    ///
    /// # Errors
    /// A time or a change that is not finite: nothing is done. An impact, or forces after it, that cannot be found: the
    /// system cannot go on from it.
    ///
    /// # Panics
    /// If there is no such body.
    pub fn intervene(
        &mut self,
        time: Time,
        changes: &[VelocityChange],
    ) -> Result<Option<Handled>, AdvanceError> {
        check_finite(time, changes)?;
        self.interrupt(time, |rooms, work| change_velocities(rooms, work, changes))
    }

    /// Adds a force law that acts from a time on. Its index is that of the last of [`laws`](Self::laws); its potential
    /// at that time is in the ledger's `interventions`. Handle all earlier events first; a time before that of the last
    /// event counts as that. Tolerances and steps keep the scales of the system as it was made. Returns the report, or
    /// `None` if nothing is to be reported.
    ///
    /// # Errors
    /// A time that is not finite, or a law that names a body that is not there: nothing is done. An impact, or forces
    /// after it, that cannot be found: the system cannot go on from it.
    pub fn add_force_law(
        &mut self,
        time: Time,
        law: Arc<dyn ForceLaw>,
    ) -> Result<Option<Handled>, AdvanceError> {
        check_finite(time, &[])?;
        check_bodies_of_force_law(self.force_laws().len(), law.as_ref(), self.body_count())?;
        self.interrupt(time, |rooms, work| change_force_laws(rooms, work, &ForceLawChange::Add(law)))
    }

    /// Removes the force law at an index from a time on: it keeps its index, and its work in the ledger. The loss of its
    /// potential is in the ledger's `interventions`. Does nothing if the law does not act; else as
    /// [`add_law`](Self::add_law).
    ///
    /// # Errors
    /// A time that is not finite: nothing is done. An impact, or forces after it, that cannot be found: the system
    /// cannot go on from it.
    pub fn remove_force_law(&mut self, time: Time, law: usize) -> Result<Option<Handled>, AdvanceError> {
        check_finite(time, &[])?;
        if !self.is_acting(law) {
            return Ok(None);
        }
        self.interrupt(time, |rooms, work| change_force_laws(rooms, work, &ForceLawChange::Remove(law)))
    }

    /// True if the force law at an index acts; false if it was removed or is not there.
    #[must_use]
    pub fn is_acting(&self, law: usize) -> bool {
        self.rooms.assembly.force_laws().is_on(law)
    }

    /// Lets an event of the caller's happen at a time, or at that of the last event if that is later.
    fn interrupt(
        &mut self,
        time: Time,
        act: impl FnOnce(&mut Rooms, &mut EventWork) -> Result<(), AdvanceError>,
    ) -> Result<Option<Handled>, AdvanceError> {
        let rooms = &mut self.rooms;
        let outcome =
            happen(rooms, time.max(rooms.assembly.now()), |rooms| with_work(rooms, Cause::Other, act));
        finish(rooms);
        outcome
    }
}

impl EventDriven for RigidSystem {
    type Report = Handled;
    type Error = AdvanceError;

    fn next_event(&self) -> Option<Time> {
        if self.failure().is_some() {
            Some(self.now())
        } else {
            self.rooms.agenda.first().map(|(time, _)| time)
        }
    }

    /// Handles the earliest event. One that cannot be handled leaves bodies that nothing holds: the system cannot go on
    /// from it, and each further call returns the same error.
    fn handle_next(&mut self) -> Result<Option<Handled>, AdvanceError> {
        if let Some(failure) = self.failure() {
            return Err(failure.clone());
        }
        let Some((time, source)) = self.rooms.agenda.first() else { return Ok(None) };
        happen(&mut self.rooms, time, |rooms| handle(rooms, source))
    }

    fn arrive(&mut self) {
        finish(&mut self.rooms);
    }
}
