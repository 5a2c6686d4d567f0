//! Errors of building a connector or a rail.

use halfgap_geometry::RoundedPlace;
use halfgap_geometry::{ArcError, LineError};

/// Reason why a connector could not be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConnectorError {
    /// Both ends are on one body.
    #[error("a connector needs two different bodies")]
    SameBody,
    /// A coordinate is infinite or not a number.
    #[error("the numbers of a connector must be finite")]
    NotFinite,
    /// The length of a rod or rope is out of range.
    #[error("the length of a rod or rope must be positive and finite, got {0} m")]
    BadLength(f64),
    /// The normal of a slot is zero or not finite or, in [`Connector::check`](super::Connector::check), no unit vector.
    #[error("the normal of a slot must be a direction, finite and not 0, got ({0}, {1})")]
    BadNormal(f64, f64),
    /// The axis of a slider or rack is zero or not finite or, in [`Connector::check`](super::Connector::check), no unit vector.
    #[error("the axis must be a direction, finite and not 0, got ({0}, {1})")]
    BadAxis(f64, f64),
    /// The ratio of a gear or pulley is out of range.
    #[error("the ratio of a gear must be finite and not 0, that of a pulley positive, got {0}")]
    BadRatio(f64),
    /// The radius of a rack's wheel is out of range.
    #[error("the radius of a rack's wheel must be finite and not 0, got {0} m")]
    BadRadius(f64),
    /// The largest force of a motor or of dry friction is out of range.
    #[error(
        "the largest force or torque must be finite and not negative, got {0}: what holds whatever it takes is a drive"
    )]
    BadPull(f64),
    /// Something is to act on the free coordinate of a connector that has none.
    #[error(
        "only a pin, a slot and a slider have a free coordinate on which a motor, friction, limits, a drive or a spring can act"
    )]
    NoCoordinate,
    /// The lower bound of a coordinate is above the upper one.
    #[error("the lower limit must not be above the upper one, got {lower} and {upper}")]
    CrossedLimits {
        /// Lower bound [rad or m].
        lower: f64,
        /// Upper bound [rad or m].
        upper: f64,
    },
    /// The elasticity is not between 0 and 1.
    #[error("elasticity must lie between 0 and 1, got {0}")]
    BadElasticity(f64),
    /// A stop does not lie on its rail.
    #[error("a stop must lie on its rail, between 0 and {} m, got {at} m", RoundedPlace(*length))]
    BadStop {
        /// Given arc length of the stop [m].
        at: f64,
        /// Length of the rail [m].
        length: f64,
    },
}

/// Reason why the path of a rail could not be built. Edges and points are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RailError {
    /// A path without edges.
    #[error("a rail needs at least one edge")]
    NoEdges,
    /// A coordinate is infinite or not a number.
    #[error("the coordinates of a rail must be finite")]
    NotFinite,
    /// A straight edge cannot be built.
    #[error("edge {edge} of the rail: {source}")]
    Line {
        /// Index of the edge.
        edge: usize,
        /// Reason why the line could not be built.
        source: LineError,
    },
    /// An arc cannot be built.
    #[error("edge {edge} of the rail: {source}")]
    Arc {
        /// Index of the edge.
        edge: usize,
        /// Reason why the arc could not be built.
        source: ArcError,
    },
    /// An edge, of the given index, sets out straight back along the edge before it.
    #[error(
        "edge {0} of the rail turns straight back where it begins; no point can follow a rail through a cusp"
    )]
    TurnsBack(usize),
    /// There are not enough points for a spline.
    #[error("the spline of a rail needs at least {least} different points, got {got}")]
    TooFewPoints {
        /// Number of different points that the spline needs.
        least: usize,
        /// Number of different points given.
        got: usize,
    },
    /// A point, of the given index, coincides with the point before it.
    #[error("point {0} of the rail coincides with the point before it")]
    CoincidentPoints(usize),
    /// The spline turns back sharply in the piece after the point of the given index.
    #[error("the spline of the rail has a cusp between its points {0} and the next")]
    Cusp(usize),
}
