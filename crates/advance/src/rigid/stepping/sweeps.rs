//! Projected sweeps: each row in turn gets the impulse by which it no longer closes, forwards and backwards, until none
//! changes its rate by more than a residual. Between sweeps the impulses go on along a conjugate direction, as long as the
//! sweeps change them less and less.
//!
//! Rows that depend on each other, or jam, get bounded impulses: what they do not reach in so many sweeps is left for the next step.
//!
//! Source: M. Silcowitz, S. Niebe, K. Erleben, The Visual Computer 26 (2010) (nonlinear conjugate gradients over sweeps).

use crate::rigid::shares::MAJOR;
use crate::rigid::stepping::rows::StepRow;
use crate::rigid::stepping::slips::StepSlip;

/// Number of sweeps there and back after which a residual may be [`MAJOR`] times as large: what closes still is stopped in the
/// next step. With 50 the piles overlap as much and take half as long again.
const FINE_SWEEPS: usize = 15;
/// Largest number of sweeps there and back. With 15 a wall of bricks that falls goes down into its floor.
const MOST_SWEEPS: usize = 150;

/// Changes velocities so that the rows which act have a rate of at least the opposite of their offset, with impulses that only
/// push, and the slips of those rows stop as far as friction goes. They begin with the impulses that they have; those of other rows
/// become zero. Rows that are soft, by a part of the mean of their compliances, share what they lack if they contradict each other.
/// False if rates are off by more than the residual.
pub(crate) fn sweep(
    (rows, slips): (&mut [StepRow], &mut [StepSlip]),
    velocities: &mut [[f64; 3]],
    (residual, softness): (f64, f64),
    acts: impl Fn(&StepRow) -> bool,
) -> bool {
    for row in rows.iter_mut() {
        (row.acts, row.direction) = (acts(row), 0.0);
        let mut slip = slip_of(row, slips);
        slip.iter_mut().for_each(|slip| slip.direction = 0.0);
        if row.acts {
            row.push(velocities, row.impulse);
            slip.into_iter().for_each(|slip| slip.push(row.places, velocities, slip.impulse));
        } else {
            row.impulse = 0.0;
            slip.into_iter().for_each(|slip| slip.impulse = 0.0);
        }
    }
    let softness = softness * rows.iter().map(|row| row.compliance).sum::<f64>() / rows.len().max(1) as f64;
    let mut last = f64::INFINITY;
    for round in 0..MOST_SWEEPS {
        for row in rows.iter_mut() {
            row.before = row.impulse;
        }
        for slip in slips.iter_mut() {
            slip.before = slip.impulse;
        }
        let most = rows.iter_mut().map(|row| visit(row, slips, velocities, softness)).fold(0.0, f64::max);
        if most <= residual || round >= FINE_SWEEPS && most <= MAJOR * residual {
            return true;
        }
        for row in rows.iter_mut().rev() {
            visit(row, slips, velocities, softness);
        }
        let squares = rows.iter().map(|row| (row.impulse - row.before) * (row.impulse - row.before));
        let of_slips = slips.iter().map(|slip| (slip.impulse - slip.before) * (slip.impulse - slip.before));
        let square = squares.sum::<f64>() + of_slips.sum::<f64>();
        let share = if square < last { square / last } else { 0.0 };
        last = square;
        for row in rows.iter_mut() {
            let (on, swept) = (share * row.direction, row.impulse - row.before);
            row.impulse += on;
            row.push(velocities, on);
            row.direction = if share > 0.0 { on + swept } else { 0.0 };
            if let Some(slip) = slip_of(row, slips) {
                let (on, swept) = (share * slip.direction, slip.impulse - slip.before);
                slip.impulse += on;
                slip.push(row.places, velocities, on);
                slip.direction = if share > 0.0 { on + swept } else { 0.0 };
            }
        }
    }
    // The last sweep leaves no impulse that pulls.
    for row in rows.iter_mut() {
        visit(row, slips, velocities, softness);
    }
    false
}

