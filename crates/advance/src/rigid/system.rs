//! Rigid bodies as an event-driven system.
//!
//! Kinds of events: a body leaves its box, a pair's search goes on, two bodies come into contact, a group's
//! segment ends. Between events nothing is computed; an event touches only its bodies and what is near them.

use super::error::AdvanceError;
use super::event::cause::EventWork;
use super::event::connectors::Connectors;
use super::event::groups::Groups;
use super::event::impacts::ImpactReport;
use super::event::ticks::Ticks;
use super::laws::Laws;
use super::ledger::Ledger;
use super::limits::memory::Memory;
use super::motion::flyer::Flyer;
use super::motion::law::{ForceLaw, Snapshot};
use super::parts::RigidParts;
use super::report::Told;
use super::search::neighbourhood::Neighbourhood;
use super::search::pairs::{PairId, Pairs, Prediction};
use super::sources::Source;
use super::step::brief::Steppers;
use super::step::dynamics::{ExtraAcceleration, Stage};
use super::step::rows::Mechanism;
use super::step::segment::StepControl;
use crate::ode::Method;
use crate::queue::{EventQueue, SourceId};
use crate::system::EventDriven;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, ConnectorId, Moving, RailHint, SearchSettings, Tolerances};
use halfgap_contact::{ImpactLaw, ImpactOrder};
use std::sync::Arc;

/// How contacts are judged, impacts resolved, and motions integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidSettings {
    /// The thresholds of touching.
    pub tolerances: Tolerances,
    /// The impact law.
    pub law: ImpactLaw,
    /// The order in which serial laws take the rows.
    pub order: ImpactOrder,
    /// False if bodies pass through each other.
    pub collisions: bool,
    /// Limits of the search for contacts.
    pub search: SearchSettings,
    /// The integrator of bodies that are not in free flight.
    pub method: Method,
    /// How its steps are chosen.
    pub steps: StepControl,
    /// The ends of steps are moved onto the held rows.
    pub projection: bool,
    /// Accelerations against the errors of held rows, if any.
    pub extra: Option<ExtraAcceleration>,
    /// Contacts carry impulses only, in steps of this length [s]; connectors carry forces all the same.
    pub impulse_step: Option<f64>,
    /// Velocities of connectors are made to fit at the ends of steps, where `projection` does not do so.
    pub joint_small_impacts: bool,
    /// Rates [m/s] up to which a row neither closes nor opens: more than rounding leaves of a solve, but far
    /// less than any approach that counts. Two rows that oppose each other at a small angle stop what slides
    /// between them, if both are taken to rest.
    pub rest_speed: f64,
    /// Time [s] that forces take to make `velocity_tol`, or to cross the target zone: more events than it can
    /// hold are ended.
    pub resolution_time: f64,
}

/// What was done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// Segments started by movable bodies.
    pub segments: u64,
    /// Events handled, of all kinds.
    pub events: u64,
    /// Impacts resolved.
    pub impacts: u64,
    /// Segments cut short by an event.
    pub backups: u64,
    /// Complementarity problems solved, and solves for the forces of held rows.
    pub contact_solves: u64,
    /// Evaluations of forces by the integrator.
    pub evaluations: u64,
    /// Storms of impacts that were ended without elasticity.
    pub storms: u64,
    /// Smallest gap [m] seen.
    pub smallest_gap: Option<f64>,
    /// Largest error of a connector's gap [m] seen.
    pub largest_connector_error: Option<f64>,
    /// Largest kinetic energy [J] that bodies with common steps had at the end of one, or those of an impact before it.
    pub largest_kinetic_energy: f64,
}

impl Counts {
    pub(crate) fn note_gap(&mut self, gap: f64) {
        self.smallest_gap = Some(self.smallest_gap.map_or(gap, |least| least.min(gap)));
    }

    pub(crate) fn note_connector_error(&mut self, error: f64) {
        self.largest_connector_error =
            Some(self.largest_connector_error.map_or(error, |most| most.max(error)));
    }
}

/// An event that was handled: an impact, or contacts that begin or end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handled {
    /// When.
    pub time: Time,
    /// True for an impact, of which [`RigidSystem::last_impact`] tells; [`RigidSystem::contact_changes`]
    /// tells of the rest.
    pub impact: bool,
}

