//! Proofs that there is no solution, refined until they are certain.
//!
//! Where no forces satisfy the rows, the forces with which a method ends have grown along a combination z of the rows,
//! z ≥ 0 on contacts, that hardly moves the bodies, u = Jᵀ z ≈ 0, while bᵀz < 0. For the iterates of a proximal point
//! method this is shown by G. Banjac, P. Goulart, B. Stellato, S. Boyd, "Infeasibility detection in the alternating
//! direction method of multipliers for convex optimization", Journal of Optimization Theory and Applications 183, 2019,
//! 490-519. Certificates of other methods are such combinations too, up to rounding that pivots have enlarged. The
//! nearest combination of the same rows that moves no body is, in scaled quantities,
//!
//! ```text
//! ẑ - Ĵ_S (δ I + Ĵ_Sᵀ Ĵ_S)⁻¹ û,    S the rows with z ≠ 0, δ → 0.
//! ```
//!
//! After a few such steps, with z and u in 31 digits from the data as given, u is only the rounding of the data (arms
//! of 1e-17 m of normals through a centre), and A z the square of that. Rows that depend on each other only nearly
//! leave far more.

use crate::body_factor::BodyFactor;
use crate::error::Infeasibility;
use crate::matrix::{BodyRows, Matrix};
use crate::problem::Problem;
use crate::settings::Settings;
use crate::system::System;
use crate::twofold::{Number, Twofold};

/// δ, in units of the diagonal of Â, which is 1: each step leaves δ/(δ + λ) of û in the direction of an eigenvalue λ of
/// Â.
const TERM: f64 = 1e-11;

/// Cap on the steps.
const STEPS: usize = 20;
/// Fraction of û: the steps end when one leaves at least this fraction of it.
const SETTLED: f64 = 0.5;

/// Fraction of the largest component: smaller ones of contacts are not part of the direction along which forces grew.
const PART: f64 = 1e-6;

/// Largest size of û, for a largest component 1 of ẑ, that comes from the rounding of J. A z is of second order in û,
/// and would be rounding long before.
const MOVED: f64 = 64.0 * f64::EPSILON;

/// A combination of rows on the way to one that moves no body.
struct Combination<'a> {
    problem: &'a Problem,
    bodies: &'a BodyRows,
    system: &'a System,
    /// z, one number per row, the largest scaled one about 1.
    parts: Vec<Twofold>,
    /// û, one number per column.
    motion: Vec<f64>,
    /// Change of the scaled parts.
    change: Vec<f64>,
}

/// Makes a certain proof from a direction of the rows of bodies, with a `factor` that is prepared for `system`; `None`
/// if that fails.
pub(crate) fn refine(
    problem: &Problem,
    system: &System,
    factor: &mut BodyFactor,
    direction: &[f64],
    settings: &Settings,
) -> Option<Infeasibility> {
    let Matrix::Bodies(bodies) = &problem.matrix else { return None };
    let mut combination = Combination::begin(problem, bodies, system, direction)?;
    let (mut before, mut is_changed) = (f64::INFINITY, true);
    for _ in 0..STEPS {
        combination.find_motion();
        let moved = largest_of(&combination.motion);
        if !is_changed && moved >= SETTLED * before {
            return if moved <= MOVED { combination.proof(settings) } else { None };
        }
        before = moved;
        let weight = |row: usize| if combination.is_in(row) { TERM.recip() } else { 0.0 };
        if is_changed && !factor.factor(system, weight) {
            return None;
        }
        factor.solve(&mut combination.motion);
        is_changed = combination.correct();
    }
    None
}

impl<'a> Combination<'a> {
    /// Starts from a direction; `None` if that is zero or not finite.
    fn begin(
        problem: &'a Problem,
        bodies: &'a BodyRows,
        system: &'a System,
        direction: &[f64],
    ) -> Option<Self> {
        let scaled = direction.iter().zip(&system.row_scale).map(|(z, s)| z * s);
        let largest = scaled.clone().fold(0.0, |most: f64, z| most.max(z.abs()));
        if !(largest.is_normal() && direction.iter().all(|z| z.is_finite())) {
            return None;
        }
        let parts = scaled.zip(direction).zip(&problem.bilateral).map(|((scaled, z), is_bilateral)| {
            let is_part = *is_bilateral || scaled > PART * largest;
            Twofold::from(if is_part { z / largest } else { 0.0 })
        });
        Some(Self {
            problem,
            bodies,
            system,
            parts: parts.collect(),
            motion: vec![0.0; system.columns()],
            change: vec![0.0; problem.len()],
        })
    }

    /// Whether a row may be part of the combination.
    fn is_in(&self, row: usize) -> bool {
        self.problem.bilateral[row] || self.parts[row] > Twofold::default()
    }

    fn find_motion(&mut self) {
        self.motion = motion_by(self.bodies, &self.parts);
    }

