//! Errors of building a world, which name bodies and connectors.

use crate::connector::{KindName, kind_name};
use crate::run_error::RunError;
use crate::world::BACKGROUND;
use halfgap_collision::{BodyId, Connector, ConnectorError};
use halfgap_geometry::Rounded;

/// Error that keeps a world from being built.
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
        /// Name of the quantity.
        quantity: &'static str,
        /// Rule that its value breaks.
        rule: &'static str,
        /// The value, in SI units.
        value: f64,
    },
    /// A body has friction where contacts carry impulses only, or where their errors are not projected.
    #[error(
        "body \"{body}\": friction needs contacts that carry forces and are projected: leave `contacts` and `stabilization` as they are, or \
         advance by steps"
    )]
    FrictionWithoutForces {
        /// Name of the body.
        body: String,
    },
    /// A coordinate or a velocity is so large that its powers overflow, or a coordinate so large that its rounding
    /// hides the smallest body.
    #[error("body \"{body}\": {quantity} must be at most {largest:e} in size, got {value:e}")]
    TooLarge {
        /// Name of the body.
        body: String,
        /// Name of the quantity.
        quantity: &'static str,
        /// Largest size allowed, in SI units.
        largest: f64,
        /// The value, in SI units.
        value: f64,
    },
    /// A setting is out of range.
    #[error("{setting} must be {rule}, got {value}")]
    BadSetting {
        /// Name of the setting.
        setting: &'static str,
        /// Rule that its value breaks.
        rule: &'static str,
        /// The value, in SI units.
        value: f64,
    },
    /// A duration is so short that the speed that crosses the scene in it is no number to compute with.
    #[error("duration must be at least {} s, got {} s", Rounded(*least), Rounded(*duration))]
    ShortDuration {
        /// The duration [s].
        duration: f64,
        /// Least duration allowed [s].
        least: f64,
    },
    /// An accuracy reaches down to gaps that are not positive.
    #[error("accuracy must be less than the target gap of {} m, got {accuracy} m", Rounded(*target_gap))]
    WideAccuracy {
        /// The accuracy [m].
        accuracy: f64,
        /// The target gap, given or from the tolerance [m].
        target_gap: f64,
    },
    /// A given threshold is smaller than the rounding of the movable bodies' coordinates allows.
    #[error(
        "{setting} must be at least {} m for coordinates of {} m, got {value:e} m",
        Rounded(*least),
        Rounded(*coordinate)
    )]
    LostInRounding {
        /// Name of the setting.
        setting: &'static str,
        /// The value [m].
        value: f64,
        /// Smallest value allowed [m].
        least: f64,
        /// Size of the largest coordinate of a movable body [m].
        coordinate: f64,
    },
    /// A force law, a connector or a pair of `let_pass` names a body that was not added.
    #[error("{what} names body {body}, but there are {bodies} bodies")]
    NoSuchBody {
        /// The law, connector or call that names the body.
        what: String,
        /// Index of the body.
        body: u32,
        /// Number of bodies.
        bodies: usize,
    },
    /// A number of a connector is out of range.
    #[error("{connector}: {source}")]
    BadConnector {
        /// The connector.
        connector: ConnectorName,
        /// Error of the connector.
        source: ConnectorError,
    },
    /// A connector is off at the start by more than is allowed.
    #[error(
        "{connector} is off by {} m at the start; at most {} m are allowed",
        Rounded(*error),
        Rounded(*allowed)
    )]
    ConnectorError {
        /// The connector.
        connector: ConnectorName,
        /// Error of the connector [m].
        error: f64,
        /// Largest error allowed [m].
        allowed: f64,
    },
    /// A coordinate of a connector is too large to compute with.
    #[error("{connector}: coordinates must be at most {largest:e} m in size, got {value:e} m")]
    FarConnector {
        /// The connector.
        connector: ConnectorName,
        /// Largest size of a coordinate allowed [m].
        largest: f64,
        /// Size of the largest coordinate [m].
        value: f64,
    },
    /// Two stops lie at one place of a closed rail, one for each direction: every point of the rail is beyond one of
    /// them.
    #[error(
        "{} and {} lie back to back on a closed path; use an open path with a stop at each end",
        stops[0],
        stops[1]
    )]
    StopsBackToBack {
        /// The stops.
        stops: Box<[ConnectorName; 2]>,
    },
    /// Connectors cannot all be put together at the start.
    #[error("{connector} cannot be put together at the start: an error of {} m remains", Rounded(*error))]
    CannotConnect {
        /// The connector with the largest error.
        connector: ConnectorName,
        /// Error that remains [m].
        error: f64,
    },
    /// Two connectors contradict each other, whatever the bodies do.
    #[error("{} and {} contradict each other: no motion satisfies both", connectors[0], connectors[1])]
    Contradiction {
        /// The connectors.
        connectors: Box<[ConnectorName; 2]>,
    },
    /// Velocities at the start cannot be made to fit the connectors.
    #[error(
        "{connector} comes apart at {} m/s at the start, and no velocities fit all connectors{}",
        Rounded(*rate),
        against.as_ref().map_or_else(String::new, |other| format!("; without {other} some would"))
    )]
    ConnectorComesApart {
        /// The connector that comes apart fastest.
        connector: ConnectorName,
        /// Another without which velocities would fit, if there is one.
        against: Option<Box<ConnectorName>>,
        /// Speed at which it comes apart [m/s].
        rate: f64,
    },
    /// A force law is not finite at the start.
    #[error("force \"{law}\" on body \"{body}\" is not finite at the start")]
    BadForce {
        /// Name of the law.
        law: String,
        /// Name of the body.
        body: String,
    },
    /// A force law accelerates a body, by its force and torque together, so much that the squares of its speeds overflow.
    #[error("force \"{law}\" accelerates body \"{body}\" by more than {largest:e} m/s^2 at the start")]
    StrongForce {
        /// Name of the law.
        law: String,
        /// Name of the body.
        body: String,
        /// Largest acceleration allowed [m/s²].
        largest: f64,
    },
    /// A force law acts at the start on a body that [`ForceLaw::bodies`](crate::force::ForceLaw::bodies) does not list:
    /// its force would be ignored.
    #[error("force \"{law}\" acts on body \"{body}\", which is not among the bodies that it names")]
    UnnamedBody {
        /// Name of the law.
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
        /// Depth of the overlap [m].
        depth: f64,
        /// Largest depth allowed [m].
        allowed: f64,
    },
    /// Gaps at the start cannot all be lifted to the target gap.
    #[error(
        "bodies \"{first}\" and \"{second}\" cannot be moved apart at the start: a gap of {} m remains between them",
        Rounded(*gap)
    )]
    CannotLift {
        /// Name of one body.
        first: String,
        /// Name of the other body.
        second: String,
        /// The gap that remains [m], negative for an overlap.
        gap: f64,
    },
    /// The forces at the start cannot be found.
    #[error("at the start: {source}")]
    Start {
        /// Error of the advance.
        source: RunError,
    },
}

