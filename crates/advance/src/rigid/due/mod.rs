//! What comes due: from the source of an event to what handles it.
//!
//! **Invariant**: each event of the agenda is either handled, by `event` or `ticks`, or found to be none and looked for anew;
//! none is left on the agenda. This room decides which it is, and changes no velocity by itself.
//!
//! * `handling`: a source to its handler · `events`: the start, a contact, the end of a segment, a rope · `joints`: points of
//!   rails that come to a joint or a stop.

pub(super) mod events;
pub(super) mod handling;
pub(super) mod joints;
