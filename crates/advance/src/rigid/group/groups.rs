//! All groups by their leaders, with the buffers from which their motion is computed.

use crate::ode::Method;
use crate::rigid::bodies::assembly::{Assembly, Shared};
use crate::rigid::connectors::store::Connectors;
use crate::rigid::forest::Forest;
use crate::rigid::group::brief::Past;
use crate::rigid::group::dynamics::{Dynamics, Stage};
use crate::rigid::group::physics::physics;
use crate::rigid::group::state::Group;
use crate::rigid::group::stepping::Steppers;
use crate::rigid::group::tools::Tools;
use halfgap_collision::{BodyId, Moving};
use halfgap_contact::InverseInertia;

/// All groups by their leaders, and the buffers of their making.
#[derive(Clone, Debug)]
pub(crate) struct Groups {
    /// Group of each leader.
    pub(crate) by_leader: Vec<Option<Box<Group>>>,
    /// Cleared groups to be used again.
    #[expect(clippy::vec_box, reason = "groups go from here to `by_leader` without being copied")]
    pub(crate) pool: Vec<Box<Group>>,
    /// Steps and depth of each body's last group.
    pub(crate) past_of: Vec<Past>,
    /// Places of a region, in sets that share their steps.
    pub(crate) coupled: Forest,
    /// True for places of a region that need an integrator.
    pub(crate) integrated: Vec<bool>,
    /// Leader of the group whose dense output is deferred until it is read.
    pub(crate) waiting: Option<BodyId>,
    /// Leaders of the groups that were made last.
    pub(crate) made: Vec<BodyId>,
    /// Bodies of the group that was extended last.
    pub(crate) extended: Vec<BodyId>,
    pub(crate) stage: Stage,
    pub(crate) steppers: Steppers,
    pub(crate) error_scales: Vec<f64>,
    /// Inertias of the bodies of a group that starts.
    pub(crate) inertias: Vec<InverseInertia>,
}

impl Groups {
    /// No groups of bodies that move like this.
    pub(crate) fn new(movings: Vec<Moving>, method: Method) -> Self {
        let count = movings.len();
        Self {
            by_leader: (0..count).map(|_| None).collect(),
            past_of: vec![Past::default(); count],
            pool: Vec::new(),
            coupled: Forest::default(),
            integrated: Vec::new(),
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
