//! Checks the table `[run]`.

use super::{At, optional};
use crate::scene::error::SceneError;
use crate::scene::{RunData, Scene};

/// Largest number of recorded times; more are taken for a mistake.
const MOST_OUTPUTS: f64 = 1e7;
/// Largest number of states of bodies that a recording may hold: with the forces of their contacts some gigabytes.
/// Those of 100,000 bodies at the default number of times fit.
const MOST_STATES: f64 = 5e7;
/// Factor on the least step that is advised, for the rounding of its digits.
const ADVICE: f64 = 1.01;

pub(super) fn validate(run: &RunData, at: &At<'_>) -> Result<(), SceneError> {
    at.field("duration").positive(run.duration, "s")?;
    at.field("start_time").finite(run.start_time)?;
    if run.end_time() <= run.start_time || !run.end_time().is_finite() {
        let (start, duration) = (run.start_time, run.duration);
        let message = format!("is lost in rounding: {start} s + {duration} s is {} s", run.end_time());
        return Err(at.field("duration").error(message));
    }
    optional(run.output_step, |step| {
        let at = at.field("output_step");
        at.positive(step, "s")?;
        let outputs = run.duration / step;
        let message = format!("would record {outputs:.0} states, at most {MOST_OUTPUTS} are allowed");
        if outputs <= MOST_OUTPUTS { Ok(()) } else { Err(at.error(message)) }
    })?;
    optional(run.tolerance, |value| tolerance(value, &at.field("tolerance")))?;
    optional(run.target_gap, |gap| at.field("target_gap").positive(gap, "m"))?;
    optional(run.velocity_tol, |velocity| at.field("velocity_tol").positive(velocity, "m/s"))?;
    optional(run.accuracy, |accuracy| {
        at.field("accuracy").positive(accuracy, "m")?;
        optional(run.target_gap, |gap| at.field("accuracy").below(accuracy, gap, "target_gap", "m"))
    })?;
    optional(run.time_step, |step| at.field("time_step").positive(step, "s"))?;
    optional(run.start_overlap, |depth| at.field("start_overlap").not_negative(depth, "m"))?;
    optional(run.start_connector_error, |error| at.field("start_connector_error").not_negative(error, "m"))
}

/// Refuses a recording of more states of bodies than fit into memory.
pub(super) fn validate_recording(scene: &Scene, at: &At<'_>) -> Result<(), SceneError> {
    let run = &scene.run;
    let times = (run.duration / run.output_step_or_default()).ceil() + 1.0;
    let bodies = scene.bodies.iter().filter(|body| !body.fixed).count();
    let states = times * bodies as f64;
    if states <= MOST_STATES {
        return Ok(());
    }
    let step = ADVICE * run.duration * bodies as f64 / MOST_STATES;
    Err(at.field("output_step").error(format!(
        "would record {states:.0} states, of {bodies} bodies at {times:.0} times; at most {MOST_STATES} are allowed, as \
         with an `output_step` of {step:.2e} s"
    )))
}

fn tolerance(value: f64, at: &At<'_>) -> Result<(), SceneError> {
    at.positive(value, "")?;
    at.zero_to_one(value)
}
