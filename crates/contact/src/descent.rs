//! A descent from forces that do not pull to those of the answer, many rows at a time.
//!
//! In a heap the closed rows carry each other: one wrong row among them turns the sign of a hundred forces, so that an
//! exchange of all wrong rows leads astray, and pivots mend them one by one. The forces of the answer minimise f.(Af +
//! 2b)/2 over f >= 0. A pass closes the rows that carry a force or would close without one, and moves the forces
//! towards the least value with these rows closed; a row that would pull on the way opens, and the others go on. Every
//! pass lowers the value, so that no set of closed rows comes back. This is the method of C. Lawson, R. Hanson,
//! "Solving Least Squares Problems", 1974, chapter 23, with many rows closed at once. A row that depends on others
//! keeps its force during a pass; at the end these forces are moved to independent rows, each along its null direction.
//! Pivots correct the rows that are still wrong. Where rows open one by one on the way, as those of a pyramid that
//! nearly depend on each other, another method is faster, and the descent stops there if it may.

use crate::closed_rows::ClosedRows;
use crate::dual_active_set::DualActiveSet;
use crate::problem::pushing;
use crate::settings::WELL;

/// Reciprocal of the fraction of closed rows that must pull for a descent: more than exchanges of blocks can mend.
const MANY: usize = 16;
/// Least number of closed rows that must pull for a descent.
const LEAST: usize = 8;

/// Least number of rows for a descent; with fewer, pivots are as fast.
const FEWEST_ROWS: usize = 64;

/// Cap on the passes.
const PASSES: usize = 24;

impl DualActiveSet {
    /// Descends from the closed forces that do not pull, if many others do.
    pub(crate) fn untangle(&mut self) {
        let closed = &self.closed;
        let pulls = |&&row: &&usize| closed.force[row] < 0.0 && !closed.free[row];
        let pulling = closed.rows.iter().filter(pulls).count();
        if self.may_descend() && pulling >= LEAST.max(closed.len() / MANY) {
            self.admissible.clear();
            self.admissible.extend(closed.force.iter().map(|&force| pushing(force)));
            self.descend();
        }
    }

    /// Whether there are many rows, all of them unilateral, and no term or spread is added to the matrix.
    pub(crate) fn may_descend(&self) -> bool {
        let closed = &self.closed;
        let is_plain = closed.spread == 0.0 && closed.proximal == 0.0 && closed.kept == 0;
        is_plain && closed.force.len() >= FEWEST_ROWS && !closed.free.contains(&true)
    }

    /// Descends from the forces in `admissible`. Closed rows, forces and accelerations fit each other afterwards; a
    /// closed force may pull, if only by rounding.
    pub(crate) fn descend(&mut self) {
        let mut force = std::mem::take(&mut self.admissible);
        self.start.fill(false);
        self.closed.open_all();
        self.closed.force.copy_from_slice(&force);
        self.closed.accelerate();
        for _ in 0..PASSES {
            if !self.mark_pushing(&force) {
                break;
            }
            self.close_pushing();
            self.go_to_face(&mut force);
            if self.is_out_of_patience() {
                self.admissible = force;
                return;
            }
            self.closed.force.copy_from_slice(&force);
            self.closed.accelerate();
        }
        self.move_to_basis(&mut force);
        self.closed.force.copy_from_slice(&force);
        self.closed.accelerate();
        // Rows that depend too nearly on others for a pass, or were left when the passes ended, were closed with the
        // forces they had.
        if self.closed.closed_error() > self.noise() {
            self.go_to_face(&mut force);
            self.closed.force.copy_from_slice(&force);
            self.closed.accelerate();
        }
        if self.closed.closed_error() > self.noise() {
            self.closed.solve_closed();
            self.closed.accelerate();
        }
        self.admissible = force;
    }

    /// Marks the rows that have a force or would close without one. Returns whether the marks have changed.
    fn mark_pushing(&mut self, force: &[f64]) -> bool {
        let limit = -self.noise();
        let closed = &self.closed;
        let mut any = false;
        for (row, start) in self.start.iter_mut().enumerate() {
            let closes = force[row] > 0.0 || closed.acceleration[row] < limit;
            let is_marked = closes && closed.system.movable[row];
            any |= std::mem::replace(start, is_marked) != is_marked;
        }
        any
    }

    /// Closes the marked rows as far as they are independent. All rows are closed anew, in the order that keeps the
    /// factor narrow, if the new rows outnumber the closed ones or the factor is wide.
    fn close_pushing(&mut self) {
        let closed = &self.closed;
        let fresh = (0..self.start.len()).filter(|&row| self.start[row] && !closed.is_closed(row)).count();
        if fresh > closed.len() || self.is_factor_wide() {
            self.closed.open_all();
            self.closed.close_independent(&self.start, WELL);
            return;
        }
        for row in 0..self.start.len() {
            if self.start[row] && !self.closed.is_closed(row) {
                let relation = self.closed.consider(row);
                if relation.complement > WELL {
                    self.closed.close(row, relation);
                }
            }
        }
    }

