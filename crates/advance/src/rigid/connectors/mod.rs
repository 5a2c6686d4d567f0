//! Connectors: their states between events, and how their rows are measured.
//!
//! **Invariant**: a hint leads to the piece of the rail on which the point is; a stop is followed exactly while a group
//! watches it; a point is in a corner only while both sides of the corner hold it. The room knows no contact and no group.
//!
//! `store`: all connectors with their states · `measuring`: their rows · `rails`: where on its rail a point is · `ends`: how far to the ends of its
//! piece · `corners`: points that come to a corner, rest in it, and leave it.

pub(super) mod corners;
pub(super) mod ends;
mod measuring;
pub(super) mod rails;
pub(super) mod store;
