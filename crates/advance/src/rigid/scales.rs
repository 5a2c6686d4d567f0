//! From one relative tolerance and the sizes in a scene to the thresholds of touching and the errors of steps.

use super::step::segment::StepControl;
use super::system::RigidSettings;
use crate::ode::Method;
use halfgap_collision::{SearchSettings, Tolerances};
use halfgap_contact::{ImpactLaw, ImpactOrder};
use halfgap_geometry::Aabb;

/// Part of the smallest body's radius, times the tolerance, that the target gap takes: the gap is a modelling
/// error that impacts amplify, so it lies far below the tolerance.
const GAP_SHARE: f64 = 1e-2;
/// The target gap is at least so many machine epsilons of the largest coordinate: gaps must be told from
/// rounding, and so must the small part of one by which a contact without force may sink before it fires
/// again.
const GAP_ROUNDINGS: f64 = 512.0;
/// Twice that: a body falls through the target gap from rest with a speed that is told from rounding.
const SPEED_ROUNDINGS: f64 = 1024.0;

/// What is slow is not slower than this part of what is by the fastest body.
const SLOWEST: f64 = 1e-3;
/// Part of `velocity_tol`, and of the scene's speed, up to which a rate is none.
const REST_OF_SLOW: f64 = 1e-3;
const REST: f64 = 1e-8;
/// Part of the tolerance that the error of one step may be, at the finest tolerance.
const LOCAL_SHARE: f64 = 0.25;
/// Tolerances finer than this ask for more than rounding leaves.
const FINEST_TOLERANCE: f64 = 1e-12;

/// Sizes that occur in a scene at its start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scales {
    /// Bounding radius [m] of the smallest movable body; `None` if nothing moves.
    pub smallest_radius: Option<f64>,
    /// Largest coordinate in size, or radius of an arc [m]: gaps are told from the rounding of both.
    pub coordinate: f64,
    /// How far it is across all of it [m], or from the origin if that is less.
    pub extent: f64,
    /// Largest speed of a point of a body [m/s].
    pub speed: f64,
    /// The least speed [m/s] of those that bodies have, or get by falling as far as they are large; `None` if
    /// none moves or falls. What is slow beside a bullet need not be so beside a ball.
    pub slow: Option<f64>,
    /// Largest acceleration of a body [m/s^2] but for damping, which makes nothing fast.
    pub acceleration: f64,
}

impl Scales {
    /// Sets `coordinate` and `extent` to those of a scene within some bounds [m].
    pub fn set_bounds(&mut self, bounds: Aabb) {
        self.coordinate = bounds.min.abs().max(bounds.max.abs()).max_element();
        self.extent = bounds.size().length().min(self.coordinate);
    }

    /// Raises `coordinate` to the radius [m] of an arc, after the bounds are set: however short the arc, its gaps are
    /// measured from its centre.
    pub fn include_radius(&mut self, radius: f64) {
        self.coordinate = self.coordinate.max(radius);
    }

    /// The smallest target gap [m] that coordinates of this size allow.
    #[must_use]
    pub fn smallest_gap(&self) -> f64 {
        GAP_ROUNDINGS * f64::EPSILON * self.coordinate
    }

    /// The largest coordinate [m] at which the smallest target gap is no larger than the smallest movable
    /// body; `None` if nothing moves.
    #[must_use]
    pub fn largest_coordinate(&self) -> Option<f64> {
        self.smallest_radius.map(|radius| radius / (GAP_ROUNDINGS * f64::EPSILON))
    }

    /// The target gap [m] that the tolerance asks for.
    #[must_use]
    pub fn wanted_gap(&self, tolerance: f64) -> f64 {
        tolerance * GAP_SHARE * self.smallest_radius.unwrap_or(self.coordinate)
    }

    /// A speed [m/s] of the scene: what falls across it reaches this, even if all is at rest at the start,
    /// and wherever it is.
    #[must_use]
    pub fn speed_scale(&self) -> f64 {
        self.speed.max((self.acceleration * self.extent).sqrt())
    }

    /// A normal speed [m/s] that is slow: a part of what is fast, but to stop at it a body need not have
    /// fallen by more than half the same part of its size.
    fn slowness(&self, tolerance: f64) -> f64 {
        let of_fast = tolerance * self.speed_scale();
        let of_slow = self.slow.map_or(f64::INFINITY, |slow| tolerance.sqrt() * slow);
        of_fast.min(of_slow.max(SLOWEST * of_fast))
    }

