//! Exact, fast 2D rigid-body mechanics with true circular arcs.

mod builder;
mod event;
mod overlap;
mod run_error;
mod scales;
mod start;
mod world;

pub use builder::{BodySpec, DEFAULT_TOLERANCE, WorldBuilder, WorldError, WorldSettings};
pub use event::{Impact, ImpactRow};
pub use halfgap_collision::{BodyId, BodyState, Tolerances};
pub use halfgap_contact::{ImpactLaw, ImpactOrder};
pub use halfgap_geometry as geometry;
pub use run_error::{RunError, StopKind};
pub use scales::ToleranceOverrides;
pub use world::{Energy, Inertia, Statistics, World};
