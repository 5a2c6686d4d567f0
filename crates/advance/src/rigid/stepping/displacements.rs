//! Displacements that bring gaps back to their target: soft problems, in which rows that contradict each other share what they lack.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::region::touching::Region;
use crate::rigid::settings::RegionSteps;
use crate::rigid::shares::{LARGE, MINOR};
use crate::rigid::stepping::rows::list_rows;
use crate::rigid::stepping::step::Stepper;
use crate::rigid::stepping::sweeps::sweep;

/// Finds the displacements that bring what overlaps back to its target, if any overlaps by more than a minor part of the slack. They
/// go no farther than a small multiple of that overlap.
pub(super) fn find_shifts(stepper: &mut Stepper, steps: RegionSteps) {
    let Stepper { rows, middle, shifts, .. } = stepper;
    shifts.clear();
    shifts.resize(middle.len(), [0.0; 3]);
    let deepest = rows.iter().map(|row| row.gap).fold(0.0, f64::min);
    if deepest >= -MINOR * steps.slack {
        return;
    }
    // The impulses of the step are kept: they are where the next one begins.
    for row in rows.iter_mut() {
        (row.kept, row.impulse, row.offset) = (row.impulse, 0.0, row.gap);
    }
    sweep((rows, &mut []), shifts, (MINOR * MINOR * steps.slack, MINOR), |_| true);
    let farthest = shifts.iter().map(|[x, y, _]| libm::hypot(*x, *y)).fold(0.0, f64::max);
    if farthest > -LARGE * deepest {
        shifts.fill([0.0; 3]);
    }
    for row in rows.iter_mut() {
        row.impulse = row.kept;
    }
}

/// Finds the least displacement that leaves no gap of a region below its target, up to a residual [m], among those that are above it by
/// at most `reach` [m]; returns the least gap above its target before it [m], or 0. Gaps that contradict each other share what they lack.
pub(crate) fn find_way_to_target(
    assembly: &Assembly,
    region: &Region,
    stepper: &mut Stepper,
    (reach, residual): (f64, f64),
) -> f64 {
    let Stepper { rows, shifts, .. } = stepper;
    list_rows(assembly, region, &[], 0.0, rows);
    rows.retain(|row| row.gap <= reach);
    shifts.clear();
    shifts.resize(region.bodies().len() + 1, [0.0; 3]);
    for row in rows.iter_mut() {
        row.offset = row.gap;
    }
    sweep((rows, &mut []), shifts, (residual, MINOR), |_| true);
    rows.iter().map(|row| row.gap).fold(0.0, f64::min)
}
