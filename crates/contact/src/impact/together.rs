//! Rows solved in one problem.

use super::Impact;
use super::law::ImpactError;
use super::many_rows::Beginning;
use super::pair_problem::{solve_one, solve_two};
use super::patience::Patience;
use crate::row::CollisionRow;

/// Fraction of the sum of the absolute works of the impulses: impulses whose net work exceeds it drive the bodies, as a
/// rebound gains nothing but rounding.
const GAIN: f64 = 1e-3;

impl Impact {
    /// Brings the bilateral rows to rest, alone and without elasticity, if one of them is violated.
    ///
    /// Later problems hold them, and their impulses then do no work along them. A rate left in one could add energy
    /// where the elasticity of a contact drives it on.
    pub(super) fn settle_connectors(&mut self, small: f64) -> Result<(), ImpactError> {
        if !(0..self.rows.len()).any(|row| self.rows[row].is_bilateral() && self.is_violated(row, small)) {
            return Ok(());
        }
        let mut set = std::mem::take(&mut self.scratch.set);
        set.clear();
        set.extend((0..self.rows.len()).filter(|&row| self.rows[row].is_bilateral() && self.can_move(row)));
        self.aim_at_rest();
        let outcome = self.solve_together(&set);
        self.scratch.set = set;
        outcome
    }

    /// Solves problems of all rows until none is violated or the patience ends. Rows that close are to rebound.
    /// Bilateral rows are active, and so are rows at rest, which count as such up to an opening rate of `rest` [m/s]: a
    /// row that was active has some rate of either sign.
    ///
    /// A row that opens stays out of the problem, even if the impulses turn it round, because holding it would add
    /// energy. If it then closes, the next round solves it with all others that close. Where rows nearly depend on each
    /// other and no impulses hold them all, the impulses found may drive the bodies instead. Such a round is taken
    /// back, and the closing rows are left to be stopped without elasticity.
    pub(super) fn solve_all(&mut self, rest: f64, patience: &mut Patience) -> Result<(), ImpactError> {
        let mut set = std::mem::take(&mut self.scratch.set);
        let mut outcome = Ok(());
        while outcome.is_ok() && self.is_any_violated(patience.small()) {
            self.list_held(&mut set, rest);
            self.scratch.rates.clone_from(&self.rates);
            self.scratch.impulses.clone_from(&self.impulses);
            outcome = self.rebound_together(&set);
            if outcome.is_ok() && self.has_gained() {
                self.rates.clone_from(&self.scratch.rates);
                self.impulses.clone_from(&self.scratch.impulses);
                break;
            }
            if !patience.spend(set.len()) {
                break;
            }
        }
        self.scratch.set = set;
        outcome
    }

    /// True if the impulses since the saved rates and impulses have done net work on the bodies beyond rounding.
    fn has_gained(&self) -> bool {
        let before = self.scratch.impulses.iter().zip(&self.scratch.rates);
        let rows = before.zip(self.impulses.iter().zip(&self.rates));
        let (mut work, mut size) = (0.0, 0.0);
        for ((old_impulse, old_rate), (impulse, rate)) in rows {
            let change = impulse - old_impulse;
            work += 0.5 * change * (old_rate + rate);
            size += 0.5 * change.abs() * (old_rate.abs() + rate.abs());
        }
        work > GAIN * size
    }

    /// Solves one problem without elasticity of the rows that close, rest, or open slowly, and again with the rows that
    /// it drives to close, until it drives none. Without elasticity the answer is the nearest admissible motion, so
    /// that no row need stay out; with slowly opening rows in the first problem, fewer are left to be driven, and fewer
    /// problems follow. The first problem starts from the impulses that rows were unloaded by, if any, each later one
    /// from the rows that carried impulses in the one before.
    pub(super) fn solve_all_inelastic(&mut self, small: f64) -> Result<(), ImpactError> {
        self.aim_at_rest();
        self.scratch.rates.clone_from(&self.rates);
        self.scratch.impulses.clone_from(&self.impulses);
        let mut set = std::mem::take(&mut self.scratch.set);
        let mut likely = std::mem::take(&mut self.scratch.listed);
        self.list_slow(&mut set, &mut likely, small);
        let mut carried = std::mem::take(&mut self.scratch.carried);
        let mut begin =
            if carried.is_empty() { Beginning::Likely(&likely) } else { Beginning::Carried(&carried) };
        let outcome = loop {
            if let Err(error) = self.solve_beginning_with(&set, begin) {
                break Err(error);
            }
            let count = set.len();
            self.add_driven(&mut set, &mut likely, small);
            if set.len() == count {
                break Ok(());
            }
            set.sort_unstable();
            self.rates.clone_from(&self.scratch.rates);
            self.impulses.clone_from(&self.scratch.impulses);
            begin = Beginning::Likely(&likely);
        };
        // The violations after the first problem are small and unrelated to the impulses that were carried.
        carried.clear();
        self.scratch.carried = carried;
        self.scratch.set = set;
        self.scratch.listed = likely;
        outcome
    }

