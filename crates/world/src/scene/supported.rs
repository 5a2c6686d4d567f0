//! Fields of the format that are not simulated yet: refused, never ignored.

use super::error::SceneError;
use super::field_path::FieldPath;
use super::{BodyData, RunData, Scene, StrategyData};

/// Refuses the first field of the scene that is not supported yet.
pub(super) fn check_supported(scene: &Scene) -> Result<(), SceneError> {
    let top = FieldPath::top();
    check_run(&scene.run, &top.field("run"))?;
    for (index, body) in scene.bodies.iter().enumerate() {
        check_body(body, &top.field("body").element(index))?;
    }
    Ok(())
}

fn check_run(run: &RunData, at: &FieldPath) -> Result<(), SceneError> {
    match run.strategy {
        StrategyData::Events => Ok(()),
        StrategyData::Steps => Err(unsupported(at.field("strategy"), "the strategy \"steps\" is")),
    }
}

fn check_body(body: &BodyData, at: &FieldPath) -> Result<(), SceneError> {
    if body.friction > 0.0 {
        return Err(unsupported(at.field("friction"), "friction is"));
    }
    Ok(())
}

fn unsupported(field: FieldPath, what: &str) -> SceneError {
    SceneError::new(field, format!("{what} not supported yet"))
}
