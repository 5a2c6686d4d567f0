//! Why a world could not be built.

use crate::connector::kind_name;
use crate::rounded::Rounded;
use crate::run_error::RunError;
use crate::world::BACKGROUND;
use halfgap_collision::{BodyId, Connector, ConnectorError};

/// Why a world could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WorldError {
    /// Two bodies have one name.
    #[error("there are two bodies named \"{name}\"")]
    DoubleName {
        /// The name.
        name: String,
    },
    /// A body has no name, or that of the background.
    #[error("a body cannot be named \"{name}\"")]
    BadName {
        /// The name.
        name: String,
    },
    /// A number is out of range.
    #[error("body \"{body}\": {quantity} must be {rule}, got {value}")]
    BadNumber {
        /// Name of the body.
        body: String,
        /// Which quantity.
        quantity: &'static str,
        /// What it must be.
        rule: &'static str,
        /// What it is.
        value: f64,
    },
    /// A coordinate or a velocity is so large that its powers are no numbers, or a coordinate so large that
    /// its rounding hides the smallest body.
    #[error("body \"{body}\": {quantity} must be at most {largest:e} in size, got {value:e}")]
    TooLarge {
        /// Name of the body.
        body: String,
        /// Which quantity.
        quantity: &'static str,
        /// How large it may be.
        largest: f64,
        /// What it is.
        value: f64,
    },
    /// A setting is out of range.
    #[error("{setting} must be {rule}, got {value}")]
    BadSetting {
        /// Which setting.
        setting: &'static str,
        /// What it must be.
        rule: &'static str,
        /// What it is.
        value: f64,
    },
    /// A distance that is given is less than rounding of the coordinates of what moves leaves.
    #[error(
        "{setting} must be at least {} m for coordinates of {} m, got {value:e} m",
        Rounded(*least),
        Rounded(*coordinate)
    )]
    LostInRounding {
        /// Which setting.
        setting: &'static str,
        /// What it is [m].
        value: f64,
        /// What it must be at least [m].
        least: f64,
        /// The largest coordinate [m].
        coordinate: f64,
    },
    /// A force law or a connector names a body that is not there.
    #[error("{what} names body {body}, but there are {bodies} bodies")]
    NoSuchBody {
        /// What names it.
        what: String,
        /// Index of the body.
        body: u32,
        /// How many bodies there are.
        bodies: usize,
    },
    /// A connector has numbers that none can have.
    #[error("{connector}: {source}")]
    BadConnector {
        /// Which connector.
        connector: ConnectorName,
        /// What is wrong with it.
        source: ConnectorError,
    },
    /// A connector is off at the start by more than is allowed.
    #[error("{connector} is off by {} m at the start; at most {} m are allowed", Rounded(*error), Rounded(*allowed))]
    ConnectorError {
        /// Which connector.
        connector: ConnectorName,
        /// How far [m].
        error: f64,
        /// How far would be allowed [m].
        allowed: f64,
    },
    /// A connector lies farther out than can be computed with.
    #[error("{connector}: coordinates must be at most {largest:e} m in size, got {value:e} m")]
    FarConnector {
        /// Which connector.
        connector: ConnectorName,
        /// How large they may be [m].
        largest: f64,
        /// The largest [m].
        value: f64,
    },
    /// Two stops lie at one place of a closed rail, one for each way: a point on it is beyond one of them.
    #[error("{} and {} lie back to back on a closed path: on one that is open there, its ends can be stopped", stops[0], stops[1])]
    StopsBackToBack {
        /// The stops.
        stops: Box<[ConnectorName; 2]>,
    },
    /// Connectors cannot all be put together at the start.
    #[error("{connector} cannot be put together at the start: {} m remain", Rounded(*error))]
    CannotConnect {
        /// The connector that is off most.
        connector: ConnectorName,
        /// How far [m].
        error: f64,
    },
    /// Velocities at the start cannot be made to fit the connectors.
    #[error("{connector} comes apart at {} m/s at the start, and cannot be kept from it", Rounded(*rate))]
    ConnectorComesApart {
        /// The connector that comes apart fastest.
        connector: ConnectorName,
        /// How fast [m/s].
        rate: f64,
    },
    /// A force law is not finite at the start.
    #[error("force \"{law}\" on body \"{body}\" is not finite at the start")]
    BadForce {
        /// What the law is called.
        law: String,
        /// Name of the body.
        body: String,
    },
    /// A force law acts at the start on a body that it does not name: that would be ignored.
    #[error("force \"{law}\" acts on body \"{body}\", which is not among the bodies that it names")]
    UnnamedBody {
        /// What the law is called.
        law: String,
        /// Name of the body.
        body: String,
    },
    /// Two bodies overlap at the start by more than is allowed.
    #[error(
        "bodies \"{first}\" and \"{second}\" overlap by {} m at the start; at most {} m are allowed",
        Rounded(*depth),
        Rounded(*allowed)
    )]
    Overlap {
        /// Name of one body.
        first: String,
        /// Name of the other body.
        second: String,
        /// How deep [m].
        depth: f64,
        /// How deep would be allowed [m].
        allowed: f64,
    },
    /// Gaps at the start cannot all be lifted to the target gap.
    #[error(
        "bodies \"{first}\" and \"{second}\" cannot be moved apart at the start: {} m remain between them",
        Rounded(*gap)
    )]
    CannotLift {
        /// Name of one body.
        first: String,
        /// Name of the other body.
        second: String,
        /// The gap [m].
        gap: f64,
    },
    /// The forces at the start cannot be found.
    #[error("at the start: {source}")]
    Start {
        /// Why not.
        source: RunError,
    },
}

/// A connector, as messages name it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConnectorName {
    /// Its index.
    pub index: usize,
    /// Its kind, as in scene files.
    pub kind: &'static str,
    /// Name of body a.
    pub first: String,
    /// Name of body b.
    pub second: String,
}

impl ConnectorName {
    /// The name of a connector, among bodies of which `name_of` tells the names; the background needs none.
    pub(crate) fn new<'a>(
        index: usize,
        connector: &Connector,
        name_of: impl Fn(BodyId) -> Option<&'a str>,
    ) -> Self {
        let [first, second] = connector.bodies().map(|body| name_of(body).unwrap_or(BACKGROUND).to_owned());
        Self { index, kind: kind_name(&connector.kind), first, second }
    }
}

impl std::fmt::Display for ConnectorName {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { index, kind, first, second } = self;
        write!(formatter, "connector {index} ({kind} of \"{first}\" and \"{second}\")")
    }
}
