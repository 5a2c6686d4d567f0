//! Building a world in code: bodies, connectors and force laws. `checks` refuses bad input, `contradictions` connectors that exclude each other, `joints` lists connectors with their parts, `energies` has the scales of the monitor, `drift` tells how far bodies
//! go that nothing holds to the world.

mod checks;
mod contradictions;
mod drift;
mod energies;
mod joints;
mod moved;
mod warnings;

pub(crate) use joints::Joints;
#[cfg(feature = "save")]
pub(crate) use joints::Parts;

use crate::connector::ConnectorSpec;
use crate::force::{ForceId, ForceLaw, Moving, Snapshot, Wrench, Wrenches, wrenches_of};
use crate::invariant_monitor::InvariantMonitor;
use crate::rigid_settings::{rigid_settings, stepping_settings, tolerances};
use crate::run_error::RunError;
use crate::settings::{AdvanceBy, WorldSettings};
use crate::start::{Corrected, StartRules, correct_start};
use crate::strategy::Strategy;
use crate::world::{Inertia, Named, Start, World, WorldParts, energy_of};
use crate::world_error::{ConnectorName, WorldError};
pub(crate) use checks::LARGEST;
use checks::world_bounds;
use drift::drift;
use energies::{acting_on, energy_scales};
use glam::DVec2;
use halfgap_advance::Time;
use halfgap_advance::rigid::{BodyPart, FreeMotion, PairRule, RigidParts, Scales, Surface};
use halfgap_collision::{Anchor, Body, BodyId, BodyMotion, BodyState, ConnectorId, Tolerances};
use halfgap_geometry::{Aabb, Edge, Pose, Rounded, Shape, ShapePool};
use std::slice::from_ref;
use std::sync::Arc;

/// Default of the overlap and the connector error accepted at the start, as a fraction of the smallest movable body's
/// radius.
const DEFAULT_START_ERROR: f64 = 1e-6;

/// Distance of a centroid from the origin below which it is taken for the origin, in machine epsilons of the shape's
/// size.
const CENTROID_ROUNDINGS: f64 = 16.0;
/// Speeds at the start below this [m/s, rad/s] are set to 0: their squares would underflow.
const VANISHING: f64 = 1e-140;
/// Time [s] that stands for the duration of a run that is not known, where bodies that move by less than a rounding of
/// their coordinates count as still.
const TIME_TO_MOVE: f64 = 1.0;

/// A body to be added to a world.
#[derive(Clone, Debug)]
pub struct BodySpec {
    /// Name of the body, unique in the world.
    pub name: String,
    /// Shape of the body, in shape coordinates.
    pub shape: Shape,
    /// Centre of mass in shape coordinates [m]; the shape's centroid if `None`.
    pub center_of_mass: Option<DVec2>,
    /// Mass and moment of inertia about the centre of mass; `None` for a fixed body. A change of `center_of_mass` does
    /// not change the moment here.
    pub inertia: Option<Inertia>,
    /// State at the start; the position is that of the centre of mass. Velocities of a fixed body are ignored.
    pub state: BodyState,
    /// Coefficient of restitution, 0 to 1; a pair of bodies uses the lesser.
    pub elasticity: f64,
    /// Friction and what else the surface does.
    pub surface: Surface,
    /// Motion of a fixed body that is moved, counted from `state` on; its laws tell the velocities. `None` for one that stays.
    pub motion: Option<BodyMotion>,
}

impl BodySpec {
    /// Makes a fixed body of elasticity 1 with its centroid at a position [m].
    #[must_use]
    pub fn fixed(name: &str, shape: Shape, position: DVec2) -> Self {
        let state = BodyState { position, ..BodyState::default() };
        Self {
            name: name.to_owned(),
            shape,
            center_of_mass: None,
            inertia: None,
            state,
            elasticity: 1.0,
            surface: Surface::default(),
            motion: None,
        }
    }

