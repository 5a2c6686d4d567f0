//! Motors and dry friction in joints: each pulls the rate of a coordinate towards a speed, with a force that is bounded by a constant.
//!
//! Below or above its speed it acts with all its force; at the speed it holds the coordinate with what that takes, by a row, until that
//! were too much.

use crate::rigid::contacts::rows::{ActiveRow, Mechanism, RowMoment};
use glam::DVec2;
use halfgap_collision::{BodyId, ConnectorId, GapKinematics, Moving};

/// A motor, or dry friction in a joint, that acts with a given force: all that it has, or its share of what holds.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Pull {
    pub(crate) id: ConnectorId,
    pub(crate) bodies: [BodyId; 2],
    /// Force [N] along its row, against the side to which the rate is off.
    pub(crate) force: f64,
    /// Rate [m/s] that the event has left, by rounding, where it sets out from its speed; `None` for one that holds what others hold,
    /// too, by the share of the force that the event gave it.
    pub(crate) left: Option<f64>,
}

impl Mechanism<'_> {
    /// Rate beyond its speed, and Jacobian, of the coordinate of a motor or of dry friction in a joint.
    pub(crate) fn pull_kinematics(&self, id: ConnectorId, movings: [&Moving; 2]) -> GapKinematics {
        self.measure_connector((id, 0), movings, None, None).kinematics
    }

    /// The row of a coordinate that is held. One that is held at a speed has no place to return to.
    pub(super) fn measure_held(&self, row: &ActiveRow, id: ConnectorId, movings: [&Moving; 2]) -> RowMoment {
        let sample = self.measure_connector((id, 0), movings, None, None);
        let stands = self.connectors[id.index()].prescribed_rate(self.time) == 0.0;
        RowMoment { gap: if stands { sample.gap } else { row.gap }, kinematics: sample.kinematics }
    }

    /// Point [m] at which a motor or dry friction in a joint acts on its primary body, the normal, and the coefficient [m] of the body's
    /// rotation.
    pub(crate) fn locate_pull(&self, id: ConnectorId, sides: [&Moving; 2]) -> (DVec2, DVec2, f64) {
        let sample = self.measure_connector((id, 0), sides, None, None);
        (sample.point_a, sample.normal, sample.kinematics.jacobian[2])
    }
}
