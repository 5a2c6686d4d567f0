//! Estimate of the error of a run: the run is repeated at a tighter tolerance and compared.
//!
//! The error of a run is in proportion to its tolerance, so that of the tighter run is small beside that of the first,
//! and the difference of both is the error of the first to within that small fraction. `tighter` makes the tighter
//! scene, `difference` compares states, `event_times` compares impacts, `growth` distinguishes chaos from error,
//! `thresholds` finds contacts of which the least change decides whether they slip.
//!
//! The idea is that of tolerance reduction as an estimate of the global error, reviewed in R. D. Skeel,
//! "Thirteen ways to estimate global error", Numerische Mathematik 48 (1986), 1-20 (there among the methods
//! that repeat the integration); here it sees the gaps and the impacts too, as both follow from the
//! tolerance.

mod difference;
mod event_times;
mod growth;
mod thresholds;
mod tighter;

pub use difference::{Difference, TimedDifference};
pub use thresholds::FrictionThreshold;

use crate::recording::Recording;
use crate::run::{Progress, Record, RunPlan, RunReport, run};
use crate::run_error::RunError;
use crate::scene::{FieldPath, Scene, SceneError};
use crate::world::World;
use difference::Comparison;
use event_times::EventTimes;
use serde::{Serialize, Serializer};

/// Estimate of the error of a run, from its difference to a tighter run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ErrorEstimate {
    /// Tolerance of the run [-].
    pub tolerance: f64,
    /// Tolerance of the tighter run [-].
    pub tighter_tolerance: f64,
    /// Target gaps of both runs [m]. Where coordinates allow no smaller one, the second is twice the first: the share
    /// of the error that comes from the gap is in proportion to the gap.
    pub target_gaps: [f64; 2],
    /// Last time at which both runs were compared [s].
    pub compared_until: f64,
    /// Largest differences at any output time.
    pub largest: Difference,
    /// Differences at the last time that was compared.
    pub end: Difference,
    /// Largest difference in time of matching impacts [s], up to `trusted_until`; `None` if no impacts match.
    pub event_time: Option<f64>,
    /// Numbers of impacts of the run and of the tighter one. A body that bounces to rest makes more of them in the
    /// tighter one.
    pub impacts: [usize; 2],
    /// Whether the difference grows faster than errors of integration do.
    pub chaotic: bool,
    /// Last output time [s] up to which every body is within 1 % of its own size of the tighter run, or within four
    /// times the tolerance or the target gap over the smallest body's size, if that is more; `None` if it stays so to
    /// the end.
    pub trusted_until: Option<f64>,
    /// Contacts at thresholds of friction, up to `trusted_until`: the scene does not tell whether they stick or slip.
    pub thresholds: Vec<FrictionThreshold>,
    /// Error that stopped the tighter run early, if one did.
    #[serde(serialize_with = "message")]
    pub tighter_stopped: Option<RunError>,
    /// Differences at all output times, the first at the start.
    #[serde(skip)]
    pub curve: Vec<TimedDifference>,
}

/// Writes an error as its message.
fn message<S: Serializer>(error: &Option<RunError>, serializer: S) -> Result<S::Ok, S::Error> {
    error.as_ref().map(RunError::to_string).serialize(serializer)
}

/// Estimates the error of a run of a scene; the run must have recorded [`Record::Everything`].
///
/// Runs the scene once more, with the same output times and a hundredth of the tolerance (with fixed steps: a tenth of
/// the tolerance and of the step); thresholds that the scene gives shrink by the same factor. If `progress` stops that
/// run, both are compared up to there.
///
/// # Errors
/// [`SceneError`] if the run did not record everything, or the scene cannot be built at the tighter tolerance.
pub fn estimate_error(
    scene: &Scene,
    plan: &RunPlan,
    world: &World,
    report: &RunReport,
    progress: Progress<'_>,
) -> Result<ErrorEstimate, SceneError> {
    if plan.record != Record::Everything {
        let message = "the error can only be estimated for a run that recorded everything";
        return Err(SceneError::new(FieldPath::top().field("run"), message));
    }
    let tighter = tighter::tightened(scene, world)?;
    let mut other = World::from_scene(&tighter)?;
    let other_plan = RunPlan { stops: Vec::new(), ..plan.clone() };
    let other_report = run(&mut other, &other_plan, progress);
    let mut estimate =
        compare(world, &report.recording, &other_report.recording, scene.run.tolerance_or_default());
    estimate.tighter_tolerance = tighter.run.tolerance_or_default();
    estimate.target_gaps[1] = other.tolerances().target_gap;
    estimate.tighter_stopped = other_report.error;
    Ok(estimate)
}

/// Compares two recordings of one scene; the tolerances are those of the first.
fn compare(world: &World, run: &Recording, tighter: &Recording, tolerance: f64) -> ErrorEstimate {
    let comparison = Comparison::new(world, run);
    let shifts = comparison.shifts(run, tighter);
    // Bodies that touch at a wide gap are off by that gap at once.
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
        thresholds: thresholds::find(world, [run, tighter], trusted),
        tighter_stopped: None,
        curve,
    }
}
