//! A problem with friction as a plain linear complementarity problem, for Lemke's method.
//!
//! A friction row becomes three: its force is β⁺ - β⁻ with both not negative, and σ ≥ 0 is the slip speed that the cone
//! allows,
//!
//! ```text
//! 0 ≤ β⁺ ⟂ a + σ ≥ 0,      0 ≤ β⁻ ⟂ -a + σ ≥ 0,      0 ≤ σ ⟂ mu fₙ - β⁺ - β⁻ ≥ 0.
//! ```
//!
//! In the plane the cone is two rays, so this is no approximation. Where no force is turned, zᵀ M z = |M⁻½ Jᵀ f|² +
//! mu fₙ σ ≥ 0: M is copositive, and Lemke's path ends at a solution, or on a ray that proves that the normal rows have
//! none. Both β may be positive where σ = 0; the force is the same. A row between constants becomes two: 0 ≤ f - least ⟂
//! a + σ ≥ 0 and 0 ≤ σ ⟂ most - f ≥ 0. Source: D. E. Stewart, J. C. Trinkle, "An implicit time-stepping scheme for rigid
//! body dynamics with inelastic collisions and Coulomb friction", IJNME 39, 1996, equation 15.

use super::scaled_rows::{Bound, ScaledRows};
use crate::error::{Infeasibility, ProblemError, SolveError};
use crate::problem::Problem;

/// A row of the plain problem: the row that it is made of, the sign with which it stands for its acceleration and force,
/// and the place of its σ, if it has one.
#[derive(Clone, Copy, Debug)]
struct Part {
    row: usize,
    sign: f64,
}

/// The plain problem of a problem with friction, in scaled forces.
pub(crate) struct PlainForm {
    rows: ScaledRows,
    parts: Vec<Part>,
    /// The σ behind the parts: (the row, the parts that it lifts).
    slips: Vec<(usize, Vec<usize>)>,
    /// Force of each row where all parts are zero.
    least: Vec<f64>,
    pub(crate) problem: Problem,
}

impl PlainForm {
    /// Makes the plain form of a problem.
    pub(crate) fn of(problem: &Problem) -> Result<Self, ProblemError> {
        let mut rows = ScaledRows::default();
        rows.load(problem);
        let mut form = Self {
            least: vec![0.0; rows.len()],
            rows,
            parts: Vec::new(),
            slips: Vec::new(),
            problem: Problem::new(),
        };
        let bilateral = form.list_parts();
        form.problem = form.build()?;
        let all: Vec<bool> = bilateral.into_iter().chain(form.slips.iter().map(|_| false)).collect();
        form.problem.set_bilateral(&all)?;
        Ok(form)
    }

    /// Lists parts and slips; returns which parts are bilateral.
    fn list_parts(&mut self) -> Vec<bool> {
        let mut bilateral = Vec::new();
        for row in 0..self.rows.len() {
            let first = self.parts.len();
            let mut push = |sign: f64, is_bilateral: bool| {
                self.parts.push(Part { row, sign });
                bilateral.push(is_bilateral);
            };
            match self.rows.bound[row] {
                Bound::Unilateral => push(1.0, false),
                Bound::Bilateral => push(1.0, true),
                Bound::Friction { .. } => {
                    push(1.0, false);
                    push(-1.0, false);
                    self.slips.push((row, vec![first, first + 1]));
                }
                Bound::Constants { least, most } if least.is_finite() => {
                    push(1.0, false);
                    self.least[row] = least;
                    if most.is_finite() {
                        self.slips.push((row, vec![first]));
                    }
                }
                Bound::Constants { most, .. } if most.is_finite() => {
                    push(-1.0, false);
                    self.least[row] = most;
                }
                Bound::Constants { .. } => push(1.0, true),
            }
        }
        bilateral
    }

    fn build(&self) -> Result<Problem, ProblemError> {
        let (parts, n) = (&self.parts, self.parts.len());
        let mut triplets = Vec::new();
        let mut known = self.rows.offset.clone();
        let columns = self.rows.first.len();
        // The parts that push each column.
        let mut pushing: Vec<Vec<(usize, f64)>> = vec![Vec::new(); columns];
        for (at, part) in parts.iter().enumerate() {
            let entries = self.rows.directions().row(part.row);
            entries.iter().for_each(|&(k, value)| pushing[k as usize].push((at, part.sign * value)));
        }
        let mut motion = vec![0.0; columns];
        for (row, &force) in self.least.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            self.rows.directions().add_to(row, force, &mut motion);
        }
        known.iter_mut().enumerate().for_each(|(row, b)| *b += self.rows.measured().times(row, &motion));
        let mut offset = Vec::new();
        for (at, part) in parts.iter().enumerate() {
            for &(k, value) in self.rows.measured().row(part.row) {
                let terms = pushing[k as usize].iter();
                triplets.extend(terms.map(|&(other, push)| (at, other, part.sign * value * push)));
            }
            offset.push(part.sign * known[part.row]);
        }
        for (at, (row, lifted)) in self.slips.iter().enumerate() {
            let slip = n + at;
            for &part in lifted {
                triplets.extend([(part, slip, 1.0), (slip, part, -1.0)]);
            }
            match self.rows.bound[*row] {
                Bound::Friction { normal, coefficient } => {
                    let pushed = parts.iter().position(|part| part.row == normal as usize);
                    triplets.extend(pushed.map(|pushed| (slip, pushed, coefficient * parts[pushed].sign)));
                    offset.push(coefficient * self.least[normal as usize]);
                }
                Bound::Constants { least, most } => offset.push(most - least),
                Bound::Unilateral | Bound::Bilateral => offset.push(0.0),
            }
        }
        Problem::from_general(&triplets, &offset)
    }

    /// The forces of the rows \[N\], of those of the plain problem.
    pub(crate) fn forces(&self, plain: &[f64], force: &mut [f64]) {
        force.copy_from_slice(&self.least);
        for (part, value) in self.parts.iter().zip(plain) {
            force[part.row] += part.sign * value;
        }
        for row in 0..force.len() {
            if let Bound::Friction { normal, coefficient } = self.rows.bound[row] {
                let most = coefficient * force[normal as usize].max(0.0);
                force[row] = force[row].clamp(-most, most);
            }
        }
        force.iter_mut().zip(&self.rows.scale).for_each(|(force, scale)| *force /= scale);
    }

    /// An error of the plain problem as one of the problem: its rows are named.
    pub(crate) fn error(&self, error: SolveError) -> SolveError {
        match error {
            SolveError::Infeasible(proof) => {
                let row_of = |at: usize| match self.parts.get(at) {
                    Some(part) => part.row,
                    None => self.slips[at - self.parts.len()].0,
                };
                let mut direction = vec![0.0; self.rows.len()];
                for (part, z) in self.parts.iter().zip(&proof.direction) {
                    direction[part.row] += part.sign * z / self.rows.scale[part.row];
                }
                let row = row_of(proof.row);
                SolveError::Infeasible(Box::new(Infeasibility { row, direction, ..*proof }))
            }
            other => other,
        }
    }
}
