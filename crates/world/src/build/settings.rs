//! The settings of a world from the table `[run]` of a scene.

use crate::scene::{self, RunData};
use crate::settings::{Integrator, Stabilization, ToleranceOverrides, WorldSettings};
use halfgap_contact::{ImpactLaw, ImpactOrder};

/// The settings that a scene asks for.
pub(crate) fn of_run(run: &RunData) -> WorldSettings {
    WorldSettings {
        start_time: run.start_time,
        duration: Some(run.duration),
        tolerance: run.tolerance,
        usual_speed: None,
        overrides: ToleranceOverrides {
            target_gap: run.target_gap,
            accuracy: run.accuracy,
            velocity_tol: run.velocity_tol,
        },
        start_overlap: run.start_overlap,
        impact_law: impact_law(run.impact_law),
        impact_order: run.seed.map_or(ImpactOrder::Fastest, ImpactOrder::Seeded),
        collisions: run.collisions,
        contacts: run.contacts,
        integrator: integrator(run.integrator.unwrap_or_default()),
        time_step: run.time_step,
        stabilization: stabilization(run.stabilization.unwrap_or_default()),
        joint_small_impacts: run.joint_small_impacts,
        start_connector_error: run.start_connector_error,
    }
}

fn impact_law(law: scene::ImpactLaw) -> ImpactLaw {
    match law {
        scene::ImpactLaw::Simultaneous => ImpactLaw::Simultaneous,
        scene::ImpactLaw::Hybrid => ImpactLaw::Hybrid,
        scene::ImpactLaw::SerialSeparate => ImpactLaw::SerialSeparate,
        scene::ImpactLaw::SerialGrouped => ImpactLaw::SerialGrouped,
        scene::ImpactLaw::SerialSeparateLastpass => ImpactLaw::SerialSeparateLastpass,
        scene::ImpactLaw::SerialGroupedLastpass => ImpactLaw::SerialGroupedLastpass,
    }
}

fn integrator(integrator: scene::Integrator) -> Integrator {
    match integrator {
        scene::Integrator::Dop853 => Integrator::Dop853,
        scene::Integrator::DormandPrince5 => Integrator::DormandPrince5,
        scene::Integrator::Rk4 => Integrator::Rk4,
        scene::Integrator::ModifiedEuler => Integrator::ModifiedEuler,
        scene::Integrator::Euler => Integrator::Euler,
    }
}

fn stabilization(policy: scene::Stabilization) -> Stabilization {
    match policy {
        scene::Stabilization::Projection => Stabilization::Projection,
        scene::Stabilization::None => Stabilization::None,
        scene::Stabilization::Velocity => Stabilization::Velocity,
        scene::Stabilization::VelocityJoints => Stabilization::VelocityJoints,
        scene::Stabilization::VelocityAndDistance => Stabilization::VelocityAndDistance,
        scene::Stabilization::VelocityAndDistanceJoints => Stabilization::VelocityAndDistanceJoints,
    }
}
