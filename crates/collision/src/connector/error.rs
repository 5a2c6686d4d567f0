//! Why a connector or a rail could not be built.

use halfgap_geometry::{ArcError, LineError};

/// Why a connector could not be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConnectorError {
    /// Both ends are on one body.
    #[error("a connector needs two different bodies")]
    SameBody,
    /// A coordinate, or the arc length of a stop, is infinite or not a number.
    #[error("the numbers of a connector must be finite")]
    NotFinite,
    /// The length of a rod or rope is out of range.
    #[error("the length of a rod or rope must be positive and finite, got {0} m")]
    BadLength(f64),
    /// The direction of a slot has no direction.
    #[error("the normal of a slot must be a direction, finite and not 0, got ({0}, {1})")]
    BadNormal(f64, f64),
    /// The elasticity is out of range.
    #[error("elasticity must lie between 0 and 1, got {0}")]
    BadElasticity(f64),
    /// A stop lies where the rail is not.
    #[error("a stop must lie on its rail, between 0 and {length} m, got {at} m")]
    BadStop {
        /// Arc length at which it was to be [m].
        at: f64,
        /// Length of the rail [m].
        length: f64,
    },
}

/// Why the path of a rail could not be built. Edges and points are counted from 0.
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
        /// What is wrong with it.
        source: LineError,
    },
    /// An arc cannot be built.
    #[error("edge {edge} of the rail: {source}")]
    Arc {
        /// Index of the edge.
        edge: usize,
        /// What is wrong with it.
        source: ArcError,
    },
    /// There are not enough points for a spline.
    #[error("the spline of a rail needs at least {least} different points, got {got}")]
    TooFewPoints {
        /// How many it needs.
        least: usize,
        /// How many there are.
        got: usize,
    },
    /// Two points that follow each other coincide.
    #[error("point {0} of the rail coincides with the point before it")]
    CoincidentPoints(usize),
    /// The spline turns back sharply.
    #[error("the spline of the rail has a cusp between its points {0} and the next")]
    Cusp(usize),
}
