//! A scene with a tighter tolerance, tighter thresholds and shorter fixed steps.

use crate::build::settings::of_run;
use crate::scene::{RunData, Scene, SceneError};
use crate::world::World;

/// Factor by which tolerance and thresholds shrink.
const FACTOR: f64 = 100.0;
/// Factor by which they shrink where the step is fixed: the step shrinks too, and the run takes longer by this factor.
const FIXED_STEP_FACTOR: f64 = 10.0;
/// Tightest tolerance [-], a few roundings a step; below it nothing becomes more exact.
const TIGHTEST: f64 = 1e-15;
/// Factor by which the target gap shrinks at least, or else grows instead: its share of the error is in proportion to
/// the gap, so that either way the difference is at least half the error.
const GAP_FACTOR: f64 = 2.0;

/// Returns the scene of a world at a tighter tolerance; thresholds that it gives shrink by the same factor.
///
/// A `time_step` that only bounds adaptive steps stays as it is: the tolerance decides there.
pub(super) fn tightened(scene: &Scene, world: &World) -> Result<Scene, SceneError> {
    let run = &scene.run;
    let step = of_run(run).fixed_step();
    let factor = if step.is_some() { FIXED_STEP_FACTOR } else { FACTOR };
    let shrunk = |value: Option<f64>| value.map(|value| value / factor);
    let gap = world.tolerances().target_gap;
    let other_gap = other_gap(gap, factor, least_gap(scene)?);
    let tolerance = run.tolerance_or_default();
    let run = RunData {
        tolerance: Some((tolerance / factor).max(TIGHTEST.min(tolerance))),
        target_gap: Some(other_gap),
        accuracy: run.accuracy.map(|accuracy| accuracy * other_gap / gap),
        velocity_tol: shrunk(run.velocity_tol),
        time_step: step.map(|step| step / factor).or(run.time_step),
        ..run.clone()
    };
    Ok(Scene { run, ..scene.clone() })
}

/// Returns the target gap [m] to compare `gap` [m] with, where the coordinates allow no less than `least` [m].
fn other_gap(gap: f64, factor: f64, least: f64) -> f64 {
    if least <= gap / GAP_FACTOR { least.max(gap / factor) } else { GAP_FACTOR * gap }
}

/// Returns the smallest target gap [m] that the coordinates allow.
fn least_gap(scene: &Scene) -> Result<f64, SceneError> {
    let run = RunData {
        tolerance: Some(TIGHTEST),
        target_gap: None,
        accuracy: None,
        velocity_tol: None,
        ..scene.run.clone()
    };
    Ok(World::from_scene(&Scene { run, ..scene.clone() })?.tolerances().target_gap)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneFormat;

    /// The run of a scene of one disc of 1 m, tightened.
    fn run(fields: &str) -> RunData {
        let text = format!(
            "format = \"halfgap-scene-1\"\ntitle = \"t\"\nrun = {{ duration = 1.0, {fields} }}\n\
             [[body]]\nname = \"disc\"\nmass = 1.0\nshape = {{ disc = {{ radius = 1.0 }} }}\n"
        );
        let scene = Scene::parse(&text, SceneFormat::Toml).expect("a fine scene");
        let world = World::from_scene(&scene).expect("a fine world");
        tightened(&scene, &world).expect("a fine world at a tighter tolerance").run
    }

    #[test]
    fn everything_that_is_given_shrinks() {
        let run =
            run("tolerance = 1e-6, target_gap = 1e-2, accuracy = 1e-3, velocity_tol = 0.5, time_step = 0.1");
        assert_eq!((run.tolerance, run.target_gap), (Some(1e-6 / 100.0), Some(1e-2 / 100.0)));
        assert!((run.accuracy.expect("it was given") - 1e-5).abs() < 1e-18);
        assert_eq!(run.velocity_tol, Some(0.5 / 100.0));
        assert_eq!(run.time_step, Some(0.1), "it bounds an adaptive step");
    }

    #[test]
    fn a_fixed_step_shrinks_to_a_tenth() {
        let run = run("integrator = \"euler\", velocity_tol = 0.5");
        assert_eq!((run.time_step, run.velocity_tol), (Some(0.025 / 10.0), Some(0.5 / 10.0)));
    }

    #[test]
    fn a_tolerance_of_rounding_stays() {
        assert_eq!(run("tolerance = 1e-14").tolerance, Some(1e-15));
        assert_eq!(run("tolerance = 1e-16").tolerance, Some(1e-16));
    }

    #[test]
    fn a_gap_that_cannot_shrink_grows() {
        assert_eq!(other_gap(2.0, 100.0, 1e-3), 0.02);
        assert_eq!(other_gap(2.0, 100.0, 0.5), 0.5);
        assert_eq!(other_gap(2.0, 100.0, 1.5), 4.0);
    }
}
