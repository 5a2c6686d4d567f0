//! Modes of rows, and the bounds of their forces.

use super::scaled_rows::{Bound, ScaledRows};

/// Distance [-] of a force from its bound, in units of both, that is the rounding of its scaling: a few roundings. With
/// less, contacts that slip are taken for sticking when their forces come back as an earlier answer.
const ON_THE_BOUND: f64 = 1e-14;

/// How the force of a row is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum Mode {
    /// It carries no force.
    Open,
    /// It is in the equations: closed, sticking, holding.
    Held,
    /// It has its least force.
    Least,
    /// It has its most force.
    Most,
}

/// Bounds of the scaled force of a row, for given scaled forces of all rows.
#[inline]
pub(super) fn bounds(rows: &ScaledRows, row: usize, force: &[f64]) -> (f64, f64) {
    match rows.bound[row] {
        Bound::Unilateral => (0.0, f64::INFINITY),
        Bound::Bilateral => (f64::NEG_INFINITY, f64::INFINITY),
        Bound::Constants { least, most } => (least, most),
        Bound::Friction { normal, coefficient } => {
            let most = coefficient * force[normal as usize].max(0.0);
            (-most, most)
        }
    }
}

/// A force cut to its bounds.
#[inline]
pub(super) fn cut(rows: &ScaledRows, row: usize, force: &[f64]) -> f64 {
    let (least, most) = bounds(rows, row, force);
    force[row].max(least).min(most)
}

/// The modes of scaled forces that may be beyond their bounds; those of an answer are on them up to rounding.
pub(super) fn of_forces(rows: &ScaledRows, force: &[f64], modes: &mut Vec<Mode>) {
    modes.clear();
    modes.extend((0..rows.len()).map(|row| {
        let (value, (least, most)) = (force[row], bounds(rows, row, force));
        let is_near = |bound: f64| (value - bound).abs() <= ON_THE_BOUND * (value.abs() + bound.abs());
        match rows.bound[row] {
            Bound::Bilateral => Mode::Held,
            Bound::Unilateral if value > 0.0 => Mode::Held,
            Bound::Unilateral => Mode::Open,
            Bound::Friction { .. } if most == 0.0 => Mode::Open,
            Bound::Constants { .. } | Bound::Friction { .. } => {
                if value < least || is_near(least) {
                    Mode::Least
                } else if value > most || is_near(most) {
                    Mode::Most
                } else {
                    Mode::Held
                }
            }
        }
    }));
}
