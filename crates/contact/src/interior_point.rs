//! A primal-dual interior-point method in body space, from which the proximal method starts where it does not end soon.
//!
//! With the scaled quantities of [`System`] and the motion u of the bodies,
//!
//! ```text
//! u = Ĵᵀ f,   a = Ĵ u + b̂ + δ f,   f_i a_i = μ   (f_i > 0, a_i > 0),   a = -δ (f - f before)  on bilateral rows
//! ```
//!
//! is followed to μ = 0 by Newton steps, each with the matrix I + Ĵᵀ W Ĵ, W = 1/(a/f + δ). It is positive definite
//! however redundant the contacts are, and as sparse as the bodies' neighbourhoods. A nonzero term δ keeps the forces
//! of jammed bodies modest, which may press each other by any amount. A step predicts how far μ can fall and corrects
//! for the quadratic terms. Where many contacts nearly depend on each other, an active set takes a pivot for each to
//! find the closed rows; here it takes some twenty steps whatever their number. Source: S. Mehrotra, "On the
//! implementation of a primal-dual interior point method", SIAM Journal on Optimization 2, 1992; for quadratic
//! programs, J. Nocedal, S. Wright, Numerical Optimization, 2nd ed., algorithm 16.4.
//!
//! The result is only near the answer; the proximal method makes it exact.

use crate::body_factor::BodyFactor;
use crate::system::System;

/// Largest mean product of scaled force and acceleration, in units of the square of the scale, that ends the iteration.
const GAP: f64 = 1e-18;
/// Largest residual of the accelerations, in units of the scale, that ends the iteration.
const FEASIBLE: f64 = 1e-9;
/// Largest mean product and residual, in the units of `GAP` and `FEASIBLE`, at which the result is of use.
const NEAR: f64 = 1e-8;
/// Least error that known forces are taken to have, in units of the scale.
const LEAST_WRONG: f64 = 1e-6;
/// Cap on the number of steps.
const STEPS: usize = 50;
/// Largest fraction of the way to the boundary that a step goes, far from the end.
const WITHIN: f64 = 0.995;
/// Fraction of a full step: the iteration ends at shorter steps.
const SHORTEST: f64 = 1e-3;
/// Power of the fraction of the gap that the predicted step leaves: the corrected step aims at that fraction of the
/// gap.
const CENTRING: i32 = 3;
/// Proximal term on bilateral rows, in units of the diagonal of Â, which is 1.
const BILATERAL_TERM: f64 = 1e-9;

/// The interior-point method with its buffers: f and a of each row, their changes, and the residuals of the equations.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct InteriorPoint {
    pub(crate) force: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    weight: Vec<f64>,
    residual: Vec<f64>,
    /// Products of force and acceleration that a step aims at.
    product: Vec<f64>,
    force_change: Vec<f64>,
    acceleration_change: Vec<f64>,
    motion: Vec<f64>,
    motion_change: Vec<f64>,
    /// The term δ, in units of the diagonal of Â, which is 1.
    pub(crate) term: f64,
    /// Number of steps of the last run.
    pub(crate) steps: usize,
}

impl InteriorPoint {
    /// Follows the path as far as possible, from the middle or from near the scaled forces `known`. Returns whether it
    /// came near the end.
    pub(crate) fn run(
        &mut self,
        system: &System,
        factor: &mut BodyFactor,
        bilateral: &[bool],
        known: Option<&[f64]>,
    ) -> bool {
        self.open(system, bilateral);
        if let Some(known) = known {
            self.begin_at(system, bilateral, known);
        }
        let scale = system.scale;
        let count = bilateral.iter().filter(|is| !**is).count().max(1) as f64;
        loop {
            self.measure(system, bilateral);
            let gap = self.gap_after(0.0, bilateral);
            let mean = gap / (count * scale * scale);
            let short = self.residual.iter().fold(0.0, |most: f64, r| most.max(r.abs())) / scale;
            let is_near = mean <= NEAR && short <= NEAR;
            if mean <= GAP && short <= FEASIBLE || self.steps >= STEPS || !gap.is_finite() {
                return is_near;
            }
            self.steps += 1;
            let weight = &self.weight;
            if !factor.factor(system, |row| weight[row]) {
                return is_near;
            }
            // The predictor aims at zero products, the corrector at the target that its result gives.
            self.product.fill(0.0);
            self.find_step(system, factor, bilateral);
            let after = self.gap_after(self.longest(bilateral), bilateral);
            let target = gap / count * (after / gap).powi(CENTRING);
            for (row, product) in self.product.iter_mut().enumerate() {
                *product = target - self.force_change[row] * self.acceleration_change[row];
            }
            self.find_step(system, factor, bilateral);
            // Near the end, where steps are accurate, one step removes nearly all of the gap.
            let within = WITHIN.max(1.0 - mean.sqrt());
            let length = (within * self.longest(bilateral)).min(1.0);
            if length < SHORTEST {
                return is_near;
            }
            self.go(length);
        }
    }

