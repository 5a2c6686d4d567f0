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
    if combinations(&rows).is_none_or(|count| count > COMBINATIONS) {
        return Tried::TooMany;
    }
    // More than are tried: the friction of open contacts is no choice.
    let count: u64 = choices.iter().map(|modes| modes.len() as u64).product();
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

/// Number of combinations: a contact is open, or held with a mode for each of its friction rows.
fn combinations(rows: &ScaledRows) -> Option<u64> {
    (0..rows.len()).try_fold(1_u64, |product, row| {
        let of_friction = 3_u64.checked_pow(rows.friction_of(row).len() as u32)?;
        product.checked_mul(match rows.bound[row] {
            Bound::Bilateral | Bound::Friction { .. } => 1,
            Bound::Unilateral => 1 + of_friction,
            Bound::Constants { .. } => 3_u64.checked_mul(of_friction)?,
        })
    })
}

fn choices(bound: &Bound) -> &'static [Mode] {
    match bound {
        Bound::Bilateral => &[Mode::Held],
        Bound::Unilateral => &[Mode::Held, Mode::Open],
        Bound::Constants { .. } => &[Mode::Held, Mode::Least, Mode::Most],
        Bound::Friction { .. } => &[Mode::Held, Mode::Least, Mode::Most, Mode::Open],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::{InverseInertia, Row};

    /// Discs that fall and slide on a floor, at velocity level.
    fn discs(count: usize) -> Problem {
        let mut problem = Problem::new();
        for at in 0..count {
            let inertia = InverseInertia { inverse_mass: 1.0, inverse_moment: 2.0 };
            let disc = problem.add_body(inertia).expect("a body");
            let slip = [0.1, 5.0][at % 2];
            let rows = [Row::new(disc, [0.0, 1.0, 0.0], -1.0), Row::new(disc, [-1.0, 0.0, -1.0], slip)];
            problem.add_contact(&rows[0], &rows[1], 0.5).expect("rows");
        }
        problem
    }

    #[test]
    fn six_contacts_are_tried_and_seven_are_not() {
        let (settings, mut solution) = (Settings::default(), Solution::new());
        assert!(matches!(enumerate(&discs(6), &settings, &mut solution), Tried::Found));
        // One sticks, the next slips.
        assert!((solution.force[1] + 0.1 / 3.0).abs() < 1e-12 && (solution.force[3] + 0.5).abs() < 1e-12);
        assert!(matches!(enumerate(&discs(7), &settings, &mut solution), Tried::TooMany));
    }
}
