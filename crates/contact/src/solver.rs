//! What a solver is.

use std::fmt;

use crate::error::SolveError;
use crate::problem::Problem;
use crate::solution::Solution;
use crate::warm::WarmStart;

/// Solves contact problems; implement it to bring a method of your own.
///
/// A solver owns its buffers, so that solving again a problem of a size known already allocates nothing.
pub trait Solver {
    /// Which method this is.
    fn method(&self) -> Method;

    /// Solves `problem` from nothing. On an error `solution` holds no answer.
    ///
    /// # Errors
    ///
    /// [`SolveError`]: the problem is infeasible, the method does not apply, or its answer failed the check.
    fn solve(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError>;

    /// Solves `problem` starting from an earlier answer. A method that cannot use one solves from nothing.
    ///
    /// # Errors
    ///
    /// As [`solve`](Self::solve).
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

/// The methods this crate offers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// Chosen by size and structure.
    Auto,
    /// Dual active set with an updated factor.
    DualActiveSet,
    /// Proximal augmented Lagrangian with semismooth Newton steps in body space.
    ProximalNewton,
    /// Interior-point quadratic programming in body space, polished.
    Qp,
    /// Lemke's pivoting method.
    Lemke,
    /// A method from outside this crate.
    Other,
}

impl Method {
    /// The name used on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Method::Auto => "auto",
            Method::DualActiveSet => "dual_active_set",
            Method::ProximalNewton => "proximal_newton",
            Method::Qp => "qp",
            Method::Lemke => "lemke",
            Method::Other => "other",
        }
    }

    /// The method of that name, if this crate offers it.
    pub fn from_name(name: &str) -> Option<Self> {
        let methods =
            [Method::Auto, Method::DualActiveSet, Method::ProximalNewton, Method::Qp, Method::Lemke];
        methods.into_iter().find(|method| method.name() == name)
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
