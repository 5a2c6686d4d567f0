//! Connectors: what is remembered of them from one step to the next, and their rows.

use crate::stepping::apart::{Apart, Third};
use crate::stepping::bodies::Bodies;
use crate::stepping::rows::{Lengths, Line, Row, Rows, Slip, Source};
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

    /// Measures a direction of a connector at a time [s].
    pub(super) fn measure(
        &self,
        bodies: &Bodies,
        (index, direction): (usize, usize),
        time: f64,
    ) -> ConnectorSample {
        let connector = &self.all[index];
        let [a, b] = connector.bodies().map(|body| bodies.moving(body));
        let carrier = connector.third().map_or(Moving::BACKGROUND, |(body, _)| bodies.moving(body));
        let hint = self.memory[index].hint.as_ref();
        let surroundings = Surroundings { time, carrier: &carrier, hint, ..Surroundings::default() };
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
        for (index, connector) in self.all.iter().enumerate() {
            // Bodies that are tied sleep together.
            if connector.all_bodies().all(|body| bodies.is_fixed(body) || is_asleep(body.index())) {
                continue;
            }
            for direction in 0..connector.row_count() {
                rows.push(self.row(bodies, (index, direction), lengths));
            }
        }
    }

    /// The row of a direction of a connector.
    fn row(&self, bodies: &Bodies, (index, direction): (usize, usize), lengths: Lengths) -> Row {
        let Lengths { span, time, slack, .. } = lengths;
        let (connector, tie) = (&self.all[index], &self.memory[index]);
        let sample = self.measure(bodies, (index, direction), time);
        let (is_bilateral, pulls) = (connector.is_bilateral(), connector.is_pull());
        let (now, end) = (connector.prescribed(time), connector.prescribed(time + span));
        // A drive is to be where its law is at the end of the step; what pulls is to have its rate, from wherever it is.
        let offset = match pulls {
            true => now.rate,
            false if is_bilateral => (sample.gap + (end.value - now.value)) / span,
            false => sample.gap.max(0.0) / span,
        };
        let gamma = sample.kinematics.gamma;
        let offset = offset + 0.5 * span * (gamma - now.acceleration);
        let ids = connector.bodies();
        let inertia = ids.map(|body| bodies.inertia_in_step(body.index()));
        let mut normal = Line::new(sample.kinematics.jacobian, inertia, offset);
        let apart = apart(connector, sample.kinematics.jacobian, span);
        if let Some(apart) = &apart {
            let inverse_moment = |place| bodies.inertia_in_step(place as usize).inverse_moment;
            normal = normal.with_compliance(apart.compliance(&normal, inertia, inverse_moment));
        }
        normal.impulse = span * tie.forces[direction];
        let mut row = Row {
            places: ids.map(|body| if body.is_world() { bodies.count() as u32 } else { body.0 }),
            apart,
            is_bilateral,
            prescribed: (connector.is_driven() || pulls && now.rate != 0.0).then_some(now.rate),
            presses: tie.presses,
            touches: is_bilateral || pulls || tie.presses || sample.gap <= slack,
            roll: None,
            normal,
            slip: Slip::default(),
            // What pulls has no place to keep.
            gap: if pulls { f64::INFINITY } else { sample.gap },
            gamma,
            elasticity: connector.elasticity,
            strikes: tie.arrival,
            blows: [0.0; 2],
            arrives: None,
            point: sample.point_a,
            source: Source::Connector { connector: index as u32, direction: direction as u32 },
        };
        row.meet(sample.kinematics.rate);
        row
    }
}

/// What the row of a connector has beyond its line in a step of a length `span` [s].
fn apart(connector: &Connector, [x, y, _, u, v, _]: [f64; 6], span: f64) -> Option<Apart> {
    let third = connector.third().map(|(body, arm)| Third { place: body.0, arm });
    let is_apart = third.is_some() || connector.is_pull() || [u, v] != [-x, -y];
    is_apart.then(|| Apart { second: [u, v], third, most: span * connector.most_force() })
}
