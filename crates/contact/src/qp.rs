//! The contact problem as a quadratic program in body space, solved by clarabel.
//!
//! min ½|u|² subject to Ĵ u + b̂ ≥ 0 (= 0 on bilateral rows) in the scaled quantities of [`System`]; the multipliers
//! are the forces. In this form the objective is strictly convex however redundant the contacts are, unlike that of the
//! same problem in the forces. An A given by its entries is factored first, Â = Ĵ Ĵᵀ (Cholesky with diagonal pivoting).
//! The interior-point answer has an error of some 1e-4 to 1e-12, so its active set only starts the pivoting method,
//! which ends at an exact answer. Source: P. Goulart, Y. Chen, "Clarabel: An interior-point solver for conic programs
//! with quadratic objectives", arXiv 2405.12762, 2024.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

use crate::dual_active_set::DualActiveSet;
use crate::error::{SettingsError, SolveError};
use crate::problem::Problem;
use crate::settings::Settings;
use crate::solution::Solution;
use crate::solver::{Method, Solver};
use crate::start::Start;
use crate::system::System;
use crate::words;

/// Largest number of rows of a matrix A that is factored to get rows J, which is dense work.
const FACTORED: usize = 200;

/// Quadratic programming in body space by clarabel, with an active-set polish, for symmetric problems.
///
/// Minimises ½|u|² subject to Ĵ u + b̂ ≥ 0 (= 0 on bilateral rows) over the scaled motion u of the bodies. A problem
/// given by the entries of A may have at most 200 rows. Source: P. Goulart, Y. Chen, "Clarabel: An interior-point
/// solver for conic programs with quadratic objectives", arXiv 2405.12762, 2024.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Qp {
    settings: Settings,
    system: System,
    polish: DualActiveSet,
    closed: Vec<bool>,
}

/// The result of the interior-point method.
struct Interior {
    multiplier: Vec<f64>,
    slack: Vec<f64>,
    iterations: usize,
}

impl Qp {
    /// Makes a solver with the given settings.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] names a setting that is not positive and finite.
    #[inline]
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        Ok(Qp { settings, polish: DualActiveSet::new(settings)?, ..Self::default() })
    }

    /// Runs clarabel. `None` if it refuses the problem or ends without an answer. Infeasible problems are left to the
    /// polish, which proves that they are.
    fn interior(&self, problem: &Problem) -> Option<Interior> {
        let (rows, columns) = self.system.rows_or_factor(self.settings.dependence);
        let n = problem.len();
        let order: Vec<usize> = (0..n)
            .filter(|&row| problem.bilateral[row])
            .chain((0..n).filter(|&row| !problem.bilateral[row]))
            .collect();
        let (mut i, mut j, mut v) = (Vec::new(), Vec::new(), Vec::new());
        for (at, &row) in order.iter().enumerate() {
            for &(k, value) in &rows[row] {
                i.push(at);
                j.push(k);
                v.push(-value);
            }
        }
        let constraints = CscMatrix::new_from_triplets(n, columns, i, j, v);
        let identity = CscMatrix::identity(columns);
        let right: Vec<f64> = order.iter().map(|&row| self.system.b[row] / self.system.scale).collect();
        let equations = problem.bilateral.iter().filter(|b| **b).count();
        let cones = [SupportedConeT::ZeroConeT(equations), SupportedConeT::NonnegativeConeT(n - equations)];
        let linear = vec![0.0; columns];
        let mut solver =
            DefaultSolver::new(&identity, &linear, &constraints, &right, &cones, self.options()).ok()?;
        solver.solve();
        let answer = match solver.solution.status {
            SolverStatus::Solved
            | SolverStatus::AlmostSolved
            | SolverStatus::MaxIterations
            | SolverStatus::NumericalError
            | SolverStatus::InsufficientProgress => &solver.solution,
            _ => return None,
        };
        let (mut multiplier, mut slack) = (vec![0.0; n], vec![0.0; n]);
        for (at, &row) in order.iter().enumerate() {
            multiplier[row] = answer.z[at];
            slack[row] = answer.s[at];
        }
        Some(Interior { multiplier, slack, iterations: answer.iterations as usize })
    }

    fn options(&self) -> DefaultSettings<f64> {
        DefaultSettings {
            verbose: false,
            max_threads: 1,
            tol_gap_abs: self.settings.interior_point,
            tol_gap_rel: self.settings.interior_point,
            tol_feas: self.settings.interior_point,
            direct_solve_method: "qdldl".to_owned(),
            ..DefaultSettings::default()
        }
    }
}

impl Solver for Qp {
    fn method(&self) -> Method {
        Method::Qp
    }

    fn solve(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError> {
        problem.require_symmetric(Method::Qp)?;
        if !problem.has_bodies() && problem.len() > FACTORED {
            let reason = words::TOO_LARGE;
            return Err(SolveError::NotApplicable { method: Method::Qp, reason });
        }
        self.system.load(problem);
        let interior = if problem.is_empty() { None } else { self.interior(problem) };
        self.closed.clear();
        let start = match &interior {
            Some(interior) => {
                let pairs = interior.multiplier.iter().zip(&interior.slack);
                self.closed.extend(pairs.map(|(force, acceleration)| force > acceleration));
                Start::Closed(&self.closed)
            }
            None => Start::Nothing,
        };
        let result = self.polish.run(problem, start, solution);
        solution.method = Method::Qp;
        solution.iterations += interior.map_or(0, |interior| interior.iterations);
        result
    }
}