/// Rigid bodies that fly, collide, rest on each other, and hang together.
#[derive(Clone, Debug)]
pub struct RigidSystem {
    pub(crate) settings: RigidSettings,
    pub(crate) flyers: Vec<Flyer>,
    pub(crate) connectors: Connectors,
    pub(crate) laws: Laws,
    /// Nothing accelerates bodies but contacts and connectors.
    pub(crate) is_forceless: bool,
    /// When the system started.
    pub(crate) start: Time,
    /// Time of the last event handled.
    pub(crate) now: Time,
    pub(crate) queue: EventQueue,
    pub(crate) pairs: Pairs,
    pub(crate) search: Neighbourhood,
    pub(crate) groups: Groups,
    /// Bodies of the group that was extended last.
    pub(crate) extended: Vec<BodyId>,
    pub(crate) stage: Stage,
    pub(crate) steppers: Steppers,
    pub(crate) error_scales: Vec<f64>,
    pub(crate) limits: Memory,
    pub(crate) ticks: Ticks,
    /// Taken out while an event is handled.
    pub(crate) work: Option<Box<EventWork>>,
    /// Buffer: pairs of which an event changes what is known.
    pub(crate) touched: Vec<PairId>,
    pub(crate) counts: Counts,
    pub(crate) ledger: Ledger,
    pub(crate) told: Told,
}

impl RigidSystem {
    /// The system of the given parts at a time. That bodies do not overlap, and connectors hold what they tie
    /// together, is for the caller to see to.
    ///
    /// # Errors
    /// Parts or settings out of range. The forces at the start cannot be found.
    pub fn new(parts: RigidParts, settings: RigidSettings, start: Time) -> Result<Self, AdvanceError> {
        parts.check(&settings, start)?;
        let RigidParts { bodies, connectors, laws, excluded } = parts;
        let flyers: Vec<Flyer> =
            bodies.into_iter().map(|(body, law, state)| Flyer::new(body, law, state, start)).collect();
        let movings: Vec<Moving> = flyers.iter().map(|flyer| flyer.moving_at(start)).collect();
        let snapshot = Snapshot::new(start.seconds(), &movings);
        let count = flyers.len();
        let movable = flyers.iter().filter(|flyer| !flyer.body().is_fixed()).count();
        let mut system = Self {
            settings,
            is_forceless: laws.is_empty()
                && flyers.iter().all(|flyer| flyer.law().acceleration == DVec2::ZERO),
            ledger: Ledger { laws: vec![0.0; laws.len()], ..Ledger::default() },
            laws: Laws::new(laws, count, &snapshot),
            connectors: Connectors::new(connectors, count),
            start,
            now: start,
            queue: EventQueue::new(),
            pairs: Pairs::new(flyers.iter().map(|flyer| flyer.body().is_fixed()).collect()),
            search: Neighbourhood::new(&flyers, excluded, &settings),
            flyers,
            groups: Groups::new(count),
            extended: Vec::new(),
            stage: Stage::new(movings),
            steppers: Steppers::new(settings.method),
            error_scales: Vec::new(),
            limits: Memory::new(count),
            ticks: Ticks::default(),
            work: None,
            touched: Vec::new(),
            counts: Counts { segments: movable as u64, ..Counts::default() },
            told: Told::default(),
        };
        if settings.collisions {
            system.set_up_boxes();
        }
        system.establish()?;
        system.complete_dense();
        Ok(system)
    }

    /// How many bodies there are.
    #[must_use]
    pub fn body_count(&self) -> usize {
        self.flyers.len()
    }

