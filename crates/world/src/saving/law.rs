//! Force laws as data: those of this crate, each by its type.

use super::error::SaveError;
use crate::force::{ConstantForce, Dashpot, ForceLaw, MutualGravity, RotatingForce, Spring};
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::sync::Arc;

/// A force law of this crate.
#[derive(Serialize, Deserialize)]
pub(super) enum SavedLaw {
    Constant(ConstantForce),
    Dashpot(Dashpot),
    MutualGravity(MutualGravity),
    Rotating(RotatingForce),
    Spring(Spring),
}

impl SavedLaw {
    /// A copy of a law.
    ///
    /// # Errors
    /// [`SaveError::OwnLaw`] for a law that is not one of this crate's.
    pub(super) fn of(law: &dyn ForceLaw) -> Result<Self, SaveError> {
        let any: &dyn Any = law;
        None.or_else(|| any.downcast_ref().cloned().map(Self::Constant))
            .or_else(|| any.downcast_ref().cloned().map(Self::Dashpot))
            .or_else(|| any.downcast_ref().cloned().map(Self::MutualGravity))
            .or_else(|| any.downcast_ref().cloned().map(Self::Rotating))
            .or_else(|| any.downcast_ref().cloned().map(Self::Spring))
            .ok_or_else(|| SaveError::OwnLaw { law: law.name().to_owned() })
    }

    pub(super) fn into_law(self) -> Arc<dyn ForceLaw> {
        match self {
            Self::Constant(law) => Arc::new(law),
            Self::Dashpot(law) => Arc::new(law),
            Self::MutualGravity(law) => Arc::new(law),
            Self::Rotating(law) => Arc::new(law),
            Self::Spring(law) => Arc::new(law),
        }
    }
}
