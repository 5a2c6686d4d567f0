//! Forces of a fixed set of active rows, which are equations: A f = -b with A = J M⁻¹ Jᵀ, solved repeatedly as J and b change.
//!
//! This is the inner loop of an integrator: the rows stay, their coefficients change from stage to stage. All that
//! depends on the structure alone is therefore found once: an order of the rows that keeps the factor narrow (see
//! `order`), and the pairs of rows that share a body. A = L D Lᵀ is stored by rows from about their first nonzero on
//! (see `factor`), which for a chain of joints is a few entries a row: A. George, J. Liu, "Computer Solution of Large
//! Sparse Positive Definite Systems", 1981, chapter 4.
//!
//! A row that depends on those before it (a joint given twice, the third contact under a block) gets no pivot and no
//! force, unless it is soft: see [`ActiveRows::soften`]. The factor leaves a = A f + b at rounding of the terms A_ij f_j.
//! Where earlier rows leave little of a row, as with a heavy body on a light one, that rounding is large beside the
//! acceleration of the heavy body, and a step of refinement follows. It computes a from the motions of the bodies,
//! whose rounding all rows share.

mod dependence;
mod factor;
mod redundant;
mod refining;
mod structure;
mod thirds;
mod turned;

pub use thirds::ThirdSide;
pub use turned::TurnedRows;

use crate::exchanges::Exchanges;
use crate::order::RowOrder;
use crate::settings::{DELICATE, DOUBTFUL, Settings};
use factor::Factor;
use refining::Refining;
use structure::Shared;
use thirds::Thirds;

/// Fraction of a row's square A_ii: a remainder below it, left by earlier rows, cannot be told from the rounding of
/// their forces.
const RESOLVED: f64 = 1e-13;

/// In place of a body: no body, or an immovable one.
const NONE: u32 = u32::MAX;

/// Active rows (contacts and connectors) as equations A f = -b, with the structure of their factor kept from solve to
/// solve.
///
/// The order of calls is [`set_structure`](Self::set_structure), [`factorize`](Self::factorize) whenever coefficients
/// change, and any number of [`solve`](Self::solve) and [`respond`](Self::respond).
///
/// # Examples
///
/// ```
/// use halfgap_contact::{ActiveRows, InverseInertia};
///
/// // A pendulum: a rod of 2 kg and 1 m, pinned at its upper end, lying level; gravity pulls its middle down.
/// let rod = InverseInertia { inverse_mass: 0.5, inverse_moment: 6.0 };
/// let mut active = ActiveRows::default();
/// active.set_structure(&[rod], &[[Some(0), None]; 2]);
/// let dependent = active.factorize(&[[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, -0.5, 0.0, 0.0, 0.0]]);
/// assert_eq!(dependent, 0);
/// let mut force = [0.0; 2];
/// active.solve(&[0.0, -9.81], &mut force);
/// assert!((force[1] - 2.0 * 9.81 / 4.0).abs() < 1e-14);
/// let mut change = [[0.0, -9.81, 0.0]];
/// active.respond(&force, &mut change);
/// assert!((change[0][1] + 0.75 * 9.81).abs() < 1e-14);
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ActiveRows {
    /// Fraction of a row's square up to which its remainder makes it dependent.
    dependence: f64,
    order: RowOrder,
    /// Where the bodies of each row begin in `column`, for the order.
    start: Vec<usize>,
    column: Vec<u32>,
    body_count: usize,
    // From here on by place in that order.
    /// The movable bodies of each row; a body on both sides is named once.
    bodies: Vec<[u32; 2]>,
    /// Roots of the inverse masses of the coefficients of each row, for either side.
    root: Vec<[[f64; 3]; 2]>,
    /// Earlier rows that share a body with each side of each row, and where those of a side begin.
    shared: Vec<Shared>,
    shared_start: Vec<usize>,
    thirds: Thirds,
    /// L and 1/D; a row that depends on earlier ones has no pivot.
    factor: Factor,
    /// True for a row that depends on others, or on which another depends.
    shares: Vec<bool>,
    /// Fraction of itself by which the square of each row is raised; 0 for a row that is not soft.
    raise: Vec<f64>,
    is_soft: bool,
    /// Fraction of each row's square that earlier rows leave, without the raise.
    kept: Vec<f64>,
    /// True if earlier rows leave less than [`DELICATE`] of an independent row.
    is_delicate: bool,
    refining: Refining,
    exchanges: Exchanges,
    /// Ĵ = J M^(-1/2), for either side of each row.
    jacobian: Vec<[[f64; 3]; 2]>,
    work: Vec<f64>,
    /// A motion of the bodies, in units of M^(1/2).
    motion: Vec<[f64; 3]>,
    /// Sum over rows of the squared motions that they give each body.
    gross: Vec<f64>,
    /// Last side of a row on each body, and for each side the one before it on the same body.
    head: Vec<u32>,
    previous: Vec<u32>,
}

