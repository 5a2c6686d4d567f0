//! A world: named bodies, the laws that act on them, and the clock.

use crate::builder::Joints;
use crate::event::{ContactForce, ContactFriction, Event, Impact};
use crate::force::{ForceLaw, Moving, Snapshot, potential_of};
use crate::invariant_monitor::InvariantMonitor;
use crate::ledger::{Books, LawWork, Ledger, Turnover};
use crate::strategy::Strategy;
use glam::DVec2;
use halfgap_advance::Time;
use halfgap_advance::rigid::{Ledger as Booked, RemedyCounts, RigidSettings, RowForce, RowFriction};
use halfgap_collision::{BodyId, BodyState, Connector, ConnectorId, Surroundings, Tolerances};
use halfgap_geometry::Shape;
use std::sync::Arc;

/// Name of the background in messages and recordings.
pub(crate) const BACKGROUND: &str = "world";

/// Returns the name of one of the bodies, or of the background.
pub(crate) fn name_among(bodies: &[Named], body: BodyId) -> &str {
    if body.is_world() { BACKGROUND } else { &bodies[body.index()].name }
}

/// Kinetic and potential energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Potential energy [J]: of uniform gravity (0 with the centre of mass at the world's origin) and of the force laws
    /// that have a potential.
    pub potential: f64,
}

impl Energy {
    /// Kinetic plus potential energy [J].
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential
    }
}

/// Counters of a run, its smallest gap and its largest connector error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Number of segments of motion started: one for each flight of a body, and for each step of a group of bodies that
    /// step together.
    pub steps: u64,
    /// Number of evaluations of the accelerations of a group of bodies by integrators; closed forms need none.
    pub evaluations: u64,
    /// Number of impacts, each contact that came fast within a step of `region_steps` counted as one.
    pub impacts: u64,
    /// Number of times that an event cut the motion of a body short, in flight or in a group.
    pub backups: u64,
    /// Number of contact problems solved, and of solves for the forces of active contacts and connectors.
    pub contact_solves: u64,
    /// Number of steps of bodies whose events accumulated beyond what was followed one by one.
    pub region_steps: u64,
    /// Smallest gap [m] of a contact seen, at an event or within a step, negative if bodies overlapped; `None` if no
    /// bodies have touched.
    pub smallest_gap: Option<f64>,
    /// Largest size of the error of a connector [m] seen within a step or at the present time; `None` without
    /// connectors.
    pub largest_connector_error: Option<f64>,
    /// How often each remedy for a rare case has acted.
    pub remedies: RemedyCounts,
}

/// Data of a body that the layers below do not hold.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Named {
    pub(crate) name: String,
    /// Centre of mass in shape coordinates [m].
    pub(crate) center_of_mass: DVec2,
    /// Mass [kg] and moment of inertia [kg m^2]; `None` for a fixed body.
    pub(crate) inertia: Option<Inertia>,
    /// It is a fixed body that is moved.
    pub(crate) moved: bool,
    /// Sum of the uniform gravities that act on it [m/s^2].
    pub(crate) gravity: DVec2,
}

/// Mass and moment of inertia of a movable body.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Inertia {
    /// Mass [kg].
    pub mass: f64,
    /// Moment of inertia about the centre of mass [kg m^2].
    pub moment: f64,
}

/// Bodies in motion, made by a [`WorldBuilder`](crate::WorldBuilder) or from a scene.
#[derive(Clone, Debug)]
pub struct World {
    pub(crate) strategy: Strategy,
    pub(crate) bodies: Vec<Named>,
    pub(crate) joints: Joints,
    pub(crate) now: Time,
    /// States at the present time that are not those of dense output: of what drives move.
    pub(crate) driven: Vec<(BodyId, BodyState)>,
    pub(crate) warnings: Vec<String>,
    pub(crate) start: Start,
    /// The last impact reported, always an `Event::Impact`: its buffers are reused.
    pub(crate) told: Event,
    /// Whether the start had an impact, jams or contacts whose motion is not unique that have not been reported yet.
    pub(crate) owes_first_report: bool,
    pub(crate) monitor: InvariantMonitor,
}

/// Corrections of the bodies before the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Start {
    /// Largest distance by which a centre of mass was moved [m].
    pub(crate) displacement: f64,
    /// Change of the total energy [J].
    pub(crate) energy_change: f64,
    /// Total energy after the corrections [J].
    pub(crate) energy: f64,
    /// Time of the start.
    pub(crate) time: Time,
}

