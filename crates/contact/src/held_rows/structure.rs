//! Which rows share which bodies, in what order they are eliminated, and where their factor lies: all that
//! does not change while the same rows are held.

use super::{HeldRows, NONE};
use crate::problem::Inertia;

/// An earlier row on a common body, with the side of that body in both rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shared {
    pub(super) place: u32,
    pub(super) own: u8,
    pub(super) theirs: u8,
}

impl HeldRows {
    /// Other bodies and rows: which two bodies (index into `inertia`; None: immovable) each row acts on.
    /// Orders the rows for small fill.
    ///
    /// # Panics
    ///
    /// If a row names a body that does not exist.
    pub fn set_structure(&mut self, inertia: &[Inertia], rows: &[[Option<u32>; 2]]) {
        self.body_count = inertia.len();
        self.find_order(inertia, rows);
        self.bodies.clear();
        self.root.clear();
        for place in 0..rows.len() {
            let sides = movable(inertia, rows[self.order.rows[place] as usize]);
            self.root.push(roots(inertia, sides));
            // The coefficients of a body on both sides add up on the first.
            self.bodies.push(if sides[0] == sides[1] { [sides[0], NONE] } else { sides });
        }
        self.list_shared();
        self.lay_out();
        self.jacobian.clear();
        self.jacobian.resize(rows.len(), [0.0; 6]);
        self.inverse_pivot.clear();
        self.inverse_pivot.resize(rows.len(), 0.0);
        self.kept.clear();
        self.kept.resize(rows.len(), 1.0);
        self.shares.clear();
        self.shares.resize(rows.len(), false);
        self.raise.clear();
        self.raise.resize(rows.len(), 0.0);
        self.is_soft = false;
        self.work.clear();
        self.work.resize(rows.len(), 0.0);
        self.motion.clear();
        self.motion.resize(self.body_count, [0.0; 3]);
    }

    fn find_order(&mut self, inertia: &[Inertia], rows: &[[Option<u32>; 2]]) {
        self.start.clear();
        self.start.push(0);
        self.column.clear();
        for &row in rows {
            self.column.extend(movable(inertia, row).into_iter().filter(|&body| body != NONE));
            self.start.push(self.column.len());
        }
        self.order.prepare_narrow(&self.start, &self.column, inertia.len());
    }

    /// Lists the earlier rows that share a body with each.
    fn list_shared(&mut self) {
        self.head.clear();
        self.head.resize(self.body_count, NONE);
        self.previous.clear();
        self.shared.clear();
        self.shared_start.clear();
        self.shared_start.push(0);
        for sides in &self.bodies {
            for (side, &body) in sides.iter().enumerate().filter(|(_, body)| **body != NONE) {
                let mut at = self.head[body as usize];
                while at != NONE {
                    self.shared.push(Shared { place: at / 2, own: side as u8, theirs: (at % 2) as u8 });
                    at = self.previous[at as usize];
                }
            }
            for (side, &body) in sides.iter().enumerate() {
                let at = self.previous.len() as u32;
                debug_assert_eq!(at % 2, side as u32);
                self.previous.push(if body == NONE { NONE } else { self.head[body as usize] });
                if body != NONE {
                    self.head[body as usize] = at;
                }
            }
            self.shared_start.push(self.shared.len());
        }
    }

    /// Finds the envelope of the factor.
    fn lay_out(&mut self) {
        self.first.clear();
        self.begin.clear();
        let mut end = 0;
        for place in 0..self.bodies.len() {
            let shared = &self.shared[self.shared_start[place]..self.shared_start[place + 1]];
            let first = shared.iter().fold(place, |first, other| first.min(other.place as usize));
            self.first.push(first);
            self.begin.push(end);
            end += place - first;
        }
        self.factor.clear();
        self.factor.resize(end, 0.0);
    }
}

/// The bodies of a row that can move, each once.
fn movable(inertia: &[Inertia], sides: [Option<u32>; 2]) -> [u32; 2] {
    sides.map(|side| match side {
        Some(body) if inertia[body as usize].inverse_mass > 0.0 => body,
        Some(body) if inertia[body as usize].inverse_moment > 0.0 => body,
        _ => NONE,
    })
}

/// Roots of the inverse masses on both sides, 0 on an immovable one.
fn roots(inertia: &[Inertia], sides: [u32; 2]) -> [f64; 6] {
    let [a, b] = sides.map(|body| {
        let rest = Inertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        let Inertia { inverse_mass, inverse_moment } =
            if body == NONE { rest } else { inertia[body as usize] };
        [inverse_mass.sqrt(), inverse_mass.sqrt(), inverse_moment.sqrt()]
    });
    [a[0], a[1], a[2], b[0], b[1], b[2]]
}
