//! What can be wrong with an edge or a shape.

/// Why a straight edge could not be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LineError {
    /// An end point is infinite or not a number, or the square of their distance is.
    #[error("end points, and the square of their distance, must be finite")]
    NotFinite,
    /// The end points coincide.
    #[error("end points coincide at ({0}, {1}) m")]
    ZeroLength(f64, f64),
}

/// Why an arc could not be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ArcError {
    /// A coordinate is infinite or not a number.
    #[error("arc center and end points must be finite, their tolerance a number")]
    NotFinite,
    /// The radius is not a positive, finite length.
    #[error("arc radius must be positive and finite, got {0} m")]
    BadRadius(f64),
    /// The sweep is empty or more than a full turn.
    #[error("arc sweep must be between 0 and a full turn in size, got {0} rad")]
    BadSweep(f64),
    /// The two ends have different distances from the center.
    #[error("arc radius is {from_radius} m at its start but {to_radius} m at its end: off by {off} m")]
    RadiusMismatch {
        /// Distance [m] of the start from the center.
        from_radius: f64,
        /// Distance [m] of the end from the center.
        to_radius: f64,
        /// Difference of the two [m].
        off: f64,
    },
    /// The center of an arc of more than half a turn lies off the line of the points as far from both ends.
    #[error(
        "arc center is {off} m off the line of all points that are as far from its start as from its end"
    )]
    CenterOff {
        /// How far [m].
        off: f64,
    },
}

/// Why a shape could not be built. Paths and edges are counted from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// A measure of a ready-made shape is out of range.
    #[error("{name} must be positive and finite, got {value} m")]
    BadLength {
        /// Which measure.
        name: &'static str,
        /// Its value [m].
        value: f64,
    },
    /// A measure of a ready-made shape does not go with another one.
    #[error("{name} is {value} m, but must be {rule} {limit} m")]
    OutOfRange {
        /// Which measure.
        name: &'static str,
        /// Its value [m].
        value: f64,
        /// How it must stand to the limit: "less than", "at most".
        rule: &'static str,
        /// The limit [m].
        limit: f64,
    },
    /// An angle of a ready-made shape is out of range.
    #[error("{name} must be more than 0 and at most {limit} rad, got {value} rad")]
    BadAngle {
        /// Which angle.
        name: &'static str,
        /// Its value [rad].
        value: f64,
        /// The limit [rad].
        limit: f64,
    },
    /// There are not enough corners.
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
    #[error("path {path} is open: edge {edge} ends {gap} m away from the start")]
    OpenPath {
        /// Index of the path.
        path: usize,
        /// Index of the last edge.
        edge: usize,
        /// Distance [m] from the start.
        gap: f64,
    },
    /// Both ends of an edge are one point.
    #[error("path {path}, edge {edge}: its end points coincide ({length} m apart)")]
    CoincidentVertices {
        /// Index of the path.
        path: usize,
        /// Index of the edge.
        edge: usize,
        /// Distance [m] of the end points.
        length: f64,
    },
    /// An arc is impossible.
    #[error("path {path}, edge {edge}: {source}")]
    Arc {
        /// Index of the path.
        path: usize,
        /// Index of the edge.
        edge: usize,
        /// What is wrong with it.
        source: ArcError,
    },
    /// The shape is so small or so large that its area and moments are no numbers.
    #[error("a shape that reaches {reach:e} m from its origin has moments beyond what numbers hold")]
    NoMoments {
        /// How far it reaches [m].
        reach: f64,
    },
    /// Two edges cross or touch.
    #[error("path {path_a}, edge {edge_a} meets path {path_b}, edge {edge_b} at ({x}, {y}) m")]
    Crossing {
        /// Path of the first edge.
        path_a: usize,
        /// Index of the first edge.
        edge_a: usize,
        /// Path of the second edge.
        path_b: usize,
        /// Index of the second edge.
        edge_b: usize,
        /// Where they meet [m].
        x: f64,
        /// Where they meet [m].
        y: f64,
    },
}
