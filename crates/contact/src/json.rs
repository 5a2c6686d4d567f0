//! Problems and answers as JSON: the formats `halfgap-contact-1` and `halfgap-solution-1`.

use std::collections::BTreeMap;

use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use crate::error::ProblemError;
use crate::matrix::{Matrix, SparseMatrix};
use crate::problem::Problem;
use crate::solution::Solution;

const PROBLEM_FORMAT: &str = "halfgap-contact-1";
const SOLUTION_FORMAT: &str = "halfgap-solution-1";

/// Fields of [`ContactFile`].
const FIELDS: [&str; 13] = [
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
    "feasible",
    "reference_force",
    "expected",
];

/// Why a file is not a contact problem.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// Not JSON, or a field has the wrong type; the message names line and column.
    #[error("{0}")]
    Json(#[from] serde_json::Error),
    /// The same of a file with numbers that JSON does not have: some programs write them.
    #[error("{0} (the file has NaN or Infinity, which JSON does not know)")]
    NotANumber(serde_json::Error),
    /// The format field says something else.
    #[error("field `format` is \"{0}\", expected \"{PROBLEM_FORMAT}\"")]
    Format(String),
    /// A field is missing.
    #[error("field `{0}` is missing")]
    Missing(&'static str),
    /// Two fields that exclude each other.
    #[error("the fields `A` and `J` exclude each other: which of them is the problem?")]
    Both,
    /// The numbers are wrong.
    #[error("{0}")]
    Problem(#[from] ProblemError),
}

/// A contact problem in a file, with what a test expects of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ContactFile {
    /// `halfgap-contact-1`.
    pub format: String,
    /// A name for people.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// What kind of problem it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub family: Option<String>,
    /// Whether A is symmetric and positive semidefinite.
    #[serde(default = "yes")]
    pub symmetric: bool,
    /// The entries of A [1/kg].
    #[serde(default, rename = "A", skip_serializing_if = "Option::is_none")]
    pub a: Option<MatrixField>,
    /// The rows of bodies.
    #[serde(default, rename = "J", skip_serializing_if = "Option::is_none")]
    pub j: Option<RowsField>,
    /// Inverse mass per column of J [1/kg, 1/(kg m²)].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inverse_mass: Option<Vec<f64>>,
    /// The right-hand side [m/s²].
    pub b: Vec<f64>,
    /// The right-hand side one step later.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub b_next: Option<Vec<f64>>,
    /// Which rows are equations; none if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bilateral: Option<Vec<bool>>,
    /// Whether a solution exists, as far as a test knows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub feasible: Option<bool>,
    /// A known solution; others may exist.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_force: Option<Vec<f64>>,
    /// What another program found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected: Option<Expected>,
}

/// A matrix, dense by rows or sparse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum MatrixField {
    /// All rows in full.
    Dense(Vec<Vec<f64>>),
    /// Entries that are not zero.
    Sparse {
        /// Number of rows and columns.
        n: usize,
        /// Row, column, value; values at one place add up.
        triplets: Vec<(usize, usize, f64)>,
    },
}

/// Rows J of bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RowsField {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Row, column, coefficient; coefficients at one place add up.
    pub triplets: Vec<(usize, usize, f64)>,
}

/// Expected accelerations and, where unique, forces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Expected {
    /// Acceleration per row [m/s²].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<Vec<f64>>,
    /// How closely they must agree, in the same units.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Force per row \[N\]; others may do where contacts are redundant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<Vec<f64>>,
}

fn yes() -> bool {
    true
}

impl ContactFile {
    /// Reads a file's text.
    ///
    /// # Errors
    ///
    /// [`FileError`]; only the shape of the file is looked at here.
    pub fn parse(text: &str) -> Result<Self, FileError> {
        // Some editors put a mark before a text.
        let file: ContactFile =
            serde_json::from_str(text.strip_prefix('\u{feff}').unwrap_or(text)).map_err(|error| {
                let has_none =
                    error.is_syntax() && ["NaN", "Infinity"].iter().any(|word| text.contains(word));
                if has_none { FileError::NotANumber(error) } else { FileError::Json(error) }
            })?;
        if file.format == PROBLEM_FORMAT { Ok(file) } else { Err(FileError::Format(file.format)) }
    }

    /// Fields of a file's text that a problem does not have: left out of account, or misspelt. None of what is no
    /// object.
    #[must_use]
    pub fn unknown_fields(text: &str) -> Vec<String> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let Ok(fields) = serde_json::from_str::<BTreeMap<String, IgnoredAny>>(text) else {
            return Vec::new();
        };
        fields.into_keys().filter(|field| !FIELDS.contains(&field.as_str())).collect()
    }

    /// The file that describes `problem`, to be replayed later.
    #[must_use]
    pub fn of(problem: &Problem) -> Self {
        let mut file = ContactFile {
            format: PROBLEM_FORMAT.to_owned(),
            symmetric: problem.is_symmetric(),
            b: problem.offset().to_vec(),
            ..Self::default()
        };
        if problem.bilateral().contains(&true) {
            file.bilateral = Some(problem.bilateral().to_vec());
        }
        match &problem.matrix {
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

    /// The file's text.
    ///
    /// # Errors
    ///
    /// [`FileError::Json`] if a number cannot be written.
    pub fn to_json(&self) -> Result<String, FileError> {
        Ok(serde_json::to_string(self)?)
    }

    /// The problem described.
    ///
    /// # Errors
    ///
    /// [`FileError`] names the field or row that is wrong.
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
        Ok(problem)
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

fn triplets(matrix: &SparseMatrix) -> Vec<(usize, usize, f64)> {
    let row = |i| {
        let (columns, values) = matrix.row(i);
        columns.iter().zip(values).map(move |(&k, &v)| (i, k, v))
    };
    (0..matrix.rows()).flat_map(row).collect()
}

/// An answer in a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SolutionFile {
    /// `halfgap-solution-1`.
    pub format: String,
    /// `solved`, `infeasible` or `failed`.
    pub status: String,
    /// Name of the method.
    pub method: String,
    /// Force per row \[N\].
    pub force: Vec<f64>,
    /// Acceleration per row [m/s²].
    pub acceleration: Vec<f64>,
    /// Natural residual.
    pub r_nat: f64,
    /// Backward residual.
    pub r_bwd: f64,
    /// Growth.
    pub growth: f64,
    /// Pivots or iterations.
    pub iterations: usize,
    /// Contradiction between dependent rows, in units of the scale.
    pub inconsistency: f64,
    /// Time of a solve from nothing \[µs\].
    pub microseconds: f64,
    /// Time of a warm solve \[µs\], if one was made.
    pub microseconds_warm: Option<f64>,
}

impl SolutionFile {
    /// The file of a solution; times are to be filled in.
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
