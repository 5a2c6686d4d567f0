//! One run of one engine: its time and its error.
//!
//! Stepping alone is timed. A first pass stops at every time of the scene's grid for a look at penetration;
//! then the run is repeated from its set-up, unless it is long, and the least of all times counts: other work
//! of the machine can only add to it.

use crate::engines::{Engine, EngineError};
use crate::scene::Scene;
use halfgap::BodyState;
use std::time::{Duration, Instant};

/// Rules for the repetition of a run.
#[derive(Clone, Copy, Debug)]
pub struct Repeats {
    /// A run that takes longer is given up.
    pub longest: Duration,
    /// Largest number of repeats.
    pub most: usize,
    /// No further repeats once they have taken this long together.
    pub patience: Duration,
}

impl Repeats {
    /// For a report.
    pub const THOROUGH: Self =
        Self { longest: Duration::from_secs(60), most: 101, patience: Duration::from_millis(400) };
    /// For a quick look.
    pub const QUICK: Self =
        Self { longest: Duration::from_secs(5), most: 11, patience: Duration::from_millis(20) };
}

/// Cost and error of a run.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// Least time of stepping [s] per simulated second.
    pub wall_per_second: f64,
    /// Steps of one run.
    pub steps: u64,
    /// Impacts of one run, where the engine knows such.
    pub events: Option<u64>,
    /// Largest error at a check [m]; `None` if nothing is known.
    pub error: Option<f64>,
    /// Deepest overlap that the engine itself saw at a time of the grid [m].
    pub penetration: f64,
    /// Largest error of a connector at a time of the grid [m].
    pub connector_error: f64,
    /// Energy at the last check less that of the known states [J]; without checks the gain since the start.
    pub energy_error: f64,
}

/// Runs a scene.
///
/// # Errors
/// The engine cannot run it to its end.
pub fn measure(engine: &dyn Engine, scene: &Scene, repeats: &Repeats) -> Result<Measurement, EngineError> {
    let mut measurement = first_pass(engine, scene, repeats)?;
    let started = Instant::now();
    for _ in 0..repeats.most {
        let expected = measurement.wall_per_second * scene.duration;
        if started.elapsed().as_secs_f64() + expected > repeats.patience.as_secs_f64() {
            break;
        }
        let wall = timed_pass(engine, scene)?.as_secs_f64();
        measurement.wall_per_second = measurement.wall_per_second.min(wall / scene.duration);
    }
    Ok(measurement)
}

/// Runs a scene once, with a look at every time of the grid.
fn first_pass(engine: &dyn Engine, scene: &Scene, repeats: &Repeats) -> Result<Measurement, EngineError> {
    let mut wall = Duration::ZERO;
    let mut session = engine.start(scene)?;
    let mut states = Vec::new();
    session.write_states(&mut states);
    let start_energy = scene.energy(&states);
    let (mut penetration, mut connector_error, mut error) = (0.0_f64, 0.0_f64, None);
    let mut checks = scene.checks.iter().peekable();
    let times = (scene.duration / scene.check_grid).round() as u64;
    for time in (1..=times).map(|index| index as f64 * scene.check_grid) {
        let started = Instant::now();
        session.advance(time)?;
        wall += started.elapsed();
        if wall > repeats.longest {
            return Err(EngineError::TooSlow { seconds: repeats.longest.as_secs_f64(), time });
        }
        session.write_states(&mut states);
        penetration = penetration.max(session.penetration());
        connector_error = connector_error.max(scene.connector_error(&states));
        if let Some(check) = checks.next_if(|check| check.time < time + 0.5 * scene.check_grid) {
            error = Some(scene.error(check, &states).max(error.unwrap_or(0.0)));
        }
    }
    let energy_error = match scene.checks.last() {
        Some(last) => {
            let mut known = states.clone();
            last.states.iter().for_each(|&(body, state)| known[body] = state);
            scene.energy(&states) - scene.energy(&known)
        }
        None => (scene.energy(&states) - start_energy).max(0.0),
    };
    Ok(Measurement {
        wall_per_second: wall.as_secs_f64() / scene.duration,
        steps: session.steps(),
        events: session.events(),
        error,
        penetration,
        connector_error,
        energy_error,
    })
}

/// Runs a scene once for its time; it stops where states are wanted, as a user would.
fn timed_pass(engine: &dyn Engine, scene: &Scene) -> Result<Duration, EngineError> {
    let mut session = engine.start(scene)?;
    let mut states: Vec<BodyState> = Vec::with_capacity(scene.bodies.len());
    let mut wall = Duration::ZERO;
    let ends = [scene.duration];
    let checks = scene.checks.iter().map(|check| check.time);
    for time in checks.chain(ends.into_iter().filter(|_| !scene.has_answer())) {
        let started = Instant::now();
        session.advance(time)?;
        wall += started.elapsed();
        session.write_states(&mut states);
    }
    Ok(wall)
}
