//! The impulses of an event.
//!
//! **Invariant**: after an impact no row that takes part closes faster than at rest, and no impulse pulls. The room changes
//! velocities, and books them; it does not decide what is active afterwards.
//!
//! `impacts`: impulses and their report · `jams`: impulses that cancel each other, of contacts that need not take part · `corners`: points that are driven out of the corner of a rail.

pub(super) mod corners;
pub(super) mod impacts;
pub(super) mod jams;
