//! Connectors as they are at the start: those that were added, and behind them what acts on their free coordinates.

use super::{WorldBuilder, centered};
use crate::connector::ConnectorSpec;
use crate::world::{Named, name_among};
use crate::world_error::{ConnectorName, WorldError};
use halfgap_collision::{BodyId, BodyState, Connector, ConnectorId};

/// All connectors of a world.
#[derive(Clone, Debug, Default)]
pub(crate) struct Joints {
    /// The connectors that were added, in their order, and then their parts.
    all: Vec<Connector>,
    parts: Parts,
}

/// What the connectors of a system do not tell by themselves.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Parts {
    /// For each part the connector on whose free coordinate it acts.
    of: Vec<ConnectorId>,
    /// Names of the connectors that were added, of those that have one.
    names: Vec<Option<String>>,
    /// Time of the start [s].
    start: f64,
}

impl Joints {
    /// Connectors of a system, with their parts behind them.
    #[cfg(feature = "save")]
    pub(crate) fn restored(all: Vec<Connector>, parts: Parts) -> Self {
        Self { all, parts }
    }

    /// What is saved beside the connectors of the system.
    #[cfg(feature = "save")]
    pub(crate) fn saved_parts(&self) -> Parts {
        self.parts.clone()
    }

    /// Replaces a connector, for tests.
    #[cfg(test)]
    pub(crate) fn replace(&mut self, index: usize, connector: Connector) {
        self.all[index] = connector;
    }

    /// The connectors that were added, in their order.
    pub(crate) fn added(&self) -> &[Connector] {
        &self.all[..self.all.len() - self.parts.of.len()]
    }

    /// Time of the start [s].
    pub(crate) fn start(&self) -> f64 {
        self.parts.start
    }

    /// The connectors that were added, and their parts.
    pub(crate) fn all(&self) -> &[Connector] {
        &self.all
    }

    /// The connector that was added of which another is a part; itself, if it is none.
    pub(crate) fn whole(&self, id: ConnectorId) -> ConnectorId {
        let first = self.all.len() - self.parts.of.len();
        id.index().checked_sub(first).and_then(|place| self.parts.of.get(place)).copied().unwrap_or(id)
    }

    /// Name of a connector in messages: that of a part is the part's kind, and the number and the name of what it is a part of.
    pub(crate) fn name(&self, id: ConnectorId, bodies: &[Named]) -> ConnectorName {
        let whole = self.whole(id).index();
        let own = self.parts.names.get(whole).and_then(Option::as_deref);
        let name_of = |body: BodyId| (!body.is_world()).then(|| name_among(bodies, body));
        ConnectorName::new((whole, own), &self.all[id.index()], name_of)
    }

    /// The ids of a connector that was added and of its parts.
    pub(crate) fn parts(&self, id: ConnectorId) -> impl Iterator<Item = ConnectorId> + '_ {
        let all = (0..).map(ConnectorId).take(self.all.len());
        all.filter(move |&part| self.whole(part) == id)
    }
}

impl WorldBuilder {
    /// Lists the connectors with their parts as they are at the start.
    pub(super) fn joints(&self) -> Result<Joints, WorldError> {
        let (mut added, mut parts, mut part_of) = (Vec::new(), Vec::new(), Vec::new());
        for (index, spec) in self.connectors.iter().enumerate() {
            let bad = |source| WorldError::BadConnector { connector: self.connector_name(index), source };
            added.push(self.begun(spec.connector.clone()));
            for part in spec.parts().map_err(bad)? {
                parts.push(self.begun(part));
                part_of.push(ConnectorId(u32::try_from(index).unwrap_or(u32::MAX)));
            }
        }
        added.append(&mut parts);
        let names = self.connectors.iter().map(|spec| spec.name.clone()).collect();
        Ok(Joints { all: added, parts: Parts { of: part_of, names, start: self.settings.start_time } })
    }

    /// A connector that keeps what its bodies have at the start.
    fn begun(&self, mut connector: Connector) -> Connector {
        let [a, b] = connector.bodies();
        let carrier = connector.third().map_or(BodyId::WORLD, |(body, _)| body);
        let still = BodyState::default();
        let state = |body: BodyId| self.bodies.get(body.index()).map_or(&still, |body| &body.state);
        let reaches = [a, b].into_iter().filter_map(|body| {
            self.bodies
                .get(body.index())
                .filter(|body| body.inertia.is_some())
                .map(|body| centered(body).reach())
        });
        let lever = reaches.reduce(f64::max).unwrap_or(1.0);
        connector.begin_from([state(a), state(b), state(carrier)], lever, self.settings.start_time);
        connector
    }

    /// Adds the force laws of springs on free coordinates.
    pub(super) fn add_springs(&mut self) {
        let named =
            |(index, spec): (usize, &ConnectorSpec)| spec.springs(&format!("spring of connector {index}"));
        let springs: Vec<_> = self.connectors.iter().enumerate().flat_map(named).collect();
        self.forces.extend(springs);
    }
}
