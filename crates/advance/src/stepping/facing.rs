//! Which contacts of two bodies face each other, where these overlap.
//!
//! *Invariant*: contacts between two convex bodies push to one side. In a corner that has sunk into a body, features on all sides overlap: if
//! all were to open, the bodies would hold each other.

use crate::stepping::contacts::Found;
use glam::DVec2;
use halfgap_collision::Moving;
use halfgap_geometry::Shape;

/// The side to which the first of two convex bodies is pushed, as a unit vector: that on which they overlap least. `None` if no two contacts
/// push against each other.
pub(super) fn side([a, b]: [(&Shape, &Moving); 2], found: &[Found]) -> Option<DVec2> {
    let overlapping = found.iter().filter(|found| found.sample.gap < 0.0).map(Found::normal);
    let opposed = overlapping.clone().any(|one| overlapping.clone().any(|other| one.dot(other) < 0.0));
    if !opposed {
        return None;
    }
    let reach = |(shape, moving): (&Shape, &Moving), direction: DVec2| {
        let pose = &moving.pose;
        pose.position.dot(direction) + shape.extent(pose.vector_to_body(direction))
    };
    let depth = |normal: DVec2| reach(b, normal) + reach(a, -normal);
    overlapping.min_by(|&one, &other| depth(one).total_cmp(&depth(other)))
}
