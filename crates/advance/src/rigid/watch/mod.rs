//! Events that end a step early: functions along a segment whose first fall below zero is an event.
//!
//! **Invariant**: on return the group's event is the first along its segment, or no force can vanish before its look. The
//! room changes a group's segment only by asking for a shorter step; it handles no event.
//!
//! `extending`: a step with its event · `early_ends`: contacts that run off their features or sink · `releases`: forces that
//! fall to zero · `slips`: slips that stop · `switches`: stops that close, laws that change branch · `margins`: how much force rows may lose · `overdue`: events that should have come before ·
//! `staying`: contacts that surely do not end · `crossing`: where a sampled function falls below zero · `earliest`.

pub(super) mod crossing;
pub(super) mod earliest;
pub(super) mod early_ends;
pub(super) mod extending;
pub(super) mod margins;
pub(super) mod overdue;
pub(super) mod releases;
pub(super) mod slips;
pub(super) mod staying;
pub(super) mod switches;
