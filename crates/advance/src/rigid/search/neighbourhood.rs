//! Data of the search for contacts beside the pairs: where bodies may be, which of them may meet, and the first contact
//! known of each.

use crate::rigid::bodies::trajectory::Trajectory;
use crate::rigid::contacts::pairs::{Link, PairId};
use crate::rigid::search::boxes::Room;
use crate::rigid::search::lane::Lane;
use crate::rigid::search::marks::Marks;
use crate::rigid::settings::RigidSettings;
use crate::time::Time;
use halfgap_collision::{BodyId, BroadPhase};

/// Bodies as the search sees them, with its buffers.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Neighbourhood {
    /// Motion and size of each body, as predictions read them.
    pub(super) lanes: Vec<Lane>,
    /// Room of each body in the broad phase.
    pub(super) rooms: Vec<Room>,
    pub(super) broad: BroadPhase,
    /// Time of the first contact known of each body, or of the group that it leads.
    pub(super) first_contacts: Vec<Time>,
    /// Pairs that never collide, the lesser id first, sorted.
    pub(super) excluded: Vec<(BodyId, BodyId)>,
    /// True for bodies that no other body can collide with.
    pub(super) loners: Vec<bool>,
    /// Buffer: pairs whose rules or predictions an event changes.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) touched: Vec<PairId>,
    /// Buffer: links of a body.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) links: Vec<Link>,
    /// Buffer: bodies near a body.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) neighbours: Vec<BodyId>,
    /// Buffer: which of these are known already.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) marks: Marks,
}

impl Neighbourhood {
    /// Copies the present motion of a body, whose box stays as it is.
    pub(crate) fn follow(&mut self, trajectory: &Trajectory, body: BodyId) {
        self.lanes[body.index()].follow(trajectory);
    }

    /// Sets the gap [m] at which a body fires.
    pub(crate) fn set_trigger_gap(&mut self, body: BodyId, trigger_gap: f64) {
        self.lanes[body.index()].set_trigger_gap(trigger_gap);
    }

    /// Takes out the buffer of pairs.
    pub(crate) fn take_touched(&mut self) -> Vec<PairId> {
        let mut touched = std::mem::take(&mut self.touched);
        touched.clear();
        touched
    }

    /// Puts back the buffer of pairs.
    pub(crate) fn put_touched(&mut self, touched: Vec<PairId>) {
        self.touched = touched;
    }

    /// Sets up the search for bodies; the broad phase is still empty.
    pub(crate) fn new(
        trajectories: &[Trajectory],
        mut excluded: Vec<(BodyId, BodyId)>,
        settings: &RigidSettings,
    ) -> Self {
        excluded.iter_mut().for_each(|pair| *pair = (pair.0.min(pair.1), pair.0.max(pair.1)));
        excluded.sort_unstable();
        excluded.dedup();
        let skin = settings.tolerances.distance_tol();
        let target_gap = settings.tolerances.target_gap;
        Self {
            lanes: trajectories.iter().map(|trajectory| Lane::new(trajectory, target_gap)).collect(),
            rooms: trajectories
                .iter()
                .map(|trajectory| Room::new(trajectory.body().shape.reach(), skin))
                .collect(),
            broad: BroadPhase::new(),
            first_contacts: vec![Time::NEVER; trajectories.len()],
            loners: loners(trajectories.len(), settings.collisions, &excluded),
            excluded,
            touched: Vec::new(),
            links: Vec::new(),
            neighbours: Vec::new(),
            marks: Marks::default(),
        }
    }
}

/// For each body, true if no other body can collide with it: collisions are off, or exclude it from all others.
pub(crate) fn loners(count: usize, collisions: bool, excluded: &[(BodyId, BodyId)]) -> Vec<bool> {
    let mut partners = vec![count.saturating_sub(1); count];
    for &(a, b) in excluded.iter().filter(|(a, b)| a != b && !b.is_world()) {
        for body in [a, b] {
            partners[body.index()] = partners[body.index()].saturating_sub(1);
        }
    }
    partners.into_iter().map(|partners| !collisions || partners == 0).collect()
}

impl Neighbourhood {
    /// Pairs that never collide, the lesser id first, sorted.
    #[inline]
    pub(crate) fn excluded(&self) -> &[(BodyId, BodyId)] {
        &self.excluded
    }

    /// Motion and size of each body, as predictions read them.
    #[inline]
    pub(crate) fn lanes(&self) -> &[Lane] {
        &self.lanes
    }

    /// True for bodies that no other body can collide with.
    #[inline]
    pub(crate) fn loners(&self) -> &[bool] {
        &self.loners
    }
}
