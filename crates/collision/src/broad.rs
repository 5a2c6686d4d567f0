//! Which bodies are near each other: a dynamic tree of fat boxes.
//!
//! Each body has a box with room to move; only when it leaves the box is the tree touched. A query costs the logarithm of
//! the number of bodies plus what it finds. The tree chooses where to insert by the least growth of half perimeters (J.
//! Goldsmith and J. Salmon, "Automatic creation of object hierarchies for ray tracing", 1987), swaps a child with a niece
//! where that makes boxes smaller (A. Kensler, "Tree rotations for improving bounding volume hierarchies", 2008), and
//! lifts the higher child where it becomes lopsided, as an AVL tree does, so that its height stays logarithmic.

use crate::body::BodyId;
use halfgap_geometry::Aabb;

const NONE: u32 = u32::MAX;
/// Heights of two children may differ by so much: small boxes matter more than perfect balance.
const LOPSIDED: u32 = 4;
/// Nodes and bodies for which a search has room to begin with.
const FIRST_ROOM: usize = 16;

/// A line of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Node {
    bounds: Aabb,
    parent: u32,
    children: [u32; 2],
    /// 0 for a leaf.
    height: u32,
    body: BodyId,
}

/// A balanced tree of boxes, one for each body.
#[derive(Clone, Debug, Default)]
pub struct BroadPhase {
    nodes: Vec<Node>,
    root: Option<u32>,
    free: Vec<u32>,
    /// Nodes whose children a search looks at, one level after another.
    frontier: Vec<u32>,
    /// Leaf of each body, by index.
    leaves: Vec<Option<u32>>,
}

impl BroadPhase {
    /// A tree without bodies.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The box of a body, if it has one.
    #[must_use]
    pub fn bounds(&self, body: BodyId) -> Option<&Aabb> {
        let leaf = self.leaves.get(body.index()).copied().flatten()?;
        Some(&self.nodes[leaf as usize].bounds)
    }

    /// Takes all boxes away; the tree keeps its room.
    pub fn clear(&mut self) {
        self.nodes.clear();
        self.root = None;
        self.free.clear();
        self.leaves.clear();
    }

    /// Gives a body its box [m], in place of the one it had.
    pub fn set(&mut self, body: BodyId, bounds: Aabb) {
        if self.leaves.len() <= body.index() {
            self.leaves.resize(body.index() + 1, None);
        }
        // A box that moves seldom goes far: the search for its new place begins where it was.
        let near = self.take_out(body).map(|sibling| self.least_around(sibling, &bounds));
        let leaf = self.allocate(Node { bounds, parent: NONE, children: [NONE; 2], height: 0, body });
        self.leaves[body.index()] = Some(leaf);
        self.insert(leaf, near);
    }

    /// Takes a body's box away; nothing happens if it has none.
    pub fn remove(&mut self, body: BodyId) {
        self.take_out(body);
    }

    /// Takes a body's box away; the node that was beside it, if there was one.
    fn take_out(&mut self, body: BodyId) -> Option<u32> {
        let leaf = self.leaves.get_mut(body.index()).and_then(Option::take)?;
        self.free.push(leaf);
        let parent = self.nodes[leaf as usize].parent;
        if parent == NONE {
            self.root = None;
            return None;
        }
        let [left, right] = self.nodes[parent as usize].children;
        let sibling = if left == leaf { right } else { left };
        let above = self.nodes[parent as usize].parent;
        self.free.push(parent);
        self.replace_child(above, parent, sibling);
        self.refit_from(above);
        Some(sibling)
    }

    /// The least box around a node that holds the given one, or the root.
    fn least_around(&self, mut node: u32, bounds: &Aabb) -> u32 {
        loop {
            let here = &self.nodes[node as usize];
            if here.bounds.contains(bounds) || here.parent == NONE {
                return node;
            }
            node = here.parent;
        }
    }

    /// Finds every body whose box overlaps the given one, the higher in the tree the earlier.
    pub fn find_overlapping(&mut self, bounds: &Aabb, found: &mut Vec<BodyId>) {
        found.clear();
        let Some(root) = self.root else { return };
        let root_node = &self.nodes[root as usize];
        if root_node.height == 0 {
            found.extend(root_node.bounds.overlaps(bounds).then_some(root_node.body));
            return;
        }
        // Level by level: which nodes come next is known long before their boxes have come from memory. What overlaps cannot
        // be foretold: everything is written down, and kept if it does.
        let (mut next, mut end, mut count) = (0, 1, 0);
        self.frontier.resize(self.frontier.len().max(FIRST_ROOM), NONE);
        self.frontier[0] = root;
        while next < end {
            let children = self.nodes[self.frontier[next] as usize].children;
            next += 1;
            if self.frontier.len() < end + 2 {
                self.frontier.resize(2 * end, NONE);
            }
            if found.len() < count + 2 {
                found.resize(2 * count + FIRST_ROOM, BodyId(NONE));
            }
            for child in children {
                let node = &self.nodes[child as usize];
                let (overlaps, is_leaf) = (node.bounds.overlaps(bounds), node.height == 0);
                found[count] = node.body;
                count += usize::from(overlaps & is_leaf);
                self.frontier[end] = child;
                end += usize::from(overlaps & !is_leaf);
            }
        }
        found.truncate(count);
    }

