//! Numbers of twice as many digits: unevaluated sums of two `f64`.
//!
//! T. Dekker, "A floating-point technique for extending the available precision", Numerische Mathematik 18, 1971; sums
//! after D. Knuth. About 31 decimal digits; more than ten times slower than `f64`.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// 2^27 + 1, which splits the digits of an `f64` into halves with exact products.
const SPLITTER: f64 = 134_217_729.0;

/// Type of the entries of a dictionary.
pub(crate) trait Number:
    Copy
    + std::fmt::Debug
    + Default
    + PartialOrd
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Unit of the last digit of 1.
    const ROUNDING: f64;

    /// The nearest `f64`.
    fn nearest(self) -> f64;

    /// The absolute value.
    fn abs(self) -> Self {
        if self < Self::default() { -self } else { self }
    }
}

impl Number for f64 {
    const ROUNDING: f64 = f64::EPSILON;

    fn nearest(self) -> f64 {
        self
    }
}

/// A sum of two `f64`, the second at most a rounding of the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Twofold {
    high: f64,
    low: f64,
}

impl Number for Twofold {
    const ROUNDING: f64 = f64::EPSILON * f64::EPSILON;

    fn nearest(self) -> f64 {
        self.high
    }
}

impl Twofold {
    /// The sum of two numbers, of which the first is the larger one.
    fn of_ordered(large: f64, small: f64) -> Self {
        let high = large + small;
        Self { high, low: small - (high - large) }
    }

    /// The sum of two numbers, exactly.
    fn of_sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let part = high - a;
        Self { high, low: (a - (high - part)) + (b - part) }
    }

    /// The product of two numbers, exactly.
    fn of_product(a: f64, b: f64) -> Self {
        let halves = |x: f64| {
            let large = SPLITTER * x;
            let head = large - (large - x);
            (head, x - head)
        };
        let ((a_head, a_tail), (b_head, b_tail)) = (halves(a), halves(b));
        let high = a * b;
        let low = ((a_head * b_head - high) + a_head * b_tail + a_tail * b_head) + a_tail * b_tail;
        Self { high, low }
    }
}

impl From<f64> for Twofold {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Neg for Twofold {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Add for Twofold {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (high, low) = (Self::of_sum(self.high, other.high), Self::of_sum(self.low, other.low));
        let sum = Self::of_ordered(high.high, high.low + low.high);
        Self::of_ordered(sum.high, sum.low + low.low)
    }
}

impl Sub for Twofold {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Twofold {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = Self::of_product(self.high, other.high);
        Self::of_ordered(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Twofold {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::from(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::from(second);
        Self::of_ordered(first, second) + Self::from(rest.high / other.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn third() -> Twofold {
        Twofold::from(1.0) / Twofold::from(3.0)
    }

    #[test]
    fn a_third_has_31_digits() {
        let rest = third() * Twofold::from(3.0) - Twofold::from(1.0);
        assert!(rest.abs().nearest() < 1e-31, "{rest:?}");
        // In `f64` this sum would be off by about 1e-16.
        let tenth = Twofold::from(1.0) / Twofold::from(10.0);
        let mut sum = Twofold::from(-1.0);
        for _ in 0..10 {
            sum = sum + tenth;
        }
        assert!(sum.abs().nearest() < 1e-31, "{sum:?}");
    }

    #[test]
    fn small_numbers_beside_large_ones_decide() {
        let one = Twofold::from(1.0);
        let more = one + Twofold::from(1e-25);
        assert!(more > one, "{more:?}");
        assert_eq!((more - one).nearest(), 1e-25);
        assert!((one - more).abs() == more - one);
    }

    proptest! {
        #[test]
        fn products_and_quotients_undo_each_other(a in -1e6..1e6, b in 1e-6..1e6, c in -1e6..1e6_f64) {
            let number = |x: f64| Twofold::from(x) * third() + Twofold::from(x * 1e-20);
            let (x, y, z) = (number(a), number(b), number(c));
            let size = (x * y).abs().nearest() + (z * y).abs().nearest();
            let rest = (x + z) * y - x * y - z * y;
            prop_assert!(rest.abs().nearest() <= 1e-30 * size);
            let rest = x / y * y - x;
            prop_assert!(rest.abs().nearest() <= 1e-30 * x.abs().nearest());
        }
    }
}