    /// Starts in the middle: all forces and accelerations of the size of the offsets.
    fn open(&mut self, system: &System, bilateral: &[bool]) {
        self.steps = 0;
        for values in [
            &mut self.weight,
            &mut self.residual,
            &mut self.product,
            &mut self.force_change,
            &mut self.acceleration_change,
        ] {
            values.clear();
            values.resize(bilateral.len(), 0.0);
        }
        for values in [&mut self.force, &mut self.acceleration] {
            values.clear();
            values.extend(bilateral.iter().map(|is| if *is { 0.0 } else { system.scale }));
        }
        for values in [&mut self.motion, &mut self.motion_change] {
            values.clear();
            values.resize(system.columns(), 0.0);
        }
        system.push(&self.force, &mut self.motion);
    }

    /// Starts near known forces, with the accelerations that they leave; both are at least the error of these
    /// accelerations.
    fn begin_at(&mut self, system: &System, bilateral: &[bool], known: &[f64]) {
        self.force.copy_from_slice(known);
        system.push(&self.force, &mut self.motion);
        system.pull(&self.motion, &mut self.acceleration);
        self.acceleration.iter_mut().zip(&system.b).for_each(|(a, b)| *a += b);
        let contacts = || (0..bilateral.len()).filter(|&row| !bilateral[row]);
        let wrong = contacts().map(|row| -self.acceleration[row]).fold(0.0, f64::max);
        let least = wrong.max(LEAST_WRONG * system.scale);
        for (row, &is_bilateral) in bilateral.iter().enumerate() {
            if is_bilateral {
                self.acceleration[row] = 0.0;
            } else {
                self.force[row] = self.force[row].max(least);
                self.acceleration[row] = self.acceleration[row].abs().max(least);
            }
        }
        system.push(&self.force, &mut self.motion);
    }

    /// Finds the weights, and the residuals of the accelerations against those of the motion.
    fn measure(&mut self, system: &System, bilateral: &[bool]) {
        system.pull(&self.motion, &mut self.residual);
        for (row, residual) in self.residual.iter_mut().enumerate() {
            *residual += system.b[row] - self.acceleration[row];
            if bilateral[row] {
                self.weight[row] = BILATERAL_TERM.recip();
            } else {
                *residual += self.term * self.force[row];
                self.weight[row] = (self.acceleration[row] / self.force[row] + self.term).recip();
            }
        }
    }

    /// Finds the changes that make the linearised equations hold with the products aimed at.
    fn find_step(&mut self, system: &System, factor: &mut BodyFactor, bilateral: &[bool]) {
        // The forces if the motion did not change.
        for (row, &is_bilateral) in bilateral.iter().enumerate() {
            let force = self.force[row];
            let kept = if is_bilateral {
                force
            } else {
                let aim = self.product[row] / self.acceleration[row] - force;
                force + aim * self.weight[row] * self.acceleration[row] / force
            };
            self.force_change[row] = kept - self.weight[row] * self.residual[row];
        }
        system.push(&self.force_change, &mut self.motion_change);
        self.motion_change.iter_mut().zip(&self.motion).for_each(|(change, motion)| *change -= motion);
        factor.solve(&mut self.motion_change);
        system.pull(&self.motion_change, &mut self.acceleration_change);
        for (row, &is_bilateral) in bilateral.iter().enumerate() {
            let change = self.acceleration_change[row];
            self.force_change[row] -= self.force[row] + self.weight[row] * change;
            let of_contact = change + self.residual[row] + self.term * self.force_change[row];
            self.acceleration_change[row] = if is_bilateral { 0.0 } else { of_contact };
        }
    }

