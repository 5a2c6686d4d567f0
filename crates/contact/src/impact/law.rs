//! The impact laws, and what all of them share.

use super::Impact;
use super::pair_problem::{solve_one, solve_two};
use super::serial::{Grouping, resolve_serially};
use super::shuffle::Shuffle;

/// Which rows are solved together, and what happens after.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ImpactLaw {
    /// All rows that close or rest in one problem, again while it leaves some closing.
    Simultaneous,
    /// Together those that close on the same bodies, one after another otherwise.
    #[default]
    Hybrid,
    /// One row at a time.
    SerialSeparate,
    /// One row at a time, with all joints that it reaches through movable bodies.
    SerialGrouped,
    /// As `SerialSeparate`, then all rows together without elasticity.
    SerialSeparateLastpass,
    /// As `SerialGrouped`, then all rows together without elasticity.
    SerialGroupedLastpass,
}

/// In which order the serial laws take the rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ImpactOrder {
    /// The one that closes fastest first, ties by place in the list.
    #[default]
    Fastest,
    /// A random order from a seed, the same for the same seed.
    Seeded(u64),
}

/// Why an impact could not be resolved.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImpactError {
    /// More rows at once than can be solved together.
    #[error("an impact of {rows} rows at once is not supported yet; at most {most} are")]
    TooManyRows {
        /// How many rows act at once.
        rows: usize,
        /// How many may.
        most: usize,
    },
    /// A closing row moves nothing.
    #[error("row {row} closes at {closing} m/s, but neither of its bodies can move")]
    Immovable {
        /// Index of the row.
        row: usize,
        /// Closing speed [m/s].
        closing: f64,
    },
}

/// Rows that may act at once.
pub(super) const MOST_ROWS: usize = 2;
/// A row closing slower than this part of the impact's fastest is done: with it the ricochets end.
const RICOCHET: f64 = 1e-12;
/// Rounds per row after which the rest of an impact is stopped without elasticity.
pub(super) const ROUNDS_PER_ROW: usize = 200;

impl ImpactLaw {
    /// Finds the impulses of an impact; `random` counts the impacts of a seeded run.
    ///
    /// # Errors
    /// More than two rows act at once, or a closing row moves nothing.
    pub fn resolve(self, impact: &mut Impact, order: ImpactOrder, random: u64) -> Result<(), ImpactError> {
        let fastest = impact.rates.iter().fold(0.0f64, |most, rate| most.max(-rate));
        let small = RICOCHET * fastest;
        for (row, rate) in impact.rates.iter().enumerate() {
            if *rate < -small && impact.coupling(row, row) <= 0.0 {
                return Err(ImpactError::Immovable { row, closing: -rate });
            }
        }
        if impact.rows.len() == 1 {
            // The most common impact by far: no law changes it, and it needs no buffers.
            let rebound = impact.rebound(0);
            let impulse = solve_one(impact.coupling(0, 0), impact.rates[0] - rebound);
            impact.solves = 1;
            impact.apply(0, impulse);
            return Ok(());
        }
        let mut shuffle = match order {
            ImpactOrder::Fastest => None,
            ImpactOrder::Seeded(seed) => Some(Shuffle::new(seed, random)),
        };
        let grouping = match self {
            ImpactLaw::Simultaneous => return impact.solve_all(small),
            ImpactLaw::Hybrid => Grouping::SameBodies,
            _ => Grouping::One,
        };
        resolve_serially(impact, grouping, shuffle.as_mut(), small)?;
        match self {
            ImpactLaw::SerialSeparateLastpass | ImpactLaw::SerialGroupedLastpass => {
                impact.solve_all_inelastic(small)
            }
            _ => Ok(()),
        }
    }
}

impl Impact {
    /// Problems of all rows: each that closes is to rebound, and rows at rest are held.
    ///
    /// A row that opens stays out, even if the impulses turn it round: to hold it would add energy. If it then closes, it
    /// is solved in the next round, with all others that do.
    fn solve_all(&mut self, small: f64) -> Result<(), ImpactError> {
        for _ in 0..ROUNDS_PER_ROW * self.rows.len() {
            if !self.rates.iter().any(|&rate| rate < -small) {
                return Ok(());
            }
            self.aim_at_rebounds();
            self.solve_growing(small, small)?;
        }
        self.solve_all_inelastic(small)
    }

    /// One problem of all rows without elasticity.
    pub(super) fn solve_all_inelastic(&mut self, small: f64) -> Result<(), ImpactError> {
        self.scratch.targets.clear();
        self.scratch.targets.resize(self.rows.len(), 0.0);
        self.solve_growing(small, f64::INFINITY)
    }

    /// Sets each row's target to its rebound from the rate that it has now.
    pub(super) fn aim_at_rebounds(&mut self) {
        let mut targets = std::mem::take(&mut self.scratch.targets);
        targets.clear();
        targets.extend((0..self.rows.len()).map(|row| self.rebound(row)));
        self.scratch.targets = targets;
    }

    /// Solves the closing rows together; as long as others are driven to close that opened at most at the rate `slow`,
    /// with these too.
    fn solve_growing(&mut self, small: f64, slow: f64) -> Result<(), ImpactError> {
        self.scratch.rates.clone_from(&self.rates);
        self.scratch.impulses.clone_from(&self.impulses);
        let mut set = std::mem::take(&mut self.scratch.set);
        set.clear();
        set.extend((0..self.rows.len()).filter(|&row| self.rates[row] < -small));
        let outcome = loop {
            if let Err(error) = self.solve_together(&set) {
                break Err(error);
            }
            let count = set.len();
            for row in 0..self.rows.len() {
                let is_driven = self.scratch.rates[row] <= slow && self.rates[row] < -small;
                if is_driven && !set[..count].contains(&row) {
                    set.push(row);
                }
            }
            if set.len() == count {
                break Ok(());
            }
            set.sort_unstable();
            self.rates.clone_from(&self.scratch.rates);
            self.impulses.clone_from(&self.scratch.impulses);
        };
        self.scratch.set = set;
        outcome
    }

    /// Solves the rows of a set together, each to reach its target rate, and applies the impulses.
    pub(super) fn solve_together(&mut self, set: &[usize]) -> Result<(), ImpactError> {
        let b = |row: usize| self.rates[row] - self.scratch.targets[row];
        match *set {
            [] => {}
            [row] => {
                let impulse = solve_one(self.coupling(row, row), b(row));
                self.solves += 1;
                self.apply(row, impulse);
            }
            [first, second] => {
                let a = [
                    self.coupling(first, first),
                    self.coupling(first, second),
                    self.coupling(second, second),
                ];
                let impulses = solve_two(a, [b(first), b(second)]);
                self.solves += 1;
                self.apply(first, impulses[0]);
                self.apply(second, impulses[1]);
            }
            _ => return Err(ImpactError::TooManyRows { rows: set.len(), most: MOST_ROWS }),
        }
        Ok(())
    }
}
