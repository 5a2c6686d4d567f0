//! What the derivatives of the rates tell of a step: the rounding of its components, and its fastest rate.

use super::super::linear::dot;
use super::{Radau, root_mean_square};

/// Multiple of the state's rounding below which corrections cannot be told from none.
const ROUNDINGS: f64 = 16.0;
/// Number of patterns of signs with which the rounding of the rates is tried.
const SIGN_PATTERNS: u32 = 4;
/// Odd number near 2^32 over the golden ratio, whose multiples are spread evenly.
const GOLDEN: u32 = 0x9e37_79b9;
/// Least size of the first component that the power method goes on from, as a fraction of its vector's size; less for
/// those after it.
const STIRRED: f64 = 1e-3;
/// Number of turns of the power method in one step.
const TURNS: usize = 4;

impl Radau {
    /// Finds the rounding of the components: each one's own, and what the rounding of the rates does to it, since a fast
    /// part follows that. Rates are rounded with either sign: the largest of a few patterns of signs counts.
    pub(super) fn find_rounding(&mut self) {
        let rounding = |value: &f64| ROUNDINGS * f64::EPSILON * value.abs();
        self.rate_rounding.clear();
        self.rate_rounding.extend(slopes_of(&self.jacobian, self.active).map(|slopes| {
            slopes.iter().zip(&self.start).map(|(slope, value)| slope.abs() * rounding(value)).sum::<f64>()
        }));
        self.rounding.clear();
        self.rounding.resize(self.active, 0.0);
        for pattern in 0..SIGN_PATTERNS {
            let of_rates = &mut self.right[..self.active];
            for (row, (of_rate, &size)) in of_rates.iter_mut().zip(&self.rate_rounding).enumerate() {
                *of_rate = if is_negative(pattern, row) { -size } else { size };
            }
            if self.solved {
                self.real.solve(of_rates);
            }
            for (found, of_rate) in self.rounding.iter_mut().zip(of_rates) {
                *found = found.max(of_rate.abs());
            }
        }
        for (found, value) in self.rounding.iter_mut().zip(&self.start) {
            *found += rounding(value);
        }
    }

    /// Finds the largest eigenvalue in size, by a few turns of the power method, which goes on from step to step.
    pub(super) fn find_fastest(&mut self) {
        let active = self.active;
        if self.fastest.len() != active {
            self.fastest.clear();
            self.fastest.resize(active, 1.0);
        }
        let mut rate = 0.0;
        self.stir();
        for _ in 0..TURNS {
            let norm = root_mean_square(&self.fastest, &self.scales);
            if norm == 0.0 || !norm.is_finite() {
                self.fastest.fill(1.0);
                break;
            }
            for (row, slopes) in slopes_of(&self.jacobian, active).enumerate() {
                self.right[row] = dot(slopes, &self.fastest) / norm;
            }
            self.fastest.copy_from_slice(&self.right[..active]);
            rate = root_mean_square(&self.fastest, &self.scales);
        }
        self.stiffness = (rate * self.length).abs();
    }

    /// Gives every component of the power method's vector a least size: a slow part, of which nothing is left there,
    /// may have become fast. Neighbours differ, for a part that pulls all alike is not fast.
    fn stir(&mut self) {
        let norm = root_mean_square(&self.fastest, &self.scales);
        for (index, (component, scale)) in self.fastest.iter_mut().zip(&self.scales).enumerate() {
            let least = STIRRED * norm * scale / (1.0 + index as f64);
            if component.abs() < least {
                *component = least;
            }
        }
    }
}

/// Sign of a row in a pattern of signs: all are positive in the first one, and mixed in the others.
fn is_negative(pattern: u32, row: usize) -> bool {
    (row as u32).wrapping_add(1).wrapping_mul(pattern.wrapping_mul(GOLDEN)) >> 31 == 1
}

/// Rows of a Jacobian of a number of components; none if there are no components.
pub(super) fn slopes_of(jacobian: &[f64], components: usize) -> std::slice::ChunksExact<'_, f64> {
    jacobian.chunks_exact(components.max(1))
}
