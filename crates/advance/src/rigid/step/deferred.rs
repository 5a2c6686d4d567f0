//! Dense output that waits until somebody looks.
//!
//! Where no body of a group can meet another, nothing can go taut or run off, and no force law changes
//! branch, only who asks from outside needs to know the motion between the ends of steps. It is made from the
//! stages of the last step, so it must be made before the stepper goes on with another group.

use super::group::Group;
use crate::rigid::system::RigidSystem;
use halfgap_collision::BodyId;

impl RigidSystem {
    /// True if nothing ends the segments of a group early.
    pub(crate) fn is_unwatched(&self, group: &Group) -> bool {
        let mechanism = self.mechanism();
        let mut connectors = group.bodies.iter().flat_map(|&body| self.connectors.of(body));
        group.bodies.iter().all(|body| self.search.loners[body.index()])
            && connectors.all(|&id| self.connector(id).is_bilateral())
            && group.rows.iter().all(|row| row.bilateral && !mechanism.can_change(row))
            && group.laws.iter().all(|&law| self.laws.all[law].switches() == 0)
    }

    /// The dense output of a group waits from now on.
    pub(crate) fn defer_dense(&mut self, leader: BodyId) {
        self.groups.waiting = Some(leader);
    }

    /// Forgets the dense output of a group that goes on: nobody looked. That of another group is made.
    pub(crate) fn skip_dense(&mut self, leader: BodyId) {
        if self.groups.waiting == Some(leader) {
            self.groups.waiting = None;
        }
        self.complete_dense();
    }

    /// Makes the dense output that waits, if any: then all motions can be read.
    pub(crate) fn complete_dense(&mut self) {
        let Some(mut group) = self.groups.waiting.take().and_then(|leader| self.groups.take(leader)) else {
            return;
        };
        self.with_group(&mut group, |dynamics, tools| dynamics.complete(tools));
        self.fly_along(&group);
        self.groups.put(group);
    }
}

/// Bodies that no other body can collide with: such that are excluded from collisions with all others.
pub(crate) fn loners(count: usize, collisions: bool, excluded: &[(BodyId, BodyId)]) -> Vec<bool> {
    let mut partners = vec![count.saturating_sub(1); count];
    for &(a, b) in excluded.iter().filter(|(a, b)| a != b && !b.is_world()) {
        for body in [a, b] {
            partners[body.index()] = partners[body.index()].saturating_sub(1);
        }
    }
    partners.into_iter().map(|partners| !collisions || partners == 0).collect()
}
