//! Thresholds of touching, all in one place.

/// Thresholds of gaps and speeds, shared by the layers above geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Tolerances {
    /// Gap [m] at which an approaching pair fires: half of `distance_tol`.
    ///
    /// A larger value leaves wider gaps, which impacts amplify; it must exceed the rounding of the largest coordinate.
    pub target_gap: f64,
    /// Half-width [m] of the target zone, in which a collision is close enough to handle.
    pub accuracy: f64,
    /// Normal speed [m/s], in size, below which a collision is a contact and its elasticity no longer acts.
    pub velocity_tol: f64,
}

impl Tolerances {
    /// Default half-width of the target zone, as a fraction of the target gap [-].
    pub const ACCURACY_SHARE: f64 = 0.6;
    /// Clearance below which a fit is tight, as a multiple of the target gap [-]. The target gap of a tight fit is its
    /// clearance divided by this.
    pub const TIGHT_FIT: f64 = 4.0;

    /// Distance by which a contact without force may sink before it fires again, as a fraction of the accuracy [-]: it
    /// lets rates pass that are only rounding.
    pub const SINK_SHARE: f64 = 1.0 / 8.0;

    /// Distance [m] by which a contact without force may sink before it fires again.
    #[must_use]
    #[inline]
    pub fn sink(&self) -> f64 {
        Self::SINK_SHARE * self.accuracy
    }

    /// Distance [m] within which two features can be in contact.
    #[must_use]
    #[inline]
    pub fn distance_tol(&self) -> f64 {
        2.0 * self.target_gap
    }

    pub(crate) fn are_finite(&self) -> bool {
        self.target_gap.is_finite() && self.accuracy.is_finite() && self.velocity_tol.is_finite()
    }

    /// The thresholds of a fit with the given clearance [m], of a convex arc in a concave one: target gap and accuracy
    /// are reduced in proportion if it is tight.
    ///
    /// They are unchanged if the clearance is at least [`TIGHT_FIT`](Self::TIGHT_FIT) target gaps.
    #[must_use]
    #[inline]
    pub fn for_clearance(&self, clearance: f64) -> Self {
        if clearance >= Self::TIGHT_FIT * self.target_gap {
            return *self;
        }
        let target_gap = clearance / Self::TIGHT_FIT;
        Self { target_gap, accuracy: self.accuracy * (target_gap / self.target_gap), ..*self }
    }
}

/// Rounding of a quantity computed from operands of size 1, as a multiple of the machine epsilon [-]: that of a dozen
/// operations.
const ROUNDINGS: f64 = 8.0;

/// Bound on the rounding of a quantity that was computed from operands of the given size, in their unit.
#[inline]
pub(crate) fn rounding(size: f64) -> f64 {
    ROUNDINGS * f64::EPSILON * size
}
