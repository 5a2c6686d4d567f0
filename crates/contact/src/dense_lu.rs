//! LU factors of a full matrix, by faer. They use one thread whatever the process has set for faer, so that sums keep
//! their order, and do not change that setting.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::prelude::ReborrowMut;
use faer::{Mat, MatMut, Par};

/// A square matrix as P A = L U, rows exchanged for the largest pivots.
#[derive(Clone, Debug)]
pub(crate) struct DenseLu {
    /// L below the diagonal, U on it and above.
    factors: Mat<f64>,
    order: Vec<usize>,
    place: Vec<usize>,
}

impl DenseLu {
    /// Factorises a square matrix. With a singular one, solutions are not finite.
    pub(crate) fn new(mut matrix: Mat<f64>) -> Self {
        let n = matrix.nrows();
        let (mut order, mut place) = (vec![0; n], vec![0; n]);
        let size = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default());
        let mut memory = MemBuffer::new(size);
        let stack = MemStack::new(&mut memory);
        let settings = Default::default();
        factor::lu_in_place(matrix.as_mut(), &mut order, &mut place, Par::Seq, stack, settings);
        Self { factors: matrix, order, place }
    }

    /// Solves A x = `right` in its place.
    pub(crate) fn solve_in_place(&self, right: &mut [f64]) {
        let n = self.order.len();
        let mut memory = MemBuffer::new(solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq));
        let stack = MemStack::new(&mut memory);
        let rows = PermRef::new_checked(&self.order, &self.place, n);
        let mut right = MatMut::from_column_major_slice_mut(right, n, 1);
        let factors = self.factors.as_ref();
        solve::solve_in_place(factors, factors, rows, right.rb_mut(), Par::Seq, stack);
    }
}

#[cfg(test)]
mod tests {
    use super::DenseLu;
    use faer::Mat;

    #[test]
    fn rows_are_exchanged_for_the_largest_pivots() {
        let rows = [[0.0, 2.0, 1.0], [4.0, 0.0, 0.0], [1.0, 1.0, 3.0]];
        let expected = [1.0, -2.0, 0.5];
        let mut x = rows.map(|row: [f64; 3]| row.iter().zip(&expected).map(|(a, x)| a * x).sum::<f64>());
        DenseLu::new(Mat::from_fn(3, 3, |i, j| rows[i][j])).solve_in_place(&mut x);
        assert!(x.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-15), "{x:?}");
    }

    #[test]
    fn without_rows_there_is_nothing_to_solve() {
        DenseLu::new(Mat::zeros(0, 0)).solve_in_place(&mut []);
    }
}
