//! States that a run of the scene is expected to reach.

use super::vector::Vector;
use serde::Deserialize;
use std::collections::BTreeMap;

/// States and energy expected at one time. An entry with only a time says that the run must get there.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExpectedData {
    /// The time [s].
    pub time: f64,
    /// Largest difference allowed in a position [m] or an angle [rad].
    pub position_tolerance: Option<f64>,
    /// Largest difference allowed in a velocity [m/s] or an angular velocity [rad/s].
    pub velocity_tolerance: Option<f64>,
    /// Expected change of the total energy since the start [J].
    pub energy_change: Option<f64>,
    /// Largest difference allowed in `energy_change` [J].
    pub energy_tolerance: Option<f64>,
    /// Upper bound of the change of the total energy since the start [J].
    pub energy_change_below: Option<f64>,
    /// Expected states of bodies by name.
    #[serde(default)]
    pub bodies: BTreeMap<String, ExpectedState>,
}

/// Expected state of a body, as far as it is known.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExpectedState {
    /// Position of the centre of mass [m].
    pub position: Option<Vector>,
    /// Angle, not reduced [rad].
    pub angle: Option<f64>,
    /// Velocity of the centre of mass [m/s].
    pub velocity: Option<Vector>,
    /// Angular velocity [rad/s].
    pub angular_velocity: Option<f64>,
}
