//! Connectors: what is remembered of them from one step to the next, and their rows.

use crate::stepping::bodies::Bodies;
use crate::stepping::rows::{Lengths, Line, Row, Rows, Slip, Source};
use crate::stepping::third::Third;
use halfgap_collision::{Connector, ConnectorKind, ConnectorSample, Moving, RailHint, Surroundings};

/// What is remembered of a connector.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Tie {
    /// Forces [N] of the last step in all directions.
    pub(super) forces: [f64; 3],
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
        let carrier = connector.third().map_or(Moving::BACKGROUND, |(body, _)| bodies.moving(body));
        let hint = self.memory[index].hint.as_ref();
        let surroundings = Surroundings { carrier: &carrier, hint, ..Surroundings::default() };
        connector.measure_in(direction, [&a, &b], &surroundings)
    }

    /// Lists the rows of the connectors of bodies that are awake.
    pub(super) fn list(
        &self,
        bodies: &Bodies,
        is_asleep: impl Fn(usize) -> bool,
        lengths: Lengths,
        rows: &mut Rows,
    ) {
        let Lengths { span, slack, .. } = lengths;
        for (index, connector) in self.all.iter().enumerate() {
            let tie = &self.memory[index];
            let ids = connector.bodies();
            // Bodies that are tied sleep together.
            if connector.all_bodies().all(|body| bodies.is_fixed(body) || is_asleep(body.index())) {
                continue;
            }
            let inertia = ids.map(|body| bodies.inertia_in_step(body.index()));
            let third = connector.third().map(|(body, arm)| Third { place: body.0, arm });
            let square = third.map_or(0.0, |Third { place, arm }| {
                bodies.inertia_in_step(place as usize).inverse_moment * arm * arm
            });
            let is_bilateral = connector.is_bilateral();
            for direction in 0..connector.row_count() {
                let sample = self.measure(bodies, index, direction);
                let gap = if is_bilateral { sample.gap } else { sample.gap.max(0.0) };
                let offset = gap / span + 0.5 * span * sample.kinematics.gamma;
                let mut row = Row {
                    places: ids.map(|body| if body.is_world() { bodies.count() as u32 } else { body.0 }),
                    third,
                    is_bilateral,
                    presses: tie.presses,
                    touches: is_bilateral || tie.presses || sample.gap <= slack,
                    roll: None,
                    normal: Line::new(sample.kinematics.jacobian, inertia, offset).with_square(square),
                    slip: Slip::default(),
                    gap: sample.gap,
                    gamma: sample.kinematics.gamma,
                    elasticity: connector.elasticity,
                    strikes: tie.arrival,
                    blows: [0.0; 2],
                    arrives: None,
                    point: sample.point_a,
                    source: Source::Connector { connector: index as u32, direction: direction as u32 },
                };
                row.normal.impulse = span * tie.forces[direction];
                rows.push(row);
            }
        }
    }
}
