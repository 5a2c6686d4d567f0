//! Connectors as a world is built from them.

use halfgap_collision::{Connector, ConnectorKind};

/// A connector to be added to a world.
#[derive(Clone, Debug, PartialEq)]
pub struct ConnectorSpec {
    /// The connector.
    pub connector: Connector,
    /// The bodies collide with each other although a pin or slot joins them.
    pub collide: bool,
    /// Body b (else a) is moved to satisfy the connector before the start.
    pub align: bool,
}

impl ConnectorSpec {
    /// A connector whose bodies collide as their kind has it, and stay where they are given.
    #[must_use]
    pub fn new(connector: Connector) -> Self {
        Self { connector, collide: false, align: false }
    }

    /// True if the bodies are not to collide with each other: those that a pin or slot joins, unless they are to.
    pub(crate) fn keeps_from_colliding(&self) -> bool {
        matches!(self.connector.kind, ConnectorKind::Pin { .. } | ConnectorKind::Slot { .. }) && !self.collide
    }
}

/// The word for a kind of connector in messages.
pub(crate) fn kind_name(kind: &ConnectorKind) -> &'static str {
    match kind {
        ConnectorKind::Pin { .. } => "pin",
        ConnectorKind::Slot { .. } => "slot",
        ConnectorKind::Rod { .. } => "rod",
        ConnectorKind::Rope { .. } => "rope",
        ConnectorKind::Rail { .. } => "rail",
        ConnectorKind::RailStop { .. } => "rail_stop",
    }
}