    /// Makes a movable body of elasticity 1 and uniform density, with the given mass [kg].
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
            surface: Surface::default(),
            motion: None,
        }
    }

    /// Places the body so that the origin of its shape's coordinates lies at a point of the world [m], with its present
    /// angle and centre of mass: a room drawn in world coordinates stays where it is drawn with `DVec2::ZERO`.
    ///
    /// ```
    /// use halfgap::BodySpec;
    /// use halfgap::geometry::{DVec2, Shape};
    ///
    /// let corner = [(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)].map(|(x, y)| DVec2::new(x, y));
    /// let ramp = BodySpec::fixed("ramp", Shape::polygon(&corner)?, DVec2::ZERO).with_origin(DVec2::ZERO);
    /// assert!((ramp.state.position - DVec2::new(4.0 / 3.0, 1.0)).length() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_origin(mut self, origin: DVec2) -> Self {
        let turned = Pose::new(DVec2::ZERO, self.state.angle).vector_to_world(center_of_mass(&self));
        self.state.position = origin + turned;
        self
    }
}

/// Collects the parts of a world and builds it.
#[derive(Clone, Debug, Default)]
pub struct WorldBuilder {
    settings: WorldSettings,
    bodies: Vec<BodySpec>,
    free_motions: Vec<FreeMotion>,
    /// Uniform gravity that acts on all bodies [m/s^2], beside those in `laws`.
    gravity: DVec2,
    forces: Vec<Arc<dyn ForceLaw>>,
    connectors: Vec<ConnectorSpec>,
    excluded: Vec<(BodyId, BodyId)>,
    pairs: Vec<([BodyId; 2], PairRule)>,
    /// Warnings of the caller.
    warnings: Vec<String>,
}

impl WorldBuilder {
    /// Makes a builder without bodies.
    #[must_use]
    pub fn new(settings: WorldSettings) -> Self {
        Self { settings, ..Self::default() }
    }

    /// The settings, to change some: those of a scene, say.
    #[must_use]
    pub fn settings_mut(&mut self) -> &mut WorldSettings {
        &mut self.settings
    }

    /// Adds a body and returns its id.
    pub fn add(&mut self, body: BodySpec) -> BodyId {
        self.bodies.push(body);
        self.free_motions.push(FreeMotion::default());
        BodyId::from_index(self.bodies.len() - 1)
    }

    /// Returns a body that was added.
    ///
    /// # Panics
    /// If no such body was added.
    #[must_use]
    pub fn body(&self, body: BodyId) -> &BodySpec {
        &self.bodies[body.index()]
    }

    /// Adds a uniform gravity [m/s^2] to those that act on a body.
    ///
    /// # Panics
    /// If no such body was added.
    pub fn add_gravity(&mut self, body: BodyId, acceleration: DVec2) {
        self.free_motions[body.index()].acceleration += acceleration;
    }

    /// Adds damping to a body: a force of -`linear` v [N] at the centre of mass and a torque of -`angular` w [N m],
    /// with `linear` in N s/m and `angular` in N m s. Does nothing to a fixed body.
    ///
    /// # Panics
    /// If no such body was added.
    pub fn add_damping(&mut self, body: BodyId, linear: f64, angular: f64) {
        if let Some(inertia) = self.bodies[body.index()].inertia {
            let law = &mut self.free_motions[body.index()];
            law.linear_rate += linear / inertia.mass;
            law.angular_rate += angular / inertia.moment;
        }
    }

    /// Adds a uniform gravity [m/s^2] to those that act on all movable bodies, also on those that
    /// are added later.
    pub fn add_gravity_to_all(&mut self, acceleration: DVec2) {
        self.gravity += acceleration;
    }

    /// Adds a force law and returns its id, by which [`World::remove_force`] removes it; see [`force`](crate::force).
    pub fn add_force(&mut self, law: Arc<dyn ForceLaw>) -> ForceId {
        self.forces.push(law);
        ForceId(self.forces.len() - 1)
    }

