//! Shapes in a scene file, in shape coordinates.

use super::machine_shape::{
    CamData, CapsuleData, GearShapeData, GenevaData, RackBarData, RatchetData, RegularData,
};
use super::one_key::one_key_enum;
use super::vector::Vector;
use serde::Deserialize;

one_key_enum! {
    /// The shape of a body.
    ShapeData: "shape" {
        /// A disc about the origin.
        "disc" => Disc(DiscData),
        /// A rectangle about the origin.
        "block" => Block(BlockData),
        /// A rectangle about the origin with quarter circles for corners.
        "rounded_block" => RoundedBlock(RoundedBlockData),
        /// A polygon.
        "polygon" => Polygon(PolygonData),
        /// The ring between two circles about the origin.
        "ring" => Ring(RingData),
        /// Two half circles joined by straight edges, along x.
        "capsule" => Capsule(CapsuleData),
        /// A regular polygon.
        "regular" => Regular(RegularData),
        /// An involute spur wheel.
        "gear" => Gear(GearShapeData),
        /// A rack for such wheels.
        "rack_bar" => RackBar(RackBarData),
        /// A ratchet wheel.
        "ratchet" => Ratchet(RatchetData),
        /// The wheel of a Geneva drive.
        "geneva" => Geneva(GenevaData),
        /// A cam for a radial follower with a roller.
        "cam" => Cam(CamData),
        /// Closed paths; points that an odd number of them surrounds are solid.
        "outline" => Outline(OutlineData),
    }
}

/// A disc about the origin.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiscData {
    /// Radius [m].
    pub radius: f64,
}

/// A rectangle about the origin.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlockData {
    /// Size along x [m].
    pub width: f64,
    /// Size along y [m].
    pub height: f64,
}

/// A rectangle about the origin with quarter circles for corners.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoundedBlockData {
    /// Size along x [m].
    pub width: f64,
    /// Size along y [m].
    pub height: f64,
    /// Radius of the corners [m], at most half of the shorter side.
    pub radius: f64,
}

/// A polygon, whose corners run in either direction.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PolygonData {
    /// Corners [m].
    pub vertices: Vec<Vector>,
}

/// The ring between two circles about the origin.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RingData {
    /// Outer radius [m].
    pub outer: f64,
    /// Inner radius [m].
    pub inner: f64,
}

/// Closed paths that do not cross.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutlineData {
    /// The paths; one inside another is a hole.
    pub paths: Vec<PathData>,
}

/// A path; each edge starts where the last one ended.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathData {
    /// First point [m].
    pub start: Vector,
    /// The edges in order.
    pub edges: Vec<EdgeData>,
}

one_key_enum! {
    /// An edge of a path.
    EdgeData: "edge" {
        /// A straight edge to the given point [m].
        "line" => Line(Vector),
        /// A circular arc.
        "arc" => Arc(ArcData),
    }
}

/// A circular arc; a full circle if it ends where it starts.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArcData {
    /// End point of the arc [m].
    pub to: Vector,
    /// Centre of its circle [m].
    pub center: Vector,
    /// Whether the arc runs clockwise from its start to its end.
    #[serde(default)]
    pub clockwise: bool,
}
