//! Dense linear equations: LU factors of a square matrix, with pivots sought in columns.

/// A square matrix, row by row, and after [`Self::factorize`] its LU factors.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Factors {
    size: usize,
    entries: Vec<f64>,
    /// Row that was exchanged with each row.
    pivots: Vec<usize>,
}

impl Factors {
    /// Makes room for a square matrix of `size` rows, all zero, and returns its entries, row by row.
    pub(super) fn clear(&mut self, size: usize) -> &mut [f64] {
        self.size = size;
        self.entries.clear();
        self.entries.resize(size * size, 0.0);
        &mut self.entries
    }

    /// Factorises the entries; false if a pivot is zero or not finite.
    pub(super) fn factorize(&mut self) -> bool {
        let size = self.size;
        self.pivots.clear();
        for column in 0..size {
            let entry = |row: usize| self.entries[row * size + column].abs();
            let pivot =
                (column..size).fold(column, |best, row| if entry(row) > entry(best) { row } else { best });
            self.pivots.push(pivot);
            let largest = self.entries[pivot * size + column];
            if largest == 0.0 || !largest.is_finite() {
                return false;
            }
            if pivot != column {
                for at in 0..size {
                    self.entries.swap(pivot * size + at, column * size + at);
                }
            }
            let (above, below) = self.entries.split_at_mut((column + 1) * size);
            let pivot_row = &above[column * size..];
            for row in below.chunks_exact_mut(size) {
                if row[column] != 0.0 {
                    let factor = row[column] / largest;
                    row[column] = factor;
                    let rest = row[column + 1..].iter_mut().zip(&pivot_row[column + 1..]);
                    rest.for_each(|(entry, pivot)| *entry -= factor * pivot);
                }
            }
        }
        true
    }

    /// Solves in place: `x` is the right-hand side, then the solution.
    pub(super) fn solve(&self, x: &mut [f64]) {
        let size = self.size;
        for (row, &pivot) in self.pivots.iter().enumerate() {
            x.swap(row, pivot);
        }
        for row in 0..size {
            let (known, rest) = x.split_at_mut(row);
            rest[0] -= dot(&self.entries[row * size..row * size + row], known);
        }
        for row in (0..size).rev() {
            let (head, known) = x.split_at_mut(row + 1);
            let entries = &self.entries[row * size..(row + 1) * size];
            head[row] = (head[row] - dot(&entries[row + 1..], known)) / entries[row];
        }
    }
}

/// Sum of products.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_that_needs_pivots_is_solved() {
        let entries = [0.0, 2.0, 1.0, 1.0, 1e-20, 3.0, -4.0, 5.0, 0.5];
        let expected = [1.5, -2.0, 0.25];
        let mut factors = Factors::default();
        factors.clear(3).copy_from_slice(&entries);
        assert!(factors.factorize());
        let mut x: Vec<f64> = entries.chunks_exact(3).map(|row| dot(row, &expected)).collect();
        factors.solve(&mut x);
        for (x, expected) in x.iter().zip(expected) {
            assert!((x - expected).abs() < 1e-14, "{x}");
        }
    }

    #[test]
    fn singular_matrices_are_told() {
        let mut factors = Factors::default();
        factors.clear(2).copy_from_slice(&[1.0, 2.0, 2.0, 4.0]);
        assert!(!factors.factorize());
    }
}
