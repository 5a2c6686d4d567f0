//! The settings of a world from the table `[run]` of a scene.

use crate::scene::RunData;
use crate::settings::{ToleranceOverrides, WorldSettings};
use halfgap_advance::rigid::RemedySet;
use halfgap_contact::ImpactOrder;

/// Returns the settings that a scene asks for.
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
        impact_law: run.impact_law,
        impact_order: run.seed.map_or(ImpactOrder::Fastest, ImpactOrder::Seeded),
        collisions: run.collisions,
        contacts: run.contacts,
        integrator: run.integrator.unwrap_or_default(),
        time_step: run.time_step,
        stabilization: run.stabilization.unwrap_or_default(),
        joint_small_impacts: run.joint_small_impacts,
        start_connector_error: run.start_connector_error,
        without: RemedySet::NONE,
    }
}
