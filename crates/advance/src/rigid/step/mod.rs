//! Steps of the bodies that move together: a `group` and the `rows` it holds (contacts, connectors), from its
//! equations of motion to its end on the rows. What ends a step early is in `ending`, what begins a group in
//! `event`.
//!
//! * equations of motion: `dynamics`; `tree` where bodies hang together by pins, in angles; `on_rows` where
//!   stages lie if rows depend on each other; `singular` where `loops` could go on in two ways;
//! * one step: `attempt`, its dense output and its repetition, `segment`; the errors it may make, `measures`; by which
//!   method, `brief` and `stiff`; how long it may be where contacts are `watched` or splines have `kinks`; its end moved onto the rows, `projection`; what it may not lose, `energy`;
//! * in time: `extending` adds a step to a group, `deferred` puts that off until somebody looks, `placing`
//!   says where the bodies are along it.

pub(super) mod attempt;
pub(super) mod brief;
pub(super) mod deferred;
pub(super) mod dynamics;
pub(super) mod energy;
pub(super) mod extending;
pub(super) mod group;
pub(super) mod kinks;
pub(super) mod loops;
pub(super) mod measures;
pub(super) mod on_rows;
pub(super) mod placing;
pub(super) mod projection;
pub(super) mod rows;
pub(super) mod segment;
pub(super) mod singular;
pub(super) mod stiff;
pub(super) mod tree;
pub(super) mod watched;
