//! Worlds as users build, read, run and record them, tested through the public API.

mod failures;
mod impacts;
mod integrators;
mod interventions;
#[cfg(feature = "scene")]
mod language;
mod live;
#[cfg(feature = "scene")]
mod newcomer;
#[cfg(feature = "scene")]
mod pictures;
#[cfg(feature = "scene")]
mod recordings;
#[cfg(feature = "scene")]
mod refusals;
#[cfg(feature = "save")]
mod saving;
#[cfg(feature = "scene")]
mod scene_files;
mod start;
