//! Impacts: closing rows in, impulses along their normals out.
//!
//! With the Delassus matrix A = J M^-1 J^T (n, n) [1/kg], impulses j >= 0 [N s] change the rates b [m/s] of the rows to
//! A j + b. An impact law selects the impulses. A row that closes faster than its `velocity_tol`, when it is solved or
//! when the impact began, is to open again at its elasticity times that speed; a slower row is to stop. Bilateral rows
//! (connectors) have impulses of either sign and end at rest.
//!
//! Energy never grows. Impulses j that take the rates from b to b' change it by sum j (b + b')/2: a row that closes at
//! b < 0 and ends at b' = -e b adds j (1 - e) b/2 <= 0, a row held at rest nothing. So a problem may hold rows that
//! close or rest, but not rows that open. Only without elasticity, with b' = 0 for all rows, may it hold any row: it is
//! then the projection onto the admissible motions in the energy norm.
//!
//! | module | contents |
//! |---|---|
//! | `law` | the laws, the order of rows, errors |
//! | `together`, `serial` | all rows in one problem, or one after another |
//! | `patience`, `blows` | the end of ricochets, and the number of blows that are none |
//! | `pair_problem`, `few_rows`, `many_rows` | up to two rows in closed form, up to eight directly, more by the active-set method |
//! | `locked` | rows at rest that no motion can open |
//! | `rough` | impacts with friction |
//! | `near_rows` | rows that nearly depend on each other |
//! | `couplings` | the Delassus matrix |
//! | `shuffle` | random orders |

mod blows;
mod couplings;
mod few_rows;
mod law;
mod locked;
mod many_rows;
mod near_rows;
mod pair_problem;
mod patience;
mod rough;
mod serial;
mod shuffle;
mod together;

pub use law::{ImpactError, ImpactLaw, ImpactOrder};
pub use rough::{FrictionRow, Restitution};

use crate::row::CollisionRow;
use couplings::Couplings;
use locked::Locked;
use many_rows::ManyRows;
use near_rows::NearRows;
use rough::Rough;

/// Rounding of rates, as a fraction of the largest change of a rate by one impulse so far.
const NOISE: f64 = 64.0 * f64::EPSILON;

/// An impact: its rows with their rates and impulses. [`ImpactLaw::resolve`] finds the impulses.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Impact {
    rows: Vec<CollisionRow>,
    has_connectors: bool,
    /// Rate of each row [m/s] after the impulses so far.
    rates: Vec<f64>,
    /// Impulse of each row [N s] so far.
    impulses: Vec<f64>,
    couplings: Couplings,
    /// Rate [m/s] that may be rounding of the impulses so far, or be left by rows that contradict each other by
    /// rounding.
    noise: f64,
    /// The largest change [m/s] of a rate by one impulse so far.
    largest_change: f64,
    /// The greatest violation [m/s] at the start.
    fastest: f64,
    /// Greatest violation [m/s] that may be left.
    bound: f64,
    /// True in the last attempt, in which impulses may be as large as necessary.
    at_last: bool,
    /// True in a trial: problems that take many pivots are given up, in the last attempt too.
    is_trial: bool,
    /// Number of complementarity problems solved.
    solves: u64,
    scratch: Scratch,
    /// Tangential rows, if a row has friction; the memory is kept.
    rough: Option<Box<Rough>>,
    is_rough: bool,
    restitution: Restitution,
}

