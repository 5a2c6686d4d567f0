//! Building a world in code: bodies, and what acts on them. What is refused is in `checks`.

mod checks;

use crate::connector::ConnectorSpec;
use crate::force::{ForceLaw, Moving, Snapshot, Wrench, Wrenches, wrenches_of};
use crate::rigid_settings::{method, rigid_settings, tolerances};
use crate::rounded::Rounded;
use crate::run_error::RunError;
use crate::sentry::{EnergyScales, Sentry};
use crate::settings::WorldSettings;
use crate::start::{Corrected, StartParts, StartRules, correct_start};
use crate::world::{Inertia, Named, Start, World, WorldParts, energy_of, name_among};
use crate::world_error::WorldError;
pub(crate) use checks::LARGEST;
use checks::world_bounds;
use glam::DVec2;
use halfgap_advance::Time;
use halfgap_advance::rigid::{FlightLaw, RigidParts, RigidSystem, Scales};
use halfgap_collision::{Anchor, Body, BodyId, BodyState, Connector, ConnectorId};
use halfgap_geometry::{Aabb, Edge, Pose, Shape, ShapePool};
use std::slice::from_ref;
use std::sync::Arc;

/// Part of the smallest movable body's radius by which bodies may overlap, and connectors be off, at the
/// start unless said otherwise.
const DEFAULT_START_ERROR: f64 = 1e-6;

/// A centroid nearer to the origin than so many machine epsilons of the shape's size is the origin.
const CENTROID_ROUNDINGS: f64 = 16.0;
/// Speeds that are lower [m/s, rad/s] are none.
const VANISHING: f64 = 1e-140;
/// A speed is told from rounding of the coordinates by so many roundings, of its square.
const LOST_ROUNDINGS: f64 = 1e4;
/// What moves by no rounding of its coordinates in this time [s] stands still, where it is not known how long the
/// world will run.
const TIME_TO_MOVE: f64 = 1.0;
/// Forces press what is held to within so many tolerances of a body's size.
const LOST_TOLERANCES: f64 = 10.0;

/// A body to be added to a world.
#[derive(Clone, Debug)]
pub struct BodySpec {
    /// Its name, unique in the world.
    pub name: String,
    /// Its shape, in shape coordinates.
    pub shape: Shape,
    /// Centre of mass in shape coordinates [m]; the shape's centroid if `None`.
    pub center_of_mass: Option<DVec2>,
    /// Mass and moment of inertia about the centre of mass, which does not follow if that is moved; `None`
    /// for a fixed body.
    pub inertia: Option<Inertia>,
    /// State at the start; the position is that of the centre of mass. A fixed body keeps neither velocity.
    pub state: BodyState,
    /// Share of the closing speed with which it leaves an impact; a pair uses the lesser.
    pub elasticity: f64,
}

impl BodySpec {
    /// A fixed body of full elasticity, its centroid at a position [m].
    #[must_use]
    pub fn fixed(name: &str, shape: Shape, position: DVec2) -> Self {
        let state = BodyState { position, ..BodyState::default() };
        Self { name: name.to_owned(), shape, center_of_mass: None, inertia: None, state, elasticity: 1.0 }
    }

    /// A movable body of full elasticity and of uniform density with the given mass [kg].
    #[must_use]
    pub fn movable(name: &str, shape: Shape, mass: f64, state: BodyState) -> Self {
        let inertia = Inertia { mass, moment: mass * shape.mass_properties().moment_per_mass };
        Self {
            name: name.to_owned(),
            shape,
            center_of_mass: None,
            inertia: Some(inertia),
            state,
            elasticity: 1.0,
        }
    }
}

/// Collects what a world is made of.
#[derive(Clone, Debug, Default)]
pub struct WorldBuilder {
    settings: WorldSettings,
    bodies: Vec<BodySpec>,
    laws: Vec<FlightLaw>,
    forces: Vec<Arc<dyn ForceLaw>>,
    connectors: Vec<ConnectorSpec>,
    excluded: Vec<(BodyId, BodyId)>,
}

impl WorldBuilder {
    /// An empty world.
    #[must_use]
    pub fn new(settings: WorldSettings) -> Self {
        Self { settings, ..Self::default() }
    }

    /// Adds a body.
    pub fn add(&mut self, body: BodySpec) -> BodyId {
        self.bodies.push(body);
        self.laws.push(FlightLaw::default());
        BodyId::from_index(self.bodies.len() - 1)
    }

