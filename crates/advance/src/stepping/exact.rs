//! The rows of an island as one problem, solved to rounding by the modes of its contacts.

use crate::stepping::bodies::Bodies;
use crate::stepping::rows::{Drag, Line, Row};
use halfgap_collision::BodyId;
use halfgap_contact::{Modes, Problem, ProblemBody, Row as ProblemRow, RowKind, Settings, Solution, Solver, WarmStart};

/// Number of times that contacts may give way to the lesser coefficient: each of them does once.
const GIVING_WAY: usize = 8;

/// Residual up to which a solution is exact, in units of the load [-]: contacts that stick side by side contradict each other by the
/// rounding of coordinates over the length of a step. With 1e-12 a block on a slope at 1/960 s has no solution.
const RESIDUAL: f64 = 1e-9;

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
    /// Coefficient of each row of the problem that has friction.
    drags: Vec<(u32, u32, bool)>,
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
            drags: Vec::new(),
        }
    }
}

impl Exact {
    /// Finds the impulses of the listed rows for velocities without them, beginning with those that the rows have. On success the
    /// rows have the impulses and the velocities include them; otherwise nothing has changed.
    pub(super) fn solve(
        &mut self,
        bodies: &Bodies,
        (rows, list): (&mut [Row], &[u32]),
        places: &[u32],
        velocities: &mut [[f64; 3]],
    ) -> bool {
        self.pose(bodies, (rows, list), places, velocities);
        let mut is_solved = self.run();
        for _ in 0..GIVING_WAY {
            if !(is_solved && self.give_way(rows)) {
                break;
            }
            is_solved = self.run();
        }
        if is_solved {
            self.take(rows, list, velocities);
        }
        is_solved
    }

    fn run(&mut self) -> bool {
        self.warm.guess_forces(self.start.iter().map(|&force| Some(force)));
        let is_solved = self.modes.solve_from(&self.problem, &self.warm, &mut self.solution).is_ok();
        if is_solved {
            self.start.clone_from(&self.solution.force);
        }
        is_solved
    }

    fn pose(&mut self, bodies: &Bodies, (rows, list): (&[Row], &[u32]), places: &[u32], velocities: &[[f64; 3]]) {
        self.problem.clear();
        self.bodies.resize(bodies.count() + 1, None);
        for &place in places {
            let inertia = bodies.inertia(BodyId::from_index(place as usize));
            self.bodies[place as usize] = self.problem.add_body(inertia).ok().map(|body| body.0);
        }
        self.first.clear();
        self.start.clear();
        self.drags.clear();
        for &index in list {
            let row = &rows[index as usize];
            let normal = self.problem.len();
            self.first.push(normal as u32);
            let posed = self.posed(row, &row.normal, velocities);
            self.add(if row.is_bilateral { posed.bilateral() } else { posed }, row.normal.impulse);
            for (is_roll, drag) in [(false, &row.slip), (true, &row.roll)] {
                let Some(drag) = drag else { continue };
                self.drags.push((self.problem.len() as u32, index, is_roll));
                let posed = self.posed(row, &drag.line, velocities).friction(normal, drag.coefficient);
                self.add(posed, drag.line.impulse);
            }
        }
        for &place in places {
            self.bodies[place as usize] = None;
        }
    }

    fn posed(&self, row: &Row, line: &Line, velocities: &[[f64; 3]]) -> ProblemRow {
        let sides = row.places.map(|place| self.bodies[place].map(ProblemBody));
        let offset = line.rate(row.places, velocities) + line.offset;
        // A row of the island has a body that can move.
        ProblemRow::between(sides, &line.jacobian, offset).unwrap_or_else(|| ProblemRow::new(ProblemBody(0), [0.0; 3], 0.0))
    }

    fn add(&mut self, row: ProblemRow, impulse: f64) {
        if self.problem.add_row(&row).is_ok() {
            self.start.push(impulse);
        }
    }

    /// Lets the contacts that were held as by static friction, and slip, be held back by kinetic friction; false if there are none. Where
    /// forces are redundant, one at its bound tells nothing: others may hold.
    fn give_way(&mut self, rows: &[Row]) -> bool {
        let mut gives = false;
        for &(row, source, is_roll) in &self.drags {
            let source = &rows[source as usize];
            let Some(drag) = (if is_roll { &source.roll } else { &source.slip }) else { continue };
            let row = row as usize;
            let RowKind::Friction { normal, coefficient } = self.problem.kind(row) else { continue };
            if drag.kinetic == coefficient {
                continue;
            }
            let [force, pressing] = [row, normal].map(|row| self.solution.force[row]);
            let slip = self.solution.acceleration[row] * drag.line.weight;
            if Drag::slips(force, coefficient * pressing, slip) {
                let kind = RowKind::Friction { normal, coefficient: drag.kinetic };
                gives |= self.problem.set_kind(row, kind).is_ok();
            }
        }
        gives
    }

    fn take(&self, rows: &mut [Row], list: &[u32], velocities: &mut [[f64; 3]]) {
        for (&index, &first) in list.iter().zip(&self.first) {
            let row = &mut rows[index as usize];
            let first = first as usize;
            let slip = if row.slip.is_some() { self.solution.force[first + 1] } else { 0.0 };
            let roll = if row.roll.is_some() { self.solution.force[first + 1 + usize::from(row.slip.is_some())] } else { 0.0 };
            row.set_impulses([self.solution.force[first], slip, roll]);
            row.push_all(velocities, 1.0);
        }
    }
}
