//! The summary of a run, and its JSON form, format `halfgap-result-1`.

use crate::estimate::ErrorEstimate;
use crate::finding::Finding;
use crate::ledger::Ledger;
use crate::recording::Recording;
use crate::run::RunReport;
use crate::run_error::{Outcome, RunError};
use crate::world::{Statistics, World};
use halfgap_advance::rigid::RemedyCounts;
use halfgap_collision::{BodyId, BodyState};
use serde::ser::{SerializeMap, SerializeStruct};
use serde::{Serialize, Serializer};

/// Summary of a run: outcome, final states, energies and counters.
#[derive(Clone, Debug, PartialEq)]
pub struct RunResult {
    /// Title of the scene.
    pub scene: String,
    /// Outcome of the run.
    pub status: Outcome,
    /// Time at the end [s].
    pub time: f64,
    /// Final states of the movable bodies by name, in the order of the scene.
    pub bodies: Vec<(String, BodyState)>,
    /// Energies at start and end.
    pub energy: EnergyResult,
    /// Counters and wall time.
    pub statistics: StatisticsResult,
    /// Changes of the energy by their causes.
    pub ledger: Ledger,
    /// Broken invariants; see [`RunReport::findings`].
    pub findings: Vec<Finding>,
    /// Estimate of the error, if one was made.
    pub error_estimate: Option<ErrorEstimate>,
    /// Sizes that numbers have in the run; not part of the JSON form.
    pub scales: ResultScales,
}

/// Sizes that numbers have in a run, by which it can be told which of their digits mean something.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ResultScales {
    /// Largest coordinate of a movable body at the start and the end [m].
    pub length: f64,
    /// Speed [m/s] that the energy in play gives to the bodies, or below which a contact is slow if that is more.
    pub speed: f64,
    /// Angular velocity [rad/s] at which the largest movable body's points have that speed.
    pub spin: f64,
    /// Largest of the energies at the start and the end, and of that in play [J].
    pub energy: f64,
}

impl ResultScales {
    fn of(world: &World, report: &RunReport) -> Self {
        let recording = &report.recording;
        let reach = |body: BodyId| world.shape(body).reach();
        let ends = recording.frames.first().into_iter().chain(recording.frames.last());
        let states = ends.flat_map(|frame| recording.movable.iter().zip(&frame.states));
        let length = states.map(|(&body, state)| state.position.abs().max_element() + reach(body));
        let mass: f64 =
            recording.movable.iter().filter_map(|&body| world.inertia(body)).map(|own| own.mass).sum();
        let of_energy = if mass > 0.0 { (2.0 * report.energy_in_play / mass).sqrt() } else { 0.0 };
        let speed = of_energy.max(world.tolerances().velocity_tol);
        let largest = recording.movable.iter().map(|&body| reach(body)).fold(0.0, f64::max);
        let now = world.energy();
        let energies =
            [report.start_energy.kinetic, report.start_energy.potential, now.kinetic, now.potential];
        Self {
            length: length.fold(0.0, f64::max),
            speed,
            spin: if largest > 0.0 { speed / largest } else { 0.0 },
            energy: energies.into_iter().map(f64::abs).fold(report.energy_in_play, f64::max),
        }
    }
}

/// Energy at start and end.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EnergyResult {
    /// Total energy at the start [J].
    pub start: f64,
    /// Kinetic energy at the end [J].
    pub kinetic: f64,
    /// Potential energy at the end [J].
    pub potential: f64,
    /// Total energy at the end [J].
    pub total: f64,
}

/// Counters of a run, and its wall time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StatisticsResult {
    /// Counters of the world.
    pub world: Statistics,
    /// Wall time of stepping alone [s], the least where a run was repeated; `None` on platforms without a clock.
    pub wall_seconds: Option<f64>,
    /// Median of the wall times [s] where a run was repeated: the mean of the two in the middle of an even number.
    pub wall_seconds_median: Option<f64>,
}

impl RunResult {
    /// Summarizes a run that has just ended.
    #[must_use]
    pub fn new(world: &World, report: &RunReport) -> Self {
        let recording: &Recording = &report.recording;
        let state = |&body| (world.name(body).to_owned(), world.state(body));
        let energy = world.energy();
        Self {
            scene: recording.title.clone(),
            status: report.error.as_ref().map_or(Outcome::Done, RunError::outcome),
            time: world.time(),
            bodies: recording.movable.iter().map(state).collect(),
            energy: EnergyResult {
                start: report.start_energy.total(),
                kinetic: energy.kinetic,
                potential: energy.potential,
                total: energy.total(),
            },
            statistics: StatisticsResult {
                world: world.statistics(),
                wall_seconds: report.wall_seconds,
                wall_seconds_median: None,
            },
            ledger: world.ledger(),
            findings: report.findings.clone(),
            error_estimate: None,
            scales: ResultScales::of(world, report),
        }
    }

