//! The books: counts, energy by cause, and what callers are told of the last event.
//!
//! **Invariant**: every joule that an event or a projection adds or takes is booked once, under its cause. The books decide
//! nothing.
//!
//! `all`: the books of a system · `counts`, `ledger`, `report`: their parts · `works`: the ledger within present segments ·
//! `forces`: those of active rows · `driven`: states
//! on the rows of drives · `heat`: that of each contact · `impacts`, `energy`: what is booked when.

pub(super) mod all;
pub(super) mod counts;
pub(super) mod driven;
pub(super) mod energy;
pub(super) mod forces;
mod heat;
pub(super) mod impacts;
pub(super) mod ledger;
pub(super) mod report;
pub(super) mod works;
