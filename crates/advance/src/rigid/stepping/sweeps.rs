//! Projected sweeps: each row in turn gets the impulse by which it no longer closes, forwards and backwards, until none
//! changes its rate by more than a residual.
//!
//! Each change is a projection in the metric of the masses. So where bodies at rest satisfy all rows, no sweep raises the
//! energy, whether it is the last or not; rows that depend on each other, or jam, get bounded impulses.

use crate::rigid::stepping::rows::StepRow;
use halfgap_contact::{Auto, InverseInertia, Problem, ProblemBody, Row, Settings, Solution, Solver, WarmStart};

/// Largest number of sweeps: what then closes still is stopped in the next step.
const MOST_SWEEPS: usize = 50;

/// Changes velocities so that the rows which `acts` tells have a rate of at least the opposite of their offset, with impulses that only push.
/// They begin with the impulses that they have.
pub(crate) fn sweep(
    rows: &mut [StepRow],
    velocities: &mut [[f64; 3]],
    residual: f64,
    acts: impl Fn(&StepRow) -> bool,
) -> bool {
    for row in rows.iter_mut() {
        if acts(row) {
            row.push(velocities, row.impulse);
        } else {
            row.impulse = 0.0;
        }
    }
    for round in 0..MOST_SWEEPS {
        let mut most = 0.0f64;
        let mut visit = |row: &mut StepRow| {
            if acts(row) {
                let wanted = row.impulse - (row.rate(velocities) + row.offset) / row.compliance;
                let change = wanted.max(0.0) - row.impulse;
                row.push(velocities, change);
                row.impulse += change;
                most = most.max(change.abs() * row.compliance);
            }
        };
        if round % 2 == 0 {
            rows.iter_mut().for_each(&mut visit);
        } else {
            rows.iter_mut().rev().for_each(&mut visit);
        }
        if most <= residual {
            return true;
        }
    }
    false
}

/// As [`sweep`], and exactly where that does not converge.
pub(crate) fn solve(
    exact: &mut Exact,
    rows: &mut [StepRow],
    velocities: &mut Vec<[f64; 3]>,
    residual: f64,
    acts: impl Fn(&StepRow) -> bool,
) {
    exact.before.clone_from(velocities);
    if sweep(rows, velocities, residual, &acts) {
        return;
    }
    let t0 = std::time::Instant::now();
    exact.problem.clear();
    for inertia in &exact.inertias {
        exact.problem.add_body(*inertia).expect("fine");
    }
    let mut guess = Vec::new();
    for row in rows.iter().filter(|row| acts(row)) {
        let bodies = row.places.map(|p| (p < exact.inertias.len()).then(|| ProblemBody(p as u32)));
        let offset = row.rate(&exact.before) + row.offset;
        if let Some(r) = Row::between(bodies, &row.jacobian, offset) {
            exact.problem.add_row(&r).expect("fine");
            guess.push(Some(row.impulse));
        }
    }
    exact.guess.guess_forces(guess);
    let ok = exact.solver.solve_from(&exact.problem, &exact.guess, &mut exact.solution);
    if std::env::var_os("TRACE").is_some() { eprintln!("EXACT rows {} {:?} {:?}", exact.problem.len(), t0.elapsed(), ok.is_ok()); }
    if ok.is_err() { return; }
    velocities.clone_from(&exact.before);
    for (row, &force) in rows.iter_mut().filter(|row| acts(row)).zip(&exact.solution.force) {
        row.impulse = force;
        row.push(velocities, force);
    }
}

/// Exact.
#[derive(Clone, Debug)]
pub(crate) struct Exact {
    pub(crate) inertias: Vec<InverseInertia>,
    before: Vec<[f64; 3]>,
    problem: Problem,
    guess: WarmStart,
    solver: Auto,
    solution: Solution,
}
impl Default for Exact {
    fn default() -> Self {
        let settings = Settings { selection: halfgap_contact::ForceSelection::Quickest, contradiction: halfgap_contact::Contradiction::LeastSquares, natural_residual: 1e-6, ..Settings::default() };
        Self { inertias: vec![], before: vec![], problem: Problem::new(), guess: WarmStart::new(), solver: Auto::new(settings).expect("fine"), solution: Solution::new() }
    }
}

