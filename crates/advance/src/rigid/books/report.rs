//! Reports that callers may ask for: forces of rows, contacts that begin and end.

use crate::rigid::error::AdvanceError;
use crate::rigid::surface::{RowFriction, RowRolling};
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, Collision, ConnectorId};
use halfgap_geometry::FeatureId;

/// Force of one active row: a contact, or one direction of a connector.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct RowForce {
    /// The primary and the normal body.
    pub bodies: [BodyId; 2],
    /// The connector; `None` for bodies that touch.
    pub connector: Option<ConnectorId>,
    /// The features that touch; `None` in a connector.
    pub features: Option<[FeatureId; 2]>,
    /// Point of the primary body at which the force acts, in world coordinates [m]; `None` for a row that is a torque.
    pub point: Option<DVec2>,
    /// Unit normal in world directions, from the normal to the primary body; zero for a row that is a torque.
    pub normal: DVec2,
    /// Force on the primary body along the normal [N]: positive pushes the bodies apart. 0 for a row that is a torque.
    pub force: f64,
    /// Torque on the primary body [N m], counter-clockwise positive, of a row that is a torque.
    pub torque: Option<f64>,
    /// Friction at a contact whose surfaces have some.
    pub friction: Option<RowFriction>,
    /// Rolling resistance at a contact whose surfaces have some.
    pub rolling: Option<RowRolling>,
    /// Heat [J] that the contact has made by slip and rolling since it began; `None` where its surfaces resist neither, and in steps.
    pub heat: Option<f64>,
    /// Change of the kinetic energy [J] at a contact by a jump of velocities: see [`ContactChanges::jam`].
    pub jump: Option<f64>,
    /// Duration [s] of the geometric series of bounces, too slow to be resolved, that would have followed under
    /// constant acceleration, of a contact that begins with an impact; `None` where there is no such series.
    pub bouncing: Option<f64>,
}

impl RowForce {
    /// A force [N] along a row whose point and normal are given, with the coefficient [m] of the primary body's rotation: a row without
    /// a normal is a torque. Nothing else is told yet.
    pub(crate) fn along(
        bodies: [BodyId; 2],
        origin: (Option<ConnectorId>, Option<[FeatureId; 2]>),
        (point, normal, turning): (DVec2, DVec2, f64),
        force: f64,
    ) -> Self {
        let is_torque = normal == DVec2::ZERO;
        Self {
            bodies,
            connector: origin.0,
            features: origin.1,
            point: (!is_torque).then_some(point),
            normal,
            force: if is_torque { 0.0 } else { force },
            torque: is_torque.then_some(turning * force),
            friction: None,
            rolling: None,
            heat: None,
            jump: None,
            bouncing: None,
        }
    }

    fn is_same(&self, other: &RowForce) -> bool {
        self.bodies == other.bodies && self.connector == other.connector && self.features == other.features
    }
}

/// Outcome of the last event, for callers that ask.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Told {
    pub(super) last_impact: ImpactReport,
    /// True if the event contained an impact.
    pub(super) has_hit: bool,
    pub(super) changes: ContactChanges,
    /// Error of the event, if it could not be handled.
    pub(super) failure: Option<AdvanceError>,
    /// Buffer: whether each row that begins has only gone on.
    pub(super) goes_on: Vec<bool>,
}

/// Unilateral rows (contacts, ropes, stops) whose holding begins or ends in one event.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactChanges {
    /// Time of the event.
    pub time: Time,
    /// Rows that are active from this event on.
    pub begin: Vec<RowForce>,
    /// Rows that are active no longer, each with its last force.
    pub end: Vec<RowForce>,
    /// Contacts that go on, but stick from this event on where they have slipped, or slip where they have stuck.
    pub turn: Vec<RowForce>,
    /// Contacts that jam: as they slip there are no forces, and velocities jump. One for each contact, and each of several jumps, that changes
    /// the energy.
    pub jam: Vec<RowForce>,
    /// Contacts that slip and whose motion is not unique: they part, but might as well be pressed together by their own friction.
    pub undecided: Vec<RowForce>,
}

impl Told {
    /// Begins an event at a time.
    pub(super) fn begin(&mut self, time: Time) {
        self.has_hit = false;
        self.changes.clear(time);
    }

    /// Drops rows that end only to begin at once.
    pub(crate) fn drop_continued(&mut self) {
        self.changes.drop_continued(&mut self.goes_on);
    }
}

impl ContactChanges {
    /// True if there is nothing to tell.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        let Self { begin, end, turn, jam, undecided, .. } = self;
        [begin, end, turn, jam, undecided].into_iter().all(Vec::is_empty)
    }

    pub(crate) fn clear(&mut self, time: Time) {
        self.time = time;
        self.begin.clear();
        self.end.clear();
        self.turn.clear();
        self.jam.clear();
        self.undecided.clear();
    }

    /// Drops rows that end only to begin at once, and notes which of them stick or slip now where they did not. Those in both lists mostly have one order, so each search begins
    /// where the last one ended.
    fn drop_continued(&mut self, goes_on: &mut Vec<bool>) {
        let Self { begin, turn, .. } = self;
        let sticks = |row: &RowForce| row.friction.map(|friction| friction.sticks);
        goes_on.clear();
        goes_on.resize(begin.len(), false);
        let mut next = 0;
        self.end.retain(|old| {
            let mut places = (next..begin.len()).chain(0..next);
            let found = places.find(|&place| !goes_on[place] && begin[place].is_same(old));
            if let Some(place) = found {
                goes_on[place] = true;
                next = place + 1;
                if sticks(&begin[place]) != sticks(old) {
                    turn.push(begin[place]);
                }
            }
            found.is_none()
        });
        let mut flags = goes_on.iter();
        begin.retain(|_| flags.next() != Some(&true));
    }
}

