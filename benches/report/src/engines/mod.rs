//! The engines that are measured, behind one trait: build a scene, advance it, read states.

pub mod box2d;
pub mod halfgap;
pub mod rapier;
mod segments;

use crate::scene::Scene;
use ::halfgap::BodyState;

/// Reason why an engine could not build or run a scene.
#[derive(Clone, Debug, thiserror::Error)]
pub enum EngineError {
    /// It has no means for something in the scene.
    #[error("{engine} has no {what}")]
    Unsupported {
        /// The engine.
        engine: &'static str,
        /// The feature that it lacks.
        what: &'static str,
    },
    /// It refused the scene.
    #[error("cannot be built: {0}")]
    Build(String),
    /// It stopped early.
    #[error("stopped early: {0}")]
    Stopped(String),
    /// It was given up.
    #[error("given up after {seconds} s at t = {time} s")]
    TooSlow {
        /// The patience it had [s].
        seconds: f64,
        /// How far it got [s].
        time: f64,
    },
}

/// An engine with its settings.
pub trait Engine {
    /// Name of the engine.
    fn name(&self) -> &'static str;

    /// Its version.
    fn version(&self) -> &'static str;

    /// Short form of the settings of this run.
    fn settings(&self) -> String;

    /// Sets a scene up.
    ///
    /// # Errors
    /// Something in the scene is beyond the engine.
    fn start(&self, scene: &Scene) -> Result<Box<dyn Session>, EngineError>;
}

/// A scene under way.
pub trait Session {
    /// Advances to a time [s] on the scene's grid of checks. Only this is timed.
    ///
    /// # Errors
    /// The run cannot go on.
    fn advance(&mut self, time: f64) -> Result<(), EngineError>;

    /// Writes the states of all bodies at the present time.
    fn write_states(&mut self, states: &mut Vec<BodyState>);

    /// Steps so far.
    fn steps(&self) -> u64;

    /// Impacts so far, where the engine knows such.
    fn events(&self) -> Option<u64>;

    /// The deepest overlap [m] that the engine itself sees at the present time, or has seen since the start.
    fn penetration(&mut self) -> f64;
}
