//! The trait of a solver, and the names of the methods.

use std::fmt;

use crate::error::SolveError;
use crate::problem::Problem;
use crate::solution::Solution;
use crate::warm::WarmStart;

/// A method that solves contact problems. Callers can implement it for methods of their own.
///
/// A solver owns its buffers, so that a later solve of a problem of known size need not allocate.
///
/// # Examples
///
/// Projected Gauss-Seidel, sweep by sweep over the rows; it keeps the motions v = M⁻¹ Jᵀ f and needs no A.
///
/// ```
/// use halfgap_contact::{
///     DualActiveSet, InverseInertia, Method, Problem, Residuals, Row, Settings, Solution, SolveError, Solver, WarmStart,
/// };
///
/// struct GaussSeidel;
///
/// impl Solver for GaussSeidel {
///     fn method(&self) -> Method {
///         Method::Other
///     }
///
///     fn solve(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError> {
///         self.solve_from(problem, &WarmStart::new(), solution)
///     }
///
///     fn solve_from(
///         &mut self,
///         problem: &Problem,
///         start: &WarmStart,
///         solution: &mut Solution,
///     ) -> Result<(), SolveError> {
///         let method = self.method();
///         let Some(weights) = problem.inverse_mass() else {
///             return Err(SolveError::NotApplicable { method, reason: "rows of bodies" });
///         };
///         let mut motion = vec![0.0; weights.len()];
///         let push = |row: usize, force: f64, motion: &mut [f64]| {
///             let (columns, values) = problem.row(row);
///             columns.iter().zip(values).for_each(|(&k, v)| motion[k] += weights[k] * v * force);
///         };
///         let rows = 0..problem.len();
///         let mut force: Vec<_> =
///             rows.clone().map(|row| start.of_row(problem, row).map_or(0.0, |earlier| earlier.force)).collect();
///         rows.clone().for_each(|row| push(row, force[row], &mut motion));
///         for _ in 0..200 {
///             for row in rows.clone() {
///                 let (columns, values) = problem.row(row);
///                 let entries = || columns.iter().zip(values);
///                 let square: f64 = entries().map(|(&k, v)| v * v * weights[k]).sum();
///                 let a = problem.offset()[row] + entries().map(|(&k, v)| v * motion[k]).sum::<f64>();
///                 let wanted = force[row] - a / square;
///                 let wanted = if problem.bilateral()[row] { wanted } else { wanted.max(0.0) };
///                 push(row, wanted - force[row], &mut motion);
///                 force[row] = wanted;
///             }
///         }
///         let residuals = Residuals::of(problem, &force);
///         (solution.force, solution.residuals, solution.method) = (force, residuals, method);
///         if residuals.accepted(&Settings { natural_residual: 1e-9, ..Settings::default() }, 0.0) {
///             Ok(())
///         } else {
///             Err(SolveError::Unsolved { method, residuals, iterations: 200 })
///         }
///     }
/// }
///
/// // Two blocks of 1 kg on each other: the lower contact carries both.
/// let mut problem = Problem::new();
/// let [lower, upper] = [(); 2].map(|()| {
///     problem.add_body(InverseInertia { inverse_mass: 1.0, inverse_moment: 0.0 }).expect("a fine inertia")
/// });
/// problem.add_row(&Row::new(lower, [0.0, 1.0, 0.0], -9.81))?;
/// problem.add_row(&Row::new(upper, [0.0, 1.0, 0.0], 0.0).against(lower, [0.0, -1.0, 0.0]))?;
/// let (mut own, mut ours) = (Solution::new(), Solution::new());
/// GaussSeidel.solve(&problem, &mut own)?;
/// DualActiveSet::default().solve(&problem, &mut ours)?;
/// assert!((own.force[0] - 2.0 * 9.81).abs() < 1e-8 && (own.force[0] - ours.force[0]).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Solver {
    /// The name of the method.
    fn method(&self) -> Method;

    /// Solves `problem` without an earlier answer. On an error `solution` holds no answer.
    ///
    /// # Errors
    ///
    /// [`SolveError`]: the problem is infeasible, the method does not apply, or its answer failed the check.
    fn solve(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError>;

    /// Solves `problem` starting from an earlier answer. The default implementation ignores `start`.
    ///
    /// # Errors
    ///
    /// Those of [`solve`](Self::solve).
    fn solve_from(
        &mut self,
        problem: &Problem,
        start: &WarmStart,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        let _ = start;
        self.solve(problem, solution)
    }
}

/// Names of the methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Method {
    /// Automatic choice by size and structure; in a solution, islands solved by different methods.
    Auto,
    /// Dual active set with an updated factor.
    DualActiveSet,
    /// Proximal augmented Lagrangian with semismooth Newton steps in body space.
    ProximalNewton,
    /// Interior-point quadratic programming in body space, polished.
    Qp,
    /// Lemke's pivoting method.
    Lemke,
    /// Newton's method on modes of friction.
    Modes,
    /// A method from outside this crate.
    Other,
}

impl Method {
    /// True if this build has the method: quadratic programming takes the feature `qp`.
    #[must_use]
    #[inline]
    pub fn is_built(self) -> bool {
        self != Method::Qp || cfg!(feature = "qp")
    }

    /// The name used on the command line and in files.
    #[must_use]
    #[inline]
    pub fn name(self) -> &'static str {
        match self {
            Method::Auto => "auto",
            Method::DualActiveSet => "dual_active_set",
            Method::ProximalNewton => "proximal_newton",
            Method::Qp => "qp",
            Method::Lemke => "lemke",
            Method::Modes => "modes",
            Method::Other => "other",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
