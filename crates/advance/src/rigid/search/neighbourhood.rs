//! What the search for contacts knows beside the pairs: where bodies may be, who may meet whom, how far ahead
//! each is known.

use super::boxes::Room;
use super::marks::Marks;
use super::pairs::{Link, PairId};
use crate::rigid::motion::flyer::Flyer;
use crate::rigid::motion::lane::Lane;
use crate::rigid::step::deferred::loners;
use crate::rigid::system::RigidSettings;
use crate::time::Time;
use halfgap_collision::{BodyId, BroadPhase};
use halfgap_geometry::FeatureId;

/// The bodies as the search sees them, and its buffers.
#[derive(Clone, Debug)]
pub(crate) struct Neighbourhood {
    /// What predictions read of each body.
    pub(crate) lanes: Vec<Lane>,
    /// The room of each body in the broad phase.
    pub(super) rooms: Vec<Room>,
    pub(super) broad: BroadPhase,
    /// The first contact that is known of each body, or of the group that it leads.
    pub(super) first_contacts: Vec<Time>,
    /// Pairs that never collide, the lesser id first, sorted.
    pub(crate) excluded: Vec<(BodyId, BodyId)>,
    /// Bodies that no other can collide with.
    pub(crate) loners: Vec<bool>,
    /// Contacts that lie deep, and at which gap [m] they were to fire, while what the search is told is made anew.
    pub(super) deep: Vec<(PairId, [FeatureId; 2], f64)>,
    /// Buffers: links of a body, bodies near it, which of them are known.
    pub(crate) links: Vec<Link>,
    pub(super) neighbours: Vec<BodyId>,
    pub(super) marks: Marks,
}

impl Neighbourhood {
    /// Of bodies of which nothing was searched yet; the broad phase is still empty.
    pub(crate) fn new(
        flyers: &[Flyer],
        mut excluded: Vec<(BodyId, BodyId)>,
        settings: &RigidSettings,
    ) -> Self {
        excluded.iter_mut().for_each(|pair| *pair = (pair.0.min(pair.1), pair.0.max(pair.1)));
        excluded.sort_unstable();
        excluded.dedup();
        let skin = settings.tolerances.distance_tol();
        let target_gap = settings.tolerances.target_gap;
        Self {
            lanes: flyers.iter().map(|flyer| Lane::new(flyer, target_gap)).collect(),
            rooms: flyers.iter().map(|flyer| Room::new(flyer.body().shape.reach(), skin)).collect(),
            broad: BroadPhase::new(),
            first_contacts: vec![Time::NEVER; flyers.len()],
            loners: loners(flyers.len(), settings.collisions, &excluded),
            excluded,
            deep: Vec::new(),
            links: Vec::new(),
            neighbours: Vec::new(),
            marks: Marks::default(),
        }
    }
}
