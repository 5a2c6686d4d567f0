//! Friction of the contacts of a step: a row along the tangent, whose impulse is bounded by that along the normal.
//!
//! A contact sticks over a step if its surfaces have no slip in the middle of it; bounds are those of sticking unless it has slipped
//! before.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::friction::slip_of;
use crate::rigid::region::touching::Region;
use crate::rigid::stepping::rows::{StepRow, push_along, rate_along};
use crate::rigid::zeno::stepped::{Dragged, Pressed};
use halfgap_contact::CollisionRow;

/// The slip of a contact of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepSlip {
    /// Coefficients of the velocities of both bodies.
    pub(super) jacobian: [f64; 6],
    /// Change of these velocities by a unit of impulse.
    pub(super) response: [f64; 6],
    /// Change of the slip speed by a unit of impulse [1/kg].
    pub(super) compliance: f64,
    /// Part of the slip speed [m/s] that no velocity changes: that of surfaces which run.
    pub(super) running: f64,
    /// Largest shares [-] of the normal impulse: of a contact that sticks, and of one that slips.
    pub(super) bounds: [f64; 2],
    /// What friction did in the last step, and before this one.
    pub(super) dragged: Dragged,
    /// Impulse of the problem that is being solved.
    pub(super) impulse: f64,
    /// Impulse before the present sweep, and change of it along which the next one begins.
    pub(super) before: f64,
    pub(super) direction: f64,
}

impl StepSlip {
    /// Slip speed [m/s] of the bodies at two places.
    #[inline]
    pub(super) fn speed(&self, places: [usize; 2], velocities: &[[f64; 3]]) -> f64 {
        rate_along(places, &self.jacobian, velocities) + self.running
    }

    /// Adds what an impulse changes to the velocities.
    #[inline]
    pub(super) fn push(&self, places: [usize; 2], velocities: &mut [[f64; 3]], impulse: f64) {
        push_along(places, &self.response, velocities, impulse);
    }

    /// Stops the slip as far as an impulse along the normal allows; returns the change of its speed [m/s].
    pub(super) fn visit(&mut self, places: [usize; 2], velocities: &mut [[f64; 3]], normal: f64) -> f64 {
        let wanted = self.impulse - self.speed(places, velocities) / self.compliance;
        let [sticking, slipping] = self.bounds.map(|bound| bound * normal);
        let bound = if wanted.abs() <= sticking { sticking } else { slipping };
        let change = wanted.clamp(-bound, bound) - self.impulse;
        self.push(places, velocities, change);
        self.impulse += change;
        change.abs() * self.compliance
    }

    /// Notes to which side the bodies at two places slip, faster than a residual [m/s]; true if that was another one in the step before.
    pub(super) fn turns(&mut self, places: [usize; 2], velocities: &[[f64; 3]], residual: f64) -> bool {
        let speed = self.speed(places, velocities);
        let side = if speed.abs() > residual { speed.signum() } else { 0.0 };
        let before = std::mem::replace(&mut self.dragged.side, side);
        before != side
    }

    /// What friction did in the step.
    pub(super) fn as_dragged(&self) -> Dragged {
        Dragged { impulse: self.impulse, ..self.dragged }
    }
}

/// Lists the slips of rows, in their order, as the bodies move now.
pub(super) fn list_slips(
    (assembly, connectors): (&Assembly, &Connectors),
    region: &Region,
    pressed: &[Pressed],
    rows: &mut [StepRow],
    slips: &mut Vec<StepSlip>,
) {
    slips.clear();
    if !assembly.any_friction() {
        return;
    }
    for row in rows {
        let record = &region.records()[row.record];
        let Some((slip, surface)) = slip_of(assembly, connectors, record) else { continue };
        let before = pressed.binary_search_by_key(&row.touch, |before| before.touch).ok();
        let dragged = before.map(|at| pressed[at].dragged).unwrap_or_default();
        let inertia = record.bodies().map(|body| assembly.inertia(body));
        let along = CollisionRow::new(record.bodies(), slip.jacobian, inertia, slip.rate);
        let running = -surface.speeds[0] - surface.speeds[1];
        let sticking = if dragged.side == 0.0 { surface.sticking } else { surface.kinetic };
        row.slip = Some(slips.len() as u32);
        slips.push(StepSlip {
            jacobian: slip.jacobian,
            response: along.response,
            compliance: along.coupling(&along),
            running,
            bounds: [sticking, surface.kinetic],
            dragged,
            impulse: 0.0,
            before: 0.0,
            direction: 0.0,
        });
    }
}
