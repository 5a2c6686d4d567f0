//! Rapier in double precision, at fixed steps.

use super::belt::{Belt, top_velocity};
use super::moved::{self, Drives, Moved};
use super::segments::corners;
use super::{Engine, EngineError, Session};
use crate::on_joint::OnJoint;
use crate::scene::{Body, Connector, End, Scene, Shape, Spring};
use glam::DVec2;
use halfgap::BodyState;
use rapier2d_f64::prelude::*;

/// The step [s] for which Rapier's lengths and frequencies were chosen.
const STOCK_STEP: f64 = 1.0 / 60.0;
/// Slip [m/s] on a belt that counts as none; from a tenth of it on, runs at some steps take loads at rest for loads that
/// slip.
const LEAST_SLIP: f64 = 1e-8;

/// Damping of motors per mass [1/s]: so much that one reaches its speed within a step, if it is strong enough.
const MOTOR_DAMPING: f64 = 1e9;
/// What a drive may pull [N, N m].
const DRIVE_FORCE: f64 = 1e9;

/// Changes to the settings of `Rapier` besides step and iterations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tuning {
    /// All else as it comes.
    Stock,
    /// No slop, no recycled contacts; contacts looked for ahead and their softness in proportion to the step,
    /// so that they vanish with it.
    Accurate,
}

/// Form in which `Rapier` ties bodies together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joints {
    /// By impulses, as everything else.
    Impulse,
    /// In reduced coordinates: trees only.
    Multibody,
}

/// Rapier with its settings.
#[derive(Clone, Copy, Debug)]
pub struct Rapier {
    /// Steps per time of the scene's grid of checks.
    pub steps_per_check: u32,
    /// Iterations of its solver.
    pub iterations: usize,
    /// Segments for a full circle where an outline has arcs.
    pub segments: usize,
    /// Further changes of its settings.
    pub tuning: Tuning,
    /// Form in which bodies are tied.
    pub joints: Joints,
    /// Form of drives.
    pub drives: Drives,
}

impl Engine for Rapier {
    fn name(&self) -> &'static str {
        "rapier"
    }

    fn version(&self) -> &'static str {
        "0.36.1"
    }

    fn settings(&self) -> String {
        let Self { iterations, steps_per_check, segments, tuning, joints, drives } = self;
        let tuning = match tuning {
            Tuning::Stock => "stock",
            Tuning::Accurate => "accurate",
        };
        let joints = match joints {
            Joints::Impulse => "",
            Joints::Multibody => " multibody",
        };
        let drives = if *drives == Drives::Moved { " moved" } else { "" };
        let segments = if *segments > 0 { format!(" segments {segments}") } else { String::new() };
        format!("{tuning}{joints}{drives} steps {steps_per_check} iterations {iterations}{segments}")
    }

    fn start(&self, scene: &Scene) -> Result<Box<dyn Session>, EngineError> {
        Ok(Box::new(Running::new(self, scene)?))
    }
}

struct Running {
    pipeline: PhysicsPipeline,
    parameters: IntegrationParameters,
    gravity: Vector,
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    impulse_joints: ImpulseJointSet,
    multibody_joints: MultibodyJointSet,
    soft_bodies: SoftBodySet,
    ccd: CCDSolver,
    handles: Vec<RigidBodyHandle>,
    ground: RigidBodyHandle,
    steps: u64,
    springs: Vec<Spring>,
    belt: Option<Belt>,
    moved: Vec<Moved>,
}

