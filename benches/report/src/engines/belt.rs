//! A belt with a load on its top, for engines that know one coefficient of friction: before each step they are told
//! which one holds, as a user of theirs would do it.

use crate::scene::{Scene, Surface};
use glam::DVec2;

/// A fixed block whose surface runs, and the body that lies on its top.
pub(super) struct Belt {
    /// The block that runs.
    pub(super) floor: usize,
    /// The body on it.
    pub(super) load: usize,
    /// Velocity of the top [m/s].
    velocity: DVec2,
    surface: Surface,
    /// Slip [m/s] below which the load goes with the belt.
    least_slip: f64,
    /// The coefficient that the engine was told last [-].
    told: Option<f64>,
}

impl Belt {
    /// The belt of a scene, if it has one. The slip [m/s] that counts as none lies above what the engine leaves of a
    /// slip when it holds a load: too small a slip takes a load that rests for one that slips, and too large a one
    /// finds out late that it slips.
    pub(super) fn of(scene: &Scene, least_slip: f64) -> Option<Self> {
        let floor = scene.bodies.iter().position(|body| body.surface.speed != 0.0)?;
        let load = scene.bodies.iter().position(|body| body.inertia.is_some())?;
        let (surface, angle) = (scene.bodies[floor].surface, scene.bodies[floor].start.angle);
        Some(Self { floor, load, velocity: top_velocity(&surface, angle), surface, least_slip, told: None })
    }

    /// The coefficient [-] for the next step, if it is another than the last, by the velocity of the load [m/s].
    pub(super) fn change(&mut self, load: DVec2) -> Option<f64> {
        let slip = (load - self.velocity).dot(self.velocity.normalize()).abs();
        let sticks = slip < self.least_slip;
        let coefficient = if sticks { self.surface.static_friction } else { self.surface.friction };
        (self.told.replace(coefficient) != Some(coefficient)).then_some(coefficient)
    }
}

/// Velocity [m/s] of the top of a block at an angle [rad]: counter-clockwise along its outline is to the left there.
pub(super) fn top_velocity(surface: &Surface, angle: f64) -> DVec2 {
    -surface.speed * DVec2::from_angle(angle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes;

    #[test]
    fn a_load_that_goes_with_the_belt_has_static_friction_and_any_other_has_kinetic_friction() {
        let scenes = scenes::wanted(|name| name == "belt_stick_slip");
        let mut belt = Belt::of(&scenes[0], 1e-6).expect("it has a belt");
        assert_eq!(belt.change(DVec2::new(0.5, 0.0)), Some(0.3));
        assert_eq!(belt.change(DVec2::new(0.5 + 1e-7, 0.1)), None);
        assert_eq!(belt.change(DVec2::new(0.4, 0.0)), Some(0.2));
        assert_eq!(belt.change(DVec2::new(-0.5, 0.0)), None);
    }
}
