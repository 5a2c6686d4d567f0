//! The structure of active rows: the rows that share a body, the order of elimination, and the layout of the factor. It
//! does not change while the same rows are active.

use super::{ActiveRows, HeldBody, NONE, ThirdSide};
use crate::problem::InverseInertia;

/// An earlier row on a common body.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Shared {
    /// The side of that row that has the body: twice its place, plus 1 for the normal side.
    pub(super) side: u32,
    /// Position of the product of the two rows in the factor.
    pub(super) position: u32,
}

impl ActiveRows {
    /// Replaces all bodies and rows. `inertia` has the inverse masses of the bodies, `rows` the primary and normal body
    /// of each row: an index into `inertia`, or `None` for an immovable one. Orders the rows for small fill; no row is
    /// soft afterwards. [`factorize`](Self::factorize) must follow.
    ///
    /// # Panics
    ///
    /// If a row names a body that does not exist.
    pub fn set_structure(&mut self, inertia: &[InverseInertia], rows: &[[Option<u32>; 2]]) {
        self.set_structure_with_thirds(inertia, rows, &[]);
    }

    /// Does as [`set_structure`](Self::set_structure), with rows some of which have a third side; at most one each.
    ///
    /// # Panics
    ///
    /// If a row names a body, or a third side a row or body, that does not exist.
    pub fn set_structure_with_thirds(
        &mut self,
        inertia: &[InverseInertia],
        rows: &[[Option<u32>; 2]],
        thirds: &[ThirdSide],
    ) {
        self.set_structure_with_held(inertia, rows, thirds, []);
    }

    /// Does as [`set_structure_with_thirds`](Self::set_structure_with_thirds), with bodies that three rows each hold wholly. The forces
    /// of these rows follow from those of the others: they never depend on others, and are not soft. A row on held bodies alone depends on
    /// theirs. No third side may name a held body, nor one of its rows.
    ///
    /// # Panics
    ///
    /// If a row names a body, or a third side or a held body a row or body, that does not exist.
    pub fn set_structure_with_held(
        &mut self,
        inertia: &[InverseInertia],
        rows: &[[Option<u32>; 2]],
        thirds: &[ThirdSide],
        held: impl IntoIterator<Item = HeldBody>,
    ) {
        self.body_count = inertia.len();
        self.held.set(inertia, rows, held);
        self.find_order(inertia, rows, thirds);
        self.take_thirds(inertia, thirds);
        self.bodies.clear();
        self.root.clear();
        for place in 0..self.row_of.len() {
            let sides = self.movable(inertia, rows[self.row_of[place] as usize]);
            self.root.push(roots(inertia, sides));
            // The coefficients of a body on both sides add up on the first.
            self.bodies.push(if sides[0] == sides[1] { [sides[0], NONE] } else { sides });
        }
        self.list_shared();
        self.lay_out();
        self.jacobian.clear();
        self.jacobian.resize(self.root.len(), [[0.0; 3]; 2]);
        self.kept.clear();
        self.kept.resize(self.root.len(), 1.0);
        self.shares.clear();
        self.shares.resize(self.root.len(), false);
        self.raise.clear();
        self.raise.resize(self.root.len(), 0.0);
        self.is_soft = false;
        self.work.clear();
        self.work.resize(self.root.len(), 0.0);
        self.motion.clear();
        self.motion.resize(self.body_count, [0.0; 3]);
    }

    fn find_order(&mut self, inertia: &[InverseInertia], rows: &[[Option<u32>; 2]], thirds: &[ThirdSide]) {
        self.start.clear();
        self.start.push(0);
        self.column.clear();
        for &row in &self.held.others {
            let sides = self.movable(inertia, rows[row as usize]);
            self.column.extend(sides.into_iter().filter(|&body| body != NONE));
            let own = thirds.iter().filter(|third| third.row == row);
            let turning = own.filter(|third| inertia[third.body as usize].inverse_moment > 0.0);
            self.column.extend(turning.map(|third| third.body));
            self.start.push(self.column.len());
        }
        self.order.prepare_narrow(&self.start, &self.column, inertia.len());
        self.row_of.clear();
        self.row_of.extend(self.order.rows.iter().map(|&index| self.held.others[index as usize]));
    }

    /// The bodies of a row that are unknowns, `NONE` for an immovable one and for a held one.
    fn movable(&self, inertia: &[InverseInertia], sides: [Option<u32>; 2]) -> [u32; 2] {
        let moves = |body: &u32| {
            let InverseInertia { inverse_mass, inverse_moment } = inertia[*body as usize];
            (inverse_mass > 0.0 || inverse_moment > 0.0) && !self.held.contains(*body)
        };
        sides.map(|side| side.filter(moves).unwrap_or(NONE))
    }

    /// Lists the earlier rows that share a body with each side of each row.
    fn list_shared(&mut self) {
        self.head.clear();
        self.head.resize(self.body_count, NONE);
        self.previous.clear();
        self.shared.clear();
        self.shared_start.clear();
        self.shared_start.push(0);
        for bodies in &self.bodies {
            for &body in bodies {
                let mut side = if body == NONE { NONE } else { self.head[body as usize] };
                while side != NONE {
                    self.shared.push(Shared { side, position: 0 });
                    side = self.previous[side as usize];
                }
                self.shared_start.push(self.shared.len());
            }
            for &body in bodies {
                let side = self.previous.len() as u32;
                self.previous.push(if body == NONE { NONE } else { self.head[body as usize] });
                if body != NONE {
                    self.head[body as usize] = side;
                }
            }
        }
    }

    /// Lays out the tiles of the factor, and finds the positions of the products of rows in them.
    fn lay_out(&mut self) {
        let of_row = |place: usize| self.shared_start[2 * place]..self.shared_start[2 * place + 2];
        let place_of = |shared: &Shared| shared.side as usize / 2;
        let rows = 0..self.bodies.len();
        let first = |place| {
            let of_thirds = self.thirds.first(place, &self.bodies);
            self.shared[of_row(place)].iter().map(place_of).fold(of_thirds, usize::min)
        };
        self.factor.lay_out(rows.clone().map(first));
        for place in rows {
            for shared in &mut self.shared[of_row(place)] {
                shared.position = self.factor.position(place, place_of(shared)) as u32;
            }
        }
        self.list_crossings();
    }
}

/// Roots of the inverse masses of both sides, 0 on an immovable one.
fn roots(inertia: &[InverseInertia], sides: [u32; 2]) -> [[f64; 3]; 2] {
    sides.map(|body| {
        let rest = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        let InverseInertia { inverse_mass, inverse_moment } =
            if body == NONE { rest } else { inertia[body as usize] };
        [inverse_mass.sqrt(), inverse_mass.sqrt(), inverse_moment.sqrt()]
    })
}
