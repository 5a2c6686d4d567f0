//! Force laws in a scene file.

use super::connector::PointData;
use super::one_key::one_key_enum;
use super::vector::Vector;
use crate::force::ForceFrame;
use serde::Deserialize;

one_key_enum! {
    /// A force law.
    ForceData: "force" {
        /// Uniform acceleration.
        "gravity" => Gravity(GravityData),
        /// Forces and torques against the velocities.
        "damping" => Damping(DampingData),
        /// Attraction between centres of mass.
        "mutual_gravity" => MutualGravity(MutualGravityData),
        /// A spring between two points.
        "spring" => Spring(SpringData),
        /// A constant force at a point of a body.
        "constant" => Constant(ConstantData),
        /// A force whose direction turns at a constant rate.
        "rotating" => Rotating(RotatingData),
    }
}

/// Uniform acceleration.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GravityData {
    /// Acceleration [m/s²].
    pub acceleration: Vector,
    /// Names of the bodies it acts on; all if not given.
    pub bodies: Option<Vec<String>>,
}

/// Forces and torques against the velocities.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DampingData {
    /// Force per velocity of the centre of mass [N·s/m], not negative.
    #[serde(default)]
    pub linear: f64,
    /// Torque per angular velocity [N·m·s], not negative.
    #[serde(default)]
    pub angular: f64,
    /// Names of the bodies it acts on; all if not given.
    pub bodies: Option<Vec<String>>,
}

/// Attraction `strength m1 m2/r²` between centres of mass.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MutualGravityData {
    /// Gravitational constant [m³/(kg·s²)]; a negative one repels.
    pub strength: f64,
    /// Names of the bodies it acts between; all that have a mass if not given.
    pub bodies: Option<Vec<String>>,
}

/// A spring between two points.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpringData {
    /// One end.
    pub a: PointData,
    /// The other end.
    pub b: PointData,
    /// Length at which the spring exerts no force [m].
    pub rest_length: f64,
    /// Force per length [N/m], not negative.
    pub stiffness: f64,
    /// Force per rate of the length [N·s/m], not negative.
    #[serde(default)]
    pub damping: f64,
}

/// A constant force at a point of a body, and a torque.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConstantData {
    /// Name of the body.
    pub body: String,
    /// Point at which the force acts, in coordinates of `frame` [m].
    pub point: Vector,
    /// Force, in coordinates of `frame` [N].
    pub force: Vector,
    /// Frame of the point and the force.
    #[serde(default)]
    pub frame: ForceFrame,
    /// Torque besides that of the force [N·m], counter-clockwise positive.
    #[serde(default)]
    pub torque: f64,
}

/// A force of constant size whose direction in the body's frame turns at a constant rate.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotatingData {
    /// Name of the body.
    pub body: String,
    /// Point at which the force acts, in shape coordinates [m].
    pub point: Vector,
    /// Size of the force [N]; a negative one points the other way.
    pub magnitude: f64,
    /// Rate at which the direction turns in the body's frame [rad/s], counter-clockwise positive.
    pub rate: f64,
    /// Direction in the body's frame at the start of the run [rad], from the x axis, counter-clockwise positive.
    #[serde(default)]
    pub phase: f64,
}

impl ForceData {
    /// Names of the bodies to which the law is limited; `None` if it acts on all, or names its bodies in other fields.
    #[must_use]
    pub fn bodies(&self) -> Option<&[String]> {
        match self {
            Self::Gravity(gravity) => gravity.bodies.as_deref(),
            Self::Damping(damping) => damping.bodies.as_deref(),
            Self::MutualGravity(mutual) => mutual.bodies.as_deref(),
            Self::Spring(_) | Self::Constant(_) | Self::Rotating(_) => None,
        }
    }
}
