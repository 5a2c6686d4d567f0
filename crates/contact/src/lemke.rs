//! Lemke's method for general linear complementarity problems, such as contacts with friction.
//!
//! Follows C. Lemke, "Bimatrix equilibrium points and mathematical programming", Management Science 11, 1965, with
//! lexicographic ties (see [`Dictionary`]) and a perturbed b, after scaling to a unit diagonal. The final basis is
//! solved again from the original data, which removes the perturbation and the loss of digits by pivots, and is
//! corrected where it then proves wrong. The path ends at a solution or on a ray. A ray that is a Farkas certificate
//! proves that the inequalities alone have no solution; any other ray proves nothing. With the artificial variable,
//! bimatrix games would end on a ray at once; they take the path of C. Lemke and J. Howson, "Equilibrium points of
//! bimatrix games", SIAM Journal 12, 1964. A problem that is not solved so is tried again with twice as many digits, if
//! it is not large.

use faer::Mat;

use crate::bimatrix::is_bimatrix_game;
use crate::check::{Checker, Residuals};
use crate::dense_lu::DenseLu;
use crate::dependent::{dot, make_orthogonal};
use crate::dictionary::Dictionary;
use crate::error::{Infeasibility, SettingsError, SolveError};
use crate::friction::PlainForm;
use crate::matrix::{Matrix, SparseMatrix};
use crate::problem::{Problem, pushing};
use crate::settings::Settings;
use crate::solution::Solution;
use crate::solver::{Method, Solver};
use crate::twofold::{Number, Twofold};

/// Least growth [-] of any solution by which a ray counts as a proof: with masses as far apart as 1e8, rounding leaves
/// rays that are none.
const SURE: f64 = 1e9;

/// Sizes of the perturbation of b, in units of the scale, one per attempt. On large redundant problems rounding defeats
/// the exact rule for ties; a small perturbation separates them, and its final basis mostly serves b itself.
const PERTURBATIONS: [f64; 4] = [1e-8, 0.0, 1e-6, 1e-4];

/// Largest number of rows of a problem that is tried with twice as many digits.
const TWOFOLD_ROWS: usize = 128;

/// Least cap on pivots, so that it is not too low for small problems: the worst take two to the power of their number
/// of rows.
const LEAST_CAP: usize = 2000;

/// Cap on the sweeps in which rows without a diagonal are scaled.
const SWEEPS: usize = 20;
/// Range of the largest scaled entry of such rows in which the scaling is even enough.
const EVEN: std::ops::RangeInclusive<f64> = 0.5..=2.0;

/// Largest contradiction between bilateral rows that is rounding, in units of the scale.
const AGREED: f64 = 1e-13;

/// Cap on the number of rows of a final basis that are changed, one by one, where the original data show that rounding
/// chose the wrong one.
const CORRECTIONS: usize = 8;

/// Lemke's pivoting method for general linear complementarity problems, such as contacts with friction.
///
/// A solution is not always found: the path may end on a ray, which proves infeasibility only if it is a Farkas
/// certificate. The tableau is dense; a pivot costs n². Sources: C. Lemke, Management Science 11, 1965; for bimatrix
/// games C. Lemke, J. Howson, SIAM Journal 12, 1964.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Lemke {
    settings: Settings,
    dictionary: Dictionary<f64>,
    exact: Dictionary<Twofold>,
    /// The entries of A, and the scale of each variable.
    matrix: SparseMatrix,
    scale: Vec<f64>,
    /// True if the problem is that of a bimatrix game.
    is_game: bool,
    checker: Checker,
    pivots: usize,
    /// Amounts taken off the scaled b because bilateral rows contradict each other slightly; empty if none were.
    shift: Vec<f64>,
    /// True if the last certificate was found with twice as many digits.
    pub(crate) is_certain: bool,
}

/// The end of the pivoting.
enum End {
    /// At a complementary basis.
    Solved,
    /// On the ray of this column.
    Ray(usize),
    /// At the cap.
    Stopped,
    /// At bilateral rows that contradict each other.
    Contradiction(Box<Infeasibility>),
}

