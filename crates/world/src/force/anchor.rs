//! Points that move with bodies, and the line between two of them.

use super::{Snapshot, Wrenches};
use glam::DVec2;
use halfgap_collision::{Anchor, BodyId};

/// Position and velocity of an anchor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Attached {
    /// World position [m].
    pub(super) position: DVec2,
    /// Velocity [m/s].
    pub(super) velocity: DVec2,
    /// Arm from the body's centre of mass, in world directions [m].
    pub(super) arm: DVec2,
}

/// Returns position and velocity of an anchor at a moment.
fn locate(anchor: &Anchor, now: &Snapshot<'_>) -> Attached {
    let moving = now.body(anchor.body);
    let arm = moving.pose.vector_to_world(anchor.point);
    Attached { position: moving.pose.position + arm, velocity: moving.velocity_at(arm), arm }
}

/// Two anchors and the line between them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Between {
    pub(super) a: Attached,
    pub(super) b: Attached,
    /// Offset from b to a [m].
    pub(super) offset: DVec2,
    /// Distance of a and b [m].
    pub(super) length: f64,
}

impl Between {
    pub(super) fn of(ends: &[Anchor; 2], now: &Snapshot<'_>) -> Self {
        let [a, b] = ends.map(|end| locate(&end, now));
        let offset = a.position - b.position;
        Self { a, b, offset, length: offset.length() }
    }

    /// Unit vector from b to a; `None` where the points coincide.
    pub(super) fn direction(&self) -> Option<DVec2> {
        (self.length > 0.0).then(|| self.offset / self.length)
    }

    /// Adds a force on a, and the opposite one on b.
    pub(super) fn pull(&self, ends: &[Anchor; 2], force_on_a: DVec2, wrenches: &mut Wrenches<'_>) {
        wrenches.add_force(ends[0].body, force_on_a, self.a.arm);
        wrenches.add_force(ends[1].body, -force_on_a, self.b.arm);
    }
}

/// Returns the bodies of two anchors, each once, without the background.
pub(super) fn bodies_of(ends: &[Anchor; 2]) -> Vec<BodyId> {
    let mut bodies: Vec<_> = ends.iter().map(|end| end.body).filter(|body| !body.is_world()).collect();
    bodies.dedup();
    bodies
}
