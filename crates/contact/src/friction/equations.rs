//! The equations of given modes, in the space of the columns: ε I + Σ_j D_j c_jᵀ over the rows that are held.
//!
//! D_j is the direction of row j, for a normal row together with the friction of its slipping rows, whose forces it
//! carries along.

use super::mode::Mode;
use super::scaled_rows::{Bound, ScaledRows};
use super::skyline_lu::SkylineLu;

/// The factors, and the direction listed last.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Equations {
    factors: SkylineLu,
    direction: Vec<(u32, f64)>,
}

impl Equations {
    /// Factorises the matrix of the modes. `act` is called with each row in the equations and its direction. False if the
    /// matrix is singular.
    pub(super) fn factorise(
        &mut self,
        rows: &ScaledRows,
        modes: &[Mode],
        epsilon: f64,
        mut act: impl FnMut(usize, &[(u32, f64)]),
    ) -> bool {
        self.factors.reset(&rows.first, epsilon);
        for row in (0..rows.len()).filter(|&row| modes[row] == Mode::Held) {
            self.list_direction(rows, modes, row);
            for &(k, d) in &self.direction {
                let measured = rows.measured().row(row);
                measured.iter().for_each(|&(l, c)| self.factors.add(k as usize, l as usize, d * c));
            }
            act(row, &self.direction);
        }
        self.factors.factorise()
    }

    /// Solves with the factors, in place of the right side.
    pub(super) fn solve(&self, right: &mut [f64]) {
        self.factors.solve(right);
    }

    fn list_direction(&mut self, rows: &ScaledRows, modes: &[Mode], row: usize) {
        let directions = rows.directions();
        self.direction.clear();
        self.direction.extend_from_slice(directions.row(row));
        for &(_, other) in rows.friction_of(row) {
            let sign = match modes[other as usize] {
                Mode::Least => -1.0,
                Mode::Most => 1.0,
                Mode::Open | Mode::Held => continue,
            };
            let Bound::Friction { coefficient, .. } = rows.bound[other as usize] else { continue };
            let entries = directions.row(other as usize).iter();
            self.direction.extend(entries.map(|&(k, d)| (k, sign * coefficient * d)));
        }
    }
}
