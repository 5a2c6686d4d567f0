//! Projected sweeps over the rows of an island: each in turn gets the impulse by which it does what is asked of it, until none
//! changes by more than a share of the largest impulse.
//!
//! Source: J. J. Moreau, CISM Courses 302 (1988).

use crate::stepping::rows::{Drag, Row};

/// Outcome of sweeps.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Swept {
    /// Number of sweeps.
    pub(super) sweeps: u32,
    /// Largest change of an impulse in the last one, as a fraction of the largest impulse.
    pub(super) residual: f64,
}

/// Changes velocities, which include the impulses that the rows have, by further impulses until the residual is reached, in at
/// most so many sweeps.
pub(super) fn sweep(
    rows: &mut [Row],
    list: &[u32],
    velocities: &mut [[f64; 3]],
    residual: f64,
    most: u32,
) -> Swept {
    let mut swept = Swept::default();
    for sweeps in 1..=most {
        let (mut change, mut largest) = (0.0_f64, 0.0_f64);
        for &row in list {
            let row = &mut rows[row as usize];
            change = change.max(visit(row, velocities));
            largest = largest.max(row.normal.impulse.abs());
        }
        swept = Swept { sweeps, residual: if largest > 0.0 { change / largest } else { 0.0 } };
        if swept.residual <= residual {
            break;
        }
    }
    swept
}

/// Gives a row the impulses by which it does what is asked; returns the largest change of one [N s].
#[inline]
fn visit(row: &mut Row, velocities: &mut [[f64; 3]]) -> f64 {
    let Row { places, normal, is_bilateral, slip, roll, .. } = row;
    let rate = normal.rate(*places, velocities) + normal.offset;
    let wanted = normal.impulse - rate * normal.weight;
    let change = if *is_bilateral { wanted } else { wanted.max(0.0) } - normal.impulse;
    if change != 0.0 {
        normal.push(*places, velocities, change);
        normal.impulse += change;
    }
    let mut most = change.abs();
    let pressing = normal.impulse.abs();
    for drag in [slip, roll].into_iter().flatten() {
        most = most.max(hold_back(drag, *places, velocities, pressing));
    }
    most
}

#[inline]
fn hold_back(drag: &mut Drag, places: [usize; 2], velocities: &mut [[f64; 3]], pressing: f64) -> f64 {
    let line = &mut drag.line;
    let rate = line.rate(places, velocities) + line.offset;
    let wanted = line.impulse - rate * line.weight;
    let bound = drag.coefficient * pressing;
    let change = if wanted.abs() <= bound {
        wanted
    } else {
        // Once it gives way it is held back by the lesser force.
        (drag.kinetic * pressing).copysign(wanted)
    } - line.impulse;
    if change != 0.0 {
        line.push(places, velocities, change);
        line.impulse += change;
    }
    change.abs()
}
