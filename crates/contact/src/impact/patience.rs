//! The end of ricochets: the violation that counts grows with the number of rows solved.
//!
//! Each round of a law lets some rows rebound and may drive others together. Mostly the rates fall fast, but in a tight
//! chain they do not: elastic bodies between two walls pass an impulse to and fro for ever. So the speed that counts as
//! closing grows in stages, each of a number of rows solved, from a rounding of the impact's speed to all of it. Rows
//! that then still close are stopped without elasticity, which loses an energy of the order of the square of the last
//! speed that counted. After the first rows only speeds at which elasticity acts count: one problem stops all slower
//! rows, instead of one row after another.
//!
//! A light body of mass m between a heavy one of mass M and a wall turns the heavy one round by pi / atan(sqrt(m / M))
//! small blows, which all count (G. Galperin, "Playing pool with pi", Regular and Chaotic Dynamics 8, 2003, 375-394); a
//! line of n light ones takes about n times as many. The first stage lasts that many blows for each row, but not in
//! impacts with connectors, which may pass impulses round for ever.
//!
//! A body between two walls at a small angle a is turned back by pi / a blows, whatever its mass: a die that jams in
//! its slot. Impacts of a few contacts are given as many blows as an angle of a few degrees takes, with connectors or
//! without.

/// Fraction of the impact's fastest rate: rows with a violation up to it are done.
pub(super) const RICOCHET: f64 = 1e-12;
/// Fraction of `velocity_tol`, the speed up to which elasticity does not act: a ricochet is over at this speed.
pub(super) const QUIET: f64 = 1e-3;
/// Number of rows solved before rows slower than `velocity_tol` are left to the end.
const FIRST_ROWS: usize = 20;
/// Number of rows solved in one stage, per row of the impact; the first stage may take more.
const ROWS_PER_STAGE: usize = 20;
/// Largest number of blows by which a light body turns a heavy one round, times the root of the ratio of their masses:
/// pi/atan(x) <= 4/x.
const BLOWS: f64 = 4.0;
/// Cap on the number of blows, however light a body is: that of a mass ratio of about 1e9.
const MOST_BLOWS: f64 = 1e5;
/// Largest number of rebounding contacts that count as few.
const FEW_CONTACTS: usize = 4;
/// Number of blows per row that an impact of few rebounding contacts may take in the first stage.
const BLOWS_OF_FEW: usize = 200;
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
    /// Patience for an impact of `rows` rows, `contacts` of which may rebound. Rates up to `small` [m/s] are done, and
    /// no row slower than `slow` [m/s] rebounds. The lightest body has `lightness` times the mass of the heaviest.
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
