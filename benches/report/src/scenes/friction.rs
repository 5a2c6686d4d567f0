//! Scenes of the tests with friction.

use super::exact;
use crate::scene::{Body, Scene};

/// Reads a scene by its name, with the grid [s] of its check times.
pub(super) fn read(name: &str, grid: f64) -> Scene {
    exact::read_known(name, &format!("friction/{name}.json"), grid)
}

/// Reads a scene in which nothing bounces. What its file says of elasticity means nothing then; engines of steps get
/// none, for some of them would bounce what they find a little apart.
pub(super) fn without_bounce(name: &str, grid: f64) -> Scene {
    still(read(name, grid))
}

/// A block on a belt and a spring.
pub(super) fn belt() -> Scene {
    still(exact::read_known("belt_stick_slip", "friction/x_belt_stick_slip.json", 0.05))
}

/// Reads a scene in which all stays where it is.
pub(super) fn at_rest(name: &str, grid: f64) -> Scene {
    let reference = "all stays where it is: every line of forces lies within its base and its cones";
    let scene = exact::read(name, grid);
    let error = scene.reference_error;
    scene.with_reference(reference, error)
}

fn still(mut scene: Scene) -> Scene {
    let bodies = std::mem::take(&mut scene.bodies);
    scene.bodies = bodies.into_iter().map(|body: Body| body.with_elasticity(0.0)).collect();
    scene
}

#[cfg(test)]
mod tests {
    use crate::scenes;

    #[test]
    fn rough_bodies_of_a_scene_are_equally_rough() {
        // Then all rules by which engines combine two coefficients agree.
        for scene in scenes::wanted(|_| true).iter().filter(|scene| scene.has_friction()) {
            let rough = scene.bodies.iter().map(|body| body.surface).filter(|surface| surface.friction > 0.0);
            let pairs: Vec<_> = rough.map(|surface| (surface.friction, surface.static_friction)).collect();
            assert!(pairs.windows(2).all(|pair| pair[0] == pair[1]), "{}: {pairs:?}", scene.name);
        }
    }
}