impl Running {
    fn new(settings: &Rapier, scene: &Scene) -> Result<Self, EngineError> {
        let step = scene.check_grid / f64::from(settings.steps_per_check);
        let mut bodies = RigidBodySet::new();
        let ground = bodies.insert(RigidBodyBuilder::fixed());
        let mut running = Self {
            pipeline: PhysicsPipeline::new(),
            parameters: parameters(settings, step),
            gravity: vector(scene.gravity),
            islands: IslandManager::new(),
            broad_phase: BroadPhaseBvh::new(),
            narrow_phase: NarrowPhase::new(),
            bodies,
            colliders: ColliderSet::new(),
            impulse_joints: ImpulseJointSet::new(),
            multibody_joints: MultibodyJointSet::new(),
            soft_bodies: SoftBodySet::new(),
            ccd: CCDSolver::new(),
            handles: Vec::new(),
            ground,
            steps: 0,
            springs: scene.springs.clone(),
            belt: Belt::of(scene, LEAST_SLIP),
            moved: moved::moved(scene, settings.drives),
        };
        for body in &scene.bodies {
            running.add_body(body, scene.collisions, settings.segments)?;
        }
        for (index, connector) in scene.connectors.iter().enumerate() {
            if running.moved.iter().all(|moved| moved.pin != index) {
                running.add_connector(connector, &scene.on_joint(index), settings.joints)?;
            }
        }
        Ok(running)
    }