impl Lemke {
    /// Makes a solver with the given settings.
    ///
    /// # Errors
    ///
    /// [`SettingsError`] names a setting that is not positive and finite.
    #[inline]
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Lemke { settings, ..Self::default() })
    }

    /// Accepts answers with a natural residual up to this.
    pub(crate) fn set_natural_residual(&mut self, natural_residual: f64) {
        self.settings.natural_residual = natural_residual;
    }

    /// Notes the entries of A, and scales them.
    fn prepare(&mut self, problem: &Problem) {
        self.matrix = match &problem.matrix {
            Matrix::Symmetric(matrix) | Matrix::General(matrix) => matrix.clone(),
            Matrix::Bodies(bodies) => bodies.product(),
        };
        self.is_game = is_bimatrix_game(&self.matrix, problem);
        self.find_scale();
    }

    /// Sets the scale of each row: 1/sqrt(A_ii); rows without a diagonal, such as the cone row of a friction contact,
    /// are scaled until the largest entry in each and in its column is about 1 (D. Ruiz, "A scaling algorithm to
    /// equilibrate both rows and columns norms in matrices", report RAL-TR-2001-034, 2001).
    fn find_scale(&mut self) {
        let n = self.matrix.rows();
        let diagonals: Vec<f64> = (0..n).map(|i| self.matrix.entry(i, i)).collect();
        self.scale.clear();
        self.scale.extend(diagonals.iter().map(|d| if *d > 0.0 { 1.0 / d.sqrt() } else { 1.0 }));
        if diagonals.iter().all(|d| *d > 0.0) {
            return;
        }
        let mut largest = vec![0.0; n];
        for _ in 0..SWEEPS {
            largest.fill(0.0);
            for i in 0..n {
                let (columns, values) = self.matrix.row(i);
                for (&j, &v) in columns.iter().zip(values) {
                    let size = (v * self.scale[i] * self.scale[j]).abs();
                    largest[i] = f64::max(largest[i], size);
                    largest[j] = f64::max(largest[j], size);
                }
            }
            let mut is_even = true;
            let scales = self.scale.iter_mut().zip(&largest).zip(&diagonals);
            for ((scale, &largest), _) in scales.filter(|((_, largest), d)| **d <= 0.0 && **largest > 0.0) {
                *scale /= largest.sqrt();
                is_even &= EVEN.contains(&largest);
            }
            if is_even {
                return;
            }
        }
    }

    /// Follows the path of a problem to its end, in the arithmetic of the given dictionary.
    fn follow<T: Number>(
        &mut self,
        problem: &Problem,
        perturbation: f64,
        dictionary: &mut Dictionary<T>,
    ) -> End {
        self.shift.clear();
        self.load(problem, perturbation, dictionary);
        dictionary.eliminate_bilateral();
        match self.reconcile(problem, dictionary) {
            Some(proof) => return End::Contradiction(Box::new(proof)),
            None if self.shift.is_empty() => {}
            None => {
                self.load(problem, perturbation, dictionary);
                dictionary.eliminate_bilateral();
            }
        }
        if self.is_game {
            return self.follow_game(problem, dictionary);
        }
        let artificial = dictionary.artificial();
        let Some(column) = dictionary.column(artificial) else { return End::Stopped };
        let Some(first) = dictionary.last_covered(column) else { return End::Solved };
        let leaving = dictionary.pivot(first, column);
        self.pivot_on(problem, dictionary, leaving, &[artificial])
    }

    /// Follows the path of Lemke and Howson: from the strategy of the first row alone, the best answer to it and the
    /// best answer to that, until the condition of the first row holds as well.
    fn follow_game<T: Number>(&mut self, problem: &Problem, dictionary: &mut Dictionary<T>) -> End {
        let (own, mut leaving) = (0, 0);
        for _ in 0..2 {
            self.pivots += 1;
            let Some(column) = dictionary.column(dictionary.complement(leaving)) else { return End::Stopped };
            let Some(row) = dictionary.last_covered(column) else { return End::Stopped };
            leaving = dictionary.pivot(row, column);
        }
        let ends = [own, dictionary.complement(own)];
        self.pivot_on(problem, dictionary, leaving, &ends)
    }

    /// Pivots: the complement of the variable that left enters, until one of the variables `ends` has left.
    fn pivot_on<T: Number>(
        &mut self,
        problem: &Problem,
        dictionary: &mut Dictionary<T>,
        mut leaving: usize,
        ends: &[usize],
    ) -> End {
        for _ in 0..self.settings.pivot_cap(problem.len()).max(LEAST_CAP) {
            if ends.contains(&leaving) {
                return End::Solved;
            }
            self.pivots += 1;
            let entering = dictionary.complement(leaving);
            let Some(column) = dictionary.column(entering) else { return End::Stopped };
            let Some(row) = dictionary.blocking(column) else { return End::Ray(column) };
            leaving = dictionary.pivot(row, column);
        }
        End::Stopped
    }

    fn load<T: Number>(&self, problem: &Problem, perturbation: f64, dictionary: &mut Dictionary<T>) {
        let mut q = self.scaled_offset(problem);
        let unilateral = q.iter_mut().zip(perturbations(perturbation)).zip(&problem.bilateral);
        for ((b, more), _) in unilateral.filter(|(_, is_bilateral)| !**is_bilateral) {
            *b = *b + T::from(more);
        }
        dictionary.reset(&q, &problem.bilateral);
        self.visit(problem, |i, j, value| dictionary.add(i, j, value));
    }

    /// The scaled b in units of the largest one, less the contradictions of bilateral rows.
    fn scaled_offset<T: Number>(&self, problem: &Problem) -> Vec<T> {
        let size = T::from(self.largest_offset(problem));
        let scaled = problem.offset.iter().zip(&self.scale).map(|(&b, &s)| T::from(b) * T::from(s) / size);
        let shift = self.shift.iter().copied().chain(std::iter::repeat(0.0));
        scaled.zip(shift).map(|(b, shift)| b - T::from(shift)).collect()
    }

    /// Makes dependent bilateral rows agree by least squares, or returns the proof that they contradict each other by
    /// more than may be settled. Contradictions that are rounding are left.
    fn reconcile<T: Number>(
        &mut self,
        problem: &Problem,
        dictionary: &Dictionary<T>,
    ) -> Option<Infeasibility> {
        let q = self.scaled_offset::<T>(problem);
        let mut basis: Vec<Vec<T>> = Vec::new();
        let mut shift = vec![T::default(); problem.len()];
        for mut direction in dictionary.null_directions() {
            make_orthogonal(&mut direction, &basis);
            let factor = dot(&direction, &q) / dot(&direction, &direction);
            let largest = direction.iter().fold(0.0, |m: f64, z| m.max(z.abs().nearest()));
            let contradiction = factor.abs().nearest() * largest;
            if contradiction > self.settings.inconsistency {
                direction.iter_mut().for_each(|z| *z = -*z * factor);
                // A contradiction that involves other rows, or rows that depend on each other only nearly, proves
                // nothing.
                return self.prove(problem, &direction, SURE);
            }
            if contradiction > AGREED {
                shift.iter_mut().zip(&direction).for_each(|(sum, z)| *sum = *sum + factor * *z);
            }
            basis.push(direction);
        }
        if shift.iter().any(|part| *part != T::default()) {
            self.shift.extend(shift.iter().map(|part| part.nearest()));
        }
        None
    }

    /// Largest amount taken off b, in units of the scale.
    fn inconsistency(&self) -> f64 {
        self.shift.iter().fold(0.0, |most: f64, part| most.max(part.abs()))
    }

    /// The largest scaled b, or 1.
    fn largest_offset(&self, problem: &Problem) -> f64 {
        let scaled = problem.offset.iter().zip(&self.scale).map(|(b, s)| (b * s).abs());
        Some(scaled.fold(0.0, f64::max)).filter(|largest| *largest > 0.0).unwrap_or(1.0)
    }

    /// Calls `act` with row, column and value of terms that add up to the scaled entries of A.
    fn visit<T: Number>(&self, problem: &Problem, mut act: impl FnMut(usize, usize, T)) {
        let scale = |i: usize, j: usize| T::from(self.scale[i]) * T::from(self.scale[j]);
        if let Matrix::Bodies(bodies) = &problem.matrix {
            bodies.visit_terms(|i, j, [v, mass, w]| {
                act(i, j, T::from(v) * T::from(mass) * T::from(w) * scale(i, j));
            });
            return;
        }
        for i in 0..problem.len() {
            let (columns, values) = self.matrix.row(i);
            columns.iter().zip(values).for_each(|(&j, &v)| act(i, j, T::from(v) * scale(i, j)));
        }
    }

    /// Solves the plain form of a problem with friction.
    #[cold]
    fn solve_friction(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError> {
        let unsolved = |residuals, iterations| {
            Err(SolveError::Unsolved { method: Method::Lemke, residuals, iterations })
        };
        let Ok(form) = PlainForm::of(problem) else { return unsolved(Residuals::default(), 0) };
        let mut plain = Solution::new();
        self.solve(&form.problem, &mut plain).map_err(|error| form.error(error))?;
        solution.reset(problem.len(), Method::Lemke);
        form.forces(&plain.force, &mut solution.force);
        solution.active.extend((0..problem.len()).filter(|&row| solution.force[row] != 0.0));
        (solution.iterations, solution.inconsistency) = (plain.iterations, plain.inconsistency);
        solution.residuals = self.checker.check(problem, &solution.force, &mut solution.acceleration);
        if solution.residuals.accepted(&self.settings, solution.inconsistency) {
            return Ok(());
        }
        unsolved(solution.residuals, solution.iterations)
    }

    /// Solves a problem with twice as many digits at once. Returns whether there is an accepted answer, or the proof if
    /// it is certain that there is none.
    pub(crate) fn solve_twofold(
        &mut self,
        problem: &Problem,
        solution: &mut Solution,
    ) -> Result<bool, Infeasibility> {
        self.pivots = 0;
        self.prepare(problem);
        let outcome = self.solve_exactly(problem, solution);
        solution.iterations = self.pivots;
        outcome
    }

    /// Solves the loaded problem with twice as many digits, from the data as given: the error of a solution is then the
    /// rounding of its forces.
    fn solve_exactly(&mut self, problem: &Problem, solution: &mut Solution) -> Result<bool, Infeasibility> {
        solution.reset(problem.len(), Method::Lemke);
        let mut dictionary = std::mem::take(&mut self.exact);
        let end = self.follow(problem, 0.0, &mut dictionary);
        let outcome = match end {
            End::Solved => {
                let size = Twofold::from(self.largest_offset(problem));
                let basic = dictionary
                    .basic_rows()
                    .filter_map(|(v, value)| Some((v.checked_sub(problem.len())?, value)));
                for (row, value) in basic.filter(|&(row, _)| row < problem.len()) {
                    solution.force[row] = (value * size * Twofold::from(self.scale[row])).nearest();
                    solution.active.push(row);
                }
                solution.active.sort_unstable();
                Ok(self.is_accepted(problem, solution))
            }
            End::Ray(column) => {
                let proof = self.certificate(problem, &dictionary, column, self.settings.greatest_growth);
                proof.filter(|proof| proof.contradiction > self.settings.inconsistency).map_or(Ok(false), Err)
            }
            End::Contradiction(proof) => Err(*proof),
            End::Stopped => Ok(false),
        };
        self.exact = dictionary;
        outcome
    }

    /// Solves the final basis again in the original data, and corrects it where that shows that a row should be in it
    /// or not, as rounding decides for nearly zero variables. Returns whether the answer is accepted.
    fn polish(&mut self, problem: &Problem, solution: &mut Solution) -> bool {
        let n = problem.len();
        let basic = self.dictionary.basic_rows().filter(|(v, _)| (n..2 * n).contains(v)).map(|(v, _)| v - n);
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
        solution.inconsistency = self.inconsistency();
        solution.residuals = self.checker.check(problem, &solution.force, &mut solution.acceleration);
        solution.residuals.accepted(&self.settings, solution.inconsistency)
    }

    /// The row outside the basis that closes fastest, and its scaled closing acceleration as a fraction of the largest
    /// scaled offset.
    fn fastest_closing(&self, problem: &Problem, solution: &Solution) -> Option<(usize, f64)> {
        let scaled = |i: usize, value: f64| value * self.scale[i];
        let largest = (0..problem.len()).map(|i| scaled(i, problem.offset[i]).abs()).fold(0.0, f64::max);
        let free = (0..problem.len())
            .filter(|i| !problem.bilateral[*i] && solution.active.binary_search(i).is_err());
        let closing = free.map(|i| (i, -scaled(i, solution.acceleration[i]) / largest));
        closing.filter(|row| row.1 > 0.0).max_by(|p, q| p.1.total_cmp(&q.1))
    }

    /// Solves A_CC f_C = -b_C of the basis in the original data, with refinement. Returns the row that pulls most, and
    /// its force as a fraction of the largest force.
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
        let size = self.largest_offset(problem);
        let shift = |row: usize| self.shift.get(row).map_or(0.0, |shift| shift * size);
        let offset = |row: usize| problem.offset[row] * self.scale[row] - shift(row);
        let right: Vec<f64> = active.iter().map(|&row| -offset(row)).collect();
        let factor = DenseLu::new(basis.clone());
        let mut force = right.clone();
        factor.solve_in_place(&mut force);
        for _ in 0..self.settings.refinements {
            let sum = |at: usize| force.iter().enumerate().map(|(j, f)| basis[(at, j)] * f).sum::<f64>();
            let mut rest: Vec<f64> = right.iter().enumerate().map(|(at, right)| right - sum(at)).collect();
            factor.solve_in_place(&mut rest);
            force.iter_mut().zip(&rest).for_each(|(force, rest)| *force += rest);
        }
        solution.force.fill(0.0);
        for (&i, force) in active.iter().zip(&force) {
            let value = force * self.scale[i];
            solution.force[i] = if problem.bilateral[i] { value } else { pushing(value) };
        }
        let largest = force.iter().map(|force| force.abs()).fold(0.0, f64::max);
        let unilateral = active.iter().zip(&force).filter(|&(&i, _)| !problem.bilateral[i]);
        let pulling = unilateral.map(|(&i, force)| (i, -force / largest));
        pulling.filter(|row| row.1 > 0.0).max_by(|p, q| p.1.total_cmp(&q.1))
    }

    /// The ray as a certificate, if it is one: z ≥ 0, Aᵀz ≤ 0 (= 0 on bilateral rows), bᵀz < 0, and any solution would
    /// have at least `least_growth`.
    fn certificate<T: Number>(
        &self,
        problem: &Problem,
        dictionary: &Dictionary<T>,
        column: usize,
        least_growth: f64,
    ) -> Option<Infeasibility> {
        let n = problem.len();
        let zero = T::default();
        let mut direction = vec![zero; n];
        for (variable, change) in dictionary.ray(column) {
            if (n..2 * n).contains(&variable) {
                direction[variable - n] = change;
            }
        }
        if let Some(entering) = dictionary.entering(column).checked_sub(n).filter(|&i| i < n) {
            direction[entering] = T::from(1.0);
        }
        // Negative components are taken for rounding; if they were more, the leakage shows it.
        for (z, _) in direction.iter_mut().zip(&problem.bilateral).filter(|(_, is_bilateral)| !**is_bilateral)
        {
            *z = if *z > zero { *z } else { zero };
        }
        self.prove(problem, &direction, least_growth)
    }

    /// The certificate of a direction, if any solution would have at least `least_growth`.
    fn prove<T: Number>(
        &self,
        problem: &Problem,
        direction: &[T],
        least_growth: f64,
    ) -> Option<Infeasibility> {
        let leakage = self.leakage(problem, direction)?;
        let largest = direction.iter().fold(0.0, |m: f64, z| m.max(z.abs().nearest()));
        let (mut worth, mut square) = (T::default(), 0.0);
        for (i, &z) in direction.iter().enumerate() {
            worth = worth + T::from(problem.offset[i]) * T::from(self.scale[i]) * z;
            square += z.nearest() * z.nearest();
        }
        let scale = self.largest_offset(problem);
        let contradiction = -worth.nearest() * largest / square / scale;
        if contradiction.is_nan() || contradiction < least_growth * leakage.max(T::ROUNDING) {
            return None;
        }
        let size = |&i: &usize| direction[i].abs().nearest();
        let row = (0..direction.len()).max_by(|i, j| size(i).total_cmp(&size(j)))?;
        let direction: Vec<f64> = direction.iter().zip(&self.scale).map(|(z, s)| z.nearest() * s).collect();
        // The returned direction has fewer digits, and leaks more.
        let rounded: Vec<T> =
            direction.iter().zip(&self.scale).map(|(&z, &s)| T::from(z) / T::from(s)).collect();
        let leakage = self.leakage(problem, &rounded)?;
        Some(Infeasibility { row, direction, contradiction, leakage })
    }

    /// The largest component of Aᵀz that a force could use, in units of the largest of z; `None` if a number is not
    /// finite.
    fn leakage<T: Number>(&self, problem: &Problem, direction: &[T]) -> Option<f64> {
        let mut image = vec![T::default(); problem.len()];
        self.visit(problem, |i, j, value: T| image[j] = image[j] + value * direction[i]);
        let image = image.into_iter().map(Number::nearest).zip(&problem.bilateral);
        let mut usable =
            image.map(|(part, &is_free)| if is_free || part.is_nan() { part.abs() } else { part });
        let used = usable.try_fold(0.0, |most: f64, part| part.is_finite().then(|| most.max(part)))?;
        Some(used / direction.iter().fold(0.0, |most: f64, z| most.max(z.abs().nearest())))
    }
}

