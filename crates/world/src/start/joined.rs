//! Errors of the connectors at the start, and their rows.

use super::moving;
use crate::builder::Joints;
use crate::world::Named;
use crate::world_error::{ConnectorName, WorldError};
use halfgap_advance::rigid::BodyPart;
use halfgap_collision::{BodyId, Connector, ConnectorId, ConnectorSample, Moving, Surroundings};

/// A connector and its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConnectorOff {
    index: usize,
    /// Error [m], 0 or more.
    pub(super) error: f64,
}

impl ConnectorOff {
    pub(super) fn name(&self, named: &[Named], connectors: &Joints) -> ConnectorName {
        name_of(self.index, named, connectors)
    }
}

/// Returns the name of a connector in messages.
pub(super) fn name_of(index: usize, named: &[Named], connectors: &Joints) -> ConnectorName {
    connectors.name(ConnectorId(u32::try_from(index).unwrap_or(u32::MAX)), named)
}

/// Refuses the first connector whose error is larger than allowed [m].
pub(super) fn require_small_errors(
    bodies: &[BodyPart],
    named: &[Named],
    connectors: &Joints,
    allowed: f64,
) -> Result<(), WorldError> {
    for (index, connector) in connectors.all().iter().enumerate() {
        let error = error_of(bodies, connector, connectors.start());
        if error > allowed || error.is_nan() {
            let connector = name_of(index, named, connectors);
            return Err(WorldError::ConnectorError { connector, error, allowed });
        }
    }
    Ok(())
}

/// Returns the connector with the largest error.
pub(super) fn worst_connector(bodies: &[BodyPart], connectors: &Joints) -> Option<ConnectorOff> {
    let off = connectors.all().iter().enumerate();
    let off = off.map(|(index, connector)| ConnectorOff {
        index,
        error: error_of(bodies, connector, connectors.start()),
    });
    off.max_by(|p, q| p.error.total_cmp(&q.error))
}

fn error_of(bodies: &[BodyPart], connector: &Connector, time: f64) -> f64 {
    let [a, b] = connector.bodies().map(|body| moving(bodies, body));
    let carrier = carrier_of(bodies, connector);
    connector.error_in([&a, &b], &Surroundings { time, carrier: &carrier, ..Surroundings::default() })
}

/// Every row of every connector that ties or is carried by a movable body, with the connector's index, but of those that only pull.
pub(super) fn rows<'a>(
    bodies: &'a [BodyPart],
    connectors: &'a Joints,
) -> impl Iterator<Item = (usize, &'a Connector, ConnectorSample)> {
    let is_fixed = |body: BodyId| body.is_world() || bodies[body.index()].body.is_fixed();
    let movable = connectors
        .all()
        .iter()
        .enumerate()
        .filter(move |(_, one)| !one.is_pull() && !one.all_bodies().all(is_fixed));
    let time = connectors.start();
    movable.flat_map(move |(index, connector)| {
        let [a, b] = connector.bodies().map(|body| moving(bodies, body));
        let carrier = carrier_of(bodies, connector);
        (0..connector.row_count()).map(move |row| {
            let surroundings = Surroundings { time, carrier: &carrier, ..Surroundings::default() };
            (index, connector, connector.measure_in(row, [&a, &b], &surroundings))
        })
    })
}

/// The motion of the third body of a connector, if it has one.
fn carrier_of(bodies: &[BodyPart], connector: &Connector) -> Moving {
    connector.third().map_or(Moving::BACKGROUND, |(body, _)| moving(bodies, body))
}
