//! Rows that can be spared: where unilateral rows depend on each other, forces may be moved among them, without
//! a change of what they do to the bodies, until so many have none that the others are independent.
//!
//! That is the way from a feasible point to a basic one, as before a simplex method goes on from an interior
//! point (N. Megiddo, "On finding primal- and dual-optimal bases", 1991). Rows that take the places of others
//! are kept as products with the factor that there is (G. Dantzig and W. Orchard-Hays, "The product form for
//! the inverse in the simplex method", 1954).

use super::HeldRows;

/// Part of the size of a row below which another's share in it is rounding.
const LEAST_SHARE: f64 = 1e-9;
/// So many rows may have taken places of others before all is to be eliminated anew, for rounding adds up.
const MOST_EXCHANGES: usize = 64;
/// Part of the size of a row below which the share of the one whose place it takes makes much of rounding.
const SMALL_SHARE: f64 = 1e-3;

/// A row that took the place of another, as the sum of those that were independent until then.
#[derive(Clone, Debug)]
struct Exchange {
    entered: usize,
    left: usize,
    /// The share of the one that left.
    share: f64,
    /// Where its other shares begin in the list of all of them.
    start: usize,
}

/// Buffers: the exchanges since the last elimination, and the shares of all of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Sparing {
    exchanges: Vec<Exchange>,
    shares: Vec<(usize, f64)>,
}

impl Sparing {
    fn clear(&mut self) {
        self.exchanges.clear();
        self.shares.clear();
    }

    /// Puts in for rows that left what they are the sum of now.
    fn substitute(&self, work: &mut [f64]) {
        for (index, exchange) in self.exchanges.iter().enumerate() {
            let part = std::mem::take(&mut work[exchange.left]) / exchange.share;
            if part == 0.0 {
                continue;
            }
            let end = self.exchanges.get(index + 1).map_or(self.shares.len(), |next| next.start);
            for &(place, share) in &self.shares[exchange.start..end] {
                work[place] -= part * share;
            }
            work[exchange.entered] += part;
        }
    }

    /// Notes that a row with the given shares of others takes the place of one of them.
    fn exchange(&mut self, entered: usize, left: usize, work: &[f64]) {
        self.exchanges.push(Exchange { entered, left, share: work[left], start: self.shares.len() });
        let shares = work.iter().enumerate().filter(|&(place, share)| *share != 0.0 && place != left);
        self.shares.extend(shares.map(|(place, &share)| (place, share)));
    }
}

impl HeldRows {
    /// Lists rows that can be spared, of those that depend on others by the last
    /// [`factorize`](Self::factorize): forces, given by row, that are not negative where `may_pull` is false,
    /// are moved along what they leave open until a row has none, for one dependent row after the other. What
    /// they do to the bodies stays as it is. None is listed if no row depends on others that may not pull.
    ///
    /// Without these rows, and others as long as there are any, the forces are those that
    /// [`solve`](Self::solve) finds: with them, it leaves out some whose loss may have others pull.
    ///
    /// # Panics
    ///
    /// If there is not one force per row.
    pub fn spare(
        &mut self,
        force: &mut [f64],
        may_pull: impl Fn(usize) -> bool,
        spared: &mut Vec<usize>,
    ) {
        assert_eq!(force.len(), self.len(), "one force per row");
        spared.clear();
        let mut sparing = std::mem::take(&mut self.sparing);
        sparing.clear();
        for place in 0..self.len() {
            if self.factor.has_pivot(place) || may_pull(self.row_at(place)) {
                continue;
            }
            self.measure_rest(place);
            sparing.substitute(&mut self.work[..place]);
            let left = self.first_without(place, force, &may_pull);
            self.move_forces(place, left, force, &may_pull);
            spared.push(self.row_at(left));
            if left != place {
                sparing.exchange(place, left, &self.work[..place]);
                let is_small = self.share_square(left) < SMALL_SHARE * SMALL_SHARE * self.square(place);
                if is_small || sparing.exchanges.len() == MOST_EXCHANGES {
                    break;
                }
            }
        }
        self.sparing = sparing;
    }

    fn row_at(&self, place: usize) -> usize {
        self.order.rows[place] as usize
    }

    /// The square of what an earlier row has of the one that was measured.
    fn share_square(&self, place: usize) -> f64 {
        self.work[place] * self.work[place] * self.square(place)
    }

    /// The place of the row that is the first to have no force as that of a dependent row, the sum of shares of
    /// others, goes to those: it may be that row itself. Of several, the one with the largest share.
    fn first_without(&self, place: usize, force: &[f64], may_pull: impl Fn(usize) -> bool) -> usize {
        let own = force[self.row_at(place)];
        let least_square = LEAST_SHARE * LEAST_SHARE * self.square(place);
        let losers = (0..place).filter(|&k| self.work[k] < 0.0 && !may_pull(self.row_at(k)));
        let (mut first, mut least, mut largest) = (place, own, self.square(place));
        for k in losers.filter(|&k| self.share_square(k) > least_square) {
            let (until, size) = (force[self.row_at(k)] / -self.work[k], self.share_square(k));
            let is_tied = (until - least).abs() <= LEAST_SHARE * own;
            if if is_tied { size > largest } else { until < least } {
                (first, least, largest) = (k, until, size);
            }
        }
        first
    }

