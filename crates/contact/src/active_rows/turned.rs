//! Rows whose forces act along other directions than they measure: the normal rows of contacts that slip, whose friction is a share of
//! their force. With the rows C and the directions D of their forces, C M⁻¹ Dᵀ f = -b.
//!
//! Few rows slip at a time, so the symmetric factor of C M⁻¹ Cᵀ is kept, and they are a correction of low rank: for the turned rows T,
//! with E = D - C, X = (C M⁻¹ Cᵀ)⁻¹ C M⁻¹ E_Tᵀ and y the forces without them, (I + X_T) f_T = y_T and f = y - X f_T (M. A. Woodbury,
//! "Inverting modified matrices", 1950).
//!
//! *Invariant*: columns and factor are those of the coefficients with which `factorize` was last called.

use super::{ActiveRows, NONE};

/// Turned rows among active ones, with the correction that they are.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct TurnedRows {
    /// The rows, and by what the direction of each one's force differs from what it measures.
    turned: Vec<(u32, [f64; 6])>,
    /// X, column by column.
    columns: Vec<f64>,
    /// Factors of I + X_T, row by row, and the order of its rows.
    factors: Vec<f64>,
    order: Vec<usize>,
    determinant: f64,
    /// The right-hand side of a column, and forces of turned rows.
    offset: Vec<f64>,
    forces: Vec<f64>,
}

impl TurnedRows {
    /// Takes the rows of `active`, which must be factorised, whose forces act along other directions than they measure: by what
    /// their coefficients (x, y \[1\] and rotation \[m\] of the primary, then of the normal body) differ. Returns the determinant of I + X_T
    /// \[-\]: positive as long as more force of the slipping contacts parts bodies more, 0 where some force parts nothing, and negative
    /// where it presses them together (P. Painlevé, 1895). For one contact it is 1 - sigma mu A_nt/A_nn.
    ///
    /// # Panics
    ///
    /// If there is no such row.
    pub fn factorize(
        &mut self,
        active: &mut ActiveRows,
        turned: impl IntoIterator<Item = (u32, [f64; 6])>,
    ) -> f64 {
        self.turned.clear();
        self.turned.extend(turned);
        self.columns.clear();
        self.columns.resize(self.turned.len() * active.len(), 0.0);
        for (index, (row, turn)) in self.turned.iter().enumerate() {
            active.list_rates(*row, turn, &mut self.offset);
            self.offset.iter_mut().for_each(|rate| *rate = -*rate);
            let own = index * active.len()..(index + 1) * active.len();
            active.solve(&self.offset, &mut self.columns[own]);
        }
        self.factorize_small(active.len());
        self.determinant
    }

    /// The determinant that [`factorize`](Self::factorize) returned.
    #[must_use]
    #[inline]
    pub fn determinant(&self) -> f64 {
        self.determinant
    }

    /// Whether no row is turned.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.turned.is_empty()
    }

    /// Factorises I + X_T with the largest pivots, in place.
    fn factorize_small(&mut self, rows: usize) {
        let Self { turned, columns, factors, order, determinant, .. } = self;
        let count = turned.len();
        factors.clear();
        factors.extend((0..count * count).map(|at| {
            let (i, j) = (at / count, at % count);
            columns[j * rows + turned[i].0 as usize] + f64::from(u8::from(i == j))
        }));
        order.clear();
        order.extend(0..count);
        *determinant = 1.0;
        for step in 0..count {
            let size = |row: &usize| factors[row * count + step].abs();
            let largest = (step..count).max_by(|p, q| size(p).total_cmp(&size(q))).unwrap_or(step);
            if largest != step {
                order.swap(step, largest);
                (0..count).for_each(|k| factors.swap(step * count + k, largest * count + k));
                *determinant = -*determinant;
            }
            let pivot = factors[step * count + step];
            *determinant *= pivot;
            for row in step + 1..count {
                let share = if pivot == 0.0 { 0.0 } else { factors[row * count + step] / pivot };
                factors[row * count + step] = share;
                for k in step + 1..count {
                    factors[row * count + k] -= share * factors[step * count + k];
                }
            }
        }
    }

    /// Finds the forces f \[N\] with C M⁻¹ Dᵀ f = -b, as [`ActiveRows::solve`] does without turned rows. Where the determinant is 0 they are
    /// not finite.
    ///
    /// # Panics
    ///
    /// If there is not one offset and one force per row.
    pub fn solve(&mut self, active: &mut ActiveRows, offset: &[f64], force: &mut [f64]) {
        active.solve(offset, force);
        let Self { turned, columns, factors, order, forces, .. } = self;
        let count = turned.len();
        forces.clear();
        forces.extend(order.iter().map(|&row| force[turned[row].0 as usize]));
        for row in 0..count {
            for k in 0..row {
                forces[row] -= factors[row * count + k] * forces[k];
            }
        }
        for row in (0..count).rev() {
            for k in row + 1..count {
                forces[row] -= factors[row * count + k] * forces[k];
            }
            forces[row] /= factors[row * count + row];
        }
        let rows = active.len();
        for (&of_turned, column) in forces.iter().zip(columns.chunks_exact(rows.max(1))) {
            force.iter_mut().zip(column).for_each(|(force, x)| *force -= x * of_turned);
        }
    }

    /// Adds M⁻¹ Dᵀ f to the accelerations of every body, as [`ActiveRows::respond`] does without turned rows.
    ///
    /// # Panics
    ///
    /// If there is not one force per row and one acceleration per body.
    pub fn respond(&self, active: &ActiveRows, force: &[f64], change: &mut [[f64; 3]]) {
        active.respond(force, change);
        for (row, turn) in &self.turned {
            active.push_along(*row, turn, force[*row as usize], change);
        }
    }
}

