//! The books: counts, energy by cause, and what callers are told of the last event.

pub(super) mod all;
pub(super) mod counts;
pub(super) mod energy;
pub(super) mod forces;
pub(super) mod impacts;
pub(super) mod ledger;
pub(super) mod report;
pub(super) mod works;