    fn allocate(&mut self, node: Node) -> u32 {
        if let Some(index) = self.free.pop() {
            self.nodes[index as usize] = node;
            return index;
        }
        self.nodes.push(node);
        u32::try_from(self.nodes.len() - 1)
            .expect("a tree has fewer than 2^32 nodes: bodies are counted in 32 bits")
    }

    /// Inserts a leaf below a node, or below the root.
    fn insert(&mut self, leaf: u32, below: Option<u32>) {
        let Some(below) = below.or(self.root) else {
            self.root = Some(leaf);
            return;
        };
        let bounds = self.nodes[leaf as usize].bounds;
        let sibling = self.best_sibling(below, &bounds);
        let above = self.nodes[sibling as usize].parent;
        let parent = self.allocate(Node {
            bounds: self.nodes[sibling as usize].bounds.union(bounds),
            parent: above,
            children: [sibling, leaf],
            height: self.nodes[sibling as usize].height + 1,
            body: BodyId(0),
        });
        self.replace_child(above, sibling, parent);
        self.nodes[sibling as usize].parent = parent;
        self.nodes[leaf as usize].parent = parent;
        self.refit_from(above);
    }

    /// Descends from a node to where a new box makes the boxes above grow least.
    fn best_sibling(&self, mut node: u32, bounds: &Aabb) -> u32 {
        loop {
            let here = &self.nodes[node as usize];
            if here.height == 0 {
                return node;
            }
            let together = here.bounds.union(*bounds).half_perimeter();
            let growth = together - here.bounds.half_perimeter();
            let [left, right] = here.children.map(|child| self.descent_cost(child, bounds) + growth);
            if together <= left && together <= right {
                return node;
            }
            node = here.children[usize::from(right < left)];
        }
    }

    fn descent_cost(&self, child: u32, bounds: &Aabb) -> f64 {
        let child = &self.nodes[child as usize];
        let together = child.bounds.union(*bounds).half_perimeter();
        if child.height == 0 { together } else { together - child.bounds.half_perimeter() }
    }

