//! Checks of answers, computed from the original data alone. The formulas are at [`Residuals`].

use halfgap_collision::geometry::Rounded;
use std::fmt;

use crate::entries::Entries;
use crate::kind::RowKind;
use crate::matrix::{BodyRows, Matrix, SparseMatrix};
use crate::problem::{Problem, pushing};
use crate::settings::Settings;

/// Residuals of an answer, computed from the original data alone.
///
/// With s_i = sqrt(A_ii) (1 where A_ii = 0) and a = A f + b:
///
/// * natural residual: r_nat = max_i φ_i / max|b/s|, with φ = |min(s f, a/s)| on a unilateral and |a/s| on a bilateral
///   row; on one whose force is bounded by constants or by friction φ = |s f - P(s f - a/s)|, where P cuts to the bounds
///   (of friction: to mu times the force of the normal row, if that pushes), so that φ is zero only for forces within
///   their bounds, or cones, that oppose the slip where they are on them, and where bounds exclude zero the denominator is
///   at least s times the least force; it is 1 where b = 0;
/// * growth = max_i Σ_j |A_ij f_j| / s_i / max|b/s|: ratio of the terms of an acceleration to the data, with the same
///   denominator;
/// * backward residual: r_bwd = r_nat / (1 + growth).
///
/// The scaling makes all three independent of units and of the scaling of a row. An answer exact to rounding has r_nat
/// of about growth times 1e-16, so problems with large mass ratios are judged by r_bwd. As r_bwd alone would accept any
/// answer with huge forces, growth is capped. The thresholds are in [`Settings`]. Source of the natural residual: R.
/// Cottle, J.-S. Pang, R. Stone, "The Linear Complementarity Problem", 1992, 5.10. An answer that is not finite has
/// infinite residuals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Residuals {
    /// Natural residual r_nat [-], in units of the scale max|b/s|.
    pub natural: f64,
    /// Growth [-]: largest sum of terms of an acceleration, in units of the scale.
    pub growth: f64,
    /// Backward residual r_bwd = r_nat / (1 + growth) [-].
    pub backward: f64,
}

impl Residuals {
    /// Computes the residuals of the forces `force` \[N\] (or impulses [N·s]), one per row of `problem`.
    ///
    /// # Panics
    ///
    /// If there is not one force per row.
    #[must_use]
    #[inline]
    pub fn of(problem: &Problem, force: &[f64]) -> Self {
        let mut acceleration = vec![0.0; problem.len()];
        Checker::default().check(problem, force, &mut acceleration)
    }

    /// Returns whether an answer with these residuals passes the thresholds of `settings`.
    ///
    /// `inconsistency` is the known contradiction between dependent rows, in units of the scale
    /// ([`Solution::inconsistency`](crate::Solution::inconsistency)). It is taken off the natural residual, and must
    /// not exceed [`Settings::inconsistency`].
    #[must_use]
    #[inline]
    pub fn accepted(&self, settings: &Settings, inconsistency: f64) -> bool {
        let natural = self.natural - inconsistency;
        if !natural.is_finite() || inconsistency > settings.inconsistency {
            return false;
        }
        let judged_by_growth = self.growth >= settings.least_growth && self.growth < settings.greatest_growth;
        natural <= settings.natural_residual
            || (judged_by_growth && natural <= settings.backward_residual * (1.0 + self.growth))
    }
}

impl Problem {
    /// Returns the accelerations A f + b of the rows [m/s²] under the forces `force` \[N\], computed by J where the
    /// problem has one.
    ///
    /// # Panics
    ///
    /// If there is not one force per row.
    #[must_use]
    #[inline]
    pub fn accelerations(&self, force: &[f64]) -> Vec<f64> {
        let mut acceleration = vec![0.0; self.len()];
        Checker::default().check(self, force, &mut acceleration);
        acceleration
    }
}

impl fmt::Display for Residuals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Residuals { natural, growth, backward } = self;
        let [natural, growth, backward] = [natural, growth, backward].map(|residual| Rounded(*residual));
        write!(f, "natural residual {natural}, growth {growth}, backward residual {backward}")
    }
}