    fn add_body(&mut self, body: &Body, collides: bool, segments: usize) -> Result<(), EngineError> {
        let moved = self.moved.iter().find(|moved| moved.body == self.handles.len()).copied();
        let mut start = body.start;
        if let Some(moved) = moved {
            (start.position, start.velocity) = (moved.pivot, DVec2::ZERO);
        }
        // Its surfaces do not run: a belt is a floor that moves along, as long as it is straight and long.
        let along = top_velocity(&body.surface, start.angle);
        let builder = match body.inertia {
            None if body.spin != 0.0 || along != DVec2::ZERO => RigidBodyBuilder::kinematic_velocity_based(),
            None => RigidBodyBuilder::fixed(),
            Some(_) if moved.is_some() => RigidBodyBuilder::kinematic_position_based(),
            Some(inertia) => RigidBodyBuilder::dynamic().additional_mass_properties(MassProperties::new(
                Vector::ZERO,
                inertia.mass,
                inertia.moment,
            )),
        };
        let handle = self.bodies.insert(
            builder
                .translation(vector(start.position))
                .rotation(start.angle)
                .linvel(vector(start.velocity + along))
                .angvel(start.angular_velocity + body.spin)
                .can_sleep(false)
                .ccd_enabled(true),
        );
        for shape in colliders(&body.shape, segments)? {
            let mut collider = shape
                .density(0.0)
                .translation(vector(moved.map_or(DVec2::ZERO, |moved| -moved.point)))
                .friction(body.surface.friction)
                .restitution(body.elasticity)
                .restitution_combine_rule(CoefficientCombineRule::Min);
            if body.surface.static_friction > body.surface.friction {
                // It takes notice of coefficients that change only where contacts might be modified.
                collider = collider.active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS);
            }
            if !collides {
                collider = collider.collision_groups(InteractionGroups::none());
            }
            self.colliders.insert_with_parent(collider, handle, &mut self.bodies);
        }
        self.handles.push(handle);
        Ok(())
    }

    fn add_connector(
        &mut self,
        connector: &Connector,
        on_joint: &OnJoint,
        joints: Joints,
    ) -> Result<(), EngineError> {
        let (from, to, joint): (_, _, GenericJoint) = match connector {
            Connector::Pin(a, b) => {
                let joint = RevoluteJointBuilder::new()
                    .contacts_enabled(false)
                    .local_anchor1(vector(self.anchor(a)))
                    .local_anchor2(vector(self.anchor(b)));
                let (from, to) = (self.handle(a), self.handle(b));
                let mut joint: GenericJoint = joint.into();
                // In reduced coordinates a joint starts where its frames coincide.
                let turn = self.bodies[from].rotation().inverse() * *self.bodies[to].rotation();
                joint.local_frame1.rotation = turn;
                act(&mut joint, JointAxis::AngX, on_joint, turn.angle());
                (from, to, joint)
            }
            Connector::Guide { body, point, axis } | Connector::Slider { body, point, axis } => {
                let joint = PrismaticJointBuilder::new(vector(*axis)).local_anchor1(vector(*point));
                let mut joint: GenericJoint = joint.into();
                act(&mut joint, JointAxis::LinX, on_joint, 0.0);
                (self.ground, self.handles[*body], joint)
            }
            Connector::Rod(..) => return Err(unsupported("rods")),
            Connector::Rail { .. } => return Err(unsupported("rails")),
        };
        match joints {
            Joints::Impulse => {
                self.impulse_joints.insert(from, to, joint, true);
                Ok(())
            }
            Joints::Multibody => {
                let inserted = self.multibody_joints.insert(from, to, joint, true);
                let handle = inserted.ok_or(unsupported("closed loops in reduced coordinates"))?;
                // It damps such joints unless told otherwise.
                if let Some((multibody, _)) = self.multibody_joints.get_mut(handle) {
                    multibody.damping_mut().fill(0.0);
                }
                Ok(())
            }
        }
    }

    /// The point of a connector's end in the coordinates of its body as it is here.
    fn anchor(&self, end: &End) -> DVec2 {
        let moved = self.moved.iter().find(|moved| Some(moved.body) == end.body);
        end.point - moved.map_or(DVec2::ZERO, |moved| moved.point)
    }

    fn handle(&self, end: &End) -> RigidBodyHandle {
        end.body.map_or(self.ground, |body| self.handles[body])
    }

    fn step(&mut self) {
        self.pull_springs();
        self.tell_friction();
        self.turn_moved();
        self.pipeline.step(
            self.gravity,
            &self.parameters,
            &mut self.islands,
            &mut self.broad_phase,
            &mut self.narrow_phase,
            &mut self.bodies,
            &mut self.colliders,
            &mut self.impulse_joints,
            &mut self.multibody_joints,
            &mut self.soft_bodies,
            &mut self.ccd,
            &(),
            &(),
        );
        self.steps += 1;
    }

    /// Applies the forces of springs, which hold for a step: those at the mean of the times at which its iterations start,
    /// which are substeps. Its own springs damp.
    fn pull_springs(&mut self) {
        let ahead = 0.5 * self.parameters.dt * (1.0 - 1.0 / self.parameters.num_solver_iterations as f64);
        for spring in &self.springs {
            let place = |end: &End| {
                let Some(body) = end.body else { return end.point };
                let body = &self.bodies[self.handles[body]];
                let place = body.position() * vector(end.point) + body.linvel() * ahead;
                DVec2::new(place.x, place.y)
            };
            let (a, b) = (place(&spring.a), place(&spring.b));
            let force = spring.force(a, b);
            for (end, place, force) in [(spring.a, a, force), (spring.b, b, -force)] {
                if let Some(body) = end.body {
                    let body = &mut self.bodies[self.handles[body]];
                    body.reset_forces(true);
                    body.add_force_at_point(vector(force), vector(place), true);
                }
            }
        }
    }

    /// Tells bodies that are moved where they are at the end of the step. One that is told its rate does not turn.
    fn turn_moved(&mut self) {
        let time = (self.steps + 1) as f64 * self.parameters.dt;
        for moved in &self.moved {
            let angle = moved.start + moved.rate * time;
            self.bodies[self.handles[moved.body]].set_next_kinematic_rotation(Rotation::new(angle));
        }
    }

    /// Sets the coefficient of friction on a belt and its load.
    fn tell_friction(&mut self) {
        let Some(belt) = &mut self.belt else { return };
        let [floor, load] = [belt.floor, belt.load].map(|body| self.handles[body]);
        let velocity = self.bodies[load].linvel();
        if let Some(coefficient) = belt.change(DVec2::new(velocity.x, velocity.y)) {
            for &collider in [floor, load].iter().flat_map(|&body| self.bodies[body].colliders()) {
                self.colliders[collider].set_friction(coefficient);
            }
        }
    }
}