    /// A body that was added.
    ///
    /// # Panics
    /// If no such body was added.
    #[must_use]
    pub fn body(&self, body: BodyId) -> &BodySpec {
        &self.bodies[body.index()]
    }

    /// Lets uniform gravity [m/s^2] act on a body, in addition to what acts already.
    ///
    /// # Panics
    /// If no such body was added.
    pub fn add_gravity(&mut self, body: BodyId, acceleration: DVec2) {
        self.laws[body.index()].acceleration += acceleration;
    }

    /// Lets damping act on a body: a force of -`linear` v [N] at the centre of mass and a torque of -`angular` w [N m].
    ///
    /// # Panics
    /// If no such body was added.
    pub fn add_damping(&mut self, body: BodyId, linear: f64, angular: f64) {
        if let Some(inertia) = self.bodies[body.index()].inertia {
            let law = &mut self.laws[body.index()];
            law.linear_rate += linear / inertia.mass;
            law.angular_rate += angular / inertia.moment;
        }
    }

    /// Lets a force law act; see [`force`](crate::force).
    pub fn add_force(&mut self, law: Arc<dyn ForceLaw>) {
        self.forces.push(law);
    }

    /// Adds a connector. Bodies that a pin or slot joins do not collide with each other, unless it says so.
    pub fn add_connector(&mut self, connector: ConnectorSpec) -> ConnectorId {
        if connector.keeps_from_colliding() {
            let [a, b] = connector.connector.bodies();
            self.let_pass(a, b);
        }
        self.connectors.push(connector);
        ConnectorId(u32::try_from(self.connectors.len() - 1).unwrap_or(u32::MAX))
    }

    /// The point of a body at the given shape coordinates [m], or of the background at world coordinates.
    ///
    /// # Panics
    /// If no such body was added.
    #[must_use]
    pub fn anchor(&self, body: BodyId, point: DVec2) -> Anchor {
        let origin = if body.is_world() { DVec2::ZERO } else { center_of_mass(&self.bodies[body.index()]) };
        Anchor { body, point: point - origin }
    }

    /// Lets two bodies pass through each other.
    pub fn let_pass(&mut self, a: BodyId, b: BodyId) {
        self.excluded.push((a, b));
    }

    /// Checks everything, aligns what is to be aligned, corrects small overlaps and errors, and builds the world.
    ///
    /// # Errors
    /// Names that are not unique, numbers out of range, bodies that overlap, connectors that are off: the
    /// error names the body or the connector, and the number.
    pub fn build(mut self) -> Result<World, WorldError> {
        self.check()?;
        self.stop_vanishing();
        self.align();
        let wrenches = self.wrenches()?;
        let scales = self.scales(&wrenches);
        self.check_resolution(&scales)?;
        let tolerances = tolerances(&self.settings, &scales);
        self.check_zone(&tolerances, &scales)?;
        let warnings =
            [self.gap_warning(&scales), self.step_warning(), self.fixed_warning(), self.stop_warning()];
        let mut warnings: Vec<String> = warnings.into_iter().flatten().collect();
        let connectors: Vec<Connector> = self.connectors.into_iter().map(|spec| spec.connector).collect();
        let (named, mut bodies): (Vec<_>, Vec<_>) =
            self.bodies.into_iter().zip(self.laws).map(into_parts).unzip();
        let mut pool = ShapePool::default();
        bodies.iter_mut().for_each(|(body, ..)| body.shape = pool.share(body.shape.clone()));
        let default_error = DEFAULT_START_ERROR * scales.smallest_radius.unwrap_or(scales.coordinate);
        // Connectors that contradict each other are together as nearly as the tolerance asks, however wide
        // the zones of contacts.
        let derived = scales.tolerances(self.settings.tolerance);
        let rules = StartRules {
            tolerances: &tolerances,
            excluded: &self.excluded,
            collisions: self.settings.collisions,
            overlap: self.settings.start_overlap.unwrap_or(default_error),
            connector_error: self.settings.start_connector_error.unwrap_or(default_error),
            contradiction: derived.accuracy.min(tolerances.accuracy),
            rounding: scales.smallest_gap(),
        };
        let total = |bodies: &[StartParts]| {
            let state = |body: BodyId| bodies[body.index()].2;
            energy_of(&named, &self.forces, self.settings.start_time, state, &mut Vec::new()).total()
        };
        let forces = forces_on(&bodies, &wrenches);
        let torques = torques_on(&bodies, &wrenches);
        let given = total(&bodies);
        let Corrected { displacement, apart } = correct_start(&mut bodies, &named, &connectors, &rules)?;
        if let Some((connector, rate)) = apart.filter(|&(_, rate)| rate > tolerances.velocity_tol) {
            warnings.push(format!(
                "{connector} comes apart at {} m/s by the velocities at the start; they were changed to fit",
                Rounded(rate)
            ));
        }
        let energy = total(&bodies);
        let start = Start { displacement, energy_change: energy - given, energy };
        let now = Time::from_seconds(self.settings.start_time);
        let (usual, still) = (usual_energy(&bodies, forces) + torques, still_energy(&bodies, &self.settings));
        let energies = EnergyScales {
            usual: if usual > still { usual } else { 0.0 },
            rough: tolerances.target_gap * forces,
            lost: lost_energy(&bodies, forces, &self.settings) + still,
            left: f64::EPSILON * start.energy_change.abs(),
        };
        let sentry = Sentry::new(&self.settings, energies);
        let settings = rigid_settings(&self.settings, &scales, tolerances);
        let parts = RigidParts {
            bodies,
            connectors: connectors.clone(),
            laws: self.forces.clone(),
            excluded: self.excluded,
        };
        let system = RigidSystem::new(parts, settings, now).map_err(|error| WorldError::Start {
            source: RunError::new(error, |body| name_among(&named, body).to_owned()),
        })?;
        Ok(World::new(WorldParts {
            system,
            bodies: named,
            forces: self.forces,
            connectors,
            now,
            warnings,
            start,
            sentry,
        }))
    }