/// Computes residuals, with buffers that are kept from check to check.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Checker {
    /// M⁻¹ Jᵀ f per column, and the sum of its absolute terms.
    velocity: Vec<[f64; 2]>,
    /// Per row, an upper bound on Σ_j |A_ij f_j| / s_i, and 1/s_i.
    bound: Vec<[f64; 2]>,
    /// Rows that carry force, by column: offsets and (row, J M⁻¹ f of that entry).
    start: Vec<usize>,
    entry: Vec<(usize, f64)>,
    /// Terms A_ij f_j of one row i, by j, and the j whose terms are set.
    term: Vec<f64>,
    used: Vec<usize>,
    /// The entries of A, formed once the same pattern of rows has come twice.
    entries: Entries,
    /// Per row, Σ_j |A_ij f_j|.
    sum: Vec<f64>,
    /// Along what the forces act, where one acts in another direction than is measured.
    pushes: SparseMatrix,
}

impl Checker {
    /// Writes A f + b to `acceleration` and returns the residuals.
    pub(crate) fn check(&mut self, problem: &Problem, force: &[f64], acceleration: &mut [f64]) -> Residuals {
        assert_eq!(force.len(), problem.len(), "one force per row");
        match &problem.matrix {
            Matrix::Bodies(bodies) if !problem.is_plain() => {
                self.check_bodies(problem, bodies, force, acceleration)
            }
            Matrix::Bodies(bodies) => {
                let mut entries = std::mem::take(&mut self.entries);
                entries.load(bodies);
                let residuals = self.check_with(&entries, problem, force, acceleration);
                self.entries = entries;
                residuals
            }
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => {
                check_matrix(problem, matrix, force, acceleration)
            }
        }
    }

    /// Does as [`check`](Self::check), with the given `entries` of the problem's A if they are formed.
    pub(crate) fn check_with(
        &mut self,
        entries: &Entries,
        problem: &Problem,
        force: &[f64],
        acceleration: &mut [f64],
    ) -> Residuals {
        match &problem.matrix {
            Matrix::Bodies(_) if entries.are_formed() => {
                self.check_entries(problem, entries, force, acceleration)
            }
            Matrix::Bodies(bodies) => self.check_bodies(problem, bodies, force, acceleration),
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => {
                check_matrix(problem, matrix, force, acceleration)
            }
        }
    }

    fn check_bodies(
        &mut self,
        problem: &Problem,
        bodies: &BodyRows,
        force: &[f64],
        acceleration: &mut [f64],
    ) -> Residuals {
        let mut pushes = std::mem::take(&mut self.pushes);
        let is_turned = problem.further.has_directions();
        if is_turned {
            problem.further.turn(&bodies.rows, &mut pushes);
        }
        let pushed = if is_turned { &pushes } else { &bodies.rows };
        self.push(pushed, &bodies.inverse_mass, force);
        let mut sums = Sums::default();
        self.bound.clear();
        for (i, out) in acceleration.iter_mut().enumerate() {
            let (columns, values) = bodies.rows.row(i);
            let (mut diagonal, mut change, mut bound) = (0.0, 0.0, 0.0);
            for (&k, &v) in columns.iter().zip(values) {
                let [velocity, terms] = self.velocity[k];
                diagonal += v * v * bodies.inverse_mass[k];
                change += v * velocity;
                bound += v.abs() * terms;
            }
            *out = change + problem.offset[i];
            let s = sums.add(diagonal, problem.offset[i], force[i], *out, 0.0, problem.bounds(i, force));
            self.bound.push([bound / s, 1.0 / s]);
        }
        sums.terms = self.largest_terms(bodies, pushed, force);
        self.pushes = pushes;
        sums.finish()
    }

    fn check_entries(
        &mut self,
        problem: &Problem,
        entries: &Entries,
        force: &[f64],
        acceleration: &mut [f64],
    ) -> Residuals {
        self.sum.clear();
        for ((out, &[diagonal, ..]), &f) in acceleration.iter_mut().zip(entries.diagonal()).zip(force) {
            *out = diagonal * f;
            self.sum.push(out.abs());
        }
        for (i, j, entry) in entries.off_diagonal() {
            let [to_i, to_j] = [entry * force[j], entry * force[i]];
            acceleration[i] += to_i;
            acceleration[j] += to_j;
            self.sum[i] += to_i.abs();
            self.sum[j] += to_j.abs();
        }
        let mut sums = Sums::default();
        for (i, out) in acceleration.iter_mut().enumerate() {
            let b = problem.offset[i];
            *out += b;
            let [_, s, inverse] = entries.diagonal()[i];
            let terms = self.sum[i] * inverse;
            let bounds = Bounds::plain(problem.bilateral[i]);
            sums.add_scaled(b * inverse, s * force[i], *out * inverse, terms, bounds);
        }
        sums.finish()
    }

