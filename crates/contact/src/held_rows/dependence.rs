//! Which rows depend on earlier ones, where the difference of squares does not tell, and which of them share
//! what they hold.
//!
//! What is left of a row between a light and a heavy body is little, in the measure of the masses, once other
//! rows hold the light one: no more than the part of the heavy one. It holds that one all the same. So what
//! is left is looked at body by body, too, against what all rows of the combination do to it.

use super::{HeldRows, NONE};

/// What the squares of soft rows are raised by, in parts of themselves: far more than the rounding of what
/// depends, far less than what does not.
const SOFTNESS: f64 = 1e-6;
/// A row depends on another that makes up more than this part of its square.
const SHARE: f64 = 1e-12;

impl HeldRows {
    /// From now on the given rows, of those that the last [`factorize`](Self::factorize) has found to depend
    /// on each other, share what they hold together instead of one of them taking all: none counts as
    /// dependent, and their forces are nearly the least that do, weighed by the squares of the rows. The
    /// others stay as stiff as they are: between a heavy and a light body a row has far less left of its
    /// square than what shares may lack.
    ///
    /// Their squares are raised a little, and what forces then lack is made good step by step. So which rows
    /// depend on which may change on the way without a jump, and a motion that departs from what they agree
    /// on by rounding has no forces that come from their disagreement alone. One that departs by more than
    /// some 1e-7 of a length has: who is farther off moves the bodies onto the rows first.
    pub fn soften(&mut self, may_share: impl Fn(usize) -> bool) {
        for ((raise, &row), &shares) in self.raise.iter_mut().zip(&self.order.rows).zip(&self.shares) {
            *raise = if shares && may_share(row as usize) { SOFTNESS } else { 0.0 };
        }
        self.is_soft = self.raise.iter().any(|&raise| raise > 0.0);
    }

    /// Whether any rows share what they hold.
    #[must_use]
    pub fn is_soft(&self) -> bool {
        self.is_soft
    }

    /// Whether a row depends on others, by the last [`factorize`](Self::factorize).
    #[must_use]
    pub fn is_dependent(&self, row: usize) -> bool {
        let place = self.order.rows.iter().position(|&other| other as usize == row);
        place.is_some_and(|place| !self.factor.has_pivot(place))
    }

    /// Notes which rows one depends on, whose rest has just been measured: those that make up more than rounding of it.
    pub(super) fn note_shares(&mut self, place: usize, diagonal: f64) {
        self.shares[place] = true;
        for k in 0..place {
            self.shares[k] |= self.work[k] * self.work[k] * self.square(k) > SHARE * diagonal;
        }
    }

    /// The least part of its square that a row kept in the last [`factorize`](Self::factorize) once earlier
    /// ones were held, so many rows left aside that kept even less; 1 if there are no more. Rows of loops
    /// depend on each other for a moment where it comes to nothing.
    #[must_use]
    pub fn kept_beyond(&mut self, aside: usize) -> f64 {
        if aside >= self.len() {
            return 1.0;
        }
        self.work.clear();
        self.work.extend_from_slice(&self.kept);
        *self.work.select_nth_unstable_by(aside, f64::total_cmp).1
    }

    /// The part of a row's square that earlier rows leave, from the row itself: |Ĵ_i - sum over k of x_k
    /// Ĵ_k|², and what squares are raised by times x_k². That has the rounding of the difference, squared,
    /// where the difference of squares has that of the squares, times what earlier small pivots make of it.
    pub(super) fn measure_rest(&mut self, place: usize) -> f64 {
        let first = self.factor.first(place);
        self.work[..first].fill(0.0);
        self.work[first..place]
            .iter_mut()
            .zip(self.factor.entries(place))
            .for_each(|(share, entry)| *share = entry);
        self.motion.fill([0.0; 3]);
        self.push(place, 1.0);
        for k in (0..place).rev() {
            let share = self.work[k];
            if share != 0.0 {
                self.push(k, -share);
                for (out, entry) in self.work[self.factor.first(k)..k].iter_mut().zip(self.factor.entries(k))
                {
                    *out -= share * entry;
                }
            }
        }
        let rest: f64 = self.motion.iter().map(|[x, y, turn]| x * x + y * y + turn * turn).sum();
        let raised = self.raise[..place].iter().enumerate().filter(|(_, raise)| **raise > 0.0);
        rest + raised.map(|(k, raise)| self.work[k] * self.work[k] * raise * self.square(k)).sum::<f64>()
    }

    /// True if what [`measure_rest`](Self::measure_rest) has left of a row moves any body by more than the
    /// part up to which rows are dependent, of what the rows of the combination do to it.
    pub(super) fn moves_by_itself(&mut self, place: usize) -> bool {
        self.gross.clear();
        self.gross.resize(self.motion.len(), 0.0);
        self.add_gross(place, 1.0);
        for k in 0..place {
            self.add_gross(k, self.work[k]);
        }
        let square = |[x, y, turn]: &[f64; 3]| x * x + y * y + turn * turn;
        let mut bodies = self.motion.iter().zip(&self.gross);
        bodies.any(|(motion, gross)| square(motion) > self.dependence * gross)
    }

