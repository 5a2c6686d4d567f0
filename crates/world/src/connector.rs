//! Connectors to be added to a world, and their names in messages.

use halfgap_collision::{Connector, ConnectorKind};

/// A connector to be added to a world.
#[derive(Clone, Debug, PartialEq)]
pub struct ConnectorSpec {
    /// The connector.
    pub connector: Connector,
    /// Whether the bodies collide with each other even if a pin, slot, weld or slider joins them.
    pub collide: bool,
    /// Whether body b, or body a if b is missing or fixed, is moved to satisfy the connector before the start.
    pub align: bool,
}

impl ConnectorSpec {
    /// Makes a connector with the defaults: bodies joined by a pin, slot, weld or slider do not collide, and none is aligned.
    #[must_use]
    pub fn new(connector: Connector) -> Self {
        Self { connector, collide: false, align: false }
    }

    /// True if the connector keeps its bodies from colliding: a pin, slot, weld or slider without `collide`.
    pub(crate) fn keeps_from_colliding(&self) -> bool {
        let joins = matches!(
            self.connector.kind,
            ConnectorKind::Pin { .. }
                | ConnectorKind::Slot { .. }
                | ConnectorKind::Weld { .. }
                | ConnectorKind::Slider { .. }
        );
        joins && !self.collide
    }
}

/// Name of a kind of connector in messages and scene files, one of [`KIND_NAMES`].
pub(crate) type KindName = &'static str;

/// Names of all kinds of connectors.
pub(crate) const KIND_NAMES: [KindName; 14] = [
    "pin",
    "slot",
    "rod",
    "rope",
    "rail",
    "rail_stop",
    "weld",
    "slider",
    "gear",
    "rack",
    "pulley",
    "limit",
    "drive",
    "motor",
];

/// Returns the name of a kind of connector.
pub(crate) fn kind_name(kind: &ConnectorKind) -> KindName {
    let [pin, slot, rod, rope, rail, rail_stop, weld, slider, gear, rack, pulley, limit, drive, motor] =
        KIND_NAMES;
    match kind {
        ConnectorKind::Pin { .. } => pin,
        ConnectorKind::Slot { .. } => slot,
        ConnectorKind::Rod { .. } => rod,
        ConnectorKind::Rope { .. } => rope,
        ConnectorKind::Rail { .. } => rail,
        ConnectorKind::RailStop { .. } => rail_stop,
        ConnectorKind::Weld { .. } => weld,
        ConnectorKind::Slider { .. } => slider,
        ConnectorKind::Gear { .. } => gear,
        ConnectorKind::Rack { .. } => rack,
        ConnectorKind::Pulley { .. } => pulley,
        ConnectorKind::Limit { .. } => limit,
        ConnectorKind::Drive { .. } => drive,
        ConnectorKind::Pull { .. } => motor,
    }
}
