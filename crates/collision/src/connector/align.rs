//! Translation of a body that satisfies a connector before the start.

use super::{Connector, ConnectorKind};
use crate::motion::Moving;
use glam::DVec2;
use halfgap_geometry::Pose;

/// Translation of one end of a connector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// True if body b is moved, false if body a is.
    pub moves_b: bool,
    /// Translation [m] of the body, in world coordinates.
    pub shift: DVec2,
}

impl Connector {
    /// Finds the least translation of body b, or of body a if b cannot be moved, that satisfies the connector; `None`
    /// if neither can be moved. `can_move` is true for the bodies a and b that may be moved.
    #[must_use]
    pub fn align(&self, a: &Pose, b: &Pose, can_move: [bool; 2]) -> Option<Alignment> {
        let moves_b = can_move[1] && self.anchors()[1].is_some();
        if !(moves_b || can_move[0]) {
            return None;
        }
        let [a, b] = [a, b].map(|&pose| Moving { pose, ..Moving::BACKGROUND });
        let shift_of_a = self.shift_of_a(&a, &b);
        Some(Alignment { moves_b, shift: if moves_b { -shift_of_a } else { shift_of_a } })
    }

    fn shift_of_a(&self, a: &Moving, b: &Moving) -> DVec2 {
        let row = self.measure(0, a, b);
        match &self.kind {
            ConnectorKind::Pin { .. } | ConnectorKind::Weld { .. } => row.point_b - row.point_a,
            // Both points stay on a line along the normal, so the translation is the gap.
            ConnectorKind::Slot { .. } | ConnectorKind::Rod { .. } | ConnectorKind::Slider { .. } => {
                row.normal * -row.gap
            }
            ConnectorKind::Rope { .. } | ConnectorKind::Pulley { .. } => row.normal * (-row.gap).max(0.0),
            // What keeps angles, or acts along a coordinate, begins where the bodies are.
            ConnectorKind::Gear { .. }
            | ConnectorKind::Rack { .. }
            | ConnectorKind::Limit { .. }
            | ConnectorKind::Drive { .. }
            | ConnectorKind::Pull { .. } => DVec2::ZERO,
            ConnectorKind::Rail { .. } => row.point_b - row.point_a,
            ConnectorKind::RailStop { path, at, .. } => {
                if row.gap < 0.0 {
                    path.place_at(*at).point() - row.point_b
                } else {
                    DVec2::ZERO
                }
            }
        }
    }
}
