//! The kinds of connectors, with their points and numbers.

use super::coordinate::Coordinate;
use super::error::ConnectorError;
use super::path::RailPath;
use super::{Anchor, SlotFrame};
use crate::body::BodyId;
use crate::motion_law::MotionLaw;
use glam::DVec2;
use std::sync::Arc;

/// Kind of a connector, with its points and numbers.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum ConnectorKind {
    /// Keeps two points together.
    Pin {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
    },
    /// Keeps two points together along one direction.
    Slot {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
        /// Direction along which the points stay together, a unit vector in `frame`.
        normal: DVec2,
        /// Frame of the direction.
        frame: SlotFrame,
    },
    /// Keeps two points exactly a length apart.
    Rod {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
        /// Length [m].
        length: f64,
    },
    /// Keeps two points at most a length apart.
    Rope {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
        /// Length [m].
        length: f64,
    },
    /// Keeps a point on a path that is fixed in the world. An open path goes on straight beyond its ends, unless a stop ends
    /// it. At a corner of the path the point loses the velocity across the piece that it goes on along, whatever the
    /// elasticity of the connector, and stays there if that piece leads back.
    Rail {
        /// Point of body a.
        a: Anchor,
        /// Path in world coordinates.
        path: Arc<RailPath>,
    },
    /// Keeps a point on one side of a place of a rail, at which the rail ends.
    RailStop {
        /// Point of body a that is on the rail.
        a: Anchor,
        /// Path of the rail.
        path: Arc<RailPath>,
        /// Arc length [m] from the path's first point at which the rail ends.
        at: f64,
        /// True if the rail ends above `at`, so that the point stays at or below it; false for the other way round.
        upper: bool,
    },
    /// Lets two bodies move in no way against each other: keeps two points together, and the bodies from turning.
    Weld {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
        /// Angle of body b less that of body a, which is kept.
        turn: Turn,
    },
    /// Lets a point of body b move along a line through one of body a, and keeps the bodies from turning against each other.
    Slider {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
        /// Direction of the line, a unit vector in `frame`.
        axis: DVec2,
        /// Frame of the direction.
        frame: SlotFrame,
        /// Angle of body b less that of body a, which is kept.
        turn: Turn,
    },
    /// Keeps the ratio of the angles by which two bodies have turned against a carrier: (angle of a) - (angle of the carrier) =
    /// ratio ((angle of b) - (angle of the carrier)) + a constant.
    Gear {
        /// Body a.
        a: BodyId,
        /// Body b.
        b: BodyId,
        /// Body that carries both, or the background.
        carrier: BodyId,
        /// Turns of a for one turn of b [-], negative for wheels that mesh from outside; not 0.
        ratio: f64,
        /// The sum of the angles that is kept.
        turn: Turn,
    },
    /// Keeps the displacement of a bar's centre of mass along a direction of the world equal to a radius times the angle by which a
    /// wheel has turned in the world. Body a is the bar.
    Rack {
        /// The wheel.
        wheel: BodyId,
        /// The bar.
        bar: BodyId,
        /// Radius [m], negative where the bar moves back as the wheel turns counter-clockwise; not 0.
        radius: f64,
        /// Direction, a unit vector of the world.
        axis: DVec2,
        /// Displacement less what the turn makes of it, which is kept [m].
        at: f64,
    },
    /// A rope over two wheels that are fixed in the world: keeps |a - wheel a| + ratio |b - wheel b| at most a length.
    Pulley {
        /// Point of body a.
        a: Anchor,
        /// Point of body b.
        b: Anchor,
        /// Points of the world [m] from which the rope goes to a and to b.
        wheels: [DVec2; 2],
        /// Length of rope on the side of a for one on that of b [-], positive.
        ratio: f64,
        /// Length [m].
        length: f64,
    },
    /// Keeps a coordinate at or above a bound, or at or below it.
    Limit {
        /// The coordinate.
        coordinate: Coordinate,
        /// The bound [rad or m].
        at: f64,
        /// True if the coordinate stays at or below the bound.
        upper: bool,
    },
    /// Prescribes a coordinate: it is `at` plus what a law of motion tells.
    Drive {
        /// The coordinate.
        coordinate: Coordinate,
        /// The law.
        law: MotionLaw,
        /// What is added to the law's value [rad or m].
        at: f64,
    },
    /// Pulls the rate of a coordinate towards a speed with a bounded force, and holds it there while less will do: a motor,
    /// or at the speed 0 dry friction. Its row is the coordinate's own.
    Pull {
        /// The coordinate.
        coordinate: Coordinate,
        /// Speed [rad/s or m/s].
        speed: f64,
        /// Largest torque [N m] or force [N].
        most: f64,
    },
}

/// An angle, or sum of angles, that a connector keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Turn {
    /// The angle [rad], whole turns counted.
    pub angle: f64,
    /// Length [m] by which the row is made a length; it changes no motion, only what counts as little.
    pub lever: f64,
}

impl ConnectorKind {
    /// The direction that the kind is given by, if it is.
    pub(super) fn direction(&self) -> Option<DVec2> {
        match self {
            Self::Slot { normal, .. } => Some(*normal),
            Self::Slider { axis, .. } | Self::Rack { axis, .. } => Some(*axis),
            Self::Limit { coordinate, .. }
            | Self::Drive { coordinate, .. }
            | Self::Pull { coordinate, .. } => match coordinate {
                Coordinate::Along { axis, .. } => Some(*axis),
                Coordinate::Angle { .. } => None,
            },
            _ => None,
        }
    }

    pub(super) fn direction_mut(&mut self) -> Option<&mut DVec2> {
        match self {
            Self::Slot { normal, .. } => Some(normal),
            Self::Slider { axis, .. } | Self::Rack { axis, .. } => Some(axis),
            Self::Limit { coordinate, .. }
            | Self::Drive { coordinate, .. }
            | Self::Pull { coordinate, .. } => match coordinate {
                Coordinate::Along { axis, .. } => Some(axis),
                Coordinate::Angle { .. } => None,
            },
            _ => None,
        }
    }

    /// The error of a direction that is none.
    pub(super) fn bad_direction(&self, x: f64, y: f64) -> ConnectorError {
        match self {
            Self::Slot { .. } => ConnectorError::BadNormal(x, y),
            _ => ConnectorError::BadAxis(x, y),
        }
    }
}