    /// Adds what a multiple of a row of Ĵ does to each body to the sums of squares.
    fn add_gross(&mut self, place: usize, share: f64) {
        let sides = self.bodies[place].iter().zip(&self.jacobian[place]);
        for (&body, row) in sides.filter(|(body, _)| **body != NONE) {
            let part: f64 = row.iter().map(|entry| entry * entry).sum();
            self.gross[body as usize] += share * share * part;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::InverseInertia;

    /// Two rows that pin a body, or two at one place, at arms of both.
    fn pin(arm: [f64; 2], other: [f64; 2]) -> [[f64; 6]; 2] {
        [[1.0, 0.0, -arm[1], -1.0, 0.0, other[1]], [0.0, 1.0, arm[0], 0.0, -1.0, -other[0]]]
    }

    #[test]
    fn what_rows_keep_falls_with_the_square_of_the_way_to_where_they_depend() {
        // Two rods hold a disc along directions that come together, and a third doubles the first.
        let mut held = HeldRows::default();
        held.set_structure(
            &[InverseInertia { inverse_mass: 2.0, inverse_moment: 1.0 }],
            &[[Some(0), None]; 3],
        );
        let along = |angle: f64| [angle.cos(), angle.sin(), 0.0, 0.0, 0.0, 0.0];
        for angle in [0.3, 1e-2, 1e-4] {
            held.factorize(&[along(0.0), along(angle), along(0.0)]);
            let sine = angle.sin();
            assert!((held.kept_beyond(1) / (sine * sine) - 1.0).abs() < 1e-6, "{angle}");
            assert!(held.kept_beyond(0) < 1e-12);
            assert_eq!([held.kept_beyond(2), held.kept_beyond(3)], [1.0; 2]);
        }
    }

    #[test]
    fn a_heavy_body_on_a_light_one_that_is_pinned_is_held() {
        let inertia = |mass: f64| InverseInertia { inverse_mass: 1.0 / mass, inverse_moment: 1.0 / mass };
        let (to_world, between) = (pin([0.3, 0.1], [0.0; 2]), pin([-0.2, 0.4], [0.1, -0.5]));
        let rows: Vec<_> = to_world.into_iter().chain(between).collect();
        let sides = [[Some(0), None], [Some(0), None], [Some(0), Some(1)], [Some(0), Some(1)]];
        for heavy in [1e3, 1e9, 1e11] {
            let mut held = HeldRows::default();
            held.set_structure(&[inertia(1.0), inertia(heavy)], &sides);
            assert_eq!(held.factorize(&rows), 0, "{heavy:e}");
            let offset: Vec<f64> = rows.iter().map(|row| -9.81 * (row[1] + row[4])).collect();
            let mut force = [0.0; 4];
            held.solve(&offset, &mut force);
            let mut change = [[0.0, -9.81, 0.0]; 2];
            held.respond(&force, &mut change);
            // The pins of a massless bar and of what hangs from it: the lower one goes along the bar at no rate.
            let rate = |row: &[f64; 6]| (0..6).map(|k| row[k] * change[k / 3][k % 3]).sum::<f64>();
            assert!(rows[2..].iter().all(|row| rate(row).abs() < 1e-3), "{heavy:e}: {change:?}");
        }
    }

    #[test]
    fn a_pin_given_twice_between_a_light_and_a_heavy_body_depends() {
        let inertia = |mass: f64| InverseInertia { inverse_mass: 1.0 / mass, inverse_moment: 1.0 / mass };
        let rows: Vec<_> =
            [pin([0.3, 0.1], [0.7, -0.2]), pin([-0.2, 0.4], [0.2, 0.1]), pin([0.3, 0.1], [0.7, -0.2])]
                .into_iter()
                .flatten()
                .collect();
        let mut held = HeldRows::default();
        held.set_structure(&[inertia(1.0), inertia(1e11)], &[[Some(0), Some(1)]; 6]);
        assert_eq!(held.factorize(&rows), 3);
    }

    #[test]
    fn what_depends_on_rows_that_leave_little_is_told_from_their_rounding() {
        let inertia = |mass: f64| InverseInertia { inverse_mass: 1.0 / mass, inverse_moment: 1.0 / mass };
        // A light and a heavy body, both pinned to the world and to each other, and the heavy one once more.
        let sides = [[Some(0), None], [Some(0), Some(1)], [Some(1), None], [Some(1), None]];
        let sides: Vec<_> = sides.iter().flat_map(|sides| [*sides; 2]).collect();
        let arms = [[-0.987, -0.937], [0.986, -0.954], [-0.882, -0.968], [0.686, -0.979], [-0.418, -0.988]];
        for heavy in [1e9, 1e11, 3e12] {
            let to_world = |arm: usize| pin(arms[arm], [0.0; 2]);
            let pins = [to_world(0), pin(arms[1], arms[2]), to_world(3), to_world(4)];
            let rows: Vec<_> = pins.into_iter().flatten().collect();
            let mut held = HeldRows::default();
            held.set_structure(&[inertia(1.0), inertia(heavy)], &sides);
            assert_eq!(held.factorize(&rows), 2, "{heavy:e}");
        }
    }
}