    /// Lists the rows that close or rest, with a flag each, and the rows that open no faster than the fastest of them
    /// closes, in the scaled rates of the solver: these do not change the scale of the problem.
    fn list_slow(&self, set: &mut Vec<usize>, likely: &mut Vec<bool>, small: f64) {
        let rest = self.rest(small);
        let movable = || (0..self.rows.len()).filter(|&row| self.can_move(row));
        let fastest = movable().fold(0.0f64, |most, row| most.max(self.violation(row) / self.length(row)));
        likely.clear();
        likely
            .extend((0..self.rows.len()).map(|row| self.rows[row].is_bilateral() || self.rates[row] <= rest));
        set.clear();
        set.extend(movable().filter(|&row| likely[row] || self.rates[row] <= fastest * self.length(row)));
    }

    /// Adds the rows that close now and are not in the ascending `set`. Flags them, and the rows that got an impulse in
    /// the last problem.
    fn add_driven(&self, set: &mut Vec<usize>, likely: &mut [bool], small: f64) {
        let count = set.len();
        for (row, likely) in likely.iter_mut().enumerate() {
            let is_driven = self.is_violated(row, small) && set[..count].binary_search(&row).is_err();
            *likely = is_driven || self.impulses[row] != self.scratch.impulses[row];
            if is_driven {
                set.push(row);
            }
        }
    }

    /// Does as [`solve_together`](Self::solve_together); more than two rows start from `begin`.
    fn solve_beginning_with(&mut self, set: &[usize], begin: Beginning<'_>) -> Result<(), ImpactError> {
        if set.len() > 2 { self.solve_many(set, begin) } else { self.solve_together(set) }
    }

    /// Lists the bilateral rows, the rows that close or open no faster than `rest` [m/s], and the rows that were active
    /// before the impact and open no faster than their `velocity_tol`.
    pub(super) fn list_held(&self, set: &mut Vec<usize>, rest: f64) {
        let limit = self.rest(rest);
        let is_slow = |row: &CollisionRow, rate| {
            rate <= if row.was_active { limit.max(row.velocity_tol) } else { limit }
        };
        let is_active = |&index: &usize| {
            let row = &self.rows[index];
            (row.is_bilateral() || is_slow(row, self.rates[index])) && self.can_move(index)
        };
        set.clear();
        set.extend((0..self.rows.len()).filter(is_active));
    }

    /// Solves the rows of an ascending set together; those that close are to rebound.
    ///
    /// Rows that hardly open are held as if at rest. Where rows depend on each other such that they cannot all rebound,
    /// as in a wedge, all are stopped instead.
    pub(super) fn rebound_together(&mut self, set: &[usize]) -> Result<(), ImpactError> {
        self.aim_at_rebounds(set);
        self.solve_together(set).or_else(|_| {
            self.aim_at_rest();
            self.solve_together(set)
        })
    }

    /// Sets the target rate of each row of a set to its rebound from the present rate; that of a bilateral row is 0.
    pub(super) fn aim_at_rebounds(&mut self, set: &[usize]) {
        self.scratch.targets.resize(self.rows.len(), 0.0);
        for &index in set {
            let (row, rate) = (&self.rows[index], self.rates[index]);
            let rebounds = !row.is_bilateral() && rate < 0.0 && row.rebounds_at(-rate);
            self.scratch.targets[index] = if rebounds { row.elasticity * -rate } else { 0.0 };
        }
    }

    /// Sets the target rate of each row to 0.
    pub(super) fn aim_at_rest(&mut self) {
        self.scratch.targets.clear();
        self.scratch.targets.resize(self.rows.len(), 0.0);
    }

