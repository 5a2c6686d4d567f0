//! Box2D 3.2 by its bindings `boxdd`, built with positions in double precision; all else in it is single.

use super::belt::Belt;
use super::moved::{self, Drives, Moved};
use super::segments::corners;
use super::{Engine, EngineError, Session};
use crate::on_joint::OnJoint;
use crate::scene::{Body, Connector, End, Scene, Shape, Spring};
use boxdd::prelude::{
    BodyBuilder, BodyId, BodyType, ChainDef, ConstraintTuning, Filter, Foundation, FoundationConfig,
    JointBase, MassData, Position, PrismaticJointDef, RevoluteJointDef, ShapeDef, SurfaceMaterial, Vec2,
    World, WorldBuilder, shapes,
};
use glam::DVec2;
use halfgap::BodyState;
use std::sync::Arc;

/// No limit on speeds [m/s], in its single precision.
const NO_LIMIT: f32 = 1e9;
/// Stock: the speed [m/s] at which overlaps are pushed apart.
const PUSH_SPEED: f32 = 3.0;
/// Stock: frequency [1/s] and damping ratio of contacts.
const CONTACT_SPRING: (f32, f32) = (30.0, 10.0);
/// Not stock: no limit of our own on the frequency [1/s] of contacts. Box2D bounds it by a quarter of that of substeps.
const STIFF_CONTACTS: f32 = 1e9;
/// Not stock: frequency of joints as a part of that of substeps, the most that Box2D itself allows for contacts.
const JOINT_SHARE: f64 = 0.25;
/// Stock: damping ratio of joints.
const JOINT_DAMPING: f32 = 2.0;
/// Slip [m/s] on a belt that counts as none: tenfold the rounding of half a metre per second. A tenth of it takes loads
/// at rest for loads that slip, tenfold is found out late.
const LEAST_SLIP: f64 = 1e-6;

/// What a drive may pull [N, N m]: what single precision still adds up well.
const DRIVE_FORCE: f64 = 1e9;

/// How much contacts yield.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contacts {
    /// As they come: boxes on each other sink in by their weight, however short the step.
    Soft,
    /// As little as the substep allows, where lengths are scaled; stock contacts are as they come.
    Stiff,
}

/// Box2D with its settings.
#[derive(Clone, Copy, Debug)]
pub struct Box2d {
    /// Steps per time of the scene's grid of checks.
    pub steps_per_check: u32,
    /// Parts of a step in which it solves.
    pub substeps: i32,
    /// Segments for a full circle where an outline has arcs.
    pub segments: usize,
    /// All lengths are multiplied by this. Its slop of 5 mm and other lengths are built in: at 100, they are
    /// a hundredth.
    pub scale: f32,
    /// How much contacts yield.
    pub contacts: Contacts,
    /// Joints as they come, even where lengths are scaled.
    pub soft_joints: bool,
    /// Form of drives.
    pub drives: Drives,
}

impl Engine for Box2d {
    fn name(&self) -> &'static str {
        "box2d"
    }

    fn version(&self) -> &'static str {
        "3.2.0 (boxdd 0.6.0)"
    }

    fn settings(&self) -> String {
        let Self { steps_per_check, substeps, segments, scale, contacts, soft_joints, drives } = self;
        let stiff = if *contacts == Contacts::Stiff { " stiff" } else { "" };
        let joints = if *soft_joints { " soft joints" } else { "" };
        let drives = if *drives == Drives::Moved { " moved" } else { "" };
        let segments = if *segments > 0 { format!(" segments {segments}") } else { String::new() };
        format!("scale {scale}{stiff}{joints}{drives} steps {steps_per_check} substeps {substeps}{segments}")
    }

    fn start(&self, scene: &Scene) -> Result<Box<dyn Session>, EngineError> {
        Ok(Box::new(Running::new(self, scene)?))
    }
}

struct Running {
    world: World,
    bodies: Vec<BodyId>,
    ground: BodyId,
    scale: f64,
    step: f64,
    substeps: i32,
    steps: u64,
    /// Stiffness of joints, if not stock.
    joints: Option<ConstraintTuning>,
    springs: Vec<Spring>,
    belt: Option<Belt>,
    moved: Vec<Moved>,
}

