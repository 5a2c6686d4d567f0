//! Problems of more than two rows: a few directly, others by the dual active-set method.

use super::Impact;
use super::couplings::Couplings;
use super::few_rows::{FEW, FewRows};
use super::law::ImpactError;
use crate::dual_active_set::DualActiveSet;
use crate::error::SolveError;
use crate::matrix::{Matrix, SparseMatrix};
use crate::problem::{Problem, pushing};
use crate::settings::{Contradiction, Settings};
use crate::solution::Solution;
use crate::start::Start;
use crate::warm::WarmStart;

/// Fraction of a row's `velocity_tol` up to which dependent rows may contradict each other, in addition to the fraction
/// of the impact's fastest rate that the solver allows. Rates that are only rounding contradict each other if the
/// impact is weak compared with the speeds of its bodies, or when ricochets have become weak.
const CONTRADICTION: f64 = 1e-3;

/// Fraction of the impact's fastest rate up to which nearly dependent rows may seem to contradict each other by
/// rounding of A. It is about the root of `Settings::dependence`, the least independent part of a row that the solver
/// tells from none.
pub(super) const NEARLY: f64 = 1e-5;

/// Growth [-] from which impulses are not accepted by their backward residual. A body that is wedged between others
/// 1e12 times heavier takes impulses that alone would make it 1e12 times faster than it gets, and so does one that lies
/// between blocks of which some lean by a few 1e-5. The rounding of such impulses, a fiftieth of the speed at this
/// growth, is corrected by the next pass.
const GREATEST_GROWTH: f64 = 1e14;

/// Fractions of itself by which the diagonal of A is raised in turn, where the rows are too nearly dependent to be
/// solved as given: first just more than `Settings::dependence`, up to which the solver takes rows for dependent.
const RAISES: [f64; 2] = [1e-10, 1e-6];

/// Cap on the pivots of a trial, per row of the problem plus 5.
const TRIAL_PIVOTS: usize = 1;

/// Place of a row that is not in the problem.
const OUTSIDE: u32 = u32::MAX;

/// Knowledge of the rows before a solve, by their index in the impact.
#[derive(Clone, Copy, Debug)]
pub(super) enum Beginning<'a> {
    /// Nothing is known.
    Unknown,
    /// Whether each row is likely to carry an impulse.
    Likely(&'a [bool]),
    /// Approximate impulse of each row [N s]; 0 where nothing is known.
    Carried(&'a [f64]),
}

/// The problem of some rows of an impact, with its solver.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct ManyRows {
    solver: DualActiveSet,
    /// The default `inconsistency` and `pivots_per_row` of the solver, which each problem adapts.
    inconsistency: f64,
    pivots_per_row: usize,
    problem: Problem,
    solution: Solution,
    /// Place of each row of the impact in the problem, or `OUTSIDE`.
    place: Vec<u32>,
    /// Guess of the closed rows or forces of the problem, used if `is_guessed`.
    guess: WarmStart,
    is_guessed: bool,
    /// max |b/s|, the unit in which the solver measures contradictions.
    scale: f64,
}

impl Default for ManyRows {
    fn default() -> Self {
        let settings = Settings {
            contradiction: Contradiction::LeastSquares,
            greatest_growth: GREATEST_GROWTH,
            ..Settings::default()
        };
        let mut problem = Problem::new();
        problem.matrix = Matrix::Symmetric(SparseMatrix::new());
        Self {
            solver: DualActiveSet::new(settings).expect("the default settings are usable"),
            inconsistency: settings.inconsistency,
            pivots_per_row: settings.pivots_per_row,
            problem,
            solution: Solution::new(),
            place: Vec::new(),
            guess: WarmStart::new(),
            is_guessed: false,
            scale: 0.0,
        }
    }
}

impl ManyRows {
    /// Loads the entries of A between the rows of an ascending set.
    fn load_matrix(&mut self, set: &[usize], couplings: &Couplings, rows: usize) {
        self.place.clear();
        self.place.resize(rows, OUTSIDE);
        for (place, &row) in set.iter().enumerate() {
            self.place[row] = place as u32;
        }
        let Matrix::Symmetric(matrix) = &mut self.problem.matrix else { return };
        matrix.start.truncate(1);
        matrix.column.clear();
        matrix.value.clear();
        for &row in set {
            for (other, value) in couplings.row(row).filter(|&(other, _)| self.place[other] != OUTSIDE) {
                matrix.column.push(self.place[other] as usize);
                matrix.value.push(value);
            }
            matrix.start.push(matrix.column.len());
        }
    }

