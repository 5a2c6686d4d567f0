//! Checks the expected states.

use super::{At, Names, optional};
use crate::scene::error::SceneError;
use crate::scene::{ExpectedData, ExpectedState, RunData};

/// Rounding by which an expected time may be beyond the end, as a fraction of the largest of start, end and duration.
const TIME_ROUNDING: f64 = 1e-12;

pub(super) fn validate(
    expected: &ExpectedData,
    run: &RunData,
    names: &Names<'_>,
    at: &At<'_>,
) -> Result<(), SceneError> {
    validate_time(expected.time, run, &at.field("time"))?;
    optional(expected.position_tolerance, |value| at.field("position_tolerance").not_negative(value, "m"))?;
    optional(expected.velocity_tolerance, |value| at.field("velocity_tolerance").not_negative(value, "m/s"))?;
    optional(expected.energy_tolerance, |value| at.field("energy_tolerance").not_negative(value, "J"))?;
    optional(expected.energy_change_below, |value| at.field("energy_change_below").finite(value))?;
    optional(expected.energy_change, |value| {
        at.field("energy_change").finite(value)?;
        require_tolerance(expected.energy_tolerance, "energy_tolerance", at)
    })?;
    if let (Some(_), None) = (expected.energy_tolerance, expected.energy_change) {
        return Err(at
            .field("energy_tolerance")
            .error("needs an `energy_change`, of which it is the tolerance"));
    }
    let around = at.field("bodies");
    for (name, state) in &expected.bodies {
        let at = around.field(name);
        names.require(name, &at)?;
        validate_state(state, &at)?;
    }
    validate_tolerances(expected, at)
}

fn validate_time(time: f64, run: &RunData, at: &At<'_>) -> Result<(), SceneError> {
    let (start, end) = (run.start_time, run.end_time());
    let rounding = TIME_ROUNDING * start.abs().max(end.abs()).max(run.duration);
    at.finite(time)?;
    if time < start {
        at.at_least(time, start, "the start time", "s")?;
    }
    if time > end + rounding { at.at_most(time, end, "the end of the run", "s") } else { Ok(()) }
}

fn validate_state(state: &ExpectedState, at: &At<'_>) -> Result<(), SceneError> {
    optional(state.position, |point| at.field("position").finite_point(point))?;
    optional(state.angle, |angle| at.field("angle").finite(angle))?;
    optional(state.velocity, |velocity| at.field("velocity").finite_point(velocity))?;
    optional(state.angular_velocity, |velocity| at.field("angular_velocity").finite(velocity))
}

/// Checks that every kind of expected state has its tolerance.
fn validate_tolerances(expected: &ExpectedData, at: &At<'_>) -> Result<(), SceneError> {
    let states = || expected.bodies.values();
    if states().any(|state| state.position.is_some() || state.angle.is_some()) {
        require_tolerance(expected.position_tolerance, "position_tolerance", at)?;
    }
    if states().any(|state| state.velocity.is_some() || state.angular_velocity.is_some()) {
        require_tolerance(expected.velocity_tolerance, "velocity_tolerance", at)?;
    }
    Ok(())
}

fn require_tolerance(value: Option<f64>, name: &str, at: &At<'_>) -> Result<(), SceneError> {
    if value.is_some() { Ok(()) } else { Err(at.error(format!("missing field `{name}`"))) }
}
