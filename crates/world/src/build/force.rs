//! The force laws of a scene. Each is named after its field: "force[2].spring".

use super::{find_body, mass};
use crate::builder::WorldBuilder;
use crate::force::{
    Anchor, ConstantForce, Dashpot, ForceFrame, MutualGravity, RotatingForce, Spring, Turning,
};
use crate::scene::{
    self, BodyData, ConstantData, FieldPath, ForceData, MutualGravityData, PointData, RotatingData, Scene,
    SceneError, SpringData,
};
use halfgap_collision::BodyId;
use std::sync::Arc;

/// Adds a law; all bodies have been added before, in the order of the scene.
pub(super) fn add(
    builder: &mut WorldBuilder,
    scene: &Scene,
    (index, force): (usize, &ForceData),
) -> Result<(), SceneError> {
    let field = FieldPath::top().field("force").element(index).field(force.key());
    match force {
        ForceData::Gravity(gravity) => {
            for (body, _) in bodies_of(scene, force) {
                builder.add_gravity(body, gravity.acceleration.into());
            }
        }
        ForceData::Damping(damping) => {
            for (body, _) in bodies_of(scene, force) {
                builder.add_damping(body, damping.linear, damping.angular);
            }
        }
        ForceData::MutualGravity(mutual) => {
            let law = mutual_gravity(builder, (scene, force), mutual, &field)?;
            builder.add_force(Arc::new(law));
        }
        ForceData::Spring(spring) => add_spring(builder, scene, spring, &field),
        ForceData::Constant(constant) => {
            let law = constant_force(builder, scene, constant, &field);
            builder.add_force(Arc::new(law));
        }
        ForceData::Rotating(rotating) => {
            let law = rotating_force(builder, scene, rotating, &field);
            builder.add_force(Arc::new(law));
        }
    }
    Ok(())
}

/// The bodies on which a law acts: those that it names, else all.
fn bodies_of<'a>(
    scene: &'a Scene,
    force: &'a ForceData,
) -> impl Iterator<Item = (BodyId, &'a BodyData)> + 'a {
    let acts_on = |body: &BodyData| force.bodies().is_none_or(|names| names.contains(&body.name));
    let numbered = scene.bodies.iter().enumerate().map(|(index, body)| (BodyId::from_index(index), body));
    numbered.filter(move |(_, body)| acts_on(body))
}

/// A fixed body attracts with the mass that it is given; without one it takes no part.
fn mutual_gravity(
    builder: &WorldBuilder,
    (scene, force): (&Scene, &ForceData),
    mutual: &MutualGravityData,
    field: &FieldPath,
) -> Result<MutualGravity, SceneError> {
    let (mut movable, mut fixed) = (Vec::new(), Vec::new());
    for (id, body) in bodies_of(scene, force) {
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

fn add_spring(builder: &mut WorldBuilder, scene: &Scene, spring: &SpringData, field: &FieldPath) {
    let ends = [&spring.a, &spring.b].map(|end| anchor(builder, scene, end));
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
    scene: &Scene,
    constant: &ConstantData,
    field: &FieldPath,
) -> ConstantForce {
    let body = find_body(scene, &constant.body);
    let (frame, point) = match constant.frame {
        scene::ForceFrame::Body => (ForceFrame::Body, builder.anchor(body, constant.point.into()).point),
        scene::ForceFrame::World => (ForceFrame::World, constant.point.into()),
    };
    ConstantForce::new(field.to_string(), body, frame, [point, constant.force.into()], constant.torque)
}

fn rotating_force(
    builder: &WorldBuilder,
    scene: &Scene,
    rotating: &RotatingData,
    field: &FieldPath,
) -> RotatingForce {
    let at = builder.anchor(find_body(scene, &rotating.body), rotating.point.into());
    let turning = Turning {
        magnitude: rotating.magnitude,
        rate: rotating.rate,
        phase: rotating.phase,
        start: scene.run.start_time,
    };
    RotatingForce::new(field.to_string(), at, turning)
}

pub(super) fn anchor(builder: &WorldBuilder, scene: &Scene, end: &PointData) -> Anchor {
    builder.anchor(find_body(scene, &end.body), end.point.into())
}