    /// Adds a connector and returns its id. Bodies joined by a pin or slot do not collide with each other, unless
    /// [`ConnectorSpec::collide`] is set.
    pub fn add_connector(&mut self, connector: ConnectorSpec) -> ConnectorId {
        if connector.keeps_from_colliding() {
            let [a, b] = connector.connector.bodies();
            self.let_pass(a, b);
        }
        self.connectors.push(connector);
        ConnectorId(u32::try_from(self.connectors.len() - 1).unwrap_or(u32::MAX))
    }

    /// Returns the anchor at given shape coordinates of a body [m], or at world coordinates of the background.
    ///
    /// # Panics
    /// If no such body was added.
    #[must_use]
    pub fn anchor(&self, body: BodyId, point: DVec2) -> Anchor {
        let origin = if body.is_world() { DVec2::ZERO } else { center_of_mass(&self.bodies[body.index()]) };
        Anchor { body, point: point - origin }
    }

    /// Lets two bodies pass through each other: they never collide.
    pub fn let_pass(&mut self, a: BodyId, b: BodyId) {
        self.excluded.push((a, b));
    }

    /// Lets two bodies collide that pass through each other so far, as those that a pin joins.
    pub fn let_collide(&mut self, a: BodyId, b: BodyId) {
        self.excluded.retain(|&pair| pair != (a, b) && pair != (b, a));
    }

