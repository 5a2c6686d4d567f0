//! Rows that depend on others and contradict them, by rounding or in earnest.
//!
//! Along a null direction z of the rows (Â z = 0, z ≥ 0 on unilateral rows), zᵀâ = zᵀb̂ for any forces. If all of these
//! rows are bilateral it must be zero, else it must not be negative. A small contradiction comes from rounding in b,
//! and is removed by the least change of b that does so, b̂ - (zᵀb̂/|z|²) z: the accelerations of the contradicting
//! rows are then those of a least-squares solution. A large one proves that there is no solution (Farkas' lemma).

use crate::closed_rows::ClosedRows;
use crate::error::Infeasibility;
use crate::problem::{Problem, pushing};
use crate::twofold::Number;

/// The outcome of a contradiction along a null direction.
pub(crate) enum Reconciled {
    /// The contradiction was small; it was taken off b̂.
    Shifted,
    /// The direction proves that there is no solution.
    Infeasible(Box<Infeasibility>),
    /// The direction is too inexact to prove anything.
    Unproven,
}

/// The amounts taken off b̂ to remove contradictions.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Shift {
    taken: Vec<f64>,
    /// Null directions of the bilateral rows, orthogonal to each other, along which b̂ is zero now.
    basis: Vec<Vec<f64>>,
    /// Largest |â| of an open bilateral row, which nearly depends on closed ones.
    rest: f64,
    /// Whether bilateral rows contradicted each other.
    pub(crate) connectors: bool,
}

impl Shift {
    pub(crate) fn reset(&mut self) {
        self.taken.clear();
        self.basis.clear();
        self.rest = 0.0;
        self.connectors = false;
    }

    /// Largest change of a row's b̂, or acceleration of an open bilateral row, in units of the scale.
    pub(crate) fn inconsistency(&self, scale: f64) -> f64 {
        self.taken.iter().fold(self.rest, |m: f64, t| m.max(t.abs())) / scale
    }

    /// Counts the accelerations of open bilateral rows as contradictions: they may contradict the closed rows although
    /// they depend on them only nearly.
    pub(crate) fn count_rest(&mut self, closed: &ClosedRows) {
        let open = (0..closed.free.len()).filter(|&row| closed.free[row] && !closed.is_closed(row));
        let taken = |row: usize| self.taken.get(row).copied().unwrap_or(0.0);
        self.rest = open.fold(0.0, |m: f64, row| m.max((closed.acceleration[row] + taken(row)).abs()));
    }

    /// Settles the contradiction of `row`, last considered, which depends on the closed rows and closes although no
    /// closed force blocks the null direction. A contradiction up to `limit` (in scaled accelerations) is taken off b̂;
    /// a larger one is a proof if any solution would have at least `least_growth`.
    pub(crate) fn reconcile(
        &mut self,
        closed: &mut ClosedRows,
        row: usize,
        limit: f64,
        least_growth: f64,
    ) -> Reconciled {
        let mut direction = null_direction(closed, row);
        // The agreement of the bilateral rows must not be undone.
        make_orthogonal(&mut direction, &self.basis);
        if self.remove(closed, &direction, limit) {
            return Reconciled::Shifted;
        }
        // Components that rounding has left below zero matter for the shift, but are no part of a proof.
        let contacts = direction.iter_mut().zip(&closed.free).filter(|(_, free)| !**free);
        contacts.for_each(|(z, _)| *z = pushing(*z));
        let violated = dot(&direction, &closed.system.b) < 0.0;
        let proof = Box::new(certificate(closed, &direction, row));
        if violated && proof.least_growth() >= least_growth {
            Reconciled::Infeasible(proof)
        } else {
            Reconciled::Unproven
        }
    }

    /// Makes dependent bilateral rows agree with the closed ones, all at once by least squares; or returns the proof
    /// that they contradict each other by more than `limit` (in scaled accelerations).
    pub(crate) fn reconcile_connectors(
        &mut self,
        closed: &mut ClosedRows,
        problem: &Problem,
        noise: f64,
        limit: f64,
    ) -> Option<Box<Infeasibility>> {
        let contradicts = |row: usize, a: f64| problem.bilateral[row] && a.abs() > noise;
        if !(0..problem.len()).any(|row| contradicts(row, closed.acceleration[row])) {
            return None;
        }
        self.connectors = true;
        for row in 0..problem.len() {
            if !problem.bilateral[row] || closed.is_closed(row) {
                continue;
            }
            closed.consider(row);
            closed.find_response();
            let mut direction = null_direction(closed, row);
            // Orthogonal directions can be settled one by one.
            make_orthogonal(&mut direction, &self.basis);
            if !self.remove(closed, &direction, limit.max(noise)) {
                return Some(Box::new(certificate(closed, &direction, row)));
            }
            self.basis.push(direction);
        }
        None
    }

    /// Removes the contradiction along a direction by the least change of b̂. Returns false, without a change, if that
    /// would change a row by more than `limit`.
    fn remove(&mut self, closed: &mut ClosedRows, direction: &[f64], limit: f64) -> bool {
        let (factor, size) = least_change(direction, &closed.system.b);
        if size > limit {
            return false;
        }
        self.taken.resize(direction.len(), 0.0);
        for ((taken, b), z) in self.taken.iter_mut().zip(&mut closed.system.b).zip(direction) {
            *taken += factor * z;
            *b -= factor * z;
        }
        true
    }
}

/// The least change of b̂ that removes the contradiction along a direction: the multiple of the direction that it takes
/// off, and the largest change of a row.
fn least_change(direction: &[f64], b: &[f64]) -> (f64, f64) {
    let factor = dot(direction, b) / dot(direction, direction);
    let largest = direction.iter().fold(0.0, |m: f64, z| m.max(z.abs()));
    (factor, factor.abs() * largest)
}

/// Makes a direction orthogonal to others, which are orthogonal to each other; two passes are enough (Kahan and
/// Parlett).
pub(crate) fn make_orthogonal<T: Number>(direction: &mut [T], basis: &[Vec<T>]) {
    for other in basis.iter().chain(basis) {
        let overlap = dot(direction, other) / dot(other, other);
        direction.iter_mut().zip(other).for_each(|(d, o)| *d = *d - overlap * *o);
    }
}

/// The direction in which `row`, last considered, and the closed rows cancel each other. It is positive on contacts, up
/// to rounding, and of either sign on connectors.
fn null_direction(closed: &ClosedRows, row: usize) -> Vec<f64> {
    let mut direction = vec![0.0; closed.force.len()];
    for (at, &other) in closed.rows.iter().enumerate() {
        direction[other] = -closed.step[at];
    }
    direction[row] = 1.0;
    direction
}

/// The proof by a null direction, which serves with either sign if all of its rows are bilateral.
fn certificate(closed: &mut ClosedRows, direction: &[f64], row: usize) -> Infeasibility {
    let (_, size) = least_change(direction, &closed.system.b);
    let scale = closed.system.scale;
    let sign = if dot(direction, &closed.system.b) > 0.0 { -1.0 } else { 1.0 };
    let mut image = vec![0.0; direction.len()];
    closed.system.accelerate(direction, &mut image);
    let largest = direction.iter().fold(0.0, |m: f64, z| m.max(z.abs()));
    let leakage =
        image.iter().zip(&closed.system.b).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / largest;
    let unscaled = direction.iter().zip(&closed.system.row_scale).map(|(z, s)| sign * z / s).collect();
    Infeasibility { row, direction: unscaled, contradiction: size / scale, leakage }
}

pub(crate) fn dot<T: Number>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::default(), |sum, (x, y)| sum + *x * *y)
}
