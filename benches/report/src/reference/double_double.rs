//! Numbers of 31 digits: the unevaluated sum of two doubles.
//!
//! T. J. Dekker, "A floating-point technique for extending the available precision", Numer. Math. 18 (1971),
//! 224-242; the product's error is taken from a fused multiply-add.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// The sum of two doubles, the second at most half a unit in the last place of the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub(crate) struct Double {
    high: f64,
    low: f64,
}

impl Double {
    /// The sum of two numbers, exactly.
    #[must_use]
    pub(crate) fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let part = high - a;
        Self { high, low: (a - (high - part)) + (b - part) }
    }

    /// The nearest double.
    #[must_use]
    pub(crate) fn value(self) -> f64 {
        self.high
    }

    /// Square root; zero of what is negative by rounding.
    #[must_use]
    pub(crate) fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::default();
        }
        let root = Self::from(self.high.sqrt());
        // One step of Newton's method doubles the digits.
        (root + self / root) * Self::from(0.5)
    }
}

impl From<f64> for Double {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let high = Self::sum(self.high, other.high);
        let low = Self::sum(self.low, other.low);
        let first = Self::sum(high.high, high.low + low.high);
        Self::sum(first.high, first.low + low.low)
    }
}

impl Neg for Double {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let error = self.high.mul_add(other.high, -high);
        Self::sum(high, error + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Double {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::from(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::from(second);
        Self::sum(first, second) + Self::from(rest.high / other.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative rounding of one operation.
    const EPSILON: f64 = f64::EPSILON * f64::EPSILON;

    #[test]
    fn thirds_and_roots_have_thirty_digits() {
        let (one, three) = (Double::from(1.0), Double::from(3.0));
        let rest = one / three * three - one;
        assert!(rest.value().abs() < 4.0 * EPSILON, "{rest:?}");
        let root = Double::from(2.0).sqrt();
        assert!((root * root - Double::from(2.0)).value().abs() < 8.0 * EPSILON);
        assert!(root.low != 0.0);
    }
}
