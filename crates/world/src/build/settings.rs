//! The settings of a world from the table `[run]` of a scene.

use crate::scene::{RunData, StrategyData};
use crate::settings::{AdvanceBy, ToleranceOverrides, WorldSettings};
use halfgap_advance::rigid::RemedySet;
use halfgap_contact::ImpactOrder;

/// Length of a step [s] where neither it nor a tolerance is given.
const DEFAULT_STEP: f64 = 1.0 / 240.0;
/// Residual of steps where no tolerance is given.
const DEFAULT_RESIDUAL: f64 = 1e-6;

fn strategy(run: &RunData) -> AdvanceBy {
    match run.strategy {
        StrategyData::Events => AdvanceBy::Events,
        StrategyData::Steps => AdvanceBy::Steps {
            step: run.time_step.or(run.tolerance.is_none().then_some(DEFAULT_STEP)),
            residual: run.tolerance.unwrap_or(DEFAULT_RESIDUAL),
        },
    }
}

/// Returns the settings that a scene asks for.
pub(crate) fn of_run(run: &RunData) -> WorldSettings {
    WorldSettings {
        start_time: run.start_time,
        duration: Some(run.duration),
        // The gap that contacts keep costs steps nothing, however coarse they are.
        tolerance: match run.strategy {
            StrategyData::Events => run.tolerance_or_default(),
            StrategyData::Steps => run.tolerance_or_default().min(DEFAULT_RESIDUAL),
        },
        strategy: strategy(run),
        restitution: run.restitution,
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
