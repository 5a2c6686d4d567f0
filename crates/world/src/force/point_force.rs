//! A push on a point of a body.

use super::{ForceFrame, ForceLaw, Snapshot, Wrenches};
use glam::DVec2;
use halfgap_collision::BodyId;

/// A force on a point of a body, which moves with the body, and a torque.
///
/// Unlike that of a [`ConstantForce`](super::ConstantForce) in the world's frame, the point is one of the body. A force whose direction
/// stays fixed in the world has the potential -(force . point + torque angle) [J]; one that turns with the body has none.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct PointForce {
    name: String,
    body: [BodyId; 1],
    push: PointPush,
}

/// Force, its point and torque of a [`PointForce`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct PointPush {
    /// Point at which the force acts, in body coordinates about the centre of mass [m].
    pub point: DVec2,
    /// Force, in coordinates of `frame` [N].
    pub force: DVec2,
    /// Frame of the force.
    pub frame: ForceFrame,
    /// Torque [N m], counter-clockwise positive.
    pub torque: f64,
}

impl PointForce {
    /// Makes the law for one body, with a name for messages and the ledger.
    #[must_use]
    pub fn new(name: impl Into<String>, body: BodyId, push: PointPush) -> Self {
        Self { name: name.into(), body: [body], push }
    }
}

impl ForceLaw for PointForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        let [body] = self.body;
        let pose = now.body(body).pose;
        let PointPush { point, force, frame, torque } = self.push;
        let force = match frame {
            ForceFrame::Body => pose.vector_to_world(force),
            ForceFrame::World => force,
        };
        wrenches.add_force(body, force, pose.vector_to_world(point));
        wrenches.add_torque(body, torque);
    }

    fn potential(&self, now: &Snapshot<'_>) -> Option<f64> {
        let moving = now.body(self.body[0]);
        let PointPush { point, force, frame, torque } = self.push;
        let at = moving.pose.point_to_world(point);
        (frame == ForceFrame::World).then(|| -force.dot(at) - torque * moving.angle)
    }
}

#[cfg(test)]
mod tests {
    use super::super::law_check::{assert_gradient, states, wrenches};
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn law(frame: ForceFrame) -> PointForce {
        let push =
            PointPush { point: DVec2::new(0.3, -0.7), force: DVec2::new(2.0, 1.0), frame, torque: 0.4 };
        PointForce::new("push", BodyId(0), push)
    }

    #[test]
    fn fixed_in_the_world_it_is_minus_the_gradient_of_its_potential() {
        assert_gradient(&law(ForceFrame::World), &states());
    }

    #[test]
    fn the_point_turns_with_the_body_and_the_force_as_said() {
        let mut states = states();
        states[0].angle = FRAC_PI_2;
        for (frame, force) in
            [(ForceFrame::World, DVec2::new(2.0, 1.0)), (ForceFrame::Body, DVec2::new(-1.0, 2.0))]
        {
            let pushed = wrenches(&law(frame), &states)[0];
            assert!((pushed.force - force).length() < 1e-15, "{frame:?}: {}", pushed.force);
            let torque = 0.4 + DVec2::new(0.7, 0.3).perp_dot(force);
            assert!((pushed.torque - torque).abs() < 1e-15, "{frame:?}: {}", pushed.torque);
        }
        let moving = states.map(|state| (&state).into());
        assert_eq!(law(ForceFrame::Body).potential(&Snapshot::new(0.0, &moving)), None);
    }
}
