//! Projected sweeps: each row in turn gets the impulse by which it no longer closes, forwards and backwards, until none
//! changes its rate by more than a residual.
//!
//! Each change is a projection in the metric of the masses. So where bodies at rest satisfy all rows, no sweep raises the
//! energy, whether it is the last or not; rows that depend on each other, or jam, get bounded impulses.

use crate::rigid::stepping::rows::StepRow;

/// Largest number of sweeps: what then closes still is stopped in the next step.
const MOST_SWEEPS: usize = 100;

/// Changes velocities so that the rows which `acts` tells have a rate of at least the opposite of their offset, with impulses that only push.
/// They begin with the impulses that they have.
pub(crate) fn sweep(
    rows: &mut [StepRow],
    velocities: &mut [[f64; 3]],
    residual: f64,
    acts: impl Fn(&StepRow) -> bool,
) {
    for row in rows.iter_mut() {
        if acts(row) {
            row.push(velocities, row.impulse);
        } else {
            row.impulse = 0.0;
        }
    }
    for round in 0..MOST_SWEEPS {
        let mut most = 0.0f64;
        let mut visit = |row: &mut StepRow| {
            if acts(row) {
                let wanted = row.impulse - (row.rate(velocities) + row.offset) / row.compliance;
                let change = wanted.max(0.0) - row.impulse;
                row.push(velocities, change);
                row.impulse += change;
                most = most.max(change.abs() * row.compliance);
            }
        };
        if round % 2 == 0 {
            rows.iter_mut().for_each(&mut visit);
        } else {
            rows.iter_mut().rev().for_each(&mut visit);
        }
        if most <= residual {
            break;
        }
    }
}
