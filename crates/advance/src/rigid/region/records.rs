//! Records of a region, measured anew.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::gaps::gap_at;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::touching::Region;
use crate::time::Time;
use halfgap_collision::{BodyId, Collision, Detector, GapState, Moving};
use halfgap_geometry::GapSample;

/// Rate of the gap of a record [m/s] by the bodies' motion at a time; the bodies must still be where it was
/// measured.
pub(crate) fn rate_of(assembly: &Assembly, record: &Collision, time: Time) -> f64 {
    let of_two =
        rate_along(assembly, record, &record.motion.kinematics.jacobian, time) + record.motion.prescribed;
    match record.parties.third {
        Some((body, j)) => of_two + j * assembly.moving_at(body, time).angular_velocity,
        None => of_two,
    }
}

/// Rate [m/s] of what has given coefficients by the velocities of a record's two bodies at a time.
pub(crate) fn rate_along(assembly: &Assembly, record: &Collision, j: &[f64; 6], time: Time) -> f64 {
    let sides = record.bodies();
    let of_side = |(side, body): (usize, BodyId)| {
        let Moving { velocity, angular_velocity, .. } = assembly.moving_at(body, time);
        j[3 * side] * velocity.x + j[3 * side + 1] * velocity.y + j[3 * side + 2] * angular_velocity
    };
    sides.into_iter().enumerate().map(of_side).sum()
}

/// Updates a record to the bodies' present motion at a time.
fn remeasure_record(assembly: &Assembly, connectors: &Connectors, record: &mut Collision, time: Time) {
    if let Detector::Connector { id, row } = record.parties.detector {
        return connectors.remeasure_connector(assembly, record, id, row, time);
    }
    let sides = [record.parties.primary, record.parties.normal];
    let (Some(primary), Some(normal)) = (sides[0].feature(), sides[1].feature()) else { return };
    let moving = sides.map(|side| assembly.moving_at(side.body, time));
    let shape = |side: usize| &assembly.trajectory(sides[side].body).body().shape;
    let (primary, normal) = (shape(0).feature(primary), shape(1).feature(normal));
    let sample = GapSample::measure(primary, &moving[0].pose, normal, &moving[1].pose);
    if let Some(sample) = sample {
        debug_assert!(sample.primary_is_a, "records have their primary first");
        let measured = (&sample, [primary.radius(), normal.radius()]);
        record.update(measured, [&moving[0], &moving[1]], time.seconds());
    }
}

/// Updates the records to the bodies' present motion at a time.
pub(crate) fn remeasure(assembly: &Assembly, connectors: &Connectors, region: &mut Region, time: Time) {
    for record in &mut region.records {
        remeasure_record(assembly, connectors, record, time);
    }
}

/// Gap at a time of the contact, rope or stop that fires an event; `None` for other causes.
pub(crate) fn gap_of_cause(
    assembly: &Assembly,
    connectors: &Connectors,
    cause: Cause,
    time: Time,
) -> Option<GapState> {
    match cause {
        Cause::Fired(touch) => Some(gap_at(assembly, touch, time)),
        Cause::Taut(id) => {
            let sample = connectors.measure_connector(assembly, id, 0, time);
            Some(GapState::of_rope(&sample, &assembly.settings().tolerances))
        }
        _ => None,
    }
}

/// Gap [m] at which the search saw the contact, rope or stop that fires an event, whose region was collected at a time:
/// that of the first detection in the record of the contact. It is measured where a record of the same place stands for
/// that one.
pub(crate) fn seen_gap_of_cause(
    assembly: &Assembly,
    connectors: &Connectors,
    region: &Region,
    time: Time,
) -> Option<f64> {
    let fired = region.cause.fired();
    let mut records = region.records.iter();
    let record = records.find(|record| fired.is_some() && Touch::of(record) == fired);
    match record {
        Some(record) => Some(record.detection().distance),
        None => gap_of_cause(assembly, connectors, region.cause, time).map(|gap| gap.distance),
    }
}