    /// A body with its segment.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    pub fn flyer(&self, body: BodyId) -> &Flyer {
        &self.flyers[body.index()]
    }

    /// What was done so far.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let (evaluations, solves) = (self.stage.evaluations, self.stage.solves);
        Counts { evaluations, contact_solves: self.counts.contact_solves + solves, ..self.counts }
    }

    /// How contacts are judged.
    #[must_use]
    pub fn settings(&self) -> &RigidSettings {
        &self.settings
    }

    /// The last impact.
    #[must_use]
    pub fn last_impact(&self) -> &ImpactReport {
        &self.told.last_impact
    }

    /// The impact of the event that could not be handled, if there was one before that was found out: it is
    /// in the ledger.
    #[must_use]
    pub fn untold_impact(&self) -> Option<&ImpactReport> {
        (self.told.failure.is_some() && self.told.has_hit).then_some(&self.told.last_impact)
    }

    /// Why the last event could not be handled: there is no going on from it.
    #[must_use]
    pub fn failure(&self) -> Option<&AdvanceError> {
        self.told.failure.as_ref()
    }

    /// Time of the last event handled.
    #[must_use]
    pub fn now(&self) -> Time {
        self.now
    }

    /// False for a force law that has no potential, whose work is in the ledger.
    ///
    /// # Panics
    /// If there is no such law.
    #[must_use]
    pub fn has_potential(&self, law: usize) -> bool {
        self.laws.has_potential[law]
    }

    /// The force laws.
    #[must_use]
    pub fn laws(&self) -> &[Arc<dyn ForceLaw>] {
        &self.laws.all
    }

    /// Where on its path the point of a rail or of a rail's stop is looked for at a time, not before that of the last event;
    /// `None` for other connectors.
    #[must_use]
    pub fn rail_hint(&self, connector: ConnectorId, time: Time) -> Option<RailHint> {
        self.hint_at(connector, 0, time)
    }

    /// Pairs of bodies that pass through each other, the lesser id first, sorted.
    #[must_use]
    pub fn excluded(&self) -> &[(BodyId, BodyId)] {
        &self.search.excluded
    }

    /// A body whose segment is cut short, which counts.
    pub(crate) fn interrupt(&mut self, body: BodyId) -> &mut Flyer {
        self.counts.segments += 1;
        self.counts.backups += 1;
        &mut self.flyers[body.index()]
    }

    pub(crate) fn bodies(&self) -> impl Iterator<Item = BodyId> + use<> {
        (0..u32::try_from(self.flyers.len()).unwrap_or(u32::MAX)).map(BodyId)
    }

    pub(crate) fn is_movable(&self, body: BodyId) -> bool {
        !body.is_world() && !self.pairs.is_fixed(body)
    }

    pub(crate) fn mechanism(&self) -> Mechanism<'_> {
        Mechanism {
            flyers: &self.flyers,
            connectors: &self.connectors.all,
            tolerances: &self.settings.tolerances,
        }
    }

    /// Runs an event at a time, and tells whether it was an impact; `None` if callers need not know of it.
    pub(crate) fn happen(
        &mut self,
        time: Time,
        act: impl FnOnce(&mut Self) -> Result<(), AdvanceError>,
    ) -> Result<Option<Handled>, AdvanceError> {
        if let Some(failure) = &self.told.failure {
            return Err(failure.clone());
        }
        self.counts.events += 1;
        self.told.has_hit = false;
        self.now = time;
        self.told.changes.clear(time);
        let outcome = act(self);
        self.told.changes.time = self.now;
        if outcome.is_ok() && !self.told.has_hit && self.told.changes.is_empty() {
            let Some(crawls) = self.limits.crawls.take() else { return Ok(None) };
            self.complete_dense();
            return Err(crawls);
        }
        self.complete_dense();
        self.told.failure = outcome.as_ref().err().cloned();
        outcome.map(|()| Some(Handled { time: self.now, impact: self.told.has_hit }))
    }

    fn handle(&mut self, source: SourceId) -> Result<(), AdvanceError> {
        match self.source(source) {
            Source::Box(body) => self.leave_box(body),
            Source::Group(leader) => return self.handle_group(leader),
            Source::Connector(id) if self.rope_fires(id) => return self.handle_rope(id),
            Source::Connector(_) => {}
            Source::Tick => return self.handle_tick(),
            Source::Pair(pair) => match self.pairs.get(pair).prediction {
                Prediction::Contact(features) => return self.handle_contact(pair, features),
                _ => self.predict(pair),
            },
        }
        Ok(())
    }
}

impl EventDriven for RigidSystem {
    type Report = Handled;
    type Error = AdvanceError;

    fn next_event(&self) -> Option<Time> {
        if self.told.failure.is_some() { Some(self.now) } else { self.queue.first().map(|entry| entry.time) }
    }

    /// Handles the earliest event. What could not be handled leaves bodies that nothing holds: there is no
    /// going on from it, and it is told again whenever that is tried.
    fn handle_next(&mut self) -> Result<Option<Handled>, AdvanceError> {
        if let Some(failure) = &self.told.failure {
            return Err(failure.clone());
        }
        let Some(event) = self.queue.first() else { return Ok(None) };
        self.happen(event.time, |system| system.handle(event.source))
    }

    fn arrive(&mut self) {
        self.complete_dense();
    }
}
