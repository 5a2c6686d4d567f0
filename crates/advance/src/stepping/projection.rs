//! Displacements that bring bodies which overlap, and connectors that have come apart, back to their gaps: the least in the metric of
//! the masses, found by sweeps.

use crate::stepping::bodies::Bodies;
use crate::stepping::books::StepBooks;
use crate::stepping::rows::{Mover, Row};

/// Largest number of sweeps: what they leave is brought back in the next step.
const MOST_SWEEPS: usize = 10;
/// Share of the error that does not matter, up to which a sweep need not change anything [-].
const ENOUGH: f64 = 0.1;

/// Brings rows back that are off by more than a slack [m]. True if bodies were shifted.
pub(super) fn project(
    bodies: &mut Bodies,
    rows: &mut [Row],
    slack: f64,
    shifts: &mut Vec<Mover>,
    books: &mut StepBooks,
) -> bool {
    shifts.clear();
    shifts.extend((0..=bodies.count()).map(|place| bodies.mover(place, [0.0; 3])));
    for row in rows.iter_mut() {
        row.normal.before = 0.0;
    }
    for _ in 0..MOST_SWEEPS {
        let mut most = 0.0_f64;
        for row in rows.iter_mut() {
            let [a, b] = row.ends();
            let (mut p, mut q) = (shifts[a], shifts[b]);
            let line = &mut row.normal;
            let lacking = line.rate(&p.velocity, &q.velocity) + row.gap;
            let wanted = line.before - lacking * line.weight;
            let change = if row.is_bilateral { wanted } else { wanted.max(0.0) } - line.before;
            if change != 0.0 {
                line.push(&mut p, &mut q, change);
                line.before += change;
                most = most.max(change.abs() / line.weight);
                (shifts[a], shifts[b]) = (p, q);
            }
        }
        if most <= ENOUGH * slack {
            break;
        }
    }
    for row in rows.iter_mut() {
        let [p, q] = row.ends().map(|place| &shifts[place].velocity);
        row.gap += row.normal.rate(p, q);
        row.slip.off += row.slip.line.rate(p, q);
    }
    for (place, shift) in shifts.iter().enumerate().take(bodies.count()) {
        let shift = shift.velocity;
        if shift != [0.0; 3] {
            let nature = &bodies.natures[place];
            let acceleration = nature.free_motion.acceleration;
            books.book_projection(
                -(acceleration.x * shift[0] + acceleration.y * shift[1]) / nature.body.inverse_mass,
            );
            bodies.shift(place, shift);
        }
    }
    true
}
