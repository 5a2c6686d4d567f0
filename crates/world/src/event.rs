//! Events that a world reports while it advances: impacts, and contacts that begin and end.

use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, ConnectorId};

/// An event at one moment of the motion.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Event {
    /// Bodies collided, or a connector pulled tight.
    Impact(Impact),
    /// A contact begins: two bodies rest or slide on each other, a rope or stop is taut, or the point of a rail rests
    /// in a corner against one side of it.
    ContactBegins(ContactEvent),
    /// A contact, taut connector or rest in a corner ends.
    ContactEnds(ContactEvent),
}

impl Event {
    /// Time of the event [s].
    #[must_use]
    pub fn time(&self) -> f64 {
        match self {
            Self::Impact(impact) => impact.time,
            Self::ContactBegins(contact) | Self::ContactEnds(contact) => contact.time,
        }
    }

    /// The impact; `None` for other events.
    #[must_use]
    pub fn impact(&self) -> Option<&Impact> {
        match self {
            Self::Impact(impact) => Some(impact),
            Self::ContactBegins(_) | Self::ContactEnds(_) => None,
        }
    }
}

/// One place of an impact, with its impulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactRow {
    /// The body that the normal points to.
    pub primary: BodyId,
    /// The body that the normal points out of.
    pub normal_body: BodyId,
    /// The connector whose row this is; `None` for bodies that touch.
    pub connector: Option<ConnectorId>,
    /// World position [m] at which the impulse acts on the primary body.
    pub point: DVec2,
    /// Unit normal, from the normal body to the primary one.
    pub normal: DVec2,
    /// Gap along the normal [m], negative where bodies overlap.
    pub gap: f64,
    /// Rate of the gap before the impact [m/s], negative when closing.
    pub velocity_before: f64,
    /// Rate of the gap after the impact [m/s], negative when closing.
    pub velocity_after: f64,
    /// Impulse on the primary body along the normal [N s], negative only in bilateral connectors; the other body gets
    /// the opposite, at the same point except in slots (see [`ContactForce`]).
    pub impulse: f64,
}

/// An impact: all collisions of one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Impact {
    /// Time of the impact [s].
    pub time: f64,
    /// Rows that carried an impulse.
    pub rows: Vec<ImpactRow>,
    /// Change of the kinetic energy [J], negative where energy was lost.
    pub energy_change: f64,
    /// States, after the impact, of the movable bodies on which an impulse acted.
    pub states: Vec<(BodyId, BodyState)>,
}

/// The force of one row between two bodies: a contact, or one direction of a connector.
///
/// In a slot whose direction is fixed in the world, the force on the second body acts at that body's own anchor instead
/// of at `point`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce {
    /// The body that the normal points to, and the one that it points out of; [`BodyId::WORLD`] for the background.
    pub bodies: [BodyId; 2],
    /// The connector whose row this is; `None` for bodies that touch.
    pub connector: Option<ConnectorId>,
    /// World position [m] at which the force acts on the first body.
    pub point: DVec2,
    /// Unit normal, from `bodies[1]` to `bodies[0]`.
    pub normal: DVec2,
    /// Force on `bodies[0]` along the normal [N], negative only in bilateral connectors; `bodies[1]` gets the opposite.
    pub force: f64,
}

/// A contact that begins or ends, with its force at that moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEvent {
    /// Time of the event [s].
    pub time: f64,
    /// Bodies, place and force of the contact.
    pub contact: ContactForce,
    /// Time [s], 2 e v/(a(1-e)), that the bounces left out as too small to resolve would have taken, with elasticity e,
    /// closing speed v at the last impact and acceleration a: the true time of rest is `time + bouncing`. Only for a
    /// single contact that begins with an impact.
    pub bouncing: Option<f64>,
}