    /// Raises the diagonal of A by a fraction of itself, so that any rows have exactly one answer. Its impulses change
    /// the rates by too little, by that fraction, which the next round corrects; they take out no less energy.
    fn raise(&mut self, part: f64) {
        let Matrix::Symmetric(matrix) = &mut self.problem.matrix else { return };
        for row in 0..matrix.rows() {
            for e in matrix.start[row]..matrix.start[row + 1] {
                if matrix.column[e] == row {
                    matrix.value[e] *= 1.0 + part;
                }
            }
        }
    }
}

impl ManyRows {
    /// Takes over the knowledge of the rows of a set.
    fn begin_with(&mut self, set: &[usize], begin: Beginning<'_>) {
        self.is_guessed = !matches!(begin, Beginning::Unknown);
        match begin {
            Beginning::Unknown => {}
            Beginning::Likely(likely) => self.guess.guess(set.iter().map(|&row| Some(likely[row]))),
            Beginning::Carried(carried) => {
                self.guess.guess_forces(set.iter().map(|&row| Some(carried[row]).filter(|&j| j > 0.0)));
            }
        }
    }

    /// Solves with the diagonal raised by the first of [`RAISES`] that leads to an answer; `None` if neither does.
    fn solve_raised(&mut self) -> Option<()> {
        RAISES.iter().find_map(|&part| {
            self.raise(part);
            self.solver.run_modestly(&self.problem, Start::Nothing, &mut self.solution).ok()
        })
    }

    /// Solves the rows as given, with impulses as large as necessary, as for a body that slides into a wedge.
    fn solve_strictly(&mut self) -> Result<(), SolveError> {
        self.solver.run_strictly(&self.problem, Start::Nothing, &mut self.solution)
    }

    /// Solves the rows with modest impulses; small contradictions are settled by least squares.
    fn solve(&mut self) -> Result<(), SolveError> {
        let start = if self.is_guessed { Start::Earlier(&self.guess) } else { Start::Nothing };
        self.solver.run_modestly(&self.problem, start, &mut self.solution)
    }
}

impl Impact {
    /// Solves the rows of an ascending set of any length, each to reach its target rate, and applies the impulses.
    pub(super) fn solve_many(&mut self, set: &[usize], begin: Beginning<'_>) -> Result<(), ImpactError> {
        if set.len() <= FEW && self.solve_few(set) {
            return Ok(());
        }
        let mut many = self.scratch.many.take().unwrap_or_default();
        many.begin_with(set, begin);
        let outcome = self.solve_with(&mut many, set);
        self.scratch.many = Some(many);
        outcome
    }

    /// Solves a few rows directly, or with more digits if some depend on others or nearly do, and applies the impulses;
    /// false if neither method ends.
    fn solve_few(&mut self, set: &[usize]) -> bool {
        let mut few = FewRows { count: set.len(), ..FewRows::default() };
        for (place, &row) in set.iter().enumerate() {
            few.offset[place] = self.rates[row] - self.scratch.targets[row];
            few.bilateral[place] = self.rows[row].is_bilateral();
            let mut column = 0;
            for (other, value) in self.couplings.row(row) {
                while column < set.len() && set[column] < other {
                    column += 1;
                }
                if column < set.len() && set[column] == other {
                    few.matrix[place][column] = value;
                }
            }
        }
        let Some(found) = few.solve() else { return few.depends && self.solve_near(set) };
        self.solves += 1;
        for (&row, &impulse) in set.iter().zip(&found.impulses) {
            self.noise = self.noise.max(found.left * self.length(row));
            if impulse != 0.0 {
                self.apply(row, impulse);
            }
        }
        true
    }

