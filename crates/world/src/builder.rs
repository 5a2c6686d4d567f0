//! Building a world in code: bodies, and what acts on them.

use crate::force::{Attachment, ForceLaw, Moving, Snapshot, Wrench, wrenches_of};
use crate::rigid_settings::rigid_settings;
use crate::scales::Scales;
use crate::settings::WorldSettings;
use crate::start::{StartParts, lift_overlaps};
use crate::world::{Inertia, Named, Start, World, energy_of};
use crate::world_error::WorldError;
use glam::DVec2;
use halfgap_advance::Time;
use halfgap_advance::rigid::{FlightLaw, RigidParts, RigidSystem};
use halfgap_collision::{Body, BodyId, BodyState, SearchSettings};
use halfgap_geometry::{Aabb, Shape};
use std::collections::BTreeSet;
use std::slice::from_ref;
use std::sync::Arc;

/// Part of the smallest movable body's radius by which bodies may overlap at the start unless said otherwise.
const DEFAULT_START_OVERLAP: f64 = 1e-6;

/// A centroid nearer to the origin than so many machine epsilons of the shape's size is the origin.
const CENTROID_ROUNDINGS: f64 = 16.0;

/// A body to be added to a world.
#[derive(Clone, Debug)]
pub struct BodySpec {
    /// Its name, unique in the world.
    pub name: String,
    /// Its shape, in shape coordinates.
    pub shape: Shape,
    /// Centre of mass in shape coordinates [m]; the shape's centroid if `None`.
    pub center_of_mass: Option<DVec2>,
    /// Mass and moment of inertia; `None` for a fixed body.
    pub inertia: Option<Inertia>,
    /// State at the start; the position is that of the centre of mass.
    pub state: BodyState,
    /// Share of the closing speed with which it leaves an impact; a pair uses the lesser.
    pub elasticity: f64,
}

impl BodySpec {
    /// A fixed body of full elasticity.
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
    gravity: Vec<DVec2>,
    forces: Vec<Arc<dyn ForceLaw>>,
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
        self.gravity.push(DVec2::ZERO);
        BodyId(u32::try_from(self.bodies.len() - 1).unwrap_or(u32::MAX))
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
    pub fn add_gravity(&mut self, body: BodyId, acceleration: DVec2) {
        self.laws[body.index()].acceleration += acceleration;
        self.gravity[body.index()] += acceleration;
    }

    /// Lets damping act on a body: a force of -`linear` v [N] at the centre of mass and a torque of -`angular` w [N m].
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

    /// The point of a body at the given shape coordinates [m], or of the background at world coordinates.
    ///
    /// # Panics
    /// If no such body was added.
    #[must_use]
    pub fn attachment(&self, body: BodyId, point: DVec2) -> Attachment {
        let origin = if body.is_world() { DVec2::ZERO } else { center_of_mass(&self.bodies[body.index()]) };
        Attachment { body, point: point - origin }
    }

    /// Lets two bodies pass through each other.
    pub fn let_pass(&mut self, a: BodyId, b: BodyId) {
        self.excluded.push((a, b));
    }

    /// Checks everything, lifts small overlaps, and builds the world.
    ///
    /// # Errors
    /// Names that are not unique, numbers out of range, bodies that overlap: the error names the body and the number.
    pub fn build(self) -> Result<World, WorldError> {
        self.check()?;
        let scales = self.scales(&self.wrenches()?);
        let tolerances = scales.tolerances(self.settings.tolerance, &self.settings.overrides);
        let mut warnings = Vec::new();
        if self.settings.overrides.target_gap.is_none()
            && scales.wanted_gap(self.settings.tolerance) < scales.smallest_gap()
        {
            warnings.push(format!(
                "tolerance {} asks for a target gap of {:e} m, but coordinates of {} m allow no less than {:e} m",
                self.settings.tolerance,
                scales.wanted_gap(self.settings.tolerance),
                scales.coordinate,
                scales.smallest_gap()
            ));
        }
        let allowed = self
            .settings
            .start_overlap
            .unwrap_or(DEFAULT_START_OVERLAP * scales.smallest_radius.unwrap_or(scales.coordinate));
        let (named, mut bodies): (Vec<_>, Vec<_>) =
            self.bodies.into_iter().zip(self.laws).zip(self.gravity).map(into_parts).unzip();
        let total = |bodies: &[StartParts]| {
            let state = |body: BodyId| bodies[body.index()].2;
            energy_of(&named, &self.forces, self.settings.start_time, state).total()
        };
        let given = total(&bodies);
        let displacement = if self.settings.collisions {
            lift_overlaps(&mut bodies, &named, &self.excluded, &tolerances, allowed)?
        } else {
            0.0
        };
        let energy = total(&bodies);
        let start = Start { displacement, energy_change: energy - given, energy };
        let settings = rigid_settings(&self.settings, &scales);
        let now = Time::from_seconds(self.settings.start_time);
        let parts =
            RigidParts { bodies, connectors: Vec::new(), laws: self.forces.clone(), excluded: self.excluded };
        let system = RigidSystem::new(parts, settings, now).map_err(|source| WorldError::Start { source })?;
        Ok(World::new(system, named, self.forces, now, warnings, start))
    }

