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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stepping::contacts::find_contacts;
    use halfgap_collision::{BodyState, Nearness};

    /// The side to which a square of 1 m is pushed that lies over another, shifted from it.
    fn side_of(x: f64, y: f64) -> Option<DVec2> {
        let square = Shape::block(1.0, 1.0).expect("a fine size");
        let [a, b] = [DVec2::new(x, y), DVec2::ZERO]
            .map(|position| Moving::from(&BodyState { position, ..BodyState::default() }));
        let nearness = Nearness { reach: 0.1, depth: 2.0, overrun: 1e-9 };
        let (mut contacts, mut found, mut gone) = (Vec::new(), Vec::new(), Vec::new());
        let sides = [(&square, &a), (&square, &b)];
        find_contacts(sides, &nearness, &mut contacts, &mut found, &mut gone);
        assert!(!found.is_empty(), "they are near each other");
        side(sides, &found)
    }

    #[test]
    fn a_body_that_has_sunk_is_pushed_to_the_side_on_which_it_overlaps_least() {
        // By 0.3 m upwards, 0.9 m to the right, or 1.1 m to the left.
        assert_eq!(side_of(0.1, 0.7), Some(DVec2::Y));
        assert_eq!(side_of(-0.7, 0.1), Some(DVec2::NEG_X));
    }

    #[test]
    fn contacts_that_agree_have_no_side_to_choose() {
        assert_eq!(side_of(0.0, 1.001), None);
    }
}