    fn solve_with(&mut self, many: &mut ManyRows, set: &[usize]) -> Result<(), ImpactError> {
        many.load_matrix(set, &self.couplings, self.rows.len());
        self.load_rates(many, set);
        self.solves += 1;
        if let Err(error) = many.solve() {
            if self.is_weak(set) {
                return Ok(());
            }
            let error = self.explain(error, many, set);
            let is_large = matches!(error, ImpactError::Infeasible { contradiction, .. }
                if contradiction > NEARLY * self.fastest);
            if self.at_last || is_large {
                many.solve_strictly().map_err(|_| error)?;
            } else {
                many.solve_raised().ok_or(error)?;
            }
        }
        // Rates that the solver leaves by rounding or contradictions must not count as motion.
        let left = many.solution.residuals.natural * many.scale;
        for (place, &row) in set.iter().enumerate() {
            let impulse = many.solution.force[place];
            self.noise = self.noise.max(left * self.length(row));
            if impulse != 0.0 {
                self.apply(row, if self.rows[row].is_bilateral() { impulse } else { pushing(impulse) });
            }
        }
        Ok(())
    }

    /// Whether all wanted changes of rates are so small that they may be rounding of the bodies' speeds; they then
    /// count as rounding.
    fn is_weak(&mut self, set: &[usize]) -> bool {
        let wanted = |&row: &usize| (self.rates[row] - self.scratch.targets[row]).abs();
        let largest = set.iter().map(wanted).fold(0.0, f64::max);
        let weak = set.iter().all(|&row| largest <= CONTRADICTION * self.rows[row].velocity_tol);
        if weak {
            self.noise = self.noise.max(largest);
        }
        weak
    }

    fn explain(&self, error: SolveError, many: &ManyRows, set: &[usize]) -> ImpactError {
        if let SolveError::Infeasible(proof) = error {
            let row = set[proof.row];
            let contradiction = proof.contradiction * many.scale * self.length(row);
            return ImpactError::Infeasible { row, contradiction };
        }
        ImpactError::Unsolved { rows: set.len(), residuals: many.solution.residuals }
    }

    /// Loads the offset of each row (its rate less its target), and sets the largest contradiction that the solver
    /// settles.
    fn load_rates(&self, many: &mut ManyRows, set: &[usize]) {
        many.problem.offset.clear();
        many.problem.bilateral.clear();
        many.scale = 0.0;
        let mut allowed = 0.0f64;
        for &row in set {
            let (b, length) = (self.rates[row] - self.scratch.targets[row], self.length(row));
            many.problem.offset.push(b);
            many.problem.bilateral.push(self.rows[row].is_bilateral());
            many.scale = many.scale.max((b / length).abs());
            let slow = CONTRADICTION * self.rows[row].velocity_tol;
            allowed = allowed.max((slow + self.noise + many.inconsistency * self.fastest) / length);
        }
        let relative = if many.scale > 0.0 { allowed / many.scale } else { 0.0 };
        many.solver.settings.inconsistency = many.inconsistency.max(relative);
        many.solver.settings.pivots_per_row = if self.is_trial { TRIAL_PIVOTS } else { many.pivots_per_row };
    }

