//! Projected sweeps over the rows of an island: each in turn gets the impulse by which it does what is asked of it, forwards and
//! backwards, until none changes its rate by more than a residual. Between rounds the impulses go on along a conjugate direction,
//! as long as rounds change them less and less.
//!
//! *Invariant*: the velocities are those of the start with the response to all impulses.
//!
//! Sources: J. J. Moreau, CISM Courses 302 (1988) (sweeps); M. Silcowitz, S. Niebe, K. Erleben, The Visual Computer 26 (2010)
//! (nonlinear conjugate gradients over them).

use crate::stepping::bodies::{Bodies, Motion3};
use crate::stepping::rows::{Drag, Line, Row};
use halfgap_collision::BodyId;

/// A body of the island, or one that cannot move: its velocity, and what an impulse and its moment change of it.
#[derive(Clone, Copy, Debug, Default)]
struct Mover {
    velocity: Motion3,
    inverse_mass: f64,
    inverse_moment: f64,
}

/// A direction in which a row acts: J = [x, y, a, -x, -y, b].
#[derive(Clone, Copy, Debug, Default)]
struct Direction {
    x: f64,
    y: f64,
    a: f64,
    b: f64,
    offset: f64,
    weight: f64,
    impulse: f64,
    /// Impulse before the round, and the direction along which the next begins.
    before: f64,
    conjugate: f64,
}

/// A row: along the normal, and along the surface if it has friction.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    movers: [u32; 2],
    is_bilateral: bool,
    normal: Direction,
    slip: Direction,
    /// Bounds of the impulse along the surface, as multiples of that along the normal: until it gives way, and then.
    bounds: [f64; 2],
}

/// A row against rolling, with the place of its cell.
#[derive(Clone, Copy, Debug, Default)]
struct Roll {
    cell: u32,
    direction: Direction,
    bound: f64,
}

/// Buffers of the sweeps.
#[derive(Clone, Debug, Default)]
pub(super) struct Sweeps {
    movers: Vec<Mover>,
    /// Place in `movers` of each body, valid for those of the island.
    mover_of: Vec<u32>,
    cells: Vec<Cell>,
    rolls: Vec<Roll>,
}

impl Direction {
    #[inline(always)]
    fn rate(&self, p: &Mover, q: &Mover) -> f64 {
        (self.x * (p.velocity[0] - q.velocity[0]) + self.y * (p.velocity[1] - q.velocity[1]))
            + (self.a * p.velocity[2] + self.b * q.velocity[2])
            + self.offset
    }

    #[inline(always)]
    fn push(&self, p: &mut Mover, q: &mut Mover, impulse: f64) {
        let (x, y) = (self.x * impulse, self.y * impulse);
        p.velocity[0] += p.inverse_mass * x;
        p.velocity[1] += p.inverse_mass * y;
        p.velocity[2] += p.inverse_moment * self.a * impulse;
        q.velocity[0] -= q.inverse_mass * x;
        q.velocity[1] -= q.inverse_mass * y;
        q.velocity[2] += q.inverse_moment * self.b * impulse;
    }

    /// Changes the impulse, and the velocities by it; returns by how much the rate has changed [m/s].
    #[inline(always)]
    fn set(&mut self, p: &mut Mover, q: &mut Mover, impulse: f64) -> f64 {
        let change = impulse - self.impulse;
        self.push(p, q, change);
        self.impulse = impulse;
        change.abs()
    }
}

impl Cell {
    /// Gives the row the impulses by which it does what is asked; returns the largest change of an impulse times the
    /// compliance of its row.
    #[inline(always)]
    fn visit(&mut self, movers: &mut [Mover]) -> f64 {
        let [a, b] = self.movers.map(|mover| mover as usize);
        let (mut p, mut q) = (movers[a], movers[b]);
        let wanted = self.normal.impulse - self.normal.rate(&p, &q) * self.normal.weight;
        let pressing = if self.is_bilateral { wanted } else { wanted.max(0.0) };
        let mut most = self.normal.set(&mut p, &mut q, pressing) / self.normal.weight;
        if self.slip.weight > 0.0 {
            let wanted = self.slip.impulse - self.slip.rate(&p, &q) * self.slip.weight;
            let [sticking, slipping] = self.bounds.map(|bound| bound * pressing);
            let held = if wanted.abs() <= sticking { wanted } else { wanted.clamp(-slipping, slipping) };
            most = most.max(self.slip.set(&mut p, &mut q, held) / self.slip.weight);
        }
        movers[a] = p;
        movers[b] = q;
        most
    }
}

impl Sweeps {
    /// Changes the velocities of an island, which do not include the impulses that the listed rows have, by better ones, until no
    /// rate changes by more than `residual` [m/s], in at most so many rounds.
    pub(super) fn solve(
        &mut self,
        bodies: &Bodies,
        (rows, list): (&mut [Row], &[u32]),
        members: &[u32],
        velocities: &mut [Motion3],
        (residual, rounds): (f64, u32),
    ) {
        self.load(bodies, (rows, list), members, velocities);
        let mut last = f64::INFINITY;
        let mut dbg=0; let mut m0=0.0; let mut ml=0.0;
        for _ in 0..rounds {
            for cell in &mut self.cells {
                (cell.normal.before, cell.slip.before) = (cell.normal.impulse, cell.slip.impulse);
            }
            let mut most = self.cells.iter_mut().map(|cell| cell.visit(&mut self.movers)).fold(0.0, f64::max);
            most = self.hold_rolling(most);
            if dbg==0 {m0=most;} ml=most; dbg+=1;
            let rel: f64 = std::env::var("REL").ok().and_then(|x| x.parse().ok()).unwrap_or(1.0);
            if most <= residual.min(rel*m0).max(1e-6*residual) {
                break;
            }
            for cell in self.cells.iter_mut().rev() {
                cell.visit(&mut self.movers);
            }
            last = self.go_on(last);
        }
        if std::env::var("DBG").is_ok() { eprintln!("SWEEPS cells {} rounds {} first {:e} last {:e} residual {:e}", self.cells.len(), dbg, m0, ml, residual); }
        // The last sweep leaves no impulse that pulls.
        for cell in &mut self.cells {
            cell.visit(&mut self.movers);
        }
        self.unload((rows, list), members, velocities);
    }

