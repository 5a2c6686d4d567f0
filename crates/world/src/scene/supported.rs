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
    for (index, pair) in scene.pairs.iter().enumerate() {
        let fields = [
            ("friction", pair.friction, "friction"),
            ("static_friction", pair.static_friction, "friction"),
            ("rolling_resistance", pair.rolling_resistance, "rolling resistance"),
        ];
        check_resistance(fields, &scene.run, &top.field("pair").element(index))?;
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

/// Refuses what the strategy of the scene does not know of.
fn check_body(body: &BodyData, run: &RunData, at: &FieldPath) -> Result<(), SceneError> {
    let fields = [
        ("friction", Some(body.friction), "friction"),
        ("static_friction", body.static_friction, "friction"),
        ("rolling_resistance", Some(body.rolling_resistance), "rolling resistance"),
    ];
    check_resistance(fields, run, at)
}

/// Refuses coefficients of friction and the like, each with its field and its name, where events have no forces for them.
fn check_resistance(
    fields: [(&str, Option<f64>, &str); 3],
    run: &RunData,
    at: &FieldPath,
) -> Result<(), SceneError> {
    let projects = run.contacts && run.stabilization.unwrap_or_default() == Stabilization::Projection;
    let given = fields.into_iter().find(|(_, coefficient, _)| coefficient.is_some_and(|c| c > 0.0));
    let Some((given, _, what)) = given.filter(|_| run.strategy == StrategyData::Events && !projects) else {
        return Ok(());
    };
    let field = if run.contacts { "stabilization" } else { "contacts" };
    let message = format!(
        "{what} needs contacts that carry forces and are projected: leave `{field}` out of `[run]`, or set `strategy` to `steps`"
    );
    Err(SceneError::new(at.field(given), message))
}
