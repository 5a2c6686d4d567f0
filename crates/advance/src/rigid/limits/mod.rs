//! What would go on for ever, or counts for nothing: `bounces` that are too low, `hops` of what closes
//! without an impact, `repeats` of an event at one time, `storms` of impacts, and the `pace` of steps that
//! never come to an end. `memory` is what they keep of the past.

pub(super) mod bounces;
pub(super) mod hops;
pub(super) mod memory;
pub(super) mod pace;
pub(super) mod repeats;
pub(super) mod storms;