impl Default for ActiveRows {
    fn default() -> Self {
        Self::new(&Settings::default())
    }
}

impl ActiveRows {
    /// Makes a solver without rows. Of `settings` only [`dependence`](Settings::dependence) is used.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        Self {
            dependence: settings.dependence,
            order: RowOrder::default(),
            start: Vec::new(),
            column: Vec::new(),
            body_count: 0,
            bodies: Vec::new(),
            root: Vec::new(),
            shared: Vec::new(),
            shared_start: Vec::new(),
            thirds: Thirds::default(),
            factor: Factor::default(),
            shares: Vec::new(),
            raise: Vec::new(),
            is_soft: false,
            kept: Vec::new(),
            is_delicate: false,
            refining: Refining::default(),
            exchanges: Exchanges::default(),
            jacobian: Vec::new(),
            work: Vec::new(),
            motion: Vec::new(),
            gross: Vec::new(),
            head: Vec::new(),
            previous: Vec::new(),
        }
    }

    /// Number of rows.
    #[must_use]
    #[inline]
    pub fn len(&self) -> usize {
        self.root.len()
    }

    /// Whether there are no rows.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.root.is_empty()
    }

    /// Sets the coefficients of every row (x, y \[1\] and rotation \[m\] of the primary, then of the normal body) and
    /// factors A. Returns the number of rows that depend on others and take no force.
    ///
    /// # Panics
    ///
    /// If there is not one set of coefficients per row.
    pub fn factorize(&mut self, jacobians: &[[f64; 6]]) -> usize {
        assert_eq!(jacobians.len(), self.len(), "coefficients of every row");
        let mut dependent = 0;
        self.is_delicate = false;
        self.shares.fill(false);
        self.set_entries(jacobians);
        for place in 0..self.len() {
            let diagonal = self.square(place);
            let raised = self.raise[place] * diagonal;
            let mut left = (diagonal + raised) - self.factor.eliminate(place);
            let is_doubtful = raised == 0.0 && left <= DOUBTFUL * diagonal;
            if is_doubtful {
                left = self.measure_rest(place);
            }
            self.kept[place] = if diagonal > 0.0 { ((left - raised) / diagonal).max(0.0) } else { 0.0 };
            let independent = left > self.dependence * diagonal
                || (raised == 0.0 && left > RESOLVED * diagonal && self.moves_by_itself(place));
            self.factor.set_inverse_pivot(place, if independent { 1.0 / left } else { 0.0 });
            self.is_delicate |= independent && raised == 0.0 && left <= DELICATE * diagonal;
            if !independent {
                dependent += 1;
                self.note_shares(place, diagonal);
            }
        }
        dependent
    }

    /// Sets Ĵ, and the entries of Ĵ Ĵᵀ = A below the diagonal.
    fn set_entries(&mut self, jacobians: &[[f64; 6]]) {
        self.factor.clear();
        let entries = self.factor.entries_mut();
        for place in 0..self.root.len() {
            let (coefficients, [p, q]) = (&jacobians[self.order.rows[place] as usize], &self.root[place]);
            let [a, b, c, d, e, f] = *coefficients;
            let mut sides = [[a * p[0], b * p[1], c * p[2]], [d * q[0], e * q[1], f * q[2]]];
            if self.bodies[place][1] == NONE {
                let [one, other] = sides;
                sides = [[one[0] + other[0], one[1] + other[1], one[2] + other[2]], [0.0; 3]];
            }
            self.jacobian[place] = sides;
            let earlier = self.jacobian[..place].as_flattened();
            for (side, [x, y, turn]) in sides.into_iter().enumerate() {
                let start = &self.shared_start[2 * place + side..];
                for shared in &self.shared[start[0]..start[1]] {
                    let theirs = &earlier[shared.side as usize];
                    entries[shared.position as usize] += x * theirs[0] + y * theirs[1] + turn * theirs[2];
                }
            }
        }
        self.thirds.add_entries(&self.jacobian, entries);
    }

    /// The square A_ii of a row of Ĵ.
    fn square(&self, place: usize) -> f64 {
        let [p, q] = &self.jacobian[place];
        let of_two = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) + (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
        of_two + self.third_square(place)
    }

    /// Adds a multiple of a row of Ĵ to the motion.
    fn push(&mut self, place: usize, share: f64) {
        let sides = self.bodies[place].iter().zip(&self.jacobian[place]);
        for (&body, row) in sides.filter(|(body, _)| **body != NONE) {
            for (out, entry) in self.motion[body as usize].iter_mut().zip(row) {
                *out += share * entry;
            }
        }
        if let Some(third) = self.thirds.of(place) {
            self.motion[third.body as usize][2] += share * third.entry;
        }
    }

    /// Finds the forces f \[N\] with A f = -b, which hold all rows at a = A f + b = 0; `offset` is b [m/s²], negative
    /// when closing. Rows that depend on others get no force, and their a is 0 if their b agrees with that of the
    /// others. With closing velocities [m/s] for b, f are impulses [N·s].
    ///
    /// # Panics
    ///
    /// If there is not one offset and one force per row.
    #[inline]
    pub fn solve(&mut self, offset: &[f64], force: &mut [f64]) {
        assert_eq!(offset.len(), self.len(), "one offset per row");
        assert_eq!(force.len(), self.len(), "one force per row");
        self.solve_raised(offset, force);
        if !self.is_soft && !self.is_delicate {
            return;
        }
        let mut refining = std::mem::take(&mut self.refining);
        if self.is_soft {
            self.refine(offset, force, &mut refining);
        } else {
            self.correct(offset, force, &mut refining);
        }
        self.refining = refining;
    }

    /// Does as [`solve`](Self::solve) without its refinement: about 1e-6 of the load of softened rows is missing, and
    /// more in the directions in which they nearly depend on each other. For callers that iterate.
    ///
    /// # Panics
    ///
    /// If there is not one offset and one force per row.
    #[inline]
    pub fn solve_roughly(&mut self, offset: &[f64], force: &mut [f64]) {
        assert_eq!(offset.len(), self.len(), "one offset per row");
        assert_eq!(force.len(), self.len(), "one force per row");
        self.solve_raised(offset, force);
    }

    fn solve_raised(&mut self, offset: &[f64], force: &mut [f64]) {
        let rows = &self.order.rows;
        let right = |place: usize| rows.get(place).map_or(0.0, |&row| -offset[row as usize]);
        self.factor.solve(right, |place, value| {
            if let Some(&row) = rows.get(place) {
                force[row as usize] = value;
            }
        });
    }

    /// Adds M⁻¹ Jᵀ f, the change by the forces `force` \[N\], to the accelerations of every body (x, y [m/s²], rotation
    /// [rad/s²]).
    ///
    /// # Panics
    ///
    /// If there is not one force per row and one acceleration per body.
    #[inline]
    pub fn respond(&self, force: &[f64], change: &mut [[f64; 3]]) {
        assert_eq!(force.len(), self.len(), "one force per row");
        assert_eq!(change.len(), self.body_count, "one acceleration per body");
        let rows = self.bodies.iter().zip(&self.order.rows).zip(self.jacobian.iter().zip(&self.root));
        for ((bodies, &index), (row, root)) in rows {
            let push = force[index as usize];
            for ((&body, row), root) in bodies.iter().zip(row).zip(root) {
                // `NONE` is beyond the last body.
                let Some(out) = change.get_mut(body as usize) else { continue };
                for k in 0..3 {
                    out[k] += root[k] * row[k] * push;
                }
            }
        }
        self.respond_by_thirds(force, change);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::InverseInertia;
    use proptest::prelude::*;

    const INERTIA: InverseInertia = InverseInertia { inverse_mass: 0.8, inverse_moment: 3.0 };

    /// M⁻¹ Jᵀ f and A f, computed the plain way.
    fn accelerations(
        inertia: &[InverseInertia],
        rows: &[[Option<u32>; 2]],
        jacobians: &[[f64; 6]],
        force: &[f64],
    ) -> (Vec<[f64; 3]>, Vec<f64>) {
        accelerations_with_thirds(inertia, (rows, &[]), jacobians, force)
    }

    fn accelerations_with_thirds(
        inertia: &[InverseInertia],
        (rows, thirds): (&[[Option<u32>; 2]], &[ThirdSide]),
        jacobians: &[[f64; 6]],
        force: &[f64],
    ) -> (Vec<[f64; 3]>, Vec<f64>) {
        let mut change = vec![[0.0; 3]; inertia.len()];
        let entries = |row: usize| {
            let own = thirds.iter().filter(move |third| third.row as usize == row);
            let of_two =
                (0..6).filter_map(move |k| Some((rows[row][k / 3]? as usize, k % 3, jacobians[row][k])));
            of_two.chain(own.map(|third| (third.body as usize, 2, third.coefficient)))
        };
        for (row, push) in force.iter().enumerate() {
            for (body, k, coefficient) in entries(row) {
                let weight = if k < 2 { inertia[body].inverse_mass } else { inertia[body].inverse_moment };
                change[body][k] += weight * coefficient * push;
            }
        }
        let rate = |row| entries(row).map(|(body, k, coefficient)| coefficient * change[body][k]).sum();
        let rates = (0..rows.len()).map(rate).collect();
        (change, rates)
    }

    /// Solves and compares with the plain products. The offsets must be those of some motion, so that dependent rows
    /// agree. Returns how many rows are dependent.
    fn check(
        inertia: &[InverseInertia],
        rows: &[[Option<u32>; 2]],
        jacobians: &[[f64; 6]],
        offset: &[f64],
    ) -> usize {
        check_with_thirds(inertia, (rows, &[]), jacobians, offset)
    }

    fn check_with_thirds(
        inertia: &[InverseInertia],
        (rows, thirds): (&[[Option<u32>; 2]], &[ThirdSide]),
        jacobians: &[[f64; 6]],
        offset: &[f64],
    ) -> usize {
        let mut active = ActiveRows::default();
        active.set_structure_with_thirds(inertia, rows, thirds);
        let dependent = active.factorize(jacobians);
        let mut force = vec![f64::NAN; rows.len()];
        active.solve(offset, &mut force);
        let (expected, rates) = accelerations_with_thirds(inertia, (rows, thirds), jacobians, &force);
        let largest = force.iter().fold(1.0f64, |m, f| m.max(f.abs()));
        for row in 0..rows.len() {
            // Rows whose remainder is up to the root of the threshold count as dependent.
            let rounding = if active.is_dependent(row) { 1e-4 } else { 1e-11 };
            let left = rates[row] + offset[row];
            assert!(
                left.abs() <= rounding * largest,
                "row {row} of {}: {left}, forces {largest}",
                rows.len()
            );
            assert!(!active.is_dependent(row) || force[row] == 0.0);
        }
        assert_eq!((0..rows.len()).filter(|&row| active.is_dependent(row)).count(), dependent);
        let mut change = vec![[0.0; 3]; inertia.len()];
        active.respond(&force, &mut change);
        for (p, q) in change.iter().zip(&expected) {
            assert!((0..3).all(|k| (p[k] - q[k]).abs() <= 1e-12 * largest));
        }
        dependent
    }

    #[test]
    fn soft_rows_hold_as_much_and_share_it() {
        // A body on two pins and, twice as far out, a third: three of the six rows depend on the others.
        let (sides, arms) = ([[Some(0), None]; 6], [-1.0, 1.0, 2.0]);
        let jacobians: Vec<[f64; 6]> = arms
            .into_iter()
            .flat_map(|arm| [[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, arm, 0.0, 0.0, 0.0]])
            .collect();
        let gravity: Vec<f64> = jacobians.iter().map(|row| -10.0 * row[1]).collect();
        let mut active = ActiveRows::default();
        active.set_structure(&[INERTIA], &sides);
        assert_eq!(active.factorize(&jacobians), 3);
        active.soften(|_| true);
        assert_eq!(active.factorize(&jacobians), 0);
        let mut force = [f64::NAN; 6];
        active.solve(&gravity, &mut force);
        let (change, _) = accelerations(&[INERTIA], &sides, &jacobians, &force);
        assert!((change[0][1] - 10.0).abs() < 1e-12 && change[0][2].abs() < 1e-12, "{change:?}");
        // The least forces, each weighed by its row's square, that carry 12.5 N without a torque: (p + q arm)/square.
        let square = |arm: f64| INERTIA.inverse_mass + INERTIA.inverse_moment * arm * arm;
        let sum = |power: i32| arms.iter().map(|&arm| arm.powi(power) / square(arm)).sum::<f64>();
        let p = 12.5 / (sum(0) - sum(1) * sum(1) / sum(2));
        let q = -p * sum(1) / sum(2);
        for (arm, force) in arms.into_iter().zip(force.chunks(2)) {
            let expected = (p + q * arm) / square(arm);
            assert!((force[1] - expected).abs() < 1e-4 && force[0].abs() < 1e-12, "{arm}: {force:?}");
        }
        // A disagreement of the rows moves nothing, and its forces stay bounded.
        let mut disagreeing = gravity.clone();
        disagreeing[1] += 1e-9;
        active.solve(&disagreeing, &mut force);
        let (change, _) = accelerations(&[INERTIA], &sides, &jacobians, &force);
        assert!((change[0][1] - 10.0).abs() < 1e-8, "{change:?}");
        assert!(force.iter().all(|force| force.abs() < 20.0), "{force:?}");
    }

    /// The offsets of the rows for given accelerations of the bodies.
    fn offsets(rows: &[[Option<u32>; 2]], jacobians: &[[f64; 6]], motion: &[[f64; 3]]) -> Vec<f64> {
        let sum = |(sides, row): (&[Option<u32>; 2], &[f64; 6])| {
            (0..6).filter_map(|k| Some(row[k] * motion[sides[k / 3]? as usize][k % 3])).sum()
        };
        rows.iter().zip(jacobians).map(sum).collect()
    }

    /// Two rows that pin body to body at two arms.
    fn pin(sides: [Option<u32>; 2], [p, q]: [[f64; 2]; 2]) -> ([[Option<u32>; 2]; 2], [[f64; 6]; 2]) {
        ([sides; 2], [[1.0, 0.0, -p[1], -1.0, 0.0, q[1]], [0.0, 1.0, p[0], 0.0, -1.0, -q[0]]])
    }

    #[test]
    fn a_chain_has_a_narrow_factor_in_any_order() {
        let links = 20;
        let mut joints: Vec<_> =
            (0..links).map(|k: u32| pin([Some(k), k.checked_sub(1)], [[-0.5, 0.1], [0.5, -0.1]])).collect();
        joints.sort_by_key(|(rows, _)| rows[0][0].map(|body| body * 7 % 20));
        let rows: Vec<_> = joints.iter().flat_map(|joint| joint.0).collect();
        let jacobians: Vec<_> = joints.iter().flat_map(|joint| joint.1).collect();
        let inertia = vec![INERTIA; links as usize];
        let offset: Vec<f64> = (0..2 * links).map(|k| f64::from(k % 3) - 9.81).collect();
        assert_eq!(check(&inertia, &rows, &jacobians, &offset), 0);
        let mut active = ActiveRows::default();
        active.set_structure(&inertia, &rows);
        let entries: usize = (0..rows.len())
            .map(|place| active.factor.entries(place).filter(|entry| *entry != 0.0).count())
            .sum();
        assert!(entries <= 3 * rows.len(), "{entries} entries");
    }

    #[test]
    fn the_third_contact_under_a_block_takes_no_force() {
        let corner = |arm| [0.0, 1.0, arm, 0.0, 0.0, 0.0];
        let jacobians = [corner(-0.5), corner(0.1), corner(0.5)];
        assert_eq!(check(&[INERTIA], &[[Some(0), None]; 3], &jacobians, &[-9.81; 3]), 1);
    }

    #[test]
    fn rows_that_depend_on_no_others_are_as_stiff_as_before() {
        // A heavy body hangs from a light one, which a pin holds; beside them a body is pinned twice.
        let (light, heavy) = (
            InverseInertia { inverse_mass: 1e3, inverse_moment: 1e3 },
            InverseInertia { inverse_mass: 1e-5, inverse_moment: 1e-5 },
        );
        let (to_world, between) = (
            pin([Some(0), None], [[0.3, 0.1], [0.0; 2]]),
            pin([Some(0), Some(1)], [[-0.2, 0.4], [0.1, -0.5]]),
        );
        let doubled =
            [pin([Some(2), None], [[0.3, 0.1], [0.0; 2]]), pin([Some(2), None], [[-0.7, 0.2], [0.0; 2]])];
        let pins = [to_world, between, doubled[0], doubled[1]];
        let rows: Vec<_> = pins.iter().flat_map(|(sides, _)| *sides).collect();
        let jacobians: Vec<_> = pins.iter().flat_map(|(_, pair)| *pair).collect();
        let inertia = [light, heavy, INERTIA];
        let mut active = ActiveRows::default();
        active.set_structure(&inertia, &rows);
        assert_eq!(active.factorize(&jacobians), 1);
        active.soften(|_| true);
        assert!(active.is_soft() && active.factorize(&jacobians) == 0);
        let falls = |side: Option<u32>| if side.is_some() { -9.81 } else { 0.0 };
        let offset: Vec<_> = rows
            .iter()
            .zip(&jacobians)
            .map(|(sides, row)| row[1] * falls(sides[0]) + row[4] * falls(sides[1]))
            .collect();
        let mut force = vec![0.0; rows.len()];
        active.solve(&offset, &mut force);
        let (_, rates) = accelerations(&inertia, &rows, &jacobians, &force);
        // Forces of 4e5 N on a body of a gram.
        assert!(rates.iter().zip(&offset).all(|(rate, offset)| (rate + offset).abs() < 1e-6), "{rates:?}");
    }

    #[test]
    fn rows_without_a_movable_body_take_no_force() {
        let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        let jacobians = [[1.0, 0.0, 0.0, -1.0, 0.0, 0.0]; 2];
        assert_eq!(
            check(&[fixed, INERTIA], &[[Some(0), None], [Some(0), Some(1)]], &jacobians, &[0.0, 1.0]),
            1
        );
    }

    #[test]
    fn a_body_on_both_sides_counts_once() {
        let jacobians = [[1.0, 0.5, 0.3, -0.2, 1.0, 0.4]];
        assert_eq!(check(&[INERTIA], &[[Some(0), Some(0)]], &jacobians, &[2.0]), 0);
    }

    #[test]
    fn another_structure_can_follow() {
        let mut active = ActiveRows::default();
        for count in [3usize, 1, 5] {
            let rows: Vec<_> = (0..count).map(|k| [Some(k as u32), None]).collect();
            active.set_structure(&vec![INERTIA; count], &rows);
            assert_eq!(active.len(), count);
            assert_eq!(active.factorize(&vec![[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]; count]), 0);
            let mut force = vec![0.0; count];
            active.solve(&vec![-0.8; count], &mut force);
            assert!(force.iter().all(|f| (f - 1.0).abs() < 1e-15));
        }
    }

    /// A row of angles alone: a - ratio b + (ratio - 1) c, with c as its third side.
    fn gear(row: u32, carrier: u32, ratio: f64) -> ([f64; 6], ThirdSide) {
        let third = ThirdSide { row, body: carrier, coefficient: ratio - 1.0 };
        ([0.0, 0.0, 1.0, 0.0, 0.0, -ratio], third)
    }

    #[test]
    fn two_gears_on_one_carrier_turn_as_their_ratios_say() {
        // A sun, a planet and their carrier, all free to turn; the ring is fixed.
        let [sun, planet, carrier] =
            [3.0, 5.0, 0.5].map(|inverse_moment| InverseInertia { inverse_mass: 1.0, inverse_moment });
        let (first, of_first) = gear(0, 2, -0.8);
        let (second, of_second) = gear(1, 2, 3.25);
        let sides = [[Some(0), Some(1)], [Some(1), None]];
        let mut active = ActiveRows::default();
        let inertia = [sun, planet, carrier];
        active.set_structure_with_thirds(&inertia, &sides, &[of_second, of_first]);
        assert_eq!(active.factorize(&[first, second]), 0);
        let mut force = [0.0; 2];
        active.solve(&[3.0, 0.0], &mut force);
        // A unit torque on the sun; planet and carrier turn -2.25/3.6 and 1/3.6 as fast as it.
        let mut change = [[0.0, 0.0, 3.0], [0.0; 3], [0.0; 3]];
        active.respond(&force, &mut change);
        let [p, c] = [-2.25 / 3.6, 1.0 / 3.6];
        let expected = 1.0 / (1.0 / 3.0 + p * p / 5.0 + c * c / 0.5);
        for (change, share) in change.iter().zip([1.0, p, c]) {
            assert!((change[2] - share * expected).abs() < 1e-14 && change[..2] == [0.0; 2], "{change:?}");
        }
    }

    #[test]
    fn a_gear_given_twice_depends_and_soft_rows_share_its_load() {
        let (row, third) = gear(0, 2, -0.8);
        let sides = [[Some(0), Some(1)]; 2];
        let thirds = [third, ThirdSide { row: 1, ..third }];
        let inertia = [INERTIA; 3];
        assert_eq!(check_with_thirds(&inertia, (&sides, &thirds), &[row; 2], &[1.0; 2]), 1);
        // The same sides without the carrier are another row.
        assert_eq!(check_with_thirds(&inertia, (&sides, &thirds[..1]), &[row; 2], &[1.0, 0.5]), 0);
        let mut active = ActiveRows::default();
        active.set_structure_with_thirds(&inertia, &sides, &thirds);
        active.factorize(&[row; 2]);
        active.soften(|_| true);
        assert_eq!(active.factorize(&[row; 2]), 0);
        let mut force = [0.0; 2];
        active.solve(&[1.0; 2], &mut force);
        let (_, rates) = accelerations_with_thirds(&inertia, (&sides, &thirds), &[row; 2], &force);
        assert!((force[0] - force[1]).abs() < 1e-6 && (rates[0] + 1.0).abs() < 1e-13, "{force:?} {rates:?}");
    }

    #[test]
    fn a_gear_between_fixed_bodies_holds_its_carrier() {
        let (row, third) = gear(0, 0, -0.8);
        assert_eq!(check_with_thirds(&[INERTIA], (&[[None; 2]], &[third]), &[row], &[1.0]), 0);
        // A carrier that cannot turn is no side.
        let fixed = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        assert_eq!(check_with_thirds(&[fixed], (&[[None; 2]], &[third]), &[row], &[0.0]), 1);
    }

    fn any_body() -> impl Strategy<Value = InverseInertia> {
        (0.1..10.0f64, 0.1..10.0f64, 0..8).prop_map(|(inverse_mass, inverse_moment, kind)| match kind {
            0 => InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 },
            _ => InverseInertia { inverse_mass, inverse_moment },
        })
    }

    /// Bodies, their rows, the coefficients of the rows, and a motion of the bodies.
    type Linkage = (Vec<InverseInertia>, Vec<[Option<u32>; 2]>, Vec<[f64; 6]>, Vec<[f64; 3]>);

    /// Linkages of pins: a tree, some loops, some pins given twice.
    fn any_linkage() -> impl Strategy<Value = Linkage> {
        let arms = prop::array::uniform2(prop::array::uniform2(-1.0..1.0f64));
        let joint = (any::<prop::sample::Index>(), any::<prop::sample::Index>(), arms, 0..6);
        let bodies = 1..25usize;
        (bodies, 0..4usize).prop_flat_map(move |(bodies, loops)| {
            let movers = prop::collection::vec(any_body(), bodies);
            let motion = prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), bodies);
            let joints = prop::collection::vec(joint.clone(), bodies + loops);
            (movers, joints, motion).prop_map(|(movers, joints, motion)| {
                let (mut rows, mut jacobians) = (Vec::new(), Vec::new());
                for (k, (one, other, arms, kind)) in joints.iter().enumerate() {
                    let first = if k < movers.len() { k } else { one.index(movers.len()) };
                    let second = if first == 0 { None } else { Some(other.index(first) as u32) };
                    let (sides, pair) = pin([Some(first as u32), second], *arms);
                    for _ in 0..if *kind == 0 { 2 } else { 1 } {
                        rows.extend(sides);
                        jacobians.extend(pair);
                    }
                }
                let moves = |body: usize| f64::from(u8::from(movers[body].inverse_mass > 0.0));
                let motion = (0..movers.len()).map(|body| motion[body].map(|v| v * moves(body))).collect();
                (movers, rows, jacobians, motion)
            })
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn linkages_with_loops_and_doubled_joints_are_held((inertia, rows, jacobians, motion) in any_linkage()) {
            let offset = offsets(&rows, &jacobians, &motion);
            let dependent = check(&inertia, &rows, &jacobians, &offset);
            let movable = inertia.iter().filter(|body| body.inverse_mass > 0.0).count();
            prop_assert!(rows.len() - dependent <= 3 * movable);
        }

        #[test]
        fn linkages_with_third_sides_are_held(
            (inertia, rows, jacobians, motion) in any_linkage(),
            thirds in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), -2.0..2.0f64), 1..6),
        ) {
            let named = thirds.into_iter().map(|(row, body, coefficient)| ThirdSide {
                row: row.index(rows.len()) as u32,
                body: body.index(inertia.len()) as u32,
                coefficient,
            });
            let mut thirds: Vec<ThirdSide> =
                named.filter(|third| !rows[third.row as usize].contains(&Some(third.body))).collect();
            thirds.sort_by_key(|third| third.row);
            thirds.dedup_by_key(|third| third.row);
            let mut offset = offsets(&rows, &jacobians, &motion);
            for third in &thirds {
                offset[third.row as usize] += third.coefficient * motion[third.body as usize][2];
            }
            check_with_thirds(&inertia, (&rows, &thirds), &jacobians, &offset);
        }
    }
}
