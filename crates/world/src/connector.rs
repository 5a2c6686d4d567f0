//! Connectors to be added to a world, and their names in messages.

use crate::force::{CoordinateDamper, CoordinateSpring};
use halfgap_advance::rigid::ForceLaw;
use halfgap_collision::{Connector, ConnectorError, ConnectorKind, MotionLaw};
use std::sync::Arc;

/// A connector to be added to a world, with all that acts on its free coordinate: of a pin the angle of body b less that of
/// body a [rad], whole turns counted; of a slider the displacement of b along the axis, and of a slot that along its normal turned by
/// -90 degrees [m].
///
/// ```
/// use halfgap::geometry::{DVec2, Shape};
/// use halfgap::{BodyId, BodySpec, BodyState, Connector, ConnectorKind, ConnectorSpec, Limits, WorldBuilder};
///
/// // A door of 2 kg that is pushed, and comes to its stop.
/// let mut builder = WorldBuilder::default();
/// let state = BodyState { angular_velocity: 1.0, velocity: DVec2::new(0.0, 0.5), ..BodyState::default() };
/// let door = builder.add(BodySpec::movable("door", Shape::block(1.0, 0.04)?, 2.0, state));
/// let hinge = DVec2::new(-0.5, 0.0);
/// let (a, b) = (builder.anchor(BodyId::WORLD, hinge), builder.anchor(door, hinge));
/// let pin = Connector::new(ConnectorKind::Pin { a, b }, 0.0)?;
/// let stop = Limits { upper: Some(0.5), ..Limits::default() };
/// builder.add_connector(ConnectorSpec::new(pin).limits(stop));
/// let mut world = builder.build()?;
/// world.advance_to(1.0, &mut |_| ())?;
/// assert!((world.state(door).angle - 0.5).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ConnectorSpec {
    /// Name in messages, if it has one.
    pub name: Option<String>,
    /// The connector. Angles and places that it keeps, as a weld or a gear does, are those that the bodies have at the start.
    pub connector: Connector,
    /// Whether the bodies collide with each other even if a pin, slot, weld or slider joins them.
    pub collide: bool,
    /// Whether body b, or body a if b is missing or fixed, is moved to satisfy the connector before the start.
    pub align: bool,
    /// What acts on the free coordinate.
    pub on_coordinate: OnCoordinate,
}

/// What acts on the free coordinate of a pin, slot or slider.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OnCoordinate {
    /// A motor.
    pub motor: Option<Motor>,
    /// Dry friction of this size [N m, or N of a slot or slider].
    pub friction: Option<f64>,
    /// Bounds.
    pub limits: Option<Limits>,
    /// A law of motion, which the coordinate follows from its value at the start.
    pub drive: Option<MotionLaw>,
    /// A spring.
    pub spring: Option<JointSpring>,
}

/// A motor: it pulls the coordinate towards a speed, and holds it there while it can. It does nothing in the instant of an impact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motor {
    /// Speed [rad/s or m/s].
    pub speed: f64,
    /// Largest torque [N m] or force [N], finite: what holds whatever it takes is a drive.
    pub max: f64,
}

/// Bounds of a coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Lower bound [rad or m], if there is one.
    pub lower: Option<f64>,
    /// Upper bound [rad or m], if there is one.
    pub upper: Option<f64>,
    /// Coefficient of restitution of both bounds [-].
    pub elasticity: f64,
}

/// A spring and damper on a coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointSpring {
    /// Coordinate at which it has no force [rad or m].
    pub rest: f64,
    /// Stiffness [N m or N/m].
    pub stiffness: f64,
    /// Damping [N m s or N s/m].
    pub damping: f64,
}

impl ConnectorSpec {
    /// Makes a connector with the defaults: bodies joined by a pin, slot, weld or slider do not collide, none is aligned, and nothing
    /// acts on the free coordinate.
    #[must_use]
    pub fn new(connector: Connector) -> Self {
        Self { name: None, connector, collide: false, align: false, on_coordinate: OnCoordinate::default() }
    }

    /// The same with a name, which messages tell.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// The same with a motor on its free coordinate.
    #[must_use]
    pub fn motor(mut self, motor: Motor) -> Self {
        self.on_coordinate.motor = Some(motor);
        self
    }

    /// The same with dry friction on its free coordinate [N m, or N of a slot or slider].
    #[must_use]
    pub fn friction(mut self, most: f64) -> Self {
        self.on_coordinate.friction = Some(most);
        self
    }

    /// The same with bounds of its free coordinate.
    #[must_use]
    pub fn limits(mut self, limits: Limits) -> Self {
        self.on_coordinate.limits = Some(limits);
        self
    }

    /// The same with a free coordinate that follows a law of motion.
    #[must_use]
    pub fn drive(mut self, law: MotionLaw) -> Self {
        self.on_coordinate.drive = Some(law);
        self
    }

