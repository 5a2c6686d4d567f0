//! Pairs of bodies in a scene file that differ from what their bodies say.

use serde::Deserialize;

/// What holds for two bodies instead of what they say together.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairData {
    /// Names of the two bodies.
    pub bodies: [String; 2],
    /// Kinetic Coulomb coefficient of friction [-].
    pub friction: Option<f64>,
    /// Coefficient up to which contacts stick [-]; as `friction` if only that is given.
    pub static_friction: Option<f64>,
    /// Coefficient of restitution, 0 to 1.
    pub elasticity: Option<f64>,
    /// Rolling resistance [-].
    pub rolling_resistance: Option<f64>,
    /// Share of the slip speed given back by an impact, 0 to 1.
    pub tangential_elasticity: Option<f64>,
    /// Whether the bodies collide with each other.
    pub collide: Option<bool>,
}
