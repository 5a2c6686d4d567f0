//! Projected sweeps over rows: each in turn gets the impulses by which it does what is asked of it, forwards and backwards, until
//! no rate is off by more than a residual. After the first sweep only rows are looked at whose bodies others have moved since.
//!
//! *Invariant*: the velocities are those of the start with the response to all impulses.
//!
//! Source: J. J. Moreau, CISM Courses 302 (1988) (sweeps).

use crate::stepping::bodies::Motion3;
use crate::stepping::rows::{Mover, Roll, Row};
use crate::stepping::swept::{Swept, SweptApart};

/// Largest number of visits of a row on average: what they leave is corrected in the steps that follow.
const MOST_VISITS: f64 = 200.0;
/// That at a residual of 1; it grows with the root of the accuracy asked for. Of the pile of 200 discs at a residual of 0.1, 8 visits leave
/// twice the overlap of 16, and 32 take a quarter more time.
const LOOSE_VISITS: f64 = 5.0;

/// The rows of an island, and all velocities.
pub(super) struct Problem<'a> {
    pub(super) rows: &'a mut [Row],
    pub(super) list: &'a [u32],
    /// Resistances against rolling of all rows, and the places of those of the island.
    pub(super) rolls: &'a mut [Roll],
    pub(super) rolling: &'a [u32],
    pub(super) movers: &'a mut [Mover],
    /// Velocities before the forces without contacts.
    pub(super) before: &'a [Motion3],
}

impl Problem<'_> {
    /// Takes all impulses back, so that bodies have their velocities without them.
    pub(super) fn forget(&mut self, members: &[u32], free: &[Motion3]) {
        for &row in self.list {
            let row = &mut self.rows[row as usize];
            (row.normal.impulse, row.slip.line.impulse) = (0.0, 0.0);
        }
        for &roll in self.rolling {
            self.rolls[roll as usize].line.impulse = 0.0;
        }
        for &body in members {
            self.movers[body as usize].velocity = free[body as usize];
        }
    }
}

/// What is enough of sweeps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Enough {
    /// Change of a rate [m/s].
    pub(super) residual: f64,
    /// Number of visits of a row on average.
    pub(super) visits: usize,
}

impl Enough {
    /// Changes of rates of so large a share of what forces change in a step [m/s].
    pub(super) fn new(share: f64, fall: f64) -> Self {
        let visits = (LOOSE_VISITS / share.sqrt()).min(MOST_VISITS);
        Self { residual: share * fall, visits: visits as usize }
    }
}

/// Buffers of sweeps.
#[derive(Clone, Debug, Default)]
pub(super) struct Sweeps {
    /// Rows in an order in which neighbours rarely share a body, so that a processor works at some at once; each body meets its rows in
    /// the order of the list.
    rows: Vec<Swept>,
    order: Vec<u32>,
    /// For each body the number of its rows, or of those in a chain that ends with it, that have been ordered.
    depths: Vec<u32>,
    /// First place of each depth.
    firsts: Vec<u32>,
    /// What has been changed of the rates of each body since its rows were last asked for [m/s]; that of all that cannot move is behind the
    /// last, and no matter.
    changes: Vec<f64>,
    /// Rows of the present sweep.
    asked: Vec<u32>,
    /// Rows that are not of the form of contacts. They are held after all others.
    apart: Vec<SweptApart>,
}

impl Sweeps {
    /// Changes the velocities of an island, which do not include the impulses that its rows have, by better ones, until rates are
    /// off by no more than is enough, or the visits are used up. True if that is reached.
    pub(super) fn solve(&mut self, problem: &mut Problem<'_>, members: &[u32], enough: Enough) -> bool {
        let Problem { rows, list, rolls, rolling, movers, before } = problem;
        self.load(rows, (list, members), movers, before);
        for row in &self.rows {
            row.push(movers, row.impulses);
        }
        let mut apart = std::mem::take(&mut self.apart);
        for other in &apart {
            let row = &rows[other.row as usize];
            row.push(movers, row.normal.impulse);
        }
        for &roll in rolling.iter() {
            let Roll { row, line, .. } = &rolls[roll as usize];
            let [a, b] = rows[*row as usize].ends();
            let (mut p, mut q) = (movers[a], movers[b]);
            line.push(&mut p, &mut q, line.impulse);
            (movers[a], movers[b]) = (p, q);
        }
        let is_solved = self.sweep((movers, members), enough, |swept, movers, changes| {
            let held = hold_apart(rows, &apart, movers, changes);
            if rolling.is_empty() {
                return held;
            }
            for swept in swept {
                rows[list[swept.listed as usize] as usize].normal.impulse = swept.impulses[0];
            }
            hold_rolling(rows, (rolls, rolling), movers);
            held
        });
        self.lose(rows, &apart, movers);
        apart.clear();
        self.apart = apart;
        for swept in &self.rows {
            let row = &mut rows[list[swept.listed as usize] as usize];
            [row.normal.impulse, row.slip.line.impulse] = swept.impulses;
        }
        is_solved
    }

