//! Rigid bodies: free flight in closed form, groups of coupled bodies by an integrator, contacts predicted pair by pair,
//! events located at their time.
//!
//! What moves: `parts` is what a system is made of, `flyer` is one body with its segment, `path` its motion along it, `lane` what predictions read of it; `law` is what a force law is, `rows` are
//! the contacts and connectors that are held, `group` the bodies that share their steps, `dynamics` their equations of
//! motion, `tree` the same where they hang together by pins, `on_rows` where its stages lie, `segment` one step of them, `projection` moves its end onto the rows, `energy` what it may not lose, `brief` and `stiff` which method makes it, `kinks` of
//! splines end it, `extending` adds it to the group, `deferred` puts it off until somebody looks, `watch` (with `crossing`) finds what ends it early.
//!
//! What happens: `boxes` is a body's room in the broad phase, `pairs` and `predictions` say when which pair comes into
//! contact (`marks` tells who is near), `connectors` when a rope goes taut and where on its rail a point is; `events` handles what comes true: `region`
//! collects the bodies that touch, `cutting` takes them to the event's time, `groups` merges and splits groups, `impacts` applies impulses, `settle` finds what is held,
//! `rules` tells the search what to leave alone, `bounces` and `hops` tell those that are too low to count, `repeats` what fires again at one time, `storms` ends what does not end by itself, `ticks` stands in for forces where contacts carry impulses only. `intervention` is what somebody outside does to
//! bodies; `ledger` keeps the energy's books, `scales` says what a tolerance means in a scene, `report` is what the outside may ask for, and `system` ties all to the event loop.

mod bounces;
mod boxes;
mod brief;
mod by_body;
mod connectors;
mod crossing;
mod cutting;
mod deferred;
mod dynamics;
mod energy;
mod error;
mod events;
mod extending;
mod flush;
mod flyer;
mod graze;
mod group;
mod groups;
mod hops;
mod horizon;
mod impacts;
mod intervention;
mod jams;
mod kinks;
mod lane;
mod law;
mod leaving;
mod ledger;
mod levers;
mod marks;
mod on_rows;
mod overdue;
mod pace;
mod pairs;
mod parts;
mod path;
mod placing;
mod predictions;
mod projection;
mod region;
mod repeats;
mod report;
mod rows;
mod rules;
mod scales;
mod segment;
mod settle;
mod settling;
mod singular;
mod staying;
mod stiff;
mod storms;
mod switches;
mod system;
#[cfg(test)]
mod test_scene;
mod ticks;
mod tree;
mod watch;

pub use dynamics::ExtraAcceleration;
pub use error::{AdvanceError, Between};
pub use flyer::{FlightLaw, Flyer};
pub use halfgap_collision as collision;
pub use halfgap_contact as contact;
pub use halfgap_geometry as geometry;
pub use impacts::{ImpactReport, RowReport};
pub use intervention::VelocityChange;
pub use law::{ForceLaw, Snapshot, Wrench, Wrenches};
pub use ledger::Ledger;
pub use parts::{PartsError, RigidParts};
pub use report::{ContactChanges, RowForce};
pub use scales::Scales;
pub use segment::StepControl;
pub use system::{Counts, Handled, RigidSettings, RigidSystem};
