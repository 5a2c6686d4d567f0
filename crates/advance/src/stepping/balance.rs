//! The balance of a solution: what impulses give to bodies, and whether it is more than they may.

/// Work [J] of the impulses of some rows, seen from what drives them, and the sum of its parts without their signs; and what drives them gives.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Balance {
    work: f64,
    size: f64,
    given: f64,
}

/// Share of the energy before by which a solution may add to it [-]: the scheme is of second order, and smooth motions go to and fro about
/// their energy. Rows that nothing can do together, such as that a body be to both sides of a wall, have solutions that are as large as
/// they are nearly parallel.
const EXPLOSION: f64 = 1e-2;
/// Share of the parts of a work that is rounding [-].
const ROUNDING: f64 = 1e-12;

impl Balance {
    /// Adds a part of the work [J].
    pub(super) fn add(&mut self, done: f64) {
        self.work += done;
        self.size += done.abs();
    }

    /// Adds what drives give [J]: bodies may have been slow before.
    pub(super) fn give(&mut self, work: f64) {
        self.given += work.abs();
    }

    /// True if that is more than a solution may give to bodies that had an energy [J] before.
    pub(super) fn explodes(&self, energy: f64) -> bool {
        self.work > EXPLOSION * (energy + self.given) + ROUNDING * self.size
    }
}