impl Running {
    fn new(settings: &Box2d, scene: &Scene) -> Result<Self, EngineError> {
        let foundation = foundation()?;
        let definition = WorldBuilder::from(foundation.world_def())
            .gravity(vector(scene.gravity * f64::from(settings.scale)))
            .enable_sleep(false)
            .enable_continuous(true)
            .restitution_threshold(0.0)
            .maximum_linear_speed(NO_LIMIT)
            .build();
        let mut world = foundation.create_world(definition.map_err(refused)?).map_err(refused)?;
        if settings.scale > 1.0 {
            world.set_contact_recycle_distance(0.0).map_err(refused)?;
            let (stock, damping) = CONTACT_SPRING;
            let hertz = if settings.contacts == Contacts::Stiff { STIFF_CONTACTS } else { stock };
            world.set_contact_tuning(hertz, damping, PUSH_SPEED * settings.scale).map_err(refused)?;
        }
        let ground = BodyBuilder::from(foundation.body_def()).build().map_err(refused)?;
        let ground = world.create_body(ground).map_err(refused)?;
        let step = scene.check_grid / f64::from(settings.steps_per_check);
        let hertz = JOINT_SHARE * f64::from(settings.substeps) / step;
        let is_tuned = settings.scale > 1.0 && !settings.soft_joints;
        let joints = is_tuned.then(|| ConstraintTuning::new(hertz as f32, JOINT_DAMPING));
        let mut running = Self {
            world,
            bodies: Vec::new(),
            ground,
            scale: f64::from(settings.scale),
            step,
            substeps: settings.substeps,
            steps: 0,
            joints: joints.transpose().map_err(refused)?,
            springs: scene.springs.clone(),
            belt: Belt::of(scene, LEAST_SLIP),
            moved: moved::moved(scene, settings.drives),
        };
        for body in &scene.bodies {
            running.add_body(foundation, body, scene.collisions, settings.segments)?;
        }
        for (index, connector) in scene.connectors.iter().enumerate() {
            if running.moved.iter().all(|moved| moved.pin != index) {
                running.add_connector(connector, &scene.on_joint(index))?;
            }
        }
        Ok(running)
    }

    fn add_body(
        &mut self,
        foundation: &'static Foundation,
        body: &Body,
        collides: bool,
        segments: usize,
    ) -> Result<(), EngineError> {
        let moved = self.moved.iter().find(|moved| moved.body == self.bodies.len()).copied();
        let (mut start, scale) = (body.start, self.scale);
        if let Some(moved) = moved {
            (start.position, start.velocity) = (moved.pivot, DVec2::ZERO);
        }
        let kind = match body.inertia {
            Some(_) if moved.is_some() => BodyType::Kinematic,
            Some(_) => BodyType::Dynamic,
            None if body.spin != 0.0 => BodyType::Kinematic,
            None => BodyType::Static,
        };
        let position = start.position * scale;
        let definition = BodyBuilder::from(foundation.body_def())
            .body_type(kind)
            .position(Position::new(position.x, position.y))
            .angle(start.angle as f32)
            .linear_velocity(vector(start.velocity * scale))
            .angular_velocity((start.angular_velocity + body.spin) as f32)
            .enable_sleep(false)
            .enable_contact_recycling(false)
            .allow_fast_rotation(true)
            .build();
        let id = self.world.create_body(definition.map_err(refused)?).map_err(refused)?;
        let origin = moved.map_or(DVec2::ZERO, |moved| moved.point);
        self.add_shape(id, body, origin, collides, segments).map_err(EngineError::Build)?;
        if let Some(inertia) = body.inertia.filter(|_| moved.is_none()) {
            let moment = (inertia.moment * scale * scale) as f32;
            let data = MassData::new(inertia.mass as f32, Vec2::new(0.0, 0.0), moment).map_err(refused)?;
            self.world.body(id).and_then(|mut body| body.set_mass_data(data)).map_err(refused)?;
        }
        self.bodies.push(id);
        Ok(())
    }