    /// Moves force from a dependent row to those that it is the sum of, until the one that is told has none.
    fn move_forces(
        &self,
        place: usize,
        left: usize,
        force: &mut [f64],
        may_pull: impl Fn(usize) -> bool,
    ) {
        let row = self.row_at(left);
        let moved = if left == place { force[row] } else { force[row] / -self.work[left] };
        let shares = self.work[..place].iter().copied().enumerate();
        for (k, share) in shares.chain([(place, -1.0)]).filter(|(_, share)| *share != 0.0) {
            let row = self.row_at(k);
            let now = force[row] + moved * share;
            force[row] = if may_pull(row) { now } else { now.max(0.0) };
        }
        force[row] = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::Inertia;
    use proptest::prelude::*;

    /// Planks on each other and on a floor: contacts of each with the one below, at these arms.
    struct Pile {
        inertia: Vec<Inertia>,
        sides: Vec<[Option<u32>; 2]>,
        rows: Vec<[f64; 6]>,
    }

    impl Pile {
        fn new(arms: &[Vec<f64>]) -> Self {
            let inertia = vec![Inertia { inverse_mass: 1.0, inverse_moment: 6.0 }; arms.len()];
            let places = |plank: usize| arms[plank].iter().map(move |&arm| (plank as u32, arm));
            let contacts = || (0..arms.len()).flat_map(places);
            let sides = contacts().map(|(plank, _)| [Some(plank), plank.checked_sub(1)]).collect();
            let rows = contacts().map(|(_, arm)| [0.0, 1.0, arm, 0.0, -1.0, -arm]).collect();
            Self { inertia, sides, rows }
        }

        fn held(&self) -> (HeldRows, usize) {
            let mut held = HeldRows::default();
            held.set_structure(&self.inertia, &self.sides);
            let dependent = held.factorize(&self.rows);
            (held, dependent)
        }

        /// What forces do to the planks.
        fn change(&self, force: &[f64]) -> Vec<[f64; 3]> {
            let mut change = vec![[0.0; 3]; self.inertia.len()];
            self.held().0.respond(force, &mut change);
            change
        }

        fn without(&self, spared: &[usize]) -> Self {
            let stays = |row: &usize| !spared.contains(row);
            let rows = || (0..self.rows.len()).filter(stays);
            Self {
                inertia: self.inertia.clone(),
                sides: rows().map(|row| self.sides[row]).collect(),
                rows: rows().map(|row| self.rows[row]).collect(),
            }
        }
    }

    /// Spares rows until none depends on others; returns what is left, with the forces, and how often all was
    /// eliminated.
    fn spare_all(mut pile: Pile, mut force: Vec<f64>) -> (Pile, Vec<f64>, usize) {
        let mut eliminations = 1;
        let mut spared = Vec::new();
        loop {
            let (mut held, dependent) = pile.held();
            if dependent == 0 {
                return (pile, force, eliminations);
            }
            held.clone().spare(&mut force.clone(), |_| true, &mut spared);
            assert!(spared.is_empty(), "rows that may pull stay");
            held.spare(&mut force, |_| false, &mut spared);
            assert!(!spared.is_empty() && spared.len() <= dependent);
            assert!(spared.iter().all(|&row| force[row] == 0.0));
            pile = pile.without(&spared);
            let mut row = 0..;
            force.retain(|_| row.next().is_some_and(|row| !spared.contains(&row)));
            eliminations += 1;
        }
    }

    fn largest_difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
        let pairs = a.as_flattened().iter().zip(b.as_flattened());
        pairs.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
    }

    #[test]
    fn rows_are_spared_without_which_none_pulls() {
        // Four contacts under a plank that carry its weight, of which two may be spared.
        let pile = || Pile::new(&[vec![-0.5, 0.1, 0.2, 0.5]]);
        let force = vec![1.0, 2.0, 3.0, 4.0];
        let before = pile().change(&force);
        let (left, force, eliminations) = spare_all(pile(), force);
        assert_eq!((force.len(), eliminations), (2, 2));
        assert!(force.iter().all(|force| *force >= 0.0), "{force:?}");
        assert!(largest_difference(&left.change(&force), &before) < 1e-14);
    }

    #[test]
    fn a_high_pile_is_eliminated_a_few_times_only() {
        let arms: Vec<Vec<f64>> = (0..100)
            .map(|plank| (0..6).map(|contact| ((7 * plank + 13 * contact) % 29) as f64 / 29.0 - 0.5).collect())
            .collect();
        let force: Vec<f64> = (0..600).map(|row| 1.0 + f64::from(row * 37 % 101)).collect();
        let before = Pile::new(&arms).change(&force);
        let (left, force, eliminations) = spare_all(Pile::new(&arms), force);
        assert_eq!(force.len(), 200);
        assert!(force.iter().all(|force| *force >= 0.0));
        assert!(largest_difference(&left.change(&force), &before) < 1e-9);
        assert!(eliminations < 10, "{eliminations}");
    }

    proptest! {
        #[test]
        fn what_is_spared_changes_nothing(
            contacts in prop::collection::vec(prop::collection::vec((-1.0..1.0, 0.0..1.0), 1..6), 1..8)
        ) {
            let arms: Vec<Vec<f64>> =
                contacts.iter().map(|plank| plank.iter().map(|contact| contact.0).collect()).collect();
            let force: Vec<f64> = contacts.iter().flatten().map(|contact: &(f64, f64)| contact.1).collect();
            let before = Pile::new(&arms).change(&force);
            let (left, force, _) = spare_all(Pile::new(&arms), force);
            prop_assert_eq!(force.len(), arms.iter().map(|arms| arms.len().min(2)).sum::<usize>());
            prop_assert!(force.iter().all(|force| *force >= 0.0));
            prop_assert!(largest_difference(&left.change(&force), &before) < 1e-9);
        }
    }
}
