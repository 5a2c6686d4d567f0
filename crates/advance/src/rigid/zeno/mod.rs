//! Sequences of events or steps that would never end, and the memory by which they are recognised.
//!
//! **Invariant**: what is counted here never changes a motion by itself: an event is told that it is one too many, a caller
//! that a run is hopeless.
//!
//! `memory`: past events of each body · `repeats`: events of a pair at one time · `accumulation`: more events than forces can
//! resolve · `budget`: what bodies may take part in before they go on by steps · `stepped`: the regions that do · `pace`, `steps`: steps too short to reach the end of the run · `turns`: bodies that turn too fast to be
//! followed.

pub(super) mod accumulation;
pub(super) mod budget;
pub(super) mod memory;
pub(super) mod pace;
pub(super) mod repeats;
pub(super) mod stepped;
pub(super) mod steps;
pub(super) mod turns;
