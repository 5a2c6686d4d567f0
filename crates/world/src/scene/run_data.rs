//! The table `[run]` of a scene: duration, accuracy, impact law, integrator.

use crate::settings::{Integrator, Stabilization};
use halfgap_contact::{ImpactLaw, Restitution};
use serde::Deserialize;

/// Default number of recorded states of a run.
const DEFAULT_OUTPUTS: f64 = 400.0;

/// The table `[run]` of a scene.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunData {
    /// Duration of the run [s].
    pub duration: f64,
    /// Time at the start [s].
    #[serde(default)]
    pub start_time: f64,
    /// Interval between recorded states [s]; by default a 400th of the duration.
    pub output_step: Option<f64>,
    /// Relative accuracy asked for [-], above 0 and at most 1; 1e-8 if not given.
    pub tolerance: Option<f64>,
    /// How the world advances.
    #[serde(default)]
    pub strategy: StrategyData,
    /// What elasticity means where there is friction.
    #[serde(default, with = "RestitutionNames")]
    pub restitution: Restitution,
    /// Impact law.
    #[serde(default, with = "ImpactLawNames")]
    pub impact_law: ImpactLaw,
    /// Seed of a random order of impacts; a deterministic order if not given.
    pub seed: Option<u64>,
    /// Whether contacts carry forces; if false, only impulses.
    #[serde(default = "yes")]
    pub contacts: bool,
    /// Whether bodies collide; if false, they pass through each other.
    #[serde(default = "yes")]
    pub collisions: bool,
    /// Gap at which an approaching pair fires [m]; half of the distance at which bodies count as touching.
    pub target_gap: Option<f64>,
    /// Normal speed below which a collision is a contact [m/s].
    pub velocity_tol: Option<f64>,
    /// Half-width of the zone about the target gap [m].
    pub accuracy: Option<f64>,
    /// Largest step, or the length of fixed steps [s].
    pub time_step: Option<f64>,
    /// Integrator of motion that has no closed form.
    pub integrator: Option<Integrator>,
    /// Method that keeps contacts and connectors from drifting.
    pub stabilization: Option<Stabilization>,
    /// Whether small impulses, too, keep connectors together.
    #[serde(default)]
    pub joint_small_impacts: bool,
    /// Largest overlap of two bodies that is accepted at the start [m].
    pub start_overlap: Option<f64>,
    /// Largest error of a connector that is accepted at the start [m].
    pub start_connector_error: Option<f64>,
}

impl RunData {
    /// Time at which the run ends [s].
    #[must_use]
    pub fn end_time(&self) -> f64 {
        self.start_time + self.duration
    }

    /// Relative accuracy asked for [-], given or by default.
    #[must_use]
    pub fn tolerance_or_default(&self) -> f64 {
        self.tolerance.unwrap_or(crate::DEFAULT_TOLERANCE)
    }

    /// Interval between recorded states [s], given or by default.
    #[must_use]
    pub fn output_step_or_default(&self) -> f64 {
        self.output_step.unwrap_or(self.duration / DEFAULT_OUTPUTS)
    }
}

/// How a world advances, in a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StrategyData {
    /// Each event at its own time.
    #[default]
    Events,
    /// Steps, in which contacts are problems of velocities: for piles.
    Steps,
}

/// The meanings of elasticity by their names in scene files.
#[derive(Deserialize)]
#[serde(remote = "Restitution", rename_all = "snake_case")]
enum RestitutionNames {
    Energetic,
    Poisson,
    Newton,
}

/// The impact laws by their names in scene files.
#[derive(Deserialize)]
#[serde(remote = "ImpactLaw", rename_all = "snake_case")]
enum ImpactLawNames {
    Simultaneous,
    Hybrid,
    SerialSeparate,
    SerialGrouped,
    SerialSeparateLastpass,
    SerialGroupedLastpass,
}

fn yes() -> bool {
    true
}