    fn check(&self) -> Result<(), WorldError> {
        let mut names = BTreeSet::new();
        for body in &self.bodies {
            if !names.insert(body.name.as_str()) {
                return Err(WorldError::DoubleName { name: body.name.clone() });
            }
            check_body(body)?;
        }
        let positive = [
            ("tolerance", Some(self.settings.tolerance)),
            ("target_gap", self.settings.overrides.target_gap),
            ("accuracy", self.settings.overrides.accuracy),
            ("velocity_tol", self.settings.overrides.velocity_tol),
            ("time_step", self.settings.time_step),
        ];
        for (setting, value) in positive {
            if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
                return Err(WorldError::BadSetting { setting, rule: "positive and finite", value });
            }
        }
        Ok(())
    }

    /// Forces and torques of all laws at the start.
    fn wrenches(&self) -> Result<Vec<Wrench>, WorldError> {
        let count = self.bodies.len();
        let moving: Vec<_> = self.bodies.iter().map(|body| Moving::from(&body.state)).collect();
        let now = Snapshot::new(self.settings.start_time, &moving);
        for law in &self.forces {
            if let Some(body) = law.bodies().iter().find(|body| body.index() >= count) {
                let law = law.name().to_owned();
                return Err(WorldError::NoSuchBody { law, body: body.0, bodies: count });
            }
            let own = wrenches_of(from_ref(law), &now, count);
            if let Some(bad) = own.iter().position(|sum| !(sum.force.is_finite() && sum.torque.is_finite())) {
                let body = self.bodies[bad].name.clone();
                return Err(WorldError::BadForce { law: law.name().to_owned(), body });
            }
        }
        Ok(wrenches_of(&self.forces, &now, count))
    }

    fn scales(&self, wrenches: &[Wrench]) -> Scales {
        let mut scales = Scales::default();
        for ((body, law), wrench) in self.bodies.iter().zip(&self.laws).zip(wrenches) {
            let shape = centered(body);
            let bounds: Aabb = shape.bounds_at(&body.state.pose());
            let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
            scales.coordinate = scales.coordinate.max(largest);
            let Some(inertia) = &body.inertia else { continue };
            let reach = shape.reach();
            scales.smallest_radius = Some(scales.smallest_radius.map_or(reach, |least| least.min(reach)));
            let speed = body.state.velocity.length() + body.state.angular_velocity.abs() * reach;
            scales.speed = scales.speed.max(speed);
            let acceleration = (law.acceleration + wrench.force / inertia.mass).length()
                + law.linear_rate * body.state.velocity.length()
                + wrench.torque.abs() / inertia.moment * reach;
            scales.acceleration = scales.acceleration.max(acceleration);
        }
        scales
    }
}

fn check_body(body: &BodySpec) -> Result<(), WorldError> {
    let bad =
        |quantity, rule, value| Err(WorldError::BadNumber { body: body.name.clone(), quantity, rule, value });
    if let Some(Inertia { mass, moment }) = body.inertia {
        for (quantity, value) in [("mass", mass), ("moment", moment)] {
            if !(value > 0.0 && value.is_finite()) {
                return bad(quantity, "positive and finite", value);
            }
        }
    }
    if !(0.0..=1.0).contains(&body.elasticity) {
        return bad("elasticity", "between 0 and 1", body.elasticity);
    }
    let state = &body.state;
    let numbers = [
        ("position", state.position.x),
        ("position", state.position.y),
        ("angle", state.angle),
        ("velocity", state.velocity.x),
        ("velocity", state.velocity.y),
        ("angular velocity", state.angular_velocity),
    ];
    match numbers.into_iter().find(|(_, value)| !value.is_finite()) {
        Some((quantity, value)) => bad(quantity, "finite", value),
        None => Ok(()),
    }
}

fn center_of_mass(body: &BodySpec) -> DVec2 {
    body.center_of_mass.unwrap_or_else(|| {
        let centroid = body.shape.mass_properties().centroid;
        // The centroid of a symmetric shape is the origin: what the integrals leave of it is their rounding.
        let rounding = CENTROID_ROUNDINGS * f64::EPSILON * body.shape.reach();
        if centroid.length() <= rounding { DVec2::ZERO } else { centroid }
    })
}

/// The shape about the centre of mass.
fn centered(body: &BodySpec) -> Shape {
    body.shape.translated(-center_of_mass(body))
}

type Parts = (Named, StartParts);

fn into_parts(((spec, law), gravity): ((BodySpec, FlightLaw), DVec2)) -> Parts {
    let (shape, center_of_mass) = (centered(&spec), center_of_mass(&spec));
    let named = Named { name: spec.name, center_of_mass, inertia: spec.inertia, gravity };
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
