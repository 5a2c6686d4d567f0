//! Moves forces that many rows share to rows that do not depend on each other: those of a method that spreads them, if
//! the settings ask for a vertex, and those at the end of a descent.

use crate::dual_active_set::{DualActiveSet, REFINED};
use crate::error::SolveError;
use crate::exchanges::{Party, first_to_vanish};
use crate::problem::{Problem, pushing};
use crate::settings::WELL;
use crate::solution::Solution;
use crate::start::Start;

/// Largest number of rows that leave one by one; for more a new factor is cheaper.
const FEW: usize = 8;

impl DualActiveSet {
    /// Moves the forces of another method's `solution` to independent rows, and makes that the answer.
    pub(crate) fn cross_over(
        &mut self,
        problem: &Problem,
        solution: &mut Solution,
    ) -> Result<(), SolveError> {
        let mut force = std::mem::take(&mut self.admissible);
        force.clear();
        force.extend_from_slice(&solution.force);
        let attempt = self.attempts().first;
        self.prepare(problem, Start::Nothing, solution, attempt);
        force.iter_mut().zip(&self.closed.system.row_scale).for_each(|(force, scale)| *force *= scale);
        for (row, start) in self.start.iter_mut().enumerate() {
            *start = problem.bilateral[row] || (force[row] > 0.0 && self.closed.system.movable[row]);
        }
        self.closed.open_all();
        if !self.closed.close_independent(&self.start, WELL) {
            self.closed.open_all();
            if let Some(certificate) = self.close_connectors(problem) {
                return Err(SolveError::Infeasible(certificate));
            }
            self.closed.close_independent(&self.start, WELL);
        }
        self.move_to_basis(&mut force);
        self.closed.force.copy_from_slice(&force);
        self.admissible = force;
        self.closed.accelerate();
        if !self.refine_closed() {
            self.closed.solve_closed();
            self.closed.accelerate();
            self.make_forces_admissible();
        }
        let end = self.pivot(problem, attempt);
        self.finish(problem, solution, end)
    }

    /// Refines the closed forces, which do not pull, until the closed accelerations are within the noise; false if that
    /// fails.
    fn refine_closed(&mut self) -> bool {
        let mut refinements = 0;
        while self.closed.closed_error() > REFINED * self.noise() {
            if refinements == self.settings.refinements {
                return self.closed.closed_error() <= self.noise();
            }
            refinements += 1;
            self.closed.refine();
            self.closed.accelerate();
        }
        true
    }

    /// Moves the forces of open rows, which depend on closed ones, to these. A closed row whose force runs out opens,
    /// and the open row closes in its place.
    pub(crate) fn move_to_basis(&mut self, force: &mut [f64]) {
        loop {
            self.exchange_for(force);
            if self.exchanges.is_empty() {
                return;
            }
            self.close_exchanged();
        }
    }

    /// Moves the forces of open rows one after the other, and notes the closed rows that they replace, until the factor
    /// must be made anew.
    fn exchange_for(&mut self, force: &mut [f64]) {
        let Self { closed, exchanges, shares, .. } = self;
        exchanges.clear();
        shares.clear();
        shares.resize(force.len(), 0.0);
        for row in 0..force.len() {
            let has_entered = exchanges.pairs().any(|(entered, _)| entered == row);
            if force[row] == 0.0 || closed.is_closed(row) || has_entered {
                continue;
            }
            let relation = closed.consider(row);
            if !relation.dependent {
                closed.close(row, relation);
                continue;
            }
            closed.find_response();
            // A connector may pull: its force is then that of the reversed row, whose shares have the other sign.
            let sign = force[row].signum();
            shares.fill(0.0);
            for (&other, step) in closed.rows.iter().zip(&closed.step) {
                shares[other] = sign * step;
            }
            exchanges.substitute(shares);
            // Rows are scaled to a square of one.
            let party = |row: usize, share: f64| Party { row, force: force[row].abs(), share, square: 1.0 };
            let unilateral = (0..force.len()).filter(|&other| shares[other] != 0.0 && !closed.free[other]);
            let dependent = party(row, -1.0);
            let (left, moved) =
                first_to_vanish(dependent, unilateral.map(|other| party(other, shares[other])));
            for (other, share) in shares.iter().enumerate().filter(|(_, share)| **share != 0.0) {
                let now = force[other] + moved * share;
                force[other] = if closed.free[other] { now } else { pushing(now) };
            }
            force[row] -= sign * moved;
            force[left.row] = 0.0;
            if left.row != row {
                shares.iter_mut().for_each(|share| *share *= sign);
                exchanges.push(dependent, Party { share: sign * left.share, ..left }, shares);
            }
            if exchanges.is_full() {
                return;
            }
        }
    }

    /// Closes the rows that entered in place of those that left.
    fn close_exchanged(&mut self) {
        let Self { closed, exchanges, start, .. } = self;
        for (row, start) in start.iter_mut().enumerate() {
            *start = closed.is_closed(row);
        }
        for (entered, left) in exchanges.pairs() {
            (start[entered], start[left]) = (true, false);
        }
        let leave = exchanges.pairs().filter(|&(_, left)| !start[left]);
        if leave.clone().count() > FEW {
            closed.open_all();
            closed.close_flagged(start);
            return;
        }
        for (_, left) in leave {
            if let Some(at) = closed.position_of(left) {
                closed.open_at(at);
            }
        }
        for (entered, _) in exchanges.pairs().filter(|&(entered, _)| start[entered]) {
            closed.try_close(entered);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::proximal_newton::ProximalNewton;
    use crate::solver::Solver;
    use crate::test_problems::pyramid;

    /// Moves the forces that the proximal method shares among the rows of a pyramid, in which every n-th row is
    /// bilateral.
    fn check(layers: usize, every: usize) {
        let mut problem = pyramid(layers, 0.5);
        let bilateral: Vec<bool> = (0..problem.len()).map(|row| row % every == every - 1).collect();
        problem.set_bilateral(&bilateral).expect("a flag for each row");
        let (mut dual, mut shared) = (DualActiveSet::default(), Solution::new());
        ProximalNewton::default().solve(&problem, &mut shared).expect("forces of a pyramid");
        let mut moved = shared.clone();
        dual.cross_over(&problem, &mut moved).expect("the same forces on other rows");
        let carrying = |solution: &Solution| solution.force.iter().filter(|force| **force != 0.0).count();
        assert!(carrying(&moved) < carrying(&shared), "{} of {}", carrying(&moved), carrying(&shared));
        // The rows that carry force are independent: all of them can be closed at once.
        let flags: Vec<bool> = moved.force.iter().map(|force| *force != 0.0).collect();
        dual.closed.open_all();
        dual.closed.close_independent(&flags, 0.0);
        assert_eq!(dual.closed.len(), carrying(&moved));
        let errors = moved.acceleration.iter().zip(&shared.acceleration).map(|(a, b)| (a - b).abs());
        assert!(errors.fold(0.0, f64::max) < 1e-9);
    }

    #[test]
    fn shared_forces_are_moved_to_independent_rows() {
        for layers in [3, 8, 14] {
            check(layers, usize::MAX);
        }
    }

    #[test]
    fn forces_are_shared_by_connectors_too() {
        for every in [3, 7, 20] {
            check(10, every);
        }
    }
}
