//! The region of an event: the bodies that touch each other around some seeds, and the records of all places.
//!
//! **Invariant**: on return of `collecting` every body that shares a group, a connector row or a contact with a body of the
//! region is in it, and each place where they touch has one record. The room reads all rooms below it and changes none.
//!
//! `touching`: the region · `cause`: of the event · `collecting`: gathers it · `wide`: for a step · `records`: measures it anew · `view`: what it
//! reads.

pub(super) mod cause;
pub(super) mod collecting;
pub(super) mod records;
pub(super) mod touching;
pub(super) mod view;
pub(super) mod wide;
