//! The complementarity problem of a few rows, solved directly.
//!
//! A heap takes thousands of rounds of a few rows each that close on the same bodies. First all rows are closed, which
//! mostly is the answer. Otherwise all wrong rows are exchanged at once while that leaves fewer of them wrong
//! (Portugal, Júdice and Vicente 1994; see `start`). A row that nearly depends on those before it gets no force, as
//! long as these hold it too. Problems that do not end so are left to `many_rows`.

use super::pair_problem::IN_DOUBLES;
use crate::settings::Settings;

/// Largest number of rows that are solved directly.
pub(super) const FEW: usize = 8;

/// Rounding of a rate, as a fraction of the scale plus the sum of its absolute terms.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Largest residual of an accepted answer, in units of the scale max |b/s|.
const ACCEPTED: f64 = 1e-14;

/// Number of exchanges in succession that may leave as many rows wrong as the best before, or more.
const TRIES: usize = 2;

/// A few rows: their matrix A [1/kg], their offsets b [m/s] (rates less targets), and one flag each for bilateral rows.
#[derive(Clone, Debug, Default)]
pub(super) struct FewRows {
    pub(super) count: usize,
    pub(super) matrix: [[f64; FEW]; FEW],
    pub(super) offset: [f64; FEW],
    pub(super) bilateral: [bool; FEW],
    /// Whether a row was found that depends on others, or nearly so.
    pub(super) depends: bool,
}

/// Impulses of a few rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FewImpulses {
    /// In the order of the rows [N s].
    pub(super) impulses: [f64; FEW],
    /// Largest violation that they leave, as a scaled rate: divided by sqrt(A_ii) [sqrt(kg) m/s].
    pub(super) left: f64,
}

impl FewRows {
    /// Finds the impulses f with A f + b >= 0, f >= 0, f.(A f + b) = 0, and A f + b = 0 on bilateral rows; `None` if
    /// the exchanges do not end at them. Scales the rows in place.
    pub(super) fn solve(&mut self) -> Option<FewImpulses> {
        let length = self.scale()?;
        let scale = self.offset[..self.count].iter().fold(0.0f64, |most, b| most.max(b.abs()));
        let limit = Settings::default().start_closed * scale;
        let mut closed: [bool; FEW] =
            std::array::from_fn(|row| row < self.count && (self.bilateral[row] || self.offset[row] <= limit));
        let (mut fewest, mut tries) = (usize::MAX, 0);
        loop {
            let (mut force, held) = self.hold(&closed);
            let mut wrong = 0;
            let mut left = 0.0f64;
            for row in 0..self.count {
                let (mut rate, mut terms) = (self.offset[row], scale);
                for (entry, force) in self.matrix[row].iter().zip(&force).take(self.count) {
                    let term = entry * force;
                    (rate, terms) = (rate + term, terms + term.abs());
                }
                let noise = ROUNDING * terms;
                left = left.max(if held[row] || self.bilateral[row] { rate.abs() } else { -rate });
                if closed[row] && !held[row] && (rate < -noise || (self.bilateral[row] && rate > noise)) {
                    return None;
                }
                let is_wrong = if held[row] {
                    force[row] < 0.0 && !self.bilateral[row]
                } else {
                    !closed[row] && rate < -noise
                };
                closed[row] ^= is_wrong;
                wrong += usize::from(is_wrong);
            }
            if wrong == 0 {
                (0..self.count).for_each(|row| force[row] /= length[row]);
                return (left <= ACCEPTED * scale).then_some(FewImpulses { impulses: force, left });
            }
            tries = if wrong < fewest { 0 } else { tries + 1 };
            fewest = fewest.min(wrong);
            if tries > TRIES {
                return None;
            }
        }
    }

    /// Scales all rows to a square A_ii of 1. Returns the former sqrt(A_ii) [1/sqrt(kg)]; `None` if one is not
    /// positive.
    fn scale(&mut self) -> Option<[f64; FEW]> {
        let length: [f64; FEW] =
            std::array::from_fn(|row| if row < self.count { self.matrix[row][row].sqrt() } else { 1.0 });
        if !length.iter().all(|length| *length > 0.0) {
            return None;
        }
        for row in 0..self.count {
            self.offset[row] /= length[row];
            for other in 0..self.count {
                self.matrix[row][other] /= length[row] * length[other];
            }
        }
        Some(length)
    }

