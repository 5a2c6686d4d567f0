//! Contact forces and impulses: complementarity problems, solved and checked.
//!
//! Rows in, forces out: with A = J M⁻¹ Jᵀ, find a = A f + b with f ≥ 0, a ≥ 0, fᵀa = 0 on unilateral rows (contacts)
//! and a = 0 on bilateral ones (connectors).
//!
//! *Invariant*: this crate knows no shapes, no time stepping and no scenes. Every answer is checked in the original
//! data before it is returned; every iteration has a cap; the same input gives the same bits.

mod auto;
mod body_factor;
mod check;
mod closed_rows;
mod dependent;
mod dictionary;
mod dual_active_set;
mod error;
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
mod settings;
mod skyline;
mod solution;
mod solver;
mod start;
mod system;
mod warm;

pub use auto::Auto;
pub use check::Residuals;
pub use dual_active_set::DualActiveSet;
pub use error::{Infeasibility, ProblemError, SettingsError, SolveError};
#[cfg(feature = "json")]
pub use json::{ContactFile, Expected, FileError, MatrixField, RowsField, SolutionFile};
pub use lemke::Lemke;
pub use problem::{BodyId, ContactKey, Inertia, Problem, Row};
pub use proximal_newton::ProximalNewton;
#[cfg(feature = "qp")]
pub use qp::Qp;
pub use settings::{Contradiction, ForceSelection, Settings};
pub use solution::Solution;
pub use solver::{Method, Solver};
pub use warm::WarmStart;
