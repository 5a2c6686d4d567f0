//! The books: counts, energy by cause, and what callers are told of the last event.

use crate::rigid::books::counts::Counts;
use crate::rigid::books::ledger::Ledger;
use crate::rigid::books::report::Told;

pub(super) mod counts;
pub(super) mod energy;
pub(super) mod ledger;
pub(super) mod report;

/// Counts, ledger and report of a system.
#[derive(Clone, Debug)]
pub(crate) struct Books {
    pub(crate) counts: Counts,
    pub(crate) ledger: Ledger,
    pub(crate) told: Told,
}