    /// Gives a body its shape, with the origin at a point of the shape's coordinates [m].
    fn add_shape(
        &mut self,
        id: BodyId,
        body: &Body,
        origin: DVec2,
        collides: bool,
        segments: usize,
    ) -> Result<(), String> {
        let told = |error: boxdd::prelude::Error| error.to_string();
        let material = SurfaceMaterial::default();
        let material = material.with_friction(body.surface.friction as f32).map_err(told)?;
        // Its tangent is the outline walked clockwise.
        let speed = -body.surface.speed * self.scale;
        let material = material.with_tangent_speed(speed as f32).map_err(told)?;
        let material = material.with_restitution(body.elasticity as f32).map_err(told)?;
        let filter = if collides { Filter::default() } else { Filter { mask_bits: 0, ..Filter::default() } };
        let definition = ShapeDef::builder().material(material).density(1.0).filter(filter);
        let definition = definition.build().map_err(told)?;
        let scale = self.scale;
        let mut target = self.world.body(id).map_err(told)?;
        match &body.shape {
            Shape::Disc { radius } => {
                let center = vector(-origin * scale);
                let circle = shapes::circle(center, (radius * scale) as f32).map_err(told)?;
                target.create_circle(&definition, &circle).map_err(told)?;
            }
            Shape::Block { width, height } => {
                let half = |size: &f64| (0.5 * size * scale) as f32;
                if origin == DVec2::ZERO {
                    let polygon = shapes::box_polygon(half(width), half(height)).map_err(told)?;
                    target.create_polygon(&definition, &polygon).map_err(told)?;
                } else {
                    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
                        .map(|(x, y)| vector((DVec2::new(x * width, y * height) - origin) * scale));
                    target.create_polygon_from_points(&definition, corners, 0.0).map_err(told)?;
                }
            }
            Shape::Polygon(corners) => {
                let corners = corners.iter().map(|&corner| vector((corner - origin) * scale));
                target.create_polygon_from_points(&definition, corners, 0.0).map_err(told)?;
            }
            Shape::Rounded { corners, radius } => {
                let corners = corners.iter().map(|&corner| vector((corner - origin) * scale));
                let radius = (radius * scale) as f32;
                target.create_polygon_from_points(&definition, corners, radius).map_err(told)?;
            }
            Shape::Outline(paths) => {
                for corners in corners(paths, segments)? {
                    let points = corners.iter().map(|&corner| vector((corner - origin) * scale));
                    let chain = ChainDef::builder().points(points).is_loop(true).filter(filter);
                    let chain = chain.single_material(&material).build().map_err(told)?;
                    target.create_chain(&chain).map_err(told)?;
                }
            }
        }
        Ok(())
    }

    fn add_connector(&mut self, connector: &Connector, on_joint: &OnJoint) -> Result<(), EngineError> {
        let scale = self.scale;
        match connector {
            Connector::Pin(a, b) => {
                let base = self.world.joint_base(self.id(a), self.id(b)).map_err(refused)?;
                let (a, b) = (vector(self.anchor(a) * scale), vector(self.anchor(b) * scale));
                let base = base.with_local_frame_components(a, 0.0, b, 0.0).map_err(refused)?;
                let mut joint = RevoluteJointDef::new(self.tuned(base.with_collide_connected(false)));
                if let Some(motor) = on_joint.as_motor(DRIVE_FORCE) {
                    let torque = (motor.most * scale * scale) as f32;
                    joint = joint.enable_motor(true).motor_speed(motor.speed as f32).max_motor_torque(torque);
                }
                if let Some([lower, upper]) = on_joint.limits {
                    joint = joint.enable_limit(true).lower_angle(lower as f32).upper_angle(upper as f32);
                }
                self.world.create_revolute_joint(&joint).map_err(refused)?;
            }
            Connector::Guide { body, point, axis } | Connector::Slider { body, point, axis } => {
                let base = self.world.joint_base(self.ground, self.bodies[*body]).map_err(refused)?;
                let angle = axis.to_angle() as f32;
                let (point, center) = (vector(*point * scale), Vec2::new(0.0, 0.0));
                let base = base.with_local_frame_components(point, angle, center, angle);
                let base = self.tuned(base.map_err(refused)?).with_collide_connected(true);
                let mut joint = PrismaticJointDef::new(base);
                if let Some(motor) = on_joint.as_motor(DRIVE_FORCE) {
                    let [speed, force] = [motor.speed, motor.most].map(|size| (size * scale) as f32);
                    joint = joint.enable_motor(true).motor_speed(speed).max_motor_force(force);
                }
                if let Some(limits) = on_joint.limits {
                    let [lower, upper] = limits.map(|limit| (limit * scale) as f32);
                    joint = joint.enable_limit(true).lower_translation(lower).upper_translation(upper);
                }
                self.world.create_prismatic_joint(&joint).map_err(refused)?;
            }
            Connector::Rod(..) => return Err(unsupported("stiff rods")),
            Connector::Rail { .. } => return Err(unsupported("rails")),
        }
        Ok(())
    }

    fn tuned(&self, base: JointBase) -> JointBase {
        match self.joints {
            Some(tuning) => base.with_constraint_tuning(tuning),
            None => base,
        }
    }

    /// The point of a connector's end in the coordinates of its body as it is here [m].
    fn anchor(&self, end: &End) -> DVec2 {
        let moved = self.moved.iter().find(|moved| Some(moved.body) == end.body);
        end.point - moved.map_or(DVec2::ZERO, |moved| moved.point)
    }

    fn id(&self, end: &End) -> BodyId {
        end.body.map_or(self.ground, |body| self.bodies[body])
    }

    fn step(&mut self) -> Result<(), boxdd::prelude::Error> {
        self.pull_springs()?;
        self.tell_friction()?;
        drop(self.world.step(self.step as f32, self.substeps)?);
        self.steps += 1;
        Ok(())
    }

