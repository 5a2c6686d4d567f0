//! Control of the step length.

use super::method::Method;

/// Length that the next step aims at, as a fraction of that at which its error would be just acceptable.
const SAFETY: f64 = 0.9;
/// Largest error norm of a step that is kept. Steps aim at less than half of the acceptable error and miss it by
/// chance: what such a miss adds to all errors is not worth a whole step.
const KEPT: f64 = 1.5;
/// Least factor of a step to the next: the estimate says little about much shorter steps.
const SMALLEST_FACTOR: f64 = 0.2;
/// Largest factor of a step to the next: the estimate says little about much longer steps.
const LARGEST_FACTOR: f64 = 6.0;

/// Error norm below which a step grows by the largest factor, whatever the order: (0.9/6)^8 is 2.6e-7.
const NO_ERROR: f64 = 1e-7;

/// Error norm below which errors tell nothing about a trend.
const TELLING_ERROR: f64 = 1e-2;

/// A step that was accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Accepted {
    /// Its length [s].
    pub length: f64,
    /// Its error norm [-], as of [`Stepper::error_norm`](super::Stepper::error_norm): 1 is just acceptable.
    pub error: f64,
}

/// True if a step of this error norm is kept, rather than repeated.
#[must_use]
#[inline]
pub fn is_kept(error_norm: f64) -> bool {
    error_norm <= KEPT
}

impl Method {
    /// Factor from the length of a step to that of the next, by the step's error norm.
    ///
    /// Plain control (HNW II.4, (4.13)): it needs no memory, so it does not mind steps that events cut short. Methods
    /// with fixed steps return 1; a norm that is not finite asks for the smallest factor.
    #[must_use]
    pub fn step_factor(self, error_norm: f64) -> f64 {
        let Some(order) = self.error_order() else { return 1.0 };
        if !error_norm.is_finite() {
            return SMALLEST_FACTOR;
        }
        if error_norm < NO_ERROR {
            return LARGEST_FACTOR;
        }
        let factor = SAFETY / root(error_norm, order + 1);
        factor.clamp(SMALLEST_FACTOR, LARGEST_FACTOR)
    }

    /// Factor from the length of an accepted step to that of the next. With the accepted step before it, it foresees
    /// that an error which grew from step to step goes on to grow.
    ///
    /// Source: Gustafsson's predictive controller as in Hairer and Wanner, "Solving Ordinary Differential Equations
    /// II", IV.8, (8.25).
    #[must_use]
    #[inline]
    pub fn factor_after(self, step: Accepted, before: Option<Accepted>) -> f64 {
        let plain = self.step_factor(step.error);
        let (Some(before), Some(order)) = (before, self.error_order()) else { return plain };
        let [error, earlier] = [step.error, before.error].map(|error| error.max(TELLING_ERROR));
        let trend = step.length / before.length * root(earlier / error, order + 1);
        (plain * trend).clamp(SMALLEST_FACTOR, plain)
    }

    /// Factor from the length of a rejected step, or of one that was accepted only on another try, to that of the next:
    /// at most 1.
    #[must_use]
    #[inline]
    pub fn step_factor_after_rejection(self, error_norm: f64) -> f64 {
        self.step_factor(error_norm).min(1.0)
    }
}

/// Root of a number. The most frequent degrees take square roots, which are faster and the same everywhere.
fn root(value: f64, degree: u32) -> f64 {
    match degree {
        8 => value.sqrt().sqrt().sqrt(),
        4 => value.sqrt().sqrt(),
        _ => libm::pow(value, 1.0 / f64::from(degree)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_powers() {
        for degree in [4, 5, 8] {
            for value in [0.0f64, 1e-300, 0.3, 1.0, 17.0, 1e200] {
                let expected = value.powf(1.0 / f64::from(degree));
                assert!((root(value, degree) - expected).abs() <= 4.0 * f64::EPSILON * expected);
            }
        }
    }
}
