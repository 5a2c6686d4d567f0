//! Errors of settings, problems and solves.

use crate::check::Residuals;
use crate::solver::Method;
use crate::words::Words;
use halfgap_collision::geometry::Rounded;

/// A number of [`Settings`](crate::Settings) is not positive and finite.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("setting `{field}` must be positive and finite, got {value}")]
pub struct SettingsError {
    /// Name of the field.
    pub field: &'static str,
    /// Its value.
    pub value: f64,
}

/// An error in the data of a contact problem.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// A coefficient, offset or matrix entry is NaN or infinite.
    #[error("row {row}: {what} is {value}")]
    NotFinite {
        /// The row that holds the number.
        row: usize,
        /// The quantity that the number is.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// An inverse mass is negative, NaN or infinite.
    #[error("column {column}: inverse mass must be zero or positive and finite, got {value}")]
    BadInverseMass {
        /// The column (coordinate of a body) with the inverse mass.
        column: usize,
        /// The inverse mass [1/kg, or 1/(kg m²) for a rotation].
        value: f64,
    },
    /// A row names a column that does not exist.
    #[error("row {row}: column {column} does not exist, there are {columns}")]
    NoSuchColumn {
        /// The row.
        row: usize,
        /// The column it names.
        column: usize,
        /// Number of columns of the problem.
        columns: usize,
    },
    /// Bodies or rows were to be added to a problem made from a matrix.
    #[error("bodies and rows cannot be added to a problem given by a matrix A")]
    NoBodies,
    /// A list has the wrong length.
    #[error("{what} has {found} entries, expected {expected}")]
    BadLength {
        /// Name of the list.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it must have.
        expected: usize,
    },
    /// A matrix entry names a row that does not exist.
    #[error("an entry names row {row}, there are {rows}")]
    NoSuchRow {
        /// The row it names.
        row: usize,
        /// Number of rows of the problem.
        rows: usize,
    },
    /// A matrix that was given as symmetric is not.
    #[error(
        "row {row}: A is not symmetric, it differs from the entry across the diagonal in column {column} by {}",
        Rounded(*difference)
    )]
    NotSymmetric {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
        /// The entry less the one across the diagonal, in units of A.
        difference: f64,
    },
    /// An entry of a symmetric matrix is larger than its diagonal allows, so that A is not positive semidefinite.
    #[error(
        "row {row}: A is not positive semidefinite, its entry {} in column {column} is larger than its diagonal \
         allows",
        Rounded(*value)
    )]
    NotSemidefinite {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
        /// The entry, whose square exceeds the product of the two diagonal entries.
        value: f64,
    },
    /// The square of a row, its diagonal entry of A, overflows or underflows.
    #[error(
        "row {row}: its diagonal entry of A is {}, which is too large or too small to compute with",
        Rounded(*value)
    )]
    OutOfRange {
        /// The row.
        row: usize,
        /// The diagonal entry.
        value: f64,
    },
    /// The bounds of a row's force are NaN, or the least exceeds the most.
    #[error("row {row}: the least force must be at most the most force, got {least} and {most}")]
    BadBounds {
        /// The row.
        row: usize,
        /// The least force \[N\].
        least: f64,
        /// The most force \[N\].
        most: f64,
    },
    /// A coefficient of friction is negative, NaN or infinite.
    #[error("row {row}: the coefficient of friction must be zero or positive and finite, got {coefficient}")]
    BadFriction {
        /// The row.
        row: usize,
        /// The coefficient.
        coefficient: f64,
    },
    /// The force of a row is bounded by that of a row that is not a unilateral one before it.
    #[error("row {row}: friction needs a unilateral row before it, row {normal} is none")]
    NotAContact {
        /// The row.
        row: usize,
        /// The row that it names.
        normal: usize,
    },
    /// A diagonal entry of a symmetric matrix is negative, so that A is not positive semidefinite.
    #[error("row {row}: the diagonal entry of a symmetric A must not be negative, got {value}")]
    NegativeDiagonal {
        /// The row.
        row: usize,
        /// The diagonal entry.
        value: f64,
    },
}

/// The reason for which a solve has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum SolveError {
    /// No forces satisfy the rows, by the enclosed proof.
    #[error("{0}")]
    Infeasible(Box<Infeasibility>),
    /// The method stopped without an answer that passes the check.
    #[error("{method} found no acceptable answer in {iterations} iterations: {residuals}")]
    Unsolved {
        /// The method that gave up.
        method: Method,
        /// Residuals of its last forces.
        residuals: Residuals,
        /// Number of pivots or iterations made.
        iterations: usize,
    },
    /// None of all modes of contacts (open, sticking, slipping either way) gives admissible forces. Problems at velocity
    /// level have a solution; see [`Jump`](crate::Jump).
    #[error("no forces satisfy the rows: none of the {combinations} combinations of modes does")]
    NoModes {
        /// Number of combinations.
        combinations: u64,
    },
    /// The method does not take rows of a kind; see [`RowKind`](crate::RowKind).
    #[error("{method} does not take {kind}: row {row} is one")]
    UnsupportedRow {
        /// The method.
        method: Method,
        /// Index of the row.
        row: usize,
        /// Words for its kind.
        #[cfg_attr(feature = "save", serde(with = "crate::words"))]
        kind: Words,
    },
    /// The method does not apply to this kind of problem.
    #[error("{method} does not apply: {reason}")]
    NotApplicable {
        /// The method.
        method: Method,
        /// Property that the method needs and the problem lacks.
        #[cfg_attr(feature = "save", serde(with = "crate::words"))]
        reason: Words,
    },
}

impl SolveError {
    /// Index of the row at which a contradiction showed, or that is not supported; `None` for other errors.
    #[must_use]
    #[inline]
    pub fn row(&self) -> Option<usize> {
        match self {
            Self::Infeasible(infeasibility) => Some(infeasibility.row),
            Self::UnsupportedRow { row, .. } => Some(*row),
            Self::Unsolved { .. } | Self::NoModes { .. } | Self::NotApplicable { .. } => None,
        }
    }
}

/// Proof that a problem has no solution.
///
/// `direction` is a combination z of the rows, z ≥ 0 on unilateral rows, that no admissible forces can accelerate: Aᵀz is
/// zero on bilateral and at most zero on unilateral rows, up to rounding, while bᵀz < 0. For any admissible forces f,
/// zᵀ(A f + b) ≤ bᵀz < 0, so the accelerations cannot all be admissible (Farkas' lemma). If A is symmetric and positive
/// semidefinite, A z = 0 then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[error(
        "no forces satisfy the rows: they contradict each other at row {row}, by {} of the scale",
        Rounded(*contradiction)
    )]
pub struct Infeasibility {
    /// Index of the row at which the contradiction showed.
    pub row: usize,
    /// The combination z of the rows, one number per row.
    pub direction: Vec<f64>,
    /// Least change of a row's b, in units of the scale, that would remove the contradiction: |bᵀz| max|s z| / |s z|².
    pub contradiction: f64,
    /// Largest scaled component of Aᵀz that admissible forces could use (of either sign on bilateral rows, positive on
    /// unilateral ones; where A is symmetric, the largest of any sign may stand for it), in units of the largest scaled
    /// component of z. Zero up to the rounding of z.
    pub leakage: f64,
}

impl Infeasibility {
    /// Least growth that any solution would have, as far as the certificate can tell: smaller forces cannot make up for
    /// the contradiction through the leakage in Aᵀz. See [`Residuals::growth`].
    #[must_use]
    #[inline]
    pub fn least_growth(&self) -> f64 {
        self.contradiction / self.leakage.max(f64::EPSILON)
    }
}