/// Name of a connector in messages.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ConnectorName {
    /// Index among the connectors, from 0.
    pub index: usize,
    /// Kind, as in scene files.
    #[cfg_attr(feature = "save", serde(with = "crate::saving::kind"))]
    pub kind: KindName,
    /// Its own name, if it has one.
    pub name: Option<Box<str>>,
    /// Name of body a.
    pub first: String,
    /// Name of body b.
    pub second: String,
}

impl ConnectorName {
    /// Makes the name of a connector; `name_of` returns the name of a body, and `None` for the background.
    pub(crate) fn new<'a>(
        (index, name): (usize, Option<&str>),
        connector: &Connector,
        name_of: impl Fn(BodyId) -> Option<&'a str>,
    ) -> Self {
        let [first, second] = connector.bodies().map(|body| name_of(body).unwrap_or(BACKGROUND).to_owned());
        Self { index, kind: kind_name(&connector.kind), name: name.map(Box::from), first, second }
    }
}

impl std::fmt::Display for ConnectorName {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { index, kind, name, first, second } = self;
        match name {
            Some(name) => write!(formatter, "connector \"{name}\" ({kind} of \"{first}\" and \"{second}\")"),
            None => write!(formatter, "connector {index} ({kind} of \"{first}\" and \"{second}\")"),
        }
    }
}
