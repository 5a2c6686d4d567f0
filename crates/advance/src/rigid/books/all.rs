//! All books of a system.

use crate::rigid::books::counts::Counts;
use crate::rigid::books::ledger::Ledger;
use crate::rigid::books::report::Told;

/// Counts, ledger and report of a system.
#[derive(Clone, Debug)]
pub(crate) struct Books {
    pub(crate) counts: Counts,
    pub(crate) ledger: Ledger,
    pub(crate) told: Told,
}
