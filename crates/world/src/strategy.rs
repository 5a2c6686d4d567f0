//! The strategies by which a world advances, behind one set of questions.
//!
//! *Invariant*: all that a world asks of the system below it is a method of [`Strategy`], and each method matches all
//! strategies: a further one does not compile until it answers everything.

use crate::force::ForceLaw;
use halfgap_advance::rigid::{
    AdvanceError, ContactChanges, Counts, Handled, ImpactReport, Ledger, RemedyCounts, RigidParts,
    RigidSettings, RigidSystem, RowForce, VelocityChange,
};
#[cfg(feature = "save")]
use halfgap_advance::rigid::{PartsError, SavedSystem};
#[cfg(feature = "save")]
use halfgap_advance::stepping::SavedStepping;
use halfgap_advance::stepping::{SteppingSettings, SteppingSystem};
use halfgap_advance::{EventDriven, Time};
#[cfg(feature = "save")]
use halfgap_collision::Connector;
use halfgap_collision::{Body, BodyId, BodyState, ConnectorId, RailHint};
use std::sync::Arc;

/// The system of a world, by the strategy that advances it.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize))]
pub(crate) enum Strategy {
    /// Each event at its own time.
    Events(Box<RigidSystem>),
    /// Steps.
    Steps(Box<SteppingSystem>),
}

impl Strategy {
    /// Makes the system of parts that fit together, to be advanced from event to event.
    pub(crate) fn events(
        parts: RigidParts,
        settings: RigidSettings,
        start: Time,
    ) -> Result<Self, AdvanceError> {
        RigidSystem::new(parts, settings, start).map(|system| Self::Events(Box::new(system)))
    }

    /// Makes the system of parts that fit together, to be advanced by steps.
    pub(crate) fn steps(
        parts: RigidParts,
        settings: SteppingSettings,
        start: Time,
    ) -> Result<Self, AdvanceError> {
        SteppingSystem::new(parts, settings, start).map(|system| Self::Steps(Box::new(system)))
    }

    /// The connectors.
    #[cfg(feature = "save")]
    pub(crate) fn connectors(&self) -> &[Connector] {
        match self {
            Self::Events(system) => system.connectors(),
            Self::Steps(system) => system.connectors(),
        }
    }

    /// Time of the last event handled.
    #[inline]
    pub(crate) fn now(&self) -> Time {
        match self {
            Self::Events(system) => system.now(),
            Self::Steps(system) => system.now(),
        }
    }

    /// A body; panics if there is no such body.
    #[inline]
    pub(crate) fn body(&self, body: BodyId) -> &Body {
        match self {
            Self::Events(system) => system.trajectory(body).body(),
            Self::Steps(system) => system.body(body),
        }
    }

    /// State of a body at a time from the last event to the next; panics if there is no such body.
    #[inline]
    pub(crate) fn state_at(&self, body: BodyId, time: Time) -> BodyState {
        match self {
            Self::Events(system) => system.trajectory(body).state_at(time),
            Self::Steps(system) => system.state_at(body, time),
        }
    }

    /// Writes the states of what drives move, where they are exacter than [`state_at`](Self::state_at), in ascending
    /// order of bodies, over `states`.
    pub(crate) fn write_driven_states(&self, time: Time, states: &mut Vec<(BodyId, BodyState)>) {
        match self {
            Self::Events(system) => system.write_driven_states(time, states),
            Self::Steps(_) => states.clear(),
        }
    }

    /// Place on its path near which the point of a rail or of its stop is sought; `None` for other connectors.
    pub(crate) fn rail_hint(&self, connector: ConnectorId, time: Time) -> Option<RailHint> {
        match self {
            Self::Events(system) => system.rail_hint(connector, time),
            Self::Steps(system) => system.rail_hint(connector),
        }
    }

    /// The forces of all contacts and connectors at a time from the last event to the next.
    pub(crate) fn row_forces(&self, time: Time) -> Vec<RowForce> {
        match self {
            Self::Events(system) => system.row_forces(time),
            Self::Steps(system) => system.row_forces(),
        }
    }

    /// Writes the energy ledger of a time from the last event to the next over `ledger`, whose buffer is used again.
    pub(crate) fn write_ledger(&self, time: Time, ledger: &mut Ledger) {
        match self {
            Self::Events(system) => system.write_ledger(time, ledger),
            Self::Steps(system) => system.write_ledger(time, ledger),
        }
    }

    /// Counts and extremes since the start.
    #[inline]
    pub(crate) fn counts(&self) -> Counts {
        match self {
            Self::Events(system) => system.counts(),
            Self::Steps(system) => system.counts(),
        }
    }

    /// How often each remedy has acted since the start.
    pub(crate) fn remedies(&self) -> RemedyCounts {
        match self {
            Self::Events(system) => system.remedies(),
            Self::Steps(_) => RemedyCounts::default(),
        }
    }

    /// The settings with which the system was made.
    #[inline]
    pub(crate) fn settings(&self) -> &RigidSettings {
        match self {
            Self::Events(system) => system.settings(),
            Self::Steps(system) => &system.settings().rigid,
        }
    }

    /// Pairs of bodies that pass through each other.
    pub(crate) fn excluded(&self) -> &[(BodyId, BodyId)] {
        match self {
            Self::Events(system) => system.excluded(),
            Self::Steps(system) => system.excluded(),
        }
    }