    /// Moves the closed forces to where the closed accelerations are zero, and opens rows whose force runs out on the
    /// way. Only the closed accelerations are kept up to date.
    fn go_to_face(&mut self, force: &mut [f64]) {
        while !self.is_out_of_patience() {
            let closed = &mut self.closed;
            let count = closed.len();
            for (at, &row) in closed.rows.iter().enumerate() {
                closed.step[at] = -closed.acceleration[row];
            }
            closed.factor.solve(&mut closed.step[..count]);
            let (length, first) = closed.go_along_step(force, 1.0);
            for &row in &closed.rows {
                closed.acceleration[row] *= 1.0 - length;
            }
            let Some(first) = first else { break };
            // A row without force that would pull cannot stay either.
            for at in (0..count).rev() {
                if at == first || (force[self.closed.rows[at]] == 0.0 && self.closed.step[at] < 0.0) {
                    self.closed.open_at(at);
                    self.count_work(1);
                }
            }
        }
    }
}

impl ClosedRows {
    /// Adds the step, times a length of at most `limit`, to the forces of the closed rows, until the first runs out.
    /// Returns the length and the position of that row.
    fn go_along_step(&self, force: &mut [f64], limit: f64) -> (f64, Option<usize>) {
        let (mut length, mut first) = (limit, None);
        for (at, &row) in self.rows.iter().enumerate() {
            if force[row] + length * self.step[at] < 0.0 {
                (length, first) = (force[row] / -self.step[at], Some(at));
            }
        }
        for (at, &row) in self.rows.iter().enumerate() {
            force[row] = pushing(force[row] + length * self.step[at]);
        }
        if let Some(first) = first {
            force[self.rows[first]] = 0.0;
        }
        (length, first)
    }
}

#[cfg(test)]
mod tests {
    use crate::dual_active_set::DualActiveSet;
    use crate::problem::{InverseInertia, Problem, Row};
    use crate::solution::Solution;
    use crate::solver::Solver;
    use crate::warm::WarmStart;

    /// Discs of 1 kg in rows of `across` discs, each on two of the row below, in directions that vary by some tenths
    /// of a radian; the discs at the ends of a row lean on walls.
    fn heap(across: usize, rows: usize) -> Problem {
        let mut problem = Problem::new();
        let inertia = InverseInertia { inverse_mass: 1.0, inverse_moment: 8.0 };
        let discs: Vec<_> = (0..across * rows).map(|_| problem.add_body(inertia).expect("a disc")).collect();
        let tilt = |index: usize| 0.5 * (1.7 * index as f64).sin();
        for (index, &disc) in discs.iter().enumerate() {
            let (row, column) = (index / across, index % across);
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                let (x, y) = (sign * 0.5 + tilt(2 * index + side), 0.8);
                let (x, y) = (x / f64::hypot(x, y), y / f64::hypot(x, y));
                let up = Row::new(disc, [x, y, 0.0], if row == 0 { -9.81 * y } else { 0.0 });
                let below =
                    (row > 0).then(|| discs[index - across + if column + side < across { side } else { 0 }]);
                let up = below.map_or(up, |below| up.against(below, [-x, -y, 0.0]));
                problem.add_row(&up).expect("a row");
            }
            if column == 0 || column + 1 == across {
                let inwards = if column == 0 { 1.0 } else { -1.0 };
                problem.add_row(&Row::new(disc, [inwards, 0.0, 0.0], 0.0)).expect("a row");
            }
        }
        problem
    }

    fn differ_by(a: &Solution, b: &Solution) -> f64 {
        let accelerations = a.acceleration.iter().zip(&b.acceleration);
        accelerations.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
    }

    #[test]
    fn the_forces_of_a_heap_take_few_pivots() {
        let problem = heap(12, 16);
        let (mut solver, mut solution) = (DualActiveSet::default(), Solution::new());
        solver.solve(&problem, &mut solution).expect("forces of a heap");
        assert!(solution.iterations < problem.len() / 16, "{} pivots", solution.iterations);
    }

    #[test]
    fn known_forces_are_gone_on_with() {
        let problem = heap(12, 16);
        let (mut solver, mut solution, mut warm) =
            (DualActiveSet::default(), Solution::new(), WarmStart::new());
        solver.solve(&problem, &mut solution).expect("forces of a heap");
        let mut again = Solution::new();
        for scale in [1.0, 0.5, 0.0] {
            warm.guess_forces(solution.force.iter().map(|force| Some(scale * force)));
            solver.solve_from(&problem, &warm, &mut again).expect("forces of a heap");
            assert!(differ_by(&again, &solution) < 1e-9);
            assert!(again.iterations == 0 || scale < 1.0, "{} pivots", again.iterations);
        }
        warm.guess_forces(solution.force.iter().map(|_| None));
        solver.solve_from(&problem, &warm, &mut again).expect("forces of a heap");
        assert!(differ_by(&again, &solution) < 1e-9);
    }
}
