//! Projected sweeps over the rows of an island: each in turn gets the impulse by which it does what is asked of it, forwards and
//! backwards, until none changes its rate by more than a residual. Between rounds the impulses go on along a conjugate direction,
//! as long as rounds change them less and less.
//!
//! *Invariant*: the velocities are those of the start with the response to all impulses.
//!
//! Sources: J. J. Moreau, CISM Courses 302 (1988) (sweeps); M. Silcowitz, S. Niebe, K. Erleben, The Visual Computer 26 (2010)
//! (nonlinear conjugate gradients over them).

use crate::stepping::rows::{Line, Mover, Roll, Row};

/// The rows of an island, and all velocities.
pub(super) struct Problem<'a> {
    pub(super) rows: &'a mut [Row],
    pub(super) list: &'a [u32],
    /// Resistances against rolling of all rows, and the places of those of the island.
    pub(super) rolls: &'a mut [Roll],
    pub(super) rolling: &'a [u32],
    pub(super) movers: &'a mut [Mover],
}

impl Problem<'_> {
    /// Changes the velocities of an island, which do not include the impulses that its rows have, by better ones, until no rate
    /// changes by more than `residual` [m/s], in at most so many rounds. True if that is reached.
    pub(super) fn sweep(&mut self, residual: f64, rounds: u32) -> bool {
        for &row in self.list {
            self.rows[row as usize].push_impulses(self.movers);
        }
        for &roll in self.rolling {
            let Roll { row, line, .. } = &self.rolls[roll as usize];
            let [a, b] = self.rows[*row as usize].ends();
            let (mut p, mut q) = (self.movers[a], self.movers[b]);
            line.push(&mut p, &mut q, line.impulse);
            (self.movers[a], self.movers[b]) = (p, q);
        }
        let mut last = f64::INFINITY;
        for _ in 0..rounds {
            let mut most = 0.0_f64;
            for &row in self.list {
                let row = &mut self.rows[row as usize];
                (row.normal.before, row.slip.line.before) = (row.normal.impulse, row.slip.line.impulse);
                most = most.max(visit(row, self.movers));
            }
            most = most.max(self.hold_rolling());
            if most <= residual {
                return true;
            }
            for &row in self.list.iter().rev() {
                visit(&mut self.rows[row as usize], self.movers);
            }
            last = self.go_on(last);
        }
        // The last sweep leaves no impulse that pulls.
        for &row in self.list {
            visit(&mut self.rows[row as usize], self.movers);
        }
        self.hold_rolling();
        false
    }

    /// Goes on along the conjugate direction, given the square of the change in the round before; returns that of this one.
    fn go_on(&mut self, last: f64) -> f64 {
        let square = |line: &Line| (line.impulse - line.before) * (line.impulse - line.before);
        let rows = self.list.iter().map(|&row| &self.rows[row as usize]);
        let present: f64 = rows.map(|row| square(&row.normal) + square(&row.slip.line)).sum();
        let share = if present < last && last < f64::INFINITY { present / last } else { 0.0 };
        for &row in self.list {
            let row = &mut self.rows[row as usize];
            let [a, b] = row.ends();
            let (mut p, mut q) = (self.movers[a], self.movers[b]);
            for line in [&mut row.normal, &mut row.slip.line] {
                let (on, swept) = (share * line.conjugate, line.impulse - line.before);
                // A new direction begins with what this round has changed.
                line.conjugate = on + swept;
                line.push(&mut p, &mut q, on);
                line.impulse += on;
            }
            (self.movers[a], self.movers[b]) = (p, q);
        }
        present
    }

    /// Holds back what rolls; returns the largest change, as that of the rate of a row along the normal with the same response.
    fn hold_rolling(&mut self) -> f64 {
        let mut most = 0.0_f64;
        for &roll in self.rolling {
            let Roll { row, line, bound } = &mut self.rolls[roll as usize];
            let row = &self.rows[*row as usize];
            let [a, b] = row.ends();
            let (mut p, mut q) = (self.movers[a], self.movers[b]);
            let bound = *bound * row.normal.impulse;
            let wanted = line.wanted(&p, &q).clamp(-bound, bound);
            let change = line.set(&mut p, &mut q, wanted);
            most = most.max(change / (line.weight * row.normal.weight).sqrt());
            (self.movers[a], self.movers[b]) = (p, q);
        }
        most
    }
}

/// Gives a row the impulses by which it does what is asked; returns the largest change of its rates that these make by
/// themselves [m/s].
#[inline(always)]
fn visit(row: &mut Row, movers: &mut [Mover]) -> f64 {
    let [a, b] = row.ends();
    let (mut p, mut q) = (movers[a], movers[b]);
    let normal = &mut row.normal;
    let wanted = normal.wanted(&p, &q);
    let pressing = if row.is_bilateral { wanted } else { wanted.max(0.0) };
    let mut most = normal.set(&mut p, &mut q, pressing) / normal.weight;
    let slip = &mut row.slip.line;
    if slip.is_some() {
        let wanted = slip.wanted(&p, &q);
        let [sticking, slipping] = row.slip.bounds.map(|bound| bound * pressing);
        let held = if wanted.abs() <= sticking { wanted } else { wanted.clamp(-slipping, slipping) };
        most = most.max(slip.set(&mut p, &mut q, held) / slip.weight);
    }
    (movers[a], movers[b]) = (p, q);
    most
}
