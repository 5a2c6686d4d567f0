//! Probes in a scene file: what is told of a run besides the states.

use super::connector::PointData;
use super::one_key::one_key_enum;
use serde::Deserialize;

one_key_enum! {
    /// What a probe measures.
    ProbeData: "probe" {
        /// Position and velocity of a point.
        "point" => Point(PointData),
        /// Angle of one body less that of another.
        "angle" => Angle(AngleData),
        /// Distance of two points.
        "distance" => Distance(DistanceData),
        /// Force and free coordinate of a connector.
        "connector" => Connector(ConnectorRef),
        /// Sum of the contact forces of the second body on the first.
        "contact" => Contact([String; 2]),
    }
}

/// Two bodies: the angle is that of `b` less that of `a`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AngleData {
    /// Name of one body, or `"world"`.
    pub a: String,
    /// Name of the other, or `"world"`.
    pub b: String,
}

/// Two points.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DistanceData {
    /// One point.
    pub a: PointData,
    /// The other point.
    pub b: PointData,
}

/// A connector of the scene.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum ConnectorRef {
    /// By its place in the file, from 0.
    Index(usize),
    /// By its name.
    Name(String),
}
