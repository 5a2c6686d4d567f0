//! Dense output that is made only when it is asked for.
//!
//! Where no body of a group can collide, no connector can go taut, no contact can run off its features, and no force
//! law changes branch, only the caller may need the motion between the ends of steps. Dense output is made from the
//! stages of the last step, so it must be made before the stepper goes on with another group.

use super::group::Group;
use crate::rigid::system::RigidSystem;
use halfgap_collision::BodyId;

impl RigidSystem {
    /// True if no event can end the segments of a group early.
    pub(crate) fn is_unwatched(&self, group: &Group) -> bool {
        let mechanism = self.mechanism();
        let mut connectors = group.bodies.iter().flat_map(|&body| self.connectors.of(body));
        group.bodies.iter().all(|body| self.search.loners[body.index()])
            && connectors.all(|&id| self.connector(id).is_bilateral())
            && group.rows.iter().all(|row| row.bilateral && !mechanism.can_change(row))
            && group.laws.iter().all(|&law| self.laws.all[law].switches() == 0)
    }

    /// Postpones the dense output of the group with this leader.
    pub(crate) fn defer_dense(&mut self, leader: BodyId) {
        self.groups.waiting = Some(leader);
    }

    /// Drops the postponed dense output of a group that goes on without having been asked for it; makes that of another
    /// group.
    pub(crate) fn skip_dense(&mut self, leader: BodyId) {
        if self.groups.waiting == Some(leader) {
            self.groups.waiting = None;
        }
        self.complete_dense();
    }

    /// Makes the postponed dense output, if there is any: then all motions can be evaluated.
    pub(crate) fn complete_dense(&mut self) {
        let Some(mut group) = self.groups.waiting.take().and_then(|leader| self.groups.take(leader)) else {
            return;
        };
        self.with_group(&mut group, |dynamics, tools| dynamics.complete(tools));
        self.fly_along(&group);
        self.groups.put(group);
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
