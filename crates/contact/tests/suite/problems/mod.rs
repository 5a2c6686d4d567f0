//! The solvers against the collected problems and against each other.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop")]

mod collected;
mod data;
mod extremes;
mod files;
mod found;
mod games;
mod least_norm;
mod perturbed;
mod properties;
mod warm;