impl ActiveRows {
    /// The bodies of a row, and the roots of their inverse masses.
    fn sides_of(&self, row: u32) -> ([u32; 2], [[f64; 3]; 2]) {
        let place = self.row_of.iter().position(|&other| other == row);
        place.map_or(([NONE; 2], [[0.0; 3]; 2]), |place| (self.bodies[place], self.root[place]))
    }

    /// Lists the rates that a unit of force on the bodies of a row gives all rows, along a direction of its own.
    fn list_rates(&self, row: u32, direction: &[f64; 6], rates: &mut Vec<f64>) {
        let (bodies, root) = self.sides_of(row);
        // A body on both sides is named once.
        let is_one = bodies[1] == NONE && root[1] != [0.0; 3];
        let mut sides =
            [0, 1].map(|side: usize| [0, 1, 2].map(|k: usize| root[side][k] * direction[3 * side + k]));
        if is_one {
            let [one, other] = sides;
            sides = [[one[0] + other[0], one[1] + other[1], one[2] + other[2]], [0.0; 3]];
        }
        rates.clear();
        rates.resize(self.len(), 0.0);
        for (place, (others, jacobian)) in self.bodies.iter().zip(&self.jacobian).enumerate() {
            let mut rate = 0.0;
            for (&body, side) in bodies.iter().zip(&sides).filter(|(body, _)| **body != NONE) {
                for (&other, entries) in others.iter().zip(jacobian) {
                    if other == body {
                        rate += side[0] * entries[0] + side[1] * entries[1] + side[2] * entries[2];
                    }
                }
            }
            rates[self.row_of[place] as usize] = rate;
        }
        for (&body, side) in bodies.iter().zip(&sides).filter(|(body, _)| **body != NONE) {
            self.add_third_rates(body, side[2], rates);
        }
        self.held.add_rates(row, direction, rates);
    }