/// Buffers of the laws, kept from one impact to the next.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Scratch {
    /// The rows that are solved together, and one flag per row of the impact.
    set: Vec<usize>,
    listed: Vec<bool>,
    /// Rates [m/s] that rows are to reach.
    targets: Vec<f64>,
    /// Rates [m/s] and impulses [N s] before a round, to which a failed round goes back.
    rates: Vec<f64>,
    impulses: Vec<f64>,
    /// Rates [m/s] and impulses [N s] to go back to.
    start_rates: Vec<f64>,
    start_impulses: Vec<f64>,
    /// Number of turns that each row has had as the focus, empty before the first, and whether one has had many.
    turns: Vec<u8>,
    has_returned: bool,
    /// Impulse [N s] that each row was unloaded by, until a problem without elasticity starts from it; empty if none
    /// was.
    carried: Vec<f64>,
    locked: Locked,
    /// Made when first needed, as most impacts have one row or two.
    many: Option<Box<ManyRows>>,
    near: Option<Box<NearRows>>,
}

impl Impact {
    /// Makes an impact without rows. Its buffers are kept from impact to impact.
    #[must_use]
    #[inline]
    pub fn new() -> Self {
        Self::default()
    }

    /// Starts a new impact with the given rows, without impulses.
    pub fn set_rows(&mut self, rows: impl IntoIterator<Item = CollisionRow>) {
        self.rows.clear();
        self.rows.extend(rows);
        self.has_connectors = self.rows.iter().any(|row| row.is_bilateral());
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
        self.scratch.locked.clear();
        self.scratch.turns.clear();
        self.scratch.has_returned = false;
        self.is_rough = false;
    }

    /// Subtracts from each row an impulse [N s] that it carries anyway, such as the force of a contact times a
    /// duration, and changes the rates accordingly. Resolving the impact afterwards restores as much of it as is
    /// needed. The impulse of a unilateral row may then end as low as minus the subtracted one.
    ///
    /// # Panics
    /// If there is not one impulse per row.
    #[inline]
    pub fn unload(&mut self, impulses: &[f64]) {
        assert_eq!(impulses.len(), self.rows.len(), "one impulse per row");
        self.scratch.carried.resize(self.rows.len(), 0.0);
        for (row, &impulse) in impulses.iter().enumerate().filter(|(_, impulse)| **impulse != 0.0) {
            self.apply(row, -impulse);
            self.scratch.carried[row] += impulse;
        }
    }

    /// The rows, in the order of [`set_rows`](Self::set_rows).
    #[must_use]
    #[inline]
    pub fn rows(&self) -> &[CollisionRow] {
        &self.rows
    }

    /// Rate of each row after the impulses [m/s], negative when closing.
    #[must_use]
    #[inline]
    pub fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// Impulse of each row [N s]: of either sign for a bilateral row, else at least 0, less the impulse that the row
    /// was [unloaded](Self::unload) by. Redundant rows leave a choice of impulses, on which the rates do not depend.
    #[must_use]
    #[inline]
    pub fn impulses(&self) -> &[f64] {
        &self.impulses
    }

    /// Greatest closing speed of a unilateral, or size of the rate of a bilateral row [m/s] that the impact may have
    /// left. This is 1e-12 of the fastest rate at the start, or the rounding of the impulses. Where rows are so nearly
    /// dependent that rounding makes them contradict each other, it is what that contradiction leaves, at most 1e-5 of
    /// the fastest rate.
    #[must_use]
    #[inline]
    pub fn bound(&self) -> f64 {
        self.bound
    }

    /// Number of complementarity problems solved since [`set_rows`](Self::set_rows).
    #[must_use]
    #[inline]
    pub fn solves(&self) -> u64 {
        self.solves
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

    /// Violation of a row [m/s]: the closing speed of a unilateral row (negative when it opens), the size of the rate
    /// of a bilateral one.
    fn violation(&self, row: usize) -> f64 {
        // Most impacts have no connectors; a scan of all rows then reads only their rates.
        let is_bilateral = self.has_connectors && self.rows[row].is_bilateral();
        if is_bilateral { self.rates[row].abs() } else { -self.rates[row] }
    }

    /// Whether the violation of a row exceeds `small` [m/s] and the rounding of rates.
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

    /// Whether an impulse along a row moves a body.
    fn can_move(&self, row: usize) -> bool {
        self.couplings.diagonal(row) > 0.0
    }
}
