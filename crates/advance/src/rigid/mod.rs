//! Rigid bodies in free flight: segments in closed form, contacts predicted pair by pair, impacts located at their time.
//!
//! `flyer` is one body with its segment, `boxes` its room to move in the broad phase, `pairs` the predictions of pairs
//! that are near each other, `impacts` what happens when one comes true, `law` what a force law is, and `system` ties them to the event loop.

mod boxes;
mod error;
mod flyer;
mod impacts;
mod law;
mod pairs;
mod system;

pub use error::{AdvanceError, Between};
pub use flyer::{FlightLaw, Flyer};
pub use impacts::{ImpactReport, RowReport};
pub use law::{ForceLaw, Snapshot, Wrench, Wrenches};
pub use system::{Counts, RigidSettings, RigidSystem};
