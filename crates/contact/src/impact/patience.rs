//! The end of ricochets: the violation that counts grows with the number of rows solved.
//!
//! Each round of a law lets some rows rebound and may drive others together. Mostly the rates fall fast, but in a tight
//! chain they do not: elastic bodies between two walls pass an impulse to and fro for ever. So the speed that counts as
//! closing grows in stages, each of a number of rows solved, from a rounding of the impact's speed to all of it. Rows
//! that then still close are stopped without elasticity, which loses an energy of the order of the square of the last
//! speed that counted. After the first rows only speeds at which elasticity acts count: one problem stops all slower
//! rows, instead of one row after another.
//!
//! The first stage lasts as many blows for each row as `blows` tells.

/// Fraction of the impact's fastest rate: rows with a violation up to it are done.
pub(super) const RICOCHET: f64 = 1e-12;
/// Fraction of `velocity_tol`, the speed up to which elasticity does not act: a ricochet is over at this speed.
pub(super) const QUIET: f64 = 1e-3;
/// Number of rows solved before rows slower than `velocity_tol` are left to the end.
const FIRST_ROWS: usize = 20;
/// Number of rows solved in one stage, per row of the impact; the first stage may take more.
const ROWS_PER_STAGE: usize = 20;
/// Number of rows solved together after a ricochet without end, per row of the impact: all of them twice, as rows may be
/// driven to close that were not in the first problem.
const ROWS_AT_LAST: usize = 2;
/// Factor by which the speed that counts as closing grows from one stage to the next.
const RAISE: f64 = 10.0;
/// Number of stages: after the last, the speed that counts has grown to that of the impact itself.
const STAGES: usize = 12;

/// The rate that counts as closing, and the number of rows that may still be solved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patience {
    /// Rate [m/s] up to which a row is done.
    small: f64,
    /// Speed [m/s] below which no row rebounds; `None` once only faster rows count.
    slow: Option<f64>,
    /// Number of rows solved in the first stage, and in each later one.
    first_stage: usize,
    per_stage: usize,
    left: usize,
    stages: usize,
}

impl Patience {
    /// Patience for an impact of `rows` rows that takes a number of blows for each. Rates up to `small` [m/s] are done, and
    /// no row slower than `slow` [m/s] rebounds.
    pub(super) fn new(blows: usize, rows: usize, small: f64, slow: f64) -> Self {
        let blows = blows.max(ROWS_PER_STAGE);
        let [first_stage, per_stage] = [blows, ROWS_PER_STAGE].map(|each| each * rows);
        Self { small, slow: Some(slow), first_stage, per_stage, left: FIRST_ROWS, stages: STAGES }
    }

    /// Patience for rows that are solved together after a ricochet without end.
    pub(super) fn short(rows: usize, small: f64) -> Self {
        Self { small, slow: None, first_stage: 0, per_stage: 0, left: ROWS_AT_LAST * rows, stages: 0 }
    }

    /// Rate [m/s] up to which a row is done.
    pub(super) fn small(&self) -> f64 {
        self.small
    }

    /// Counts solved rows; returns false once the last stage is over.
    pub(super) fn spend(&mut self, rows: usize) -> bool {
        self.left = self.left.saturating_sub(rows);
        if self.left > 0 {
            return true;
        }
        if let Some(slow) = self.slow.take() {
            self.left = self.first_stage;
            self.small = self.small.max(slow);
        } else if self.stages > 0 {
            self.stages -= 1;
            self.left = self.per_stage;
            self.small *= RAISE;
        }
        self.stages > 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_ends_after_so_many_rows_with_all_of_the_impact() {
        let mut patience = Patience::new(0, 3, RICOCHET, 0.0);
        let mut solved = 0;
        while patience.spend(1) {
            solved += 1;
        }
        assert_eq!(solved + 1, FIRST_ROWS + 3 * ROWS_PER_STAGE * STAGES);
        assert!((patience.small() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn slow_rows_do_not_count_after_the_first() {
        let mut patience = Patience::new(0, 3, RICOCHET, 0.5);
        assert!(patience.spend(FIRST_ROWS - 1) && patience.small() == RICOCHET);
        assert!(patience.spend(1) && patience.small() == 0.5);
    }
}