    /// Scale s = sqrt(A_ii) [1/sqrt(kg)] of a row; the solver works with rates divided by it.
    pub(super) fn length(&self, row: usize) -> f64 {
        self.couplings.diagonal(row).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::{ImpactLaw, ImpactOrder};
    use crate::kind::RowKind;
    use crate::problem::InverseInertia;
    use crate::row::CollisionRow;
    use halfgap_collision::BodyId;
    use proptest::prelude::*;

    #[test]
    fn a_light_body_wedged_into_a_corner_stops_a_heavy_one() -> Result<(), ImpactError> {
        // Two corners of a ring of 900 t against two sides of a flake of 3 mg that leans against a wall and a floor.
        let ring = InverseInertia { inverse_mass: 1.11e-6, inverse_moment: 3.83e-6 };
        let flake = InverseInertia { inverse_mass: 3.07e5, inverse_moment: 6.72e6 };
        let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        let (on_ring, on_wall) = ([BodyId(0), BodyId(1)], [BodyId(1), BodyId::WORLD]);
        let row = |bodies: [BodyId; 2], jacobian, rate| {
            let inertia = if bodies == on_ring { [ring, flake] } else { [flake, fixed] };
            CollisionRow { velocity_tol: 5e-8, ..CollisionRow::new(bodies, jacobian, inertia, rate) }
        };
        let mut impact = Impact::new();
        impact.set_rows([
            row(
                on_ring,
                [-0.731007, 0.682369866, 0.0098468537, 0.731007, -0.682369866, 0.3309805286],
                -1.97e-6,
            ),
            row(
                on_ring,
                [-0.999866068, -0.016366017, 0.108669443, 0.999866068, 0.016366017, -0.3309805286],
                -2.89e-6,
            ),
            row(on_wall, [-1.0, 0.0, 0.156312, 1.0, 0.0, 1.678756], -2.85e-5),
            row(on_wall, [0.0, 1.0, 0.156312, 0.0, -1.0, -1.991381], -3.82e-6),
        ]);
        impact.resolve_inelastic()?;
        assert!(impact.rates().iter().all(|&rate| rate >= -1e-6), "{:?}", impact.rates());
        Ok(())
    }

    #[test]
    fn a_body_on_two_rails_that_lead_into_the_floor_at_a_millionth_stops() -> Result<(), ImpactError> {
        // The rails are parallel to the floor up to 1e-6: the body goes along them at 7 m/s and comes down at 1e-5 m/s.
        let (body, fixed) = (
            InverseInertia { inverse_mass: 0.46, inverse_moment: 25.0 },
            InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 },
        );
        let along = 7.0;
        let [first, second] = [[9.5e-7, 1.0, -0.029], [1.22e-6, 1.0, -0.0156]];
        let spin = -along * (second[0] - first[0]) / (second[2] - first[2]);
        let down = -(along * first[0] + spin * first[2]);
        let row = |[x, y, turn]: [f64; 3], bilateral| {
            let rate = x * along + y * down + turn * spin;
            let jacobian = [x, y, turn, -x, -y, 0.0];
            CollisionRow {
                velocity_tol: 6e-5,
                kind: RowKind::plain(bilateral),
                ..CollisionRow::new([BodyId(0), BodyId::WORLD], jacobian, [body, fixed], rate)
            }
        };
        let mut impact = Impact::new();
        impact.set_rows([row(first, true), row(second, true), row([0.0, 1.0, 0.0], false)]);
        assert!(impact.rates()[2] < -5e-6, "{:?}", impact.rates());
        ImpactLaw::SerialSeparate.resolve(&mut impact, ImpactOrder::Fastest, 0)?;
        let changes = impact.rows().iter().zip(impact.impulses()).map(|(row, j)| row.response[0] * j);
        assert!((along + changes.sum::<f64>()).abs() < 1e-3, "{:?}", impact.impulses());
        assert!(impact.rates().iter().all(|rate| rate.abs() < 1e-8), "{:?}", impact.rates());
        Ok(())
    }

