//! A polynomial through values: both ends of a step with their rates, and five nodes between.
//!
//! The nodes are the zeros of the Jacobi polynomial of degree 5 for the weight (1 - s^2)^2, for which the
//! mean square of the error is least. Even and odd parts are found for themselves, in powers of s^2, by
//! divided differences.

use super::polynomial::{DEGREE, SegmentPolynomial};

/// Nearer root of 143 s^4 - 110 s^2 + 15: with 0 and the farther one it makes the inner nodes.
const NEAR: f64 = 0.420_914_805_023_811_46;
/// Farther root.
const FAR: f64 = 0.769_455_324_331_787_3;

impl SegmentPolynomial {
    /// Inner nodes of [`SegmentPolynomial::through`], as fractions of the step.
    pub const INNER: [f64; 5] = [0.5 - 0.5 * FAR, 0.5 - 0.5 * NEAR, 0.5, 0.5 + 0.5 * NEAR, 0.5 + 0.5 * FAR];

    /// The polynomial of degree 8 with a value and a rate [1/s] at each end of a step of a length [s], and values at
    /// the [inner nodes](SegmentPolynomial::INNER).
    #[must_use]
    pub fn through([start, end]: [[f64; 2]; 2], inner: [f64; 5], step: f64) -> Self {
        let [far_left, near_left, middle, near_right, far_right] = inner.map(|value| value - start[0]);
        let motion = end[0] - start[0];
        let [left, right] = [start[1], end[1]].map(|rate| 0.5 * step * rate);
        let (near, far) = (NEAR * NEAR, FAR * FAR);
        let even = newton(
            [0.0, near, far, 1.0, 1.0],
            [middle, 0.5 * (near_left + near_right), 0.5 * (far_left + far_right), 0.5 * motion],
            0.25 * (right - left),
        );
        let odd = newton(
            [near, far, 1.0, 1.0],
            [0.5 * (near_right - near_left) / NEAR, 0.5 * (far_right - far_left) / FAR, 0.5 * motion],
            0.25 * (left + right - motion),
        );
        let mut coefficients = [0.0; DEGREE + 1];
        for (power, coefficient) in even.into_iter().enumerate() {
            coefficients[2 * power] = coefficient;
        }
        for (power, coefficient) in odd.into_iter().enumerate() {
            coefficients[2 * power + 1] = coefficient;
        }
        Self::from_start(start[0], coefficients, step)
    }
}

/// Monomial coefficients of the polynomial with given values at nodes, the last two of which coincide, and a given
/// slope there.
fn newton<const N: usize, const M: usize>(nodes: [f64; N], values: [f64; M], slope: f64) -> [f64; N] {
    let mut differences = [0.0; N];
    differences[..M].copy_from_slice(&values);
    differences[M] = values[M - 1];
    for order in 1..N {
        for at in (order..N).rev() {
            let width = nodes[at] - nodes[at - order];
            differences[at] =
                if width == 0.0 { slope } else { (differences[at] - differences[at - 1]) / width };
        }
    }
    let mut coefficients = [0.0; N];
    for (at, &node) in nodes.iter().enumerate().rev() {
        // times (y - node), plus the next difference
        for power in (1..N).rev() {
            coefficients[power] = coefficients[power - 1] - node * coefficients[power];
        }
        coefficients[0] = differences[at] - node * coefficients[0];
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_degree_8_is_met_everywhere() {
        let value = |t: f64| 3.0 + t - 2.0 * t.powi(2) + t.powi(5) - 0.3 * t.powi(8);
        let rate = |t: f64| 1.0 - 4.0 * t + 5.0 * t.powi(4) - 2.4 * t.powi(7);
        let step = 1.3;
        let inner = SegmentPolynomial::INNER.map(|part| value(part * step));
        let ends = [0.0, step].map(|t| [value(t), rate(t)]);
        let path = SegmentPolynomial::through(ends, inner, step);
        for part in [0.0, 0.11, 0.4, 0.77, 1.0] {
            let t = part * step;
            assert!((path.value_at(t) - value(t)).abs() < 1e-14, "at {part}");
            assert!((path.derivative_at(t) - rate(t)).abs() < 1e-13, "rate at {part}");
            assert!((path.derivative().value_at(t) - rate(t)).abs() < 1e-13, "derivative at {part}");
        }
    }

    #[test]
    fn a_point_that_turns_by_two_radians_is_met_to_four_parts_in_1e8() {
        let inner = SegmentPolynomial::INNER.map(|part| (2.0 * part).sin());
        let ends = [[0.0, 1.0], [2.0f64.sin(), 2.0f64.cos()]];
        let path = SegmentPolynomial::through(ends, inner, 2.0);
        let errors = (0..=200).map(|i| f64::from(i) / 100.0).map(|t| (path.value_at(t) - t.sin()).abs());
        let largest = errors.fold(0.0, f64::max);
        assert!((1e-8..4e-8).contains(&largest), "{largest}");
    }
}
