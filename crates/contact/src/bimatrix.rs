//! Recognition of bimatrix games among linear complementarity problems. `lemke` solves them.
//!
//! R. Cottle, J.-S. Pang, R. Stone, "The Linear Complementarity Problem", 1992, section 1.2: with the costs A, B > 0 of
//! two players, M = [0 A; Bᵀ 0] and q = -1, a solution is, up to its size on either side, a pair of strategies in
//! equilibrium. Here rows may be in any order, and q may be any negative vector, which is a matter of scale.

use crate::matrix::SparseMatrix;
use crate::problem::Problem;

/// True if a problem is that of a bimatrix game: rows on two sides, each with positive entries in all columns
/// of the other side and none in those of its own, and b < 0.
pub(crate) fn is_bimatrix_game(matrix: &SparseMatrix, problem: &Problem) -> bool {
    let n = problem.len();
    if n < 2 || problem.bilateral.contains(&true) || problem.offset.iter().any(|b| *b >= 0.0) {
        return false;
    }
    let mut is_other = vec![false; n];
    entries(matrix, 0).for_each(|(j, _)| is_other[j] = true);
    let others = is_other.iter().filter(|is_other| **is_other).count();
    let joins_sides = |i: usize| {
        let met = if is_other[i] { n - others } else { others };
        entries(matrix, i).count() == met
            && entries(matrix, i).all(|(j, v)| v > 0.0 && is_other[j] != is_other[i])
    };
    others > 0 && (0..n).all(joins_sides)
}

/// Columns and values of a row, without stored zeros.
fn entries(matrix: &SparseMatrix, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
    let (columns, values) = matrix.row(row);
    columns.iter().copied().zip(values.iter().copied()).filter(|(_, v)| *v != 0.0)
}
