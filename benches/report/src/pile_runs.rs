//! Piles: what they cost, how deep bodies overlap, whether steps gain energy, and whether what rests creeps.

use crate::engines::{Engine, EngineError};
use crate::scene::Scene;
use glam::DVec2;
use halfgap::BodyState;
use std::time::Instant;

/// Time [s] at the end in which bodies at rest should not move.
const AT_REST: f64 = 1.0;

/// What is measured of a pile.
#[derive(Clone, Copy, Debug)]
pub struct PileRun {
    /// Time of stepping [s] per simulated second.
    pub wall_per_second: f64,
    /// Time of the longest frame [s].
    pub longest_frame: f64,
    /// Deepest overlap [m] that the engine saw.
    pub deepest: f64,
    /// Largest gain of energy in a frame, as a fraction of the energy that the scene has lost in all [-], or of that of its fall
    /// through a metre.
    pub gain: f64,
    /// Largest way of a body in the last second [m/s].
    pub creep: f64,
    /// Largest way of a body since the start [m].
    pub drift: f64,
}

/// Runs a pile frame by frame.
///
/// # Errors
/// The engine cannot run it to its end.
pub fn run(engine: &dyn Engine, scene: &Scene) -> Result<PileRun, EngineError> {
    let mut session = engine.start(scene)?;
    let mut states: Vec<BodyState> = Vec::new();
    session.write_states(&mut states);
    let start: Vec<DVec2> = states.iter().map(|state| state.position).collect();
    let mut before_rest = start.clone();
    let frames = (scene.duration / scene.check_grid).round() as u32;
    let rest = frames.saturating_sub((AT_REST / scene.check_grid).round() as u32);
    let (mut wall, mut longest, mut deepest, mut gain) = (0.0, 0.0_f64, 0.0_f64, 0.0_f64);
    let mut energy = scene.energy(&states);
    for frame in 1..=frames {
        let begun = Instant::now();
        session.advance(f64::from(frame) * scene.check_grid)?;
        let took = begun.elapsed().as_secs_f64();
        wall += took;
        longest = longest.max(took);
        session.write_states(&mut states);
        deepest = deepest.max(session.penetration());
        let now = scene.energy(&states);
        gain = gain.max(now - energy);
        energy = now;
        if frame == rest {
            before_rest = states.iter().map(|state| state.position).collect();
        }
    }
    let weight: f64 = scene.bodies.iter().filter_map(|body| body.inertia).map(|inertia| inertia.mass).sum();
    let way = |from: &[DVec2]| {
        states.iter().zip(from).map(|(state, from)| (state.position - *from).length()).fold(0.0, f64::max)
    };
    Ok(PileRun {
        wall_per_second: wall / scene.duration,
        longest_frame: longest,
        deepest,
        gain: gain / (weight * scene.gravity.length()),
        creep: way(&before_rest) / AT_REST,
        drift: way(&start),
    })
}
