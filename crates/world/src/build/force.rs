//! The force laws of a scene. The name of each is the path of its field: "force[2].spring".

use super::bodies::Bodies;
use super::mass;
use crate::builder::WorldBuilder;
use crate::force::{
    Anchor, ConstantForce, Dashpot, ForceFrame, MutualGravity, Push, RotatingForce, Spring, Turning,
};
use crate::scene::{
    ConstantData, FieldPath, ForceData, MutualGravityData, PointData, RotatingData, SceneError, SpringData,
};
use std::sync::Arc;

/// Adds a law; all bodies have been added before, in the order of the scene.
pub(super) fn add(
    builder: &mut WorldBuilder,
    bodies: &Bodies<'_>,
    (index, force): (usize, &ForceData),
) -> Result<(), SceneError> {
    let field = FieldPath::top().field("force").element(index).field(force.key());
    match force {
        ForceData::Gravity(gravity) => {
            for (body, _) in bodies.acted_on(force) {
                builder.add_gravity(body, gravity.acceleration.into());
            }
        }
        ForceData::Damping(damping) => {
            for (body, _) in bodies.acted_on(force) {
                builder.add_damping(body, damping.linear, damping.angular);
            }
        }
        ForceData::MutualGravity(mutual) => {
            let law = mutual_gravity(builder, (bodies, force), mutual, &field)?;
            builder.add_force(Arc::new(law));
        }
        ForceData::Spring(spring) => add_spring(builder, bodies, spring, &field),
        ForceData::Constant(constant) => {
            let law = constant_force(builder, bodies, constant, &field);
            builder.add_force(Arc::new(law));
        }
        ForceData::Rotating(rotating) => {
            let law = rotating_force(builder, bodies, rotating, &field);
            builder.add_force(Arc::new(law));
        }
    }
    Ok(())
}

/// Makes the law. A fixed body attracts with its given mass; without one it takes no part, or is refused if it is
/// named.
fn mutual_gravity(
    builder: &WorldBuilder,
    (bodies, force): (&Bodies<'_>, &ForceData),
    mutual: &MutualGravityData,
    field: &FieldPath,
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
    Ok(MutualGravity::new(field.to_string(), mutual.strength, &movable, &fixed))
}

fn add_spring(builder: &mut WorldBuilder, bodies: &Bodies<'_>, spring: &SpringData, field: &FieldPath) {
    let ends = [&spring.a, &spring.b].map(|end| anchor(builder, bodies, end));
    if spring.stiffness > 0.0 {
        let law = Spring::new(field.to_string(), ends, spring.rest_length, spring.stiffness);
        builder.add_force(Arc::new(law));
    }
    if spring.damping > 0.0 {
        let law = Dashpot::new(field.field("damping").to_string(), ends, spring.damping);
        builder.add_force(Arc::new(law));
    }
}

fn constant_force(
    builder: &WorldBuilder,
    bodies: &Bodies<'_>,
    constant: &ConstantData,
    field: &FieldPath,
) -> ConstantForce {
    let body = bodies.find(&constant.body);
    let point = match constant.frame {
        ForceFrame::Body => builder.anchor(body, constant.point.into()).point,
        ForceFrame::World => constant.point.into(),
    };
    let push = Push { frame: constant.frame, point, force: constant.force.into(), torque: constant.torque };
    ConstantForce::new(field.to_string(), body, push)
}

fn rotating_force(
    builder: &WorldBuilder,
    bodies: &Bodies<'_>,
    rotating: &RotatingData,
    field: &FieldPath,
) -> RotatingForce {
    let at = builder.anchor(bodies.find(&rotating.body), rotating.point.into());
    let turning = Turning {
        magnitude: rotating.magnitude,
        rate: rotating.rate,
        phase: rotating.phase,
        start: bodies.scene.run.start_time,
    };
    RotatingForce::new(field.to_string(), at, turning)
}

pub(super) fn anchor(builder: &WorldBuilder, bodies: &Bodies<'_>, end: &PointData) -> Anchor {
    builder.anchor(bodies.find(&end.body), end.point.into())
}
