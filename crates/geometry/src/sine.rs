//! Sine and cosine of an angle at once, the same bits on every machine.
//!
//! Poses are computed from little else, so the code is kept short: its only branch hands angles of many turns to
//! `libm`. The angle is reduced to an eighth of a turn either way in two parts (W. J. Cody and W. Waite, "Software
//! Manual for the Elementary Functions", 1980, ch. 8), where the Taylor series are summed pairwise. Near multiples of a
//! quarter turn the smaller of sine and cosine is exact to rounding of 1, not of itself; a rotation needs no more.

use std::f64::consts::FRAC_2_PI;

/// Largest angle [rad] of the series: beyond it the reduction would lose digits.
const LARGEST: f64 = 1e5;
/// Number that rounds a small number added to it to an integer; the last bits of the sum hold that integer.
const TO_INTEGER: f64 = 1.5 / f64::EPSILON;
/// First 33 bits of a quarter turn [rad].
const QUARTER: f64 = f64::from_bits(0x3ff9_21fb_5440_0000);
/// Rest of a quarter turn [rad] beyond [`QUARTER`].
const QUARTER_REST: f64 = f64::from_bits(0x3dd0_b461_1a62_6331);

/// Coefficients of the series (sin r - r)/r^3 = S0 + S1 r^2 + ...
const S: [f64; 8] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 355_687_428_096_000.0,
];
/// Coefficients of the series (cos r - 1 + r^2/2)/r^4 = C0 + C1 r^2 + ...
const C: [f64; 7] = [
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
];

/// Sine and cosine of an angle [rad], in this order; not numbers for an angle that is not finite.
#[inline]
pub(crate) fn sin_cos(angle: f64) -> (f64, f64) {
    // Angles that are not finite go to `libm`, too.
    if angle.abs() <= LARGEST { by_series(angle) } else { libm::sincos(angle) }
}

#[inline]
fn by_series(angle: f64) -> (f64, f64) {
    let shifted = angle * FRAC_2_PI + TO_INTEGER;
    let (quarters, last_bits) = (shifted - TO_INTEGER, shifted.to_bits());
    let near = angle - quarters * QUARTER;
    let rest = quarters * QUARTER_REST;
    let r = near - rest;
    let tail = (near - r) - rest;

    let z = r * r;
    let (z2, half) = (z * z, 0.5 * z);
    let z4 = z2 * z2;
    let s = ((S[0] + z * S[1]) + z2 * (S[2] + z * S[3])) + z4 * ((S[4] + z * S[5]) + z2 * (S[6] + z * S[7]));
    let c = ((C[0] + z * C[1]) + z2 * (C[2] + z * C[3])) + z4 * ((C[4] + z * C[5]) + z2 * C[6]);
    let rough = 1.0 - half;
    let sin = r + (r * z * s + tail * rough);
    let cos = rough + (((1.0 - rough) - half) + (z2 * c - r * tail));

    let (sin, cos) = if last_bits & 1 == 0 { (sin, cos) } else { (cos, -sin) };
    if last_bits & 2 == 0 { (sin, cos) } else { (-sin, -cos) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Larger of the differences of sine and cosine from those of `libm`, as a multiple of the machine epsilon [-].
    fn off(angle: f64) -> f64 {
        let ((sin, cos), (their_sin, their_cos)) = (sin_cos(angle), libm::sincos(angle));
        (sin - their_sin).abs().max((cos - their_cos).abs()) / f64::EPSILON
    }

    #[test]
    fn sine_and_cosine_are_right_to_rounding() {
        let (mut worst, mut angle) = (0.0f64, 1e-9);
        while angle < LARGEST {
            worst = worst.max(off(angle)).max(off(-angle));
            angle *= 1.000_01;
        }
        assert!(worst <= 0.5, "{worst}");
        for quarters in -4000..=4000 {
            for turn in [-1e-3, -1e-9, 0.0, 1e-12, 1e-5, 0.785] {
                let angle = f64::from(quarters) * FRAC_PI_2 + turn;
                assert!(off(angle) <= 0.5, "{angle}: {}", off(angle));
            }
        }
    }

    #[test]
    fn quarters_of_a_turn_come_out_even() {
        for (angle, sin, cos) in [(0.0, 0.0, 1.0), (FRAC_PI_2, 1.0, 0.0), (PI, 0.0, -1.0), (-PI, 0.0, -1.0)] {
            let (s, c) = sin_cos(angle);
            assert!((s - sin).abs() < f64::EPSILON && (c - cos).abs() < f64::EPSILON, "{angle}");
            assert!(s == sin || c == cos);
        }
    }

    #[test]
    fn a_turn_the_other_way_is_mirrored_bit_for_bit() {
        for angle in [1e-300, 1e-8, 0.3, 0.79, 1.1, 2.6, 4.0, 77.7, 9e4, 3e7] {
            let ((s, c), (s_back, c_back)) = (sin_cos(angle), sin_cos(-angle));
            assert_eq!((s.to_bits(), c.to_bits()), ((-s_back).to_bits(), c_back.to_bits()));
        }
    }

    #[test]
    fn numbers_that_are_not_finite_have_no_sine() {
        for angle in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(sin_cos(angle).0.is_nan() && sin_cos(angle).1.is_nan());
        }
    }
}
