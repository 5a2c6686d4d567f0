//! From one relative tolerance and the scene's scales to the thresholds of touching.

use halfgap_collision::Tolerances;
use halfgap_geometry::Aabb;

/// Part of the smallest body's radius, times the tolerance, that the target gap takes: the gap is a modelling error that
/// impacts amplify, so it lies far below the tolerance.
const GAP_SHARE: f64 = 1e-2;
/// The target gap is at least so many machine epsilons of the largest coordinate: gaps must be told from rounding, and so
/// must the small part of one by which a contact without force may sink before it fires again.
const GAP_ROUNDINGS: f64 = 512.0;
/// Twice that: a body falls through the target gap from rest with a speed that is told from rounding.
const SPEED_ROUNDINGS: f64 = 1024.0;

/// Sizes that occur in a scene at its start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Scales {
    /// Bounding radius [m] of the smallest movable body; `None` if nothing moves.
    pub(crate) smallest_radius: Option<f64>,
    /// Largest coordinate in size [m].
    pub(crate) coordinate: f64,
    /// How far it is across all of it [m], or from the origin if that is less.
    pub(crate) extent: f64,
    /// Largest speed of a point of a body [m/s].
    pub(crate) speed: f64,
    /// Largest acceleration of a body [m/s^2] but for damping, which makes nothing fast.
    pub(crate) acceleration: f64,
}

/// The largest coordinate in size [m] within some bounds.
pub(crate) fn farthest_in(bounds: &Aabb) -> f64 {
    bounds.min.abs().max(bounds.max.abs()).max_element()
}

/// Thresholds that the user gives in place of the derived ones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToleranceOverrides {
    /// Gap [m] at which an approaching pair fires.
    pub target_gap: Option<f64>,
    /// Half-width [m] of the target zone.
    pub accuracy: Option<f64>,
    /// Normal speed [m/s] below which a collision is a contact.
    pub velocity_tol: Option<f64>,
}

impl Scales {
    /// Takes in all that lies within some bounds [m].
    pub(crate) fn spread(&mut self, bounds: Option<Aabb>) {
        let Some(bounds) = bounds else { return };
        self.coordinate = farthest_in(&bounds);
        self.extent = bounds.size().length().min(self.coordinate);
    }

    /// The smallest target gap [m] that coordinates of this size allow.
    pub(crate) fn smallest_gap(&self) -> f64 {
        GAP_ROUNDINGS * f64::EPSILON * self.coordinate
    }

    /// The largest coordinate [m] at which the smallest target gap is no larger than the smallest movable body; `None` if
    /// nothing moves.
    pub(crate) fn largest_coordinate(&self) -> Option<f64> {
        self.smallest_radius.map(|radius| radius / (GAP_ROUNDINGS * f64::EPSILON))
    }

    /// The target gap [m] that the tolerance asks for.
    pub(crate) fn wanted_gap(&self, tolerance: f64) -> f64 {
        tolerance * GAP_SHARE * self.smallest_radius.unwrap_or(self.coordinate)
    }

    /// A speed [m/s] of the scene: what falls across it reaches this, even if all is at rest at the start, and wherever it is.
    pub(crate) fn speed_scale(&self) -> f64 {
        self.speed.max((self.acceleration * self.extent).sqrt())
    }

    pub(crate) fn tolerances(&self, tolerance: f64, given: &ToleranceOverrides) -> Tolerances {
        let target_gap = given.target_gap.unwrap_or(self.wanted_gap(tolerance).max(self.smallest_gap()));
        let told_from_rounding =
            (SPEED_ROUNDINGS * f64::EPSILON * self.coordinate * self.acceleration).sqrt();
        Tolerances {
            target_gap,
            accuracy: given.accuracy.unwrap_or(Tolerances::ACCURACY_SHARE * target_gap),
            velocity_tol: given
                .velocity_tol
                .unwrap_or((tolerance * self.speed_scale()).max(told_from_rounding)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn what_happens_far_away_is_no_faster() {
        let speed_at = |place: DVec2| {
            let mut scales = Scales { acceleration: 10.0, ..Scales::default() };
            scales.spread(Some(Aabb { min: place - 4.0, max: place + 4.0 }));
            assert!(scales.coordinate >= place.max_element());
            scales.speed_scale()
        };
        let near = speed_at(DVec2::ZERO);
        assert_eq!(near, (10.0f64 * 4.0).sqrt());
        assert!(speed_at(DVec2::new(1e6, 0.0)) < 2.0 * near);
    }
}
