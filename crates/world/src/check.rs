//! Comparison of a run with the states that its scene expects.

use crate::finding::Finding;
use crate::recording::{Frame, Recording};
use crate::run::{Record, RunPlan, run, unwatched};
use crate::scene::{ExpectedData, ExpectedState, Scene};
use crate::world::World;
use glam::DVec2;
use halfgap_collision::BodyState;
use serde::Serialize;

/// Differences of a run from the states that its scene expects.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckReport {
    /// Title of the scene.
    pub scene: String,
    /// Whether the run reached every expected state within its tolerances.
    pub ok: bool,
    /// Largest difference of a position [m] or an angle [rad]; `None` if none was compared.
    pub position_error: Option<f64>,
    /// Largest difference of a velocity [m/s] or an angular velocity [rad/s]; `None` if none was compared.
    pub velocity_error: Option<f64>,
    /// Largest difference of an energy change, or excess over its bound [J]; `None` if none was compared.
    pub energy_error: Option<f64>,
    /// One message for each expectation that failed, with time, body and quantity.
    pub why: Vec<String>,
    /// Broken invariants of the run, whatever was expected.
    #[serde(skip)]
    pub findings: Vec<Finding>,
}

/// Runs the world of a scene up to its last expected time and compares it with the expected states.
pub fn check(world: &mut World, scene: &Scene) -> CheckReport {
    let mut order: Vec<&ExpectedData> = scene.expected.iter().collect();
    order.sort_by(|a, b| a.time.total_cmp(&b.time));
    let mut plan = RunPlan::of_scene(scene, Record::Ends);
    // Rounding may have put a time a little beyond the end.
    plan.stops = order.iter().map(|expected| expected.time.min(plan.end_time)).collect();
    plan.end_time = plan.stops.last().copied().unwrap_or(plan.start_time);
    let report = run(world, &plan, &mut unwatched);
    let start_energy = report.start_energy.total();
    let mut comparison = Comparison::new(world, &report.recording);
    for (expected, frame) in order.iter().zip(&report.stops) {
        comparison.compare(expected, frame, frame.energy.total() - start_energy);
    }
    if let (Some(missed), Some(error)) = (order.get(report.stops.len()), &report.error) {
        comparison.why.push(format!("t = {} s: not reached: {error}", missed.time));
    }
    comparison.into_report(scene, report.findings)
}

/// The comparison so far.
struct Comparison<'a> {
    world: &'a World,
    recording: &'a Recording,
    position_error: Option<f64>,
    velocity_error: Option<f64>,
    energy_error: Option<f64>,
    why: Vec<String>,
}

impl<'a> Comparison<'a> {
    fn new(world: &'a World, recording: &'a Recording) -> Self {
        Self {
            world,
            recording,
            position_error: None,
            velocity_error: None,
            energy_error: None,
            why: Vec::new(),
        }
    }

    fn into_report(self, scene: &Scene, findings: Vec<Finding>) -> CheckReport {
        CheckReport {
            scene: scene.title.clone(),
            ok: self.why.is_empty(),
            position_error: self.position_error,
            velocity_error: self.velocity_error,
            energy_error: self.energy_error,
            why: self.why,
            findings,
        }
    }

    fn compare(&mut self, expected: &ExpectedData, frame: &Frame, energy_change: f64) {
        for (name, state) in &expected.bodies {
            self.compare_body(expected, frame, name, state);
        }
        let time = expected.time;
        if let (Some(change), Some(tolerance)) = (expected.energy_change, expected.energy_tolerance) {
            let error = (energy_change - change).abs();
            raise(&mut self.energy_error, error);
            self.judge(error, tolerance, || {
                format!(
                    "t = {time} s: energy change: got {energy_change} J, expected {change} J within {tolerance:e} J"
                )
            });
        }
        if let Some(bound) = expected.energy_change_below {
            raise(&mut self.energy_error, (energy_change - bound).max(0.0));
            self.judge(energy_change, bound, || {
                format!("t = {time} s: energy change: got {energy_change} J, expected at most {bound} J")
            });
        }
    }

    fn compare_body(&mut self, expected: &ExpectedData, frame: &Frame, name: &str, state: &ExpectedState) {
        let Some(got) = self.find_state(frame, name) else { return };
        let at = format!("t = {} s: {name}", expected.time);
        let near = expected.position_tolerance.unwrap_or(0.0);
        let slow = expected.velocity_tolerance.unwrap_or(0.0);
        if let Some(wanted) = state.position.map(DVec2::from) {
            let error = got.position.distance(wanted);
            raise(&mut self.position_error, error);
            self.judge(error, near, || {
                format!("{at}: position: got {}, expected {wanted} within {near:e} m", got.position)
            });
        }
        if let Some(wanted) = state.angle {
            let error = (got.angle - wanted).abs();
            raise(&mut self.position_error, error);
            self.judge(error, near, || {
                format!("{at}: angle: got {}, expected {wanted} within {near:e} rad", got.angle)
            });
        }
        if let Some(wanted) = state.velocity.map(DVec2::from) {
            let error = got.velocity.distance(wanted);
            raise(&mut self.velocity_error, error);
            self.judge(error, slow, || {
                format!("{at}: velocity: got {}, expected {wanted} within {slow:e} m/s", got.velocity)
            });
        }
        if let Some(wanted) = state.angular_velocity {
            let error = (got.angular_velocity - wanted).abs();
            raise(&mut self.velocity_error, error);
            self.judge(error, slow, || {
                let got = got.angular_velocity;
                format!("{at}: angular velocity: got {got}, expected {wanted} within {slow:e} rad/s")
            });
        }
    }

    /// State of a body in a frame, or of a fixed body, which frames leave out.
    fn find_state(&self, frame: &Frame, name: &str) -> Option<BodyState> {
        let body = self.world.find(name)?;
        let place = self.recording.place(body);
        Some(place.map_or_else(|| self.world.state(body), |place| frame.states[place]))
    }

    /// Notes a difference that is larger than its tolerance, or not a number.
    fn judge(&mut self, error: f64, tolerance: f64, message: impl FnOnce() -> String) {
        if error.is_nan() || error > tolerance {
            self.why.push(message());
        }
    }
}

/// The larger of two errors, of which NaN is the largest.
fn raise(largest: &mut Option<f64>, error: f64) {
    *largest = match *largest {
        Some(before) if before.is_nan() || before >= error => Some(before),
        _ => Some(error),
    };
}
