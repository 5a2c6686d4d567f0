//! Exact line search on a convex, piecewise quadratic function.
//!
//! Its derivative along a line is piecewise linear and never falls, and the minimum is where the derivative crosses
//! zero. The places where its slope changes are sorted and passed in order.

/// A nondecreasing piecewise linear function of t: value + slope t, with kinks.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct PiecewiseLinear {
    value: f64,
    slope: f64,
    kinks: Vec<Kink>,
}

/// An addition of `value` + `slope` t to the function from t = `at` on.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Kink {
    at: f64,
    value: f64,
    slope: f64,
}

impl PiecewiseLinear {
    /// Sets the function to `value` + `slope` t.
    pub(crate) fn reset(&mut self, value: f64, slope: f64) {
        self.value = value;
        self.slope = slope;
        self.kinks.clear();
    }

    /// Adds `value` + `slope` t everywhere.
    pub(crate) fn add(&mut self, value: f64, slope: f64) {
        self.value += value;
        self.slope += slope;
    }

    /// Adds `value` + `slope` t beyond `at` > 0; it must vanish there.
    pub(crate) fn add_beyond(&mut self, at: f64, value: f64, slope: f64) {
        self.kinks.push(Kink { at, value, slope });
    }

    /// Finds the t > 0 at which the function becomes zero. `None` if it is not negative at 0 or never becomes zero.
    pub(crate) fn find_zero(&mut self) -> Option<f64> {
        let (mut value, mut slope) = (self.value, self.slope);
        if value >= 0.0 {
            return None;
        }
        // The kinks are needed only if the first piece ends before the zero.
        let first = -value / slope;
        if slope > 0.0 && self.kinks.iter().all(|kink| kink.at >= first) {
            return Some(first);
        }
        self.kinks.sort_unstable_by(|a, b| a.at.total_cmp(&b.at));
        for kink in &self.kinks {
            if value + slope * kink.at >= 0.0 {
                break;
            }
            value += kink.value;
            slope += kink.slope;
        }
        let zero = -value / slope;
        (zero.is_finite() && zero > 0.0).then_some(zero)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_zero_is_found_beyond_a_kink() {
        let mut derivative = PiecewiseLinear::default();
        derivative.reset(-3.0, 1.0);
        derivative.add_beyond(1.0, -1.0, 1.0);
        // -3 + t up to 1, then -4 + 2 t.
        assert_eq!(derivative.find_zero(), Some(2.0));
    }
}
