//! Guards against sequences of events or steps that would never end: `bounces` too low to count, `hops` of contacts
//! that open and close again without an impact, `repeats` of an event at one time, `storms` of impacts, the `pace`
//! of steps too short to reach the end of the run, and `turns` too fast to follow. `memory` holds the past events that
//! they decide by.

pub(super) mod memory;
pub(super) mod pace;
pub(super) mod repeats;
pub(super) mod steps;
pub(super) mod storms;
pub(super) mod turns;