    #[test]
    fn rows_that_resist_small_impulses_are_held_by_large_ones() -> Result<(), ImpactError> {
        // A light body on two rails that are parallel up to 1e-4 is pinned by long arms to a heavy one and to another,
        // which hits the heavy one and touches a third.
        let inertias = [
            (1.966_996_099_768_953_3, 199_516.372),
            (0.345_544_057_994_402_8, 1.450_1),
            (4.393_578_581_882_733_5e-4, 1.159_423_6e-3),
            (0.693_840_2, 2.439_869_7),
            (0.0, 0.0),
        ];
        let row = |bodies: [u32; 2], [x, y]: [f64; 2], turns: [f64; 2], rate, bilateral| {
            let inertia = bodies.map(|body| {
                let (inverse_mass, inverse_moment) = inertias[body as usize];
                InverseInertia { inverse_mass, inverse_moment }
            });
            let bodies = bodies.map(|body| if body == 4 { BodyId::WORLD } else { BodyId(body) });
            let jacobian = [x, y, turns[0], -x, -y, turns[1]];
            CollisionRow {
                velocity_tol: 3e-5,
                kind: RowKind::plain(bilateral),
                ..CollisionRow::new(bodies, jacobian, inertia, rate)
            }
        };
        let mut impact = Impact::new();
        impact.set_rows([
            row([0, 2], [1.0, 0.0], [-0.0033061730114849475, 4.421053633593274], 0.0, true),
            row([0, 2], [0.0, 1.0], [-0.00033792322108583406, -4.141241410333202], 0.0, true),
            row(
                [3, 2],
                [0.4524345105792622, -0.8917976304279484],
                [0.3728759855825903, 0.7028326465702406],
                0.0,
                false,
            ),
            row([2, 1], [-0.0514784547046198, 0.9986741053523037], [-0.15008070184769445, 0.0], -3.1, false),
            row([1, 0], [1.0, 0.0], [-0.0835908273973045, -6.027404821825888], 0.0, true),
            row([1, 0], [0.0, 1.0], [-0.3208527307114073, 4.52543049521314], 0.0, true),
            row(
                [3, 1],
                [-0.7912890264419127, -0.611442292152424],
                [0.12415462398435718, 0.26200585712386515],
                0.0,
                false,
            ),
            row([3, 4], [0.15057760360235742, 0.9885981920342416], [-0.3605402600715962, 0.0], 0.0, true),
            row([0, 4], [0.9338833544160206, 0.3575777962131898], [9.877447213480273e-5, 0.0], 0.0, true),
            row([0, 4], [0.9338536361396701, 0.35765540156513337], [0.00012183002597049753, 0.0], 0.0, true),
        ]);
        ImpactLaw::SerialSeparate.resolve(&mut impact, ImpactOrder::Fastest, 0)?;
        let rates = impact.rows().iter().zip(impact.rates());
        let violations = rates.map(|(row, rate)| if row.is_bilateral() { rate.abs() } else { -rate });
        assert!(violations.fold(0.0, f64::max) < 1e-7, "{:?}", impact.rates());
        Ok(())
    }

    #[test]
    fn pins_in_line_with_an_impact_do_not_pull_each_other_apart() -> Result<(), ImpactError> {
        // Two blocks pinned together twice bounce between a block and a wall. The first three rows of the pins nearly
        // depend on each other: the remainder of the fourth row's square is rounding, but far larger than usual.
        let inertias = [(6.9e-4, 0.0138), (13.597459369453698, 81.58475621672218), (0.21, 1.24), (0.0, 0.0)];
        let row = |bodies: [u32; 2], [x, y]: [f64; 2], turns: [f64; 2], rate, elasticity| {
            let inertia = bodies.map(|body| {
                let (inverse_mass, inverse_moment) = inertias[body as usize];
                InverseInertia { inverse_mass, inverse_moment }
            });
            let bodies = bodies.map(|body| if body == 3 { BodyId::WORLD } else { BodyId(body) });
            let jacobian = [x, y, turns[0], -x, -y, turns[1]];
            let is_pin = bodies == [BodyId(1), BodyId(2)];
            CollisionRow {
                elasticity,
                velocity_tol: 0.015,
                kind: RowKind::plain(is_pin),
                ..CollisionRow::new(bodies, jacobian, inertia, rate)
            }
        };
        let half = std::f64::consts::FRAC_1_SQRT_2;
        for turn in 1..100 {
            let angle = std::f64::consts::FRAC_PI_4 + 1e-5 * f64::from(turn);
            let (near, far) = (0.4 * angle.cos(), 0.4 * angle.sin());
            let mut impact = Impact::new();
            impact.set_rows([
                row([0, 1], [-0.7075174, 0.7066959], [0.27076, 0.157528], 0.0, 0.8),
                row([1, 0], [0.7075811, -0.7066322], [0.499955, -0.071729], -0.865, 0.0),
                row([1, 2], [1.0, 0.0], [-far, -near.next_down()], 0.0, 0.0),
                row([1, 2], [0.0, 1.0], [near, -far.next_up()], 0.0, 0.0),
                row([1, 2], [1.0, 0.0], [-near.next_up(), -far], 0.0, 0.0),
                row([1, 2], [0.0, 1.0], [-far, near], 0.0, 0.0),
                row([1, 3], [-half, half], [0.50029, 0.0], 0.0, 0.8),
                row([1, 3], [-half, half], [-0.49971, 0.0], 0.0, 0.8),
            ]);
            ImpactLaw::SerialGroupedLastpass.resolve(&mut impact, ImpactOrder::Fastest, 0)?;
            let rates = impact.rows().iter().zip(impact.rates());
            let violations = rates.map(|(row, rate)| if row.is_bilateral() { rate.abs() } else { -rate });
            let worst = violations.fold(0.0, f64::max);
            let largest = impact.impulses().iter().fold(0.0f64, |most, impulse| most.max(impulse.abs()));
            assert!(worst < 1e-9 && largest < 1e4, "{turn}: {worst:e} m/s, {largest:e} N s");
        }
        Ok(())
    }

