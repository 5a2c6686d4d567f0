//! Sparse matrices by rows, and the rows J of bodies with their inverse masses.
//!
//! A is given by its entries, or by J and the masses as A = J M⁻¹ Jᵀ. The row of a contact touches two bodies, so J has
//! at most six entries a row however many contacts a body has, while A may be full (a box on 100 floor points).

use crate::error::ProblemError;

/// Largest difference across the diagonal of a symmetric matrix, in units of sqrt(A_ii A_jj): far above the rounding of
/// the products that make it, far below any friction coefficient.
const SYMMETRY: f64 = 1e-9;

/// A sparse matrix stored by rows, entries of a row in ascending order of column, none twice.
#[derive(Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SparseMatrix {
    pub(crate) start: Vec<usize>,
    pub(crate) column: Vec<usize>,
    pub(crate) value: Vec<f64>,
}

impl Clone for SparseMatrix {
    fn clone(&self) -> Self {
        let SparseMatrix { start, column, value } = self;
        SparseMatrix { start: start.clone(), column: column.clone(), value: value.clone() }
    }

    /// Reuses the memory of the buffers, which a derived `clone_from` would not.
    fn clone_from(&mut self, source: &Self) {
        self.start.clone_from(&source.start);
        self.column.clone_from(&source.column);
        self.value.clone_from(&source.value);
    }
}

impl SparseMatrix {
    /// No rows.
    pub(crate) fn new() -> Self {
        SparseMatrix { start: vec![0], column: Vec::new(), value: Vec::new() }
    }

    pub(crate) fn rows(&self) -> usize {
        self.start.len() - 1
    }

    /// Columns and values of one row.
    pub(crate) fn row(&self, row: usize) -> (&[usize], &[f64]) {
        let range = self.start[row]..self.start[row + 1];
        (&self.column[range.clone()], &self.value[range])
    }

    /// Takes the last row off.
    pub(crate) fn pop_row(&mut self) {
        self.start.pop();
        let end = self.start.last().copied().unwrap_or(0);
        self.column.truncate(end);
        self.value.truncate(end);
    }

    /// The entry at one place, zero where none is stored.
    pub(crate) fn entry(&self, row: usize, column: usize) -> f64 {
        let (columns, values) = self.row(row);
        columns.binary_search(&column).map_or(0.0, |k| values[k])
    }

    /// Makes a matrix from entries (row, column, value); entries at the same place add up.
    pub(crate) fn from_triplets(
        rows: usize,
        columns: usize,
        triplets: &[(usize, usize, f64)],
    ) -> Result<Self, ProblemError> {
        for &(row, column, value) in triplets {
            if row >= rows {
                return Err(ProblemError::NoSuchRow { row, rows });
            }
            if column >= columns {
                return Err(ProblemError::NoSuchColumn { row, column, columns });
            }
            check_finite(row, "a coefficient", value)?;
        }
        let mut sorted = triplets.to_vec();
        sorted.sort_by_key(|&(row, column, _)| (row, column));
        let mut matrix = SparseMatrix::new();
        for &(row, column, value) in &sorted {
            while matrix.rows() <= row {
                matrix.start.push(matrix.column.len());
            }
            let in_row = matrix.column.len() > matrix.start[row];
            match (in_row, matrix.column.last(), matrix.value.last_mut()) {
                (true, Some(&last), Some(sum)) if last == column => *sum += value,
                _ => {
                    matrix.column.push(column);
                    matrix.value.push(value);
                }
            }
            if let Some(end) = matrix.start.last_mut() {
                *end = matrix.column.len();
            }
        }
        while matrix.rows() < rows {
            matrix.start.push(matrix.column.len());
        }
        for row in 0..rows {
            matrix.row(row).1.iter().try_for_each(|&sum| check_finite(row, "a sum of coefficients", sum))?;
        }
        Ok(matrix)
    }

    /// Checks that a square matrix is symmetric up to rounding, has no negative diagonal entry, and no entry larger
    /// than its diagonal allows.
    pub(crate) fn check_symmetric(&self) -> Result<(), ProblemError> {
        let diagonal: Vec<f64> = (0..self.rows()).map(|row| self.entry(row, row)).collect();
        if let Some(row) = diagonal.iter().position(|&d| d < 0.0) {
            return Err(ProblemError::NegativeDiagonal { row, value: diagonal[row] });
        }
        for row in 0..self.rows() {
            let (columns, values) = self.row(row);
            for (&column, &value) in columns.iter().zip(values) {
                let difference = value - self.entry(column, row);
                let size = diagonal[row].sqrt() * diagonal[column].sqrt();
                if difference.abs() > SYMMETRY * size {
                    return Err(ProblemError::NotSymmetric { row, column, difference });
                }
                if value.abs() > (1.0 + SYMMETRY) * size {
                    return Err(ProblemError::NotSemidefinite { row, column, value });
                }
            }
        }
        Ok(())
    }
}

