//! Coefficients of the method of Radau IIA with three stages, and of the transformation that splits its equations.
//!
//! Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer 1996, IV.5
//! (Table 5.6) and IV.8. With the inverse of the matrix of stages A,
//!
//! ```text
//! T^-1 A^-1 T = [ real, 0, 0;  0, pair.0, -pair.1;  0, pair.1, pair.0 ]
//! ```

/// Square root of 6.
const ROOT: f64 = 2.449_489_742_783_178;

/// Places of the stages, as fractions of the step.
pub(super) const NODES: [f64; 3] = [(4.0 - ROOT) / 10.0, (4.0 + ROOT) / 10.0, 1.0];

/// The matrix A: the stages lie off the start by the step times these sums of their rates.
pub(super) const STAGES: [[f64; 3]; 3] = [
    [(88.0 - 7.0 * ROOT) / 360.0, (296.0 - 169.0 * ROOT) / 1800.0, (-2.0 + 3.0 * ROOT) / 225.0],
    [(296.0 + 169.0 * ROOT) / 1800.0, (88.0 + 7.0 * ROOT) / 360.0, (-2.0 - 3.0 * ROOT) / 225.0],
    [(16.0 - ROOT) / 36.0, (16.0 + ROOT) / 36.0, 1.0 / 9.0],
];

/// The real eigenvalue of the inverse of A.
pub(super) const REAL: f64 = 3.637_834_252_744_496;
/// Real and imaginary part of the other two.
pub(super) const PAIR: (f64, f64) = (2.681_082_873_627_752, 3.050_430_199_247_411);

/// T, which makes the stages of the unknowns that are solved for.
pub(super) const BACK: [[f64; 3]; 3] = [
    [0.091_232_394_870_892_95, -0.141_255_295_020_954_2, -0.030_029_194_105_147_424],
    [0.241_717_932_707_107, 0.204_129_352_293_799_94, 0.382_942_112_757_261_9],
    [0.966_048_182_615_093, 1.0, 0.0],
];

/// The inverse of T.
pub(super) const FORTH: [[f64; 3]; 3] = [
    [4.325_579_890_063_155, 0.339_199_251_815_809_84, 0.541_770_539_935_874_9],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_37, 0.476_623_554_500_550_44],
    [-0.502_872_634_945_786_8, 2.571_926_949_855_605, -0.596_039_204_828_224_9],
];

/// Weights of the stages in the estimate of the error, IV.8, (8.19): it compares with a formula of order 3 that has the
/// rates at the start beside the stages.
pub(super) const ERROR: [f64; 3] = [-(13.0 + 7.0 * ROOT) / 3.0, (-13.0 + 7.0 * ROOT) / 3.0, -1.0 / 3.0];

#[cfg(test)]
mod tests {
    use super::*;

    fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
    }

    #[test]
    fn stages_integrate_powers_up_to_their_number() {
        for power in 1..=3 {
            for (stage, node) in STAGES.iter().zip(NODES) {
                let sum: f64 =
                    stage.iter().zip(NODES).map(|(weight, node)| weight * node.powi(power - 1)).sum();
                assert!((sum - node.powi(power) / f64::from(power)).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn the_transformation_splits_the_stages() {
        let blocks = [[REAL, 0.0, 0.0], [0.0, PAIR.0, -PAIR.1], [0.0, PAIR.1, PAIR.0]];
        // A T blocks = T, and T^-1 T = 1.
        let (split, one) = (product(&product(&STAGES, &BACK), &blocks), product(&FORTH, &BACK));
        for row in 0..3 {
            for column in 0..3 {
                assert!((split[row][column] - BACK[row][column]).abs() < 1e-14, "{row} {column}: {split:?}");
                let identity = f64::from(u8::from(row == column));
                assert!((one[row][column] - identity).abs() < 1e-14, "{row} {column}: {one:?}");
            }
        }
    }
}
