//! Lemke's method for general linear complementarity problems, such as contacts with friction.
//!
//! Follows C. Lemke, "Bimatrix equilibrium points and mathematical programming", Management Science 11, 1965,
//! with lexicographic ties (see [`Dictionary`]) and a perturbed b, after scaling to a unit diagonal; the
//! final basis is solved again from the original data, which undoes the perturbation and the digits that a
//! dictionary loses with every pivot, and corrected where it is wrong by that. Ends either at a solution or
//! on a ray; a ray that is a Farkas certificate proves that the inequalities alone have no solution, any
//! other proves nothing.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, Par};

use crate::check::Checker;
use crate::dictionary::Dictionary;
use crate::error::{Infeasibility, SettingsError, SolveError};
use crate::matrix::{Matrix, SparseMatrix};
use crate::problem::Problem;
use crate::settings::Settings;
use crate::solution::Solution;
use crate::solver::{Method, Solver};

/// Part of its own largest component by which a ray may violate the inequalities of Farkas' lemma: rounding of a
/// dictionary after many pivots.
const RAY: f64 = 1e-9;

/// Growth that any solution would have, by a ray that is believed: of masses as far apart as 1e8 rounding
/// leaves rays that are none.
const SURE: f64 = 1e9;

/// Sizes of the perturbation of b, in units of the scale, for one attempt each. On large redundant problems the exact
/// rule for ties drowns in rounding; a small perturbation separates them, and its basis mostly serves b itself.
const PERTURBATIONS: [f64; 4] = [1e-8, 0.0, 1e-6, 1e-4];

/// How many rows of a final basis are changed, one by one, where the original data say that rounding chose
/// the wrong one.
const CORRECTIONS: usize = 8;

/// Lemke's method with its buffers.
#[derive(Clone, Debug, Default)]
pub struct Lemke {
    settings: Settings,
    dictionary: Dictionary,
    /// A as entries; scale of each variable.
    matrix: SparseMatrix,
    scale: Vec<f64>,
    checker: Checker,
    pivots: usize,
}

/// How the pivoting ended.
enum End {
    /// At a complementary basis.
    Solved,
    /// On the ray of this column.
    Ray(usize),
    /// At the cap.
    Stopped,
}

