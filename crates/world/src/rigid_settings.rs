//! Settings of the advance, from the settings of a world and its scales.

use crate::settings::{Integrator, LONGEST_STEP, Stabilization, ToleranceOverrides, WorldSettings};
use halfgap_advance::ode::Method;
use halfgap_advance::rigid::{ExtraAcceleration, RigidSettings, Scales, StepControl};
use halfgap_advance::stepping::SteppingSettings;
use halfgap_collision::{SearchSettings, Tolerances};

/// Factor on the sinking of a centre in one step: the corner of a body that turns may sink faster than its centre.
const SINKING: f64 = 4.0;

/// Returns the settings of the advance, with the thresholds of touching from [`tolerances`].
pub(crate) fn rigid_settings(
    settings: &WorldSettings,
    scales: &Scales,
    tolerances: Tolerances,
) -> RigidSettings {
    let method = method(settings.integrator);
    let derived = RigidSettings::with_tolerances(settings.tolerance, tolerances, scales, method);
    let impulse_step = settings.fixed_step().filter(|_| !settings.contacts);
    RigidSettings {
        impact_law: settings.impact_law,
        order: settings.impact_order,
        restitution: settings.restitution,
        collisions: settings.collisions,
        search: SearchSettings { depth: sinking(settings, &tolerances, scales), ..derived.search },
        steps: StepControl { largest_step: settings.fixed_step().or(settings.time_step), ..derived.steps },
        projection: settings.stabilization == Stabilization::Projection,
        extra: extra(settings),
        without: settings.without,
        impulse_step,
        region_steps: derived.region_steps.filter(|_| impulse_step.is_none()),
        joint_small_impacts: settings.joint_small_impacts,
        ..derived
    }
}

/// Largest error of positions that steps leave, as a fraction of the smallest body [-]: it cannot be seen.
const MOST_SLACK: f64 = 1e-4;

/// Returns the settings of an advance by steps.
pub(crate) fn stepping_settings(
    rigid: RigidSettings,
    (step, residual): (Option<f64>, f64),
    scales: &Scales,
) -> SteppingSettings {
    let length = scales.smallest_radius.unwrap_or(scales.coordinate);
    let slack = (residual.min(MOST_SLACK) * length).max(rigid.tolerances.accuracy);
    SteppingSettings {
        step: step.unwrap_or(LONGEST_STEP),
        accuracy: step.is_none().then_some(residual * length),
        residual,
        slack,
        rigid,
    }
}

/// Returns the thresholds of touching: those given in the settings, the others derived from the tolerance.
pub(crate) fn tolerances(settings: &WorldSettings, scales: &Scales) -> Tolerances {
    let derived = scales.tolerances(settings.tolerance);
    let ToleranceOverrides { target_gap, accuracy, velocity_tol } = settings.overrides;
    let target_gap = target_gap.unwrap_or(derived.target_gap);
    Tolerances {
        target_gap,
        accuracy: accuracy.unwrap_or(Tolerances::ACCURACY_SHARE * target_gap),
        velocity_tol: velocity_tol.unwrap_or(derived.velocity_tol),
    }
}

/// Largest distance [m] by which a slow contact may sink in one step, where contacts carry impulses only; else 0.
fn sinking(settings: &WorldSettings, tolerances: &Tolerances, scales: &Scales) -> f64 {
    let step = settings.fixed_step().filter(|_| !settings.contacts);
    step.map_or(0.0, |step| SINKING * (tolerances.velocity_tol + scales.acceleration * step) * step)
}

/// The integration method behind a setting.
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
