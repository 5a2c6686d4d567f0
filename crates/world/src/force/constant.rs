//! A constant force at a point, and a constant torque.

use super::{ForceLaw, Snapshot, Wrenches};
use glam::DVec2;
use halfgap_collision::BodyId;

/// The frame in which a constant force and its point are given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(any(feature = "save", feature = "scene"), derive(serde::Deserialize, serde::Serialize))]
#[cfg_attr(any(feature = "save", feature = "scene"), serde(rename_all = "snake_case"))]
pub enum ForceFrame {
    /// Force and point turn with the body. In code the origin is the centre of mass, in scene files that of the
    /// shape's coordinates.
    Body,
    /// Force and point stay fixed in the world, however the body moves.
    #[default]
    World,
}

/// A constant force at a point, and a constant torque, on one body.
///
/// It has no potential. In the body's frame the force turns with the body; in the world's frame its torque depends on
/// the position of the body while the force does not depend on the angle: neither is a gradient.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ConstantForce {
    name: String,
    body: [BodyId; 1],
    push: Push,
}

/// Force, its point and torque of a [`ConstantForce`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Push {
    /// Frame of the point and the force.
    pub frame: ForceFrame,
    /// Point at which the force acts, in coordinates of `frame` [m].
    pub point: DVec2,
    /// Force, in coordinates of `frame` [N].
    pub force: DVec2,
    /// Torque [N m], counter-clockwise positive.
    pub torque: f64,
}

impl ConstantForce {
    /// Makes the law for one body, with a name for messages and the ledger.
    #[must_use]
    pub fn new(name: impl Into<String>, body: BodyId, push: Push) -> Self {
        Self { name: name.into(), body: [body], push }
    }
}

impl ForceLaw for ConstantForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        let [body] = self.body;
        let pose = now.body(body).pose;
        let Push { frame, point, force, torque } = self.push;
        let (force, arm) = match frame {
            ForceFrame::Body => (pose.vector_to_world(force), pose.vector_to_world(point)),
            ForceFrame::World => (force, point - pose.position),
        };
        wrenches.add_force(body, force, arm);
        wrenches.add_torque(body, torque);
    }

    fn fixed_point(&self) -> Option<(BodyId, DVec2)> {
        let Push { frame, point, force, .. } = self.push;
        (frame == ForceFrame::World && force != DVec2::ZERO).then_some((self.body[0], point))
    }
}

#[cfg(test)]
mod tests {
    use super::super::law_check::{states, wrenches};
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    const POINT: DVec2 = DVec2::new(0.0, 2.0);
    const FORCE: DVec2 = DVec2::new(3.0, 0.0);

    fn push(frame: ForceFrame, torque: f64) -> Push {
        Push { frame, point: POINT, force: FORCE, torque }
    }

    #[test]
    fn in_the_bodys_frame_force_and_point_turn_with_the_body() {
        let law = ConstantForce::new("", BodyId(0), push(ForceFrame::Body, 0.5));
        let mut states = states();
        states[0].angle = FRAC_PI_2;
        let pushed = wrenches(&law, &states)[0];
        assert!((pushed.force - DVec2::new(0.0, 3.0)).length() < 1e-15);
        assert!((pushed.torque - (0.5 - 6.0)).abs() < 1e-15, "{}", pushed.torque);
    }

    #[test]
    fn in_the_worlds_frame_the_point_stays_while_the_body_moves() {
        let law = ConstantForce::new("", BodyId(0), push(ForceFrame::World, 0.0));
        let mut states = states();
        for (height, torque) in [(0.0, -6.0), (2.0, 0.0), (3.0, 3.0)] {
            states[0].position = DVec2::new(7.0, height);
            let pushed = wrenches(&law, &states)[0];
            assert_eq!((pushed.force, pushed.torque), (FORCE, torque));
        }
    }

    #[test]
    fn neither_is_a_gradient() {
        // Around a small rectangle of height and angle the work is not zero, so no potential can exist.
        for frame in [ForceFrame::Body, ForceFrame::World] {
            let law = ConstantForce::new("", BodyId(0), push(frame, 0.0));
            assert_eq!(law.potential(&Snapshot::new(0.0, &states().map(|state| (&state).into()))), None);
            let push_at = |height: f64, angle: f64| {
                let mut states = states();
                states[0].position.y = height;
                states[0].angle = angle;
                wrenches(&law, &states)[0]
            };
            const STEP: f64 = 1e-3;
            let up = STEP * (push_at(0.0, STEP).force.y - push_at(0.0, 0.0).force.y);
            let turn = STEP * (push_at(0.0, 0.0).torque - push_at(STEP, 0.0).torque);
            assert!((up + turn).abs() > STEP * STEP, "{frame:?}: {up} {turn}");
        }
    }
}