    /// Solves one row to reach the rate `target` [m/s], and applies the impulse.
    pub(super) fn solve_alone(&mut self, row: usize, target: f64) {
        let b = self.rates[row] - target;
        let impulse = solve_one(self.couplings.diagonal(row), b, self.rows[row].is_bilateral());
        self.solves += 1;
        self.apply(row, impulse);
    }

    /// Solves the rows of an ascending set together, each to reach its target rate, and applies the impulses.
    pub(super) fn solve_together(&mut self, set: &[usize]) -> Result<(), ImpactError> {
        match *set {
            [] => Ok(()),
            [row] => {
                self.solve_alone(row, self.scratch.targets[row]);
                Ok(())
            }
            [first, second] => self.solve_pair(first, second),
            _ => self.solve_many(set, Beginning::Unknown),
        }
    }

    fn solve_pair(&mut self, first: usize, second: usize) -> Result<(), ImpactError> {
        let couplings = &self.couplings;
        let a = [couplings.diagonal(first), couplings.between(first, second), couplings.diagonal(second)];
        let b = [first, second].map(|row| self.rates[row] - self.scratch.targets[row]);
        let bilateral = [first, second].map(|row| self.rows[row].is_bilateral());
        let Some(impulses) = solve_two(a, b, bilateral) else {
            return self.solve_many(&[first, second], Beginning::Unknown);
        };
        self.solves += 1;
        self.apply(first, impulses[0]);
        self.apply(second, impulses[1]);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::law::{ImpactLaw, ImpactOrder};
    use super::*;
    use crate::problem::InverseInertia;
    use halfgap_collision::BodyId;

    #[test]
    fn rows_that_open_slowly_are_driven_in_one_problem() -> Result<(), ImpactError> {
        // Discs in a line: the first row closes at 1 m/s and drives the others, which open, each slower than that.
        let disc = InverseInertia { inverse_mass: 1.0, inverse_moment: 0.0 };
        let jacobian = [1.0, 0.0, 0.0, -1.0, 0.0, 0.0];
        let row = |place: u32, rate| CollisionRow {
            velocity_tol: 1e-3,
            ..CollisionRow::new([BodyId(place + 1), BodyId(place)], jacobian, [disc; 2], rate)
        };
        let mut impact = Impact::new();
        // A trial has enough pivots for this.
        for resolve in [Impact::resolve_inelastic, Impact::try_inelastic] {
            impact.set_rows((0..8).map(|place| row(place, if place == 0 { -1.0 } else { 1e-3 })));
            resolve(&mut impact)?;
            let active = impact.impulses().iter().filter(|&&impulse| impulse != 0.0).count();
            assert_eq!((impact.solves(), active), (1, 8));
            assert!(impact.rates().iter().all(|rate| rate.abs() <= impact.bound()), "{:?}", impact.rates());
        }
        Ok(())
    }

    #[test]
    fn a_held_row_is_struck_with_the_rest_though_it_opens_by_rounding() -> Result<(), ImpactError> {
        // A disc strikes another one, against which a third lies.
        let disc = InverseInertia { inverse_mass: 1.0, inverse_moment: 0.0 };
        let jacobian = [1.0, 0.0, 0.0, -1.0, 0.0, 0.0];
        let row = |place: u32, rate| CollisionRow {
            elasticity: 1.0,
            velocity_tol: 1e-6,
            ..CollisionRow::new([BodyId(place + 1), BodyId(place)], jacobian, [disc; 2], rate)
        };
        let strike = |rate: f64, was_active: bool| {
            let mut impact = Impact::new();
            impact.set_rows([row(0, -1.0), CollisionRow { was_active, ..row(1, rate) }]);
            ImpactLaw::Simultaneous.resolve(&mut impact, ImpactOrder::Fastest, 0)?;
            Ok([impact.rates()[0], impact.rates()[1]])
        };
        let at_rest = strike(0.0, true)?;
        let opening = strike(1e-7, true)?;
        assert!(
            at_rest.iter().zip(opening).all(|(rest, opening)| (rest - opening).abs() < 1e-6),
            "{opening:?}"
        );
        // A row that opens faster than `velocity_tol`, or was not active, is driven to close later, and opens.
        assert!(strike(1e-5, true)?[1] > 0.5 && strike(1e-7, false)?[1] > 0.5);
        Ok(())
    }
}