    /// Takes over the rows of a list, each behind all before it that share a body that can move.
    fn load(
        &mut self,
        rows: &[Row],
        (list, members): (&[u32], &[u32]),
        movers: &[Mover],
        before: &[Motion3],
    ) {
        let Self { depths, firsts, asked, order, apart, .. } = self;
        apart.clear();
        depths.resize(movers.len(), 0);
        members.iter().for_each(|&body| depths[body as usize] = 0);
        firsts.clear();
        asked.clear();
        for &row in list {
            let [a, b] = rows[row as usize].ends();
            let depth = depths[a].max(depths[b]);
            for body in [a, b] {
                // What cannot move orders nothing.
                depths[body] = if movers[body].inverse_mass > 0.0 { depth + 1 } else { 0 };
            }
            if firsts.len() <= depth as usize {
                firsts.resize(depth as usize + 1, 0);
            }
            firsts[depth as usize] += 1;
            asked.push(depth);
            apart.extend(SweptApart::of(rows, row, movers, before));
        }
        let mut next = 0;
        for first in firsts.iter_mut() {
            (*first, next) = (next, next + *first);
        }
        order.clear();
        order.resize(list.len(), 0);
        for (listed, &depth) in asked.iter().enumerate() {
            let place = &mut firsts[depth as usize];
            order[*place as usize] = listed as u32;
            *place += 1;
        }
        self.rows.clear();
        self.rows.extend(
            order
                .iter()
                .map(|&listed| (&rows[list[listed as usize] as usize], listed))
                .filter(|(row, _)| row.apart.is_none())
                .map(|(row, listed)| Swept::of(row, listed, movers, before)),
        );
    }

    /// Takes back as much of all impulses as gives energy to the bodies: what sweeps leave unsolved may push apart what parts by itself.
    fn lose(&mut self, rows: &mut [Row], apart: &[SweptApart], movers: &mut [Mover]) {
        // The work of a share s of the impulses is s first + s^2 second.
        let (mut first, mut second) = (0.0, 0.0);
        for row in &self.rows {
            let [p, q] = row.ends().map(|place| movers[place].velocity);
            let (x, y) = (p[0] - q[0], p[1] - q[1]);
            let rate = |[jx, jy, ja, jb]: &[f64; 4]| (jx * x + jy * y) + (ja * p[2] + jb * q[2]);
            let pushed = [rate(&row.normal) - row.kicked[0], rate(&row.slip) - row.kicked[1]];
            let [normal, slip] = row.impulses;
            first += row.free[0] * normal + row.free[1] * slip;
            second += 0.5 * (pushed[0] * normal + pushed[1] * slip);
        }
        for other in apart {
            let row = &rows[other.row as usize];
            let impulse = row.normal.impulse;
            first += other.free * impulse;
            second += 0.5 * (row.change_of(movers) - other.kicked) * impulse;
        }
        if first + second <= 0.0 {
            return;
        }
        let kept = (-first / second).max(0.0);
        for other in apart {
            let row = &mut rows[other.row as usize];
            row.push(movers, (kept - 1.0) * row.normal.impulse);
            row.normal.impulse *= kept;
        }
        for row in &mut self.rows {
            row.push(movers, row.impulses.map(|impulse| (kept - 1.0) * impulse));
            row.impulses = row.impulses.map(|impulse| kept * impulse);
        }
    }

