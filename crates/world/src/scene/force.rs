//! Force laws as a scene file gives them.

use super::connector::PointData;
use super::one_key::one_key_enum;
use super::vector::Vector;
use serde::Deserialize;

one_key_enum! {
    /// A force law.
    ForceData: "force" {
        /// The same acceleration for every body.
        "gravity" => Gravity(GravityData),
        /// Forces against the velocities.
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

/// The same acceleration for every body.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GravityData {
    /// Acceleration [m/s²].
    pub acceleration: Vector,
    /// The bodies it acts on; all if not given.
    pub bodies: Option<Vec<String>>,
}

/// Forces against the velocities.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DampingData {
    /// Force per velocity of the centre of mass [N·s/m].
    #[serde(default)]
    pub linear: f64,
    /// Torque per angular velocity [N·m·s].
    #[serde(default)]
    pub angular: f64,
    /// The bodies it acts on; all if not given.
    pub bodies: Option<Vec<String>>,
}

/// Attraction `strength m1 m2/r²` between centres of mass.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MutualGravityData {
    /// Gravitational constant [m³/(kg·s²)].
    pub strength: f64,
    /// The bodies it acts between; all if not given.
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
    /// Length without force [m].
    pub rest_length: f64,
    /// Force per length [N/m].
    pub stiffness: f64,
    /// Force per rate of the length [N·s/m].
    #[serde(default)]
    pub damping: f64,
}

/// A constant force at a point of a body, and a torque.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConstantData {
    /// The body.
    pub body: String,
    /// Where the force acts, in coordinates of `frame` [m].
    pub point: Vector,
    /// The force, in coordinates of `frame` [N].
    pub force: Vector,
    /// Whether force and point turn with the body.
    #[serde(default)]
    pub frame: ForceFrame,
    /// An additional torque [N·m].
    #[serde(default)]
    pub torque: f64,
}

/// The frame of a constant force and its point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ForceFrame {
    /// Both turn with the body.
    Body,
    /// Both are fixed in the world.
    #[default]
    World,
}

/// A force of constant size whose direction in the body's frame turns at a constant rate.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotatingData {
    /// The body.
    pub body: String,
    /// Where the force acts, in shape coordinates [m].
    pub point: Vector,
    /// Its size [N].
    pub magnitude: f64,
    /// How fast it turns [rad/s].
    pub rate: f64,
    /// Its direction at the start [rad].
    #[serde(default)]
    pub phase: f64,
}

impl ForceData {
    /// The bodies to which the law is limited, if it is one that can be and says so.
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
