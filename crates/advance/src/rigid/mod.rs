//! Rigid bodies: free flight in closed form, groups of coupled bodies by an integrator, contacts predicted pair by
//! pair, events located at their time.
//!
//! | room | contents |
//! |---|---|
//! | `motion` | one body: its state, its path along a segment; the trait of force laws |
//! | `step` | groups of bodies that share steps: equations of motion, steps, projection |
//! | `ending` | events that end a step early: release, feature change, stops |
//! | `search` | prediction of the next contact of each pair: boxes, pairs, predictions, rules |
//! | `event` | handling of an event: regions, impacts, groups merged and split, ropes, ticks |
//! | `held` | choice of the contacts and connectors that are held after an event |
//! | `limits` | motions too small to resolve and event sequences without end: bounces, hops, storms, pace |
//!
//! `system` ties all rooms to the event loop. `parts` lists the parts of a system, `scales` turns a tolerance into
//! thresholds for a scene, `intervention` is a change of velocities by the caller, `laws` the force laws, `by_body` and
//! `forest` lists and sets of bodies, `sources` the numbering of events in the queue, `ledger` the energy balance,
//! `report` the forces and contact changes that callers may ask for, `error` the reasons why an advance stops.

mod agenda;
mod bodies;
mod books;
mod connectors;
mod contacts;
mod error;
mod event;
mod forest;
mod group;
mod held;
mod impact;
mod parts;
mod region;
mod scales;
mod search;
mod settings;
mod sinking;
mod system;
#[cfg(test)]
mod test_scene;
mod watch;
mod zeno;

pub use bodies::flyer::{FlightLaw, Flyer};
pub use bodies::law::{ForceLaw, Snapshot, Wrench, Wrenches};
pub use bodies::squeezed::LARGEST_MASS_RATIO;
pub use books::counts::Counts;
pub use books::ledger::Ledger;
pub use books::report::{ContactChanges, Handled, ImpactReport, RowForce, RowReport};
pub use error::{AdvanceError, Between};
pub use event::intervention::VelocityChange;
pub use halfgap_collision as collision;
pub use halfgap_contact as contact;
pub use halfgap_geometry as geometry;
pub use parts::{BodyPart, PartsError, RigidParts};
pub use scales::Scales;
pub use settings::{ExtraAcceleration, RigidSettings, StepControl};
pub use system::RigidSystem;
