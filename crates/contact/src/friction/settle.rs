//! Forces of given modes near earlier ones, and modes that are corrected where these forces contradict them.
//!
//! Near û, with rows j in the equations of `equations`, the forces are found as changes of û,
//!
//! ```text
//! (ε I + Σ_j D_j c_jᵀ) δv = -Σ_j D_j (c_j v + b_j),      δu_j = -(c_j v + b_j + c_j δv)/ε
//! ```
//!
//! so that rounding is that of the change, and repeating it refines. *Invariant*: forces outside the equations are at
//! their bounds.

use super::equations::Equations;
use super::mode::{self, Mode};
use super::scaled_rows::ScaledRows;

/// Cap on changes of modes: where the modes of the start are nearly right, two or three do.
const CHANGES: usize = 8;

/// Forces and accelerations of modes.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Settle {
    modes: Vec<Mode>,
    wished: Vec<Mode>,
    /// u, û - a/ε, and the scaled accelerations.
    force: Vec<f64>,
    wanted: Vec<f64>,
    acceleration: Vec<f64>,
    /// c_j v + b_j of the rows in the equations.
    rest: Vec<f64>,
    motion: Vec<f64>,
    change: Vec<f64>,
}

impl Settle {
    /// Replaces the forces `center` by the forces of their modes, which are corrected until the natural residual is at
    /// most `enough` or no mode is wrong. Returns that residual, in units of the load; `None` if modes do not come to an
    /// end.
    pub(super) fn run(
        &mut self,
        rows: &ScaledRows,
        equations: &mut Equations,
        center: &mut Vec<f64>,
        [epsilon, enough]: [f64; 2],
        iterations: &mut usize,
    ) -> Option<f64> {
        mode::of_forces(rows, center, &mut self.modes);
        for _ in 0..CHANGES {
            *iterations += 1;
            if !self.solve(rows, equations, center, epsilon) {
                return None;
            }
            let residual = self.natural_residual(rows);
            if residual <= enough || !self.correct(rows, center, epsilon) {
                std::mem::swap(center, &mut self.force);
                return Some(residual);
            }
        }
        None
    }

    /// Replaces the forces `center` by those of given modes, whether these are right or not.
    pub(super) fn run_fixed(
        &mut self,
        rows: &ScaledRows,
        equations: &mut Equations,
        modes: &[Mode],
        center: &mut Vec<f64>,
        epsilon: f64,
    ) {
        self.modes.clear();
        self.modes.extend_from_slice(modes);
        if self.solve(rows, equations, center, epsilon) {
            std::mem::swap(center, &mut self.force);
        }
    }

    fn solve(&mut self, rows: &ScaledRows, equations: &mut Equations, center: &[f64], epsilon: f64) -> bool {
        self.set_known_forces(rows, center);
        self.motion.clear();
        self.motion.resize(rows.first.len(), 0.0);
        for (row, &force) in self.force.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            rows.directions().add_to(row, force, &mut self.motion);
        }
        self.rest.clear();
        self.rest
            .extend((0..rows.len()).map(|row| rows.offset[row] + rows.measured().times(row, &self.motion)));
        self.change.clear();
        self.change.resize(rows.first.len(), 0.0);
        let (rest, change) = (&self.rest, &mut self.change);
        let is_regular = equations.factorise(rows, &self.modes, epsilon, |row, direction| {
            direction.iter().for_each(|&(k, d)| change[k as usize] -= rest[row] * d);
        });
        if is_regular {
            equations.solve(&mut self.change);
            self.take_change(rows, epsilon);
        }
        is_regular
    }

    /// Sets u to û in the equations, and to its bounds elsewhere.
    fn set_known_forces(&mut self, rows: &ScaledRows, center: &[f64]) {
        self.force.clear();
        let held = |row: usize| if self.modes[row] == Mode::Held { center[row] } else { 0.0 };
        self.force.extend((0..rows.len()).map(held));
        for row in 0..rows.len() {
            let (least, most) = mode::bounds(rows, row, &self.force);
            match self.modes[row] {
                Mode::Least => self.force[row] = least,
                Mode::Most => self.force[row] = most,
                Mode::Open | Mode::Held => {}
            }
        }
    }

    fn take_change(&mut self, rows: &ScaledRows, epsilon: f64) {
        self.acceleration.clear();
        for row in 0..rows.len() {
            let acceleration = self.rest[row] + rows.measured().times(row, &self.change);
            if self.modes[row] == Mode::Held {
                self.force[row] -= acceleration / epsilon;
            }
            self.acceleration.push(acceleration);
        }
        // Slipping rows follow their normal rows.
        for &(_, row) in &rows.friction {
            let row = row as usize;
            let (least, most) = mode::bounds(rows, row, &self.force);
            match self.modes[row] {
                Mode::Least => self.force[row] = least,
                Mode::Most => self.force[row] = most,
                Mode::Open | Mode::Held => {}
            }
        }
    }

    /// The natural residual of the present forces and accelerations, in units of the load.
    fn natural_residual(&self, rows: &ScaledRows) -> f64 {
        let (mut most, load) = (0.0_f64, rows.load_size());
        for row in 0..rows.len() {
            let (force, (least, largest)) = (self.force[row], mode::bounds(rows, row, &self.force));
            most = most.max(self.acceleration[row].min(force - least).max(force - largest).abs());
        }
        if load > 0.0 { most / load } else { most }
    }

    /// Takes the modes of û - a/ε over. False if they are those of before.
    fn correct(&mut self, rows: &ScaledRows, center: &[f64], epsilon: f64) -> bool {
        self.wanted.clear();
        self.wanted.extend((0..rows.len()).map(|row| match self.modes[row] {
            Mode::Held => self.force[row],
            _ => center[row] - self.acceleration[row] / epsilon,
        }));
        mode::of_forces(rows, &self.wanted, &mut self.wished);
        let has_changed = self.wished != self.modes;
        std::mem::swap(&mut self.wished, &mut self.modes);
        has_changed
    }
}