/// Parts of a world, collected by its builder.
pub(crate) struct WorldParts {
    pub(crate) strategy: Strategy,
    pub(crate) bodies: Vec<Named>,
    pub(crate) joints: Joints,
    pub(crate) now: Time,
    pub(crate) warnings: Vec<String>,
    pub(crate) start: Start,
    pub(crate) monitor: InvariantMonitor,
}

impl World {
    pub(crate) fn new(parts: WorldParts) -> Self {
        let WorldParts { strategy, bodies, joints, now, warnings, start, monitor } = parts;
        let told = Event::Impact(Impact::default());
        let changes = strategy.contact_changes();
        let is_odd = !changes.jam.is_empty() || !changes.undecided.is_empty();
        let owes_first_report = strategy.counts().impacts > 0 || is_odd;
        let mut world = Self {
            strategy,
            bodies,
            joints,
            now,
            driven: Vec::new(),
            warnings,
            start,
            told,
            owes_first_report,
            monitor,
        };
        world.monitor.turnover = Turnover::new(world.energy());
        world
    }

    /// The present time [s].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.now.seconds()
    }

    /// Number of bodies, fixed ones included.
    #[must_use]
    pub fn body_count(&self) -> usize {
        self.bodies.len()
    }

    /// All bodies, in the order in which they were added.
    pub fn bodies(&self) -> impl Iterator<Item = BodyId> + use<> {
        (0..self.bodies.len()).map(BodyId::from_index)
    }

    /// Returns the body with the given name; `None` if there is none.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<BodyId> {
        self.bodies().find(|&body| self.name(body) == name)
    }

    /// Name of a body; "world" for the background.
    ///
    /// # Panics
    /// If the world has no such body.
    #[must_use]
    pub fn name(&self, body: BodyId) -> &str {
        name_among(&self.bodies, body)
    }

    /// True for fixed bodies, which nothing pushes, and for the background.
    ///
    /// # Panics
    /// If the world has no such body.
    #[must_use]
    pub fn is_fixed(&self, body: BodyId) -> bool {
        body.is_world() || self.bodies[body.index()].inertia.is_none()
    }

    /// True for fixed bodies that are moved as prescribed.
    ///
    /// # Panics
    /// If the world has no such body.
    #[must_use]
    pub fn is_moved(&self, body: BodyId) -> bool {
        !body.is_world() && self.bodies[body.index()].moved
    }

    /// Shape of a body, in body coordinates, whose origin is the centre of mass.
    ///
    /// # Panics
    /// If the world has no such body, and for the background.
    #[must_use]
    pub fn shape(&self, body: BodyId) -> &Shape {
        &self.strategy.body(body).shape
    }

    /// Centre of mass of a body [m], in the coordinates in which its shape was given.
    ///
    /// # Panics
    /// If the world has no such body, and for the background.
    #[must_use]
    pub fn center_of_mass(&self, body: BodyId) -> DVec2 {
        self.bodies[body.index()].center_of_mass
    }

    /// Mass and moment of inertia of a body; `None` for a fixed body and for the background.
    ///
    /// # Panics
    /// If the world has no such body.
    #[must_use]
    pub fn inertia(&self, body: BodyId) -> Option<Inertia> {
        if body.is_world() { None } else { self.bodies[body.index()].inertia }
    }

    /// State of a body at the present time; the background is at rest at the origin.
    ///
    /// # Panics
    /// If the world has no such body.
    #[must_use]
    pub fn state(&self, body: BodyId) -> BodyState {
        if body.is_world() {
            return BodyState::default();
        }
        match self.driven.binary_search_by_key(&body, |&(driven, _)| driven) {
            Ok(place) => self.driven[place].1,
            Err(_) => self.strategy.state_at(body, self.now),
        }
    }

    /// Kinetic and potential energy at the present time.
    #[must_use]
    pub fn energy(&self) -> Energy {
        self.energy_in(&mut Vec::new())
    }

    /// Returns [`World::energy`], with a buffer for the motion of the bodies.
    fn energy_in(&self, room: &mut Vec<Moving>) -> Energy {
        energy_of(&self.bodies, self.forces(), self.time(), |body| self.state(body), room)
    }

    /// The present energy; at the start that before contacts that slip have [jammed](Ledger::jams).
    #[must_use]
    pub fn energy_to_begin_with(&self) -> Energy {
        let jams = if self.now == self.start.time { self.ledger().jams } else { 0.0 };
        let Energy { kinetic, potential } = self.energy();
        Energy { kinetic: kinetic - jams, potential }
    }

    /// Returns the sums of the ledger, with buffers for what they are made from.
    pub(crate) fn books(&self, booked: &mut Booked, room: &mut Vec<Moving>) -> Books {
        self.strategy.write_ledger(self.now, booked);
        let works = |size: fn(f64) -> f64| {
            let force_laws = booked.force_laws.iter().enumerate();
            force_laws
                .filter(|(index, _)| !self.strategy.has_potential(*index))
                .map(|(_, &work)| size(work))
                .sum::<f64>()
        };
        Books {
            now: self.energy_in(room),
            start: self.start.energy,
            booked: booked.impacts
                + booked.captures
                + booked.projections
                + booked.steps
                + booked.interventions
                + booked.damping
                + booked.jams
                + booked.impact_friction
                + booked.friction
                + booked.surfaces
                + booked.drives
                + works(|work| work),
            captures: booked.captures,
            projections: booked.projections,
            given: booked.interventions,
            works: works(f64::abs) + booked.surfaces.abs() + booked.drives.abs(),
        }
    }

    /// Returns the energy ledger: every change of the energy since the start, by its cause.
    #[must_use]
    pub fn ledger(&self) -> Ledger {
        let mut books = Booked::default();
        self.strategy.write_ledger(self.now, &mut books);
        let force_laws = self.strategy.force_laws().iter().zip(&books.force_laws).enumerate();
        let force_laws = force_laws.filter(|(index, _)| !self.strategy.has_potential(*index));
        Ledger {
            now: self.energy(),
            start: self.start.energy,
            start_correction: self.start.energy_change,
            impacts: books.impacts,
            captures: books.captures,
            projections: books.projections,
            steps: books.steps,
            interventions: books.interventions,
            damping: books.damping,
            jams: books.jams,
            impact_friction: books.impact_friction,
            friction: books.friction,
            surfaces: books.surfaces,
            drives: books.drives,
            force_laws: force_laws
                .map(|(_, (law, &work))| LawWork { law: law.name().to_owned(), work })
                .collect(),
        }
    }

    /// The forces of all contacts and connectors at the present time.
    #[must_use]
    pub fn contact_forces(&self) -> Vec<ContactForce> {
        self.strategy.row_forces(self.now).iter().map(|row| contact_force(row, &self.joints)).collect()
    }

    /// True if uniform gravity acts on a body.
    #[cfg(feature = "scene")]
    pub(crate) fn has_gravity(&self, body: BodyId) -> bool {
        self.bodies[body.index()].gravity != DVec2::ZERO
    }

    /// The force laws that act, in the order in which they were added.
    pub fn forces(&self) -> impl Iterator<Item = &Arc<dyn ForceLaw>> {
        let force_laws = self.strategy.force_laws().iter().enumerate();
        force_laws.filter(|&(index, _)| self.strategy.is_acting(index)).map(|(_, law)| law)
    }

    /// The connectors, in the order in which they were added.
    #[must_use]
    pub fn connectors(&self) -> &[Connector] {
        self.joints.added()
    }

    /// Error of a connector and of what acts on its free coordinate at the present time [m], 0 or more; 0 for a slack rope and for a point that is clear of its
    /// stop.
    ///
    /// # Panics
    /// If there is no such connector.
    #[must_use]
    pub fn connector_error(&self, connector: ConnectorId) -> f64 {
        let moving = |body: BodyId| {
            if body.is_world() { Moving::BACKGROUND } else { Moving::from(&self.state(body)) }
        };
        let of_part = |id: ConnectorId| {
            let (part, hint) = (&self.joints.all()[id.index()], self.strategy.rail_hint(id, self.now));
            let carrier = part.third().map_or(Moving::BACKGROUND, |(body, _)| moving(body));
            let surroundings = Surroundings {
                time: self.time(),
                carrier: &carrier,
                hint: hint.as_ref(),
                ..Surroundings::default()
            };
            let [a, b] = part.bodies().map(moving);
            part.error_in([&a, &b], &surroundings)
        };
        self.joints.parts(connector).map(of_part).fold(0.0, f64::max)
    }

    /// Thresholds of touching, given or derived from the tolerance.
    #[must_use]
    pub fn tolerances(&self) -> &Tolerances {
        &self.strategy.settings().tolerances
    }

    /// Relative accuracy asked for [-].
    pub(crate) fn tolerance(&self) -> f64 {
        self.monitor.tolerance
    }

    /// Distance [m] by which two bodies may overlap now, beyond the target gap, before they are put back: two slow ones where
    /// contacts carry impulses only, and two whose contact is in a [step](Statistics::region_steps) of bodies whose events
    /// accumulated; else 0.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    pub fn room_to_sink(&self, bodies: [BodyId; 2]) -> f64 {
        self.strategy.room_to_sink(bodies)
    }

    pub(crate) fn rigid_settings(&self) -> &RigidSettings {
        self.strategy.settings()
    }

    /// Pairs of bodies that pass through each other.
    pub(crate) fn pairs_that_pass(&self) -> &[(BodyId, BodyId)] {
        self.strategy.excluded()
    }

    /// Warnings from building the world, such as a gap that rounding keeps from being as small as the tolerance asks.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Largest distance [m] by which a centre of mass was moved at the start, to lift gaps to the target gap and to put
    /// connectors together.
    #[must_use]
    pub fn start_correction(&self) -> f64 {
        self.start.displacement
    }

    /// Counters of the run so far.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        let counts = self.strategy.counts();
        let ids = (0..).map(ConnectorId).take(self.joints.added().len());
        let errors = counts.largest_connector_error.into_iter().chain(ids.map(|id| self.connector_error(id)));
        Statistics {
            steps: counts.segments,
            evaluations: counts.evaluations,
            impacts: counts.impacts,
            backups: counts.backups,
            contact_solves: counts.contact_solves,
            region_steps: counts.region_steps,
            smallest_gap: counts.smallest_gap,
            largest_connector_error: errors.reduce(f64::max),
            remedies: self.strategy.remedies(),
        }
    }

    /// Largest kinetic energy [J] of a group of bodies at the end of a step or just before an impact. Looks at the
    /// present state now and then may miss it.
    pub(crate) fn largest_kinetic_energy(&self) -> f64 {
        self.strategy.counts().largest_kinetic_energy
    }

    /// Number of segments of motion started so far.
    pub(crate) fn steps(&self) -> u64 {
        self.strategy.counts().segments
    }
}

