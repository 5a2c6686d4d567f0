//! Force laws in a scene file.

use super::connector::PointData;
use super::one_key::one_key_enum;
use super::vector::Vector;
use crate::force::{ForceFrame, Vary, VaryError};
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
        /// A force on a point of a body, which moves with it.
        "push" => Push(PushData),
        /// A spring between the angles of two bodies.
        "torsion_spring" => TorsionSpring(TorsionSpringData),
    }
}

one_key_enum! {
    /// A factor as a function of the scene's time.
    VaryData: "vary" {
        /// A sine.
        "sine" => Sine(SineData),
        /// Values at times, linear between and constant outside.
        "table" => Table(TableData),
        /// 1 from the first of two times [s] until the second, else 0.
        "on" => On([f64; 2]),
    }
}

impl VaryData {
    /// Makes the factor.
    ///
    /// # Errors
    /// Numbers that make none.
    pub(crate) fn to_vary(&self) -> Result<Vary, VaryError> {
        match self {
            Self::Sine(sine) => Vary::sine(sine.frequency, sine.phase),
            Self::Table(table) => Vary::table(table.times.clone(), table.values.clone()),
            Self::On([from, until]) => Vary::on(*from, *until),
        }
    }
}

/// sin(2 pi frequency t + phase).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SineData {
    /// Frequency [Hz].
    pub frequency: f64,
    /// Phase [rad].
    #[serde(default)]
    pub phase: f64,
}

/// Values at times.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableData {
    /// Times [s], which grow.
    pub times: Vec<f64>,
    /// A value [-] for each.
    pub values: Vec<f64>,
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
    /// A factor of the time on the stiffness and the damping; 1 if not given.
    pub vary: Option<VaryData>,
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
    /// A factor of the time on the force and the torque; 1 if not given.
    pub vary: Option<VaryData>,
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
    /// A factor of the time on the force; 1 if not given.
    pub vary: Option<VaryData>,
}

/// A force on a point of a body, which moves with the body, and a torque.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PushData {
    /// Name of the body.
    pub body: String,
    /// Point at which the force acts, in shape coordinates [m]; the centre of mass if not given.
    pub point: Option<Vector>,
    /// Force, in coordinates of `frame` [N].
    #[serde(default)]
    pub force: Vector,
    /// Frame of the force.
    #[serde(default)]
    pub frame: ForceFrame,
    /// Torque besides that of the force [N·m], counter-clockwise positive.
    #[serde(default)]
    pub torque: f64,
    /// A factor of the time on the force and the torque; 1 if not given.
    pub vary: Option<VaryData>,
}

/// A spring between the angles of two bodies.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TorsionSpringData {
    /// Name of one body, or `"world"`.
    pub a: String,
    /// Name of the other, or `"world"`.
    pub b: String,
    /// Angle of b less that of a at which the spring exerts no torque [rad], whole turns counted.
    #[serde(default)]
    pub rest_angle: f64,
    /// Torque per angle [N·m/rad], not negative.
    pub stiffness: f64,
    /// Torque per angular velocity [N·m·s/rad], not negative.
    #[serde(default)]
    pub damping: f64,
    /// A factor of the time on the stiffness and the damping; 1 if not given.
    pub vary: Option<VaryData>,
}

impl ForceData {
    /// Names of the bodies to which the law is limited; `None` if it acts on all, or names its bodies in other fields.
    #[must_use]
    pub fn bodies(&self) -> Option<&[String]> {
        match self {
            Self::Gravity(gravity) => gravity.bodies.as_deref(),
            Self::Damping(damping) => damping.bodies.as_deref(),
            Self::MutualGravity(mutual) => mutual.bodies.as_deref(),
            _ => None,
        }
    }

    /// The factor of the time on the law; `None` if it has none.
    #[must_use]
    pub fn vary(&self) -> Option<&VaryData> {
        match self {
            Self::Gravity(_) | Self::Damping(_) | Self::MutualGravity(_) => None,
            Self::Spring(spring) => spring.vary.as_ref(),
            Self::Constant(constant) => constant.vary.as_ref(),
            Self::Rotating(rotating) => rotating.vary.as_ref(),
            Self::Push(push) => push.vary.as_ref(),
            Self::TorsionSpring(spring) => spring.vary.as_ref(),
        }
    }
}