    /// The thresholds that a relative tolerance asks for.
    #[must_use]
    pub fn tolerances(&self, tolerance: f64) -> Tolerances {
        let target_gap = self.wanted_gap(tolerance).max(self.smallest_gap());
        let told_from_rounding =
            (SPEED_ROUNDINGS * f64::EPSILON * self.coordinate * self.acceleration).sqrt();
        Tolerances {
            target_gap,
            accuracy: Tolerances::ACCURACY_SHARE * target_gap,
            velocity_tol: self.slowness(tolerance).max(told_from_rounding),
        }
    }
}

impl RigidSettings {
    /// What a relative tolerance asks for in a scene of such sizes, with the default method: contacts carry
    /// forces, impacts are resolved by the hybrid law, and steps are projected.
    #[must_use]
    pub fn new(tolerance: f64, scales: &Scales) -> Self {
        Self::with_tolerances(tolerance, scales.tolerances(tolerance), scales, Method::default())
    }

    /// The same with thresholds of touching, and a method, of one's own.
    #[must_use]
    pub fn with_tolerances(tolerance: f64, tolerances: Tolerances, scales: &Scales, method: Method) -> Self {
        let speed = scales.speed_scale();
        let rest_speed = rest_speed(tolerances.velocity_tol, speed);
        Self {
            tolerances,
            law: ImpactLaw::default(),
            order: ImpactOrder::default(),
            collisions: true,
            search: SearchSettings { rest: rest_speed, ..SearchSettings::default() },
            method,
            steps: StepControl {
                local_error: local_error(tolerance, method),
                length: scales.smallest_radius.unwrap_or(scales.coordinate),
                speed,
                largest_step: None,
            },
            projection: true,
            extra: None,
            impulse_step: None,
            joint_small_impacts: false,
            rest_speed,
            resolution_time: resolution_time(&tolerances, scales),
        }
    }
}

/// Relative error that a step may make by its estimate. That is of one order less than the step: what errors
/// add up to falls faster than what is asked of the estimate, by one power in so many.
fn local_error(tolerance: f64, method: Method) -> f64 {
    let power = -1.0 / f64::from(method.order() + 1);
    LOCAL_SHARE * tolerance * libm::pow(tolerance / FINEST_TOLERANCE, power)
}

/// Rates up to which a row is at rest, in a scene of the given speed [m/s].
fn rest_speed(velocity_tol: f64, speed: f64) -> f64 {
    let slow = REST_OF_SLOW * velocity_tol;
    if speed > 0.0 { slow.min(REST * speed) } else { slow }
}

/// The time [s] in which forces can be resolved.
fn resolution_time(tolerances: &Tolerances, scales: &Scales) -> f64 {
    let speed = scales.speed_scale();
    // Without forces nothing makes speed: then what crosses the gap tells which events are near each other.
    if scales.acceleration > 0.0 {
        let fall = (2.0 * tolerances.accuracy / scales.acceleration).sqrt();
        fall.max(tolerances.velocity_tol / scales.acceleration)
    } else if speed > 0.0 {
        tolerances.target_gap / speed
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn a_bullet_makes_nothing_else_slow() {
        let slow = |tolerance: f64, speed: f64| {
            let scales = Scales { speed, slow: Some(3.0), coordinate: 1.0, ..Scales::default() };
            scales.tolerances(tolerance).velocity_tol
        };
        // Where all is about as fast, or much is asked for, it does not matter.
        assert_eq!([slow(1e-2, 10.0), slow(1e-8, 1e4)], [1e-1, 1e-4]);
        assert_eq!([slow(1e-2, 1e4), slow(1e-4, 1e4)], [0.1 * 3.0, 1e-2 * 3.0]);
        assert_eq!(slow(1e-2, 1e9), SLOWEST * 1e7);
    }

    #[test]
    fn what_happens_far_away_is_no_faster() {
        let speed_at = |place: DVec2| {
            let mut scales = Scales { acceleration: 10.0, ..Scales::default() };
            scales.set_bounds(Aabb { min: place - 4.0, max: place + 4.0 });
            assert!(scales.coordinate >= place.max_element());
            scales.speed_scale()
        };
        let near = speed_at(DVec2::ZERO);
        assert_eq!(near, (10.0f64 * 4.0).sqrt());
        assert!(speed_at(DVec2::new(1e6, 0.0)) < 2.0 * near);
    }
}
