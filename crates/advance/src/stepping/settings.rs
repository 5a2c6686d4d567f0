//! Settings of an advance by steps.

use crate::rigid::{POSITIVE, PartsError, RigidSettings, keep_to};

/// Settings of an advance by steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct SteppingSettings {
    /// Length of a step [s]; of the longest, if they are chosen.
    pub step: f64,
    /// If given, lengths of steps are chosen so that ways of bodies in two of them are off by no more than this [m].
    pub accuracy: Option<f64>,
    /// Rate that sweeps may leave, as a fraction of the speed that forces give in a step [-].
    pub residual: f64,
    /// Error of positions [m] that is not corrected.
    pub slack: f64,
    /// Thresholds of touching, the impact law, its order and what elasticity means with friction, and whether bodies collide; steps need nothing else of it.
    pub rigid: RigidSettings,
}

impl SteppingSettings {
    /// Checks the numbers that only steps have.
    ///
    /// # Errors
    /// The first that is out of range.
    pub(super) fn check(&self) -> Result<(), PartsError> {
        let numbers = [
            ("time_step", self.step),
            ("accuracy", self.accuracy.unwrap_or(self.step)),
            ("residual", self.residual),
            ("slack", self.slack),
        ];
        keep_to(&[(POSITIVE.0, POSITIVE.1, &numbers)])
            .map_err(|(setting, rule, value)| PartsError::BadSetting { setting, rule, value })
    }
}
