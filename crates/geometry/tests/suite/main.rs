//! Promises of the geometry, tested through its public API.

mod degenerate;
mod errors;
mod gaps;
mod mass;
mod queries;
mod reference;
mod reference_pairs;
mod sampling;
mod shapes;
