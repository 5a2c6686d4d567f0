//! Connectors in a scene file, which tie two bodies, or a body and the world, together.

use super::one_key::one_key_enum;
use super::shape::EdgeData;
use super::vector::Vector;
use serde::Deserialize;

/// A point of a body, in its shape coordinates, or of the world.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointData {
    /// Name of the body, or `"world"`.
    pub body: String,
    /// Coordinates [m].
    pub point: Vector,
}

one_key_enum! {
    /// A connector.
    ConnectorData: "connector" {
        /// Keeps two points together.
        "pin" => Pin(PinData),
        /// Keeps two points together along one direction.
        "slot" => Slot(SlotData),
        /// Keeps two points exactly a length apart.
        "rod" => Rod(LengthData),
        /// Keeps two points at most a length apart.
        "rope" => Rope(LengthData),
        /// Keeps a point on a path that is fixed in the world.
        "rail" => Rail(RailData),
        /// Ends a rail.
        "rail_stop" => RailStop(RailStopData),
    }
}

/// Fields that every connector may have.
///
/// They are repeated in each connector rather than flattened into it, because flattening and the refusal of unknown
/// fields do not go together in serde.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConnectorOptions {
    /// Coefficient of restitution, if given.
    pub elasticity: Option<f64>,
    /// Whether the bodies collide with each other although they are joined.
    pub collide: bool,
    /// Whether body b, or body a if b is missing or fixed, is moved to satisfy the connector before the start.
    pub align: bool,
}

macro_rules! connector_data {
    ($(#[$meta:meta])* $name:ident { $($(#[$doc:meta])* $field:ident: $kind:ty),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            $($(#[$doc])* pub $field: $kind,)+
            /// Coefficient of restitution; by default 0 for pin, slot, rod and rail, the lesser of the
            /// bodies' for rope and rail_stop (1 for the world).
            pub elasticity: Option<f64>,
            /// Whether the bodies collide with each other although they are joined.
            #[serde(default)]
            pub collide: bool,
            /// Whether body b, or body a if b is missing or fixed, is moved to satisfy the connector before the start.
            #[serde(default)]
            pub align: bool,
        }

        impl $name {
            fn options(&self) -> ConnectorOptions {
                ConnectorOptions { elasticity: self.elasticity, collide: self.collide, align: self.align }
            }
        }
    };
}

connector_data! {
    /// Keeps two points together.
    PinData {
        /// One point.
        a: PointData,
        /// The other point.
        b: PointData,
    }
}

connector_data! {
    /// Keeps two points together along one direction.
    SlotData {
        /// One point.
        a: PointData,
        /// The other point.
        b: PointData,
        /// Direction along which the points are kept together, a vector of any length but 0.
        normal: Vector,
        /// Frame in which `normal` is given and stays constant.
        #[serde(default)]
        normal_frame: NormalFrame,
    }
}

connector_data! {
    /// Keeps two points exactly (rod) or at most (rope) a length apart.
    LengthData {
        /// One point.
        a: PointData,
        /// The other point.
        b: PointData,
        /// The length [m].
        length: f64,
    }
}

connector_data! {
    /// Keeps a point on a path that is fixed in the world.
    RailData {
        /// The point.
        a: PointData,
        /// The path.
        path: RailPath,
        /// Whether the path is closed: a spline through points is periodic, edges must end where they start.
        #[serde(default)]
        closed: bool,
    }
}

connector_data! {
    /// Ends a rail.
    RailStopData {
        /// The point that is on the rail.
        a: PointData,
        /// The path of the rail.
        path: RailPath,
        /// Position of the stop: arc length from the first point of the path [m].
        at: f64,
        /// Whether the stop is the upper end of the rail (arc lengths beyond `at` are cut off), else the lower end.
        upper: bool,
    }
}

/// Frame of a slot's direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NormalFrame {
    /// The direction turns with body a.
    A,
    /// The direction turns with body b.
    B,
    /// The direction is constant in the world.
    #[default]
    World,
}

/// Path of a rail: edges from a start, or the cubic spline through points.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RailPath {
    /// First point [m], with `edges`.
    pub start: Option<Vector>,
    /// The edges in order, with `start`.
    pub edges: Option<Vec<EdgeData>>,
    /// Points of a spline [m], instead of `start` and `edges`.
    pub points: Option<Vec<Vector>>,
}

impl ConnectorData {
    /// Returns the fields that every connector may have.
    #[must_use]
    pub fn options(&self) -> ConnectorOptions {
        match self {
            Self::Pin(pin) => pin.options(),
            Self::Slot(slot) => slot.options(),
            Self::Rod(rod) => rod.options(),
            Self::Rope(rope) => rope.options(),
            Self::Rail(rail) => rail.options(),
            Self::RailStop(stop) => stop.options(),
        }
    }

    /// Returns the points of the connector: `a`, and `b` if it has one.
    #[must_use]
    pub fn points(&self) -> (&PointData, Option<&PointData>) {
        match self {
            Self::Pin(pin) => (&pin.a, Some(&pin.b)),
            Self::Slot(slot) => (&slot.a, Some(&slot.b)),
            Self::Rod(length) | Self::Rope(length) => (&length.a, Some(&length.b)),
            Self::Rail(rail) => (&rail.a, None),
            Self::RailStop(stop) => (&stop.a, None),
        }
    }
}