    /// Computes M⁻¹ Jᵀ f and the sums of its absolute terms.
    fn push(&mut self, pushed: &SparseMatrix, inverse_mass: &[f64], force: &[f64]) {
        self.velocity.clear();
        self.velocity.resize(inverse_mass.len(), [0.0; 2]);
        for (j, &f) in force.iter().enumerate().filter(|(_, f)| **f != 0.0) {
            let (columns, values) = pushed.row(j);
            for (&k, &v) in columns.iter().zip(values) {
                let push = v * inverse_mass[k] * f;
                let [velocity, terms] = &mut self.velocity[k];
                *velocity += push;
                *terms += push.abs();
            }
        }
    }

    /// max_i Σ_j |A_ij f_j| / s_i. The bound of a row, made of sums by column, is at least its sum, so that only rows
    /// whose bound exceeds the largest sum so far are evaluated.
    fn largest_terms(&mut self, bodies: &BodyRows, pushed: &SparseMatrix, force: &[f64]) -> f64 {
        let Some(top) = (0..force.len()).max_by(|&i, &j| self.bound[i][0].total_cmp(&self.bound[j][0]))
        else {
            return 0.0;
        };
        self.list(pushed, &bodies.inverse_mass, force);
        let mut largest = 0.0_f64;
        for i in std::iter::once(top).chain(0..force.len()) {
            let [bound, inverse] = self.bound[i];
            if bound > largest {
                let (columns, values) = bodies.rows.row(i);
                largest = largest.max(self.sum_of_terms(columns, values) * inverse);
            }
        }
        largest
    }

    /// Lists, per column, the rows that carry force.
    fn list(&mut self, pushed: &SparseMatrix, inverse_mass: &[f64], force: &[f64]) {
        let columns = inverse_mass.len();
        self.start.clear();
        self.start.resize(columns + 2, 0);
        self.term.clear();
        self.term.resize(force.len(), 0.0);
        self.used.reserve(force.len());
        for (j, _) in force.iter().enumerate().filter(|(_, f)| **f != 0.0) {
            // An immovable column couples no rows, and that of a floor may hold all rows of the problem.
            let movable = pushed.row(j).0.iter().filter(|k| inverse_mass[**k] > 0.0);
            movable.for_each(|&k| self.start[k + 2] += 1);
        }
        for k in 2..self.start.len() {
            self.start[k] += self.start[k - 1];
        }
        self.entry.clear();
        self.entry.resize(self.start[columns + 1], (0, 0.0));
        for (j, &f) in force.iter().enumerate().filter(|(_, f)| **f != 0.0) {
            let (row_columns, values) = pushed.row(j);
            let entries = row_columns.iter().zip(values);
            for (&k, &v) in entries.filter(|(k, _)| inverse_mass[**k] > 0.0) {
                self.entry[self.start[k + 1]] = (j, v * inverse_mass[k] * f);
                self.start[k + 1] += 1;
            }
        }
    }

    /// Σ_j |A_ij f_j| of the row with these coefficients.
    fn sum_of_terms(&mut self, columns: &[usize], values: &[f64]) -> f64 {
        for (&k, &v) in columns.iter().zip(values) {
            for &(j, push) in &self.entry[self.start[k]..self.start[k + 1]] {
                if self.term[j] == 0.0 {
                    self.used.push(j);
                }
                self.term[j] += v * push;
            }
        }
        let mut sum = 0.0;
        for &j in &self.used {
            sum += self.term[j].abs();
            self.term[j] = 0.0;
        }
        self.used.clear();
        sum
    }
}

fn check_matrix(
    problem: &Problem,
    matrix: &SparseMatrix,
    force: &[f64],
    acceleration: &mut [f64],
) -> Residuals {
    let mut sums = Sums::default();
    for (i, out) in acceleration.iter_mut().enumerate() {
        let (columns, values) = matrix.row(i);
        let (mut diagonal, mut change, mut terms) = (0.0, 0.0, 0.0);
        for (&j, &v) in columns.iter().zip(values) {
            if i == j {
                diagonal = v;
            }
            let term = v * force[j];
            change += term;
            terms += term.abs();
        }
        *out = change + problem.offset[i];
        sums.add(diagonal, problem.offset[i], force[i], *out, terms, problem.bounds(i, force));
    }
    sums.finish()
}

/// Between what a force must lie.
#[derive(Clone, Copy, Debug)]
enum Bounds {
    None,
    /// Zero, from below.
    Zero,
    /// The least and the most.
    Between(f64, f64),
}

impl Bounds {
    /// Distance of the bounds from zero: a force that must act is a load, too.
    fn distance(self) -> f64 {
        match self {
            Self::None | Self::Zero => 0.0,
            Self::Between(least, most) => least.max(-most).max(0.0),
        }
    }