    /// Distance [m] by which a pair of bodies may sink below the target gap.
    pub(crate) fn room_to_sink(&self, bodies: [BodyId; 2]) -> f64 {
        match self {
            Self::Events(system) => system.room_to_sink(bodies),
            Self::Steps(system) => system.room_to_sink(bodies),
        }
    }

    /// True if the world advances by steps.
    pub(crate) fn is_stepping(&self) -> bool {
        match self {
            Self::Events(_) => false,
            Self::Steps(_) => true,
        }
    }

    /// Sets the total time [s] to be simulated, against which steps are judged hopelessly short.
    #[inline]
    pub(crate) fn set_duration(&mut self, duration: f64) {
        match self {
            Self::Events(system) => system.set_duration(duration),
            Self::Steps(_) => {}
        }
    }
}

/// Force laws and velocities, which the caller changes.
impl Strategy {
    /// Force laws in the order of their indices, those that were removed included.
    pub(crate) fn force_laws(&self) -> &[Arc<dyn ForceLaw>] {
        match self {
            Self::Events(system) => system.force_laws(),
            Self::Steps(system) => system.force_laws(),
        }
    }

    /// True if the force law at an index acts; false if it was removed or is not there.
    pub(crate) fn is_acting(&self, law: usize) -> bool {
        match self {
            Self::Events(system) => system.is_acting(law),
            Self::Steps(system) => system.is_acting(law),
        }
    }

    /// True if the force law at an index has a potential; panics if there is no such law.
    pub(crate) fn has_potential(&self, law: usize) -> bool {
        match self {
            Self::Events(system) => system.has_potential(law),
            Self::Steps(system) => system.has_potential(law),
        }
    }

    /// Adds a force law that acts from a time on.
    pub(crate) fn add_force_law(
        &mut self,
        time: Time,
        law: Arc<dyn ForceLaw>,
    ) -> Result<Option<Handled>, AdvanceError> {
        match self {
            Self::Events(system) => system.add_force_law(time, law),
            Self::Steps(system) => system.add_force_law(time, law),
        }
    }

    /// Removes the force law at an index from a time on.
    pub(crate) fn remove_force_law(
        &mut self,
        time: Time,
        law: usize,
    ) -> Result<Option<Handled>, AdvanceError> {
        match self {
            Self::Events(system) => system.remove_force_law(time, law),
            Self::Steps(system) => system.remove_force_law(time, law),
        }
    }

    /// Changes velocities of bodies at a time, all at once.
    pub(crate) fn intervene(
        &mut self,
        time: Time,
        changes: &[VelocityChange],
    ) -> Result<Option<Handled>, AdvanceError> {
        match self {
            Self::Events(system) => system.intervene(time, changes),
            Self::Steps(system) => system.intervene(time, changes),
        }
    }
}

/// What the last event was.
impl Strategy {
    /// Report of the last impact; empty if there was none.
    #[inline]
    pub(crate) fn last_impact(&self) -> &ImpactReport {
        match self {
            Self::Events(system) => system.last_impact(),
            Self::Steps(system) => system.last_impact(),
        }
    }

    /// The impact of the event that then failed, if it got that far.
    pub(crate) fn untold_impact(&self) -> Option<&ImpactReport> {
        match self {
            Self::Events(system) => system.untold_impact(),
            Self::Steps(_) => None,
        }
    }

    /// Contacts that began or ended in the last event.
    #[inline]
    pub(crate) fn contact_changes(&self) -> &ContactChanges {
        match self {
            Self::Events(system) => system.contact_changes(),
            Self::Steps(system) => system.contact_changes(),
        }
    }

    /// Error of the last event, if it could not be handled: the system cannot go on from it.
    #[inline]
    pub(crate) fn failure(&self) -> Option<&AdvanceError> {
        match self {
            Self::Events(system) => system.failure(),
            Self::Steps(_) => None,
        }
    }
}

/// The advance from one event to the next.
impl EventDriven for Strategy {
    type Report = Handled;
    type Error = AdvanceError;

    #[inline]
    fn next_event(&self) -> Option<Time> {
        match self {
            Self::Events(system) => system.next_event(),
            Self::Steps(system) => system.next_event(),
        }
    }

    #[inline]
    fn handle_next(&mut self) -> Result<Option<Handled>, AdvanceError> {
        match self {
            Self::Events(system) => system.handle_next(),
            Self::Steps(system) => system.handle_next(),
        }
    }

    #[inline]
    fn arrive(&mut self) {
        match self {
            Self::Events(system) => system.arrive(),
            Self::Steps(system) => system.arrive(),
        }
    }
}

/// A system that was saved, without its force laws: what serialising a [`Strategy`] leaves.
#[cfg(feature = "save")]
#[derive(serde::Deserialize)]
pub(crate) enum SavedStrategy {
    Events(Box<SavedSystem>),
    Steps(Box<SavedStepping>),
}

#[cfg(feature = "save")]
impl SavedStrategy {
    /// The system, given the force laws that it had.
    pub(crate) fn with_force_laws(self, force_laws: Vec<Arc<dyn ForceLaw>>) -> Result<Strategy, PartsError> {
        match self {
            Self::Events(saved) => {
                saved.with_force_laws(force_laws).map(|system| Strategy::Events(Box::new(system)))
            }
            Self::Steps(saved) => {
                saved.with_force_laws(force_laws).map(|system| Strategy::Steps(Box::new(system)))
            }
        }
    }
}
