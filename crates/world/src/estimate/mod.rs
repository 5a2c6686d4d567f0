//! How far a run is from the truth, without knowing it: the run is repeated at a tighter tolerance and compared.
//!
//! The error of a run is in proportion to its tolerance, so what the tighter run leaves is small beside what
//! it removes: the difference of both is the error of the first to within the share that is left. `tighter`
//! says what is tightened, `difference` compares states, `event_times` compares impacts, `growth` tells chaos
//! from error.
//!
//! The idea is that of tolerance reduction as an estimate of the global error, reviewed in R. D. Skeel,
//! "Thirteen ways to estimate global error", Numerische Mathematik 48 (1986), 1-20 (there among the methods
//! that repeat the integration); here it sees the gaps and the impacts too, as both follow from the
//! tolerance.

mod difference;
mod event_times;
mod growth;
mod tighter;

pub use difference::{Difference, TimedDifference};

use crate::recording::Recording;
use crate::run::{Progress, Record, RunPlan, RunReport, run};
use crate::scene::{FieldPath, Scene, SceneError};
use crate::world::World;
use difference::Comparison;
use event_times::EventTimes;
use serde::Serialize;

/// How far a run is from the truth, as far as a tighter run tells.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ErrorEstimate {
    /// Tolerance of the run.
    pub tolerance: f64,
    /// Tolerance of the run it was compared with.
    pub tighter_tolerance: f64,
    /// Target gaps of both runs [m]. Where coordinates allow no smaller one, the second is twice the first:
    /// the part of the error that comes from the gap is in proportion to it.
    pub target_gaps: [f64; 2],
    /// Up to when both runs were compared [s].
    pub compared_until: f64,
    /// The largest differences at any output time.
    pub largest: Difference,
    /// The differences at the last time that was compared.
    pub end: Difference,
    /// Largest difference of the time of an impact [s], up to `trusted_until`; `None` if there were none.
    pub event_time: Option<f64>,
    /// Impacts of the run and of the tighter one. A body that bounces to rest does so more often in the tighter one.
    pub impacts: [usize; 2],
    /// The difference grows faster than any power of the time that errors of integration grow with.
    pub chaotic: bool,
    /// The last output time [s] at which each body was where it should be to a hundredth of its own size, or to the part
    /// that four target gaps are of the smallest one, if that is more; `None` if it was so to the end. Until then the
    /// answer is worth something.
    pub trusted_until: Option<f64>,
    /// Why the tighter run stopped early, if it did.
    pub tighter_stopped: Option<String>,
    /// The differences at all output times, the first at the start.
    #[serde(skip)]
    pub curve: Vec<TimedDifference>,
}

/// Estimates the error of a run of a scene; the run must have recorded everything.
///
/// The scene is run once more, with the same output times and a tolerance of a hundredth (where the step is
/// fixed: a tenth, and a tenth of the step); thresholds that the scene gives itself shrink alike. Where `progress` breaks
/// that run off, both are compared up to there.
///
/// # Errors
/// The run did not record everything; the scene cannot be built, or not at the tighter tolerance.
pub fn estimate_error(
    scene: &Scene,
    plan: &RunPlan,
    world: &World,
    report: &RunReport,
    progress: Progress<'_>,
) -> Result<ErrorEstimate, SceneError> {
    if plan.record != Record::Everything {
        let message = "the error can be estimated of a run that recorded everything only";
        return Err(SceneError::new(FieldPath::top().field("run"), message));
    }
    let tighter = tighter::tightened(scene, world)?;
    let mut other = World::from_scene(&tighter)?;
    let other_plan = RunPlan { stops: Vec::new(), ..plan.clone() };
    let other_report = run(&mut other, &other_plan, progress);
    let mut estimate = compare(world, &report.recording, &other_report.recording, scene.run.tolerance);
    estimate.tighter_tolerance = tighter.run.tolerance;
    estimate.target_gaps[1] = other.tolerances().target_gap;
    estimate.tighter_stopped = other_report.error.map(|error| error.to_string());
    Ok(estimate)
}

/// Compares two recordings of one scene; the tolerances are those of the first.
fn compare(world: &World, run: &Recording, tighter: &Recording, tolerance: f64) -> ErrorEstimate {
    let comparison = Comparison::new(world, run);
    let shifts = comparison.shifts(run, tighter);
    // What touches at a gap that is wide is off by that at once.
    let usual = tolerance.max(comparison.part(world.tolerances().target_gap));
    let growth = growth::judge(&shifts, usual);
    let trusted = growth.trusted_until.unwrap_or(f64::INFINITY);
    let times = [run, tighter].map(|recording| EventTimes::new(recording, trusted));
    let event_time = times[0].largest_difference(&times[1]);
    let curve = comparison.curve(run, tighter, &times, event_time.unwrap_or(0.0));
    ErrorEstimate {
        tolerance,
        tighter_tolerance: tolerance,
        target_gaps: [world.tolerances().target_gap; 2],
        compared_until: shifts.last().map_or(0.0, |(time, _)| *time),
        largest: curve
            .iter()
            .fold(Difference::default(), |largest, timed| largest.largest(&timed.difference)),
        end: curve.last().map(|timed| timed.difference).unwrap_or_default(),
        event_time,
        impacts: [run.impacts.len(), tighter.impacts.len()],
        chaotic: growth.chaotic,
        trusted_until: growth.trusted_until,
        tighter_stopped: None,
        curve,
    }
}