impl Lemke {
    /// A solver with these settings.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] names a number that is not usable.
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Lemke { settings, ..Self::default() })
    }

    fn load(&mut self, problem: &Problem, perturbation: f64) {
        self.matrix = match &problem.matrix {
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => matrix.clone(),
            Matrix::Bodies(bodies) => bodies.product(),
        };
        self.find_scale();
        let n = problem.len();
        let mut q: Vec<f64> = problem.offset.iter().zip(&self.scale).map(|(b, s)| b * s).collect();
        let largest = q.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        if largest > 0.0 {
            q.iter_mut().for_each(|v| *v /= largest);
        }
        perturb(&mut q, perturbation);
        self.dictionary.reset(&q, &problem.bilateral);
        for i in 0..n {
            let (columns, values) = self.matrix.row(i);
            for (&j, &v) in columns.iter().zip(values) {
                self.dictionary.set(i, j, v * self.scale[i] * self.scale[j]);
            }
        }
    }

    /// 1/sqrt(A_ii); for a row without a diagonal, such as the cone row of a friction contact, what makes its largest
    /// scaled entry 1.
    fn find_scale(&mut self) {
        let n = self.matrix.rows();
        let diagonal = (0..n).map(|i| self.matrix.entry(i, i));
        self.scale.clear();
        self.scale.extend(diagonal.map(|d| if d > 0.0 { 1.0 / d.sqrt() } else { 0.0 }));
        for i in 0..n {
            if self.scale[i] == 0.0 {
                let (columns, values) = self.matrix.row(i);
                let largest =
                    columns.iter().zip(values).fold(0.0, |m: f64, (&j, v)| m.max(v.abs() * self.scale[j]));
                self.scale[i] = if largest > 0.0 { 1.0 / largest } else { 1.0 };
            }
        }
    }

    fn pivot(&mut self) -> End {
        let dictionary = &mut self.dictionary;
        dictionary.eliminate_bilateral();
        let Some(first) = dictionary.most_negative() else { return End::Solved };
        let artificial = dictionary.artificial();
        let mut leaving = dictionary.variable(first);
        let Some(column) = dictionary.column(artificial) else { return End::Stopped };
        dictionary.pivot(first, column);
        for _ in 0..self.settings.pivot_cap(self.scale.len()) {
            self.pivots += 1;
            let entering = dictionary.complement(leaving);
            let Some(column) = dictionary.column(entering) else { return End::Stopped };
            let Some(row) = dictionary.blocking(column) else { return End::Ray(column) };
            leaving = dictionary.pivot(row, column);
            if leaving == artificial {
                return End::Solved;
            }
        }
        End::Stopped
    }

    /// Solves again with the final basis in the original data, and corrects it where that shows that a row
    /// should have been in it or not: of what is nearly zero rounding has decided. True if the answer is
    /// accepted.
    fn polish(&mut self, problem: &Problem, solution: &mut Solution) -> bool {
        let n = problem.len();
        let basic = self.dictionary.basic_rows().filter(|&(v, _)| v >= n && v < 2 * n).map(|(v, _)| v - n);
        solution.active.extend(basic);
        solution.active.sort_unstable();
        for _ in 0..=CORRECTIONS {
            let pulling = self.solve_basis(problem, solution);
            if self.is_accepted(problem, solution) {
                return true;
            }
            let closing = self.fastest_closing(problem, solution);
            let Some((wrong, _)) =
                [pulling, closing].into_iter().flatten().max_by(|p, q| p.1.total_cmp(&q.1))
            else {
                return false;
            };
            match solution.active.binary_search(&wrong) {
                Ok(place) => drop(solution.active.remove(place)),
                Err(place) => solution.active.insert(place, wrong),
            }
        }
        false
    }

    fn is_accepted(&mut self, problem: &Problem, solution: &mut Solution) -> bool {
        solution.residuals = self.checker.check(problem, &solution.force, &mut solution.acceleration);
        solution.residuals.accepted(&self.settings, 0.0)
    }

    /// The row without force that closes fastest, and how fast, as part of the largest offset.
    fn fastest_closing(&self, problem: &Problem, solution: &Solution) -> Option<(usize, f64)> {
        let scaled = |i: usize, value: f64| value * self.scale[i];
        let largest = (0..problem.len()).map(|i| scaled(i, problem.offset[i]).abs()).fold(0.0, f64::max);
        let free = (0..problem.len())
            .filter(|i| !problem.bilateral[*i] && solution.active.binary_search(i).is_err());
        let closing = free.map(|i| (i, -scaled(i, solution.acceleration[i]) / largest));
        closing.filter(|row| row.1 > 0.0).max_by(|p, q| p.1.total_cmp(&q.1))
    }

    /// Solves A_CC f_C = -b_C of the basis in the original data, with refinement. The row that pulls most,
    /// and how much, as part of the largest force.
    fn solve_basis(&self, problem: &Problem, solution: &mut Solution) -> Option<(usize, f64)> {
        let active = &solution.active;
        let mut place = vec![usize::MAX; problem.len()];
        active.iter().enumerate().for_each(|(at, &row)| place[row] = at);
        let mut basis = Mat::<f64>::zeros(active.len(), active.len());
        for (at, &i) in active.iter().enumerate() {
            let (columns, values) = self.matrix.row(i);
            for (&j, &v) in columns.iter().zip(values).filter(|(j, _)| place[**j] != usize::MAX) {
                basis[(at, place[j])] = v * self.scale[i] * self.scale[j];
            }
        }
        let right =
            Mat::from_fn(active.len(), 1, |at, _| -problem.offset[active[at]] * self.scale[active[at]]);
        let factor = PartialPivLu::new(basis.as_ref());
        let mut force = factor.solve(&right);
        for _ in 0..self.settings.refinements {
            let rest = &right - &basis * &force;
            force += factor.solve(&rest);
        }
        solution.force.fill(0.0);
        for (at, &i) in active.iter().enumerate() {
            let value = force[(at, 0)] * self.scale[i];
            solution.force[i] = if problem.bilateral[i] { value } else { value.max(0.0) };
        }
        let largest = (0..active.len()).map(|at| force[(at, 0)].abs()).fold(0.0, f64::max);
        let unilateral = active.iter().enumerate().filter(|&(_, &i)| !problem.bilateral[i]);
        let pulling = unilateral.map(|(at, &i)| (i, -force[(at, 0)] / largest));
        pulling.filter(|row| row.1 > 0.0).max_by(|p, q| p.1.total_cmp(&q.1))
    }

    /// The ray as a certificate, if it is one: z ≥ 0, Aᵀz ≤ 0 (= 0 on bilateral rows), bᵀz < 0.
    fn certificate(&self, problem: &Problem, column: usize) -> Option<Infeasibility> {
        let n = problem.len();
        let mut direction = vec![0.0; n];
        for (variable, change) in self.dictionary.ray(column) {
            if (n..2 * n).contains(&variable) {
                direction[variable - n] = change;
            }
        }
        if let Some(entering) = self.dictionary.entering(column).checked_sub(n).filter(|&i| i < n) {
            direction[entering] = 1.0;
        }
        // What rounding has made negative is nothing; if it was more, the image tells.
        for (z, _) in direction.iter_mut().zip(&problem.bilateral).filter(|(_, is_bilateral)| !**is_bilateral)
        {
            *z = z.max(0.0);
        }
        let largest = direction.iter().fold(0.0, |m: f64, z| m.max(z.abs()));
        let mut image = vec![0.0; n];
        let (mut worth, mut square, mut scale) = (0.0, 0.0, 0.0_f64);
        for (i, &z) in direction.iter().enumerate() {
            let (columns, values) = self.matrix.row(i);
            for (&j, &v) in columns.iter().zip(values) {
                image[j] += v * self.scale[i] * self.scale[j] * z;
            }
            let b = problem.offset[i] * self.scale[i];
            worth += b * z;
            square += z * z;
            scale = scale.max(b.abs());
        }
        let violates = |i: usize| {
            let outside = if problem.bilateral[i] { image[i].abs() } else { image[i] };
            outside > RAY * largest
        };
        if worth >= -RAY * scale * largest || (0..n).any(violates) {
            return None;
        }
        let leakage = image.iter().fold(0.0, |m: f64, v| m.max(*v)) / largest;
        let row = (0..n).max_by(|&i, &j| direction[i].total_cmp(&direction[j]))?;
        direction.iter_mut().zip(&self.scale).for_each(|(z, s)| *z *= s);
        Some(Infeasibility { row, direction, contradiction: -worth * largest / square / scale, leakage })
    }
}