impl Solver for Lemke {
    fn method(&self) -> Method {
        Method::Lemke
    }

    fn solve(&mut self, problem: &Problem, solution: &mut Solution) -> Result<(), SolveError> {
        if !problem.is_plain() {
            return self.solve_friction(problem, solution);
        }
        (self.pivots, self.is_certain) = (0, false);
        self.prepare(problem);
        let mut doubtful = None;
        for perturbation in PERTURBATIONS {
            solution.reset(problem.len(), Method::Lemke);
            let mut dictionary = std::mem::take(&mut self.dictionary);
            let end = self.follow(problem, perturbation, &mut dictionary);
            self.dictionary = dictionary;
            match &end {
                End::Ray(column) => doubtful = self.certificate(problem, &self.dictionary, *column, SURE),
                End::Contradiction(proof) => doubtful = Some(proof.as_ref().clone()),
                End::Solved | End::Stopped => {}
            }
            if doubtful.is_some() {
                break;
            }
            solution.iterations = self.pivots;
            let is_solved = match end {
                End::Solved => self.polish(problem, solution),
                _ => self.is_accepted(problem, solution),
            };
            if is_solved {
                return Ok(());
            }
        }
        let failure = solution.residuals;
        if problem.len() <= TWOFOLD_ROWS {
            // A proof may be rounding, so it is checked with more digits as well.
            let outcome = self.solve_exactly(problem, solution);
            solution.iterations = self.pivots;
            match outcome {
                Ok(true) => return Ok(()),
                Ok(false) => {}
                Err(proof) => {
                    self.is_certain = true;
                    return Err(SolveError::Infeasible(Box::new(proof)));
                }
            }
        }
        let unsolved =
            SolveError::Unsolved { method: Method::Lemke, residuals: failure, iterations: self.pivots };
        Err(doubtful.map_or(unsolved, |proof| SolveError::Infeasible(Box::new(proof))))
    }
}

/// A different positive amount below `size` for every entry: fractional parts of multiples of the golden ratio.
fn perturbations(size: f64) -> impl Iterator<Item = f64> {
    let golden = f64::midpoint(5.0_f64.sqrt(), 1.0);
    (1..).map(move |i: u32| size * (f64::from(i) * golden).fract())
}
