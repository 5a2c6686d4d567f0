//! What the geometry promises, tested through its public API.

mod errors;
