//! Derives the thresholds of touching and the errors of steps from one relative tolerance and the sizes in a scene.

use crate::ode::Method;
use crate::rigid::remedies::RemedySet;
use crate::rigid::settings::{RegionSteps, RigidSettings, StepControl};
use crate::rigid::shares::{LARGE, NEGLIGIBLE, TINY};
use halfgap_collision::{SearchSettings, Tolerances};
use halfgap_contact::{ImpactLaw, ImpactOrder, Restitution};
use halfgap_geometry::Aabb;

/// Target gap as a multiple of the tolerance times the smallest body's radius: the gap is a modelling error that
/// impacts amplify, so it lies far below the tolerance.
const GAP_SHARE: f64 = 1e-2;
/// Least target gap as a multiple of machine epsilon times the largest coordinate: gaps must be told from rounding, and
/// so must the small fraction of a gap by which a contact without force may sink before it fires again.
const GAP_ROUNDINGS: f64 = 512.0;

/// Upper bound of `rest_speed` as a fraction of the scene's speed.
const REST: f64 = 1e-8;
/// Error of one step as a fraction of the tolerance, at the finest tolerance.
const LOCAL_SHARE: f64 = 0.25;
/// Finest tolerance that rounding leaves room for [-].
const FINEST_TOLERANCE: f64 = 1e-12;

/// Sizes that occur in a scene at its start, from which its thresholds follow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scales {
    /// Bounding radius [m] of the smallest movable body; `None` if nothing moves.
    pub smallest_radius: Option<f64>,
    /// Largest absolute coordinate or radius of an arc [m]: gaps are told from the rounding of both.
    pub coordinate: f64,
    /// Diagonal of the scene's bounds [m], or the largest coordinate if that is less.
    pub extent: f64,
    /// Largest speed of a point of a movable body [m/s].
    pub speed: f64,
    /// Least characteristic speed [m/s] over the movable bodies, each the larger of its speed at the start and
    /// sqrt(acceleration x reach); `None` if nothing moves or falls. It keeps a speed that is slow for a bullet from
    /// counting as slow for a ball.
    pub slow: Option<f64>,
    /// Largest acceleration of a movable body [m/s^2], damping left out: it makes nothing fast.
    pub acceleration: f64,
}

impl Scales {
    /// Sets `coordinate` and `extent` to those of a scene within the given bounds [m].
    #[inline]
    pub fn set_bounds(&mut self, bounds: Aabb) {
        self.coordinate = bounds.min.abs().max(bounds.max.abs()).max_element();
        self.extent = bounds.size().length().min(self.coordinate);
    }

    /// Raises `coordinate` to a distance [m], after the bounds are set: the radius of an arc, whose gaps are measured from
    /// its centre however short it is, or the way that all bodies will go together.
    #[inline]
    pub fn include_distance(&mut self, distance: f64) {
        self.coordinate = self.coordinate.max(distance);
    }

    /// Smallest target gap [m] that can be told from the rounding of coordinates.
    #[must_use]
    #[inline]
    pub fn smallest_gap(&self) -> f64 {
        GAP_ROUNDINGS * f64::EPSILON * self.coordinate
    }

    /// Largest coordinate [m] at which the smallest target gap is no larger than the smallest movable body; `None` if
    /// nothing moves.
    #[must_use]
    #[inline]
    pub fn largest_coordinate(&self) -> Option<f64> {
        self.smallest_radius.map(|radius| radius / (GAP_ROUNDINGS * f64::EPSILON))
    }

    /// Target gap [m] that a relative tolerance asks for; [`Self::smallest_gap`] may exceed it.
    #[must_use]
    #[inline]
    pub fn wanted_gap(&self, tolerance: f64) -> f64 {
        tolerance * GAP_SHARE * self.smallest_radius.unwrap_or(self.coordinate)
    }

    /// Characteristic speed [m/s] of the scene: the larger of `speed` and sqrt(`acceleration` x `extent`), about the
    /// speed of a fall across the scene from rest, wherever it lies.
    #[must_use]
    #[inline]
    pub fn speed_scale(&self) -> f64 {
        self.speed.max((self.acceleration * self.extent).sqrt())
    }

    /// Normal speed [m/s] up to which a contact is slow: `tolerance` times the scene's speed, but no more than
    /// sqrt(`tolerance`) times [`Self::slow`], which the slowest body gains by falling half of `tolerance` times its
    /// size, and no less than `NEGLIGIBLE` of the former.
    fn slowness(&self, tolerance: f64) -> f64 {
        let of_fast = tolerance * self.speed_scale();
        let of_slow = self.slow.map_or(f64::INFINITY, |slow| tolerance.sqrt() * slow);
        of_fast.min(of_slow.max(NEGLIGIBLE * of_fast))
    }

