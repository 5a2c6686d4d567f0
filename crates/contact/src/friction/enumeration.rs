//! All modes of few contacts, tried one by one.
//!
//! Whether a force problem with sliding contacts has a solution at all is NP-hard to tell (D. Baraff, "Issues in computing
//! contact forces for non-penetrating rigid bodies", Algorithmica 10, 1993), so this is for few rows.

use super::equations::Equations;
use super::mode::{self, Mode};
use super::scaled_rows::{Bound, ScaledRows};
use super::settle::Settle;
use crate::check::Checker;
use crate::problem::Problem;
use crate::settings::Settings;
use crate::solution::Solution;
use crate::solver::Method;

/// Most combinations that are tried: those of six contacts, of which each is open, sticks, or slips either way.
const COMBINATIONS: u64 = 4096;
/// ε [-], and repetitions by which forces come to those of their modes.
const EPSILON: f64 = 1e-8;
const REPETITIONS: usize = 3;

/// What came of it.
pub(super) enum Tried {
    /// A solution was found.
    Found,
    /// None of so many combinations of modes is a solution.
    None(u64),
    /// There are too many.
    TooMany,
}

/// Tries all combinations of modes.
pub(super) fn enumerate(problem: &Problem, settings: &Settings, solution: &mut Solution) -> Tried {
    let mut rows = ScaledRows::default();
    rows.load(problem);
    let choices: Vec<&[Mode]> = rows.bound.iter().map(choices).collect();
    let count = choices.iter().try_fold(1_u64, |product, modes| product.checked_mul(modes.len() as u64));
    // Open contacts have no friction to choose: the true number is less.
    let Some(count) = count.filter(|&count| count <= COMBINATIONS * (rows.friction.len() as u64 + 1)) else {
        return Tried::TooMany;
    };
    let (mut settle, mut equations, mut checker) =
        (Settle::default(), Equations::default(), Checker::default());
    let (mut modes, mut force, mut tried) = (Vec::new(), Vec::new(), 0);
    for combination in 0..count {
        modes.clear();
        let mut rest = combination;
        for modes_of_row in &choices {
            modes.push(modes_of_row[(rest % modes_of_row.len() as u64) as usize]);
            rest /= modes_of_row.len() as u64;
        }
        let is_idle = |&(normal, row): &(u32, u32)| {
            (modes[normal as usize] == Mode::Open) != (modes[row as usize] == Mode::Open)
        };
        if rows.friction.iter().any(is_idle) {
            continue;
        }
        tried += 1;
        force.clear();
        force.resize(rows.len(), 0.0);
        for _ in 0..REPETITIONS {
            settle.run_fixed(&rows, &mut equations, &modes, &mut force, EPSILON);
        }
        solution.reset(problem.len(), Method::Modes);
        for row in 0..rows.len() {
            solution.force[row] = mode::cut(&rows, row, &force) / rows.scale[row];
        }
        solution.residuals = checker.check(problem, &solution.force, &mut solution.acceleration);
        if solution.residuals.accepted(settings, 0.0) {
            solution.active.extend((0..rows.len()).filter(|&row| modes[row] == Mode::Held));
            solution.iterations = tried as usize;
            return Tried::Found;
        }
    }
    Tried::None(tried)
}

fn choices(bound: &Bound) -> &'static [Mode] {
    match bound {
        Bound::Bilateral => &[Mode::Held],
        Bound::Unilateral => &[Mode::Held, Mode::Open],
        Bound::Constants { .. } => &[Mode::Held, Mode::Least, Mode::Most],
        Bound::Friction { .. } => &[Mode::Held, Mode::Least, Mode::Most, Mode::Open],
    }
}
