//! What ends a step early. `watch` looks along a step that was made: a force that falls to zero, a contact that runs
//! off its features; `switches` are stops that close and force laws that change branch. `crossing` finds where a
//! polynomial crosses zero, `overdue` what should have ended before, `staying` which contacts surely do not end.

pub(super) mod crossing;
mod earliest;
pub(super) mod overdue;
pub(super) mod staying;
pub(super) mod switches;
pub(super) mod watch;
