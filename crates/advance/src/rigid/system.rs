//! Rigid bodies as an event-driven system.
//!
//! Kinds of events: a body leaves its box, a pair's search goes on or finds a contact, a rope goes taut, a group's
//! segment ends, sunk contacts are put back. Between events nothing is computed; an event touches only its bodies and
//! their neighbours.

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
use super::parts::{BodyPart, RigidParts};
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

/// Settings of a system: how contacts are judged, impacts resolved, and motions integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidSettings {
    /// Thresholds of touching.
    pub tolerances: Tolerances,
    /// Impact law.
    pub law: ImpactLaw,
    /// Order in which serial impact laws take the rows.
    pub order: ImpactOrder,
    /// True if bodies collide; false if they pass through each other.
    pub collisions: bool,
    /// Limits of the search for contacts.
    pub search: SearchSettings,
    /// Integrator of bodies that are not in free flight.
    pub method: Method,
    /// Choice of the integrator's steps.
    pub steps: StepControl,
    /// True if the ends of steps are moved onto the held rows, in position and velocity.
    pub projection: bool,
    /// Accelerations against the errors of held rows; `None` for none.
    pub extra: Option<ExtraAcceleration>,
    /// Time [s] after which sunk contacts are put back, if contacts carry impulses only; `None` if they carry forces.
    /// Connectors carry forces either way.
    pub impulse_step: Option<f64>,
    /// True if the velocities of connectors are made to fit at the ends of steps where `projection` is false.
    pub joint_small_impacts: bool,
    /// Rows with |rate| up to this [m/s] are at rest. Must exceed the rounding of a solve, but lie far below any
    /// approach speed that counts: two rows that oppose each other at a small angle stop a body that slides between
    /// them, if both are taken to rest.
    pub rest_speed: f64,
    /// Time [s] in which forces produce `velocity_tol`, or move a body through half of the target zone, whichever is
    /// longer. Bodies with more events than allowed within it are stopped without elasticity (a storm).
    pub resolution_time: f64,
}

/// Counts and extremes of a system since its start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// Segments started: flights of bodies, and steps of groups.
    pub segments: u64,
    /// Events handled, of all kinds.
    pub events: u64,
    /// Impacts resolved.
    pub impacts: u64,
    /// Times that an event cut the motion of a body short, in flight or in a group.
    pub backups: u64,
    /// Complementarity problems solved, and solves for the forces of held rows.
    pub contact_solves: u64,
    /// Evaluations of forces by the integrator.
    pub evaluations: u64,
    /// Storms of impacts that were ended without elasticity.
    pub storms: u64,
    /// Smallest gap [m] seen, negative for overlap; `None` if none was measured.
    pub smallest_gap: Option<f64>,
    /// Largest error of a connector's gap [m] seen; `None` if none was measured.
    pub largest_connector_error: Option<f64>,
    /// Largest kinetic energy [J] seen: of a group at the end of a step, or of the bodies of an impact before it.
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

/// Report of a handled event: an impact, or contacts that begin or end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handled {
    /// Time of the event.
    pub time: Time,
    /// True for an impact, which [`RigidSystem::last_impact`] reports; [`RigidSystem::contact_changes`] lists the
    /// contacts that begin or end.
    pub impact: bool,
}

/// System of rigid bodies that fly, collide, rest on each other, and are tied by connectors.
#[derive(Clone, Debug)]
pub struct RigidSystem {
    pub(crate) settings: RigidSettings,
    pub(crate) flyers: Vec<Flyer>,
    pub(crate) connectors: Connectors,
    pub(crate) laws: Laws,
    /// True if some masses differ beyond the ratio that can be held together.
    pub(crate) masses_are_extreme: bool,
    /// True if nothing but contacts and connectors accelerates bodies.
    pub(crate) is_forceless: bool,
    /// Time at which the system started.
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
    /// Buffers of an event; taken out while one is handled.
    pub(crate) work: Option<Box<EventWork>>,
    /// Buffer: pairs whose rules or predictions an event changes.
    pub(crate) touched: Vec<PairId>,
    pub(crate) counts: Counts,
    pub(crate) ledger: Ledger,
    pub(crate) told: Told,
}

