//! How long and how exactly a scene is to run.

use serde::Deserialize;

/// Recorded states per run where the scene does not say how far they are apart.
const DEFAULT_OUTPUTS: f64 = 400.0;

/// The table `[run]` of a scene.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunData {
    /// How long [s].
    pub duration: f64,
    /// Time at the start [s].
    #[serde(default)]
    pub start_time: f64,
    /// Time between recorded states [s].
    pub output_step: Option<f64>,
    /// Relative accuracy asked for.
    #[serde(default = "default_tolerance")]
    pub tolerance: f64,
    /// How impacts are resolved.
    #[serde(default)]
    pub impact_law: ImpactLaw,
    /// Seed of a random order of impacts; a deterministic order if not given.
    pub seed: Option<u64>,
    /// Contacts carry forces; else only impulses.
    #[serde(default = "yes")]
    pub contacts: bool,
    /// Bodies collide; else they pass through each other.
    #[serde(default = "yes")]
    pub collisions: bool,
    /// Half of the distance at which bodies count as touching [m].
    pub target_gap: Option<f64>,
    /// Normal speed below which a collision is a contact [m/s].
    pub velocity_tol: Option<f64>,
    /// Half width of the zone about the target gap [m].
    pub accuracy: Option<f64>,
    /// Largest step, or the step of integrators that have a fixed one [s].
    pub time_step: Option<f64>,
    /// Integrator.
    pub integrator: Option<Integrator>,
    /// What keeps contacts and joints from drifting.
    pub stabilization: Option<Stabilization>,
    /// Joints are kept together by small impacts.
    #[serde(default)]
    pub joint_small_impacts: bool,
    /// How deep bodies may overlap at the start [m].
    pub start_overlap: Option<f64>,
    /// How far off connectors may be at the start [m].
    pub start_connector_error: Option<f64>,
}

impl RunData {
    /// Time at which the run ends [s].
    #[must_use]
    pub fn end_time(&self) -> f64 {
        self.start_time + self.duration
    }

    /// Time between recorded states [s], given or by default.
    #[must_use]
    pub fn output_step_or_default(&self) -> f64 {
        self.output_step.unwrap_or(self.duration / DEFAULT_OUTPUTS)
    }
}

/// How impacts of several rows are resolved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ImpactLaw {
    /// All at once.
    Simultaneous,
    /// At once where bodies are shared, else one after another.
    #[default]
    Hybrid,
    /// One row at a time.
    SerialSeparate,
    /// One row at a time, with all joints it reaches.
    SerialGrouped,
    /// One row at a time, then once all at once without elasticity.
    SerialSeparateLastpass,
    /// One row and its joints at a time, then once all at once without elasticity.
    SerialGroupedLastpass,
}

/// How motion under forces is integrated where it has no closed form.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Dormand and Prince, order 8, adaptive.
    #[default]
    Dop853,
    /// Dormand and Prince, order 5, adaptive.
    DormandPrince5,
    /// The classical method of order 4, fixed steps.
    Rk4,
    /// Order 2, fixed steps.
    ModifiedEuler,
    /// Order 1, fixed steps.
    Euler,
}

/// What keeps contacts and joints from drifting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stabilization {
    /// States are projected onto the constraints.
    #[default]
    Projection,
    /// Nothing.
    None,
    /// Extra acceleration against the velocity error of contacts and joints.
    Velocity,
    /// The same, of joints only.
    VelocityJoints,
    /// Extra acceleration against velocity and distance errors.
    VelocityAndDistance,
    /// The same, of joints only.
    VelocityAndDistanceJoints,
}

fn default_tolerance() -> f64 {
    crate::DEFAULT_TOLERANCE
}

fn yes() -> bool {
    true
}
