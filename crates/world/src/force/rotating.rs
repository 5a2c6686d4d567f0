//! A force of constant size whose direction turns.

use super::{ForceLaw, Snapshot, Wrenches};
use glam::DVec2;
use halfgap_collision::{Anchor, BodyId};
use halfgap_geometry::Rotation;

/// A force of constant size at a point of a body, whose direction in the body's frame turns at a constant rate.
///
/// At time t its angle to the body's x axis is phase + rate (t - start), counter-clockwise. It has no potential.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct RotatingForce {
    name: String,
    body: [BodyId; 1],
    point: DVec2,
    turning: Turning,
}

/// Size, rate and phase of a [`RotatingForce`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Turning {
    /// Size of the force [N]; a negative one points the other way.
    pub magnitude: f64,
    /// Rate at which the direction turns in the body's frame [rad/s], counter-clockwise positive.
    pub rate: f64,
    /// Direction in the body's frame at `start` [rad], from the x axis, counter-clockwise positive.
    pub phase: f64,
    /// Time at which the direction is `phase` [s]; in scene files the start of the run.
    pub start: f64,
}

impl RotatingForce {
    /// Makes the law for a point of a body, with a name for messages and the ledger; on the background it does nothing.
    #[must_use]
    pub fn new(name: impl Into<String>, at: Anchor, turning: Turning) -> Self {
        Self { name: name.into(), body: [at.body], point: at.point, turning }
    }
}

impl ForceLaw for RotatingForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        let Turning { magnitude, rate, phase, start } = self.turning;
        let [body] = self.body;
        let pose = now.body(body).pose;
        let direction = Rotation::from_angle(phase + rate * (now.time - start)).apply(DVec2::X);
        wrenches.add_force(
            body,
            magnitude * pose.vector_to_world(direction),
            pose.vector_to_world(self.point),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::super::law_check::{states, wrenches_at};
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn the_direction_turns_in_the_bodys_frame_from_its_phase() {
        let at = Anchor { body: BodyId(0), point: DVec2::new(1.0, 0.0) };
        let turning = Turning { magnitude: 2.0, rate: 0.5, phase: FRAC_PI_2, start: 10.0 };
        let law = RotatingForce::new("", at, turning);
        let mut states = states();
        states[0].angle = 0.0;
        // Up at the start, to the left after a quarter turn; a turned body takes it along.
        for (time, angle, force, torque) in [
            (10.0, 0.0, DVec2::new(0.0, 2.0), 2.0),
            (10.0 + std::f64::consts::PI, 0.0, DVec2::new(-2.0, 0.0), 0.0),
            (10.0, FRAC_PI_2, DVec2::new(-2.0, 0.0), 2.0),
        ] {
            states[0].angle = angle;
            let pushed = wrenches_at(&law, &states, time)[0];
            assert!((pushed.force - force).length() < 1e-15 * 4.0, "{} at {time} s", pushed.force);
            assert!((pushed.torque - torque).abs() < 1e-15 * 4.0, "{} at {time} s", pushed.torque);
        }
    }
}