pub(crate) fn contact_force(row: &RowForce, joints: &Joints) -> ContactForce {
    ContactForce {
        bodies: row.bodies,
        connector: row.connector.map(|id| joints.whole(id)),
        point: row.point,
        normal: row.normal,
        force: row.force,
        torque: row.torque,
        friction: row.friction.map(|RowFriction { force, slip_speed, most, sticks }| ContactFriction {
            force,
            slip_speed,
            most,
            sticks,
        }),
        rolling_moment: row.rolling.map(|rolling| rolling.moment),
        heat: row.heat,
    }
}

/// Kinetic energy of bodies in given states, and potential energy of gravity and the force laws on them; `room` is a
/// buffer for what the laws read.
pub(crate) fn energy_of<'a>(
    bodies: &[Named],
    forces: impl Iterator<Item = &'a Arc<dyn ForceLaw>>,
    time: f64,
    state_of: impl Fn(BodyId) -> BodyState,
    room: &mut Vec<Moving>,
) -> Energy {
    let ids = (0..bodies.len()).map(BodyId::from_index);
    let mut energy = Energy::default();
    for (body, named) in ids.clone().zip(bodies) {
        let Named { inertia: Some(inertia), gravity, .. } = named else { continue };
        let state = state_of(body);
        let spin = state.angular_velocity;
        energy.kinetic +=
            0.5 * (inertia.mass * state.velocity.length_squared() + inertia.moment * spin * spin);
        energy.potential -= inertia.mass * gravity.dot(state.position);
    }
    let mut forces = forces.peekable();
    if forces.peek().is_some() {
        room.clear();
        room.extend(ids.map(|body| Moving::from(&state_of(body))));
        energy.potential += potential_of(forces, &Snapshot::new(time, room));
    }
    energy
}
