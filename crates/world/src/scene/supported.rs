//! What the format knows but the program does not simulate yet: refused, never ignored.

use super::error::SceneError;
use super::field_path::FieldPath;
use super::force::ForceData;
use super::run_data::{Integrator, RunData, Stabilization};
use super::{BodyData, Scene};

/// Refuses the first field of the scene that is not supported yet.
pub(super) fn check_supported(scene: &Scene) -> Result<(), SceneError> {
    let top = FieldPath::top();
    check_run(&scene.run, &top.field("run"))?;
    for (index, body) in scene.bodies.iter().enumerate() {
        check_body(body, &top.field("body").element(index))?;
    }
    if let Some(connector) = scene.connectors.first() {
        let field = top.field("connector").element(0).field(connector.key());
        return Err(unsupported(field, "connectors are"));
    }
    for (index, force) in scene.forces.iter().enumerate() {
        check_force(force, &top.field("force").element(index))?;
    }
    Ok(())
}

fn check_run(run: &RunData, at: &FieldPath) -> Result<(), SceneError> {
    if !matches!(run.integrator, None | Some(Integrator::Dop853)) {
        return Err(unsupported(at.field("integrator"), "integrators other than \"dop853\" are"));
    }
    if !matches!(run.stabilization, None | Some(Stabilization::Projection)) {
        return Err(unsupported(at.field("stabilization"), "stabilization other than \"projection\" is"));
    }
    if run.joint_small_impacts {
        return Err(unsupported(at.field("joint_small_impacts"), "small impacts at joints are"));
    }
    Ok(())
}

fn check_body(body: &BodyData, at: &FieldPath) -> Result<(), SceneError> {
    if body.friction > 0.0 {
        return Err(unsupported(at.field("friction"), "friction is"));
    }
    Ok(())
}

fn check_force(force: &ForceData, at: &FieldPath) -> Result<(), SceneError> {
    match force {
        _ => Ok(()),
    }
}

fn unsupported(field: FieldPath, what: &str) -> SceneError {
    SceneError::new(field, format!("{what} not supported yet"))
}
