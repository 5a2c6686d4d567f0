//! A bounding tree over the features of a shape, so that the cost of finding near features grows as the logarithm of
//! their number.
//!
//! Each node keeps a box in body coordinates and a circle: of two posed trees, the circles of one are compared with the
//! boxes of the other, in the other's coordinates, so that no box ever needs turning.

use crate::bounds::Aabb;
use crate::feature::{Feature, FeatureId};
use crate::pose::Pose;
use glam::DVec2;

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Box around all features below, in body coordinates [m].
    pub bounds: Aabb,
    /// Centre of a circle around all features below, in body coordinates [m].
    pub center: DVec2,
    /// Radius of the circle about `center` around all features below [m].
    pub radius: f64,
    content: Content,
}

#[derive(Clone, Copy, Debug)]
enum Content {
    Leaf(FeatureId),
    /// Index of the second child; the first child follows its parent.
    Branch(u32),
}

/// Content of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Below {
    /// One feature.
    Leaf(FeatureId),
    /// Indices of two nodes.
    Branch([usize; 2]),
}

/// A binary tree over features; the root is node 0.
#[derive(Clone, Debug)]
pub struct FeatureTree {
    nodes: Vec<Node>,
    /// Indices of the leaves, ascending.
    leaves: Vec<usize>,
}

/// Largest number of leaves of two trees that are compared leaf by leaf: the leaves of each with the root of the other,
/// then the remaining leaves of both with each other.
const FEW: usize = 16;

impl FeatureTree {
    /// Builds the tree over the features, `boxes` holding the box of each.
    pub(crate) fn build(features: &[Feature], boxes: &[Aabb]) -> Self {
        let mut items: Vec<Item> = boxes
            .iter()
            .enumerate()
            .map(|(index, &bounds)| Item { id: FeatureId::from_index(index), bounds })
            .collect();
        let mut tree = Self { nodes: Vec::with_capacity(2 * items.len()), leaves: Vec::new() };
        if !items.is_empty() {
            tree.add(&mut items, features);
        }
        let is_leaf = |&node: &usize| matches!(tree.nodes[node].content, Content::Leaf(_));
        tree.leaves = (0..tree.nodes.len()).filter(is_leaf).collect();
        tree
    }

    /// The root: `None` only for a shape without features.
    #[must_use]
    #[inline]
    pub fn root(&self) -> Option<&Node> {
        self.nodes.first()
    }

    /// One of the nodes; the root is node 0.
    pub(crate) fn node(&self, index: usize) -> &Node {
        &self.nodes[index]
    }

    /// Content of a node: its feature, or the indices of its children.
    pub(crate) fn below(&self, index: usize) -> Below {
        match self.nodes[index].content {
            Content::Leaf(feature) => Below::Leaf(feature),
            Content::Branch(second) => Below::Branch([index + 1, second as usize]),
        }
    }

    /// Finds the least value of a feature below `limit`, and returns it with the data that `value` gives for the
    /// feature; `None` if no value is below `limit`.
    ///
    /// Branch and bound: `bound` must not exceed the value of any feature below the node; the child with the lesser
    /// bound is searched first.
    pub(crate) fn find_least<T>(
        &self,
        limit: f64,
        bound: &impl Fn(&Node) -> f64,
        value: &mut impl FnMut(FeatureId) -> Option<(f64, T)>,
    ) -> Option<(f64, T)> {
        let mut best = Best { limit, found: None };
        if let Some(root) = self.root() {
            self.improve(0, bound(root), bound, value, &mut best);
        }
        best.found.map(|found| (best.limit, found))
    }

    /// Visits every feature whose node and all of its ancestors are `wanted`.
    pub(crate) fn visit_where(&self, wanted: &impl Fn(&Node) -> bool, visit: &mut impl FnMut(FeatureId)) {
        if !self.nodes.is_empty() {
            self.visit_below(0, wanted, visit);
        }
    }

    /// Visits every pair of features, of this tree at `pose` and of another at its own, whose bounds (boxes and
    /// circles) are within `distance` [m] of each other.
    pub fn visit_near_pairs(
        &self,
        pose: &Pose,
        other: &FeatureTree,
        other_pose: &Pose,
        distance: f64,
        visit: &mut impl FnMut(FeatureId, FeatureId),
    ) {
        if !self.nodes.is_empty() && !other.nodes.is_empty() {
            let pair = PosedTrees { a: self, b: other, a_in_b: pose.seen_from(other_pose), distance };
            if self.leaves.len().max(other.leaves.len()) <= FEW {
                pair.visit_leaves(visit);
            } else {
                pair.descend(pair.of_a(0), pair.of_b(0), visit);
            }
        }
    }

