//! Connectors in a scene file, which tie two bodies, or a body and the world, together.

use super::body::WORLD;
use super::motion::DriveData;
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
        /// Keeps two bodies from moving against each other.
        "weld" => Weld(WeldData),
        /// Lets a point move along a line, and keeps the bodies from turning against each other.
        "slider" => Slider(SliderData),
        /// Keeps the ratio of the turns of two bodies.
        "gear" => Gear(GearData),
        /// Keeps the way of a bar and the turn of a wheel together.
        "rack" => Rack(RackData),
        /// A rope over two wheels that are fixed in the world.
        "pulley" => Pulley(PulleyData),
    }
}

/// A motor on a free coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotorData {
    /// Speed to which it pulls [rad/s, or m/s of a slot or slider].
    pub speed: f64,
    /// Largest torque [N m] or force [N].
    pub max: f64,
}

/// Bounds of a free coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimitsData {
    /// Lower bound [rad or m].
    pub lower: Option<f64>,
    /// Upper bound [rad or m].
    pub upper: Option<f64>,
    /// Coefficient of restitution of both.
    #[serde(default)]
    pub elasticity: f64,
}

/// A spring on a free coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointSpringData {
    /// Coordinate at which it has no force [rad or m].
    #[serde(default)]
    pub rest: f64,
    /// Stiffness [N m or N/m].
    #[serde(default)]
    pub stiffness: f64,
    /// Damping [N m s or N s/m].
    #[serde(default)]
    pub damping: f64,
}

/// What acts on the free coordinate of a pin, slot or slider, as its data tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointData<'a> {
    /// A motor.
    pub motor: Option<MotorData>,
    /// Dry friction [N m or N], with the name of its field.
    pub friction: (&'static str, Option<f64>),
    /// Bounds.
    pub limits: Option<LimitsData>,
    /// A prescribed motion.
    pub drive: Option<&'a DriveData>,
    /// A spring.
    pub spring: Option<JointSpringData>,
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

macro_rules! joint_data {
    (
        $(#[$meta:meta])* $name:ident ($friction:ident: $unit:literal) {
            $($(#[$doc:meta])* $field:ident: $kind:ty),+ $(,)?
        }
    ) => {
        connector_data! {
            $(#[$meta])*
            $name {
                $($(#[$doc])* $field: $kind,)+
                /// A motor on the free coordinate.
                motor: Option<MotorData>,
                #[doc = concat!("Dry friction on the free coordinate [", $unit, "].")]
                $friction: Option<f64>,
                /// Bounds of the free coordinate.
                limits: Option<LimitsData>,
                /// Motion that the free coordinate follows from its value at the start.
                drive: Option<DriveData>,
                /// A spring on the free coordinate.
                spring: Option<JointSpringData>,
            }
        }

        impl $name {
            fn joint(&self) -> JointData<'_> {
                JointData {
                    motor: self.motor,
                    friction: (stringify!($friction), self.$friction),
                    limits: self.limits,
                    drive: self.drive.as_ref(),
                    spring: self.spring,
                }
            }
        }
    };
}

macro_rules! connector_data {
    ($(#[$meta:meta])* $name:ident { $($(#[$doc:meta])* $field:ident: $kind:ty),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            $($(#[$doc])* pub $field: $kind,)+
            /// Coefficient of restitution; by default the lesser of the bodies' for rope, pulley and rail_stop (1
            /// for the world), 0 for the others.
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

joint_data! {
    /// Keeps two points together.
    PinData (friction_torque: "N m") {
        /// One point.
        a: PointData,
        /// The other point.
        b: PointData,
    }
}

joint_data! {
    /// Keeps two points together along one direction.
    SlotData (friction_force: "N") {
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

connector_data! {
    /// Keeps two bodies from moving against each other.
    WeldData {
        /// Point of one body.
        a: PointData,
        /// Point of the other body, at the same place.
        b: PointData,
    }
}

joint_data! {
    /// Lets a point of body b move along a line through one of body a, without relative rotation.
    SliderData (friction_force: "N") {
        /// Point through which the line goes.
        a: PointData,
        /// Point that stays on it.
        b: PointData,
        /// Direction of the line, a vector of any length but 0.
        axis: Vector,
        /// Frame in which `axis` is given and stays constant.
        #[serde(default)]
        axis_frame: AxisFrame,
    }
}

connector_data! {
    /// Keeps (angle of a) - (angle of the carrier) = ratio ((angle of b) - (angle of the carrier)), but for their values at the start.
    GearData {
        /// Name of one body.
        a: String,
        /// Name of the other body.
        b: String,
        /// Turns of a for one of b, negative for wheels that mesh from outside.
        ratio: f64,
        /// Name of the body that carries both.
        #[serde(default = "world")]
        carrier: String,
    }
}

connector_data! {
    /// Keeps the displacement of a bar along a direction at radius times the turn of a wheel.
    RackData {
        /// Name of the wheel.
        wheel: String,
        /// Name of the bar.
        bar: String,
        /// Radius of the wheel [m].
        radius: f64,
        /// Direction of the world along which the bar goes as the wheel turns counter-clockwise, a vector of any length but 0.
        axis: Vector,
    }
}

connector_data! {
    /// A rope over two wheels: keeps |a - wheel_a| + ratio |b - wheel_b| at most a length.
    PulleyData {
        /// Point at one end.
        a: PointData,
        /// Point at the other end.
        b: PointData,
        /// Point of the world from which the rope goes to `a` [m].
        wheel_a: Vector,
        /// Point of the world from which the rope goes to `b` [m].
        wheel_b: Vector,
        /// Length of rope on the side of `a` for one on that of `b`.
        #[serde(default = "one")]
        ratio: f64,
        /// The length [m].
        length: f64,
    }
}

fn world() -> String {
    WORLD.to_owned()
}

fn one() -> f64 {
    1.0
}

/// Frame of a slider's direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AxisFrame {
    /// The direction turns with body a.
    #[default]
    A,
    /// The direction is constant in the world.
    World,
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
            Self::Weld(weld) => weld.options(),
            Self::Slider(slider) => slider.options(),
            Self::Gear(gear) => gear.options(),
            Self::Rack(rack) => rack.options(),
            Self::Pulley(pulley) => pulley.options(),
        }
    }

    /// Returns the points of the connector: `a`, and `b` if it has one. Gears and racks have none.
    #[must_use]
    pub fn points(&self) -> [Option<&PointData>; 2] {
        match self {
            Self::Pin(pin) => [Some(&pin.a), Some(&pin.b)],
            Self::Slot(slot) => [Some(&slot.a), Some(&slot.b)],
            Self::Rod(length) | Self::Rope(length) => [Some(&length.a), Some(&length.b)],
            Self::Rail(rail) => [Some(&rail.a), None],
            Self::RailStop(stop) => [Some(&stop.a), None],
            Self::Weld(weld) => [Some(&weld.a), Some(&weld.b)],
            Self::Slider(slider) => [Some(&slider.a), Some(&slider.b)],
            Self::Gear(_) | Self::Rack(_) => [None, None],
            Self::Pulley(pulley) => [Some(&pulley.a), Some(&pulley.b)],
        }
    }

    /// Returns what acts on the free coordinate; `None` for a connector that has none.
    #[must_use]
    pub fn joint(&self) -> Option<JointData<'_>> {
        match self {
            Self::Pin(pin) => Some(pin.joint()),
            Self::Slot(slot) => Some(slot.joint()),
            Self::Slider(slider) => Some(slider.joint()),
            _ => None,
        }
    }
}
