//! Exchanges of rows among independent rows, while forces are moved from dependent rows to these until the rows with a
//! force are independent.
//!
//! This leads from any forces that do not pull to those of a vertex, as from an interior point to a basic one in linear
//! programming (N. Megiddo, "On finding primal- and dual-optimal bases", ORSA Journal on Computing 3, 1991, 63-65). A
//! dependent row is given as the sum of shares of the rows of a factor; rows that have left are substituted in product
//! form (G. Dantzig, W. Orchard-Hays, "The product form for the inverse in the simplex method", Mathematics of
//! Computation 8, 1954, 64-67), so that one factor serves for many rows. The caller has the factor and moves the
//! forces.

/// Fraction of the size of a dependent row: smaller parts of other rows in it are rounding. Forces that run out within
/// this fraction of the dependent force tie.
const LEAST_SHARE: f64 = 1e-9;
/// Fraction of the size of an entering row: if the part of the row that leaves is smaller, the exchange enlarges
/// rounding much.
const SMALL_SHARE: f64 = 1e-3;
/// Number of exchanges before the factor must be made anew, as rounding adds up.
const MOST: usize = 400;

/// A row that took the place of another.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Exchange {
    entered: usize,
    left: usize,
    /// The share of the row that left in the one that entered.
    share: f64,
    /// Where the shares of the other rows begin in `shares` of [`Exchanges`].
    start: usize,
}

/// The exchanges since the factor was made.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Exchanges {
    list: Vec<Exchange>,
    shares: Vec<(usize, f64)>,
    /// True if an exchange enlarged rounding much.
    is_rough: bool,
}

/// A dependent row, or one of the rows that it is the sum of, as a candidate for losing its force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Party {
    pub(crate) row: usize,
    pub(crate) force: f64,
    /// Share in the dependent row; -1 for that row itself.
    pub(crate) share: f64,
    /// Square of the row.
    pub(crate) square: f64,
}

impl Party {
    /// The square of its part in the dependent row.
    fn part(&self) -> f64 {
        self.share * self.share * self.square
    }
}

impl Exchanges {
    pub(crate) fn clear(&mut self) {
        self.list.clear();
        self.shares.clear();
        self.is_rough = false;
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether the factor must be made anew before the next dependent row.
    pub(crate) fn is_full(&self) -> bool {
        self.is_rough || self.list.len() >= MOST
    }

    /// Rows that entered and left.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = (usize, usize)> + Clone {
        self.list.iter().map(|exchange| (exchange.entered, exchange.left))
    }

    /// Replaces shares of rows that left by shares of the rows that they are now the sum of.
    pub(crate) fn substitute(&self, shares: &mut [f64]) {
        for (index, exchange) in self.list.iter().enumerate() {
            let part = std::mem::take(&mut shares[exchange.left]) / exchange.share;
            if part == 0.0 {
                continue;
            }
            let end = self.list.get(index + 1).map_or(self.shares.len(), |next| next.start);
            for &(row, share) in &self.shares[exchange.start..end] {
                shares[row] -= part * share;
            }
            shares[exchange.entered] += part;
        }
    }

    /// Notes that a dependent row, the sum of `shares`, takes the place of one of its rows.
    pub(crate) fn push(&mut self, entered: Party, left: Party, shares: &[f64]) {
        let start = self.shares.len();
        self.list.push(Exchange { entered: entered.row, left: left.row, share: left.share, start });
        let others = shares.iter().enumerate().filter(|&(row, share)| *share != 0.0 && row != left.row);
        self.shares.extend(others.map(|(row, &share)| (row, share)));
        self.is_rough |= left.part() < SMALL_SHARE * SMALL_SHARE * entered.square;
    }
}

/// Selects the row that is to lose its force. Also returns the force that the dependent row gives to the others, of
/// which it is the sum, until then; it is negative if the dependent row takes from them. The force of the dependent row
/// must not be negative, and rows that may pull must be left out. Of the two rows that lose their force first, one in
/// either direction, the one with the larger part in the dependent row is selected: the rows left are then farther from
/// dependent, and a block on four corners ends on two that are far apart.
pub(crate) fn first_to_vanish(dependent: Party, others: impl Iterator<Item = Party> + Clone) -> (Party, f64) {
    let least_part = LEAST_SHARE * LEAST_SHARE * dependent.square;
    let until = |party: &Party| party.force / party.share.abs();
    let first_of = |best: Party, party: Party| {
        let longer = until(&party) - until(&best);
        let is_tied = longer.abs() <= LEAST_SHARE * dependent.force;
        let is_before = if is_tied { party.part() > best.part() } else { longer < 0.0 };
        if is_before { party } else { best }
    };
    let others = others.filter(|party| party.part() > least_part);
    let giving = others.clone().filter(|party| party.share < 0.0).fold(dependent, first_of);
    let taking = others.filter(|party| party.share > 0.0).reduce(first_of);
    let left = taking.filter(|taking| taking.part() > giving.part()).unwrap_or(giving);
    (left, left.force / -left.share)
}
