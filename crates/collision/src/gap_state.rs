//! The state of a gap, and the predicates by which an advance decides.
//!
//! *Invariant*: a predicate compares a distance with thresholds of distance and a rate with thresholds of rate, and
//! nothing else; it says the same of a record, of two features and of a rope.
//!
//! Two thresholds of speed serve different ends. Elasticity acts above `velocity_tol` ([`GapState::rebounds`]). Every
//! other question asks for a rate that is more than rounding, and the caller says how much that is: its `rest` speed is
//! far less than `velocity_tol`, or contacts that leave slowly would be glued.

use crate::connector::ConnectorSample;
use crate::tolerances::Tolerances;
use crate::zone::Zone;
use std::ops::RangeInclusive;

/// Distance and rate of a gap at one moment, with what is needed to judge them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct GapState {
    /// Distance [m] along the normal; negative for penetration.
    pub distance: f64,
    /// Rate of the distance [m/s]; negative when closing.
    pub normal_velocity: f64,
    /// True if the gap may neither close nor open.
    pub bilateral: bool,
    /// Thresholds of this gap.
    pub tolerances: Tolerances,
}

impl GapState {
    /// The gap of two bodies: distance [m] and rate [m/s].
    #[must_use]
    #[inline]
    pub fn of_contact(distance: f64, normal_velocity: f64, tolerances: &Tolerances) -> Self {
        Self { distance, normal_velocity, bilateral: false, tolerances: *tolerances }
    }

    /// The gap of a measured row of a rope or of a stop, whose target is 0.
    #[must_use]
    #[inline]
    pub fn of_rope(sample: &ConnectorSample, tolerances: &Tolerances) -> Self {
        let tolerances = Tolerances { target_gap: 0.0, ..*tolerances };
        Self::of_contact(sample.gap, sample.kinematics.rate, &tolerances)
    }

    /// The zone of the distance.
    #[must_use]
    #[inline]
    pub fn zone(&self) -> Zone {
        Zone::of(self.distance, &self.tolerances)
    }

    /// True within `distance_tol`, or if bilateral. A rope is touching when it is taut.
    #[must_use]
    #[inline]
    pub fn is_touching(&self) -> bool {
        self.bilateral || self.zone() != Zone::OutOfRange
    }

    /// True for a contact: touching at one of the `rates` [m/s], or bilateral.
    ///
    /// An overlap counts, too: a contact without force sinks a little each time it is touched, and is one all the same.
    /// The range may be lopsided, for a contact that opens becomes inactive where one that closes stays active.
    #[must_use]
    #[inline]
    pub fn is_contact(&self, rates: RangeInclusive<f64>) -> bool {
        self.bilateral || (self.is_touching() && rates.contains(&self.normal_velocity))
    }

    /// True at the target gap or nearer, or if bilateral. A gap that is `above` [m] the target by no more than a contact
    /// may sink counts as at it: both lie between two firings of one contact.
    #[must_use]
    #[inline]
    pub fn is_at_target(&self, above: f64) -> bool {
        self.bilateral || self.distance - self.tolerances.target_gap <= above
    }

    /// True if the row closes faster than `rest` [m/s], wherever its gap is, and be it bilateral.
    #[must_use]
    #[inline]
    pub fn closes(&self, rest: f64) -> bool {
        self.normal_velocity < -rest
    }

    /// True if the gap opens faster than `rest` [m/s]; never if bilateral.
    #[must_use]
    #[inline]
    pub fn opens(&self, rest: f64) -> bool {
        !self.bilateral && self.normal_velocity > rest
    }

    /// True if the gap changes no faster than `rest` [m/s], either way.
    #[must_use]
    #[inline]
    pub fn rests(&self, rest: f64) -> bool {
        self.normal_velocity.abs() <= rest
    }

    /// True if touching bodies close faster than `rest` [m/s]; never if bilateral.
    ///
    /// It is the direction that decides, not the depth: bodies that overlap and part are on their way out.
    #[must_use]
    #[inline]
    pub fn is_colliding(&self, rest: f64) -> bool {
        !self.bilateral && self.closes(rest) && self.is_touching()
    }

    /// True if the gap closes so fast that elasticity acts: faster than `velocity_tol`. Never if bilateral.
    #[must_use]
    #[inline]
    pub fn rebounds(&self) -> bool {
        !self.bilateral && self.closes(self.tolerances.velocity_tol)
    }

    /// True if nearer than a gap [m]; never if bilateral.
    ///
    /// Depths to which contacts may sink are not all borders of zones: they also follow from the bodies' sizes.
    #[must_use]
    #[inline]
    pub fn is_sunk_below(&self, gap: f64) -> bool {
        !self.bilateral && self.distance < gap
    }

    /// True if overlapping by more than the depth `allowed` [m], which rounding or sinking explains; never if bilateral.
    #[must_use]
    #[inline]
    pub fn is_illegal(&self, allowed: f64) -> bool {
        self.is_sunk_below(-allowed) && self.zone() == Zone::Penetrating
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCES: Tolerances = Tolerances { target_gap: 5e-3, accuracy: 3e-3, velocity_tol: 0.5 };
    const REST: f64 = 1e-3;

    fn state(distance: f64, rate: f64) -> GapState {
        GapState::of_contact(distance, rate, &TOLERANCES)
    }

    #[test]
    fn the_direction_decides_what_collides() {
        for distance in [-1e-3, 1e-3, 5e-3, 9e-3] {
            assert!(state(distance, -0.1).is_colliding(REST) && !state(distance, 0.1).is_colliding(REST));
            assert!(!state(distance, -0.5 * REST).is_colliding(REST), "that is rest");
        }
        assert!(!state(10.1e-3, -0.1).is_colliding(REST), "out of range");
        assert!(state(10.1e-3, -0.1).closes(REST) && !state(1e-3, -0.1).rebounds());
        assert!(state(1e-3, -0.6).rebounds());
    }

    #[test]
    fn a_contact_rests_in_any_zone_in_range() {
        for (distance, is_contact) in [(-1e-3, true), (1e-3, true), (9e-3, true), (10.1e-3, false)] {
            let contact = |rate: f64| state(distance, rate).is_contact(-REST..=0.5 * REST);
            assert_eq!(contact(-0.9 * REST), is_contact);
            assert!(!contact(0.9 * REST) && !contact(-1.1 * REST));
        }
    }

    #[test]
    fn a_depth_that_is_allowed_is_not_illegal() {
        assert!(!state(1e-3, -1.0).is_illegal(0.0) && state(1e-3, -1.0).is_sunk_below(2e-3));
        assert!(state(-1e-4, 1.0).is_illegal(0.0) && !state(-1e-4, 1.0).is_illegal(2e-4));
        assert!(state(6e-3, 0.0).is_at_target(1e-3) && !state(6e-3, 0.0).is_at_target(0.9e-3));
    }

    #[test]
    fn a_bilateral_row_is_a_contact_and_neither_collides_nor_opens() {
        let joint = |rate: f64| GapState { bilateral: true, ..state(-1.0, rate) };
        assert!(
            joint(-5.0).is_contact(-REST..=REST) && joint(-5.0).is_touching() && joint(-5.0).closes(REST)
        );
        assert!(joint(-5.0).is_at_target(0.0) && !joint(-5.0).is_sunk_below(0.0));
        assert!(!joint(-5.0).is_colliding(REST) && !joint(-5.0).rebounds() && !joint(-5.0).is_illegal(0.0));
        assert!(!joint(5.0).opens(REST) && state(1.0, 5.0).opens(REST) && !joint(5.0).rests(REST));
    }
}