impl Session for Running {
    fn advance(&mut self, time: f64) -> Result<(), EngineError> {
        let target = (time / self.parameters.dt).round() as u64;
        while self.steps < target {
            self.step();
        }
        Ok(())
    }

    fn write_states(&mut self, states: &mut Vec<BodyState>) {
        states.clear();
        states.extend(self.handles.iter().map(|&handle| {
            let body = &self.bodies[handle];
            BodyState {
                position: DVec2::new(body.translation().x, body.translation().y),
                angle: body.rotation().angle(),
                velocity: DVec2::new(body.linvel().x, body.linvel().y),
                angular_velocity: body.angvel(),
            }
        }));
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
        let points = self.narrow_phase.contact_pairs().flat_map(|pair| pair.manifolds());
        points.flat_map(|manifold| &manifold.points).map(|point| -point.dist).fold(0.0, f64::max)
    }
}

/// Sets what acts on a joint whose coordinate is `start` where its frames coincide.
fn act(joint: &mut GenericJoint, axis: JointAxis, on_joint: &OnJoint, start: f64) {
    if let Some(motor) = on_joint.as_motor(DRIVE_FORCE) {
        joint.set_motor_velocity(axis, motor.speed, MOTOR_DAMPING).set_motor_max_force(axis, motor.most);
    }
    if let Some(limits) = on_joint.limits {
        joint.set_limits(axis, limits.map(|limit| limit - start));
    }
}

fn parameters(settings: &Rapier, step: f64) -> IntegrationParameters {
    let mut parameters = IntegrationParameters {
        dt: step,
        num_solver_iterations: settings.iterations,
        ..IntegrationParameters::default()
    };
    parameters.min_ccd_dt = step / 100.0;
    if settings.tuning == Tuning::Accurate {
        let share = step / STOCK_STEP;
        parameters.normalized_allowed_linear_error = 0.0;
        parameters.normalized_prediction_distance *= share;
        parameters.contact_recycling = false;
        parameters.normalized_contact_recycle_distance = 0.0;
        parameters.normalized_max_linear_velocity = Real::MAX;
        parameters.contact_softness.natural_frequency /= share;
        parameters.static_contact_softness.natural_frequency /= share;
        parameters.warmstart_joints = true;
    }
    parameters
}

fn colliders(shape: &Shape, segments: usize) -> Result<Vec<ColliderBuilder>, EngineError> {
    Ok(match shape {
        Shape::Disc { radius } => vec![ColliderBuilder::ball(*radius)],
        Shape::Block { width, height } => vec![ColliderBuilder::cuboid(0.5 * width, 0.5 * height)],
        Shape::Polygon(corners) => {
            let corners: Vec<_> = corners.iter().map(|&corner| vector(corner)).collect();
            let hull = ColliderBuilder::convex_polyline(corners);
            vec![hull.ok_or_else(|| EngineError::Build("a polygon that is not convex".to_owned()))?]
        }
        Shape::Rounded { corners, radius } => {
            let corners = corners.iter().map(|&corner| vector(corner)).collect();
            let rounded = ColliderBuilder::round_convex_polyline(corners, *radius);
            vec![rounded.ok_or_else(|| EngineError::Build("a polygon that is not convex".to_owned()))?]
        }
        Shape::Outline(paths) => {
            let paths = corners(paths, segments).map_err(EngineError::Build)?;
            paths.iter().map(|corners| polyline(corners)).collect()
        }
    })
}

fn polyline(corners: &[DVec2]) -> ColliderBuilder {
    let count = u32::try_from(corners.len()).unwrap_or(u32::MAX);
    let sides = (0..count).map(|from| [from, (from + 1) % count]).collect();
    ColliderBuilder::oriented_polyline(corners.iter().map(|&corner| vector(corner)).collect(), Some(sides))
}

fn vector(vector: DVec2) -> Vector {
    Vector::new(vector.x, vector.y)
}

fn unsupported(what: &'static str) -> EngineError {
    EngineError::Unsupported { engine: "rapier", what }
}
