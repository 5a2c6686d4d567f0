//! Errors of building an edge or a shape.

use crate::fit::FitError;
use crate::rounded::{Rounded, RoundedPlace};

/// Reason why a straight edge could not be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LineError {
    /// An end point is infinite or not a number, or the square of their distance is.
    #[error("end points, and the square of their distance, must be finite")]
    NotFinite,
    /// The end points coincide.
    #[error("end points coincide at ({}, {}) m", RoundedPlace(*.0), RoundedPlace(*.1))]
    ZeroLength(f64, f64),
}

/// Reason why an arc could not be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ArcError {
    /// A coordinate or the start angle is infinite or not a number, or the fit tolerance is not a number.
    #[error("arc center and end points must be finite, their tolerance a number")]
    NotFinite,
    /// The radius is not a positive, finite length.
    #[error("arc radius must be positive and finite, got {0} m")]
    BadRadius(f64),
    /// The sweep is empty or more than a full turn.
    #[error("arc sweep must be between 0 and a full turn in size, got {0} rad")]
    BadSweep(f64),
    /// The distances of the two ends from the center differ by more than the fit tolerance.
    #[error(
        "arc radius is {} m at its start but {} m at its end: off by {} m",
        RoundedPlace(*from_radius),
        RoundedPlace(*to_radius),
        Rounded(*off)
    )]
    RadiusMismatch {
        /// Distance [m] of the start from the center.
        from_radius: f64,
        /// Distance [m] of the end from the center.
        to_radius: f64,
        /// Difference of the two distances [m], not negative.
        off: f64,
    },
    /// The center of an arc of more than half a turn lies off the perpendicular bisector of its chord.
    #[error(
        "arc center is {} m off the line of all points that are as far from its start as from its end",
        Rounded(*off)
    )]
    CenterOff {
        /// Distance [m] of the center from the bisector.
        off: f64,
    },
}

/// Reason why an edge could not be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EdgeError {
    /// A straight edge cannot be built.
    #[error(transparent)]
    Line(#[from] LineError),
    /// An arc cannot be built.
    #[error(transparent)]
    Arc(#[from] ArcError),
}

/// Reason why a shape could not be built. Paths and edges are counted from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// A measure of a ready-made shape is not positive and finite.
    #[error("{name} must be positive and finite, got {value} m")]
    BadLength {
        /// Name of the measure.
        name: &'static str,
        /// Value of the measure [m].
        value: f64,
    },
    /// A measure of a ready-made shape conflicts with another one.
    #[error("{name} is {value} m, but must be {rule} {} m", RoundedPlace(*limit))]
    OutOfRange {
        /// Name of the measure.
        name: &'static str,
        /// Value of the measure [m].
        value: f64,
        /// Required relation of the value to the limit: "less than", "at most".
        rule: &'static str,
        /// The limit [m].
        limit: f64,
    },
    /// An angle of a ready-made shape is out of range.
    #[error("{name} must be more than 0 and at most {} rad, got {value} rad", RoundedPlace(*limit))]
    BadAngle {
        /// Name of the angle.
        name: &'static str,
        /// Value of the angle [rad].
        value: f64,
        /// Largest permitted angle [rad].
        limit: f64,
    },
    /// A ready-made shape has too few teeth or slots.
    #[error("{name} must be at least {least}, got {count}")]
    TooFew {
        /// What there is too few of.
        name: &'static str,
        /// Their number.
        count: usize,
        /// Least number.
        least: usize,
    },
    /// A cam's lift is another after a turn.
    #[error("the lift is another after a turn, by {} m: it must come back to where it began", Rounded(*by))]
    LiftJumps {
        /// Difference [m].
        by: f64,
    },
    /// A cam's lift has another slope after a turn.
    #[error(
        "the lift has a corner where a turn ends: its slope must be the same there (`periodic = true` for tables)"
    )]
    LiftHasCorner,
    /// A cam's lift pulls its roller over the axis.
    #[error("at {} rad the lift pulls the roller over the axis", RoundedPlace(*angle))]
    CamTooDeep {
        /// Angle on the cam [rad].
        angle: f64,
    },
    /// A cam's lift bends more than its roller can follow.
    #[error(
        "at {} rad the way of the roller's center bends with a radius of {} m, which the roller of {roller} m cannot follow: \
         take a smaller roller or a larger base",
        RoundedPlace(*angle),
        Rounded(*radius)
    )]
    Undercut {
        /// Angle on the cam [rad].
        angle: f64,
        /// Radius of curvature of the way of the roller's center [m].
        radius: f64,
        /// Radius of the roller [m].
        roller: f64,
    },
    /// A curve of a ready-made shape cannot be followed by arcs.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A polygon has fewer than three vertices.
    #[error("a polygon needs at least 3 vertices, got {0}")]
    TooFewVertices(usize),
    /// A shape without paths.
    #[error("an outline needs at least one path")]
    NoPaths,
    /// A path without edges.
    #[error("path {path} has no edges")]
    EmptyPath {
        /// Index of the path.
        path: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("path {path}, edge {edge}: coordinates must be finite")]
    NotFinite {
        /// Index of the path.
        path: usize,
        /// Index of the edge.
        edge: usize,
    },
    /// The last edge does not end where the path starts.
    #[error("path {path} is open: edge {edge} ends {} m away from the start", Rounded(*gap))]
    OpenPath {
        /// Index of the path.
        path: usize,
        /// Index of the last edge.
        edge: usize,
        /// Distance [m] from the end of the last edge to the start.
        gap: f64,
    },
    /// Both ends of an edge are one point.
    #[error("path {path}, edge {edge}: its end points coincide ({} m apart)", Rounded(*length))]
    CoincidentVertices {
        /// Index of the path.
        path: usize,
        /// Index of the edge.
        edge: usize,
        /// Distance [m] between the end points.
        length: f64,
    },
    /// An arc is impossible.
    #[error("path {path}, edge {edge}: {source}")]
    Arc {
        /// Index of the path.
        path: usize,
        /// Index of the edge.
        edge: usize,
        /// Reason why the arc could not be built.
        source: ArcError,
    },
    /// The shape is so small or so large that its area or moments under- or overflow.
    #[error("a shape that reaches {} m from its origin has moments beyond what numbers hold", Rounded(*reach))]
    NoMoments {
        /// Largest distance [m] of a point of the shape from the body's origin.
        reach: f64,
    },
    /// Two edges cross or touch.
    #[error(
        "path {path_a}, edge {edge_a} meets path {path_b}, edge {edge_b} at ({}, {}) m",
        RoundedPlace(*x),
        RoundedPlace(*y)
    )]
    Crossing {
        /// Path of the first edge.
        path_a: usize,
        /// Index of the first edge.
        edge_a: usize,
        /// Path of the second edge.
        path_b: usize,
        /// Index of the second edge.
        edge_b: usize,
        /// x coordinate of the point at which they meet [m].
        x: f64,
        /// y coordinate of the point at which they meet [m].
        y: f64,
    },
}
