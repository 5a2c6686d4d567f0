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
mod held;
mod redundant;
mod refining;
mod structure;
mod thirds;
mod turned;

pub use held::HeldBody;
pub use thirds::ThirdSide;
pub use turned::TurnedRows;

use crate::exchanges::Exchanges;
use crate::order::RowOrder;
use crate::settings::{DELICATE, DOUBTFUL, Settings};
use factor::Factor;
use held::Held;
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
    /// The row at each place of the order.
    row_of: Vec<u32>,
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
    held: Held,
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
            row_of: Vec::new(),
            start: Vec::new(),
            column: Vec::new(),
            body_count: 0,
            bodies: Vec::new(),
            root: Vec::new(),
            shared: Vec::new(),
            shared_start: Vec::new(),
            thirds: Thirds::default(),
            held: Held::default(),
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
        self.root.len() + self.held.row_count()
    }

    /// Whether there are no rows.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
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
        self.held.take_coefficients(jacobians);
        self.set_entries(jacobians);
        for place in 0..self.root.len() {
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
            let (coefficients, [p, q]) = (&jacobians[self.row_of[place] as usize], &self.root[place]);
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
        self.solve_others(offset, force, Self::solve_and_refine);
    }

    #[inline]
    fn solve_and_refine(&mut self, offset: &[f64], force: &mut [f64]) {
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
        self.solve_others(offset, force, Self::solve_raised);
    }

    fn solve_raised(&mut self, offset: &[f64], force: &mut [f64]) {
        let rows = &self.row_of;
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
        let rows = self.bodies.iter().zip(&self.row_of).zip(self.jacobian.iter().zip(&self.root));
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
        self.held.respond(force, change);
    }
}

#[cfg(test)]
mod tests;
