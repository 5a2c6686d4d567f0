//! Rows solved one after another, until none closes.
//!
//! Each round takes one violated row as the focus (one that closes, or a bilateral one whose rate is not zero) and lets
//! it rebound, alone or with the rows that join it.

use super::Impact;
use super::law::ImpactError;
use super::patience::Patience;
use super::shuffle::Shuffle;

/// The rows that are solved together with the focus, beside the locked ones that they reach (see `locked`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Grouping {
    /// No others.
    One,
    /// All connectors that the focus reaches through movable bodies.
    Connectors,
    /// The rows that share a movable body with the focus and close at a comparable speed (see [`COMPARABLE`]), and all
    /// connectors that these and the focus reach.
    Closing,
}

/// Outcome of a round of rows that are solved one after another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ricochet {
    /// No row is violated any more, or the patience has ended.
    Over,
    /// An impulse has come back to one row time and again, for the first time in the impact.
    Returns,
}

/// Number of times that a row is the focus before locked rows are looked for. Locked rows drive each other again and again,
/// but for those that no impulse reaches; in heaps most rows have their turn once or twice.
const RETURNS: u8 = 3;

/// Fraction of the greatest violation: rows within it of the fastest tie with it, so that rounding does not decide
/// between them.
const TIE: f64 = 1e-9;

/// Fraction of the violation of a focus: a row that closes more slowly does not join it, and has its turn later. An
/// impulse that runs through a line of nearly elastic bodies leaves small rates behind it; solved together with a fast row,
/// such a row would take an impulse as large as that row's.
const COMPARABLE: f64 = 1.0 / 32.0;

impl Impact {
    /// Solves focus after focus until no row is violated or the patience ends; stops once as an impulse comes back to a row.
    pub(super) fn solve_serially(
        &mut self,
        grouping: Grouping,
        mut shuffle: Option<&mut Shuffle>,
        patience: &mut Patience,
    ) -> Result<Ricochet, ImpactError> {
        while let Some(focus) = self.focus(shuffle.as_deref_mut(), patience.small()) {
            if !patience.spend(self.solve_around(focus, grouping, patience.small())?) {
                break;
            }
            if self.comes_back(focus) {
                return Ok(Ricochet::Returns);
            }
        }
        Ok(Ricochet::Over)
    }

    /// Counts the turns of a row; true once in an impact, when one has had as many as [`RETURNS`].
    fn comes_back(&mut self, focus: usize) -> bool {
        let turns = &mut self.scratch.turns;
        if turns.is_empty() {
            turns.resize(self.rows.len(), 0);
        }
        // No more is counted than decides.
        turns[focus] = turns[focus].saturating_add(1);
        let returns = turns[focus] == RETURNS && !self.scratch.has_returned;
        self.scratch.has_returned |= returns;
        returns
    }

    /// The next focus among the violated rows: the fastest, the last of several that tie, or a random one if there is a
    /// `shuffle`.
    pub(super) fn focus(&self, shuffle: Option<&mut Shuffle>, small: f64) -> Option<usize> {
        let rest = self.rest(small);
        match shuffle {
            None => {
                let most = (0..self.rows.len()).map(|row| self.violation(row)).fold(rest, f64::max);
                let least = (1.0 - TIE) * most;
                let is_fastest = |&row: &usize| self.violation(row) >= least && self.violation(row) > rest;
                if most > rest { (0..self.rows.len()).rfind(is_fastest) } else { None }
            }
            Some(shuffle) => {
                let violated = || (0..self.rows.len()).filter(|&row| self.violation(row) > rest);
                let count = violated().count();
                if count == 0 { None } else { violated().nth(shuffle.below(count)) }
            }
        }
    }

    /// Target rate [m/s] of a row that is solved alone. The elasticity of a connector acts only here: in a problem with
    /// other rows it could add energy to them.
    pub(super) fn rebound_alone(&self, row: usize) -> f64 {
        let row_data = &self.rows[row];
        let violation = self.violation(row);
        if violation > 0.0 && row_data.rebounds_at(violation) {
            -row_data.elasticity * self.rates[row]
        } else {
            0.0
        }
    }

    /// Solves a focus together with the rows that join it. Returns the number of rows.
    fn solve_around(&mut self, focus: usize, grouping: Grouping, small: f64) -> Result<usize, ImpactError> {
        let set = self.join_focus(focus, grouping, small);
        let outcome = match set[..] {
            [row] if grouping == Grouping::One => {
                self.solve_alone(row, self.rebound_alone(row));
                Ok(())
            }
            _ => self.rebound_together(&set),
        };
        let count = set.len();
        self.scratch.set = set;
        outcome.map(|()| count)
    }

    /// Lists a focus and the rows that join it, ascending, in the buffer of sets.
    pub(super) fn join_focus(&mut self, focus: usize, grouping: Grouping, small: f64) -> Vec<usize> {
        let mut set = std::mem::take(&mut self.scratch.set);
        set.clear();
        set.push(focus);
        if grouping == Grouping::Closing && !self.rows[focus].is_bilateral() {
            let least = COMPARABLE * self.violation(focus);
            let joins = |&row: &usize| {
                let is_contact = row != focus && !self.rows[row].is_bilateral();
                is_contact && self.is_violated(row, small) && self.violation(row) >= least
            };
            set.extend(self.couplings.row(focus).map(|(row, _)| row).filter(joins));
        }
        self.add_tied(&mut set, grouping);
        set.sort_unstable();
        set
    }

    /// Adds the locked rows, and if connectors join, the bilateral rows that a set reaches through movable bodies,
    /// directly or through other such rows.
    fn add_tied(&mut self, set: &mut Vec<usize>, grouping: Grouping) {
        let joins_connectors = self.has_connectors && grouping != Grouping::One;
        if !joins_connectors && !self.has_locked() {
            return;
        }
        let mut listed = std::mem::take(&mut self.scratch.listed);
        listed.clear();
        listed.resize(self.rows.len(), false);
        set.iter().for_each(|&row| listed[row] = true);
        let mut next = 0;
        while next < set.len() {
            for (other, _) in self.couplings.row(set[next]) {
                let is_tied = self.is_locked(other) || (joins_connectors && self.rows[other].is_bilateral());
                if is_tied && !listed[other] {
                    listed[other] = true;
                    set.push(other);
                }
            }
            next += 1;
        }
        self.scratch.listed = listed;
    }
}
