//! Bodies that a drive turns about a point of the world, for engines that move a body as they are told: it has its origin
//! at that point, and needs neither pin nor motor.

use crate::scene::{Connector, Scene};
use glam::DVec2;
use halfgap::BodyState;

/// How an engine without drives is given one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drives {
    /// As a motor that pulls as hard as is wanted.
    Motor,
    /// The body is one that is moved, where it turns about a point of the world.
    Moved,
}

/// A body that is turned.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved {
    pub(super) body: usize,
    /// The pin that is not needed.
    pub(super) pin: usize,
    /// The pivot in the world [m] and in the body's coordinates [m].
    pub(super) pivot: DVec2,
    pub(super) point: DVec2,
    /// Its angle at the start [rad] and its rate [rad/s].
    pub(super) start: f64,
    pub(super) rate: f64,
}

/// All bodies of a scene that are to be moved.
pub(super) fn moved(scene: &Scene, drives: Drives) -> Vec<Moved> {
    let turned = |&(pin, on_joint): &(usize, crate::on_joint::OnJoint)| {
        let rate = on_joint.rate.filter(|_| drives == Drives::Moved)?;
        match scene.connectors.get(pin)? {
            Connector::Pin(a, b) if a.body.is_none() => {
                let body = b.body?;
                let start = scene.bodies.get(body)?.start.angle;
                Some(Moved { body, pin, pivot: a.point, point: b.point, start, rate })
            }
            _ => None,
        }
    };
    scene.on_joints.iter().filter_map(turned).collect()
}

/// State of the body, from its angle [rad].
pub(super) fn state(moved: &Moved, angle: f64) -> BodyState {
    let arm = -DVec2::from_angle(angle).rotate(moved.point);
    BodyState {
        position: moved.pivot + arm,
        angle,
        velocity: moved.rate * arm.perp(),
        angular_velocity: moved.rate,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes;

    #[test]
    fn the_crank_of_a_driven_four_bar_is_moved_and_starts_where_it_is() {
        let scenes = scenes::wanted(|name| name == "driven_four_bar");
        assert!(moved(&scenes[0], Drives::Motor).is_empty());
        let cranks = moved(&scenes[0], Drives::Moved);
        let start = scenes[0].bodies[cranks[0].body].start;
        let known = state(&cranks[0], start.angle);
        assert!((known.position - start.position).length() < 1e-15);
        assert!((known.velocity - start.velocity).length() < 1e-14 && cranks.len() == 1);
    }
}
