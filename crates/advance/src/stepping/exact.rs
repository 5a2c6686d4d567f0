//! The rows of an island as one problem, solved to rounding by the modes of its contacts.

use crate::stepping::apart::Third;
use crate::stepping::rows::{Line, Mover, Roll, Row};
use crate::stepping::sweeps::Problem as Island;
use halfgap_contact::{
    InverseInertia, Modes, Problem, ProblemBody, Row as ProblemRow, RowKind, Settings, Solution, Solver,
    WarmStart,
};

/// Number of times that contacts may give way to the lesser coefficient: each of them does once.
const GIVING_WAY: usize = 8;

/// Residual up to which a solution is exact, in units of the load [-]: contacts that stick side by side contradict each other by the
/// rounding of coordinates over the length of a step. With 1e-12 a block on a slope at 1/960 s has no solution.
const RESIDUAL: f64 = 1e-9;

/// How much is done for a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effort {
    /// All that is known.
    Full,
    /// Forces are near those of the solution, or none is found.
    Near,
}

/// The solver with its buffers.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Exact {
    problem: Problem,
    solution: Solution,
    warm: WarmStart,
    modes: Modes,
    /// The body of the problem for each place, valid for those of the island.
    bodies: Vec<Option<u32>>,
    /// Row of the problem for each row of the list: that along the normal, those of slip and roll follow.
    first: Vec<u32>,
    start: Vec<f64>,
}

impl Default for Exact {
    fn default() -> Self {
        let settings = Settings { natural_residual: RESIDUAL, ..Settings::default() };
        Self {
            problem: Problem::default(),
            solution: Solution::default(),
            warm: WarmStart::default(),
            // Settings that differ from the default by a positive number are fine.
            modes: Modes::new(settings).unwrap_or_default(),
            bodies: Vec::new(),
            first: Vec::new(),
            start: Vec::new(),
        }
    }
}

impl Exact {
    /// Finds the impulses of the rows of an island for velocities without them, beginning with those that the rows have. On success
    /// the rows have the impulses and the velocities include them; otherwise nothing has changed.
    pub(super) fn solve(
        &mut self,
        island: &mut Island<'_>,
        members: &[u32],
        (span, slack): (f64, f64),
        effort: Effort,
    ) -> bool {
        self.pose(island, members, (span, slack));
        let mut is_solved = self.run(effort);
        for _ in 0..GIVING_WAY {
            if !(is_solved && self.give_way(island)) {
                break;
            }
            is_solved = self.run(effort);
        }
        if is_solved {
            self.take(island);
        }
        is_solved
    }

    fn run(&mut self, effort: Effort) -> bool {
        self.warm.guess_forces(self.start.iter().map(|&force| Some(force)));
        let outcome = match effort {
            Effort::Full => self.modes.solve_from(&self.problem, &self.warm, &mut self.solution),
            Effort::Near => self.modes.solve_near(&self.problem, &self.warm, &mut self.solution),
        };
        let is_solved = outcome.is_ok();
        if is_solved {
            self.start.clone_from(&self.solution.force);
        }
        is_solved
    }

    fn pose(&mut self, island: &Island<'_>, members: &[u32], (span, slack): (f64, f64)) {
        self.problem.clear();
        self.bodies.resize(island.movers.len(), None);
        for &place in members {
            let Mover { inverse_mass, inverse_moment, .. } = island.movers[place as usize];
            let body = self.problem.add_body(InverseInertia { inverse_mass, inverse_moment });
            self.bodies[place as usize] = body.ok().map(|body| body.0);
        }
        self.first.clear();
        self.start.clear();
        for &index in island.list {
            let row = &island.rows[index as usize];
            let normal = self.problem.len();
            self.first.push(normal as u32);
            // What overlaps a little, or has slipped a little, is brought back by the velocities: that keeps motions smooth.
            let back = if row.is_bilateral { 0.0 } else { row.gap.clamp(-slack, 0.0) / span };
            let offset = row.change_of(island.movers) + row.normal.offset + back;
            let posed = self.posed(row, &row.jacobian(), row.third(), offset);
            let posed = match row.bounds() {
                _ if row.is_bilateral => posed.bilateral(),
                [least, most] if row.pulls() => posed.bounded(least, most),
                _ => posed,
            };
            self.add(posed, row.normal.impulse);
            if row.slip.line.is_some() {
                let posed = self.posed_line(island, row, &row.slip.line, row.slip.off / span);
                self.add(posed.friction(normal, row.slip.bounds[0]), row.slip.line.impulse);
            }
            if let Some(roll) = row.roll {
                let Roll { line, bound, .. } = &island.rolls[roll as usize];
                self.add(self.posed_line(island, row, line, 0.0).friction(normal, *bound), line.impulse);
            }
        }
        for &place in members {
            self.bodies[place as usize] = None;
        }
    }

