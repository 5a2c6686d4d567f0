//! What the advance is told, from the settings of a world and its scales.

use crate::scales::Scales;
use crate::settings::{Integrator, Stabilization, WorldSettings};
use halfgap_advance::ode::Method;
use halfgap_advance::rigid::{ExtraAcceleration, RigidSettings, StepControl};
use halfgap_collision::{SearchSettings, Tolerances};

/// Part of `velocity_tol`, and of the scene's speed, up to which a rate is none.
const REST_OF_SLOW: f64 = 1e-3;
const REST: f64 = 1e-5;
/// The corner of a body that turns while it falls may be faster than its centre.
const SINKING: f64 = 4.0;
/// Part of the tolerance that the error of one step may be, at the finest tolerance.
const LOCAL_SHARE: f64 = 0.25;
/// Tolerances finer than this ask for more than rounding leaves.
const FINEST_TOLERANCE: f64 = 1e-12;

/// The settings of the advance.
pub(crate) fn rigid_settings(settings: &WorldSettings, scales: &Scales) -> RigidSettings {
    let tolerances = scales.tolerances(settings.tolerance, &settings.overrides);
    let speed = scales.speed_scale();
    // Without forces nothing makes speed: then what crosses the gap tells which events are near each other.
    let resolution_time = if scales.acceleration > 0.0 {
        let fall = (2.0 * tolerances.accuracy / scales.acceleration).sqrt();
        fall.max(tolerances.velocity_tol / scales.acceleration)
    } else if speed > 0.0 {
        tolerances.target_gap / speed
    } else {
        0.0
    };
    RigidSettings {
        tolerances,
        law: settings.impact_law,
        order: settings.impact_order,
        collisions: settings.collisions,
        search: SearchSettings {
            depth: sinking(settings, &tolerances, scales),
            rest: rest_speed(tolerances.velocity_tol, speed),
            ..SearchSettings::default()
        },
        method: method(settings.integrator),
        steps: StepControl {
            local_error: local_error(settings.tolerance, method(settings.integrator)),
            length: scales.smallest_radius.unwrap_or(scales.coordinate),
            speed,
            largest_step: settings.fixed_step().or(settings.time_step),
        },
        projection: settings.stabilization == Stabilization::Projection,
        extra: extra(settings),
        impulse_step: settings.fixed_step().filter(|_| !settings.contacts),
        joint_small_impacts: settings.joint_small_impacts,
        rest_speed: rest_speed(tolerances.velocity_tol, speed),
        resolution_time,
    }
}

/// Relative error that a step may make by its estimate. That is of one order less than the step: what errors add up to falls
/// faster than what is asked of the estimate, by one power in so many.
fn local_error(tolerance: f64, method: Method) -> f64 {
    let power = -1.0 / f64::from(method.order() + 1);
    LOCAL_SHARE * tolerance * (tolerance / FINEST_TOLERANCE).powf(power)
}

/// How far [m] a slow contact may sink in one step, where contacts carry impulses only.
fn sinking(settings: &WorldSettings, tolerances: &Tolerances, scales: &Scales) -> f64 {
    let step = settings.fixed_step().filter(|_| !settings.contacts);
    step.map_or(0.0, |step| SINKING * (tolerances.velocity_tol + scales.acceleration * step) * step)
}

/// Rates up to which a row is at rest, in a scene of the given speed [m/s].
fn rest_speed(velocity_tol: f64, speed: f64) -> f64 {
    let slow = REST_OF_SLOW * velocity_tol;
    if speed > 0.0 { slow.min(REST * speed) } else { slow }
}

/// The method of an integrator.
pub(crate) fn method(integrator: Integrator) -> Method {
    match integrator {
        Integrator::Dop853 => Method::Dop853,
        Integrator::DormandPrince5 => Method::DormandPrince5,
        Integrator::Rk4 => Method::Rk4,
        Integrator::ModifiedEuler => Method::ModifiedEuler,
        Integrator::Euler => Method::Euler,
    }
}

fn extra(settings: &WorldSettings) -> Option<ExtraAcceleration> {
    let time = settings.fixed_step()?;
    let (distance, joints_only) = match settings.stabilization {
        Stabilization::Projection | Stabilization::None => return None,
        Stabilization::Velocity => (false, false),
        Stabilization::VelocityJoints => (false, true),
        Stabilization::VelocityAndDistance => (true, false),
        Stabilization::VelocityAndDistanceJoints => (true, true),
    };
    Some(ExtraAcceleration { time, distance, joints_only })
}