impl Solver for Lemke {
    fn method(&self) -> Method {
        Method::Lemke
    }

    fn solve(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError> {
        // One thread, so that sums keep their order.
        faer::set_global_parallelism(Par::Seq);
        self.pivots = 0;
        for perturbation in PERTURBATIONS {
            solution.reset(problem.len(), Method::Lemke);
            self.load(problem, perturbation);
            let end = self.pivot();
            if let End::Ray(column) = end
                && let Some(proof) = self.certificate(problem, column)
                && proof.least_growth() >= SURE
            {
                return Err(SolveError::Infeasible(Box::new(proof)));
            }
            solution.iterations = self.pivots;
            let is_solved = match end {
                End::Solved => self.polish(problem, solution),
                End::Ray(_) | End::Stopped => self.is_accepted(problem, solution),
            };
            if is_solved {
                return Ok(());
            }
        }
        Err(SolveError::Unsolved {
            method: Method::Lemke,
            residuals: solution.residuals,
            iterations: self.pivots,
        })
    }
}

/// Adds to every entry a different positive amount below `size`, the fractional parts of multiples of the golden
/// ratio.
fn perturb(q: &mut [f64], size: f64) {
    let golden = f64::midpoint(5.0_f64.sqrt(), 1.0);
    for (i, value) in q.iter_mut().enumerate() {
        *value += size * ((i + 1) as f64 * golden).fract();
    }
}