/// The rows J and the inverse mass of each of its columns.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct BodyRows {
    pub(crate) rows: SparseMatrix,
    /// Inverse mass [1/kg], or inverse moment of inertia [1/(kg m²)], of each column; 0 for an immovable one.
    pub(crate) inverse_mass: Vec<f64>,
}

impl BodyRows {
    pub(crate) fn new() -> Self {
        BodyRows { rows: SparseMatrix::new(), inverse_mass: Vec::new() }
    }

    /// Refuses a row whose square J M⁻¹ Jᵀ over- or underflows.
    pub(crate) fn check_square(&self, row: usize) -> Result<(), ProblemError> {
        let (columns, values) = self.rows.row(row);
        let (mut square, mut moves) = (0.0, false);
        for (&column, &value) in columns.iter().zip(values) {
            let scaled = value * self.inverse_mass[column].sqrt();
            square += scaled * scaled;
            moves |= value != 0.0 && self.inverse_mass[column] != 0.0;
        }
        if moves && !f64::is_normal(square) {
            return Err(ProblemError::OutOfRange { row, value: square });
        }
        Ok(())
    }

    /// Calls `act` with the place of each term J_ik M⁻¹_k J_jk of an entry of A = J M⁻¹ Jᵀ, and its factors, row by row.
    pub(crate) fn visit_terms(&self, mut act: impl FnMut(usize, usize, [f64; 3])) {
        let touching = self.touching();
        for row in 0..self.rows.rows() {
            let (columns, values) = self.rows.row(row);
            for (&k, &v) in columns.iter().zip(values) {
                touching[k].iter().for_each(|&(other, w)| act(row, other, [v, self.inverse_mass[k], w]));
            }
        }
    }

    /// The rows with a coefficient in each column, and the coefficient.
    fn touching(&self) -> Vec<Vec<(usize, f64)>> {
        let mut touching: Vec<Vec<(usize, f64)>> = vec![Vec::new(); self.inverse_mass.len()];
        for row in 0..self.rows.rows() {
            let (columns, values) = self.rows.row(row);
            columns.iter().zip(values).for_each(|(&k, &v)| touching[k].push((row, v)));
        }
        touching
    }

    /// A = J M⁻¹ Jᵀ, its entries.
    pub(crate) fn product(&self) -> SparseMatrix {
        let n = self.rows.rows();
        let touching = self.touching();
        let mut product = SparseMatrix::new();
        let mut sum = vec![0.0; n];
        for row in 0..n {
            let (columns, values) = self.rows.row(row);
            let mut used: Vec<usize> = Vec::new();
            for (&k, &v) in columns.iter().zip(values) {
                for &(other, w) in &touching[k] {
                    used.push(other);
                    sum[other] += v * self.inverse_mass[k] * w;
                }
            }
            used.sort_unstable();
            used.dedup();
            for other in used {
                product.column.push(other);
                product.value.push(sum[other]);
                sum[other] = 0.0;
            }
            product.start.push(product.column.len());
        }
        product
    }
}

/// The matrix A of a problem, in the form in which it was given.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Matrix {
    /// A = J M⁻¹ Jᵀ, symmetric and positive semidefinite by construction.
    Bodies(BodyRows),
    /// The entries of a symmetric, positive semidefinite A.
    Symmetric(SparseMatrix),
    /// The entries of any square A.
    General(SparseMatrix),
}

pub(crate) fn check_finite(row: usize, what: &'static str, value: f64) -> Result<(), ProblemError> {
    if value.is_finite() { Ok(()) } else { Err(ProblemError::NotFinite { row, what, value }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_at_one_place_add_up() -> Result<(), ProblemError> {
        let matrix = SparseMatrix::from_triplets(3, 2, &[(2, 1, 1.0), (0, 0, 2.0), (2, 1, 0.5)])?;
        assert_eq!((matrix.rows(), matrix.entry(2, 1), matrix.entry(1, 0)), (3, 1.5, 0.0));
        Ok(())
    }

    #[test]
    fn asymmetry_is_named_by_row_and_column() -> Result<(), ProblemError> {
        let matrix =
            SparseMatrix::from_triplets(2, 2, &[(0, 0, 1.0), (0, 1, 0.5), (1, 0, 0.4), (1, 1, 1.0)])?;
        assert!(matches!(
            matrix.check_symmetric(),
            Err(ProblemError::NotSymmetric { row: 0, column: 1, .. })
        ));
        Ok(())
    }
}
