//! Problems and answers as JSON: the formats `halfgap-contact-1` and `halfgap-solution-1`.

mod fault;

use std::collections::BTreeMap;

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use crate::error::ProblemError;
use crate::kind::RowKind;
use crate::matrix::{Matrix, SparseMatrix};
use crate::problem::Problem;
use crate::solution::Solution;

const PROBLEM_FORMAT: &str = "halfgap-contact-1";
const SOLUTION_FORMAT: &str = "halfgap-solution-1";

/// Fields of [`ContactFile`].
const FIELDS: [&str; 15] = [
    "format",
    "title",
    "family",
    "symmetric",
    "A",
    "J",
    "inverse_mass",
    "b",
    "b_next",
    "bilateral",
    "friction",
    "bounds",
    "feasible",
    "reference_force",
    "expected",
];

/// An error in a file of a contact problem.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The text is not JSON; the message names line and column.
    #[error("{0}")]
    Json(#[from] serde_json::Error),
    /// The text is not JSON and contains NaN or Infinity, which JSON does not have but some programs write.
    #[error("{0} (the file has NaN or Infinity, which JSON does not know)")]
    NotANumber(serde_json::Error),
    /// The field `format` is not that of a contact problem.
    #[error("field `format` is \"{0}\", expected \"{PROBLEM_FORMAT}\"")]
    Format(String),
    /// A value is of another type than its field wants; the path of the field is empty for the whole file.
    #[error("{} must be {expected}, got {found}", place(field))]
    WrongValue {
        /// Path of the field, such as `A.triplets[2][0]`.
        field: String,
        /// Values that the field takes.
        expected: &'static str,
        /// The value, shortened.
        found: String,
    },
    /// A required field is missing.
    #[error("field `{0}` is missing")]
    Missing(&'static str),
    /// The file has both `A` and `J`, which exclude each other.
    #[error("the fields `A` and `J` exclude each other: which of them is the problem?")]
    Both,
    /// The numbers are not a contact problem.
    #[error("{0}")]
    Problem(#[from] ProblemError),
}

/// The contents of a problem file, format `halfgap-contact-1`: a contact problem and what a test expects of its answer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ContactFile {
    /// Name of the format, `halfgap-contact-1`.
    pub format: String,
    /// Title of the problem.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Name of the family of problems that it belongs to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub family: Option<String>,
    /// Whether A is symmetric and positive semidefinite; true if absent.
    #[serde(default = "yes")]
    pub symmetric: bool,
    /// The entries of A [1/kg]; excludes `j`.
    #[serde(default, rename = "A", skip_serializing_if = "Option::is_none")]
    pub a: Option<MatrixField>,
    /// The rows J of bodies [1, 1, m per body]; excludes `a` and needs `inverse_mass`.
    #[serde(default, rename = "J", skip_serializing_if = "Option::is_none")]
    pub j: Option<RowsField>,
    /// Inverse mass per column of J [1/kg, 1/(kg m²)].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inverse_mass: Option<Vec<f64>>,
    /// The offset b of each row [m/s²].
    pub b: Vec<f64>,
    /// The offset b of each row one step later [m/s²].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub b_next: Option<Vec<f64>>,
    /// One flag per row, true if it is bilateral; none is if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bilateral: Option<Vec<bool>>,
    /// The rows that are bounded by friction.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub friction: Vec<FrictionField>,
    /// The rows that are bounded by constants.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bounds: Vec<BoundsField>,
    /// Whether a solution exists, as far as a test knows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub feasible: Option<bool>,
    /// Force per row \[N\] of a known solution; others may exist.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_force: Option<Vec<f64>>,
    /// The answer of another program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected: Option<Expected>,
}

/// A matrix, dense by rows or sparse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum MatrixField {
    /// All rows, with all entries.
    Dense(Vec<Vec<f64>>),
    /// The nonzero entries only.
    Sparse {
        /// Number of rows and columns.
        n: usize,
        /// Row, column, value [1/kg]; values at the same place add up.
        triplets: Vec<(usize, usize, f64)>,
    },
}

/// The rows J of bodies, sparse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RowsField {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Row, column, coefficient (x and y \[1\], rotation \[m\]); coefficients at the same place add up.
    pub triplets: Vec<(usize, usize, f64)>,
}

/// A row bounded by friction: |f| ≤ coefficient times the force of the normal row; see
/// [`RowKind::Friction`](crate::RowKind::Friction).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrictionField {
    /// Index of the tangential row.
    pub row: usize,
    /// Index of the normal row, which is unilateral.
    pub normal: usize,
    /// Coefficient of friction mu \[-\].
    pub coefficient: f64,
}

/// A row bounded by constants; see [`RowKind::Bounded`](crate::RowKind::Bounded).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundsField {
    /// Index of the row.
    pub row: usize,
    /// Least force \[N\]; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub least: Option<f64>,
    /// Most force \[N\]; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub most: Option<f64>,
}