    /// What to say if the coordinates do not allow the gap that the tolerance asks for.
    fn gap_warning(&self, scales: &Scales) -> Option<String> {
        let tolerance = self.settings.tolerance;
        let (wanted, smallest) = (scales.wanted_gap(tolerance), scales.smallest_gap());
        let is_too_small = self.settings.overrides.target_gap.is_none() && wanted < smallest;
        is_too_small.then(|| {
            format!(
                "tolerance {} asks for a target gap of {} m, but coordinates or radii of {} m allow no less than {} m",
                Rounded(tolerance),
                Rounded(wanted),
                Rounded(scales.coordinate),
                Rounded(smallest)
            )
        })
    }

    /// What to say if a step of a given length is too long for how fast a body is damped: what should decay
    /// grows then, wherever it is integrated. Flights are in closed form.
    fn step_warning(&self) -> Option<String> {
        let settings = &self.settings;
        let step = settings.fixed_step().filter(|_| settings.integrator.has_fixed_step())?;
        let bodies = self.bodies.iter().zip(&self.laws);
        let rates = bodies.map(|(body, law)| (&body.name, law.linear_rate.max(law.angular_rate)));
        let (name, rate) = rates.max_by(|p, q| p.1.total_cmp(&q.1))?;
        let longest = method(settings.integrator).stability_limit()? / rate;
        (step > longest).then(|| {
            format!(
                "a time_step of {} s is too long for body \"{name}\", which is damped at {} 1/s: where it is tied or touches something, \
                 what should decay grows in steps of more than {} s",
                Rounded(step),
                Rounded(rate),
                Rounded(longest)
            )
        })
    }

    /// What to say of a fixed body that is given a velocity.
    fn fixed_warning(&self) -> Option<String> {
        let moves = |state: &BodyState| state.velocity != DVec2::ZERO || state.angular_velocity != 0.0;
        let body = self.bodies.iter().find(|body| body.inertia.is_none() && moves(&body.state))?;
        Some(format!("body \"{}\" is fixed: its velocity is left out of account", body.name))
    }

    /// What to say of a stop without the rail that it ends.
    fn stop_warning(&self) -> Option<String> {
        let connectors = || self.connectors.iter().map(|spec| &spec.connector);
        let is_lone = |stop: &Connector| stop.is_stop() && !connectors().any(|rail| stop.is_stop_of(rail));
        let index = connectors().position(is_lone)?;
        let name = self.connector_name(index);
        Some(format!(
            "{name} ends no rail: none has the same point and path, so that nothing keeps the point on it"
        ))
    }

    /// Stops what moves at speeds whose squares are no numbers any more.
    fn stop_vanishing(&mut self) {
        let stop = |speed: &mut f64| *speed = if speed.abs() < VANISHING { 0.0 } else { *speed };
        for BodyState { velocity, angular_velocity, .. } in self.bodies.iter_mut().map(|body| &mut body.state)
        {
            [&mut velocity.x, &mut velocity.y, angular_velocity].into_iter().for_each(stop);
        }
    }

