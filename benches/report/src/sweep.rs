//! All runs of the report: every scene, every engine, over its settings.

use crate::engines::Engine;
use crate::engines::halfgap::Halfgap;
use crate::measure::{Measurement, Repeats, measure};
use crate::scene::Scene;

/// A run that was measured, or why there is none.
#[derive(Clone, Debug)]
pub struct Row {
    /// Name of the scene.
    pub scene: String,
    /// Name of the engine.
    pub engine: &'static str,
    /// Its version.
    pub version: &'static str,
    /// Its settings.
    pub settings: String,
    /// How far the known states themselves may be off [m].
    pub reference_error: f64,
    /// What was measured, or what kept it from that.
    pub outcome: Result<Measurement, String>,
}

/// How thorough a sweep is.
#[derive(Clone, Debug)]
pub struct Effort {
    /// How often each run is repeated.
    pub repeats: Repeats,
    /// Runs that would take longer than this [s] are left out.
    pub longest_run: f64,
    /// Tolerances for halfgap.
    pub tolerances: Vec<f64>,
}

impl Effort {
    /// For a report.
    #[must_use]
    pub fn thorough() -> Self {
        let tolerances = (3..=12).map(|digits| 10_f64.powi(-digits)).collect();
        Self { repeats: Repeats::THOROUGH, longest_run: 10.0, tolerances }
    }

    /// For a look in a minute.
    #[must_use]
    pub fn quick() -> Self {
        Self { repeats: Repeats::QUICK, longest_run: 0.3, tolerances: vec![1e-3, 1e-6, 1e-9, 1e-12] }
    }
}

/// Measures one engine on one scene.
#[must_use]
pub fn run(engine: &dyn Engine, scene: &Scene, effort: &Effort) -> Row {
    Row {
        scene: scene.name.clone(),
        engine: engine.name(),
        version: engine.version(),
        settings: engine.settings(),
        reference_error: scene.reference_error,
        outcome: measure(engine, scene, &effort.repeats).map_err(|error| error.to_string()),
    }
}

/// Measures halfgap over its tolerances.
#[must_use]
pub fn halfgap_rows(scene: &Scene, effort: &Effort) -> Vec<Row> {
    effort.tolerances.iter().map(|&tolerance| run(&Halfgap { tolerance }, scene, effort)).collect()
}
