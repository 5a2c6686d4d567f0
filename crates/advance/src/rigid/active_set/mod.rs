//! The active set: which rows are active after an event.
//!
//! **Invariant**: the rows chosen carry a force that pushes, in a solution in which no candidate accelerates into another.
//! The room chooses; it moves nothing.
//!
//! `settle`: the order in which the problem of the candidates is solved · `posing`: that problem · `relaxing`: forces shared anew · `settling`: solvers and buffers ·
//! `choosing`: which candidates become active, and at which gap · `hops`: contacts that open and close again at once · `jammed`:
//! forces of rows that work against each other · `leverless`, `levers`: contacts that act by next to no lever · `dependent`,
//! `redundant`: candidates that depend on others · `leaving`: contacts that end at once · `slips`: who slips and who
//! sticks · `pulls`: which motors and joints with dry friction hold · `holding`: the rows that
//! hold beside them · `responses`: what forces do to bodies · `jump`: what follows where slips have no forces · `painleve`: what there is to tell of that.

pub(super) mod choosing;
pub(super) mod dependent;
pub(super) mod exclusion;
mod holding;
pub(super) mod hops;
pub(super) mod jammed;
pub(super) mod jump;
pub(super) mod leaving;
pub(super) mod leverless;
pub(super) mod levers;
pub(super) mod painleve;
pub(super) mod posing;
pub(super) mod pulling;
mod pulls;
pub(super) mod redundant;
pub(super) mod relaxing;
mod responses;
pub(super) mod settle;
pub(super) mod settling;
pub(super) mod slips;