    /// Moves the bodies that connectors are to align, in the connectors' order.
    fn align(&mut self) {
        for spec in self.connectors.iter().filter(|spec| spec.align) {
            let ends = spec.connector.bodies();
            let pose =
                |body: BodyId| self.bodies.get(body.index()).map_or(Pose::IDENTITY, |body| body.state.pose());
            let can_move =
                ends.map(|body| self.bodies.get(body.index()).is_some_and(|body| body.inertia.is_some()));
            if let Some(alignment) = spec.connector.align(&pose(ends[0]), &pose(ends[1]), can_move) {
                let moved = ends[usize::from(alignment.moves_b)];
                self.bodies[moved.index()].state.position += alignment.shift;
            }
        }
    }

    /// Forces and torques of all laws at the start.
    fn wrenches(&self) -> Result<Vec<Wrench>, WorldError> {
        let moving: Vec<_> = self.bodies.iter().map(|body| Moving::from(&body.state)).collect();
        let now = Snapshot::new(self.settings.start_time, &moving);
        let mut own = vec![Wrench::default(); moving.len()];
        for law in &self.forces {
            let is_left = |body: &BodyId| own.get(body.index()).is_some_and(|sum| *sum != Wrench::default());
            if law.bodies().iter().any(is_left) {
                break;
            }
            law.apply(&now, &mut Wrenches::new(&mut own));
            for &body in law.bodies() {
                let Some(sum) = own.get_mut(body.index()).map(std::mem::take) else { continue };
                if !(sum.force.is_finite() && sum.torque.is_finite()) {
                    let body = self.bodies[body.index()].name.clone();
                    return Err(WorldError::BadForce { law: law.name().to_owned(), body });
                }
            }
        }
        // What is left acts on a body that its law does not name.
        let Some(unnamed) = own.iter().position(|sum| *sum != Wrench::default()) else {
            return Ok(wrenches_of(&self.forces, &now, moving.len()));
        };
        let acts = |law: &&Arc<dyn ForceLaw>| {
            let named = law.bodies().iter().any(|body| body.index() == unnamed);
            !named && wrenches_of(from_ref(*law), &now, moving.len())[unnamed] != Wrench::default()
        };
        let law = self.forces.iter().find(acts).map_or("", |law| law.name());
        let body = self.bodies[unnamed].name.clone();
        Err(WorldError::UnnamedBody { law: law.to_owned(), body })
    }

    fn scales(&self, wrenches: &[Wrench]) -> Scales {
        let mut scales = Scales { speed: self.settings.usual_speed.unwrap_or_default(), ..Scales::default() };
        let of_connectors = self.connectors.iter().filter_map(|spec| world_bounds(&spec.connector));
        let mut bounds = of_connectors.reduce(Aabb::union);
        for ((body, law), wrench) in self.bodies.iter().zip(&self.laws).zip(wrenches) {
            let shape = centered(body);
            let own = shape.bounds_at(&body.state.pose());
            bounds = Some(bounds.map_or(own, |all| all.union(own)));
            let Some(inertia) = &body.inertia else { continue };
            let reach = shape.reach();
            scales.smallest_radius = Some(scales.smallest_radius.map_or(reach, |least| least.min(reach)));
            let speed = body.state.velocity.length() + body.state.angular_velocity.abs() * reach;
            scales.speed = scales.speed.max(speed);
            let acceleration = (law.acceleration + wrench.force / inertia.mass).length()
                + wrench.torque.abs() / inertia.moment * reach;
            scales.acceleration = scales.acceleration.max(acceleration);
            let turning =
                if shape.centered_disc().is_some() { 0.0 } else { body.state.angular_velocity.abs() * reach };
            let slow = (body.state.velocity.length() + turning).max((acceleration * reach).sqrt());
            if slow > 0.0 {
                scales.slow = Some(scales.slow.map_or(slow, |least| least.min(slow)));
            }
        }
        bounds.into_iter().for_each(|bounds| scales.set_bounds(bounds));
        self.bodies.iter().for_each(|body| scales.include_radius(largest_radius(&body.shape)));
        // Where nothing moves or acts somebody will push: what is usual then crosses all of it in the run.
        let crossing = scales.coordinate / self.settings.duration.unwrap_or(TIME_TO_MOVE);
        if scales.speed_scale() <= f64::EPSILON * crossing {
            scales.speed = crossing;
        }
        scales
    }
}

/// Kinetic energy [J] of the bodies, and what forces of a size [N] make of it across all of them.
fn usual_energy(bodies: &[StartParts], forces: f64) -> f64 {
    let bounds = bodies.iter().map(|(body, _, state)| body.shape.bounds_at(&state.pose()));
    let size = bounds.reduce(Aabb::union).map_or(0.0, |all| all.size().length());
    let kinetic = bodies.iter().map(|(body, _, state)| body.kinetic_energy(state));
    kinetic.sum::<f64>() + forces * size
}

