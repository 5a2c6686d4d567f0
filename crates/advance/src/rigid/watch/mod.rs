//! Events that end a step early. `watch` searches a step that was made for a contact that runs off its features or
//! sinks, `releases` for a force that falls to zero, `switches` for stops that close and force laws that change branch.
//! `crossing` finds where a sampled function falls below zero, `overdue` the events that should have come before,
//! `staying` the contacts that surely do not end; `earliest` keeps the first event found.

pub(super) mod crossing;
pub(super) mod earliest;
pub(super) mod early_ends;
pub(super) mod extending;
pub(super) mod overdue;
pub(super) mod releases;
pub(super) mod staying;
pub(super) mod switches;
