//! Fields of the format that are not simulated yet: refused, never ignored.

use super::error::SceneError;
use super::field_path::FieldPath;
use super::{BodyData, RunData, Scene, StrategyData};
use crate::settings::Stabilization;

/// Refuses the first field of the scene that is not supported yet.
pub(super) fn check_supported(scene: &Scene) -> Result<(), SceneError> {
    let top = FieldPath::top();
    check_run(&scene.run, &top.field("run"))?;
    for (index, body) in scene.bodies.iter().enumerate() {
        check_body(body, &scene.run, &top.field("body").element(index))?;
    }
    Ok(())
}

/// Refuses what steps do not know yet.
fn check_run(run: &RunData, at: &FieldPath) -> Result<(), SceneError> {
    if run.strategy == StrategyData::Events {
        return Ok(());
    }
    if !run.contacts {
        let message =
            "steps know no contacts without forces: leave `contacts` out, or set `strategy` to `events`";
        return Err(SceneError::new(at.field("contacts"), message.to_owned()));
    }
    Ok(())
}

/// Refuses what only steps know of, where the scene advances by events, and motions that are none of a constant velocity.
fn check_body(body: &BodyData, run: &RunData, at: &FieldPath) -> Result<(), SceneError> {
    if let Some(motion) = &body.motion {
        let others = [("oscillate", motion.oscillate.is_some()), ("table", motion.table.is_some())];
        if let Some((field, _)) = others.into_iter().find(|&(_, is_given)| is_given) {
            return Err(unsupported(
                at.field("motion").field(field),
                "a motion other than at constant velocities is",
            ));
        }
    }
    if run.strategy == StrategyData::Steps {
        return Ok(());
    }
    let is_rough = body.friction > 0.0 || body.static_friction.is_some_and(|friction| friction > 0.0);
    let projects = run.stabilization.unwrap_or_default() == Stabilization::Projection;
    if is_rough && !(run.contacts && projects) {
        let field = if run.contacts { "stabilization" } else { "contacts" };
        let message = format!(
            "friction needs contacts that carry forces and are projected: leave `{field}` out of `[run]`, or set `strategy` to `steps`"
        );
        return Err(SceneError::new(
            at.field(if body.friction > 0.0 { "friction" } else { "static_friction" }),
            message,
        ));
    }
    let fields = [
        ("rolling_resistance", body.rolling_resistance > 0.0, "rolling resistance"),
        ("motion", body.motion.is_some(), "a fixed body that moves"),
    ];
    match fields.into_iter().find(|&(_, is_given, _)| is_given) {
        Some((field, _, what)) => {
            let message =
                format!("{what} is not supported by events yet: set `strategy` to `steps` in `[run]`");
            Err(SceneError::new(at.field(field), message))
        }
        None => Ok(()),
    }
}

fn unsupported(field: FieldPath, what: &str) -> SceneError {
    SceneError::new(field, format!("{what} not supported yet"))
}
