//! halfgap, with its one knob.

use super::{Engine, EngineError, Session};
use crate::on_joint::OnJoint;
use crate::scene::{Body, Connector, End, Scene};
use glam::DVec2;
use halfgap::force::Spring;
use halfgap::{
    AdvanceBy, Anchor, BodyId, BodyMotion, BodySpec, BodyState, ConnectorKind, ConnectorSpec, Inertia,
    Limits, MotionLaw, Motor, RailPath, SlotFrame, Surface, Turn, World, WorldBuilder, WorldSettings,
    geometry,
};
use std::sync::Arc;

/// Tolerance from which thresholds of steps follow, as in scene files.
const FINE: f64 = 1e-6;

/// halfgap at a tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Halfgap {
    /// Relative accuracy asked for.
    pub tolerance: f64,
    /// Length of steps [s], with `tolerance` as their residual; `None` for events.
    pub step: Option<f64>,
}

impl Engine for Halfgap {
    fn name(&self) -> &'static str {
        "halfgap"
    }

    fn version(&self) -> &'static str {
        env!("CARGO_PKG_VERSION")
    }

    fn settings(&self) -> String {
        match self.step {
            Some(step) => format!("{:.0} Hz residual {:e}", 1.0 / step, self.tolerance),
            None => format!("tolerance {:e}", self.tolerance),
        }
    }

    fn start(&self, scene: &Scene) -> Result<Box<dyn Session>, EngineError> {
        let strategy = match self.step {
            Some(step) => AdvanceBy::Steps { step: Some(step), residual: self.tolerance },
            None => AdvanceBy::Events,
        };
        let world = build(scene, self.tolerance, strategy)?;
        Ok(Box::new(Running { world }))
    }
}

/// Builds a scene as a world.
///
/// # Errors
/// A scene that halfgap refuses.
pub fn build(scene: &Scene, tolerance: f64, strategy: AdvanceBy) -> Result<World, EngineError> {
    let settings = WorldSettings {
        tolerance: match strategy {
            AdvanceBy::Events => tolerance,
            AdvanceBy::Steps { .. } => tolerance.min(FINE),
        },
        strategy,
        collisions: scene.collisions,
        ..WorldSettings::default()
    };
    let mut builder = WorldBuilder::new(settings);
    for body in &scene.bodies {
        let id = builder.add(body_spec(body).map_err(refused)?);
        if body.inertia.is_some() {
            builder.add_gravity(id, scene.gravity);
        }
    }
    for (index, connector) in scene.connectors.iter().enumerate() {
        let connector = halfgap::Connector::new(connector_kind(connector)?, 0.0).map_err(refused)?;
        builder.add_connector(acted_on(ConnectorSpec::new(connector), &scene.on_joint(index)));
    }
    for (index, spring) in scene.springs.iter().enumerate() {
        let ends = [anchor(&spring.a), anchor(&spring.b)];
        let law = Spring::new(format!("spring {index}"), ends, spring.rest_length, spring.stiffness);
        builder.add_force(Arc::new(law));
    }
    builder.build().map_err(refused)
}

fn refused(error: impl std::fmt::Display) -> EngineError {
    EngineError::Build(error.to_string())
}

fn body_spec(body: &Body) -> Result<BodySpec, geometry::ShapeError> {
    let shape = body.shape.geometry()?;
    let inertia = body.inertia.map(|inertia| Inertia { mass: inertia.mass, moment: inertia.moment });
    let crate::scene::Surface { friction, static_friction, speed } = body.surface;
    Ok(BodySpec {
        name: body.name.clone(),
        shape,
        center_of_mass: Some(DVec2::ZERO),
        inertia,
        state: body.start,
        elasticity: body.elasticity,
        surface: Surface { friction, static_friction, velocity: speed, ..Surface::default() },
        motion: (body.spin != 0.0).then(|| BodyMotion::uniform(DVec2::ZERO, body.spin)),
    })
}

fn anchor(end: &End) -> Anchor {
    Anchor { body: end.body.map_or(BodyId::WORLD, BodyId::from_index), point: end.point }
}

fn connector_kind(connector: &Connector) -> Result<ConnectorKind, EngineError> {
    Ok(match connector {
        Connector::Pin(a, b) => ConnectorKind::Pin { a: anchor(a), b: anchor(b) },
        Connector::Rod(a, b, length) => ConnectorKind::Rod { a: anchor(a), b: anchor(b), length: *length },
        Connector::Guide { body, point, axis } => ConnectorKind::Slot {
            a: anchor(&End::world(*point)),
            b: anchor(&End::body(*body, DVec2::ZERO)),
            normal: axis.perp(),
            frame: SlotFrame::World,
        },
        Connector::Slider { body, point, axis } => ConnectorKind::Slider {
            a: anchor(&End::world(*point)),
            b: anchor(&End::body(*body, DVec2::ZERO)),
            axis: *axis,
            frame: SlotFrame::World,
            turn: Turn::default(),
        },
        Connector::Rail { body, points } => ConnectorKind::Rail {
            a: anchor(&End::body(*body, DVec2::ZERO)),
            path: Arc::new(RailPath::through(points, false).map_err(refused)?),
        },
    })
}

fn acted_on(mut spec: ConnectorSpec, on_joint: &OnJoint) -> ConnectorSpec {
    let OnJoint { motor, limits, friction, rate } = *on_joint;
    if let Some(motor) = motor {
        spec = spec.motor(Motor { speed: motor.speed, max: motor.most });
    }
    if let Some([lower, upper]) = limits {
        spec = spec.limits(Limits { lower: Some(lower), upper: Some(upper), elasticity: 0.0 });
    }
    if friction > 0.0 {
        spec = spec.friction(friction);
    }
    if let Some(rate) = rate {
        spec = spec.drive(MotionLaw::Uniform(rate));
    }
    spec
}

struct Running {
    world: World,
}

impl Session for Running {
    fn advance(&mut self, time: f64) -> Result<(), EngineError> {
        self.world.advance_to(time, &mut |_| {}).map_err(|error| EngineError::Stopped(error.to_string()))
    }

    fn write_states(&mut self, states: &mut Vec<BodyState>) {
        states.clear();
        states.extend(self.world.bodies().map(|body| self.world.state(body)));
    }

    fn steps(&self) -> u64 {
        self.world.statistics().steps
    }

    fn events(&self) -> Option<u64> {
        Some(self.world.statistics().impacts)
    }

    fn penetration(&mut self) -> f64 {
        self.world.statistics().smallest_gap.map_or(0.0, |gap| (-gap).max(0.0))
    }
}