    /// Puts `new` where `old` was below `parent`, or at the root.
    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        self.nodes[new as usize].parent = parent;
        if parent == NONE {
            self.root = Some(new);
            return;
        }
        let children = &mut self.nodes[parent as usize].children;
        children[usize::from(children[1] == old)] = new;
    }

    /// Mends boxes, heights and balance from a node up to the root, or to where nothing changes any more.
    fn refit_from(&mut self, mut node: u32) {
        while node != NONE {
            let node_now = self.balance(node);
            let is_as_before = !self.refit(node_now);
            if is_as_before && node_now == node {
                break;
            }
            node = self.nodes[node_now as usize].parent;
        }
    }

    /// True if the box or the height of a node has changed.
    fn refit(&mut self, node: u32) -> bool {
        let [left, right] = self.nodes[node as usize].children.map(|child| &self.nodes[child as usize]);
        let (bounds, height) = (left.bounds.union(right.bounds), 1 + left.height.max(right.height));
        let here = &mut self.nodes[node as usize];
        let has_changed = here.bounds != bounds || here.height != height;
        (here.bounds, here.height) = (bounds, height);
        has_changed
    }

    /// Swaps a child with a child of the other where that shrinks the other's box.
    fn swap_with_niece(&mut self, node: u32) {
        let children = self.nodes[node as usize].children;
        let mut best = (0.0, 0, 0);
        for side in 0..2 {
            let (child, other) = (children[side], &self.nodes[children[1 - side] as usize]);
            if other.height == 0 {
                continue;
            }
            let size = other.bounds.half_perimeter();
            for niece_side in 0..2 {
                let stays = &self.nodes[other.children[1 - niece_side] as usize];
                let saved = size - stays.bounds.union(self.nodes[child as usize].bounds).half_perimeter();
                if saved > best.0 {
                    best = (saved, side, niece_side);
                }
            }
        }
        let (saved, side, niece_side) = best;
        if saved <= 0.0 {
            return;
        }
        let (child, other) = (children[side], children[1 - side]);
        let niece = self.nodes[other as usize].children[niece_side];
        self.nodes[node as usize].children[side] = niece;
        self.nodes[niece as usize].parent = node;
        self.nodes[other as usize].children[niece_side] = child;
        self.nodes[child as usize].parent = other;
        self.refit(other);
    }

    /// Rotates the higher child up if the two differ by much; returns the root of the subtree.
    fn balance(&mut self, node: u32) -> u32 {
        let [left, right] = self.nodes[node as usize].children;
        let (left_height, right_height) =
            (self.nodes[left as usize].height, self.nodes[right as usize].height);
        let (high, side) = match () {
            () if left_height > right_height + LOPSIDED => (left, 0),
            () if right_height > left_height + LOPSIDED => (right, 1),
            () => {
                self.swap_with_niece(node);
                return node;
            }
        };
        // The high child takes the node's place; its lower child moves under the node.
        let [first, second] = self.nodes[high as usize].children;
        let first_is_lower = self.nodes[first as usize].height <= self.nodes[second as usize].height;
        let (lower, higher) = if first_is_lower { (first, second) } else { (second, first) };
        let above = self.nodes[node as usize].parent;
        self.replace_child(above, node, high);
        self.nodes[high as usize].children = [node, higher];
        self.nodes[node as usize].parent = high;
        self.nodes[node as usize].children[side] = lower;
        self.nodes[lower as usize].parent = node;
        self.refit(node);
        high
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    /// A cheap generator of places that look random.
    fn place(index: u32) -> DVec2 {
        let turn = f64::from(index) * 0.618_033_988_749_895;
        DVec2::new(turn.fract() * 100.0, (turn * 7.1).fract() * 100.0)
    }

    fn found(broad: &mut BroadPhase, bounds: &Aabb) -> Vec<u32> {
        let mut bodies = Vec::new();
        broad.find_overlapping(bounds, &mut bodies);
        let mut bodies: Vec<u32> = bodies.into_iter().map(|body| body.0).collect();
        bodies.sort_unstable();
        bodies
    }

    #[test]
    fn queries_find_what_brute_force_finds_while_boxes_move() {
        let mut broad = BroadPhase::new();
        let mut boxes: Vec<Aabb> = (0..300).map(|index| Aabb::around_disc(place(index), 1.5)).collect();
        for (index, bounds) in boxes.iter().enumerate() {
            broad.set(BodyId(index as u32), *bounds);
        }
        for round in 0..20 {
            for index in (round..300).step_by(7) {
                boxes[index] = Aabb::around_disc(place(index as u32 + 1000 * (round as u32 + 1)), 2.0);
                broad.set(BodyId(index as u32), boxes[index]);
            }
            for (index, query) in boxes.iter().enumerate().step_by(11) {
                let expected: Vec<u32> =
                    (0..300).filter(|&other| boxes[other as usize].overlaps(query)).collect();
                assert_eq!(found(&mut broad, query), expected, "box {index} in round {round}");
            }
        }
    }

    #[test]
    fn boxes_that_drift_are_found_and_the_tree_stays_shallow() {
        let mut broad = BroadPhase::new();
        let heading = |index: u32| DVec2::from_angle(f64::from(index) * 2.4);
        let bounds = |index: u32, round: u32| {
            Aabb::around_disc(place(index) + heading(index) * (0.5 * f64::from(round)), 1.5)
        };
        (0..500).for_each(|index| broad.set(BodyId(index), bounds(index, 0)));
        // The last rounds are hundreds of widths away from the first.
        for round in 1..1000 {
            (0..500).for_each(|index| broad.set(BodyId(index), bounds(index, round)));
            let query = bounds(round % 500, round);
            let expected: Vec<u32> =
                (0..500).filter(|&other| bounds(other, round).overlaps(&query)).collect();
            assert_eq!(found(&mut broad, &query), expected, "round {round}");
        }
        let root = broad.root.expect("there are bodies");
        assert!(broad.nodes[root as usize].height <= 20, "height {}", broad.nodes[root as usize].height);
    }

    #[test]
    fn the_tree_of_a_sorted_row_stays_shallow() {
        let mut broad = BroadPhase::new();
        for index in 0..1024 {
            broad.set(BodyId(index), Aabb::around_disc(DVec2::new(f64::from(index), 0.0), 0.4));
        }
        let root = broad.root.expect("there are bodies");
        assert!(broad.nodes[root as usize].height <= 20, "height {}", broad.nodes[root as usize].height);
    }

    #[test]
    fn removed_bodies_are_not_found() {
        let mut broad = BroadPhase::new();
        for index in 0..10 {
            broad.set(BodyId(index), Aabb::around_disc(DVec2::ZERO, 1.0));
        }
        for index in 0..10 {
            broad.remove(BodyId(index));
            assert_eq!(found(&mut broad, &Aabb::around(DVec2::ZERO)).len(), 9 - index as usize);
            assert_eq!(broad.bounds(BodyId(index)), None);
        }
    }
}
