//! How the problem of an island is solved: exactly, or by sweeps.
//!
//! *Invariant*: a solution gives bodies no more energy than it may, or it is found anew by sweeps.

use crate::stepping::balance::Balance;
use crate::stepping::bodies::Motion3;
use crate::stepping::exact::{Effort, Exact};
use crate::stepping::rows::{Mover, Rows};
use crate::stepping::sweeps::{Enough, Problem, Sweeps};

/// Number of rows up to which an island is solved exactly, by whatever it takes.
pub(super) const LARGEST_SMALL: usize = 60;
/// Number of rows up to which an island in which nothing is faster than forces make it in a step is solved exactly, if the forces of the
/// last step tell its modes: a tower stands, where sweeps would let each of its contacts close a little.
const LARGEST_QUIET: usize = 1000;

/// What decides how the problem of an island is solved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Means {
    /// Nothing is known of forces.
    pub(super) is_start: bool,
    /// Nothing is faster than forces make it in a step.
    pub(super) is_quiet: bool,
    pub(super) span: f64,
    pub(super) slack: f64,
    pub(super) enough: Enough,
    /// What moves is left to sweeps.
    pub(super) is_loose: bool,
}

/// True if the impulses of a solution give bodies more energy than they may.
fn explodes(problem: &Problem<'_>, members: &[u32], free: &[Motion3]) -> bool {
    let Problem { rows, list, movers, before, .. } = problem;
    let mut balance = Balance::default();
    for &row in list.iter() {
        let row = &rows[row as usize];
        let [p, q] = row.ends().map(|place| &movers[place].velocity);
        let closing = row.rate(before) + (row.change_of(movers) + row.prescribed.unwrap_or(0.0));
        let slipping = row.slip_rate(before) + row.slip.line.rate(p, q);
        row.weigh([row.normal.impulse, row.slip.line.impulse], [closing, slipping], &mut balance);
    }
    let energy = |velocities: &[Motion3]| -> f64 {
        members.iter().map(|&body| movers[body as usize].energy(velocities[body as usize])).sum()
    };
    balance.explodes(energy(before) + energy(free))
}

/// Finds the impulses of some rows of an island and of some that resist rolling, beginning with those that they have, for velocities without them.
pub(super) fn solve(
    (rows, list, rolling): (&mut Rows, &[u32], &[u32]),
    (movers, before, free): (&mut [Mover], &[Motion3], &[Motion3]),
    (exact, sweeps): (&mut Exact, &mut Sweeps),
    members: &[u32],
    Means { is_start, is_quiet, span, slack, enough, is_loose }: Means,
) {
    let mut problem = Problem { rows: &mut rows.all, list, rolls: &mut rows.rolls, rolling, movers, before };
    let effort = match problem.list.len() {
        0..=LARGEST_SMALL if !is_loose => Some(Effort::Full),
        // Without forces to begin with.
        0..=LARGEST_QUIET if is_start => Some(Effort::Full),
        0..=LARGEST_QUIET if is_quiet && !is_loose => Some(Effort::Near),
        _ => None,
    };
    let mut is_solved =
        effort.is_some_and(|effort| exact.solve(&mut problem, members, (span, slack), effort));
    if is_solved && explodes(&problem, members, free) {
        problem.forget(members, free);
        is_solved = false;
    }
    if !is_solved {
        sweeps.solve(&mut problem, members, enough);
    }
}
