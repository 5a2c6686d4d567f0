//! All groups by their leaders, with the buffers from which their motion is computed.

use crate::ode::Method;
use crate::rigid::bodies::assembly::{Assembly, Shared};
use crate::rigid::connectors::store::Connectors;
use crate::rigid::group::brief::Past;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::physics::physics;
use crate::rigid::group::stage::Stage;
use crate::rigid::group::state::Group;
use crate::rigid::group::stepping::Steppers;
use crate::rigid::group::tools::Tools;
use crate::time::Time;
use halfgap_collision::{BodyId, Moving};
use halfgap_contact::InverseInertia;

/// All groups by their leaders, and the buffers of their making.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Groups {
    /// Group of each leader.
    pub(super) by_leader: Vec<Option<Box<Group>>>,
    /// Cleared groups to be used again.
    #[cfg_attr(feature = "save", serde(skip))]
    #[expect(clippy::vec_box, reason = "groups go from here to `by_leader` without being copied")]
    pub(super) pool: Vec<Box<Group>>,
    /// Steps and depth of each body's last group.
    pub(super) past_of: Vec<Past>,
    /// Leader of the group whose dense output is deferred until it is read.
    pub(super) waiting: Option<BodyId>,
    /// Leaders of the groups that were made last.
    pub(super) made: Vec<BodyId>,
    /// Bodies of the group that was extended last.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) extended: Vec<BodyId>,
    pub(super) stage: Stage,
    pub(super) steppers: Steppers,
    pub(super) error_scales: Vec<f64>,
    /// Inertias of the bodies of a group that starts.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) inertias: Vec<InverseInertia>,
}

impl Groups {
    /// Begins the making of groups.
    pub(crate) fn begin_making(&mut self) {
        self.made.clear();
    }

    /// Notes the leader of a group that has been made.
    pub(crate) fn note_made(&mut self, leader: BodyId) {
        self.made.push(leader);
    }

    /// An empty group.
    pub(crate) fn take_empty(&mut self) -> Box<Group> {
        let mut group = self.pool.pop().unwrap_or_default();
        group.clear();
        group
    }

    /// Keeps a group that has ended, to be used again.
    pub(crate) fn recycle(&mut self, mut group: Box<Group>) {
        group.clear();
        self.pool.push(group);
    }

    /// Notes the experience with the group of a body, which ends now.
    pub(crate) fn note_past(&mut self, body: BodyId, group: &Group, now: Time) {
        self.past_of[body.index()] = Past::of(group, now);
    }

    /// Takes out the buffer of inertias, emptied.
    pub(crate) fn take_inertias(&mut self) -> Vec<InverseInertia> {
        let mut inertias = std::mem::take(&mut self.inertias);
        inertias.clear();
        inertias
    }

    /// Puts back the buffer of inertias.
    pub(crate) fn put_inertias(&mut self, inertias: Vec<InverseInertia>) {
        self.inertias = inertias;
    }

    /// Takes out the buffer for the bodies of a group that is extended, emptied.
    pub(crate) fn take_extended(&mut self) -> Vec<BodyId> {
        let mut extended = std::mem::take(&mut self.extended);
        extended.clear();
        extended
    }

    /// Puts back that buffer.
    pub(crate) fn put_extended(&mut self, extended: Vec<BodyId>) {
        self.extended = extended;
    }

    /// Takes out the buffers of evaluations.
    pub(crate) fn take_stage(&mut self) -> Stage {
        std::mem::take(&mut self.stage)
    }

    /// Puts back the buffers of evaluations.
    pub(crate) fn put_stage(&mut self, stage: Stage) {
        self.stage = stage;
    }

    /// Sets the motion of a body for evaluations.
    pub(crate) fn place(&mut self, body: BodyId, moving: Moving) {
        self.stage.place(body, moving);
    }

    /// Postpones the dense output of the group with this leader.
    pub(crate) fn defer(&mut self, leader: BodyId) {
        self.waiting = Some(leader);
    }

    /// Drops the postponed dense output of the group with this leader, if it is that.
    pub(crate) fn skip(&mut self, leader: BodyId) {
        if self.waiting == Some(leader) {
            self.waiting = None;
        }
    }

    /// Takes out the group whose dense output is postponed, if there is one.
    pub(crate) fn take_waiting(&mut self) -> Option<Box<Group>> {
        let leader = self.waiting.take()?;
        self.take(leader)
    }

    /// Notes that the place to which the point of a stop has come is known, of the group with this leader.
    pub(crate) fn note_stop(&mut self, leader: BodyId, place: usize) {
        if let Some(group) = self.by_leader[leader.index()].as_deref_mut() {
            group.note_stop(place);
        }
    }

    /// No groups of bodies that move like this.
    pub(crate) fn new(movings: Vec<Moving>, method: Method) -> Self {
        let count = movings.len();
        Self {
            by_leader: (0..count).map(|_| None).collect(),
            past_of: vec![Past::default(); count],
            pool: Vec::new(),
            waiting: None,
            made: Vec::new(),
            inertias: Vec::new(),
            extended: Vec::new(),
            stage: Stage::new(movings),
            steppers: Steppers::new(method),
            error_scales: Vec::new(),
        }
    }

    /// Takes a group out to work on it.
    pub(crate) fn take(&mut self, leader: BodyId) -> Option<Box<Group>> {
        self.by_leader[leader.index()].take()
    }
}

/// The group of a body, if it is in one.
pub(crate) fn group_of<'a>(assembly: &Assembly, groups: &'a Groups, body: BodyId) -> Option<&'a Group> {
    let leader = assembly.leader_of()[body.index()]?;
    groups.by_leader[leader.index()].as_deref()
}

/// Runs an action on a group with its dynamics and its stepper.
pub(crate) fn with_group<T>(
    assembly: &Assembly,
    connectors: &Connectors,
    groups: &mut Groups,
    group: &mut Group,
    act: impl FnOnce(&mut Dynamics<'_>, &mut Tools<'_>) -> T,
) -> T {
    let Groups { stage, steppers, error_scales: scales, .. } = groups;
    let settings = assembly.settings();
    let physics = physics(assembly, connectors);
    let (start, stepper) = (group.start, steppers.of(group.stepping()));
    act(&mut Dynamics { physics, group, stage, start }, &mut Tools { stepper, scales, settings })
}

/// Puts a group back, and tells the bodies and the connectors what they share with it.
pub(crate) fn put_group(
    assembly: &mut Assembly,
    connectors: &mut Connectors,
    groups: &mut Groups,
    group: Box<Group>,
) {
    let leader = group.leader();
    let shared = Shared { end: group.end(), depth: group.depth(), largest_error: group.largest_error };
    assembly.share(leader, shared);
    for stop in &group.stops {
        connectors.watch(stop, group.start);
    }
    groups.by_leader[leader.index()] = Some(group);
}

/// Tells the bodies and the connectors of a group that it is no more.
pub(crate) fn part(assembly: &mut Assembly, connectors: &mut Connectors, group: &Group) {
    for &body in &group.bodies {
        assembly.part(body);
    }
    for stop in &group.stops {
        connectors.unwatch(stop.id);
    }
}

impl Groups {
    /// Group of each leader.
    #[inline]
    pub(crate) fn by_leader(&self) -> &[Option<Box<Group>>] {
        &self.by_leader
    }

    /// Leaders of the groups that were made last.
    #[inline]
    pub(crate) fn made(&self) -> &[BodyId] {
        &self.made
    }

    /// The stage.
    #[inline]
    pub(crate) fn stage(&self) -> &Stage {
        &self.stage
    }
}
