//! Contact forces and impulses: complementarity problems, solved and checked.
//!
//! Rows in, forces out: with the Delassus matrix A = J M⁻¹ Jᵀ, find forces f and accelerations a = A f + b with f ≥ 0,
//! a ≥ 0, fᵀa = 0 on unilateral rows (contacts) and a = 0 on bilateral ones (connectors). [`Problem`] holds the rows,
//! [`Solution`] the forces and their residuals, and [`Auto`] chooses a method. Each method is a [`Solver`] too, a trait
//! that callers can implement for methods of their own.
//!
//! ```
//! use halfgap_contact::{Auto, InverseInertia, Problem, Row, Settings, Solution, Solver};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A box of 2 kg on a support to the left of its centre of mass and on another, twice as far, to the right.
//! let mut problem = Problem::new();
//! let block = problem.add_body(InverseInertia { inverse_mass: 0.5, inverse_moment: 3.0 })?;
//! for arm in [-0.25, 0.5] {
//!     problem.add_row(&Row::new(block, [0.0, 1.0, arm], -9.81))?;
//! }
//! let mut solution = Solution::new();
//! Auto::new(Settings::default())?.solve(&problem, &mut solution)?;
//! assert!((solution.force[0] - 13.08).abs() < 1e-12 && (solution.force[1] - 6.54).abs() < 1e-12);
//! assert!(solution.residuals.natural < 1e-12);
//! # Ok(())
//! # }
//! ```
//!
//! *Invariant*: this crate knows no shapes, no time stepping and no scenes. Every answer is checked in the original
//! data before it is returned. Every iteration has a cap. A new solver gives the same bits for the same input; one that
//! has solved other problems before gives the same answer up to rounding. A warm solve of a size met before allocates
//! nothing.
//!
//! | module | contents |
//! |---|---|
//! | `problem`, `kind`, `matrix` | a problem by the rows of bodies, or by the entries of A; checked when built |
//! | `solution`, `check` | the answer and its residuals |
//! | `settings`, `error`, `solver` | thresholds and caps of the methods, errors, the trait of a method |
//! | `system`, `entries` | the problem scaled to a unit diagonal, on which the symmetric methods work |
//! | `dual_active_set`, `start`, `descent`, `spread`, `crossover`, `exchanges`, `closed_rows`, `skyline`, `order`, `dependent`, `raised`, `least_norm` | [`DualActiveSet`] |
//! | `proximal_newton`, `interior_point`, `body_factor`, `line_search`, `certificate` | [`ProximalNewton`] |
//! | `lemke`, `bimatrix`, `dictionary`, `dense_lu`, `twofold` | [`Lemke`], for unsymmetric problems |
//! | `friction` | [`Modes`], for rows bounded by friction or constants; [`Jump`] |
//! | `qp` | `Qp`, feature `qp` (default; on wasm it needs wasm-bindgen): clarabel with a polish |
//! | `auto`, `islands` | [`Auto`] |
//! | `active_rows` | [`ActiveRows`]: a fixed set of rows as equations, solved repeatedly; [`TurnedRows`]: some of them slip |
//! | `row`, `impact` | [`Impact`]: impulses of an impact by an [`ImpactLaw`] |
//! | `warm` | [`WarmStart`]: carrying an answer over to the next step |
//! | `json` | feature `json`: problems and answers as files |

#![forbid(unsafe_code)]
// Units such as \[N\] are escaped in the docs of this crate, so that all other names in brackets are links.
#![warn(rustdoc::broken_intra_doc_links)]

mod active_rows;
mod auto;
mod bimatrix;
mod body_factor;
mod certificate;
mod check;
mod closed_rows;
mod crossover;
mod dense_lu;
mod dependent;
mod descent;
mod dictionary;
mod dual_active_set;
mod entries;
mod error;
mod exchanges;
mod friction;
mod impact;
mod interior_point;
mod islands;
#[cfg(feature = "json")]
mod json;
mod kind;
mod least_norm;
mod lemke;
mod line_search;
mod matrix;
mod order;
mod problem;
mod proximal_newton;
#[cfg(feature = "qp")]
mod qp;
mod raised;
mod row;
mod settings;
mod skyline;
mod solution;
mod solver;
mod spread;
mod start;
mod system;
#[cfg(test)]
mod test_problems;
mod twofold;
mod warm;
mod words;

pub use active_rows::{ActiveRows, HeldBody, ThirdSide, TurnedRows};
pub use auto::Auto;
pub use check::Residuals;
pub use dual_active_set::DualActiveSet;
pub use error::{Infeasibility, ProblemError, SettingsError, SolveError};
pub use friction::{Jump, JumpError, Modes};
pub use halfgap_collision as collision;
pub use impact::{FrictionRow, Impact, ImpactError, ImpactLaw, ImpactOrder, Restitution};
#[cfg(feature = "json")]
pub use json::{
    BoundsField, ContactFile, Expected, FileError, FrictionField, MatrixField, RowsField, SolutionFile,
};
pub use kind::RowKind;
pub use lemke::Lemke;
pub use problem::{ContactKey, InverseInertia, Problem, ProblemBody, Row};
pub use proximal_newton::ProximalNewton;
#[cfg(feature = "qp")]
pub use qp::Qp;
pub use row::{CollisionRow, CollisionThird};
pub use settings::{Contradiction, ForceSelection, Settings};
pub use solution::Solution;
pub use solver::{Method, Solver};
pub use warm::{Earlier, WarmStart};
