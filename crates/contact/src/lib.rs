//! Contact forces and impulses: complementarity problems, solved and checked.
//!
//! Rows in, forces out: with A = J M⁻¹ Jᵀ, find a = A f + b with f ≥ 0, a ≥ 0, fᵀa = 0 on unilateral rows (contacts)
//! and a = 0 on bilateral ones (connectors). [`Problem`] holds the rows, [`Solution`] the forces with the evidence that
//! they are right, [`Auto`] chooses a method; each method is also a [`Solver`] of its own, and so can yours be.
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
//! *Invariant*: this crate knows no shapes, no time stepping and no scenes. Every answer is checked in the
//! original data before it is returned; every iteration has a cap; the same input gives a new solver the same
//! bits, and one that has solved other problems before the same answer but for rounding; a warm solve of a
//! size met before allocates nothing.
//!
//! | module | what |
//! |---|---|
//! | `problem`, `matrix` | rows of bodies, or the entries of A; checked when built |
//! | `solution`, `check` | the answer and its residuals |
//! | `settings`, `error`, `solver` | the numbers that methods decide by, what can go wrong, what a method is |
//! | `system`, `entries` | the problem scaled to a unit diagonal, which the symmetric methods work on |
//! | `dual_active_set`, `start`, `descent`, `spread`, `crossover`, `exchanges`, `closed_rows`, `skyline`, `order`, `dependent`, `raised`, `least_norm` | [`DualActiveSet`] |
//! | `proximal_newton`, `interior_point`, `body_factor`, `line_search` | [`ProximalNewton`] |
//! | `lemke`, `bimatrix`, `dictionary`, `dense_lu`, `twofold` | [`Lemke`], for unsymmetric problems |
//! | `qp` | `Qp`, feature `qp` (default; on wasm it wants wasm-bindgen): clarabel with a polish |
//! | `auto`, `islands` | [`Auto`] |
//! | `held_rows` | [`HeldRows`]: a fixed set of rows as equations, solved again and again |
//! | `row`, `impact` | [`Impact`]: impulses of an impact by an [`ImpactLaw`] |
//! | `warm` | [`WarmStart`]: carrying an answer over to the next step |
//! | `json` | feature `json`: problems and answers as files |

#![forbid(unsafe_code)]
// Units are escaped in this crate, so that what is left in brackets is a link.
#![warn(rustdoc::broken_intra_doc_links)]

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
mod held_rows;
mod impact;
mod interior_point;
mod islands;
#[cfg(feature = "json")]
mod json;
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

pub use auto::Auto;
pub use check::Residuals;
pub use dual_active_set::DualActiveSet;
pub use error::{Infeasibility, ProblemError, SettingsError, SolveError};
pub use halfgap_collision as collision;
pub use held_rows::HeldRows;
pub use impact::{Impact, ImpactError, ImpactLaw, ImpactOrder};
#[cfg(feature = "json")]
pub use json::{ContactFile, Expected, FileError, MatrixField, RowsField, SolutionFile};
pub use lemke::Lemke;
pub use problem::{ContactKey, InverseInertia, Problem, ProblemBody, Row};
pub use proximal_newton::ProximalNewton;
#[cfg(feature = "qp")]
pub use qp::Qp;
pub use row::CollisionRow;
pub use settings::{Contradiction, ForceSelection, Settings};
pub use solution::Solution;
pub use solver::{Method, Solver};
pub use warm::{Earlier, WarmStart};
