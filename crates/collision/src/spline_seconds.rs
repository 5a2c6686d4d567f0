//! The second derivatives of cubic splines at their knots, of numbers or of points.
//!
//! With h the widths of the pieces, D the divided differences and M the second derivatives at the knots, continuity of the
//! first derivative asks h[i-1] M[i-1] + 2 (h[i-1] + h[i]) M[i] + h[i] M[i+1] = 6 (D[i] - D[i-1]); natural ends have M = 0,
//! a closed spline has one such equation for every knot. The system is diagonally dominant: elimination without pivots.
//!
//! Source: C. de Boor, "A Practical Guide to Splines", 1978, chapter IV; for the corner entries of the closed system
//! W. Press et al., "Numerical Recipes", 2.7 (Sherman-Morrison).

use std::ops::{Add, Div, Mul, Sub};

/// What a spline may go through.
pub(crate) trait Vector:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> + Div<f64, Output = Self>
{
}

impl<T> Vector for T where
    T: Copy + Default + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T> + Div<f64, Output = T>
{
}

/// Second derivatives at the knots of an open spline, 0 at its ends.
pub(crate) fn natural_seconds<T: Vector>(widths: &[f64], slopes: &[T]) -> Vec<T> {
    let inner = widths.len() - 1;
    let diagonal: Vec<f64> = (0..inner).map(|i| 2.0 * (widths[i] + widths[i + 1])).collect();
    let mut seconds: Vec<T> = (0..inner).map(|i| (slopes[i + 1] - slopes[i]) * 6.0).collect();
    if inner > 0 {
        solve_tridiagonal(&diagonal, &widths[1..inner], &mut seconds);
    }
    seconds.insert(0, T::default());
    seconds.push(T::default());
    seconds
}

/// Second derivatives at the knots of a closed spline, the last of which is not repeated.
pub(crate) fn closed_seconds<T: Vector>(widths: &[f64], slopes: &[T]) -> Vec<T> {
    let count = widths.len();
    let before = |i: usize| (i + count - 1) % count;
    let mut diagonal: Vec<f64> = (0..count).map(|i| 2.0 * (widths[before(i)] + widths[i])).collect();
    let mut seconds: Vec<T> = (0..count).map(|i| (slopes[i] - slopes[before(i)]) * 6.0).collect();
    // The two corner entries belong to a matrix of rank one, corner (1, 0, .., 0, 1)(1, 0, .., 0, 1)^T, whose diagonal
    // entries are subtracted first.
    let corner = widths[count - 1];
    diagonal[0] -= corner;
    diagonal[count - 1] -= corner;
    let mut unit = vec![0.0; count];
    (unit[0], unit[count - 1]) = (corner, corner);
    solve_tridiagonal(&diagonal, &widths[..count - 1], &mut seconds);
    solve_tridiagonal(&diagonal, &widths[..count - 1], &mut unit);
    let share = (seconds[0] + seconds[count - 1]) / (1.0 + unit[0] + unit[count - 1]);
    seconds.iter().zip(&unit).map(|(&second, &unit)| second - share * unit).collect()
}

/// Solves a symmetric tridiagonal system with the entries `beside` the diagonal, in place of its right side.
fn solve_tridiagonal<T: Vector>(diagonal: &[f64], beside: &[f64], right: &mut [T]) {
    let mut pivots = diagonal.to_vec();
    for i in 1..diagonal.len() {
        let factor = beside[i - 1] / pivots[i - 1];
        pivots[i] -= factor * beside[i - 1];
        let above = right[i - 1];
        right[i] = right[i] - above * factor;
    }
    for i in (0..diagonal.len()).rev() {
        let below = if i + 1 < diagonal.len() { right[i + 1] * beside[i] } else { T::default() };
        right[i] = (right[i] - below) / pivots[i];
    }
}
