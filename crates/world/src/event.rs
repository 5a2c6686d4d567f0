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
    /// A contact that has stuck slips from now on.
    Slips(ContactEvent),
    /// A contact that has slipped sticks from now on.
    Sticks(ContactEvent),
    /// A contact that slips jams: no forces would let it go on, so that velocities jump, without any collision. Told of each contact at which
    /// that changes the energy.
    Jams(ContactEvent),
    /// A contact that slips may go on in several ways: without a force it parts, but its own friction might as well press it together. Told
    /// where no other contact or connector acts on its bodies.
    Undecided(ContactEvent),
}

impl Event {
    /// Time of the event [s].
    #[must_use]
    pub fn time(&self) -> f64 {
        match self {
            Self::Impact(impact) => impact.time,
            Self::ContactBegins(contact)
            | Self::ContactEnds(contact)
            | Self::Slips(contact)
            | Self::Sticks(contact)
            | Self::Jams(contact)
            | Self::Undecided(contact) => contact.time,
        }
    }

    /// The impact; `None` for other events.
    #[must_use]
    pub fn impact(&self) -> Option<&Impact> {
        match self {
            Self::Impact(impact) => Some(impact),
            Self::ContactBegins(_)
            | Self::ContactEnds(_)
            | Self::Slips(_)
            | Self::Sticks(_)
            | Self::Jams(_)
            | Self::Undecided(_) => None,
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
    /// World position [m] at which the impulse acts on the primary body; `None` for a torque, whose gap is an angle [rad], with rates
    /// [rad/s] and an angular impulse [N m s].
    pub point: Option<DVec2>,
    /// Unit normal, from the normal body to the primary one; zero for a torque.
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
    /// World position [m] at which the force acts on the first body; `None` for a torque, which has no point.
    pub point: Option<DVec2>,
    /// Unit normal, from `bodies[1]` to `bodies[0]`; zero for a torque.
    pub normal: DVec2,
    /// Force on `bodies[0]` along the normal [N], negative only in bilateral connectors; `bodies[1]` gets the opposite, but where a
    /// connector turns forces: the wheel of a rack gets a torque. 0 for a torque.
    pub force: f64,
    /// Torque on `bodies[0]` [N m], counter-clockwise positive, of a row of a connector that is a torque: of a weld, a slider or a gear, and of
    /// what acts on the angle of a pin. `bodies[1]` gets the opposite, but in a gear.
    pub torque: Option<f64>,
    /// Friction, of a contact whose surfaces have some, in an advance by events.
    pub friction: Option<ContactFriction>,
    /// Moment of rolling resistance on `bodies[0]` [N m], counter-clockwise positive, of a contact whose surfaces have some, in an advance by events;
    /// `bodies[1]` gets the opposite.
    pub rolling_moment: Option<f64>,
    /// Heat [J] that the contact has made by slip and rolling since it began, at least 0, of a contact whose surfaces have friction or rolling
    /// resistance, in an advance by events. Those of all contacts, past ones as they ended, are together what the ledger's `friction` took.
    pub heat: Option<f64>,
}

/// Friction at a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactFriction {
    /// Force on `bodies[0]` along the normal turned by +90 degrees [N]; `bodies[1]` gets the opposite.
    pub force: f64,
    /// Slip speed [m/s] of the surface of `bodies[0]` against that of `bodies[1]`, along the same direction; 0 if the contact sticks.
    pub slip_speed: f64,
    /// Largest friction [N] that the contact can bear, sticking or slipping as it does.
    pub most: f64,
    /// True if it sticks.
    pub sticks: bool,
}

impl ContactFriction {
    /// Friction as a share of what the contact can bear [-]: 1 of one that slips.
    #[must_use]
    pub fn cone_use(&self) -> f64 {
        if self.most > 0.0 { self.force.abs() / self.most } else { 0.0 }
    }

    /// Name of what the contact does: "stick", "slip+" or "slip-", by the sign of its slip; friction on the body goes the other way.
    #[must_use]
    pub fn mode(&self) -> &'static str {
        let goes_up = if self.force == 0.0 { self.slip_speed >= 0.0 } else { self.force < 0.0 };
        match (self.sticks, goes_up) {
            (true, _) => "stick",
            (false, true) => "slip+",
            (false, false) => "slip-",
        }
    }
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
    /// Change of the kinetic energy [J] by a contact that [jams](Event::Jams), negative where energy was lost; `None` for other events. Those of all
    /// jams are together the ledger's `jams`.
    pub energy_change: Option<f64>,
}
