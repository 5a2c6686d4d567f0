//! Rows that depend on earlier ones where the difference of squares cannot tell, and rows that share their load.
//!
//! Once other rows hold the light body, little is left of the square of a row between a light and a heavy body: the
//! share of the heavy one. The row holds the heavy body all the same. The remainder is therefore also compared body by
//! body with the motions that all rows of the combination give the body.

use super::{ActiveRows, NONE};

/// Fraction of itself by which the square A_ii of a soft row is raised: far more than the rounding of a dependent row's
/// remainder, far less than the remainder of an independent row.
const SOFTNESS: f64 = 1e-6;
/// Fraction of a dependent row's square: the row depends on the rows whose parts in it have squares above this.
const SHARE: f64 = 1e-12;

impl ActiveRows {
    /// Lets rows share their load from the next [`factorize`](Self::factorize) on: those that the last one found to
    /// depend on each other, and for which `may_share` (called with the index of a row) is true. None of these then
    /// counts as dependent, and their forces are nearly those of least norm, weighted by the squares of the rows. All
    /// other rows keep their stiffness: between a heavy and a light body, earlier rows may leave a far smaller fraction
    /// of a row's square than the 1e-6 by which soft rows are raised.
    ///
    /// The squares of these rows are raised by 1e-6 of themselves, and [`solve`](Self::solve) makes up for the missing
    /// force by refinement. Forces therefore do not jump when the dependence among these rows changes along a motion,
    /// and a motion that violates the rows by rounding causes no forces from their disagreement alone. A violation by
    /// more than about 1e-7 of a length does: callers farther off must move the bodies onto the rows first.
    #[inline]
    pub fn soften(&mut self, may_share: impl Fn(usize) -> bool) {
        for ((raise, &row), &shares) in self.raise.iter_mut().zip(&self.row_of).zip(&self.shares) {
            *raise = if shares && may_share(row as usize) { SOFTNESS } else { 0.0 };
        }
        self.is_soft = self.raise.iter().any(|&raise| raise > 0.0);
    }

    /// Whether any rows share their load by [`soften`](Self::soften).
    #[must_use]
    #[inline]
    pub fn is_soft(&self) -> bool {
        self.is_soft
    }

    /// Whether the row with index `row` depends on others by the last [`factorize`](Self::factorize), and so takes no
    /// force.
    #[must_use]
    #[inline]
    pub fn is_dependent(&self, row: usize) -> bool {
        let place = self.row_of.iter().position(|&other| other as usize == row);
        place.is_some_and(|place| !self.factor.has_pivot(place))
    }

    /// Notes the rows on which one depends whose rest has just been measured: those whose part in it exceeds rounding.
    pub(super) fn note_shares(&mut self, place: usize, diagonal: f64) {
        self.shares[place] = true;
        for k in 0..place {
            self.shares[k] |= self.work[k] * self.work[k] * self.square(k) > SHARE * diagonal;
        }
    }

    /// Returns the fraction of its square that a row kept in the last [`factorize`](Self::factorize) once earlier ones
    /// were active: the least of all rows after the `aside` rows that kept even less. 1 if there are no more rows. Where
    /// it falls to 0, rows of loops depend on each other for a moment.
    #[must_use]
    #[inline]
    pub fn kept_beyond(&mut self, aside: usize) -> f64 {
        if aside >= self.kept.len() {
            return 1.0;
        }
        self.work.clear();
        self.work.extend_from_slice(&self.kept);
        *self.work.select_nth_unstable_by(aside, f64::total_cmp).1
    }

    /// The remainder of a row's square that earlier rows leave, computed from the row itself: |Ĵ_i - sum over k of x_k
    /// Ĵ_k|², plus the raises of the squares times x_k². Its rounding is that of the difference, squared; the
    /// difference of squares has the rounding of the squares, enlarged by earlier small pivots.
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

    /// True if the rest of a row, just found by [`measure_rest`](Self::measure_rest), moves some body by more than
    /// rounding: its squared motion exceeds `dependence` times the sum of those that the rows of the combination give
    /// the body. Rows whose squared share in it is no more than `dependence` carry next to no force, and do not count: a
    /// body that only they move is let go with them.
    pub(super) fn moves_by_itself(&mut self, place: usize) -> bool {
        self.gross.clear();
        self.gross.resize(self.motion.len(), 0.0);
        self.add_gross(place, 1.0);
        for k in 0..place {
            if self.work[k] * self.work[k] > self.dependence {
                self.add_gross(k, self.work[k]);
            }
        }
        let square = |[x, y, turn]: &[f64; 3]| x * x + y * y + turn * turn;
        let mut bodies = self.motion.iter().zip(&self.gross);
        bodies.any(|(motion, &gross)| gross > 0.0 && square(motion) > self.dependence * gross)
    }