    /// Gives two bodies a friction, an elasticity and the like of their own, instead of what they say together. Of two rules for one pair
    /// the first holds.
    ///
    /// ```
    /// use halfgap::{BodySpec, BodyState, PairRule, WorldBuilder};
    /// use halfgap::geometry::{DVec2, Shape};
    ///
    /// let mut builder = WorldBuilder::default();
    /// let cloth = builder.add(BodySpec::fixed("cloth", Shape::block(3.0, 0.1)?, DVec2::new(0.0, -0.05)));
    /// let state = BodyState { position: DVec2::new(0.0, 0.03), ..BodyState::default() };
    /// let ball = builder.add(BodySpec::movable("ball", Shape::disc(0.03)?, 0.2, state));
    /// builder.set_pair(cloth, ball, PairRule { friction: Some(0.2), ..PairRule::default() });
    /// assert!(builder.build().is_ok());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_pair(&mut self, a: BodyId, b: BodyId, rule: PairRule) {
        self.pairs.push(([a, b], rule));
    }

    /// Adds a warning, to be told before those of the builder.
    #[cfg(feature = "scene")]
    pub(crate) fn warn(&mut self, warning: String) {
        self.warnings.push(warning);
    }

    /// Checks the input, aligns connectors, corrects small overlaps and connector errors, and builds the world.
    ///
    /// # Errors
    /// [`WorldError`] for names that are not unique, numbers out of range, bodies that overlap, and connectors that are
    /// off: the error names the body or the connector, and the number.
    pub fn build(mut self) -> Result<World, WorldError> {
        let gravity = std::mem::take(&mut self.gravity);
        let free_motions =
            self.free_motions.iter_mut().zip(&self.bodies).filter(|(_, body)| body.inertia.is_some());
        free_motions.for_each(|(free, _)| free.acceleration += gravity);
        self.check()?;
        self.stop_vanishing();
        self.align();
        self.add_springs();
        let joints = self.joints()?;
        let wrenches = self.wrenches()?;
        let scales = self.scales(&wrenches);
        self.check_resolution(&scales)?;
        self.check_duration(&scales)?;
        let tolerances = tolerances(&self.settings, &scales);
        self.check_zone(&tolerances, &scales)?;
        let warnings = [
            self.gap_warning(&scales),
            self.wide_gap_warning(&scales),
            self.step_warning(),
            self.fixed_warning(),
            self.law_warning(),
            self.stop_warning(),
            self.still_warning(),
        ];
        let mut warnings: Vec<String> =
            self.warnings.into_iter().chain(warnings.into_iter().flatten()).collect();
        let (named, mut bodies): (Vec<_>, Vec<_>) = self
            .bodies
            .into_iter()
            .zip(self.free_motions)
            .map(|given| into_part(given, self.settings.start_time))
            .unzip();
        let mut pool = ShapePool::default();
        bodies.iter_mut().for_each(|part| part.body.shape = pool.share(part.body.shape.clone()));
        let rules = start_rules(&self.settings, &self.excluded, &tolerances, &scales);
        let total = |bodies: &[BodyPart]| {
            let state = |body: BodyId| bodies[body.index()].state;
            energy_of(&named, self.forces.iter(), self.settings.start_time, state, &mut Vec::new()).total()
        };
        let acting = acting_on(&bodies, &wrenches, &joints);
        let given = total(&bodies);
        let Corrected { displacement, apart } = correct_start(&mut bodies, &named, &joints, &rules)?;
        warnings.extend(velocity_warning(apart, &tolerances));
        let energy = total(&bodies);
        let now = Time::from_seconds(self.settings.start_time);
        let start = Start { displacement, energy_change: energy - given, energy, time: now };
        let energies = energy_scales(&bodies, acting, &start, (&self.settings, &tolerances));
        let monitor = InvariantMonitor::new(&self.settings, energies);
        let settings = rigid_settings(&self.settings, &scales, tolerances);
        let parts = RigidParts {
            bodies,
            connectors: joints.all().to_vec(),
            force_laws: self.forces,
            excluded: self.excluded,
            pairs: self.pairs,
        };
        let strategy = match self.settings.strategy {
            AdvanceBy::Events => Strategy::events(parts, settings, now),
            AdvanceBy::Steps { step, residual } => {
                Strategy::steps(parts, stepping_settings(settings, (step, residual), &scales), now)
            }
        }
        .map_err(|error| WorldError::Start { source: RunError::new(error, &named, &joints) })?;
        Ok(World::new(WorldParts { strategy, bodies: named, joints, now, warnings, start, monitor }))
    }

    /// Sets to 0 the speeds whose squares would underflow.
    fn stop_vanishing(&mut self) {
        let stop = |speed: &mut f64| *speed = if speed.abs() < VANISHING { 0.0 } else { *speed };
        for BodyState { velocity, angular_velocity, .. } in self.bodies.iter_mut().map(|body| &mut body.state)
        {
            [&mut velocity.x, &mut velocity.y, angular_velocity].into_iter().for_each(stop);
        }
    }

    /// Aligns bodies to the connectors that ask for it, in the connectors' order.
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

    /// Returns the force and torque of all laws on each body at the start. Refuses laws that are not finite, or act on
    /// a body that they do not list.
    fn wrenches(&self) -> Result<Vec<Wrench>, WorldError> {
        let moving: Vec<_> = self.bodies.iter().map(|body| Moving::from(&body.state)).collect();
        let now = Snapshot::new(self.settings.start_time, &moving);
        let mut own = vec![Wrench::default(); moving.len()];
        let accelerated = |body: BodyId, sum: &Wrench| {
            let body = &self.bodies[body.index()];
            let acceleration = |inertia| acceleration(inertia, farthest_reach(body), DVec2::ZERO, sum);
            (body.name.clone(), body.inertia.as_ref().map_or(0.0, acceleration))
        };
        for law in &self.forces {
            let is_left = |body: &BodyId| own.get(body.index()).is_some_and(|sum| *sum != Wrench::default());
            if law.bodies().iter().any(is_left) {
                break;
            }
            check_law(law.as_ref(), &now, &mut own, accelerated)?;
        }
        // A wrench that is left acts on a body that its law does not list.
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

    /// Scales of the scene at the start: sizes, coordinates, speeds and accelerations.
    fn scales(&self, wrenches: &[Wrench]) -> Scales {
        let mut scales = Scales { speed: self.settings.usual_speed.unwrap_or_default(), ..Scales::default() };
        let of_connectors = self.connectors.iter().filter_map(|spec| world_bounds(&spec.connector));
        let mut bounds = of_connectors.reduce(Aabb::union);
        for ((body, law), wrench) in self.bodies.iter().zip(&self.free_motions).zip(wrenches) {
            let shape = centered(body);
            let own = shape.bounds_at(&body.state.pose());
            bounds = Some(bounds.map_or(own, |all| all.union(own)));
            let Some(inertia) = &body.inertia else {
                moved::include(body, shape.reach(), &self.settings, &mut scales);
                continue;
            };
            let reach = shape.reach();
            scales.smallest_radius = Some(scales.smallest_radius.map_or(reach, |least| least.min(reach)));
            let speed = body.state.velocity.length() + body.state.angular_velocity.abs() * reach;
            scales.speed = scales.speed.max(speed);
            let acceleration = acceleration(inertia, reach, law.acceleration, wrench);
            scales.acceleration = scales.acceleration.max(acceleration);
            let turning =
                if shape.centered_disc().is_some() { 0.0 } else { body.state.angular_velocity.abs() * reach };
            let slow = (body.state.velocity.length() + turning).max((acceleration * reach).sqrt());
            if slow > 0.0 {
                scales.slow = Some(scales.slow.map_or(slow, |least| least.min(slow)));
            }
        }
        bounds.into_iter().for_each(|bounds| scales.set_bounds(bounds));
        self.bodies.iter().for_each(|body| scales.include_distance(largest_radius(&body.shape)));
        let ties = (&self.connectors[..], &self.forces[..]);
        let drift = self
            .settings
            .duration
            .and_then(|duration| drift(&self.bodies, &self.free_motions, ties, duration));
        if let (Some(drift), Some(largest)) = (drift, scales.largest_coordinate()) {
            // Gaps may be wider for it by no more than the tolerance.
            scales.include_distance(drift.min(self.settings.tolerance * largest));
        }
        // Where nothing moves and no forces act, interventions are to be expected: the speed that crosses the whole
        // scene in the run is taken for usual then.
        let crossing = scales.coordinate / self.settings.duration.unwrap_or(TIME_TO_MOVE);
        if scales.speed_scale() <= f64::EPSILON * crossing {
            scales.speed = crossing;
        }
        scales
    }
}

