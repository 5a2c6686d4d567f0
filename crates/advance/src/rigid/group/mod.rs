//! Groups: bodies that share their steps, from the equations of motion to the end of a step on the active rows.
//!
//! **Invariant**: between steps the state of a group lies on its active rows, and rates and forces are those of that state;
//! dense output keeps to the rows within what the watch allows. The room knows no event and no search.
//!
//! * data: `state` (a group), `reading`, `making` (its members), `gripping` (what friction adds), `turning` (from one segment to the next), `groups` (all of
//!   them), `stage` (buffers of one moment), `lending`, `samples`;
//! * equations of motion: `physics`, `dynamics` in bodies, `friction`, `stress` of what is locked, what is `held`, `level`, `tree` in angles where bodies hang together by pins;
//!   `on_rows` moves stages onto rows that depend on each other; `singular` leads steps over the bifurcation points of
//!   closed `loops`;
//! * one step: `attempt`; its repetition and dense output, `segment`; the errors it may make, `measures` and `inner`; its
//!   method, `stepping`, `brief`, `stiff` and `stiffness`; its length where contacts are `watched` or splines have `kinks`;
//!   its end moved onto the rows, `projection`; the energy it must keep, `energy`;
//! * in time: `extending` adds a step to a group, with its `tools`; `placing` evaluates where the bodies are along it.

pub(super) mod attempt;
pub(super) mod brief;
mod drives;
pub(super) mod dynamics;
pub(super) mod energy;
pub(super) mod extending;
pub(super) mod friction;
pub(super) mod gripping;
pub(super) mod groups;
mod held;
pub(super) mod inner;
pub(super) mod kinks;
pub(super) mod lending;
pub(super) mod level;
pub(super) mod loops;
pub(super) mod making;
pub(super) mod measures;
pub(super) mod on_rows;
pub(super) mod physics;
pub(super) mod placing;
pub(super) mod projection;
pub(super) mod pulleys;
mod reading;
pub(super) mod samples;
pub(super) mod segment;
pub(super) mod singular;
pub(super) mod stage;
pub(super) mod state;
pub(super) mod stepping;
pub(super) mod stiff;
pub(super) mod stiffness;
mod stress;
pub(super) mod tools;
pub(super) mod tree;
pub(super) mod turning;
pub(super) mod watched;