impl RigidSystem {
    /// Makes the system of the given parts at a time. The caller must see to it that bodies do not overlap and that
    /// connectors fit the states: neither is checked.
    ///
    /// # Errors
    /// Parts or settings out of range, or forces at the start that cannot be found.
    pub fn new(parts: RigidParts, settings: RigidSettings, start: Time) -> Result<Self, AdvanceError> {
        parts.check(&settings, start)?;
        let RigidParts { bodies, connectors, laws, excluded } = parts;
        let flyer = |BodyPart { body, law, state }| Flyer::new(body, law, state, start);
        let flyers: Vec<Flyer> = bodies.into_iter().map(flyer).collect();
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
            masses_are_extreme: false,
        };
        system.masses_are_extreme = system.has_extreme_masses();
        if settings.collisions {
            system.set_up_boxes();
        }
        system.establish()?;
        system.complete_dense();
        Ok(system)
    }

    /// Number of bodies.
    #[must_use]
    #[inline]
    pub fn body_count(&self) -> usize {
        self.flyers.len()
    }

    /// Returns a body with its present segment.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    #[inline]
    pub fn flyer(&self, body: BodyId) -> &Flyer {
        &self.flyers[body.index()]
    }

    /// Counts and extremes of the system since its start.
    #[must_use]
    #[inline]
    pub fn counts(&self) -> Counts {
        let (evaluations, solves) = (self.stage.evaluations, self.stage.solves);
        Counts { evaluations, contact_solves: self.counts.contact_solves + solves, ..self.counts }
    }

    /// The settings of the system.
    #[must_use]
    #[inline]
    pub fn settings(&self) -> &RigidSettings {
        &self.settings
    }

    /// Report of the last impact; empty if there was none.
    #[must_use]
    #[inline]
    pub fn last_impact(&self) -> &ImpactReport {
        &self.told.last_impact
    }

    /// The impact of the event that then failed, if it got that far: booked in the ledger, not reported.
    #[must_use]
    #[inline]
    pub fn untold_impact(&self) -> Option<&ImpactReport> {
        (self.told.failure.is_some() && self.told.has_hit).then_some(&self.told.last_impact)
    }

    /// Error of the last event, if it could not be handled: the system cannot go on from it.
    #[must_use]
    #[inline]
    pub fn failure(&self) -> Option<&AdvanceError> {
        self.told.failure.as_ref()
    }

    /// Time of the last event handled.
    #[must_use]
    #[inline]
    pub fn now(&self) -> Time {
        self.now
    }

    /// True if the force law at an index has a potential; the work of a law without one is in the ledger.
    ///
    /// # Panics
    /// If there is no such law.
    #[must_use]
    #[inline]
    pub fn has_potential(&self, law: usize) -> bool {
        self.laws.has_potential[law]
    }

    /// Force laws, in the order of their indices.
    #[must_use]
    pub fn laws(&self) -> &[Arc<dyn ForceLaw>] {
        &self.laws.all
    }

    /// Place on its path near which the point of a rail or of a rail's stop is sought at a time, which must not be
    /// before the last event; `None` for other connectors.
    #[must_use]
    #[inline]
    pub fn rail_hint(&self, connector: ConnectorId, time: Time) -> Option<RailHint> {
        self.hint_at(connector, 0, time)
    }

    /// Pairs of bodies that never collide with each other, the lesser id first, sorted.
    #[must_use]
    #[inline]
    pub fn excluded(&self) -> &[(BodyId, BodyId)] {
        &self.search.excluded
    }

    /// Counts that the segment of a body is cut short, and returns the body.
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

    /// Runs an event at a time and returns its report; `None` if callers need not know of it.
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
                _ => self.search_on(pair),
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

    /// Handles the earliest event. One that cannot be handled leaves bodies that nothing holds: the system cannot go on
    /// from it, and each further call returns the same error.
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
