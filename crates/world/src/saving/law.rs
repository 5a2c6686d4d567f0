//! Force laws as data: those of this crate, each by its type.

use super::error::SaveError;
use crate::force::{
    ConstantForce, CoordinateDamper, CoordinateSpring, Dashpot, ForceLaw, MutualGravity, PointForce,
    RotatingForce, Spring, Varied, Vary,
};
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::sync::Arc;

/// A force law of this crate.
#[derive(Serialize, Deserialize)]
pub(super) enum SavedLaw {
    Constant(ConstantForce),
    CoordinateDamper(CoordinateDamper),
    CoordinateSpring(CoordinateSpring),
    Dashpot(Dashpot),
    MutualGravity(MutualGravity),
    PointForce(PointForce),
    Rotating(RotatingForce),
    Spring(Spring),
    Varied(Box<Self>, Vary),
}

impl SavedLaw {
    /// A copy of a law.
    ///
    /// # Errors
    /// [`SaveError::OwnLaw`] for a law that is not one of this crate's.
    pub(super) fn of(law: &dyn ForceLaw) -> Result<Self, SaveError> {
        let any: &dyn Any = law;
        if let Some(varied) = any.downcast_ref::<Varied>() {
            let (law, vary) = varied.parts();
            return Ok(Self::Varied(Box::new(Self::of(&**law)?), vary.clone()));
        }
        None.or_else(|| any.downcast_ref().cloned().map(Self::Constant))
            .or_else(|| any.downcast_ref().cloned().map(Self::CoordinateDamper))
            .or_else(|| any.downcast_ref().cloned().map(Self::CoordinateSpring))
            .or_else(|| any.downcast_ref().cloned().map(Self::Dashpot))
            .or_else(|| any.downcast_ref().cloned().map(Self::MutualGravity))
            .or_else(|| any.downcast_ref().cloned().map(Self::PointForce))
            .or_else(|| any.downcast_ref().cloned().map(Self::Rotating))
            .or_else(|| any.downcast_ref().cloned().map(Self::Spring))
            .ok_or_else(|| SaveError::OwnLaw { law: law.name().to_owned() })
    }

    pub(super) fn into_law(self) -> Arc<dyn ForceLaw> {
        match self {
            Self::Constant(law) => Arc::new(law),
            Self::CoordinateDamper(law) => Arc::new(law),
            Self::CoordinateSpring(law) => Arc::new(law),
            Self::Dashpot(law) => Arc::new(law),
            Self::MutualGravity(law) => Arc::new(law),
            Self::PointForce(law) => Arc::new(law),
            Self::Rotating(law) => Arc::new(law),
            Self::Spring(law) => Arc::new(law),
            Self::Varied(law, vary) => Arc::new(Varied::new(law.into_law(), vary)),
        }
    }
}
