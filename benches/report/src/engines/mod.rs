//! The engines that are measured, behind one trait: build a scene, advance it, read states.

mod belt;
pub mod box2d;
pub mod halfgap;
pub mod moved;
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

#[cfg(test)]
mod tests {
    use super::box2d::{Box2d, Contacts};
    use super::halfgap::Halfgap;
    use super::moved::Drives;
    use super::rapier::{Joints, Rapier, Tuning};
    use super::*;
    use crate::measure::{Repeats, measure};
    use crate::scene::Group;
    use crate::scenes;

    /// The peers at a step of about a millisecond, set for accuracy.
    fn peers(scene: &Scene, drives: Drives) -> [Box<dyn Engine>; 2] {
        let (steps_per_check, segments) = ((1000.0 * scene.check_grid) as u32, 512);
        let tuning = Tuning::Accurate;
        [
            Box::new(Rapier {
                steps_per_check,
                iterations: 4,
                segments,
                tuning,
                joints: Joints::Impulse,
                drives,
            }),
            Box::new(Box2d {
                steps_per_check,
                substeps: 4,
                segments,
                scale: 100.0,
                contacts: Contacts::Stiff,
                soft_joints: scene.group() == Group::MotorsAndLimits,
                drives,
            }),
        ]
    }

    fn error(engine: &dyn Engine, scene: &Scene) -> f64 {
        let once = Repeats { most: 0, ..Repeats::QUICK };
        let run = measure(engine, scene, &once).expect("it runs");
        run.error.expect("its answer is known")
    }

    #[test]
    fn every_engine_is_given_the_friction_the_springs_and_the_belt_of_a_scene() {
        let names = [
            "block_slide_friction",
            "disc_slips_then_rolls",
            "block_rocks",
            "belt_stick_slip",
            "friction_drive",
        ];
        for scene in scenes::wanted(|name| names.contains(&name)) {
            let ours = error(&Halfgap { tolerance: 1e-6, step: None }, &scene);
            assert!(ours < 1e-7, "{}: {ours}", scene.name);
            for peer in peers(&scene, Drives::Motor) {
                let theirs = error(&*peer, &scene);
                assert!(theirs < 5e-3, "{}: {} {theirs}", scene.name, peer.name());
            }
        }
    }

    #[test]
    fn every_engine_is_given_the_motors_the_limits_and_the_drives_of_a_scene() {
        let scenes = scenes::wanted(|_| true).into_iter();
        for scene in scenes.filter(|scene| scene.group() == Group::MotorsAndLimits) {
            let ours = error(&Halfgap { tolerance: 1e-6, step: None }, &scene);
            assert!(ours < 1e-6, "{}: {ours}", scene.name);
            for drives in [Drives::Motor, Drives::Moved] {
                for peer in peers(&scene, drives) {
                    let theirs = error(&*peer, &scene);
                    assert!(theirs < 5e-2, "{}: {} {drives:?} {theirs}", scene.name, peer.name());
                }
            }
        }
    }

    #[test]
    fn peers_have_no_friction_in_the_part_of_an_impact_that_parts() {
        let scenes = scenes::wanted(|name| name == "disc_bounces_sliding");
        let [floor, disc] = [0, 1].map(|body| &scenes[0].bodies[body]);
        let (friction, speed) = (floor.surface.friction, disc.start.velocity.x);
        // Between the first impact, at the speed of a fall of 1 m, and the second.
        let closing = (2.0 * scenes[0].gravity.length()).sqrt();
        for peer in peers(&scenes[0], Drives::Motor) {
            let mut session = peer.start(&scenes[0]).expect("it has all that the scene needs");
            session.advance(1.0).expect("it runs");
            let mut states = Vec::new();
            session.write_states(&mut states);
            let share = (speed - states[1].velocity.x) / (friction * closing);
            assert!((share - 1.0).abs() < 0.02, "{}: {share} of the impulse that stops it", peer.name());
        }
    }
}