    /// Adds the squared motion of each body by a multiple of a row of Ĵ to `gross`.
    fn add_gross(&mut self, place: usize, share: f64) {
        let sides = self.bodies[place].iter().zip(&self.jacobian[place]);
        for (&body, row) in sides.filter(|(body, _)| **body != NONE) {
            let part: f64 = row.iter().map(|entry| entry * entry).sum();
            self.gross[body as usize] += share * share * part;
        }
        if let Some(third) = self.thirds.of(place) {
            self.gross[third.body as usize] += share * share * third.entry * third.entry;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::InverseInertia;

    /// The two rows of a pin between two bodies at the given arms; the second may be immovable.
    fn pin(arm: [f64; 2], other: [f64; 2]) -> [[f64; 6]; 2] {
        [[1.0, 0.0, -arm[1], -1.0, 0.0, other[1]], [0.0, 1.0, arm[0], 0.0, -1.0, -other[0]]]
    }

    #[test]
    fn the_share_that_rows_keep_falls_with_the_square_of_the_way_to_where_they_depend() {
        // Two rods hold a disc along directions that come together, and a third doubles the first.
        let mut active = ActiveRows::default();
        active.set_structure(
            &[InverseInertia { inverse_mass: 2.0, inverse_moment: 1.0 }],
            &[[Some(0), None]; 3],
        );
        let along = |angle: f64| [angle.cos(), angle.sin(), 0.0, 0.0, 0.0, 0.0];
        for angle in [0.3, 1e-2, 1e-4] {
            active.factorize(&[along(0.0), along(angle), along(0.0)]);
            let sine = angle.sin();
            assert!((active.kept_beyond(1) / (sine * sine) - 1.0).abs() < 1e-6, "{angle}");
            assert!(active.kept_beyond(0) < 1e-12);
            assert_eq!([active.kept_beyond(2), active.kept_beyond(3)], [1.0; 2]);
        }
    }

    #[test]
    fn a_heavy_body_on_a_light_one_that_is_pinned_is_held() {
        let inertia = |mass: f64| InverseInertia { inverse_mass: 1.0 / mass, inverse_moment: 1.0 / mass };
        let (to_world, between) = (pin([0.3, 0.1], [0.0; 2]), pin([-0.2, 0.4], [0.1, -0.5]));
        let rows: Vec<_> = to_world.into_iter().chain(between).collect();
        let sides = [[Some(0), None], [Some(0), None], [Some(0), Some(1)], [Some(0), Some(1)]];
        for heavy in [1e3, 1e9, 1e11] {
            let mut active = ActiveRows::default();
            active.set_structure(&[inertia(1.0), inertia(heavy)], &sides);
            assert_eq!(active.factorize(&rows), 0, "{heavy:e}");
            let offset: Vec<f64> = rows.iter().map(|row| -9.81 * (row[1] + row[4])).collect();
            let mut force = [0.0; 4];
            active.solve(&offset, &mut force);
            let mut change = [[0.0, -9.81, 0.0]; 2];
            active.respond(&force, &mut change);
            // The light body is nearly a massless bar from which the heavy one hangs: the rows of the lower pin keep a
            // rate of zero.
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
        let mut active = ActiveRows::default();
        active.set_structure(&[inertia(1.0), inertia(1e11)], &[[Some(0), Some(1)]; 6]);
        assert_eq!(active.factorize(&rows), 3);
    }

    #[test]
    fn a_row_that_depends_on_rows_that_leave_little_is_told_from_their_rounding() {
        let inertia = |mass: f64| InverseInertia { inverse_mass: 1.0 / mass, inverse_moment: 1.0 / mass };
        // A light and a heavy body, both pinned to the world and to each other; the heavy one is pinned to the world
        // once more.
        let sides = [[Some(0), None], [Some(0), Some(1)], [Some(1), None], [Some(1), None]];
        let sides: Vec<_> = sides.iter().flat_map(|sides| [*sides; 2]).collect();
        let arms = [[-0.987, -0.937], [0.986, -0.954], [-0.882, -0.968], [0.686, -0.979], [-0.418, -0.988]];
        for heavy in [1e9, 1e11, 3e12] {
            let to_world = |arm: usize| pin(arms[arm], [0.0; 2]);
            let pins = [to_world(0), pin(arms[1], arms[2]), to_world(3), to_world(4)];
            let rows: Vec<_> = pins.into_iter().flatten().collect();
            let mut active = ActiveRows::default();
            active.set_structure(&[inertia(1.0), inertia(heavy)], &sides);
            assert_eq!(active.factorize(&rows), 2, "{heavy:e}");
        }
    }
}
