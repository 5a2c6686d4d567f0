//! Connectors, and what is remembered of them from one step to the next.

use crate::stepping::bodies::Bodies;
use halfgap_collision::{Connector, ConnectorKind, ConnectorSample, RailHint};

/// What is remembered of a connector.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Tie {
    /// Forces [N] of the last step in both directions.
    pub(super) forces: [f64; 2],
    /// It carried a force in the last step.
    pub(super) presses: bool,
    /// Callers know that it carries a force.
    pub(super) is_told: bool,
    /// Speed [m/s] at which a rope goes taut at the end of the step, or a stop is met, if that is an impact.
    pub(super) arrival: Option<f64>,
    /// Place of the point of a rail or a stop.
    pub(super) hint: Option<RailHint>,
}

/// All connectors.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Ties {
    pub(super) all: Vec<Connector>,
    pub(super) memory: Vec<Tie>,
}

impl Ties {
    pub(super) fn new(all: Vec<Connector>) -> Self {
        Self { memory: vec![Tie::default(); all.len()], all }
    }

    /// Notes where the points of rails and stops are now.
    pub(super) fn follow(&mut self, bodies: &Bodies) {
        for (connector, tie) in self.all.iter().zip(&mut self.memory) {
            let (ConnectorKind::Rail { a, path } | ConnectorKind::RailStop { a, path, .. }) = &connector.kind
            else {
                continue;
            };
            let point = bodies.moving(a.body).pose.point_to_world(a.point);
            tie.hint = Some(path.hint_near(point, tie.hint.as_ref()));
        }
    }

    /// Measures a direction of a connector.
    pub(super) fn measure(&self, bodies: &Bodies, index: usize, direction: usize) -> ConnectorSample {
        let connector = &self.all[index];
        let [a, b] = connector.bodies().map(|body| bodies.moving(body));
        connector.measure_near(direction, &a, &b, self.memory[index].hint.as_ref())
    }
}