/// The slip of a row, if it takes part.
#[inline]
fn slip_of<'a>(row: &StepRow, slips: &'a mut [StepSlip]) -> Option<&'a mut StepSlip> {
    slips.get_mut(row.slip? as usize)
}

/// Stops a row that closes, or lets it go if it would pull, and its slip; returns the greater change of a rate [m/s].
fn visit(row: &mut StepRow, slips: &mut [StepSlip], velocities: &mut [[f64; 3]], softness: f64) -> f64 {
    if !row.acts {
        return 0.0;
    }
    let lacking = row.rate(velocities) + row.offset + softness * row.impulse;
    let wanted = row.impulse - lacking / (row.compliance + softness);
    let change = wanted.max(0.0) - row.impulse;
    row.push(velocities, change);
    row.impulse += change;
    let changed = change.abs() * row.compliance;
    slip_of(row, slips).map_or(changed, |slip| changed.max(slip.visit(row.places, velocities, row.impulse)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::contacts::touch::Touch;
    use halfgap_collision::BodyId;
    use halfgap_geometry::FeatureId;

    /// A column of discs of 1 kg on a floor: row i keeps disc i off the one below it.
    fn column(count: usize) -> Vec<StepRow> {
        let row = |upper: usize| {
            let lower = if upper == 0 { count } else { upper - 1 };
            let carried = if upper == 0 { 0.0 } else { -1.0 };
            StepRow {
                record: upper,
                touch: Touch::new([BodyId(0), BodyId(1)], [FeatureId(0), FeatureId(0)]),
                places: [upper, lower],
                jacobian: [0.0, 1.0, 0.0, 0.0, -1.0, 0.0],
                response: [0.0, 1.0, 0.0, 0.0, carried, 0.0],
                compliance: 1.0 - carried,
                gap: 0.0,
                bend: 0.0,
                running: 0.0,
                elasticity: 0.0,
                approach: 0.0,
                touches: true,
                pressed: None,
                stopped_by: 0.0,
                acts: true,
                kept: 0.0,
                before: 0.0,
                direction: 0.0,
                impulse: 0.0,
                offset: 0.0,
                slip: None,
            }
        };
        (0..count).map(row).collect()
    }

    #[test]
    fn a_column_that_falls_is_stopped_by_its_weight() {
        let count = 8;
        let mut rows = column(count);
        let mut velocities = vec![[0.0, -1.0, 0.0]; count];
        velocities.push([0.0; 3]);
        sweep((&mut rows, &mut []), &mut velocities, (1e-12, 0.0), |_| true);
        let fastest = velocities.iter().map(|v| v[1].abs()).fold(0.0, f64::max);
        assert!(fastest < 1e-4, "{fastest} m/s");
        for (index, row) in rows.iter().enumerate() {
            let carried = (count - index) as f64;
            assert!((row.impulse - carried).abs() < 1e-3, "{index}: {} N s", row.impulse);
        }
        // From these impulses one sweep tells that nothing changes.
        let mut again = vec![[0.0, -1.0, 0.0]; count];
        again.push([0.0; 3]);
        sweep((&mut rows, &mut []), &mut again, (1e-3, 0.0), |_| true);
        assert!(again.iter().all(|v| v[1].abs() < 1e-4), "{again:?}");
    }

    #[test]
    fn rows_that_open_get_no_impulse_and_none_pulls() {
        let mut rows = column(2);
        let mut velocities = vec![[0.0, -1.0, 0.0], [0.0, 3.0, 0.0], [0.0; 3]];
        sweep((&mut rows, &mut []), &mut velocities, (1e-12, 0.0), |_| true);
        assert_eq!(velocities, [[0.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0; 3]]);
        assert_eq!(rows.iter().map(|row| row.impulse).collect::<Vec<_>>(), [1.0, 0.0]);
    }
}
