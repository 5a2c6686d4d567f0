//! Rigid bodies: free flight in closed form, groups of coupled bodies by an integrator, contacts predicted
//! pair by pair, events located at their time.
//!
//! | room | what lives there |
//! |---|---|
//! | `motion` | one body: its state, its path along a segment; what a force law is |
//! | `step` | groups of bodies that are held together: equations of motion, steps, projection |
//! | `ending` | what ends a step early: release, feature change, stops |
//! | `search` | which pairs come into contact next: boxes, pairs, predictions, rules |
//! | `event` | what happens then: regions, impacts, groups merged and split, ropes, ticks |
//! | `held` | which contacts and connectors are held from then on |
//! | `limits` | what counts for nothing or would go on for ever: bounces, hops, storms, pace |
//!
//! `system` ties all to the event loop. `parts` is what a system is made of, `scales` what a tolerance means
//! in a scene, `intervention` what somebody outside does to bodies, `laws` the force laws, `by_body` and `forest` lists
//! and sets of bodies, `ledger` the energy's books,
//! `report` what the outside may ask for.

mod by_body;
mod ending;
mod error;
mod event;
mod forest;
mod held;
mod intervention;
mod laws;
mod ledger;
mod limits;
mod motion;
mod parts;
mod report;
mod scales;
mod search;
mod sources;
mod step;
mod system;
#[cfg(test)]
mod test_scene;

pub use error::{AdvanceError, Between};
pub use event::impacts::{ImpactReport, RowReport};
pub use halfgap_collision as collision;
pub use halfgap_contact as contact;
pub use halfgap_geometry as geometry;
pub use intervention::VelocityChange;
pub use ledger::Ledger;
pub use motion::flyer::{FlightLaw, Flyer};
pub use motion::law::{ForceLaw, Snapshot, Wrench, Wrenches};
pub use parts::{PartsError, RigidParts};
pub use report::{ContactChanges, RowForce};
pub use scales::Scales;
pub use step::dynamics::ExtraAcceleration;
pub use step::segment::StepControl;
pub use system::{Counts, Handled, RigidSettings, RigidSystem};