    /// Longest multiple of the step at which no force and no acceleration of a unilateral row is below zero.
    fn longest(&self, bilateral: &[bool]) -> f64 {
        let to_zero = |value: f64, change: f64| if change < 0.0 { -value / change } else { f64::INFINITY };
        let of_row = |row: usize| {
            let force = to_zero(self.force[row], self.force_change[row]);
            force.min(to_zero(self.acceleration[row], self.acceleration_change[row]))
        };
        (0..bilateral.len()).filter(|&row| !bilateral[row]).map(of_row).fold(f64::INFINITY, f64::min)
    }

    /// Sum of the products of the unilateral rows after a multiple of the step, capped at 1.
    fn gap_after(&self, steps: f64, bilateral: &[bool]) -> f64 {
        let steps = steps.min(1.0);
        let of_row = |row: usize| {
            (self.force[row] + steps * self.force_change[row])
                * (self.acceleration[row] + steps * self.acceleration_change[row])
        };
        (0..bilateral.len()).filter(|&row| !bilateral[row]).map(of_row).sum()
    }

    /// Goes a part of the step.
    fn go(&mut self, part: f64) {
        for (values, changes) in [
            (&mut self.force, &self.force_change),
            (&mut self.acceleration, &self.acceleration_change),
            (&mut self.motion, &self.motion_change),
        ] {
            values.iter_mut().zip(changes).for_each(|(value, change)| *value += part * change);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::{InverseInertia, Problem, Row};
    use crate::test_problems::crooked_pyramid;

    fn run(problem: &Problem, known: Option<&[f64]>) -> (bool, InteriorPoint) {
        let (mut system, mut factor) = (System::default(), BodyFactor::default());
        system.load(problem);
        assert!(factor.prepare(&system, system.columns()));
        let mut method = InteriorPoint::default();
        let is_near = method.run(&system, &mut factor, problem.bilateral(), known);
        (is_near, method)
    }

    #[test]
    fn nearly_redundant_contacts_take_few_steps_whatever_their_number() {
        for layers in [2, 8, 16] {
            let (is_near, method) = run(&crooked_pyramid(layers), None);
            assert!(is_near && method.steps < 30, "{} steps", method.steps);
            let forces = method.force.iter().zip(&method.acceleration);
            let kept = forces.clone().filter(|(force, acceleration)| force > acceleration).count();
            assert!(kept < method.force.len());
            // Rows that carry force do not open, and rows that open carry none.
            assert!(forces.into_iter().all(|(force, acceleration)| force.min(*acceleration) < 1e-6));
        }
    }

    #[test]
    fn known_forces_save_steps() {
        let problem = crooked_pyramid(8);
        let (is_near, from_middle) = run(&problem, None);
        assert!(is_near);
        let off = |(row, force): (usize, &f64)| force + 1e-3 * (row % 3) as f64;
        let known: Vec<f64> = from_middle.force.iter().enumerate().map(off).collect();
        let (is_near, from_known) = run(&problem, Some(&known));
        assert!(is_near && from_known.steps < from_middle.steps, "{} steps", from_known.steps);
    }

    #[test]
    fn connectors_may_pull() {
        let mut problem = Problem::new();
        let body =
            problem.add_body(InverseInertia { inverse_mass: 2.0, inverse_moment: 1.0 }).expect("a body");
        problem.add_row(&Row::new(body, [0.0, 1.0, 0.0], 5.0).bilateral()).expect("a row");
        problem.add_row(&Row::new(body, [1.0, 0.0, 0.0], -3.0)).expect("a row");
        let (is_near, method) = run(&problem, None);
        // In units in which a row's square is 1: forces times the square root of the inverse mass.
        let expected = [-5.0, 3.0].map(|force: f64| force / 2.0_f64.sqrt());
        assert!(is_near);
        let errors = method.force.iter().zip(expected).map(|(force, expected)| (force - expected).abs());
        assert!(errors.fold(0.0, f64::max) < 1e-6, "{:?}", method.force);
    }

    #[test]
    fn jaws_that_close_on_a_body_have_no_end() {
        let mut problem = Problem::new();
        let body =
            problem.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 1.0 }).expect("a body");
        for direction in [1.0, -1.0] {
            problem.add_row(&Row::new(body, [direction, 0.0, 0.0], -1.0)).expect("a row");
        }
        assert!(!run(&problem, None).0);
    }
}