    fn improve<T>(
        &self,
        node: usize,
        node_bound: f64,
        bound: &impl Fn(&Node) -> f64,
        value: &mut impl FnMut(FeatureId) -> Option<(f64, T)>,
        best: &mut Best<T>,
    ) {
        if node_bound >= best.limit {
            return;
        }
        match self.below(node) {
            Below::Leaf(feature) => {
                if let Some((value, found)) = value(feature).filter(|&(value, _)| value < best.limit) {
                    *best = Best { limit: value, found: Some(found) };
                }
            }
            Below::Branch([first, second]) => {
                let (to_first, to_second) = (bound(&self.nodes[first]), bound(&self.nodes[second]));
                if to_first <= to_second {
                    self.improve(first, to_first, bound, value, best);
                    self.improve(second, to_second, bound, value, best);
                } else {
                    self.improve(second, to_second, bound, value, best);
                    self.improve(first, to_first, bound, value, best);
                }
            }
        }
    }

    fn visit_below(&self, node: usize, wanted: &impl Fn(&Node) -> bool, visit: &mut impl FnMut(FeatureId)) {
        if !wanted(&self.nodes[node]) {
            return;
        }
        match self.below(node) {
            Below::Leaf(feature) => visit(feature),
            Below::Branch(children) => {
                for child in children {
                    self.visit_below(child, wanted, visit);
                }
            }
        }
    }

    /// Appends the subtree over `items`; its root is the next node.
    fn add(&mut self, items: &mut [Item], features: &[Feature]) {
        let bounds =
            items.iter().map(|item| item.bounds).reduce(Aabb::union).unwrap_or(Aabb::around(DVec2::ZERO));
        let center = bounds.center();
        let radius =
            items.iter().map(|item| features[item.id.0 as usize].farthest(center)).fold(0.0, f64::max);
        let node = self.nodes.len();
        let content = Content::Leaf(items[0].id);
        self.nodes.push(Node { bounds, center, radius, content });
        if items.len() == 1 {
            return;
        }
        let size = bounds.size();
        let axis = if size.x >= size.y { DVec2::X } else { DVec2::Y };
        let half = items.len() / 2;
        items.sort_by(|p, q| {
            let (p_place, q_place) = (p.bounds.center().dot(axis), q.bounds.center().dot(axis));
            p_place.total_cmp(&q_place).then(p.id.cmp(&q.id))
        });
        let (low, high) = items.split_at_mut(half);
        self.add(low, features);
        let second = self.nodes.len();
        self.nodes[node].content = Content::Branch(u32::try_from(second).unwrap_or(u32::MAX));
        self.add(high, features);
    }
}

/// The best feature found so far.
struct Best<T> {
    /// Value of the best feature, or the limit of the search: only lesser values are better.
    limit: f64,
    found: Option<T>,
}

struct Item {
    id: FeatureId,
    bounds: Aabb,
}

struct PosedTrees<'a> {
    a: &'a FeatureTree,
    b: &'a FeatureTree,
    /// Pose of `a` in the coordinates of `b`.
    a_in_b: Pose,
    distance: f64,
}

/// A node with the centre of its circle in the other tree's coordinates [m].
#[derive(Clone, Copy)]
struct Placed {
    node: usize,
    center: DVec2,
}

/// Leaves of a tree that are near another tree.
struct NearLeaves {
    leaves: [Placed; FEW],
    count: usize,
}

impl NearLeaves {
    /// Collects the leaves of a tree of at most [`FEW`] for which `place` returns a place.
    #[inline]
    fn find(tree: &FeatureTree, place: impl Fn(usize) -> Option<Placed>) -> Self {
        let mut near = Self { leaves: [Placed { node: 0, center: DVec2::ZERO }; FEW], count: 0 };
        for placed in tree.leaves.iter().take(FEW).filter_map(|&node| place(node)) {
            near.leaves[near.count] = placed;
            near.count += 1;
        }
        near
    }

    fn is_empty(&self) -> bool {
        self.count == 0
    }

    fn iter(&self) -> std::slice::Iter<'_, Placed> {
        self.leaves[..self.count].iter()
    }
}

