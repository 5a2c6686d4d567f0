//! The stepper, the buffer and the settings with which a group is stepped.

use crate::ode::Stepper;
use crate::rigid::settings::RigidSettings;

/// Stepper, buffer and settings with which a group is stepped.
pub(crate) struct Tools<'a> {
    pub(crate) stepper: &'a mut Stepper,
    pub(crate) scales: &'a mut Vec<f64>,
    pub(crate) settings: &'a RigidSettings,
}
