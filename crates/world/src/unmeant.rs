//! What a run shows that its author can hardly have meant: a push whose point has left its body, a world in which
//! nothing happens.

use crate::finding::Finding;
use crate::world::World;
use halfgap_geometry::EdgeSpec;
#[cfg(feature = "scene")]
use {
    crate::force::{Snapshot, Wrench, wrenches_of},
    crate::ledger::Turnover,
    halfgap_collision::Moving,
    std::slice::from_ref,
};

impl World {
    /// Lists the force laws whose point, fixed in the world, is now outside of the body on which they push, but those
    /// of which that is known.
    pub(crate) fn find_points_left(&self, is_known: impl Fn(&str) -> bool, findings: &mut Vec<Finding>) {
        for law in self.forces().filter(|law| !is_known(law.name())) {
            let Some((body, point)) = law.fixed_point().filter(|(body, _)| !self.is_fixed(*body)) else {
                continue;
            };
            let shape = self.shape(body);
            let inside = self.state(body).pose().point_to_body(point);
            // A point counts as on the body to the accuracy to which the points of outlines must be written. A state
            // that is no number is another finding.
            let fit = EdgeSpec::FIT * shape.reach();
            if !inside.is_finite() || shape.nearest(inside).signed_distance <= fit {
                continue;
            }
            let (law, body) = (law.name().to_owned(), self.name(body).to_owned());
            findings.push(Finding::PointLeft { law, body, point, time: self.time() });
        }
    }
}

/// Only a whole run, of a scene, can tell that nothing has happened.
#[cfg(feature = "scene")]
impl World {
    /// Adds a finding if bodies that could move never did, and no force acts on any of them.
    pub(crate) fn find_nothing(&self, turnover: &Turnover, findings: &mut Vec<Finding>) {
        let has_movable = self.bodies().any(|body| !self.is_fixed(body));
        if has_movable && turnover.energy == 0.0 && !self.is_forced() {
            findings.push(Finding::NothingMoved);
        }
    }

    /// True if gravity or a force law acts on a movable body, even if they cancel each other.
    fn is_forced(&self) -> bool {
        let movings: Vec<_> = self.bodies().map(|body| Moving::from(&self.state(body))).collect();
        let now = Snapshot::new(self.time(), &movings);
        let movable = || self.bodies().filter(|&body| !self.is_fixed(body));
        let acts = |law| {
            let wrenches = wrenches_of(from_ref(law), &now, movings.len());
            movable().any(|body| wrenches[body.index()] != Wrench::default())
        };
        movable().any(|body| self.has_gravity(body)) || self.forces().any(acts)
    }
}
