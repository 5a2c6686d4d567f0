//! When ricochets end.
//!
//! Each round of a law lets some rows rebound and may drive others together. In general the rates fall fast, but not in
//! a tight chain: elastic bodies between two walls pass an impulse to and fro for ever. So what counts as closing grows
//! in stages, each of so many rows solved, from a rounding of the impact's speed to all of it; what then still closes is
//! stopped without elasticity. The energy lost by that is of the order of the square of what counted last.

/// Part of the impact's fastest rate below which a row is done.
pub(super) const RICOCHET: f64 = 1e-12;
/// Part of `velocity_tol`, the speed below which elasticity does not act, at which a ricochet is over.
pub(super) const QUIET: f64 = 1e-3;
/// Rows solved in one stage, per row of the impact.
const ROWS_PER_STAGE: usize = 20;
/// Factor of what counts as closing, from one stage to the next.
const RAISE: f64 = 10.0;
/// Number of stages: the last leaves nothing that is less than the impact itself.
const STAGES: usize = 12;

/// What counts as closing, and for how long.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patience {
    /// Rate [m/s] up to which a row is done.
    small: f64,
    per_stage: usize,
    left: usize,
    stages: usize,
}

impl Patience {
    /// For an impact of `rows` rows in which rates up to `small` are done.
    pub(super) fn new(rows: usize, small: f64) -> Self {
        let per_stage = ROWS_PER_STAGE * rows;
        Self { small, per_stage, left: per_stage, stages: STAGES }
    }

    /// Rate [m/s] up to which a row is done.
    pub(super) fn small(&self) -> f64 {
        self.small
    }

    /// Counts rows that were solved; false when it is time to give in.
    pub(super) fn spend(&mut self, rows: usize) -> bool {
        self.left = self.left.saturating_sub(rows);
        if self.left == 0 && self.stages > 0 {
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
        let mut patience = Patience::new(3, RICOCHET);
        let mut solved = 0;
        while patience.spend(1) {
            solved += 1;
        }
        assert_eq!(solved + 1, 3 * ROWS_PER_STAGE * STAGES);
        assert!((patience.small() - 1.0).abs() < 1e-12);
    }
}