    fn sweep(
        &mut self,
        (movers, members): (&mut [Mover], &[u32]),
        enough: Enough,
        mut hold_others: impl FnMut(&[Swept], &mut [Mover], &mut [f64]) -> f64,
    ) -> bool {
        let Self { rows, changes, asked, .. } = self;
        let mut left = enough.visits * rows.len();
        changes.resize(movers.len() + 1, 0.0);
        members.iter().for_each(|&body| changes[body as usize] = 0.0);
        for row in rows.iter_mut() {
            let change = row.visit(movers);
            note(row, changes, change);
        }
        let mut held = hold_others(rows, movers, changes);
        let mut last = f64::INFINITY;
        loop {
            // Each round goes back over the rows that are asked, and forth over those that are then.
            for is_forward in [false, true] {
                ask(rows, (members, changes), enough.residual, asked);
                if asked.is_empty() && held <= enough.residual {
                    return true;
                }
                if asked.len() >= left {
                    return false;
                }
                left -= asked.len().max(1);
                let mut visit = |index: u32| {
                    let row = &mut rows[index as usize];
                    if !is_forward {
                        row.before = row.impulses;
                    }
                    let change = row.visit(movers);
                    note(row, changes, change);
                };
                if is_forward {
                    asked.iter().for_each(|&index| visit(index));
                } else {
                    asked.iter().rev().for_each(|&index| visit(index));
                }
                held = hold_others(rows, movers, changes);
            }
            last = go_on(rows, asked, movers, changes, last);
        }
    }
}

/// Notes a change of the rates of a row [m/s] for its bodies.
#[inline(always)]
fn note(row: &Swept, changes: &mut [f64], change: f64) {
    row.noted.into_iter().for_each(|body| changes[body as usize] += change);
}

/// Goes on along the conjugate direction, given the square of the change in the round before; returns that of this one.
fn go_on(rows: &mut [Swept], asked: &[u32], movers: &mut [Mover], changes: &mut [f64], last: f64) -> f64 {
    let mut present = 0.0;
    for &index in asked {
        let row = &rows[index as usize];
        present += (0..2)
            .map(|k| (row.impulses[k] - row.before[k]) * (row.impulses[k] - row.before[k]))
            .sum::<f64>();
    }
    let share = if present < last && last < f64::INFINITY { present / last } else { 0.0 };
    for &index in asked {
        let row = &mut rows[index as usize];
        let on = row.conjugate.map(|conjugate| share * conjugate);
        // A new direction begins with what this round has changed.
        row.conjugate = std::array::from_fn(|k| on[k] + row.impulses[k] - row.before[k]);
        if on != [0.0; 2] {
            row.push(movers, on);
            row.impulses = std::array::from_fn(|k| row.impulses[k] + on[k]);
            let change = (on[0] * row.compliances[0]).abs().max((on[1] * row.compliances[1]).abs());
            note(row, changes, change);
        }
    }
    present
}

/// Lists the rows of bodies that others may have moved by more than half of a residual: no other row is off by more than all of it.
fn ask(rows: &[Swept], (members, changes): (&[u32], &mut [f64]), residual: f64, asked: &mut Vec<u32>) {
    if let Some(fixed) = changes.last_mut() {
        *fixed = 0.0;
    }
    asked.clear();
    asked.resize(rows.len(), 0);
    let mut count = 0;
    for (index, row) in rows.iter().enumerate() {
        let [a, b] = row.noted.map(|body| body as usize);
        asked[count] = index as u32;
        count += usize::from(changes[a].max(changes[b]) > 0.5 * residual);
    }
    asked.truncate(count);
    for &body in members {
        let change = &mut changes[body as usize];
        *change = if *change > 0.5 * residual { 0.0 } else { *change };
    }
}

/// Lets the rows that are visited apart do what is asked of them; returns the largest change of a rate by that [m/s].
fn hold_apart(rows: &mut [Row], apart: &[SweptApart], movers: &mut [Mover], changes: &mut [f64]) -> f64 {
    let mut most = 0.0f64;
    for other in apart {
        let row = &mut rows[other.row as usize];
        let change = row.hold(movers);
        row.all_ends().for_each(|place| changes[place] += change);
        most = most.max(change);
    }
    most
}

/// Holds back what rolls.
fn hold_rolling(rows: &[Row], (rolls, rolling): (&mut [Roll], &[u32]), movers: &mut [Mover]) {
    for &roll in rolling {
        let Roll { row, line, bound } = &mut rolls[roll as usize];
        let row = &rows[*row as usize];
        let [a, b] = row.ends();
        let (mut p, mut q) = (movers[a], movers[b]);
        let bound = *bound * row.normal.impulse;
        let wanted = line.wanted(&p, &q).min(bound).max(-bound);
        line.set(&mut p, &mut q, wanted);
        (movers[a], movers[b]) = (p, q);
    }
}