/// The work [J] of forces of a size [N] within the tolerance of the bodies' sizes, and what the bodies have
/// at a speed that is rounding of their coordinates.
fn lost_energy(bodies: &[StartParts], forces: f64, settings: &WorldSettings) -> f64 {
    let reach = movable(bodies).map(|(body, ..)| body.shape.reach()).fold(0.0, f64::max);
    let rounding = settings.duration.map_or(0.0, |duration| crossing_energy(bodies, duration));
    LOST_ROUNDINGS * f64::EPSILON * rounding + forces * LOST_TOLERANCES * settings.tolerance * reach
}

/// Energy [J] of bodies that move so slowly that in all of the run their coordinates do not change by a rounding.
fn still_energy(bodies: &[StartParts], settings: &WorldSettings) -> f64 {
    let time = settings.duration.unwrap_or(TIME_TO_MOVE);
    f64::EPSILON * f64::EPSILON * crossing_energy(bodies, time)
}

/// Energy [J] of the bodies, if all went as far as the coordinates are large in a time [s].
fn crossing_energy(bodies: &[StartParts], time: f64) -> f64 {
    let farthest =
        bodies.iter().map(|(body, _, state)| state.position.abs().max_element() + body.shape.reach());
    let speed = farthest.fold(0.0, f64::max) / time;
    let mass: f64 = movable(bodies).map(|(body, ..)| body.inverse_mass.recip()).sum();
    mass * speed * speed
}

fn movable(bodies: &[StartParts]) -> impl Iterator<Item = &StartParts> {
    bodies.iter().filter(|(body, ..)| !body.is_fixed())
}

/// Sum of the sizes of the forces [N] on the movable bodies.
fn forces_on(bodies: &[StartParts], wrenches: &[Wrench]) -> f64 {
    let movable = bodies.iter().zip(wrenches).filter(|((body, ..), _)| !body.is_fixed());
    let forces = movable.map(|((body, law, _), wrench)| wrench.force + law.acceleration / body.inverse_mass);
    forces.map(|force| force.length()).sum()
}

/// Sum of the sizes of the torques [N m] on the movable bodies: what they do to a radian [J].
fn torques_on(bodies: &[StartParts], wrenches: &[Wrench]) -> f64 {
    let movable = bodies.iter().zip(wrenches).filter(|((body, ..), _)| !body.is_fixed());
    movable.map(|(_, wrench)| wrench.torque.abs()).sum()
}

fn center_of_mass(body: &BodySpec) -> DVec2 {
    body.center_of_mass.unwrap_or_else(|| {
        let centroid = body.shape.mass_properties().centroid;
        // The centroid of a symmetric shape is the origin: what the integrals leave of it is their rounding.
        let rounding = CENTROID_ROUNDINGS * f64::EPSILON * body.shape.reach();
        if centroid.length() <= rounding { DVec2::ZERO } else { centroid }
    })
}

/// Largest radius [m] of a shape's arcs.
pub(super) fn largest_radius(shape: &Shape) -> f64 {
    let radii = shape.edges().filter_map(|edge| match edge {
        Edge::Arc(arc) => Some(arc.radius()),
        Edge::Line(_) => None,
    });
    radii.fold(0.0, f64::max)
}

/// The shape about the centre of mass.
fn centered(body: &BodySpec) -> Shape {
    body.shape.translated(-center_of_mass(body))
}

type Parts = (Named, StartParts);

fn into_parts((spec, law): (BodySpec, FlightLaw)) -> Parts {
    let (shape, center_of_mass) = (centered(&spec), center_of_mass(&spec));
    let named = Named { name: spec.name, center_of_mass, inertia: spec.inertia, gravity: law.acceleration };
    let inverse =
        |value: fn(&Inertia) -> f64| spec.inertia.as_ref().map_or(0.0, |inertia| 1.0 / value(inertia));
    let body = Body {
        shape,
        inverse_mass: inverse(|inertia| inertia.mass),
        inverse_moment: inverse(|inertia| inertia.moment),
        elasticity: spec.elasticity,
    };
    // A fixed body keeps neither velocity.
    let state = if spec.inertia.is_some() {
        spec.state
    } else {
        BodyState { velocity: DVec2::ZERO, angular_velocity: 0.0, ..spec.state }
    };
    (named, (body, law, state))
}
