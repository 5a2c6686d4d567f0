//! The thresholds of touching, all in one place.

/// Thresholds shared by the layers above geometry. SI units; each field says what it decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Gap [m] at which an approaching pair fires: half of `distance_tol`.
    ///
    /// Larger leaves wider gaps, which impacts amplify; must exceed the rounding of the largest coordinate.
    pub target_gap: f64,
    /// Half-width [m] of the target zone, in which a collision is close enough to handle.
    pub accuracy: f64,
    /// Normal speed [m/s] below which a collision is a contact and its elasticity no longer acts.
    pub velocity_tol: f64,
}

impl Tolerances {
    /// Part of the target gap that the half-width of the target zone takes by default.
    pub const ACCURACY_SHARE: f64 = 0.6;
    /// A fit is tight when its clearance is less than this many target gaps; its target is then that part of it.
    pub const TIGHT_FIT: f64 = 4.0;

    /// Part of the accuracy by which a contact without force may sink before it fires again: it lets rates
    /// that are only rounding pass.
    pub const SINK_SHARE: f64 = 1.0 / 8.0;

    /// Distance [m] by which a contact without force may sink before it fires again.
    #[must_use]
    pub fn sink(&self) -> f64 {
        Self::SINK_SHARE * self.accuracy
    }

    /// Distance [m] within which two features can be in contact.
    #[must_use]
    pub fn distance_tol(&self) -> f64 {
        2.0 * self.target_gap
    }

    pub(crate) fn are_finite(&self) -> bool {
        self.target_gap.is_finite() && self.accuracy.is_finite() && self.velocity_tol.is_finite()
    }

    /// The thresholds of a tight fit with the given clearance [m]: a convex arc in a barely larger hollow.
    ///
    /// Unchanged where the clearance is at least four target gaps.
    #[must_use]
    pub fn for_clearance(&self, clearance: f64) -> Self {
        if clearance >= Self::TIGHT_FIT * self.target_gap {
            return *self;
        }
        let target_gap = clearance / Self::TIGHT_FIT;
        Self { target_gap, accuracy: self.accuracy * (target_gap / self.target_gap), ..*self }
    }
}

/// Rounding of a length computed from coordinates of size 1, in units of the machine epsilon: a dozen operations.
const ROUNDINGS: f64 = 8.0;

/// Rounding-sized bound on a quantity that was computed from operands of the given size.
#[inline]
pub(crate) fn rounding(size: f64) -> f64 {
    ROUNDINGS * f64::EPSILON * size
}
