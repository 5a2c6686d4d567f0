//! The force laws of a scene. The name of each that is given none is the path of its field: "force[2].spring".

use super::bodies::Bodies;
use super::mass;
use crate::builder::WorldBuilder;
use crate::force::{
    Anchor, ConstantForce, CoordinateDamper, CoordinateSpring, Dashpot, ForceFrame, ForceLaw, MutualGravity,
    PointForce, PointPush, Push, RotatingForce, Spring, Turning, Varied,
};
use crate::scene::{
    ConstantData, FieldPath, ForceData, MutualGravityData, NamedData, PointData, PushData, RotatingData,
    SceneError, SpringData, TorsionSpringData, VaryData,
};
use glam::DVec2;
use halfgap_collision::Coordinate;
use std::sync::Arc;

/// Adds a law; all bodies have been added before, in the order of the scene.
pub(super) fn add(
    builder: &mut WorldBuilder,
    bodies: &Bodies<'_>,
    (index, named): (usize, &NamedData<ForceData>),
) -> Result<(), SceneError> {
    let force = &named.data;
    let field = FieldPath::top().field("force").element(index).field(force.key());
    let name = named.name.clone().unwrap_or_else(|| field.to_string());
    let laws: Vec<Arc<dyn ForceLaw>> = match force {
        ForceData::Gravity(gravity) => {
            for (body, _) in bodies.acted_on(force) {
                builder.add_gravity(body, gravity.acceleration.into());
            }
            Vec::new()
        }
        ForceData::Damping(damping) => {
            for (body, _) in bodies.acted_on(force) {
                builder.add_damping(body, damping.linear, damping.angular);
            }
            Vec::new()
        }
        ForceData::MutualGravity(mutual) => {
            vec![Arc::new(mutual_gravity(builder, (bodies, force), mutual, (&name, &field))?)]
        }
        ForceData::Spring(spring) => spring_laws(builder, bodies, spring, &name),
        ForceData::Constant(constant) => vec![Arc::new(constant_force(builder, bodies, constant, &name))],
        ForceData::Rotating(rotating) => vec![Arc::new(rotating_force(builder, bodies, rotating, &name))],
        ForceData::Push(push) => vec![Arc::new(point_force(builder, bodies, push, &name))],
        ForceData::TorsionSpring(spring) => torsion_laws(bodies, spring, &name),
    };
    let vary = force.vary().map(VaryData::to_vary).transpose();
    let vary = vary.map_err(|error| SceneError::new(field.field("vary"), error.to_string()))?;
    for law in laws {
        builder.add_force(match &vary {
            Some(vary) => Arc::new(Varied::new(law, vary.clone())),
            None => law,
        });
    }
    Ok(())
}

/// Makes the law. A fixed body attracts with its given mass; without one it takes no part, or is refused if it is
/// named.
fn mutual_gravity(
    builder: &WorldBuilder,
    (bodies, force): (&Bodies<'_>, &ForceData),
    mutual: &MutualGravityData,
    (name, field): (&str, &FieldPath),
) -> Result<MutualGravity, SceneError> {
    let (mut movable, mut fixed) = (Vec::new(), Vec::new());
    for (id, body) in bodies.acted_on(force) {
        match mass(body, &builder.body(id).shape) {
            Some(mass) if body.fixed => fixed.push((id, mass)),
            Some(mass) => movable.push((id, mass)),
            None if mutual.bodies.is_some() => {
                let message = format!("body {:?} is fixed and has no mass to attract with", body.name);
                return Err(SceneError::new(field.field("bodies"), message));
            }
            None => {}
        }
    }
    Ok(MutualGravity::new(name, mutual.strength, &movable, &fixed))
}

fn spring_laws(
    builder: &WorldBuilder,
    bodies: &Bodies<'_>,
    spring: &SpringData,
    name: &str,
) -> Vec<Arc<dyn ForceLaw>> {
    let ends = [&spring.a, &spring.b].map(|end| anchor(builder, bodies, end));
    let mut laws: Vec<Arc<dyn ForceLaw>> = Vec::new();
    if spring.stiffness > 0.0 {
        laws.push(Arc::new(Spring::new(name, ends, spring.rest_length, spring.stiffness)));
    }
    if spring.damping > 0.0 {
        laws.push(Arc::new(Dashpot::new(format!("{name}.damping"), ends, spring.damping)));
    }
    laws
}

fn torsion_laws(bodies: &Bodies<'_>, spring: &TorsionSpringData, name: &str) -> Vec<Arc<dyn ForceLaw>> {
    let [a, b] = [&spring.a, &spring.b].map(|name| bodies.find(name));
    let angle = Coordinate::angle(a, b);
    let mut laws: Vec<Arc<dyn ForceLaw>> = Vec::new();
    if spring.stiffness > 0.0 {
        laws.push(Arc::new(CoordinateSpring::new(name, angle, spring.rest_angle, spring.stiffness)));
    }
    if spring.damping > 0.0 {
        laws.push(Arc::new(CoordinateDamper::new(format!("{name}.damping"), angle, spring.damping)));
    }
    laws
}

fn point_force(builder: &WorldBuilder, bodies: &Bodies<'_>, push: &PushData, name: &str) -> PointForce {
    let body = bodies.find(&push.body);
    let point = push.point.map_or(DVec2::ZERO, |point| builder.anchor(body, point.into()).point);
    let (force, frame, torque) = (push.force.into(), push.frame, push.torque);
    PointForce::new(name, body, PointPush { point, force, frame, torque })
}

fn constant_force(
    builder: &WorldBuilder,
    bodies: &Bodies<'_>,
    constant: &ConstantData,
    name: &str,
) -> ConstantForce {
    let body = bodies.find(&constant.body);
    let point = match constant.frame {
        ForceFrame::Body => builder.anchor(body, constant.point.into()).point,
        ForceFrame::World => constant.point.into(),
    };
    let push = Push { frame: constant.frame, point, force: constant.force.into(), torque: constant.torque };
    ConstantForce::new(name, body, push)
}

fn rotating_force(
    builder: &WorldBuilder,
    bodies: &Bodies<'_>,
    rotating: &RotatingData,
    name: &str,
) -> RotatingForce {
    let at = builder.anchor(bodies.find(&rotating.body), rotating.point.into());
    let turning = Turning {
        magnitude: rotating.magnitude,
        rate: rotating.rate,
        phase: rotating.phase,
        start: bodies.scene.run.start_time,
    };
    RotatingForce::new(name, at, turning)
}

pub(super) fn anchor(builder: &WorldBuilder, bodies: &Bodies<'_>, end: &PointData) -> Anchor {
    builder.anchor(bodies.find(&end.body), end.point.into())
}