    /// Returns the summary as one JSON object; numbers have the shortest form that reads back as the same bits.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("a result is strings and numbers only")
    }
}

impl Serialize for RunResult {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut result = serializer.serialize_struct("RunResult", 10)?;
        result.serialize_field("format", "halfgap-result-1")?;
        result.serialize_field("scene", &self.scene)?;
        result.serialize_field("status", &self.status)?;
        result.serialize_field("time", &self.time)?;
        result.serialize_field("bodies", &BodiesJson(&self.bodies))?;
        result.serialize_field("energy", &self.energy)?;
        result.serialize_field("statistics", &self.statistics)?;
        result.serialize_field("ledger", &self.ledger)?;
        let findings: Vec<String> = self.findings.iter().map(Finding::to_string).collect();
        result.serialize_field("findings", &findings)?;
        match &self.error_estimate {
            Some(estimate) => result.serialize_field("error_estimate", estimate)?,
            None => result.skip_field("error_estimate")?,
        }
        result.end()
    }
}

/// Serializes the bodies as a map in the order of the scene, which sorted maps would lose.
struct BodiesJson<'a>(&'a [(String, BodyState)]);

impl Serialize for BodiesJson<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut bodies = serializer.serialize_map(Some(self.0.len()))?;
        for (name, state) in self.0 {
            bodies.serialize_entry(name, &StateJson::from(state))?;
        }
        bodies.end()
    }
}

#[derive(Serialize)]
struct StateJson {
    position: [f64; 2],
    angle: f64,
    velocity: [f64; 2],
    angular_velocity: f64,
}

impl From<&BodyState> for StateJson {
    fn from(state: &BodyState) -> Self {
        Self {
            position: state.position.to_array(),
            angle: state.angle,
            velocity: state.velocity.to_array(),
            angular_velocity: state.angular_velocity,
        }
    }
}

impl Serialize for StatisticsResult {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let world = &self.world;
        let any_acted = world.remedies.acted().next().is_some();
        let any_steps = world.region_steps > 0;
        let fields = 8
            + usize::from(any_steps)
            + usize::from(self.wall_seconds_median.is_some())
            + usize::from(any_acted);
        let mut statistics = serializer.serialize_struct("StatisticsResult", fields)?;
        statistics.serialize_field("steps", &world.steps)?;
        statistics.serialize_field("evaluations", &world.evaluations)?;
        statistics.serialize_field("impacts", &world.impacts)?;
        statistics.serialize_field("backups", &world.backups)?;
        statistics.serialize_field("contact_solves", &world.contact_solves)?;
        if any_steps {
            statistics.serialize_field("region_steps", &world.region_steps)?;
        } else {
            statistics.skip_field("region_steps")?;
        }
        statistics.serialize_field("smallest_gap", &world.smallest_gap)?;
        statistics.serialize_field("largest_connector_error", &world.largest_connector_error)?;
        if any_acted {
            statistics.serialize_field("remedies", &RemediesJson(&world.remedies))?;
        } else {
            statistics.skip_field("remedies")?;
        }
        statistics.serialize_field("wall_seconds", &self.wall_seconds)?;
        match self.wall_seconds_median {
            Some(median) => statistics.serialize_field("wall_seconds_median", &median)?,
            None => statistics.skip_field("wall_seconds_median")?,
        }
        statistics.end()
    }
}

/// Serializes the remedies that have acted as a map, in their order.
struct RemediesJson<'a>(&'a RemedyCounts);

impl Serialize for RemediesJson<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.acted().map(|(remedy, count)| (remedy.name(), count)))
    }
}

/// Serializes energies and booked changes [J], and the error of the integration.
impl Serialize for Ledger {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let rare = [
            ("steps", self.steps),
            ("interventions", self.interventions),
            ("jams", self.jams),
            ("impact_friction", self.impact_friction),
            ("friction", self.friction),
            ("surfaces", self.surfaces),
            ("drives", self.drives),
        ];
        let count = rare.iter().filter(|(_, change)| *change != 0.0).count();
        let mut ledger = serializer.serialize_struct("Ledger", 9 + count)?;
        ledger.serialize_field("start", &self.start)?;
        ledger.serialize_field("start_correction", &self.start_correction)?;
        ledger.serialize_field("kinetic", &self.now.kinetic)?;
        ledger.serialize_field("potential", &self.now.potential)?;
        ledger.serialize_field("impacts", &self.impacts)?;
        ledger.serialize_field("captures", &self.captures)?;
        ledger.serialize_field("projections", &self.projections)?;
        for (name, change) in rare {
            if change == 0.0 {
                ledger.skip_field(name)?;
            } else {
                ledger.serialize_field(name, &change)?;
            }
        }
        ledger.serialize_field("damping", &self.damping)?;
        ledger.serialize_field("laws", &self.force_laws)?;
        ledger.serialize_field("integration_error", &self.integration_error())?;
        ledger.end()
    }
}
