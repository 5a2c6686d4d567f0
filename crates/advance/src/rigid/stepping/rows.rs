//! The contacts of a step, as rows of its problems.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::rows::row_of;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::region::touching::Region;
use crate::rigid::shares::WAY_OF_A_STEP;
use crate::rigid::zeno::stepped::Pressed;
use halfgap_collision::{BodyAcceleration, Collision};

/// A contact of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepRow {
    /// Index of its record in the region.
    pub(crate) record: usize,
    pub(crate) touch: Touch,
    /// Places of its primary and its normal body; that of what cannot move is behind the last.
    pub(crate) places: [usize; 2],
    /// Coefficients of the velocities of both bodies.
    pub(crate) jacobian: [f64; 6],
    /// Change of these velocities by a unit of impulse.
    pub(crate) response: [f64; 6],
    /// Change of the rate by a unit of impulse [1/kg].
    pub(crate) compliance: f64,
    /// Gap above its target [m].
    pub(crate) gap: f64,
    /// Acceleration of the gap [m/s^2] at constant velocities, as long as the contact stays on its features.
    pub(crate) bend: f64,
    /// Speed at which the contact runs along an arc, in sizes of the smaller body [1/s].
    pub(crate) running: f64,
    pub(crate) elasticity: f64,
    /// Speed [m/s] at which it closed as the last step began, or closes now if it was in none.
    pub(crate) approach: f64,
    /// It is between what touches or has pressed: its rate must not close.
    pub(crate) touches: bool,
    /// Impulse [N s] in the last step, if it pressed there.
    pub(crate) pressed: Option<f64>,
    /// Impulse [N s] that stops it before the step.
    pub(crate) stopped_by: f64,
    /// It takes part in the problem that is being solved.
    pub(crate) acts: bool,
    /// Impulse before the present sweep, and change of it along which the next one begins.
    pub(crate) before: f64,
    pub(crate) direction: f64,
    /// Impulse of the step, while displacements are found.
    pub(crate) kept: f64,
    /// Impulse, or displacement, of the problem that is being solved.
    pub(crate) impulse: f64,
    /// The rate must be at least the opposite of this.
    pub(crate) offset: f64,
    /// Place of its slip, if it has friction.
    pub(crate) slip: Option<u32>,
}

impl StepRow {
    /// Acceleration of the gap [m/s^2] in a step of a length `span` [s]. A contact of a nearly straight arc that soon runs off its
    /// features bends for an instant only.
    pub(crate) fn bend_within(&self, span: f64) -> f64 {
        if self.running * span <= WAY_OF_A_STEP { self.bend } else { 0.0 }
    }

    /// Rate [m/s] of its gap at given velocities.
    #[inline]
    pub(crate) fn rate(&self, velocities: &[[f64; 3]]) -> f64 {
        rate_along(self.places, &self.jacobian, velocities)
    }

    /// Adds what an impulse changes to the velocities.
    #[inline]
    pub(crate) fn push(&self, velocities: &mut [[f64; 3]], impulse: f64) {
        push_along(self.places, &self.response, velocities, impulse);
    }
}

/// Rate [m/s] along a Jacobian of the bodies at two places.
#[inline]
pub(super) fn rate_along(places: [usize; 2], j: &[f64; 6], velocities: &[[f64; 3]]) -> f64 {
    let [[x, y, turn], [u, v, spin]] = places.map(|place| velocities[place]);
    j[0] * x + j[1] * y + j[2] * turn + j[3] * u + j[4] * v + j[5] * spin
}

/// Adds a multiple of a response to the velocities of the bodies at two places.
#[inline]
pub(super) fn push_along(places: [usize; 2], response: &[f64; 6], velocities: &mut [[f64; 3]], impulse: f64) {
    for (side, place) in places.into_iter().enumerate() {
        for (k, velocity) in velocities[place].iter_mut().enumerate() {
            *velocity += response[3 * side + k] * impulse;
        }
    }
}

/// Lists the contacts of a region, which was collected for a step, as rows. `pressed` are the contacts that pressed in the steps that end
/// now, sorted; a gap of up to `touching` [m] above the target touches, too.
pub(crate) fn list_rows(
    assembly: &Assembly,
    region: &Region,
    pressed: &[Pressed],
    touching: f64,
    rows: &mut Vec<StepRow>,
) {
    let target_gap = assembly.settings().tolerances.target_gap;
    let still = BodyAcceleration::default();
    let behind = region.bodies().len();
    rows.clear();
    rows.extend(region.records().iter().enumerate().filter_map(|(index, record)| {
        let touch = Touch::of(record)?;
        let row = row_of(assembly, record);
        let compliance = row.coupling(&row);
        let before = pressed.binary_search_by_key(&touch, |before| before.touch).ok().map(|at| pressed[at]);
        let gap = record.geometry.distance - target_gap;
        (compliance > 0.0).then(|| StepRow {
            record: index,
            touch,
            places: row.bodies.map(|body| region.place(body).unwrap_or(behind)),
            jacobian: row.jacobian,
            response: row.response,
            compliance,
            gap,
            bend: record.motion.kinematics.acceleration(&still, &still),
            running: running(assembly, record),
            elasticity: row.elasticity,
            approach: before.map_or(0.0, |before| before.approach),
            pressed: before.map(|before| before.impulse),
            stopped_by: before.map_or(0.0, |before| before.stopped_by),
            touches: before.is_some() || gap <= touching,
            impulse: 0.0,
            acts: false,
            kept: 0.0,
            before: 0.0,
            direction: 0.0,
            offset: 0.0,
            slip: None,
        })
    }));
}

/// Sets the accelerations of gaps at constant velocities to those of the records, measured anew, from which the rows were listed.
pub(crate) fn bend_anew(assembly: &Assembly, region: &Region, rows: &mut [StepRow]) {
    let still = BodyAcceleration::default();
    for row in rows {
        let record = &region.records()[row.record];
        row.bend = record.motion.kinematics.acceleration(&still, &still);
        row.running = running(assembly, record);
    }
}

/// Speed at which a contact runs along an arc of a body, in sizes of the smaller body [1/s]; a disc has no ends.
fn running(assembly: &Assembly, record: &Collision) -> f64 {
    let geometry = &record.geometry;
    let turning = geometry.normal.perp_dot(geometry.normal_rate);
    let sides = record.bodies().into_iter().zip([geometry.radius_primary, geometry.radius_normal]);
    let speeds =
        sides.filter(|&(body, _)| assembly.trajectory(body).disc().is_none()).map(|(body, radius)| {
            let spin = assembly.moving_at(body, assembly.now()).angular_velocity;
            radius.map_or(0.0, |radius| ((turning - spin) * radius).abs())
        });
    let reaches = record.bodies().map(|body| assembly.trajectory(body).reach());
    speeds.fold(0.0, f64::max) / reaches[0].min(reaches[1])
}
