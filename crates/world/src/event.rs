//! What a world tells while it advances: impacts, and contacts that begin and end.

use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, ConnectorId};

/// Something that happened at one moment.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Event {
    /// Bodies collided, or a connector pulled tight.
    Impact(Impact),
    /// From now on two bodies rest on each other, a connector that can be slack is taut, or the point of a rail
    /// rests in a corner, by one side of it.
    ContactBegins(ContactEvent),
    /// From now on they do so no longer.
    ContactEnds(ContactEvent),
}

impl Event {
    /// When [s].
    #[must_use]
    pub fn time(&self) -> f64 {
        match self {
            Self::Impact(impact) => impact.time,
            Self::ContactBegins(contact) | Self::ContactEnds(contact) => contact.time,
        }
    }

    /// The impact, if it is one.
    #[must_use]
    pub fn impact(&self) -> Option<&Impact> {
        match self {
            Self::Impact(impact) => Some(impact),
            Self::ContactBegins(_) | Self::ContactEnds(_) => None,
        }
    }
}

/// One place at which two bodies collided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpactRow {
    /// The body that the normal points to.
    pub primary: BodyId,
    /// The body that the normal points out of.
    pub normal_body: BodyId,
    /// The connector that the row is of; `None` for bodies that touch.
    pub connector: Option<ConnectorId>,
    /// Where [m].
    pub point: DVec2,
    /// Unit normal, from the normal body to the primary one.
    pub normal: DVec2,
    /// Gap [m].
    pub gap: f64,
    /// Rate of the gap before [m/s], negative when closing.
    pub velocity_before: f64,
    /// Rate of the gap after [m/s].
    pub velocity_after: f64,
    /// Impulse on the primary body along the normal [N s]; the other body gets the opposite, at that place but for
    /// what [`ContactForce`] says of slots.
    pub impulse: f64,
}

/// An impact: everything that collided at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Impact {
    /// When [s].
    pub time: f64,
    /// Where, and how hard.
    pub rows: Vec<ImpactRow>,
    /// Change of the kinetic energy [J].
    pub energy_change: f64,
    /// States of the movable bodies that took part, after the impact.
    pub states: Vec<(BodyId, BodyState)>,
}

/// The force of one row between two bodies: a contact, or one direction of a connector. Of a slot whose direction is
/// fixed in the world it acts on the second body at that one's own anchor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce {
    /// The body that the normal points to, and the one that it points out of; [`BodyId::WORLD`] for the background.
    pub bodies: [BodyId; 2],
    /// The connector; `None` for bodies that touch.
    pub connector: Option<ConnectorId>,
    /// Where [m].
    pub point: DVec2,
    /// Unit normal.
    pub normal: DVec2,
    /// Force on the first body along the normal [N]; the other body gets the opposite.
    pub force: f64,
}

/// A contact that begins or ends, with its force just then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEvent {
    /// When [s].
    pub time: f64,
    /// Between whom, where and how strong.
    pub contact: ContactForce,
    /// How long [s] the bounces would have gone on that were too slow or too low to be resolved, of a single
    /// contact that begins: the time of rest is this much later.
    pub bouncing: Option<f64>,
}
