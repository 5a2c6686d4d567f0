//! Data of the search for contacts beside the pairs: where bodies may be, which of them may meet, and the first contact
//! known of each.

use crate::rigid::bodies::flyer::Flyer;
use crate::rigid::contacts::pairs::{Link, PairId};
use crate::rigid::search::boxes::Room;
use crate::rigid::search::lane::Lane;
use crate::rigid::search::marks::Marks;
use crate::rigid::settings::RigidSettings;
use crate::time::Time;
use halfgap_collision::{BodyId, BroadPhase};
use halfgap_geometry::FeatureId;

/// Bodies as the search sees them, with its buffers.
#[derive(Clone, Debug)]
pub(crate) struct Neighbourhood {
    /// Motion and size of each body, as predictions read them.
    pub(crate) lanes: Vec<Lane>,
    /// Room of each body in the broad phase.
    pub(crate) rooms: Vec<Room>,
    pub(crate) broad: BroadPhase,
    /// Time of the first contact known of each body, or of the group that it leads.
    pub(crate) first_contacts: Vec<Time>,
    /// Pairs that never collide, the lesser id first, sorted.
    pub(crate) excluded: Vec<(BodyId, BodyId)>,
    /// True for bodies that no other body can collide with.
    pub(crate) loners: Vec<bool>,
    /// Contacts that lie deep, with the gaps [m] at which they were to fire, while the rules are made anew.
    pub(crate) deep: Vec<(PairId, [FeatureId; 2], f64)>,
    /// Buffer: pairs whose rules or predictions an event changes.
    pub(crate) touched: Vec<PairId>,
    /// Buffer: links of a body.
    pub(crate) links: Vec<Link>,
    /// Buffer: bodies near a body.
    pub(crate) neighbours: Vec<BodyId>,
    /// Buffer: which of these are known already.
    pub(crate) marks: Marks,
}

impl Neighbourhood {
    /// Sets up the search for bodies; the broad phase is still empty.
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
