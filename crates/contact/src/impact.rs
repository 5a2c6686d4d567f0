//! Impacts: closing rows in, impulses along their normals out.
//!
//! With the Delassus matrix A = J M^-1 J^T (n, n) [1/kg] the rates b [m/s] of the rows become A j + b by
//! impulses j >= 0 [N s]. An impact law says which impulses: each row that closes faster than its
//! `velocity_tol`, when it is solved or when the impact began, is to open again at its elasticity times that
//! speed, a slower one is to stop. Bilateral rows (connectors) have impulses of either sign and end at rest.
//!
//! Energy never grows. Impulses j that take the rates from b to b' change it by sum j (b + b')/2: a row that
//! closes at b < 0 and ends at b' = -e b adds j (1 - e) b/2 <= 0, a row held at rest nothing. So a problem
//! may hold rows that close or rest, but not rows that open; only without elasticity, b' = 0 throughout, may
//! it hold any (then it is the projection onto the admissible motions, in the measure of energy).
//!
//! | module | what |
//! |---|---|
//! | `law` | which rows are solved when; errors |
//! | `together`, `serial` | all rows in one problem, or one after another |
//! | `patience` | when ricochets end |
//! | `pair_problem`, `few_rows`, `many_rows` | one or two rows in closed form, some more directly; else by the active-set method |
//! | `couplings` | the Delassus matrix |
//! | `shuffle` | random orders |

mod couplings;
mod few_rows;
mod law;
mod many_rows;
mod pair_problem;
mod patience;
mod serial;
mod shuffle;
mod together;

pub use law::{ImpactError, ImpactLaw, ImpactOrder};

use crate::row::CollisionRow;
use couplings::Couplings;
use many_rows::ManyRows;

/// Part of the largest change of a rate so far that is rounding.
const NOISE: f64 = 64.0 * f64::EPSILON;

/// An impact: rows with their rates and the impulses applied so far.
#[derive(Clone, Debug, Default)]
pub struct Impact {
    rows: Vec<CollisionRow>,
    has_connectors: bool,
    /// Rate of each row [m/s] after the impulses so far.
    rates: Vec<f64>,
    /// Impulse of each row [N s] so far.
    impulses: Vec<f64>,
    couplings: Couplings,
    /// Rate [m/s] that is rounding of the impulses so far, or what rows that contradict each other by rounding leave.
    noise: f64,
    /// The largest change [m/s] of a rate by one impulse so far.
    largest_change: f64,
    /// The fastest rate [m/s] that was to be changed.
    fastest: f64,
    bound: f64,
    /// What is left has resisted small impulses.
    at_last: bool,
    /// What takes many pivots is given up, at last as well as before.
    is_trial: bool,
    /// How many complementarity problems were solved.
    solves: u64,
    scratch: Scratch,
}

/// Buffers of the laws, kept from one impact to the next.
#[derive(Clone, Debug, Default)]
struct Scratch {
    /// The rows that are solved together, and a flag for each.
    set: Vec<usize>,
    listed: Vec<bool>,
    /// Rates [m/s] that rows are to reach.
    targets: Vec<f64>,
    /// Rates [m/s] and impulses [N s] to go back to.
    rates: Vec<f64>,
    impulses: Vec<f64>,
    /// What rows were unloaded by [N s], until they are solved.
    carried: Vec<f64>,
    /// Made when first needed, for most impacts have one row or two.
    many: Option<Box<ManyRows>>,
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
        self.has_connectors = self.rows.iter().any(|row| row.bilateral);
        self.rates.clear();
        self.rates.extend(self.rows.iter().map(|row| row.rate));
        self.impulses.clear();
        self.impulses.resize(self.rows.len(), 0.0);
        self.couplings.set_rows(&self.rows);
        self.noise = 0.0;
        self.largest_change = 0.0;
        self.fastest = 0.0;
        self.bound = 0.0;
        self.at_last = false;
        self.solves = 0;
        self.scratch.carried.clear();
    }

    /// Takes from each row an impulse [N s] that it carries anyway, as the force of a contact does over some
    /// time. What is resolved afterwards brings back as much of it as is needed: in all, a row that is not
    /// bilateral may then have an impulse down to minus that.
    ///
    /// # Panics
    /// If there is not one impulse per row.
    pub fn unload(&mut self, impulses: &[f64]) {
        assert_eq!(impulses.len(), self.rows.len(), "one impulse per row");
        self.scratch.carried.resize(self.rows.len(), 0.0);
        for (row, &impulse) in impulses.iter().enumerate().filter(|(_, impulse)| **impulse != 0.0) {
            self.apply(row, -impulse);
            self.scratch.carried[row] += impulse;
        }
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

    /// Impulse of each row [N s], at least 0 for a row that is not bilateral, but for what it was
    /// [unloaded](Self::unload) by. Redundant rows leave a choice; the rates do not depend on it.
    #[must_use]
    pub fn impulses(&self) -> &[f64] {
        &self.impulses
    }

    /// Greatest closing speed, or rate of a bilateral row [m/s], that the impact may have left: 1e-12 of its
    /// fastest rate, or the rounding of its impulses; where rows are so nearly dependent that rounding makes
    /// them contradict each other, what that leaves, at most 1e-5 of that rate.
    #[must_use]
    pub fn bound(&self) -> f64 {
        self.bound
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

    /// Adds an impulse along one row and brings all rates up to date.
    fn apply(&mut self, row: usize, impulse: f64) {
        self.impulses[row] += impulse;
        let mut largest = self.largest_change;
        for (other, coupling) in self.couplings.row(row) {
            let change = coupling * impulse;
            largest = largest.max(change.abs());
            self.rates[other] += change;
        }
        self.largest_change = largest;
        self.noise = self.noise.max(NOISE * largest);
    }

    /// By how much a row's rate is wrong [m/s]: its closing speed, or a bilateral row's rate without sign.
    fn violation(&self, row: usize) -> f64 {
        // Most impacts have no connectors; then a scan of all rows reads their rates alone.
        let is_bilateral = self.has_connectors && self.rows[row].bilateral;
        if is_bilateral { self.rates[row].abs() } else { -self.rates[row] }
    }

    /// Whether that is more than `small`, and more than rounding.
    fn is_violated(&self, row: usize, small: f64) -> bool {
        self.violation(row) > self.rest(small)
    }

    fn is_any_violated(&self, small: f64) -> bool {
        (0..self.rows.len()).any(|row| self.is_violated(row, small))
    }

    /// Rate [m/s] up to which a row counts as at rest.
    fn rest(&self, small: f64) -> f64 {
        small.max(self.noise)
    }

    /// Whether an impulse along a row changes anything.
    fn can_move(&self, row: usize) -> bool {
        self.couplings.diagonal(row) > 0.0
    }
}
