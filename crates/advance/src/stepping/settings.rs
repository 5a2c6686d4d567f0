//! Settings of an advance by steps.

use crate::rigid::RigidSettings;
use halfgap_contact::Restitution;

/// Settings of an advance by steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct SteppingSettings {
    /// Length of a step [s].
    pub step: f64,
    /// Change of an impulse, as a fraction of the largest [-], up to which the impulses of a step are found.
    pub residual: f64,
    /// Error of positions [m] that is not corrected.
    pub slack: f64,
    /// What elasticity means where there is friction.
    pub restitution: Restitution,
    /// Thresholds of touching, the impact law and its order, and whether bodies collide; steps need nothing else of it.
    pub rigid: RigidSettings,
}
