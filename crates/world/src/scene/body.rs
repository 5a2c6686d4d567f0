//! Bodies in a scene file.

use super::motion::MotionData;
use super::shape::ShapeData;
use super::vector::Vector;
use serde::Deserialize;

/// Name by which points refer to the immovable background; no body may have it.
pub const WORLD: &str = crate::world::BACKGROUND;

/// A rigid body.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyData {
    /// Name of the body, unique in the scene.
    pub name: String,
    /// Whether the body is immovable, as if of infinite mass.
    #[serde(default)]
    pub fixed: bool,
    /// Shape of the body, in shape coordinates.
    pub shape: ShapeData,
    /// Mass [kg]; a movable body has either a mass or a density.
    pub mass: Option<f64>,
    /// Mass per area [kg/m²], instead of the mass.
    pub density: Option<f64>,
    /// Moment of inertia about the centre of mass [kg·m²]; uniform over the shape if not given.
    pub moment: Option<f64>,
    /// Centre of mass in shape coordinates [m]; the shape's centroid if not given.
    pub center_of_mass: Option<Vector>,
    /// World position of the centre of mass at the start [m]; the world's origin if neither this nor `origin` is given.
    pub position: Option<Vector>,
    /// Instead of the position: the world position of the origin of the shape coordinates at the start [m].
    pub origin: Option<Vector>,
    /// Angle at the start [rad].
    #[serde(default)]
    pub angle: f64,
    /// Velocity of the centre of mass at the start [m/s].
    #[serde(default)]
    pub velocity: Vector,
    /// Angular velocity at the start [rad/s].
    #[serde(default)]
    pub angular_velocity: f64,
    /// Coefficient of restitution, 0 to 1; a pair of bodies uses the lesser.
    #[serde(default = "full_elasticity")]
    pub elasticity: f64,
    /// Kinetic Coulomb coefficient of friction [-]; a pair of bodies uses the geometric mean.
    #[serde(default)]
    pub friction: f64,
    /// Coefficient up to which contacts stick [-]; as `friction` if not given. A pair uses the geometric mean.
    pub static_friction: Option<f64>,
    /// Speed at which the surface runs along the outline [m/s], counter-clockwise positive.
    #[serde(default)]
    pub surface_velocity: f64,
    /// Rolling resistance [-]: a torque of at most so many times radius and normal force; a pair uses the greater.
    #[serde(default)]
    pub rolling_resistance: f64,
    /// Share of the slip speed given back by an impact, 0 to 1; a pair uses the lesser.
    #[serde(default)]
    pub tangential_elasticity: f64,
    /// Motion of a fixed body that is moved.
    pub motion: Option<MotionData>,
    /// Names of bodies with which this one never collides, nor they with it.
    #[serde(default)]
    pub passes_through: Vec<String>,
}

fn full_elasticity() -> f64 {
    1.0
}