    #[test]
    fn impulses_are_looked_for_where_rows_were_unloaded() -> Result<(), ImpactError> {
        // Discs in rows, each on two of the row below in directions that vary, fall onto a floor.
        const ACROSS: usize = 9;
        let disc = InverseInertia { inverse_mass: 1.0, inverse_moment: 8.0 };
        let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        let contacts = |fall: f64, hop: f64| {
            (0..2 * ACROSS * ACROSS).map(move |contact| {
                let (index, side) = (contact / 2, contact % 2);
                let (row, column) = (index / ACROSS, index % ACROSS);
                let tilt = 0.5 * (1.7 * contact as f64).sin() + if side == 0 { 0.5 } else { -0.5 };
                let (x, y) = (tilt / tilt.hypot(0.8), 0.8 / tilt.hypot(0.8));
                let below = index.wrapping_sub(ACROSS) + usize::from(side == 1 && column + 1 < ACROSS);
                let (other, theirs, fall) = match row {
                    0 => (BodyId::WORLD, fixed, -fall * y),
                    _ => (BodyId(below as u32), disc, 0.0),
                };
                let rate = fall + hop * (2.9 * contact as f64).cos();
                let (bodies, jacobian) = ([BodyId(index as u32), other], [x, y, 0.0, -x, -y, 0.0]);
                CollisionRow {
                    velocity_tol: 1e-3,
                    ..CollisionRow::new(bodies, jacobian, [disc, theirs], rate)
                }
            })
        };
        let mut impact = Impact::new();
        impact.set_rows(contacts(1.0, 0.0));
        impact.resolve_inelastic()?;
        let carried = impact.impulses().to_vec();
        let [known, unknown] = [true, false].map(|is_known| {
            impact.set_rows(contacts(0.0, 0.01));
            impact.unload(&carried);
            if !is_known {
                impact.scratch.carried.clear();
            }
            impact.resolve_inelastic().expect("impulses that are there");
            assert!(impact.rates().iter().all(|&rate| rate >= -1e-9), "{:?}", impact.rates());
            impact.scratch.many.as_ref().expect("there are many rows").solution.iterations
        });
        assert!(known == 0 && unknown > 8, "{known} and {unknown} pivots");
        Ok(())
    }

    proptest! {
        #[test]
        fn few_rows_come_to_the_rates_that_many_do(
            rows in prop::collection::vec((prop::array::uniform6(-1.0..1.0f64), -1.0..0.2f64, 0u32..3), 3..=FEW),
        ) {
            let inertia = InverseInertia { inverse_mass: 0.8, inverse_moment: 3.0 };
            let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
            let rows = rows.iter().map(|&(jacobian, rate, other)| {
                let (other, theirs) = if other == 0 { (BodyId::WORLD, fixed) } else { (BodyId(other), inertia) };
                CollisionRow { velocity_tol: 1e-3, ..CollisionRow::new([BodyId(0), other], jacobian, [inertia, theirs], rate) }
            });
            let mut direct = Impact::new();
            direct.set_rows(rows);
            direct.aim_at_rest();
            let mut pivoted = direct.clone();
            let set: Vec<usize> = (0..direct.rows.len()).collect();
            // Where rows nearly depend on each other, and `near_rows` is called, the pivoted method's forces are rounding.
            if direct.solve_few(&set) && direct.scratch.near.is_none() {
                pivoted.solve_with(&mut ManyRows::default(), &set)?;
                for (p, q) in direct.rates.iter().zip(&pivoted.rates) {
                    prop_assert!((p - q).abs() < 1e-9, "{p}, {q}");
                }
            }
        }
    }
}