/// Expected accelerations and, where unique, forces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Expected {
    /// Acceleration per row [m/s²].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<Vec<f64>>,
    /// Largest difference [m/s²] of an acceleration from the expected one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Force per row \[N\]; not unique where contacts are redundant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<Vec<f64>>,
}

fn yes() -> bool {
    true
}

impl ContactFile {
    /// Parses the text of a problem file.
    ///
    /// # Errors
    ///
    /// [`FileError::Json`], [`FileError::NotANumber`], [`FileError::WrongValue`], [`FileError::Missing`] or
    /// [`FileError::Format`]. The numbers are checked by [`problem`](Self::problem).
    #[inline]
    pub fn parse(text: &str) -> Result<Self, FileError> {
        // Some editors put a byte order mark before the text.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let file: ContactFile = serde_json::from_str(text).map_err(|error| {
            let has_none = error.is_syntax() && ["NaN", "Infinity"].iter().any(|word| text.contains(word));
            if has_none {
                FileError::NotANumber(error)
            } else {
                fault::find_fault(text).unwrap_or(FileError::Json(error))
            }
        })?;
        if file.format == PROBLEM_FORMAT { Ok(file) } else { Err(FileError::Format(file.format)) }
    }

    /// Lists the fields of a file's text that the format does not have; [`parse`](Self::parse) ignores them. Empty if
    /// the text is not a JSON object.
    #[must_use]
    #[inline]
    pub fn unknown_fields(text: &str) -> Vec<String> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let Ok(fields) = serde_json::from_str::<BTreeMap<String, IgnoredAny>>(text) else {
            return Vec::new();
        };
        fields.into_keys().filter(|field| !FIELDS.contains(&field.as_str())).collect()
    }

    /// Makes the file of `problem`, to be replayed later. Keys of rows are not part of it; a problem with forces that act
    /// in other directions than are measured is given by its A.
    #[must_use]
    pub fn of(problem: &Problem) -> Self {
        let mut file = ContactFile {
            format: PROBLEM_FORMAT.to_owned(),
            symmetric: problem.is_symmetric() && !problem.further.has_directions(),
            b: problem.offset().to_vec(),
            ..Self::default()
        };
        if problem.bilateral().contains(&true) {
            file.bilateral = Some(problem.bilateral().to_vec());
        }
        for (row, kind) in problem.further.kinds() {
            match kind {
                RowKind::Unilateral | RowKind::Bilateral => {}
                RowKind::Friction { normal, coefficient } => {
                    file.friction.push(FrictionField { row, normal, coefficient });
                }
                RowKind::Bounded { least, most } => {
                    let [least, most] = [least, most].map(|bound| bound.is_finite().then_some(bound));
                    file.bounds.push(BoundsField { row, least, most });
                }
            }
        }
        match &problem.matrix {
            Matrix::Bodies(_) if problem.further.has_directions() => {
                let entries = problem.dense();
                let triplets = (0..problem.len()).flat_map(|i| {
                    let row = entries[i].iter().enumerate();
                    row.filter(|(_, value)| **value != 0.0).map(move |(j, &value)| (i, j, value))
                });
                file.a = Some(MatrixField::Sparse { n: problem.len(), triplets: triplets.collect() });
            }
            Matrix::Bodies(bodies) => {
                let (rows, columns) = (bodies.rows.rows(), bodies.inverse_mass.len());
                file.j = Some(RowsField { rows, columns, triplets: triplets(&bodies.rows) });
                file.inverse_mass = Some(bodies.inverse_mass.clone());
            }
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => {
                file.a = Some(MatrixField::Sparse { n: matrix.rows(), triplets: triplets(matrix) });
            }
        }
        file
    }

    /// Writes the file as JSON.
    ///
    /// # Errors
    ///
    /// [`FileError::Json`] if a number cannot be written.
    #[inline]
    pub fn to_json(&self) -> Result<String, FileError> {
        Ok(serde_json::to_string(self)?)
    }

    /// Makes the problem that the file describes.
    ///
    /// # Errors
    ///
    /// [`FileError`] names the field or row that is wrong.
    #[inline]
    pub fn problem(&self) -> Result<Problem, FileError> {
        let mut problem = match (&self.a, &self.j) {
            (Some(_), Some(_)) => return Err(FileError::Both),
            (None, Some(rows)) => self.problem_of_rows(rows)?,
            (Some(matrix), None) => self.problem_of_matrix(matrix)?,
            (None, None) => return Err(FileError::Missing("A or J")),
        };
        if let Some(bilateral) = &self.bilateral {
            problem.set_bilateral(bilateral)?;
        }
        self.set_kinds(&mut problem)?;
        self.check_answers()?;
        Ok(problem)
    }

    /// Sets the kinds of the rows that are bounded.
    fn set_kinds(&self, problem: &mut Problem) -> Result<(), FileError> {
        let friction = self.friction.iter().map(|&FrictionField { row, normal, coefficient }| {
            (row, RowKind::Friction { normal, coefficient })
        });
        let bounds = self.bounds.iter().map(|&BoundsField { row, least, most }| {
            let [least, most] = [least.unwrap_or(f64::NEG_INFINITY), most.unwrap_or(f64::INFINITY)];
            (row, RowKind::Bounded { least, most })
        });
        for (row, kind) in friction.chain(bounds) {
            if row >= problem.len() {
                return Err(ProblemError::NoSuchRow { row, rows: problem.len() }.into());
            }
            problem.set_kind(row, kind)?;
        }
        Ok(())
    }

    /// Checks that known answers have a number for each row.
    fn check_answers(&self) -> Result<(), FileError> {
        let expected = self.expected.as_ref();
        let answers = [
            ("reference_force", self.reference_force.as_ref()),
            ("expected.acceleration", expected.and_then(|expected| expected.acceleration.as_ref())),
            ("expected.force", expected.and_then(|expected| expected.force.as_ref())),
        ];
        for (what, answer) in answers {
            if let Some(found) = answer.map(Vec::len).filter(|&found| found != self.b.len()) {
                return Err(ProblemError::BadLength { what, found, expected: self.b.len() }.into());
            }
        }
        Ok(())
    }

    fn problem_of_rows(&self, j: &RowsField) -> Result<Problem, FileError> {
        let inverse_mass = self.inverse_mass.as_ref().ok_or(FileError::Missing("inverse_mass"))?;
        let lengths = [("b", self.b.len(), j.rows), ("inverse_mass", inverse_mass.len(), j.columns)];
        for (what, found, expected) in lengths {
            if found != expected {
                return Err(ProblemError::BadLength { what, found, expected }.into());
            }
        }
        Ok(Problem::from_rows(&j.triplets, inverse_mass, &self.b)?)
    }

    fn problem_of_matrix(&self, matrix: &MatrixField) -> Result<Problem, FileError> {
        let problem = match (matrix, self.symmetric) {
            (MatrixField::Dense(rows), true) => Problem::from_dense(rows, &self.b)?,
            (MatrixField::Dense(rows), false) => Problem::from_general_dense(rows, &self.b)?,
            (MatrixField::Sparse { n, triplets }, symmetric) => {
                if *n != self.b.len() {
                    let (found, expected) = (self.b.len(), *n);
                    return Err(ProblemError::BadLength { what: "b", found, expected }.into());
                }
                match symmetric {
                    true => Problem::from_symmetric(triplets, &self.b)?,
                    false => Problem::from_general(triplets, &self.b)?,
                }
            }
        };
        Ok(problem)
    }
}

