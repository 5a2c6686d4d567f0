//! Sides of pulleys on which nothing is left: beyond its wheel a rope has no direction.

use crate::rigid::contacts::rows::RowSource;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::stage::body_state;
use glam::DVec2;
use halfgap_collision::{BodyId, ConnectorId, Moving};
use halfgap_geometry::Pose;

impl Dynamics<'_> {
    /// A pulley of which nothing is left on the side of a body: that side is shorter than it may err at the start of the
    /// last step, or the body has gone past the wheel within the step, if that was accepted.
    pub(crate) fn ran_out(&self, is_accepted: bool) -> Option<(ConnectorId, BodyId)> {
        let zone = self.physics.mechanism.tolerances.accuracy;
        self.group.rows.iter().find_map(|row| {
            let RowSource::Connector(id, _) = row.source else { return None };
            let connector = &self.physics.mechanism.connectors[id.index()];
            connector.wheels()?;
            let sides = |state| {
                connector.sides([&self.pose_in(state, row.bodies[0]), &self.pose_in(state, row.bodies[1])])
            };
            let start = sides(&self.group.state)?;
            let end = if is_accepted { sides(&self.group.end_state)? } else { start };
            let is_gone = |(from, to): (&DVec2, &DVec2)| from.dot(*to) <= zone * zone;
            let side = start.iter().zip(&end).position(is_gone)?;
            Some((id, row.bodies[side]))
        })
    }

    /// Pose of a body of a row in a state of the group.
    fn pose_in(&self, state: &[f64], body: BodyId) -> Pose {
        let bodies = &self.group.bodies;
        match bodies.binary_search(&body) {
            Ok(place) => body_state(state, bodies.len(), place).pose(),
            Err(_) if body.is_world() => Moving::BACKGROUND.pose,
            Err(_) => self.physics.mechanism.trajectories[body.index()].unwound_at(self.start).pose(),
        }
    }
}