    fn posed_line(&self, island: &Island<'_>, row: &Row, line: &Line, back: f64) -> ProblemRow {
        let [p, q] = row.ends().map(|place| &island.movers[place].velocity);
        self.posed(row, &line.jacobian(), None, line.rate(p, q) + line.offset + back)
    }

    fn posed(&self, row: &Row, jacobian: &[f64; 6], third: Option<Third>, offset: f64) -> ProblemRow {
        let sides = row.ends().map(|place| self.bodies[place].map(ProblemBody));
        let of_two = ProblemRow::between(sides, jacobian, offset);
        let third =
            third.and_then(|Third { place, arm }| Some((ProblemBody(self.bodies[place as usize]?), arm)));
        let posed = match third {
            Some((body, arm)) => Some(ProblemRow::turning(of_two, body, arm, offset)),
            None => of_two,
        };
        // A row of the island has a body that can move.
        posed.unwrap_or_else(|| ProblemRow::new(ProblemBody(0), [0.0; 3], 0.0))
    }

    fn add(&mut self, row: ProblemRow, impulse: f64) {
        if self.problem.add_row(&row).is_ok() {
            self.start.push(impulse);
        }
    }

    /// Lets the contacts that were held as by static friction, and slip, be held back by kinetic friction; false if there are none. Where
    /// forces are redundant, one at its bound tells nothing: others may hold.
    fn give_way(&mut self, island: &Island<'_>) -> bool {
        let mut gives = false;
        for (place, &index) in island.list.iter().enumerate() {
            let Row { slip, .. } = &island.rows[index as usize];
            if slip.bounds[0] == slip.bounds[1] {
                continue;
            }
            let row = self.first[place] as usize + 1;
            let RowKind::Friction { normal, coefficient } = self.problem.kind(row) else { continue };
            let [force, pressing] = [row, normal].map(|row| self.solution.force[row]);
            let stopping = self.solution.acceleration[row] * slip.line.weight;
            if coefficient != slip.bounds[1] && Line::slips(force, coefficient * pressing, stopping) {
                let kind = RowKind::Friction { normal, coefficient: slip.bounds[1] };
                gives |= self.problem.set_kind(row, kind).is_ok();
            }
        }
        gives
    }

    fn take(&self, island: &mut Island<'_>) {
        for (&index, &first) in island.list.iter().zip(&self.first) {
            let row = &mut island.rows[index as usize];
            let mut forces = self.solution.force[first as usize..].iter().copied();
            row.normal.impulse = forces.next().unwrap_or(0.0);
            if row.slip.line.is_some() {
                row.slip.line.impulse = forces.next().unwrap_or(0.0);
            }
            row.push_impulses(island.movers);
            if let Some(roll) = row.roll {
                let line = &mut island.rolls[roll as usize].line;
                line.impulse = forces.next().unwrap_or(0.0);
                let [a, b] = row.ends();
                let (mut p, mut q) = (island.movers[a], island.movers[b]);
                line.push(&mut p, &mut q, line.impulse);
                (island.movers[a], island.movers[b]) = (p, q);
            }
        }
    }
}