    /// Adds what a force on the bodies of a row changes of their accelerations, along a direction of its own.
    fn push_along(&self, row: u32, direction: &[f64; 6], force: f64, change: &mut [[f64; 3]]) {
        let (bodies, root) = self.sides_of(row);
        for side in 0..2 {
            // A body on both sides is named once.
            let body = if bodies[side] == NONE && root[side] != [0.0; 3] { bodies[0] } else { bodies[side] };
            let Some(out) = change.get_mut(body as usize) else { continue };
            for k in 0..3 {
                out[k] += root[side][k] * root[side][k] * direction[3 * side + k] * force;
            }
        }
        self.held.push_along(row, direction, force, change);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::InverseInertia;
    use proptest::prelude::*;

    /// A rod of 1 kg and half length 1 m that leans by an angle whose tangent is `tan` over a floor, on which its end slides to the
    /// right: the row of its end, and what friction adds to it.
    fn rod(tan: f64, mu: f64) -> (InverseInertia, [f64; 6], [f64; 6]) {
        let (cos, sin) = (1.0 / tan.hypot(1.0), tan / tan.hypot(1.0));
        // The end lies at (cos, -sin) from the centre.
        let (normal, slip) = ([0.0, 1.0, cos, 0.0, 0.0, 0.0], [1.0, 0.0, sin, 0.0, 0.0, 0.0]);
        let inertia = InverseInertia { inverse_mass: 1.0, inverse_moment: 3.0 };
        (inertia, normal, slip.map(|entry| -mu * entry))
    }

    #[test]
    fn the_determinant_falls_to_zero_where_painleve_says() {
        for (mu, expected) in [(0.0, 1.0), (4.0 / 3.0, 0.0), (1.6, -0.2)] {
            let (inertia, normal, turn) = rod(2.0, mu);
            let mut active = ActiveRows::default();
            active.set_structure(&[inertia], &[[Some(0), None]]);
            active.factorize(&[normal]);
            let determinant = TurnedRows::default().factorize(&mut active, [(0, turn)]);
            // p = 1 + 3 cos (cos - mu sin) is 1.6 - 1.2 mu, and A_nn 1.6.
            let p = 1.6 * determinant;
            assert!((determinant - (1.6 - 1.2 * mu) / 1.6).abs() < 1e-14, "mu {mu}: {p} m");
            assert!((determinant - expected).abs() < 0.01 + 1e-12, "mu {mu}: {determinant}");
        }
    }

    #[test]
    fn a_block_that_slides_over_another_pushes_it_along() {
        // Blocks of 1 and 2 kg on each other, the lower one on a floor without friction; the upper one slides to the right.
        let of_mass = |mass: f64| InverseInertia { inverse_mass: 1.0 / mass, inverse_moment: 0.0 };
        let (g, mu) = (10.0, 0.3);
        let mut active = ActiveRows::default();
        active.set_structure(&[of_mass(1.0), of_mass(2.0)], &[[Some(0), Some(1)], [Some(1), None]]);
        active.factorize(&[[0.0, 1.0, 0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]]);
        let mut turned = TurnedRows::default();
        turned.factorize(&mut active, [(0, [-mu, 0.0, 0.0, mu, 0.0, 0.0])]);
        let mut force = [0.0; 2];
        turned.solve(&mut active, &[0.0, -g], &mut force);
        assert!((force[0] - g).abs() < 1e-13 && (force[1] - 3.0 * g).abs() < 1e-13, "{force:?}");
        let mut change = [[0.0, -g, 0.0]; 2];
        turned.respond(&active, &force, &mut change);
        assert!(
            (change[0][0] + mu * g).abs() < 1e-13 && (change[1][0] - 0.5 * mu * g).abs() < 1e-13,
            "{change:?}"
        );
        assert!(change.iter().all(|change| change[1].abs() < 1e-13), "{change:?}");
    }

    proptest! {
        #[test]
        fn turned_rows_hold_still_what_they_measure(
            entries in proptest::collection::vec(-1.0..1.0f64, 12 * 6),
            places in proptest::collection::vec((0u32..6, 0u32..7), 8),
            turns in proptest::collection::vec((0usize..8, proptest::array::uniform6(-0.3..0.3f64)), 0..4),
            offset in proptest::collection::vec(-1.0..1.0f64, 8),
        ) {
            let inertia = [InverseInertia { inverse_mass: 0.7, inverse_moment: 2.0 }; 6];
            let sides: Vec<[Option<u32>; 2]> =
                places.iter().map(|&(a, b)| [Some(a), (b < 6).then_some(b)]).collect();
            let jacobians: Vec<[f64; 6]> =
                entries.chunks(6).take(8).map(|row| row.try_into().expect("six numbers")).collect();
            let mut active = ActiveRows::default();
            active.set_structure(&inertia, &sides);
            let dependent = active.factorize(&jacobians);
            let mut turns: Vec<(u32, [f64; 6])> = turns.iter().map(|&(row, turn)| (row as u32, turn)).collect();
            turns.sort_by_key(|turn| turn.0);
            turns.dedup_by_key(|turn| turn.0);
            let mut turned = TurnedRows::default();
            let determinant = turned.factorize(&mut active, turns);
            prop_assume!(dependent == 0 && determinant.abs() > 0.1);
            let mut force = [0.0; 8];
            turned.solve(&mut active, &offset, &mut force);
            let mut change = [[0.0; 3]; 6];
            turned.respond(&active, &force, &mut change);
            let largest = force.iter().fold(1.0f64, |most, force| most.max(force.abs()));
            for ((jacobian, sides), offset) in jacobians.iter().zip(&sides).zip(&offset) {
                let rate: f64 = (0..2)
                    .filter_map(|side| Some((side, sides[side]?)))
                    .flat_map(|(side, body)| (0..3).map(move |k| (3 * side + k, body as usize, k)))
                    .map(|(entry, body, k)| jacobian[entry] * change[body][k])
                    .sum();
                prop_assert!((rate + offset).abs() < 1e-9 * largest, "{rate} {offset}, forces {largest}");
            }
        }
    }
}