/// Report of a handled event: an impact, or contacts that begin or end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Handled {
    /// Time of the event.
    pub time: Time,
    /// True for an impact, which [`RigidSystem::last_impact`] reports; [`RigidSystem::contact_changes`] lists the
    /// contacts that begin or end.
    pub impact: bool,
}

/// Report of one row of an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct RowReport {
    /// Collision record of the row, with its impulse.
    pub collision: Collision,
    /// Rate of the gap before the impact [m/s]; negative closes.
    pub rate_before: f64,
    /// Rate of the gap after the impact [m/s]; negative closes.
    pub rate_after: f64,
    /// Impulse on the primary body along the normal [N s]: positive pushes the bodies apart.
    pub impulse: f64,
}

/// Report of an impact.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ImpactReport {
    /// Time of the impact.
    pub time: Time,
    /// The rows that carried an impulse.
    pub rows: Vec<RowReport>,
    /// Change of the kinetic energy [J]: the sum of j (v- + v+)/2 over the rows, and over the slips of those with friction, and what
    /// running surfaces and moved bodies do.
    pub energy_change: f64,
    /// What of it is the loss by friction [J], at most 0.
    pub friction_change: f64,
    /// What of it is the work of surfaces that run [J].
    pub surface_work: f64,
    /// What of it is the work of bodies that are moved [J].
    pub drive_work: f64,
    /// States after the impact of the movable bodies on which an impulse acted.
    pub states: Vec<(BodyId, BodyState)>,
}

impl ImpactReport {
    /// Begins the report of an impact at a time.
    pub(crate) fn begin(&mut self, time: Time) {
        (self.time, self.energy_change) = (time, 0.0);
        (self.friction_change, self.surface_work, self.drive_work) = (0.0, 0.0, 0.0);
        self.rows.clear();
        self.states.clear();
    }

    /// Adds a row and its change of the kinetic energy [J].
    pub(crate) fn add(&mut self, row: RowReport, energy: f64) {
        self.rows.push(row);
        self.energy_change += energy;
    }

    /// Adds the friction of a row: its change of the kinetic energy [J], and what surfaces that run did of it.
    pub(crate) fn add_friction(&mut self, energy: f64, surface_work: f64) {
        self.energy_change += energy;
        self.surface_work += surface_work;
    }

    /// Adds the work [J] of moved bodies at a row.
    pub(crate) fn add_drive(&mut self, work: f64) {
        self.energy_change += work;
        self.drive_work += work;
    }

    /// Sets the loss by friction [J].
    pub(crate) fn set_friction_loss(&mut self, loss: f64) {
        self.friction_change = -loss;
    }

    /// Adds states of bodies after the impact.
    pub(crate) fn add_states(&mut self, states: impl Iterator<Item = (BodyId, BodyState)>) {
        self.states.extend(states);
    }
}

impl Told {
    /// The changes.
    #[inline]
    pub(crate) fn changes(&self) -> &ContactChanges {
        &self.changes
    }

    /// Error of the event, if it could not be handled.
    #[inline]
    pub(crate) fn failure(&self) -> &Option<AdvanceError> {
        &self.failure
    }

    /// True if the event contained an impact.
    #[inline]
    pub(crate) fn has_hit(&self) -> bool {
        self.has_hit
    }

    /// The last impact.
    #[inline]
    pub(crate) fn last_impact(&self) -> &ImpactReport {
        &self.last_impact
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    fn of(body: u32) -> RowForce {
        RowForce::along([BodyId(0), BodyId(body)], (None, None), (DVec2::ZERO, DVec2::Y, 0.0), 1.0)
    }

    #[test]
    fn a_contact_that_ends_only_to_begin_at_once_is_no_change_in_whatever_order() {
        let mut changes = ContactChanges {
            begin: [1, 2, 3, 4].map(of).to_vec(),
            end: [3, 5, 1, 4].map(of).to_vec(),
            ..ContactChanges::default()
        };
        changes.drop_continued(&mut Vec::new());
        assert!(changes.turn.is_empty());
        assert_eq!(changes.begin, [of(2)]);
        assert_eq!(changes.end, [of(5)]);
    }

    #[test]
    fn a_contact_that_goes_on_and_sticks_now_is_told() {
        let gripped = |body: u32, sticks: bool| {
            let friction = RowFriction { force: 0.1, slip_speed: 0.0, most: 0.3, sticks };
            RowForce { friction: Some(friction), ..of(body) }
        };
        let mut changes = ContactChanges {
            begin: vec![gripped(1, true), gripped(2, false), gripped(3, true)],
            end: vec![gripped(2, false), gripped(1, false)],
            ..ContactChanges::default()
        };
        changes.drop_continued(&mut Vec::new());
        assert_eq!((changes.turn.len(), changes.begin.len(), changes.end.len()), (1, 1, 0));
        assert_eq!((changes.turn[0], changes.begin[0]), (gripped(1, true), gripped(3, true)));
    }
}