    /// The forces that hold the closed rows, 0 on the others, and one flag per row that is active. Closed rows that
    /// nearly depend on earlier ones are not held.
    fn hold(&mut self, closed: &[bool; FEW]) -> ([f64; FEW], [bool; FEW]) {
        let mut rows = [0; FEW];
        let mut count = 0;
        // A = L D L^T by rows, with the forward substitution of the right-hand side.
        let mut factor = [[0.0; FEW]; FEW];
        let (mut pivot, mut value) = ([0.0; FEW], [0.0; FEW]);
        for candidate in (0..self.count).filter(|&row| closed[row]) {
            let mut square = self.matrix[candidate][candidate];
            let mut right = -self.offset[candidate];
            let mut row = [0.0; FEW];
            for j in 0..count {
                let known = (0..j).map(|k| row[k] * factor[j][k]).sum::<f64>();
                row[j] = self.matrix[candidate][rows[j]] - known;
            }
            for j in 0..count {
                factor[count][j] = row[j] / pivot[j];
                square -= factor[count][j] * row[j];
                right -= factor[count][j] * value[j];
            }
            if square > IN_DOUBLES {
                (rows[count], pivot[count], value[count]) = (candidate, square, right);
                count += 1;
            } else {
                self.depends = true;
            }
        }
        let (mut force, mut held) = ([0.0; FEW], [false; FEW]);
        for i in (0..count).rev() {
            let known = (i + 1..count).map(|k| factor[k][i] * force[rows[k]]).sum::<f64>();
            force[rows[i]] = value[i] / pivot[i] - known;
            held[rows[i]] = true;
        }
        (force, held)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn few(matrix: &[&[f64]], offset: &[f64]) -> FewRows {
        let mut few = FewRows { count: offset.len(), ..FewRows::default() };
        for (row, values) in matrix.iter().enumerate() {
            few.matrix[row][..values.len()].copy_from_slice(values);
        }
        few.offset[..offset.len()].copy_from_slice(offset);
        few
    }

    #[test]
    fn a_row_that_would_pull_opens() {
        // The second row is driven open by the first.
        let found = few(&[&[2.0, 1.9], &[1.9, 2.0]], &[-2.0, -0.1]).solve().expect("independent rows");
        assert_eq!(found.impulses[..2], [1.0, 0.0]);
    }

    #[test]
    fn of_rows_that_depend_on_each_other_as_many_are_held_as_it_takes() {
        // Three points of a block that lands flat: arms of -1, 0 and 1.
        let landing: [&[f64]; 3] = [&[2.0, 1.0, 0.0], &[1.0, 1.0, 1.0], &[0.0, 1.0, 2.0]];
        let found = few(&landing, &[-1.0, -1.0, -1.0]).solve().expect("they agree");
        assert_eq!(found.impulses[..3].iter().sum::<f64>(), 1.0);
        // The middle row is slower than the ends: held with one of the ends it drives the other to close, and another
        // choice is needed.
        assert_eq!(few(&landing, &[-1.0, -0.5, -1.0]).solve(), None);
    }

    #[test]
    fn rows_that_contradict_each_other_are_left() {
        assert_eq!(few(&[&[1.0, -1.0], &[-1.0, 1.0]], &[-1.0, -1.0]).solve(), None);
        assert_eq!(few(&[&[1.0, 1.0 - 1e-9], &[1.0 - 1e-9, 1.0]], &[-1.0, -1.0 - 1e-6]).solve(), None);
        assert_eq!(few(&[&[0.0]], &[-1.0]).solve(), None);
        assert_eq!(few(&[&[f64::NAN]], &[-1.0]).solve(), None);
    }

    proptest! {
        #[test]
        fn the_answer_found_satisfies_the_problem(
            rows in prop::collection::vec(prop::array::uniform8(-1.0..1.0f64), 1..=FEW),
            offset in prop::array::uniform8(-1.0..1.0f64),
            bilateral in prop::array::uniform8(prop::bool::weighted(0.2)),
            unit in prop_oneof![Just(1e-9), Just(1.0), Just(1e9)],
        ) {
            let mut problem = FewRows { count: rows.len(), offset, bilateral, ..FewRows::default() };
            for (i, p) in rows.iter().enumerate() {
                for (j, q) in rows.iter().enumerate() {
                    problem.matrix[i][j] = unit * p.iter().zip(q).map(|(p, q)| p * q).sum::<f64>();
                }
            }
            if let Some(found) = problem.clone().solve() {
                for row in 0..rows.len() {
                    let products = (0..rows.len()).map(|other| problem.matrix[row][other] * found.impulses[other]);
                    let rate = products.sum::<f64>() + offset[row];
                    let impulse = found.impulses[row];
                    if bilateral[row] || impulse > 0.0 {
                        prop_assert!(rate.abs() < 1e-12, "{rate}");
                    }
                    prop_assert!(bilateral[row] || (impulse >= 0.0 && rate > -1e-12), "{impulse}, {rate}");
                }
            }
        }
    }
}
