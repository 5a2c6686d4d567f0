//! A system between the bytes that it was saved to and the force laws that bytes cannot hold.

use crate::rigid::bodies::force_law::ForceLaw;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::parts::{PartsError, check_bodies_of_force_law};
use crate::rigid::system::RigidSystem;
use std::sync::Arc;

/// A system that was saved, which waits for its force laws.
#[derive(Debug, serde::Deserialize)]
pub struct SavedSystem {
    rooms: Rooms,
}

impl SavedSystem {
    /// The system as it was when it was saved, given the force laws that it had, all of [`RigidSystem::force_laws`]: it
    /// goes on with the same bits, in a build of the same version.
    ///
    /// # Errors
    /// Laws that are too many, too few, or name a body that is not there.
    pub fn with_force_laws(mut self, force_laws: Vec<Arc<dyn ForceLaw>>) -> Result<RigidSystem, PartsError> {
        let count = self.rooms.assembly.body_count();
        for (index, law) in force_laws.iter().enumerate() {
            check_bodies_of_force_law(index, law.as_ref(), count)?;
        }
        self.rooms.assembly.restore_force_laws(force_laws)?;
        Ok(RigidSystem::of_rooms(self.rooms))
    }
}
