//! What happens at an event. `events` is the order of it: `region` collects the bodies that touch, `cutting`
//! takes them to the event's time, `impacts` applies impulses (`jams`: impulses that cancel each other, of
//! contacts that need not be), `groups` merges and splits groups of bodies (`members`: what belongs to which).
//! `connectors` says when a rope goes taut, `rails` where on its rail a point is, `corners` what it does at a corner;
//! `ticks` stands in for forces where contacts carry impulses only. What is held afterwards is found in `held`.

pub(super) mod cause;
pub(super) mod connectors;
pub(super) mod corners;
pub(super) mod cutting;
pub(super) mod events;
pub(super) mod groups;
pub(super) mod impacts;
pub(super) mod jams;
pub(super) mod members;
pub(super) mod rails;
pub(super) mod region;
pub(super) mod ticks;
