//! Impacts: closing rows in, impulses along their normals out.
//!
//! With the Delassus matrix A = J M^-1 J^T (n, n) [1/kg] the rates b [m/s] of the rows become A j + b by impulses j >= 0
//! [N s]. An impact law says which impulses: each row that closes faster than its `velocity_tol` is to open again at its
//! elasticity times that speed, a slower one is to stop.
//!
//! Energy never grows: the impulses of one solve lose (1 - e^2) of the energy in the closing motion at least, and rows
//! solved one after another repeat that.

mod law;
mod pair_problem;
mod serial;
mod shuffle;

pub use law::{ImpactError, ImpactLaw, ImpactOrder};

use crate::row::CollisionRow;

/// An impact: rows with their rates and the impulses applied so far.
#[derive(Clone, Debug, Default)]
pub struct Impact {
    rows: Vec<CollisionRow>,
    /// Rate of each row [m/s] after the impulses so far.
    rates: Vec<f64>,
    /// Impulse of each row [N s] so far.
    impulses: Vec<f64>,
    /// The Delassus matrix, row by row [1/kg].
    delassus: Vec<f64>,
    /// How many complementarity problems were solved.
    solves: u64,
    scratch: Scratch,
}

/// Buffers of the laws, kept from one impact to the next.
#[derive(Clone, Debug, Default)]
struct Scratch {
    /// The rows that are solved together.
    set: Vec<usize>,
    /// Rates [m/s] that rows are to reach.
    targets: Vec<f64>,
    /// Rates [m/s] and impulses [N s] to go back to.
    rates: Vec<f64>,
    impulses: Vec<f64>,
}

impl Impact {
    /// An impact without rows, whose buffers can be used again and again.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Starts over with other rows, in their order.
    pub fn set_rows(&mut self, rows: impl IntoIterator<Item = CollisionRow>) {
        self.rows.clear();
        self.rows.extend(rows);
        self.rates.clear();
        self.rates.extend(self.rows.iter().map(|row| row.rate));
        self.impulses.clear();
        self.impulses.resize(self.rows.len(), 0.0);
        self.delassus.clear();
        for row in &self.rows {
            self.delassus.extend(self.rows.iter().map(|other| row.coupling(other)));
        }
        self.solves = 0;
    }

    /// The rows.
    #[must_use]
    pub fn rows(&self) -> &[CollisionRow] {
        &self.rows
    }

    /// Rate of each row after the impulses [m/s].
    #[must_use]
    pub fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// Impulse of each row [N s], at least 0 for a row that is not bilateral.
    #[must_use]
    pub fn impulses(&self) -> &[f64] {
        &self.impulses
    }

    /// How many complementarity problems were solved.
    #[must_use]
    pub fn solves(&self) -> u64 {
        self.solves
    }

    /// How many rows carry an impulse.
    #[must_use]
    pub fn active_rows(&self) -> usize {
        self.impulses.iter().filter(|&&impulse| impulse != 0.0).count()
    }

    fn coupling(&self, row: usize, other: usize) -> f64 {
        self.delassus[row * self.rows.len() + other]
    }

    /// Adds an impulse along one row and brings all rates up to date.
    fn apply(&mut self, row: usize, impulse: f64) {
        self.impulses[row] += impulse;
        for other in 0..self.rows.len() {
            let change = self.coupling(other, row) * impulse;
            self.rates[other] += change;
        }
    }

    /// The rate that a row is to have after its impact [m/s]: its elasticity acts only above its `velocity_tol`.
    fn rebound(&self, row: usize) -> f64 {
        let closing = -self.rates[row];
        let fast = closing > self.rows[row].velocity_tol;
        if fast && !self.rows[row].bilateral { self.rows[row].elasticity * closing } else { 0.0 }
    }
}
