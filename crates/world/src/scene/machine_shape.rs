//! Shapes made for machines in a scene file: capsules, regular polygons, toothed wheels and bars, cams.

use super::motion::DriveData;
use serde::Deserialize;

/// Two half circles about centres on the x axis, joined by straight edges.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CapsuleData {
    /// Distance of the centres of its ends [m].
    pub length: f64,
    /// Radius of its ends [m].
    pub radius: f64,
}

/// A regular polygon about the origin, with its first corner on the x axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegularData {
    /// Number of sides, at least 3.
    pub sides: usize,
    /// Distance of its corners from the origin [m].
    pub radius: f64,
}

/// An involute spur wheel about the origin, with a tooth on the x axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GearShapeData {
    /// Pitch diameter per tooth [m].
    pub module: f64,
    /// Number of teeth, at least 3.
    pub teeth: usize,
    /// Pressure angle [rad]; 20 degrees if not given.
    pub pressure_angle: Option<f64>,
    /// Height of the teeth above the pitch circle, in modules [-]; 1 if not given.
    pub addendum: Option<f64>,
    /// Their depth below it, in modules [-]; 1.25 if not given.
    pub dedendum: Option<f64>,
    /// Play of two wheels along the pitch circle [m], of which each gives half.
    #[serde(default)]
    pub backlash: f64,
    /// Radius by which the feet of the teeth are rounded [m]; sharp if 0.
    #[serde(default)]
    pub root_radius: f64,
    /// Radius of a round hole in the middle [m]; none if not given.
    pub bore: Option<f64>,
    /// By how much flanks may be off [m]; 1e-4 of the module if not given.
    pub tolerance: Option<f64>,
}

/// A rack: a bar along x with teeth upwards, whose pitch line is the x axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RackBarData {
    /// Length along the bar per tooth, divided by pi [m].
    pub module: f64,
    /// Number of teeth.
    pub teeth: usize,
    /// Pressure angle [rad]; 20 degrees if not given.
    pub pressure_angle: Option<f64>,
    /// Height of the teeth above the pitch line, in modules [-]; 1 if not given.
    pub addendum: Option<f64>,
    /// Their depth below it, in modules [-]; 1.25 if not given.
    pub dedendum: Option<f64>,
    /// Play with a wheel along the pitch line [m], of which each gives half.
    #[serde(default)]
    pub backlash: f64,
    /// Radius by which the feet of the teeth are rounded [m]; sharp if 0.
    #[serde(default)]
    pub root_radius: f64,
    /// Thickness of the bar below the teeth [m]; two modules if not given.
    pub thickness: Option<f64>,
}

/// A ratchet wheel about the origin, with a radial face on the x axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RatchetData {
    /// Number of teeth, at least 3.
    pub teeth: usize,
    /// Radius of the tips of the teeth [m].
    pub outer: f64,
    /// Radius of their feet [m].
    pub inner: f64,
    /// To which side the radial faces look.
    #[serde(default)]
    pub lean: LeanData,
}

/// A side of a ratchet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LeanData {
    /// Counter-clockwise.
    #[default]
    Left,
    /// Clockwise.
    Right,
}

/// The wheel of a Geneva drive about the origin, with its first slot on the x axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GenevaData {
    /// Number of slots, at least 3.
    pub slots: usize,
    /// Distance of the wheel's axis from the crank's [m]; the crank's radius is this times the sine of half a slot's turn.
    pub center_distance: f64,
    /// Radius of the crank's pin [m].
    pub pin_radius: f64,
    /// Play of the pin in the slot [m], to either side and at its end.
    #[serde(default)]
    pub clearance: f64,
    /// Radius of the hollows in which the crank's disc holds the wheel [m]; the rim is round if not given.
    pub lock_radius: Option<f64>,
}

/// A cam about the origin for a radial follower with a roller.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CamData {
    /// Radius of the cam where there is no lift [m].
    pub base: f64,
    /// Lift of the roller [m], as the motion of a drive in which the time is the share of a turn, 0 to 1; less its value at 0.
    pub lift: DriveData,
    /// Radius of the roller [m].
    pub roller: f64,
    /// By how much the outline may be off [m]; 1e-4 of the base if not given.
    pub tolerance: Option<f64>,
}