/// Returns the words of messages for a field, or for the whole file.
fn place(field: &str) -> String {
    if field.is_empty() { "the file".to_owned() } else { format!("field `{field}`") }
}

fn triplets(matrix: &SparseMatrix) -> Vec<(usize, usize, f64)> {
    let row = |i| {
        let (columns, values) = matrix.row(i);
        columns.iter().zip(values).map(move |(&k, &v)| (i, k, v))
    };
    (0..matrix.rows()).flat_map(row).collect()
}

/// The contents of an answer file, format `halfgap-solution-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SolutionFile {
    /// Name of the format, `halfgap-solution-1`.
    pub format: String,
    /// Outcome: `solved`, `infeasible` or `failed`.
    pub status: String,
    /// Name of the method, as [`Method::name`](crate::Method::name).
    pub method: String,
    /// Force per row \[N\].
    pub force: Vec<f64>,
    /// Acceleration per row [m/s²].
    pub acceleration: Vec<f64>,
    /// Natural residual [-]; see [`Residuals`](crate::Residuals).
    pub r_nat: f64,
    /// Backward residual [-].
    pub r_bwd: f64,
    /// Growth [-]: largest sum of terms of an acceleration, in units of the scale.
    pub growth: f64,
    /// Number of pivots or iterations.
    pub iterations: usize,
    /// Contradiction between dependent rows, in units of the scale.
    pub inconsistency: f64,
    /// Time of a solve without an earlier answer \[µs\].
    pub microseconds: f64,
    /// Time of a warm solve \[µs\]; `None` if none was made.
    pub microseconds_warm: Option<f64>,
}

impl SolutionFile {
    /// Makes the file of a solution, with `status` "solved". The caller fills in the times.
    #[must_use]
    pub fn of(solution: &Solution) -> Self {
        SolutionFile {
            format: SOLUTION_FORMAT.to_owned(),
            status: "solved".to_owned(),
            method: solution.method.name().to_owned(),
            force: solution.force.clone(),
            acceleration: solution.acceleration.clone(),
            r_nat: solution.residuals.natural,
            r_bwd: solution.residuals.backward,
            growth: solution.residuals.growth,
            iterations: solution.iterations,
            inconsistency: solution.inconsistency,
            microseconds: 0.0,
            microseconds_warm: None,
        }
    }
}
