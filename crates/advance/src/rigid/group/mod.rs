//! Steps of a `group` of bodies that move together, and of the `rows` it holds (contacts and connectors): from the
//! equations of motion to the end of the step on the rows. Events that end a step early are in `ending`, those that
//! begin a group in `event`.
//!
//! * equations of motion: `dynamics` in bodies, `tree` in angles where bodies hang together by pins; `on_rows` moves
//!   stages onto rows that depend on each other; `singular` leads steps over the bifurcation points of closed `loops`;
//! * one step: `attempt`; its repetition and dense output, `segment`; the errors it may make, `measures`; its method,
//!   `brief` and `stiff`; its length where contacts are `watched` or splines have `kinks`; its end moved onto the rows,
//!   `projection`; the energy it must keep, `energy`;
//! * in time: `extending` adds a step to a group, `deferred` postpones its dense output until it is asked for,
//!   `placing` evaluates where the bodies are along it.

pub(super) mod attempt;
pub(super) mod brief;
pub(super) mod dynamics;
pub(super) mod energy;
pub(super) mod extending;
pub(super) mod groups;
pub(super) mod inner;
pub(super) mod kinks;
pub(super) mod lifted;
pub(super) mod loops;
pub(super) mod making;
pub(super) mod measures;
pub(super) mod on_rows;
pub(super) mod physics;
pub(super) mod placing;
pub(super) mod projection;
pub(super) mod samples;
pub(super) mod segment;
pub(super) mod singular;
pub(super) mod state;
pub(super) mod stepping;
pub(super) mod stiff;
pub(super) mod stiffness;
pub(super) mod tools;
pub(super) mod tree;
pub(super) mod turning;
pub(super) mod watched;
