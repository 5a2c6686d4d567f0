//! Impact laws and solvers, tested through the public API.

mod friction;
mod impact_found;
mod impact_laws;
mod impact_rows;
mod impact_thirds;
mod kinds;
mod laws;
#[cfg(feature = "json")]
mod problems;
mod rough_impacts;
