//! Advance by steps of one length, in which contacts are problems of velocities: for worlds of many bodies, with friction.
//!
//! *Invariant*: a system is at the start of a step, and knows how its bodies go through it; a step depends on nothing but the one
//! before.
//!
//! `settings` · `balance`: what impulses may give · `bodies`: where bodies are, how they go through the step · `pairs`: which are near each other · `contacts`: what is
//! remembered of where they touch · `facing`: on which side · `ties`: connectors · `kicks`: accelerations without contacts · `rows`, `apart`, `listing`: what contacts
//! and connectors ask of velocities · `islands` · `solving`, `exact`, `sweeps`, `swept`: impulses · `impacts` · `report`: what callers are told ·
//! `pacing`: how long steps are · `projection`: back to the gaps · `passing`: what would pass through something · `sleep` · `memory` · `striking`, `departure`, `step`:
//! from one step to the next · `books`, `driving`: where energy went · `system`, `intervention`: what callers see and change.

mod apart;
mod balance;
mod bodies;
mod books;
mod contacts;
mod departure;
mod driving;
mod exact;
mod facing;
mod impacts;
mod intervention;
mod islands;
mod kicks;
mod listing;
mod memory;
mod pacing;
mod pairs;
mod passing;
mod projection;
mod report;
mod rows;
mod settings;
mod sleep;
mod solving;
mod step;
mod striking;
mod sweeps;
mod swept;
mod system;
mod ties;

#[cfg(feature = "save")]
pub use intervention::SavedStepping;
pub use settings::SteppingSettings;
pub use system::SteppingSystem;