/// Refuses a law whose force on a body that it names is not a finite number, or accelerates it by more than [`LARGEST`].
/// `accelerated` gives the name of a body and the acceleration [m/s^2] of its points under a force and a torque. `own` holds
/// zeros for the bodies that the law names, before and after; what the law does to others is left in it.
pub(crate) fn check_law(
    law: &dyn ForceLaw,
    now: &Snapshot<'_>,
    own: &mut [Wrench],
    accelerated: impl Fn(BodyId, &Wrench) -> (String, f64),
) -> Result<(), WorldError> {
    law.apply(now, &mut Wrenches::new(own));
    for &body in law.bodies() {
        let Some(sum) = own.get_mut(body.index()).map(std::mem::take) else { continue };
        let (body, acceleration) = accelerated(body, &sum);
        if !(sum.force.is_finite() && sum.torque.is_finite()) {
            return Err(WorldError::BadForce { law: law.name().to_owned(), body });
        }
        if acceleration > LARGEST {
            return Err(WorldError::StrongForce { law: law.name().to_owned(), body, largest: LARGEST });
        }
    }
    Ok(())
}

/// Returns the errors that the start accepts, and the thresholds that it is to reach.
fn start_rules<'a>(
    settings: &WorldSettings,
    excluded: &'a [(BodyId, BodyId)],
    tolerances: &'a Tolerances,
    scales: &Scales,
) -> StartRules<'a> {
    let default_error = DEFAULT_START_ERROR * scales.smallest_radius.unwrap_or(scales.coordinate);
    // Connectors that contradict each other are together as nearly as the tolerance asks, however wide
    // the zones of contacts.
    let derived = scales.tolerances(settings.tolerance);
    StartRules {
        tolerances,
        excluded,
        collisions: settings.collisions,
        overlap: settings.start_overlap.unwrap_or(default_error),
        connector_error: settings.start_connector_error.unwrap_or(default_error),
        contradiction: derived.accuracy.min(tolerances.accuracy),
        rounding: scales.smallest_gap(),
    }
}