    /// Applies the forces of springs, which hold for a step: those at the mean of the times at which its substeps start. Its
    /// own springs damp.
    fn pull_springs(&mut self) -> Result<(), boxdd::prelude::Error> {
        let scale = self.scale;
        let ahead = 0.5 * self.step * (1.0 - 1.0 / f64::from(self.substeps));
        for index in 0..self.springs.len() {
            let spring = self.springs[index];
            let (a, b) = (self.place(&spring.a, ahead)?, self.place(&spring.b, ahead)?);
            let force = spring.force(a, b) * scale;
            for (end, place, force) in [(spring.a, a, force), (spring.b, b, -force)] {
                if let Some(body) = end.body {
                    let place = Position::new(place.x * scale, place.y * scale);
                    self.world.body(self.bodies[body])?.apply_force(vector(force), place, true)?;
                }
            }
        }
        Ok(())
    }

    /// World position [m] of an end of a spring on a body that goes on for a time [s] as it does now, without turning.
    fn place(&mut self, end: &End, ahead: f64) -> Result<DVec2, boxdd::prelude::Error> {
        let Some(body) = end.body else { return Ok(end.point) };
        let state = state(&mut self.world, self.bodies[body], self.scale)?;
        Ok(state.position + ahead * state.velocity + DVec2::from_angle(state.angle).rotate(end.point))
    }

    /// Sets the coefficient of friction on a belt and its load.
    fn tell_friction(&mut self) -> Result<(), boxdd::prelude::Error> {
        let Some(belt) = &mut self.belt else { return Ok(()) };
        let [floor, load] = [belt.floor, belt.load].map(|body| self.bodies[body]);
        let velocity = self.world.body(load)?.linear_velocity()?;
        let velocity = DVec2::new(f64::from(velocity.x), f64::from(velocity.y)) / self.scale;
        if let Some(coefficient) = belt.change(velocity) {
            for id in [floor, load] {
                for shape in self.world.body(id)?.shapes()? {
                    self.world.shape(shape)?.set_friction(coefficient as f32)?;
                }
            }
        }
        Ok(())
    }
}

impl Session for Running {
    fn advance(&mut self, time: f64) -> Result<(), EngineError> {
        let target = (time / self.step).round() as u64;
        while self.steps < target {
            self.step().map_err(|error| EngineError::Stopped(error.to_string()))?;
        }
        Ok(())
    }

    fn write_states(&mut self, states: &mut Vec<BodyState>) {
        states.clear();
        for &id in &self.bodies {
            states.push(state(&mut self.world, id, self.scale).unwrap_or(LOST));
        }
        for moved in &self.moved {
            states[moved.body] = moved::state(moved, states[moved.body].angle);
        }
    }

    fn steps(&self) -> u64 {
        self.steps
    }

    fn events(&self) -> Option<u64> {
        None
    }

    fn penetration(&mut self) -> f64 {
        let mut deepest = 0.0_f64;
        for &id in &self.bodies {
            let contacts = self.world.body(id).and_then(|body| body.contact_data()).unwrap_or_default();
            for point in contacts.iter().flat_map(|contact| contact.manifold.points()) {
                deepest = deepest.max(-f64::from(point.separation));
            }
        }
        deepest / self.scale
    }
}

/// The library itself, with its settings for all worlds. It writes a line to standard output wherever a disc
/// meets many segments at once, which is no fault.
fn foundation() -> Result<&'static Foundation, EngineError> {
    if let Some(foundation) = Foundation::get() {
        return Ok(foundation);
    }
    let silent = FoundationConfig::default().with_log_hook(Arc::new(|_| {}));
    Foundation::initialize(silent).map_err(refused)
}

/// The state of a body that cannot be read any more: as wrong as can be.
const LOST: BodyState =
    BodyState { position: DVec2::INFINITY, angle: 0.0, velocity: DVec2::INFINITY, angular_velocity: 0.0 };

fn state(world: &mut World, id: BodyId, scale: f64) -> Result<BodyState, boxdd::prelude::Error> {
    let body = world.body(id)?;
    let (position, velocity) = (body.position()?, body.linear_velocity()?);
    Ok(BodyState {
        position: DVec2::new(position.x, position.y) / scale,
        angle: f64::from(body.rotation()?.angle()),
        velocity: DVec2::new(f64::from(velocity.x), f64::from(velocity.y)) / scale,
        angular_velocity: f64::from(body.angular_velocity()?),
    })
}

fn vector(vector: DVec2) -> Vec2 {
    Vec2::new(vector.x as f32, vector.y as f32)
}

fn refused(error: impl std::fmt::Display) -> EngineError {
    EngineError::Build(error.to_string())
}

fn unsupported(what: &'static str) -> EngineError {
    EngineError::Unsupported { engine: "box2d", what }
}
