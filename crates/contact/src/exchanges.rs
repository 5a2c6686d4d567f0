//! Rows that take the places of others among rows that are independent, while forces are moved from those that
//! depend on them until so many have none that the others are independent.
//!
//! That is the way from any forces that do not pull to those of a vertex, as from an interior point to a basic
//! one in linear programming (N. Megiddo, "On finding primal- and dual-optimal bases", ORSA Journal on
//! Computing 3, 1991, 63-65). A dependent row is known as the sum of shares of the rows of a factor; that some
//! of these have left is put in as products (G. Dantzig, W. Orchard-Hays, "The product form for the inverse in
//! the simplex method", Mathematics of Computation 8, 1954, 64-67), so that one factor serves for many rows.
//! Whose factor it is, and what the forces do, is not known here.

/// Part of the size of a row below which another's share in it is rounding.
const LEAST_SHARE: f64 = 1e-9;
/// Part of the size of a row below which the share of the one whose place it takes makes much of rounding.
const SMALL_SHARE: f64 = 1e-3;
/// So many rows may take places of others before all is to be eliminated anew, for rounding adds up.
const MOST: usize = 400;

/// A row that took the place of another.
#[derive(Clone, Copy, Debug)]
struct Exchange {
    entered: usize,
    left: usize,
    /// The share that the one that left had in it.
    share: f64,
    /// Where the shares of the others begin in the list of all of them.
    start: usize,
}

/// The exchanges since the last elimination.
#[derive(Clone, Debug, Default)]
pub(crate) struct Exchanges {
    list: Vec<Exchange>,
    shares: Vec<(usize, f64)>,
    /// The last exchange was one that makes much of rounding.
    is_rough: bool,
}

/// What a dependent row, or one that it is the sum of, has to do with the choice of the one that loses its force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Party {
    pub(crate) row: usize,
    pub(crate) force: f64,
    /// Share in the dependent row; of that itself -1.
    pub(crate) share: f64,
    /// Square of the row.
    pub(crate) square: f64,
}

impl Party {
    /// The square of what it has of the dependent row.
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

    /// Whether all is to be eliminated anew before another dependent row is looked at.
    pub(crate) fn is_full(&self) -> bool {
        self.is_rough || self.list.len() >= MOST
    }

    /// Rows that entered and left.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = (usize, usize)> + Clone {
        self.list.iter().map(|exchange| (exchange.entered, exchange.left))
    }

    /// Puts in for rows that left what they are the sum of now.
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

    /// Notes that a dependent row takes the place of one of those whose shares it is the sum of.
    pub(crate) fn push(&mut self, entered: Party, left: Party, shares: &[f64]) {
        let start = self.shares.len();
        self.list.push(Exchange { entered: entered.row, left: left.row, share: left.share, start });
        let others = shares.iter().enumerate().filter(|&(row, share)| *share != 0.0 && row != left.row);
        self.shares.extend(others.map(|(row, &share)| (row, share)));
        self.is_rough |= left.part() < SMALL_SHARE * SMALL_SHARE * entered.square;
    }
}

/// Which row is to have no force, and how much the dependent row, whose force is not negative, gives until then to the others,
/// of which it is the sum; less than nothing if it takes from them. Rows that may pull are left out. Of the two that are
/// the first to have no force, one either way, it is the one with the larger part in the dependent row: what is left is farther from dependent
/// then, and a block on four corners ends on two that are far apart.
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