    fn plain(bilateral: bool) -> Self {
        if bilateral { Self::None } else { Self::Zero }
    }
}

impl Problem {
    /// The bounds of a row's force, for given forces of all rows.
    fn bounds(&self, row: usize, force: &[f64]) -> Bounds {
        match self.further.kind(row) {
            Some(RowKind::Bounded { least, most }) => Bounds::Between(least, most),
            Some(RowKind::Friction { normal, coefficient }) => {
                let most = coefficient * pushing(force[normal]);
                Bounds::Between(-most, most)
            }
            _ => Bounds::plain(self.bilateral[row]),
        }
    }
}

/// Largest values over the rows so far, all scaled.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    residual: f64,
    terms: f64,
    scale: f64,
    /// True once a residual, force or acceleration is not finite: `f64::max` would drop a NaN.
    broken: bool,
}

impl Sums {
    /// Adds a row; returns its s.
    fn add(
        &mut self,
        diagonal: f64,
        b: f64,
        force: f64,
        acceleration: f64,
        terms: f64,
        bounds: Bounds,
    ) -> f64 {
        let s = if diagonal > 0.0 { diagonal.sqrt() } else { 1.0 };
        let bounds = match bounds {
            Bounds::Between(least, most) => Bounds::Between(least * s, most * s),
            plain => plain,
        };
        self.add_scaled(b / s, s * force, acceleration / s, terms / s, bounds);
        s
    }

    /// Adds a row whose quantities are scaled.
    fn add_scaled(&mut self, b: f64, force: f64, acceleration: f64, terms: f64, bounds: Bounds) {
        let residual = match bounds {
            Bounds::None => acceleration.abs(),
            Bounds::Zero => force.min(acceleration).abs(),
            // The cut first, so that an acceleration far below the force does not drown in it.
            Bounds::Between(least, most) => acceleration.min(force - least).max(force - most).abs(),
        };
        self.broken |= !(residual.is_finite() && force.is_finite() && acceleration.is_finite());
        self.residual = self.residual.max(residual);
        self.terms = self.terms.max(terms);
        self.scale = self.scale.max(b.abs()).max(bounds.distance());
    }

    fn finish(self) -> Residuals {
        if self.broken {
            return Residuals { natural: f64::INFINITY, growth: f64::INFINITY, backward: f64::INFINITY };
        }
        let scale = if self.scale > 0.0 { self.scale } else { 1.0 };
        let (natural, growth) = (self.residual / scale, self.terms / scale);
        Residuals { natural, growth, backward: natural / (1.0 + growth) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ProblemError;

    #[test]
    fn both_forms_of_a_problem_have_the_same_residuals() -> Result<(), ProblemError> {
        let rows = [(0, 0, 1.0), (0, 1, 2.0), (1, 1, -1.0), (1, 2, 0.5)];
        let by_rows = Problem::from_rows(&rows, &[0.5, 2.0, 0.0], &[-3.0, 1.0])?;
        let by_matrix = Problem::from_dense(&by_rows.dense(), by_rows.offset())?;
        let (x, y) = (Residuals::of(&by_rows, &[0.25, 1.5]), Residuals::of(&by_matrix, &[0.25, 1.5]));
        assert!((x.natural - y.natural).abs() < 1e-15 && (x.growth - y.growth).abs() < 1e-15);
        Ok(())
    }

    #[test]
    fn accelerations_are_those_of_the_matrix() -> Result<(), ProblemError> {
        let rows = [(0, 0, 1.0), (0, 1, 2.0), (1, 1, -1.0), (1, 2, 0.5), (2, 0, 3.0)];
        let problem = Problem::from_rows(&rows, &[0.5, 2.0, 0.0], &[-3.0, 1.0, 0.5])?;
        let force = [0.25, 1.5, -2.0];
        let dense = problem.dense();
        let accelerations = problem.accelerations(&force);
        for ((row, b), acceleration) in dense.iter().zip(problem.offset()).zip(accelerations) {
            let expected = row.iter().zip(&force).map(|(a, f)| a * f).sum::<f64>() + b;
            assert!((acceleration - expected).abs() < 1e-14);
        }
        Ok(())
    }

    #[test]
    fn a_force_that_is_not_a_number_is_never_accepted() -> Result<(), ProblemError> {
        let problem = Problem::from_dense(&[vec![1.0]], &[-1.0])?;
        let residuals = Residuals::of(&problem, &[f64::NAN]);
        assert!(!residuals.accepted(&Settings::default(), 0.0));
        Ok(())
    }
}