/// Warning if velocities at the start, by which a connector came apart at a rate [m/s], were changed.
fn velocity_warning(apart: Option<(ConnectorName, f64)>, tolerances: &Tolerances) -> Option<String> {
    let (connector, rate) = apart.filter(|&(_, rate)| rate > tolerances.velocity_tol)?;
    Some(format!(
        "the velocities at the start, by which {connector} comes apart at {} m/s, were changed to fit",
        Rounded(rate)
    ))
}

/// Centre of mass of a body in shape coordinates [m].
pub(crate) fn center_of_mass(body: &BodySpec) -> DVec2 {
    body.center_of_mass.unwrap_or_else(|| {
        let centroid = body.shape.mass_properties().centroid;
        // The centroid of a symmetric shape is the origin: what the integrals give instead is their rounding.
        let rounding = CENTROID_ROUNDINGS * f64::EPSILON * body.shape.reach();
        if centroid.length() <= rounding { DVec2::ZERO } else { centroid }
    })
}

/// Acceleration [m/s²] of a body's fastest point, at a reach [m] from its centre of mass, by gravity, force and torque.
pub(crate) fn acceleration(inertia: &Inertia, reach: f64, gravity: DVec2, wrench: &Wrench) -> f64 {
    (gravity + wrench.force / inertia.mass).length() + wrench.torque.abs() / inertia.moment * reach
}

/// Bound [m] on the distance of a body's points from its centre of mass.
fn farthest_reach(body: &BodySpec) -> f64 {
    body.shape.reach() + center_of_mass(body).length()
}

/// Largest radius [m] of a shape's arcs.
pub(super) fn largest_radius(shape: &Shape) -> f64 {
    let radii = shape.edges().filter_map(|edge| match edge {
        Edge::Arc(arc) => Some(arc.radius()),
        Edge::Line(_) => None,
    });
    radii.fold(0.0, f64::max)
}

/// Shape of a body in coordinates about its centre of mass.
fn centered(body: &BodySpec) -> Shape {
    body.shape.translated(-center_of_mass(body))
}

/// Splits the specification of a body into the data that the world keeps and the part for the system, at a time [s].
fn into_part((spec, law): (BodySpec, FreeMotion), start: f64) -> (Named, BodyPart) {
    let (shape, center_of_mass) = (centered(&spec), center_of_mass(&spec));
    let moved = spec.inertia.is_none() && spec.motion.as_ref().is_some_and(|motion| !motion.is_still());
    let named = Named {
        name: spec.name.clone(),
        center_of_mass,
        inertia: spec.inertia,
        moved,
        gravity: law.acceleration,
    };
    let inverse =
        |value: fn(&Inertia) -> f64| spec.inertia.as_ref().map_or(0.0, |inertia| 1.0 / value(inertia));
    let body = Body {
        shape,
        inverse_mass: inverse(|inertia| inertia.mass),
        inverse_moment: inverse(|inertia| inertia.moment),
        elasticity: spec.elasticity,
    };
    let state = if spec.inertia.is_some() { spec.state } else { moved::state_at(&spec, start) };
    let BodySpec { surface, motion, .. } = spec;
    (named, BodyPart { surface, motion, ..BodyPart::new(body, law, state) })
}
