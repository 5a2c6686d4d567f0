//! Recognition of contacts with friction in a general complementarity problem of Stewart and Trinkle's form.
//!
//! There a friction row has become three, β⁺, β⁻ and σ (see `stewart_trinkle`): the row of σ has no diagonal, mu at its normal
//! row, and -1 at β⁺ and β⁻, which have 1 at σ and are opposite to each other elsewhere. [`Modes`] takes a hundredth of
//! Lemke's time on a hundred contacts.

use super::modes::Modes;
use crate::kind::RowKind;
use crate::matrix::{Matrix, SparseMatrix};
use crate::problem::Problem;
use crate::solution::Solution;
use crate::solver::Solver;

/// Largest difference of entries that are opposite to each other, in units of the larger: the rounding of their products.
const OPPOSITE: f64 = 1e-12;

/// The rows of one contact.
#[derive(Clone, Copy, Debug)]
struct Contact {
    normal: usize,
    plus: usize,
    minus: usize,
    slip: usize,
    coefficient: f64,
}

/// A problem with friction, and the rows of the general problem that it was found in.
pub(crate) struct Recognised {
    problem: Problem,
    contacts: Vec<Contact>,
    /// The rows that are left, by their place.
    kept: Vec<usize>,
}

impl Recognised {
    /// Finds the contacts of a general problem; `None` if there are none.
    pub(crate) fn of(problem: &Problem) -> Option<Self> {
        let Matrix::General(matrix) = &problem.matrix else { return None };
        let slips =
            (0..matrix.rows()).filter(|&row| matrix.entry(row, row) == 0.0 && problem.offset[row] == 0.0);
        let contacts: Vec<Contact> =
            slips.filter_map(|slip| contact(matrix, &problem.offset, slip)).collect();
        if contacts.is_empty() {
            return None;
        }
        let mut is_left_out = vec![false; problem.len()];
        for contact in &contacts {
            (is_left_out[contact.minus], is_left_out[contact.slip]) = (true, true);
        }
        let kept: Vec<usize> = (0..problem.len()).filter(|&row| !is_left_out[row]).collect();
        let mut place = vec![usize::MAX; problem.len()];
        kept.iter().enumerate().for_each(|(at, &row)| place[row] = at);
        let mut triplets = Vec::new();
        for &row in &kept {
            let (columns, values) = matrix.row(row);
            let inside = columns.iter().zip(values).filter(|(k, _)| place[**k] != usize::MAX);
            triplets.extend(inside.map(|(&k, &value)| (place[row], place[k], value)));
        }
        let offset: Vec<f64> = kept.iter().map(|&row| problem.offset[row]).collect();
        let mut found = Problem::from_general(&triplets, &offset).ok()?;
        let bilateral: Vec<bool> = kept.iter().map(|&row| problem.bilateral[row]).collect();
        found.set_bilateral(&bilateral).ok()?;
        for contact in &contacts {
            let kind = RowKind::Friction { normal: place[contact.normal], coefficient: contact.coefficient };
            found.set_kind(*place.get(contact.plus)?, kind).ok()?;
        }
        Some(Self { problem: found, contacts, kept })
    }

    /// Solves by modes; the forces of the general problem go to `force`. False if no answer was found.
    pub(crate) fn solve(&self, modes: &mut Modes, force: &mut [f64]) -> bool {
        let mut solution = Solution::new();
        if modes.solve(&self.problem, &mut solution).is_err() {
            return false;
        }
        force.fill(0.0);
        let mut slip = vec![0.0; force.len()];
        for (at, &row) in self.kept.iter().enumerate() {
            (force[row], slip[row]) = (solution.force[at], solution.acceleration[at]);
        }
        for contact in &self.contacts {
            let friction = force[contact.plus];
            (force[contact.plus], force[contact.minus]) = (friction.max(0.0), (-friction).max(0.0));
            // Of the room in the cone and the slip speed one is zero, up to rounding.
            let room = contact.coefficient * force[contact.normal] - friction.abs();
            let speed = slip[contact.plus].abs();
            force[contact.slip] = if room < speed { speed } else { 0.0 };
        }
        true
    }
}

/// The contact whose σ is in row `slip`.
fn contact(matrix: &SparseMatrix, offset: &[f64], slip: usize) -> Option<Contact> {
    let (mut normal, mut lifted) = (None, Vec::new());
    let (columns, values) = matrix.row(slip);
    for (&k, &value) in columns.iter().zip(values).filter(|(_, value)| **value != 0.0) {
        if value == -1.0 && matrix.entry(k, slip) == 1.0 {
            lifted.push(k);
        } else if value > 0.0 && matrix.entry(k, slip) == 0.0 && normal.is_none() {
            normal = Some((k, value));
        } else {
            return None;
        }
    }
    let (&[plus, minus], (normal, coefficient)) = (lifted.as_slice(), normal?) else { return None };
    let is_opposite = |a: f64, b: f64| (a + b).abs() <= OPPOSITE * a.abs().max(b.abs());
    let rows_are_opposite = (0..matrix.rows())
        .filter(|&k| k != slip)
        .all(|k| is_opposite(matrix.entry(plus, k), matrix.entry(minus, k)));
    let columns_are_opposite = (0..matrix.rows())
        .filter(|&k| k != slip)
        .all(|k| is_opposite(matrix.entry(k, plus), matrix.entry(k, minus)));
    let is_contact = rows_are_opposite && columns_are_opposite && is_opposite(offset[plus], offset[minus]);
    is_contact.then_some(Contact { normal, plus, minus, slip, coefficient })
}
