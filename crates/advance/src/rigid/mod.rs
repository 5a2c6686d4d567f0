//! Rigid bodies: free flight in closed form, groups of coupled bodies by an integrator, contacts predicted pair by
//! pair, events located at their time.
//!
//! Each folder is a room, and so are the files `ticks` and `system`. A room may use those above it in this table, and none below; what it guarantees is stated in its
//! `mod.rs`.
//!
//! | room | question it answers |
//! |---|---|
//! | `bodies` | where is a body, how does it move, what acts on it? |
//! | `connectors` | where is the point of a rail, is a rope taut, what is the row of a connector? |
//! | `contacts` | which pairs are near each other, what touched lately, what is the row of a contact? |
//! | `sinking` | how far may a contact sink that carries impulses only? |
//! | `search` | when does each pair meet next? |
//! | `group` | how do bodies move that share their steps? |
//! | `watch` | which event ends a step early? |
//! | `books` | where did energy go, what are callers told? |
//! | `zeno` | is this one event or step too many? |
//! | `region` | what touches around an event? |
//! | `impact` | which impulses? |
//! | `active_set` | which rows are active afterwards? |
//! | `stepping` | how does a region go on whose events accumulate? |
//! | `event` | what is done, in which order? |
//! | `ticks` | what is done where contacts carry impulses only? |
//! | `due` | which event is it? |
//!
//! `system` is what callers see of all this. `parts` lists the parts of a system, `settings` how it is run, `scales` turns a
//! tolerance into thresholds for a scene, `shares` has the orders of magnitude that decisions use, `remedies` what is done in
//! rare cases, `agenda` is the queue of events by their sources, `forest` disjoint sets, `saved_system` a system between bytes and force laws, `error` the reasons why an advance
//! stops.

mod active_set;
mod agenda;
mod bodies;
mod books;
mod connectors;
mod contacts;
mod due;
mod error;
mod event;
mod forest;
mod group;
mod impact;
mod parts;
mod region;
mod remedies;
#[cfg(feature = "save")]
mod saved_system;
mod scales;
mod search;
mod settings;
mod shares;
mod sinking;
mod stepping;
mod surface;
mod surfaces;
mod system;
#[cfg(test)]
mod test_scene;
mod ticks;
mod watch;
mod zeno;

pub use bodies::force_law::{ForceLaw, Snapshot, Wrench, Wrenches};
pub(crate) use bodies::force_laws::ForceLaws;
pub use bodies::squeezed::LARGEST_MASS_RATIO;
pub use bodies::trajectory::{FreeMotion, Trajectory};
pub use books::counts::Counts;
pub use books::ledger::Ledger;
pub use books::report::{ContactChanges, Handled, ImpactReport, RowForce, RowReport};
pub use error::{AdvanceError, Between};
pub use event::intervention::VelocityChange;
pub(crate) use event::intervention::check_finite;
pub(crate) use forest::Forest;
pub use halfgap_collision as collision;
pub use halfgap_contact as contact;
pub use halfgap_geometry as geometry;
pub use parts::{BodyPart, PartsError, RigidParts};
pub(crate) use parts::{POSITIVE, check_bodies_of_force_law, keep_to};
pub use remedies::{Remedy, RemedyCounts, RemedySet};
#[cfg(feature = "save")]
pub use saved_system::SavedSystem;
pub use scales::Scales;
pub use settings::{ExtraAcceleration, RegionSteps, RigidSettings, StepControl};
pub use surface::{PairSurface, RowFriction, RowRolling, Surface};
pub use surfaces::PairRule;
pub(crate) use surfaces::PairRules;
pub use system::RigidSystem;
