//! (outline)

#[cfg(feature = "scene")]
mod build;
#[cfg(feature = "scene")]
mod check;
#[cfg(feature = "scene")]
pub mod picture;
#[cfg(feature = "scene")]
mod recording;
#[cfg(feature = "scene")]
mod result;
#[cfg(feature = "scene")]
mod run;
#[cfg(feature = "scene")]
pub mod scene;
mod world;

#[cfg(feature = "scene")]
pub use check::{CheckReport, check};
#[cfg(feature = "scene")]
pub use recording::{Frame, RecordedBody, Recording};
#[cfg(feature = "scene")]
pub use result::{EnergyResult, Outcome, RunResult, StatisticsResult};
#[cfg(feature = "scene")]
pub use run::{Record, RunPlan, RunReport, run};
pub use world::{BodyId, BodyState, Energy, Impact, ImpactRow, RunError, Statistics, Status, World};
