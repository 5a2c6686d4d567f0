//! When ricochets end.
//!
//! Each round of a law lets some rows rebound and may drive others together. In general the rates fall fast,
//! but not in a tight chain: elastic bodies between two walls pass an impulse to and fro for ever. So what
//! counts as closing grows in stages, each of so many rows solved, from a rounding of the impact's speed to
//! all of it; what then still closes is stopped without elasticity. The energy lost by that is of the order
//! of the square of what counted last. After the first rows only speeds at which elasticity acts count: to
//! stop what is slower takes one problem, not a row after another.
//!
//! A light body of mass m between a heavy one of mass M and a wall turns the heavy one round by pi /
//! atan(sqrt(m / M)) small blows, which all count (G. Galperin, "Playing pool with pi", Regular and Chaotic
//! Dynamics 8, 2003, 375-394); a line of n light ones takes some n times as many. The first stage lasts as
//! long, for each row. Where connectors take part it does not: they may pass impulses round for ever.
//!
//! A body between two walls that all but face each other, at an angle a, is turned back by pi / a blows,
//! whatever it weighs: a die that jams in its slot. Few contacts are given as many as an angle of a few
//! degrees takes, connectors or not.

/// Part of the impact's fastest rate below which a row is done.
pub(super) const RICOCHET: f64 = 1e-12;
/// Part of `velocity_tol`, the speed below which elasticity does not act, at which a ricochet is over.
pub(super) const QUIET: f64 = 1e-3;
/// Rows solved before slow rows are left to the end.
const FIRST_ROWS: usize = 20;
/// Rows solved in one stage, per row of the impact, at least.
const ROWS_PER_STAGE: usize = 20;
/// Blows by which a light body turns a heavy one round, times the root of the ratio of their masses, at most:
/// pi/atan(x) <= 4/x.
const BLOWS: f64 = 4.0;
/// The most of them, however light a body is: those of masses as 1 to 1e9.
const MOST_BLOWS: f64 = 1e5;
/// Contacts that rebound are few up to this number, and may take so many blows then.
const FEW_CONTACTS: usize = 4;
const BLOWS_OF_FEW: usize = 200;
/// Factor of what counts as closing, from one stage to the next.
const RAISE: f64 = 10.0;
/// Number of stages: the last leaves nothing that is less than the impact itself.
const STAGES: usize = 12;

/// What counts as closing, and for how long.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patience {
    /// Rate [m/s] up to which a row is done.
    small: f64,
    /// Speed [m/s] below which no row rebounds, while it does not count.
    slow: Option<f64>,
    /// Rows solved in the first stage, and in each other.
    first_stage: usize,
    per_stage: usize,
    left: usize,
    stages: usize,
}

impl Patience {
    /// For an impact of `rows` rows, `contacts` of which may rebound, in which rates up to `small` are done,
    /// and no row rebounds that is slower than `slow`. The lightest body has a mass of `lightness` times that
    /// of the heaviest.
    pub(super) fn new([rows, contacts]: [usize; 2], lightness: f64, small: f64, slow: f64) -> Self {
        let of_masses = (BLOWS / lightness.sqrt()).min(MOST_BLOWS) as usize;
        let of_angles = if (1..=FEW_CONTACTS).contains(&contacts) { BLOWS_OF_FEW } else { 0 };
        let blows = of_masses.max(of_angles).max(ROWS_PER_STAGE);
        let [first_stage, per_stage] = [blows, ROWS_PER_STAGE].map(|each| each * rows);
        Self { small, slow: Some(slow), first_stage, per_stage, left: FIRST_ROWS, stages: STAGES }
    }

    /// Rate [m/s] up to which a row is done.
    pub(super) fn small(&self) -> f64 {
        self.small
    }

    /// Counts rows that were solved; false when it is time to give in.
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
        let mut patience = Patience::new([3, 5], 1.0, RICOCHET, 0.0);
        let mut solved = 0;
        while patience.spend(1) {
            solved += 1;
        }
        assert_eq!(solved + 1, FIRST_ROWS + 3 * ROWS_PER_STAGE * STAGES);
        assert!((patience.small() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn slow_rows_do_not_count_after_the_first() {
        let mut patience = Patience::new([3, 3], 1.0, RICOCHET, 0.5);
        assert!(patience.spend(FIRST_ROWS - 1) && patience.small() == RICOCHET);
        assert!(patience.spend(1) && patience.small() == 0.5);
    }
}