    /// Thresholds of touching for a relative tolerance.
    #[must_use]
    pub fn tolerances(&self, tolerance: f64) -> Tolerances {
        let target_gap = self.wanted_gap(tolerance).max(self.smallest_gap());
        let told_from_rounding = (2.0 * self.smallest_gap() * self.acceleration).sqrt();
        Tolerances {
            target_gap,
            accuracy: Tolerances::ACCURACY_SHARE * target_gap,
            velocity_tol: self.slowness(tolerance).max(told_from_rounding),
        }
    }
}

impl RigidSettings {
    /// Settings for a relative tolerance in a scene of the given scales, with the default method: contacts carry
    /// forces, the hybrid law resolves impacts, and ends of steps are projected.
    #[must_use]
    pub fn new(tolerance: f64, scales: &Scales) -> Self {
        Self::with_tolerances(tolerance, scales.tolerances(tolerance), scales, Method::default())
    }

    /// Settings for a relative tolerance with the caller's thresholds of touching and method; all else is as of
    /// [`Self::new`].
    #[must_use]
    pub fn with_tolerances(tolerance: f64, tolerances: Tolerances, scales: &Scales, method: Method) -> Self {
        let speed = scales.speed_scale();
        let rest_speed = rest_speed(tolerances.velocity_tol, speed);
        Self {
            tolerances,
            impact_law: ImpactLaw::default(),
            order: ImpactOrder::default(),
            restitution: Restitution::default(),
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
            region_steps: region_steps(tolerance, &tolerances, scales),
            without: RemedySet::default(),
            joint_small_impacts: false,
            rest_speed,
            resolution_time: resolution_time(&tolerances, scales),
        }
    }
}

/// Relative error that a step may make by its estimate. The estimate is one order lower than the step, so accumulated
/// errors fall faster than it: for an error of the order of `tolerance` the estimate must fall with the power
/// order/(order + 1) of that.
fn local_error(tolerance: f64, method: Method) -> f64 {
    let power = -1.0 / f64::from(method.order() + 1);
    LOCAL_SHARE * tolerance * libm::pow(tolerance / FINEST_TOLERANCE, power)
}

/// Largest rate [m/s] at which a row is at rest, in a scene of the given speed [m/s].
pub(crate) fn rest_speed(velocity_tol: f64, speed: f64) -> f64 {
    let slow = NEGLIGIBLE * velocity_tol;
    if speed > 0.0 { slow.min(REST * speed) } else { slow }
}

/// Time [s] in which forces produce `velocity_tol` or bring a body from rest through half the target zone, if that is
/// longer.
fn resolution_time(tolerances: &Tolerances, scales: &Scales) -> f64 {
    let speed = scales.speed_scale();
    // Without forces no speed is produced: the time to cross the target gap tells which events are near each other.
    if scales.acceleration > 0.0 {
        let fall = (2.0 * tolerances.accuracy / scales.acceleration).sqrt();
        fall.max(tolerances.velocity_tol / scales.acceleration)
    } else if speed > 0.0 {
        tolerances.target_gap / speed
    } else {
        0.0
    }
}

/// Steps of regions whose events accumulate, none where the zone can be seen: few events fit into so coarse a run. What they
/// may be off cannot be seen beside the smallest body, and is no more than sqrt(`tolerance`) times its radius, or half of the target
/// zone if that is wider: a tolerance a hundred times as fine asks for three times as many. Forces move a body so far in one; without
/// forces it goes much farther, as nothing comes back to where it was but what others keep there.
fn region_steps(tolerance: f64, tolerances: &Tolerances, scales: &Scales) -> Option<RegionSteps> {
    let radius = scales.smallest_radius.filter(|radius| tolerances.accuracy <= TINY * radius)?;
    let slack = tolerances.accuracy.max(TINY.min(tolerance.sqrt()) * radius);
    let slow = tolerances.velocity_tol;
    if scales.acceleration > 0.0 {
        let span = (2.0 * slack / scales.acceleration).sqrt();
        Some(RegionSteps { span, slack, slow: slow.max(2.0 * slack / span) })
    } else {
        let speed = scales.speed_scale();
        (speed > 0.0).then_some(RegionSteps { span: LARGE * slack / speed, slack, slow })
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
        // Where all bodies are about as fast, or the tolerance is fine, the slowest body does not matter.
        assert_eq!([slow(1e-2, 10.0), slow(1e-8, 1e4)], [1e-1, 1e-4]);
        assert_eq!([slow(1e-2, 1e4), slow(1e-4, 1e4)], [0.1 * 3.0, 1e-2 * 3.0]);
        assert_eq!(slow(1e-2, 1e9), NEGLIGIBLE * 1e7);
    }

    #[test]
    fn a_scene_far_from_the_origin_is_no_faster() {
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
