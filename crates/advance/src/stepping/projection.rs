//! Displacements that bring bodies which overlap, and connectors that have come apart, back to their gaps: the least in the metric of
//! the masses, found by sweeps.

use crate::stepping::bodies::{Bodies, Motion3};
use crate::stepping::books::StepBooks;
use crate::stepping::rows::Row;

/// Largest number of sweeps: what they leave is brought back in the next step.
const MOST_SWEEPS: usize = 10;
/// Share of the error that does not matter, up to which a sweep need not change anything [-].
const ENOUGH: f64 = 0.1;

/// Brings rows back that are off by more than a slack [m]. True if bodies were shifted.
pub(super) fn project(
    bodies: &mut Bodies,
    rows: &mut [Row],
    slack: f64,
    shifts: &mut Vec<Motion3>,
    books: &mut StepBooks,
) -> bool {
    let is_off = |row: &Row| if row.is_bilateral { row.gap.abs() > slack } else { row.gap < -slack };
    if !rows.iter().any(is_off) {
        return false;
    }
    shifts.clear();
    shifts.resize(bodies.count() + 1, [0.0; 3]);
    for row in rows.iter_mut() {
        row.normal.impulse = 0.0;
    }
    for _ in 0..MOST_SWEEPS {
        let mut most = 0.0_f64;
        for row in rows.iter_mut() {
            let line = &mut row.normal;
            let lacking = line.rate(row.places, shifts) + row.gap;
            let wanted = line.impulse - lacking * line.weight;
            let change = if row.is_bilateral { wanted } else { wanted.max(0.0) } - line.impulse;
            if change != 0.0 {
                line.push(row.places, shifts, change);
                line.impulse += change;
                most = most.max(change.abs() / line.weight);
            }
        }
        if most <= ENOUGH * slack {
            break;
        }
    }
    for row in rows.iter_mut() {
        row.gap += row.normal.rate(row.places, shifts);
        if let Some(slip) = &mut row.slip {
            slip.off += slip.line.rate(row.places, shifts);
        }
    }
    for place in 0..bodies.count() {
        let shift = shifts[place];
        if shift != [0.0; 3] {
            let nature = &bodies.natures[place];
            let acceleration = nature.free_motion.acceleration;
            books.book_projection(-(acceleration.x * shift[0] + acceleration.y * shift[1]) / nature.body.inverse_mass);
            bodies.shift(place, shift);
        }
    }
    true
}
