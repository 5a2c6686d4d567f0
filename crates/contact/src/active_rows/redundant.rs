//! Redundant rows: where unilateral rows depend on each other, forces can be moved among them, without a
//! change of the motion of the bodies, until the rows that still have a force are independent.

use super::ActiveRows;
use crate::exchanges::{Party, first_to_vanish};
use crate::problem::pushing;

impl ActiveRows {
    /// Lists in `redundant` unilateral rows that can be excluded without a change of the motion of the bodies.
    ///
    /// Rows for which `may_pull` is true are bilateral. For each unilateral row that depends on others by the last
    /// [`factorize`](Self::factorize), `force` \[N\] (one per row, not negative on unilateral rows) is changed along
    /// the null direction of these rows until a unilateral row has no force; that row is listed. M⁻¹ Jᵀ f stays the
    /// same. The list is empty if no unilateral row depends on others, and may be incomplete otherwise: callers
    /// factorize the rows that are left and repeat until it is empty.
    ///
    /// Once no dependent row is left, [`solve`](Self::solve) finds the forces that `force` then holds. As long as there
    /// are some, it gives no force to rows of its own choice, and contacts may then have to pull.
    ///
    /// # Panics
    ///
    /// If there is not one force per row.
    pub fn find_redundant(
        &mut self,
        force: &mut [f64],
        may_pull: impl Fn(usize) -> bool,
        redundant: &mut Vec<usize>,
    ) {
        assert_eq!(force.len(), self.len(), "one force per row");
        redundant.clear();
        let mut exchanges = std::mem::take(&mut self.exchanges);
        exchanges.clear();
        for place in 0..self.root.len() {
            if self.factor.has_pivot(place) || may_pull(self.row_at(place)) {
                continue;
            }
            self.measure_rest(place);
            exchanges.substitute(&mut self.work[..place]);
            let dependent = self.party(place, -1.0, force);
            let unilateral = (0..place).filter(|&k| !may_pull(self.row_at(k)));
            let (left, moved) =
                first_to_vanish(dependent, unilateral.map(|k| self.party(k, self.work[k], force)));
            self.move_forces(place, moved, force, &may_pull);
            force[self.row_at(left.row)] = 0.0;
            redundant.push(self.row_at(left.row));
            if left.row != place {
                exchanges.push(dependent, left, &self.work[..place]);
            }
            if exchanges.is_full() {
                break;
            }
        }
        self.exchanges = exchanges;
    }

    fn row_at(&self, place: usize) -> usize {
        self.row_of[place] as usize
    }

    fn party(&self, place: usize, share: f64, force: &[f64]) -> Party {
        Party { row: place, force: force[self.row_at(place)], share, square: self.square(place) }
    }

    /// Moves force from a dependent row to the rows of which it is a combination.
    fn move_forces(&self, place: usize, moved: f64, force: &mut [f64], may_pull: impl Fn(usize) -> bool) {
        let shares = self.work[..place].iter().copied().enumerate();
        for (k, share) in shares.chain([(place, -1.0)]).filter(|(_, share)| *share != 0.0) {
            let row = self.row_at(k);
            let now = force[row] + moved * share;
            force[row] = if may_pull(row) { now } else { pushing(now) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::InverseInertia;
    use proptest::prelude::*;

    /// Planks on each other and on a floor: contacts of each with the one below, at these arms.
    struct Pile {
        inertia: Vec<InverseInertia>,
        sides: Vec<[Option<u32>; 2]>,
        rows: Vec<[f64; 6]>,
    }

    impl Pile {
        fn new(arms: &[Vec<f64>]) -> Self {
            let inertia = vec![InverseInertia { inverse_mass: 1.0, inverse_moment: 6.0 }; arms.len()];
            let places = |plank: usize| arms[plank].iter().map(move |&arm| (plank as u32, arm));
            let contacts = || (0..arms.len()).flat_map(places);
            let sides = contacts().map(|(plank, _)| [Some(plank), plank.checked_sub(1)]).collect();
            let rows = contacts().map(|(_, arm)| [0.0, 1.0, arm, 0.0, -1.0, -arm]).collect();
            Self { inertia, sides, rows }
        }

        fn active(&self) -> (ActiveRows, usize) {
            let mut active = ActiveRows::default();
            active.set_structure(&self.inertia, &self.sides);
            let dependent = active.factorize(&self.rows);
            (active, dependent)
        }

        /// Accelerations of the planks under the forces.
        fn change(&self, force: &[f64]) -> Vec<[f64; 3]> {
            let mut change = vec![[0.0; 3]; self.inertia.len()];
            self.active().0.respond(force, &mut change);
            change
        }

        fn without(&self, redundant: &[usize]) -> Self {
            let stays = |row: &usize| !redundant.contains(row);
            let rows = || (0..self.rows.len()).filter(stays);
            Self {
                inertia: self.inertia.clone(),
                sides: rows().map(|row| self.sides[row]).collect(),
                rows: rows().map(|row| self.rows[row]).collect(),
            }
        }
    }

    /// Spares rows until none depends on others. Returns the pile of the rows left, their forces, and the number of
    /// factorizations.
    fn spare_all(mut pile: Pile, mut force: Vec<f64>) -> (Pile, Vec<f64>, usize) {
        let mut eliminations = 1;
        let mut redundant = Vec::new();
        loop {
            let (mut active, dependent) = pile.active();
            if dependent == 0 {
                return (pile, force, eliminations);
            }
            active.clone().find_redundant(&mut force.clone(), |_| true, &mut redundant);
            assert!(redundant.is_empty(), "rows that may pull stay");
            active.find_redundant(&mut force, |_| false, &mut redundant);
            assert!(!redundant.is_empty() && redundant.len() <= dependent);
            assert!(redundant.iter().all(|&row| force[row] == 0.0));
            pile = pile.without(&redundant);
            let mut row = 0..;
            force.retain(|_| row.next().is_some_and(|row| !redundant.contains(&row)));
            eliminations += 1;
        }
    }

    fn largest_difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
        let pairs = a.as_flattened().iter().zip(b.as_flattened());
        pairs.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
    }

    #[test]
    fn rows_are_redundant_without_which_none_pulls() {
        // Four contacts under a plank that carry its weight, of which two are redundant.
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
            .map(|plank| {
                (0..6).map(|contact| ((7 * plank + 13 * contact) % 29) as f64 / 29.0 - 0.5).collect()
            })
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
        fn a_redundant_row_changes_nothing(
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
