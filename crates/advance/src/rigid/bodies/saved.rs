//! Bodies and laws that were saved: what their data do not tell is put back.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::force_law::ForceLaw;
use crate::rigid::bodies::force_laws::ForceLaws;
use crate::rigid::bodies::trajectory::Trajectory;
use crate::rigid::parts::PartsError;
use halfgap_geometry::ShapePool;
use serde::{Deserialize, Deserializer};
use std::sync::Arc;

/// Reads bodies, whose equal shapes are then in memory once.
pub(super) fn trajectories<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Trajectory>, D::Error> {
    let mut trajectories = Vec::<Trajectory>::deserialize(deserializer)?;
    let mut pool = ShapePool::default();
    trajectories.iter_mut().for_each(|trajectory| trajectory.share_shape(&mut pool));
    Ok(trajectories)
}

impl Assembly {
    /// Gives the force laws back that the bodies had when they were saved.
    ///
    /// # Errors
    /// [`PartsError::OtherLaws`].
    pub(crate) fn restore_force_laws(
        &mut self,
        force_laws: Vec<Arc<dyn ForceLaw>>,
    ) -> Result<(), PartsError> {
        self.force_laws.restore(force_laws)
    }
}

impl ForceLaws {
    /// Puts back the force laws, which are not saved.
    ///
    /// # Errors
    /// Too many or too few of them.
    pub(crate) fn restore(&mut self, force_laws: Vec<Arc<dyn ForceLaw>>) -> Result<(), PartsError> {
        let (given, count) = (force_laws.len(), self.count());
        if given != count {
            return Err(PartsError::OtherLaws { given, count });
        }
        self.all = force_laws;
        Ok(())
    }
}
