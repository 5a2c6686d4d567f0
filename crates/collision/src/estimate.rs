//! Estimate of the time at which a collision's distance reaches its target gap, from two of its states.

use crate::quadratic::first_closing_time;

/// State of a gap at a moment: that of its first detection, or one of the two that an estimate needs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct EstimatePoint {
    /// Time [s].
    pub time: f64,
    /// Distance [m].
    pub distance: f64,
    /// Normal velocity [m/s], negative when closing.
    pub normal_velocity: f64,
}

/// Estimates the time [s] at which the distance reaches `target_gap` [m], between `earlier`, the state after the
/// back-up, and `later`, the state at which the collision was detected, with the acceleration that the two velocities
/// imply.
///
/// The distance at `later` is not used. `None` if by this estimate the target is not reached in between,
/// which can happen although the later distance is below it; the event search then brackets.
#[must_use]
#[inline]
pub fn estimate_target_time(earlier: EstimatePoint, later: EstimatePoint, target_gap: f64) -> Option<f64> {
    let span = later.time - earlier.time;
    if span <= 0.0 {
        return None;
    }
    let acceleration = (later.normal_velocity - earlier.normal_velocity) / span;
    let wait = first_closing_time(earlier.distance - target_gap, earlier.normal_velocity, acceleration)?;
    (wait <= span).then_some(earlier.time + wait)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dropped_ball_is_estimated_exactly() {
        let earlier = EstimatePoint { time: 1.0, distance: 5.01, normal_velocity: 0.0 };
        let later = EstimatePoint { time: 3.0, distance: -14.99, normal_velocity: -20.0 };
        let time = estimate_target_time(earlier, later, 0.01).expect("it falls");
        assert!((time - 2.0).abs() < 1e-15 * 4.0);
    }

    #[test]
    fn there_is_none_when_the_velocities_do_not_show_the_closing() {
        let earlier = EstimatePoint { time: 0.0, distance: 1.0, normal_velocity: 1.0 };
        let later = EstimatePoint { time: 1.0, distance: -1.0, normal_velocity: 1.0 };
        assert_eq!(estimate_target_time(earlier, later, 0.1), None);
    }
}
