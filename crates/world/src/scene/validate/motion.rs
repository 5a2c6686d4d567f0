//! Checks prescribed motions.

use super::{At, optional};
use crate::scene::error::SceneError;
use crate::scene::motion::BadTable;
use crate::scene::{BodyData, BodyTableData, DriveData, MotionData, RunData};

/// Checks the motion of a body.
pub(super) fn validate(
    motion: &MotionData,
    body: &BodyData,
    run: &RunData,
    at: &At<'_>,
) -> Result<(), SceneError> {
    if !body.fixed {
        return Err(at.error("only a fixed body is moved: give it `fixed = true`, or a `velocity` instead"));
    }
    validate_form(motion, at)?;
    optional(motion.velocity, |velocity| at.field("velocity").finite_point(velocity))?;
    optional(motion.angular_velocity, |spin| at.field("angular_velocity").finite(spin))?;
    if let Some(oscillate) = &motion.oscillate {
        let at = at.field("oscillate");
        at.field("amplitude").finite_point(oscillate.amplitude)?;
        at.field("angle").finite(oscillate.angle)?;
        at.field("frequency").finite(oscillate.frequency)?;
        at.field("phase").finite(oscillate.phase)?;
    }
    if let Some(table) = &motion.table {
        let at = at.field("table");
        validate_places(table, &at)?;
        motion.to_motion().map_err(|bad| no_law(bad, &at))?;
        cover(&table.times, table.periodic, run, &at)?;
    }
    Ok(())
}

/// Checks the motion of a driven coordinate.
pub(super) fn validate_drive(drive: &DriveData, run: &RunData, at: &At<'_>) -> Result<(), SceneError> {
    validate_law(drive, at)?;
    let DriveData::Table(table) = drive else { return Ok(()) };
    cover(&table.times, table.periodic, run, &at.field(drive.key()))
}

/// Checks the lift of a cam, whose time is the share of a turn.
pub(super) fn validate_lift(lift: &DriveData, at: &At<'_>) -> Result<(), SceneError> {
    validate_law(lift, at)?;
    let DriveData::Table(table) = lift else { return Ok(()) };
    let (Some(&first), Some(&last)) = (table.times.first(), table.times.last()) else { return Ok(()) };
    if table.periodic || (first <= 0.0 && 1.0 <= last) {
        return Ok(());
    }
    let message = format!("go from {first} to {last}, but a turn from 0 to 1");
    Err(at.field(lift.key()).field("times").error(message))
}

/// Checks the numbers of a motion, and that they make a law.
fn validate_law(drive: &DriveData, at: &At<'_>) -> Result<(), SceneError> {
    let at = at.field(drive.key());
    match drive {
        DriveData::Speed(speed) => at.finite(*speed),
        DriveData::Oscillate(oscillate) => {
            at.field("amplitude").finite(oscillate.amplitude)?;
            at.field("frequency").finite(oscillate.frequency)?;
            at.field("phase").finite(oscillate.phase)
        }
        DriveData::Table(table) => {
            validate_numbers(&table.times, &at.field("times"))?;
            validate_numbers(&table.values, &at.field("values"))?;
            drive.to_law().map(|_| ()).map_err(|bad| no_law(bad, &at))
        }
    }
}

/// Refuses a motion that has not exactly one form.
fn validate_form(motion: &MotionData, at: &At<'_>) -> Result<(), SceneError> {
    let forms = [
        ("velocity", motion.velocity.is_some()),
        ("angular_velocity", motion.angular_velocity.is_some()),
        ("oscillate", motion.oscillate.is_some()),
        ("table", motion.table.is_some()),
    ];
    let mut given = forms.into_iter().filter(|(_, is_given)| *is_given).map(|(form, _)| form);
    match (given.next(), given.next_back()) {
        (None, _) => Err(at.error(
            "tells no motion: give `velocity` and `angular_velocity`, or one of them, or `oscillate`, or `table`",
        )),
        (Some(one), Some(other @ ("oscillate" | "table"))) => {
            Err(at.field(other).error(format!("give `{one}` or `{other}`, not both")))
        }
        _ => Ok(()),
    }
}

fn validate_places(table: &BodyTableData, at: &At<'_>) -> Result<(), SceneError> {
    if table.positions.is_none() && table.angles.is_none() {
        return Err(at.error("tells no motion: give `positions`, `angles`, or both"));
    }
    validate_numbers(&table.times, &at.field("times"))?;
    for (index, &position) in table.positions.iter().flatten().enumerate() {
        at.field("positions").element(index).finite_point(position)?;
    }
    validate_numbers(table.angles.as_deref().unwrap_or_default(), &at.field("angles"))
}

fn validate_numbers(numbers: &[f64], at: &At<'_>) -> Result<(), SceneError> {
    numbers.iter().enumerate().try_for_each(|(index, &number)| at.element(index).finite(number))
}

fn no_law((field, error): BadTable, at: &At<'_>) -> SceneError {
    at.field(field).error(error.to_string())
}

/// Refuses a table that neither repeats nor covers the run.
fn cover(times: &[f64], periodic: bool, run: &RunData, at: &At<'_>) -> Result<(), SceneError> {
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else { return Ok(()) };
    let (start, end) = (run.start_time, run.end_time());
    if periodic || (first <= start && end <= last) {
        return Ok(());
    }
    let message = format!(
        "go from {first} s to {last} s, but the run from {start} s to {end} s: a table that is not `periodic` must cover it"
    );
    Err(at.field("times").error(message))
}