    /// Subtracts the correction by the solved motion from the parts. Returns whether a contact has dropped out.
    fn correct(&mut self) -> bool {
        self.system.pull(&self.motion, &mut self.change);
        let mut is_changed = false;
        for row in 0..self.parts.len() {
            if self.is_in(row) {
                let change = self.change[row] / TERM / self.system.row_scale[row];
                self.parts[row] = self.parts[row] - Twofold::from(change);
                if !self.is_in(row) {
                    self.parts[row] = Twofold::default();
                    is_changed = true;
                }
            }
        }
        is_changed
    }

    /// The proof by this combination, rounded to `f64`, if it is certain.
    fn proof(&self, settings: &Settings) -> Option<Infeasibility> {
        let offsets = self.problem.offset.iter().map(|b| Twofold::from(*b));
        let worth = offsets.zip(&self.parts).fold(Twofold::default(), |sum, (b, z)| sum + b * *z).nearest();
        let direction: Vec<f64> = self.parts.iter().map(|z| z.nearest()).collect();
        let scaled: Vec<f64> = direction.iter().zip(&self.system.row_scale).map(|(z, s)| z * s).collect();
        let row = (0..scaled.len()).max_by(|&i, &j| scaled[i].abs().total_cmp(&scaled[j].abs()))?;
        let (largest, square) = (scaled[row].abs(), scaled.iter().map(|z| z * z).sum::<f64>());
        let contradiction = -worth * largest / square / self.system.scale;
        let rounding = Twofold::ROUNDING.max(self.leakage(&self.motion) / largest);
        let is_certain = contradiction > settings.inconsistency
            && contradiction.is_finite()
            && contradiction >= settings.greatest_growth * rounding;
        let rounded: Vec<Twofold> = direction.iter().map(|z| Twofold::from(*z)).collect();
        let leakage = self.leakage(&motion_by(self.bodies, &rounded)) / largest;
        is_certain.then_some(Infeasibility { row, direction, contradiction, leakage })
    }

    /// Largest scaled component of A z, computed as Ĵ û.
    fn leakage(&self, motion: &[f64]) -> f64 {
        let mut image = vec![0.0; self.parts.len()];
        self.system.pull(motion, &mut image);
        largest_of(&image)
    }
}

/// û = M^(-1/2) Jᵀ z.
fn motion_by(bodies: &BodyRows, parts: &[Twofold]) -> Vec<f64> {
    let mut sums = vec![Twofold::default(); bodies.inverse_mass.len()];
    for (row, &part) in parts.iter().enumerate().filter(|(_, part)| **part != Twofold::default()) {
        let (columns, values) = bodies.rows.row(row);
        for (&k, &v) in columns.iter().zip(values) {
            sums[k] = sums[k] + Twofold::from(v) * part;
        }
    }
    sums.iter().zip(&bodies.inverse_mass).map(|(sum, w)| sum.nearest() * w.sqrt()).collect()
}

/// The largest absolute value; infinite if one is NaN.
fn largest_of(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, v| if v.is_nan() { f64::INFINITY } else { most.max(v.abs()) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ProblemError;
    use crate::proximal_newton::ProximalNewton;

    const DISCS: usize = 5;

    /// Discs of unlike masses in a column between a floor and a lid that approach each other by a given amount.
    fn column(nearer: f64) -> Result<Problem, ProblemError> {
        let mut rows = Vec::new();
        for disc in 0..DISCS {
            rows.extend([(disc, disc, 1.0), (disc + 1, disc, -1.0)]);
        }
        let inverse_mass: Vec<f64> = (0..DISCS).map(|disc| 10f64.powi(disc as i32)).collect();
        let offset: Vec<f64> = (0..=DISCS).map(|row| (row as f64).sin() - nearer).collect();
        Problem::from_rows(&rows, &inverse_mass, &offset)
    }

    #[test]
    fn a_rough_direction_becomes_a_proof() -> Result<(), ProblemError> {
        let rough: Vec<f64> = (0..=DISCS).map(|row| 1.0 + 1e-4 * (row as f64).cos()).collect();
        let mut solver = ProximalNewton::default();
        let proof = solver.refine_proof(&column(1.0)?, &rough).expect("discs that are squeezed");
        assert!(proof.direction.iter().all(|z| (z / proof.direction[0] - 1.0).abs() < 1e-15), "{proof:?}");
        assert!(proof.contradiction > 0.01 && proof.leakage < 1e-15, "{proof:?}");
        // A lid that does not approach leaves the discs room.
        assert_eq!(solver.refine_proof(&column(-1.0)?, &rough), None);
        Ok(())
    }

    #[test]
    fn rows_that_nearly_cancel_each_other_prove_nothing() -> Result<(), ProblemError> {
        // A wedge that slips out of its slot, of nearly no angle, with A z of 1e-16.
        let rows = [(0, 1, 1.0), (1, 0, 1e-8), (1, 1, -1.0)];
        let problem = Problem::from_rows(&rows, &[1.0, 1.0], &[-1.0, -1.0])?;
        assert_eq!(ProximalNewton::default().refine_proof(&problem, &[1.0, 1.0]), None);
        Ok(())
    }
}