    /// Goes on along the conjugate direction, given the square of the change in the round before; returns that of this one.
    fn go_on(&mut self, last: f64) -> f64 {
        let square = |direction: &Direction| (direction.impulse - direction.before) * (direction.impulse - direction.before);
        let present: f64 = self.cells.iter().map(|cell| square(&cell.normal) + square(&cell.slip)).sum();
        let share = if present < last && std::env::var("NOCG").is_err() { present / last } else { 0.0 };
        for cell in &mut self.cells {
            let [a, b] = cell.movers.map(|mover| mover as usize);
            for direction in [&mut cell.normal, &mut cell.slip] {
                let (on, swept) = (share * direction.conjugate, direction.impulse - direction.before);
                direction.conjugate = if share > 0.0 { on + swept } else { 0.0 };
                if on != 0.0 {
                    let (mut p, mut q) = (self.movers[a], self.movers[b]);
                    direction.push(&mut p, &mut q, on);
                    direction.impulse += on;
                    (self.movers[a], self.movers[b]) = (p, q);
                }
            }
        }
        present
    }

    /// Holds back what rolls; returns the greater of a change and the largest of these.
    fn hold_rolling(&mut self, mut most: f64) -> f64 {
        for Roll { cell, direction, bound } in &mut self.rolls {
            let Cell { movers, normal, .. } = &self.cells[*cell as usize];
            let [a, b] = movers.map(|mover| mover as usize);
            let (mut p, mut q) = (self.movers[a], self.movers[b]);
            let wanted = direction.impulse - direction.rate(&p, &q) * direction.weight;
            let bound = *bound * normal.impulse;
            let change = direction.set(&mut p, &mut q, wanted.clamp(-bound, bound));
            // As the rate of a row along the normal that has the same response.
            most = most.max(change / (direction.weight * normal.weight).sqrt());
            (self.movers[a], self.movers[b]) = (p, q);
        }
        most
    }

    fn load(&mut self, bodies: &Bodies, (rows, list): (&[Row], &[u32]), members: &[u32], velocities: &[Motion3]) {
        let Self { movers, mover_of, cells, rolls } = self;
        movers.clear();
        mover_of.resize(bodies.count() + 1, 0);
        for &member in members {
            mover_of[member as usize] = movers.len() as u32;
            let inertia = bodies.inertia(BodyId(member));
            movers.push(Mover {
                velocity: velocities[member as usize],
                inverse_mass: inertia.inverse_mass,
                inverse_moment: inertia.inverse_moment,
            });
        }
        cells.clear();
        rolls.clear();
        for &index in list {
            let row = &rows[index as usize];
            let ends = [0, 1].map(|side: usize| {
                if bodies.is_fixed(row.bodies[side]) {
                    movers.push(Mover { velocity: velocities[row.places[side]], ..Mover::default() });
                    movers.len() as u32 - 1
                } else {
                    mover_of[row.places[side]]
                }
            });
            let place = cells.len() as u32;
            cells.push(Cell {
                movers: ends,
                is_bilateral: row.is_bilateral,
                normal: direction(&row.normal),
                slip: row.slip.as_ref().map_or(Direction::default(), |drag| direction(&drag.line)),
                bounds: row.slip.as_ref().map_or([0.0; 2], |drag| [drag.coefficient, drag.kinetic]),
            });
            if let Some(Drag { line, coefficient, .. }) = &row.roll {
                rolls.push(Roll { cell: place, direction: direction(line), bound: *coefficient });
            }
        }
        for cell in cells.iter() {
            let [a, b] = cell.movers.map(|mover| mover as usize);
            let (mut p, mut q) = (movers[a], movers[b]);
            cell.normal.push(&mut p, &mut q, cell.normal.impulse);
            cell.slip.push(&mut p, &mut q, cell.slip.impulse);
            (movers[a], movers[b]) = (p, q);
        }
        for roll in rolls.iter() {
            let [a, b] = cells[roll.cell as usize].movers.map(|mover| mover as usize);
            let (mut p, mut q) = (movers[a], movers[b]);
            roll.direction.push(&mut p, &mut q, roll.direction.impulse);
            (movers[a], movers[b]) = (p, q);
        }
    }

    fn unload(&self, (rows, list): (&mut [Row], &[u32]), members: &[u32], velocities: &mut [Motion3]) {
        for (&member, mover) in members.iter().zip(&self.movers) {
            velocities[member as usize] = mover.velocity;
        }
        for (&index, cell) in list.iter().zip(&self.cells) {
            rows[index as usize].set_impulses([cell.normal.impulse, cell.slip.impulse, 0.0]);
        }
        for roll in &self.rolls {
            if let Some(drag) = &mut rows[list[roll.cell as usize] as usize].roll {
                drag.line.impulse = roll.direction.impulse;
            }
        }
    }
}

fn direction(line: &Line) -> Direction {
    let [x, y, a, _, _, b] = line.jacobian;
    let Line { offset, weight, impulse, .. } = *line;
    Direction { x, y, a, b, offset, weight, impulse, before: 0.0, conjugate: 0.0 }
}
