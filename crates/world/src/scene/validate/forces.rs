//! Checks the force laws.

use super::{At, Names, each, optional};
use crate::scene::error::SceneError;
use crate::scene::{ConstantData, ForceData, PushData, RotatingData, SpringData, TorsionSpringData};

pub(super) fn validate(force: &ForceData, names: &Names<'_>, at: &At<'_>) -> Result<(), SceneError> {
    let at = at.field(force.key());
    match force {
        ForceData::Gravity(gravity) => at.field("acceleration").finite_point(gravity.acceleration)?,
        ForceData::Damping(damping) => {
            at.field("linear").not_negative(damping.linear, "N s/m")?;
            at.field("angular").not_negative(damping.angular, "N m s")?;
        }
        ForceData::MutualGravity(mutual) => at.field("strength").finite(mutual.strength)?,
        ForceData::Spring(spring) => validate_spring(spring, names, &at)?,
        ForceData::Constant(constant) => validate_constant(constant, names, &at)?,
        ForceData::Rotating(rotating) => validate_rotating(rotating, names, &at)?,
        ForceData::Push(push) => validate_push(push, names, &at)?,
        ForceData::TorsionSpring(spring) => validate_torsion_spring(spring, names, &at)?,
    }
    if let Some(vary) = force.vary() {
        let field = at.field("vary");
        vary.to_vary().map_err(|error| field.field(vary.key()).error(error.to_string()))?;
    }
    each(&at.field("bodies"), force.bodies().unwrap_or_default(), |name, at| names.require(name, at))
}

fn validate_spring(spring: &SpringData, names: &Names<'_>, at: &At<'_>) -> Result<(), SceneError> {
    names.require_point(&spring.a, &at.field("a"))?;
    names.require_point(&spring.b, &at.field("b"))?;
    names.require_apart(&spring.a, &spring.b, at)?;
    at.field("rest_length").not_negative(spring.rest_length, "m")?;
    at.field("stiffness").not_negative(spring.stiffness, "N/m")?;
    at.field("damping").not_negative(spring.damping, "N s/m")
}

fn validate_constant(constant: &ConstantData, names: &Names<'_>, at: &At<'_>) -> Result<(), SceneError> {
    names.require(&constant.body, &at.field("body"))?;
    at.field("point").finite_point(constant.point)?;
    at.field("force").finite_point(constant.force)?;
    at.field("torque").finite(constant.torque)
}

fn validate_rotating(rotating: &RotatingData, names: &Names<'_>, at: &At<'_>) -> Result<(), SceneError> {
    names.require(&rotating.body, &at.field("body"))?;
    at.field("point").finite_point(rotating.point)?;
    at.field("magnitude").finite(rotating.magnitude)?;
    at.field("rate").finite(rotating.rate)?;
    at.field("phase").finite(rotating.phase)
}

fn validate_push(push: &PushData, names: &Names<'_>, at: &At<'_>) -> Result<(), SceneError> {
    names.require(&push.body, &at.field("body"))?;
    optional(push.point, |point| at.field("point").finite_point(point))?;
    at.field("force").finite_point(push.force)?;
    at.field("torque").finite(push.torque)
}

fn validate_torsion_spring(
    spring: &TorsionSpringData,
    names: &Names<'_>,
    at: &At<'_>,
) -> Result<(), SceneError> {
    names.require_or_world(&spring.a, &at.field("a"))?;
    names.require_or_world(&spring.b, &at.field("b"))?;
    if spring.a == spring.b {
        return Err(at.error(format!("ties {:?} to itself; `a` and `b` must be two bodies", spring.a)));
    }
    at.field("rest_angle").finite(spring.rest_angle)?;
    at.field("stiffness").not_negative(spring.stiffness, "N m/rad")?;
    at.field("damping").not_negative(spring.damping, "N m s/rad")
}