    /// The same with a spring on its free coordinate.
    #[must_use]
    pub fn spring(mut self, spring: JointSpring) -> Self {
        self.on_coordinate.spring = Some(spring);
        self
    }

    /// True if the connector keeps its bodies from colliding: a pin, slot, weld or slider without `collide`.
    pub(crate) fn keeps_from_colliding(&self) -> bool {
        let joins = matches!(
            self.connector.kind,
            ConnectorKind::Pin { .. }
                | ConnectorKind::Slot { .. }
                | ConnectorKind::Weld { .. }
                | ConnectorKind::Slider { .. }
        );
        joins && !self.collide
    }

    /// The connectors that act on its free coordinate.
    ///
    /// # Errors
    /// A number out of its range, or a connector without a free coordinate on which something acts.
    pub(crate) fn parts(&self) -> Result<Vec<Connector>, ConnectorError> {
        let OnCoordinate { motor, friction, limits, drive, spring } = &self.on_coordinate;
        let Some(coordinate) = self.connector.coordinate() else {
            let is_plain = self.on_coordinate == OnCoordinate::default();
            return if is_plain { Ok(Vec::new()) } else { Err(ConnectorError::NoCoordinate) };
        };
        let mut kinds = Vec::new();
        if let Some(law) = drive {
            kinds.push((ConnectorKind::Drive { coordinate, law: law.clone(), at: 0.0 }, 0.0));
        }
        if let Some(Limits { lower, upper, elasticity }) = *limits {
            if let (Some(lower), Some(upper)) = (lower, upper)
                && lower > upper
            {
                return Err(ConnectorError::CrossedLimits { lower, upper });
            }
            let bounds = [(lower, false), (upper, true)].into_iter();
            let bounds = bounds.filter_map(|(at, upper)| Some((at?, upper)));
            kinds.extend(
                bounds.map(|(at, upper)| (ConnectorKind::Limit { coordinate, at, upper }, elasticity)),
            );
        }
        if let Some(Motor { speed, max }) = *motor {
            kinds.push((ConnectorKind::Pull { coordinate, speed, most: max }, 0.0));
        }
        if let Some(most) = *friction {
            kinds.push((ConnectorKind::Pull { coordinate, speed: 0.0, most }, 0.0));
        }
        let numbers = spring.map_or([0.0; 3], |spring| [spring.rest, spring.stiffness, spring.damping]);
        if !numbers.iter().all(|number| number.is_finite()) {
            return Err(ConnectorError::NotFinite);
        }
        kinds.into_iter().map(|(kind, elasticity)| Connector::new(kind, elasticity)).collect()
    }

    /// The force laws of the spring on its free coordinate, with a name for messages.
    pub(crate) fn springs(&self, name: &str) -> Vec<Arc<dyn ForceLaw>> {
        let (Some(coordinate), Some(spring)) = (self.connector.coordinate(), self.on_coordinate.spring)
        else {
            return Vec::new();
        };
        let JointSpring { rest, stiffness, damping } = spring;
        let mut laws: Vec<Arc<dyn ForceLaw>> = Vec::new();
        if stiffness != 0.0 {
            laws.push(Arc::new(CoordinateSpring::new(name, coordinate, rest, stiffness)));
        }
        if damping != 0.0 {
            laws.push(Arc::new(CoordinateDamper::new(name, coordinate, damping)));
        }
        laws
    }
}

/// Name of a kind of connector in messages and scene files, one of [`KIND_NAMES`].
pub(crate) type KindName = &'static str;

/// Names of all kinds of connectors.
pub(crate) const KIND_NAMES: [KindName; 14] = [
    "pin",
    "slot",
    "rod",
    "rope",
    "rail",
    "rail_stop",
    "weld",
    "slider",
    "gear",
    "rack",
    "pulley",
    "limits",
    "drive",
    "motor",
];

/// Returns the name of a kind of connector.
pub(crate) fn kind_name(kind: &ConnectorKind) -> KindName {
    let place = match kind {
        ConnectorKind::Pin { .. } => 0,
        ConnectorKind::Slot { .. } => 1,
        ConnectorKind::Rod { .. } => 2,
        ConnectorKind::Rope { .. } => 3,
        ConnectorKind::Rail { .. } => 4,
        ConnectorKind::RailStop { .. } => 5,
        ConnectorKind::Weld { .. } => 6,
        ConnectorKind::Slider { .. } => 7,
        ConnectorKind::Gear { .. } => 8,
        ConnectorKind::Rack { .. } => 9,
        ConnectorKind::Pulley { .. } => 10,
        ConnectorKind::Limit { .. } => 11,
        ConnectorKind::Drive { .. } => 12,
        ConnectorKind::Pull { .. } => 13,
    };
    KIND_NAMES[place]
}
