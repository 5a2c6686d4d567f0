//! A tree of boxes over the pieces of a curve, in their order along it.
//!
//! Neighbours along a curve are neighbours in the plane, so the tree halves the list of pieces: the node over `count`
//! pieces is followed by the nodes of its first half, then by those of its second half.

use glam::DVec2;
use halfgap_geometry::Aabb;

/// A tree of boxes over at least one piece.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct BoxTree {
    boxes: Vec<Aabb>,
    count: usize,
}

impl BoxTree {
    /// The tree over the boxes of the pieces; `None` if there are none.
    pub(super) fn new(leaves: &[Aabb]) -> Option<Self> {
        let mut boxes = Vec::with_capacity(2 * leaves.len());
        build(leaves, &mut boxes)?;
        Some(Self { boxes, count: leaves.len() })
    }

    /// The box [m] around all pieces.
    pub(super) fn bounds(&self) -> Aabb {
        self.boxes[0]
    }

    /// Visits pieces from near to far until the squared distance [m^2] that `visit` returns, the least it has
    /// found so far, rules out the rest.
    #[inline]
    pub(super) fn visit_nearest(&self, point: DVec2, visit: &mut impl FnMut(usize) -> f64) {
        let mut least = f64::INFINITY;
        self.visit(Node { place: 0, first: 0, count: self.count }, point, &mut least, visit);
    }

    fn visit(&self, node: Node, point: DVec2, least: &mut f64, visit: &mut impl FnMut(usize) -> f64) {
        if node.count == 1 {
            *least = visit(node.first);
            return;
        }
        let [left, right] = node.halves();
        let (to_left, to_right) = (self.distance_sq(left, point), self.distance_sq(right, point));
        let order = if to_left <= to_right {
            [(left, to_left), (right, to_right)]
        } else {
            [(right, to_right), (left, to_left)]
        };
        for (half, distance_sq) in order {
            if distance_sq < *least {
                self.visit(half, point, least, visit);
            }
        }
    }

    #[inline]
    fn distance_sq(&self, node: Node, point: DVec2) -> f64 {
        let bounds = &self.boxes[node.place];
        (bounds.min - point).max(point - bounds.max).max(DVec2::ZERO).length_squared()
    }
}

/// A node: its place in the list of boxes, and the first and the number of the pieces under it.
#[derive(Clone, Copy)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Node {
    place: usize,
    first: usize,
    count: usize,
}

impl Node {
    #[inline]
    fn halves(self) -> [Node; 2] {
        let half = self.count / 2;
        let left = Node { place: self.place + 1, first: self.first, count: half };
        let right = Node { place: self.place + 2 * half, first: self.first + half, count: self.count - half };
        [left, right]
    }
}

fn build(leaves: &[Aabb], boxes: &mut Vec<Aabb>) -> Option<Aabb> {
    let (&first, rest) = leaves.split_first()?;
    let bounds = rest.iter().fold(first, |bounds, &leaf| bounds.union(leaf));
    boxes.push(bounds);
    if !rest.is_empty() {
        let (left, right) = leaves.split_at(leaves.len() / 2);
        build(left, boxes)?;
        build(right, boxes)?;
    }
    Some(bounds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_of_any_number_of_points_is_found() {
        for count in 1..40u32 {
            let place =
                |index: u32| DVec2::new(f64::from(index * 7919 % 101), f64::from(index * 104_729 % 97));
            let leaves: Vec<Aabb> = (0..count).map(|index| Aabb::around(place(index))).collect();
            let tree = BoxTree::new(&leaves).expect("there are leaves");
            for index in 0..count {
                let from = place(index) + DVec2::new(0.3, -0.2);
                let (mut best, mut least) = (usize::MAX, f64::INFINITY);
                tree.visit_nearest(from, &mut |leaf| {
                    let distance_sq = (leaves[leaf].min - from).length_squared();
                    if distance_sq < least {
                        (best, least) = (leaf, distance_sq);
                    }
                    least
                });
                assert_eq!(best, index as usize, "of {count}");
            }
        }
    }
}