impl PosedTrees<'_> {
    #[inline]
    fn of_a(&self, node: usize) -> Placed {
        Placed { node, center: self.a_in_b.point_to_world(self.a.nodes[node].center) }
    }

    #[inline]
    fn of_b(&self, node: usize) -> Placed {
        Placed { node, center: self.a_in_b.point_to_body(self.b.nodes[node].center) }
    }

    /// Visits the pairs of near leaves of two trees of at most [`FEW`] leaves each.
    fn visit_leaves(&self, visit: &mut impl FnMut(FeatureId, FeatureId)) {
        let (root_a, root_b) = (&self.a.nodes[0], &self.b.nodes[0]);
        let (at_a, at_b) = (self.of_a(0).center, self.of_b(0).center);
        if self.are_apart((root_a, at_a), (root_b, at_b)) {
            return;
        }
        let near = NearLeaves::find(self.b, |node| {
            let placed = self.of_b(node);
            (!self.are_apart((root_a, at_a), (&self.b.nodes[node], placed.center))).then_some(placed)
        });
        if near.is_empty() {
            return;
        }
        for &leaf in &self.a.leaves {
            let (a, at_a) = (&self.a.nodes[leaf], self.of_a(leaf));
            if self.are_apart((a, at_a.center), (root_b, at_b)) {
                continue;
            }
            for at_b in near.iter() {
                let b = &self.b.nodes[at_b.node];
                if let (Content::Leaf(feature_a), Content::Leaf(feature_b)) = (a.content, b.content)
                    && !self.are_apart((a, at_a.center), (b, at_b.center))
                {
                    visit(feature_a, feature_b);
                }
            }
        }
    }

    fn descend(&self, at_a: Placed, at_b: Placed, visit: &mut impl FnMut(FeatureId, FeatureId)) {
        let (a, b) = (&self.a.nodes[at_a.node], &self.b.nodes[at_b.node]);
        if self.are_apart((a, at_a.center), (b, at_b.center)) {
            return;
        }
        match (a.content, b.content) {
            (Content::Leaf(feature_a), Content::Leaf(feature_b)) => visit(feature_a, feature_b),
            (Content::Branch(second), Content::Branch(_)) if a.radius >= b.radius => {
                self.descend_a(at_a.node, second, at_b, visit);
            }
            (Content::Branch(second), Content::Leaf(_)) => {
                self.descend_a(at_a.node, second, at_b, visit);
            }
            (_, Content::Branch(second)) => {
                self.descend(at_a, self.of_b(at_b.node + 1), visit);
                self.descend(at_a, self.of_b(second as usize), visit);
            }
        }
    }

    fn descend_a(
        &self,
        node: usize,
        second: u32,
        at_b: Placed,
        visit: &mut impl FnMut(FeatureId, FeatureId),
    ) {
        self.descend(self.of_a(node + 1), at_b, visit);
        self.descend(self.of_a(second as usize), at_b, visit);
    }

    /// True if the bounds of two nodes are farther apart than the distance, given each centre in the coordinates of the
    /// other tree.
    #[inline]
    fn are_apart(&self, (a, center_a): (&Node, DVec2), (b, center_b): (&Node, DVec2)) -> bool {
        let (reach_a, reach_b) = (a.radius + self.distance, b.radius + self.distance);
        (center_a - b.center).length_squared() > square(a.radius + reach_b)
            || b.bounds.distance_squared_to(center_a) > square(reach_a)
            || a.bounds.distance_squared_to(center_b) > square(reach_b)
    }
}

#[inline]
fn square(x: f64) -> f64 {
    x * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Shape;
    use std::f64::consts::TAU;

    /// A regular polygon of the given number of corners on a circle of radius 1 m.
    fn polygon(corners: u32) -> Shape {
        let at = |index: u32| DVec2::from_angle(TAU * f64::from(index) / f64::from(corners));
        Shape::polygon(&(0..corners).map(at).collect::<Vec<_>>()).expect("a convex polygon")
    }

    #[test]
    fn all_near_corners_are_visited_and_few_that_are_far() {
        // Two trees of few leaves, which are not descended, and larger trees, which are.
        for [few, many] in [[3, 8], [8, 9], [5, 60], [60, 70]] {
            let (a, b) = (polygon(few), polygon(many));
            for step in 0..40 {
                let turn = 0.37 * f64::from(step);
                let pose_a = Pose::new(DVec2::new(-3.0, 2.0), turn);
                let pose_b = Pose::new(DVec2::new(-3.0, 2.0) + 1.9 * DVec2::from_angle(1.3 * turn), -turn);
                for distance in [0.0, 0.05, 0.5] {
                    let mut visited = Vec::new();
                    let mut visit = |a, b| visited.push((a, b));
                    a.tree().visit_near_pairs(&pose_a, b.tree(), &pose_b, distance, &mut visit);
                    let corner =
                        |shape: &Shape, pose: &Pose, index: u32| match shape.feature(FeatureId(index)) {
                            Feature::Round(round) => Some(pose.point_to_world(round.center)),
                            Feature::Line(_) => None,
                        };
                    let count = |shape: &Shape| u32::try_from(shape.features().len()).unwrap_or(u32::MAX);
                    for index_a in 0..count(&a) {
                        for index_b in 0..count(&b) {
                            let corners = (corner(&a, &pose_a, index_a), corner(&b, &pose_b, index_b));
                            let (Some(p), Some(q)) = corners else { continue };
                            let is_near = p.distance(q) <= distance;
                            let is_visited = visited.contains(&(FeatureId(index_a), FeatureId(index_b)));
                            assert_eq!(
                                is_visited, is_near,
                                "{few} and {many} corners, step {step}, {distance} m"
                            );
                        }
                    }
                    let pairs = visited.len();
                    visited.sort_unstable();
                    visited.dedup();
                    assert_eq!(visited.len(), pairs, "each pair once");
                }
            }
        }
    }
}
