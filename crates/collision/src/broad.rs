//! A dynamic tree of fat boxes, which finds the bodies near a box.
//!
//! Each body has a box with room to move; only when it leaves the box does the tree change. A query costs the logarithm
//! of the number of bodies plus the number of bodies found. The tree chooses where to insert by the least growth
//! of half perimeters (J. Goldsmith and J. Salmon, "Automatic creation of object hierarchies for ray
//! tracing", 1987), swaps a child with a niece where that makes boxes smaller (A. Kensler, "Tree rotations
//! for improving bounding volume hierarchies", 2008), and lifts the higher child where it becomes lopsided,
//! as an AVL tree does, so that its height stays logarithmic.
//!
//! A node keeps the boxes of its children, and bodies have no nodes: with thousands of bodies the number of places in
//! memory that are read decides the cost.

use crate::body::BodyId;
use glam::DVec2;
use halfgap_geometry::Aabb;

/// Largest difference of the heights of two children [levels]: small boxes matter more than perfect balance.
const LOPSIDED: u32 = 4;
/// Number of nodes, and of bodies, for which a search reserves room at first.
const FIRST_ROOM: usize = 16;

/// Reference to a child of a node, or to the root: another node, or a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Link(u32);

impl Link {
    /// Bit that marks a body.
    const BODY: u32 = 1 << 31;

    fn of_node(index: u32) -> Self {
        Self(index)
    }

    fn of_body(body: BodyId) -> Self {
        Self(body.0 | Self::BODY)
    }

    #[inline]
    fn is_body(self) -> bool {
        self.0 & Self::BODY != 0
    }

    /// Index of the body or node.
    #[inline]
    fn index(self) -> usize {
        (self.0 & !Self::BODY) as usize
    }

    /// Index of the node; `None` for a body.
    #[inline]
    fn node(self) -> Option<usize> {
        (!self.is_body()).then_some(self.index())
    }
}

/// Place of a child in the tree: a side of a node, or the root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Slot {
    node: u32,
    side: u32,
}

impl Slot {
    const ROOT: Self = Self { node: u32::MAX, side: 0 };

    fn new(node: usize, side: usize) -> Self {
        Self { node: number(node), side: number(side) }
    }

    /// Indices of the node and of its side; `None` for the root.
    #[inline]
    fn place(self) -> Option<(usize, usize)> {
        (self != Self::ROOT).then_some((self.node as usize, self.side as usize))
    }
}

/// A child of a node: its box, its reference, and the number of levels below it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Child {
    bounds: Aabb,
    link: Link,
    /// Number of levels below; 0 for a body.
    height: u32,
}

/// A node with its two children, aligned to two lines of the cache that are read together.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[repr(align(128))]
struct Node {
    children: [Child; 2],
    slot: Slot,
}

impl Node {
    fn bounds(&self) -> Aabb {
        self.children[0].bounds.union(self.children[1].bounds)
    }

    fn height(&self) -> u32 {
        1 + self.children[0].height.max(self.children[1].height)
    }
}

/// The box of a body and its place in the tree.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Leaf {
    bounds: Aabb,
    slot: Slot,
}

/// A balanced tree of boxes, one for each body.
#[derive(Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct BroadPhase {
    nodes: Vec<Node>,
    root: Option<Link>,
    free: Vec<usize>,
    /// Nodes whose children a search tests, one level after another.
    #[cfg_attr(feature = "save", serde(skip))]
    frontier: Vec<u32>,
    /// Leaf of each body, by index.
    leaves: Vec<Option<Leaf>>,
}

impl Clone for BroadPhase {
    fn clone(&self) -> Self {
        let mut tree = Self::default();
        tree.clone_from(self);
        tree
    }

    /// Uses the buffers again.
    fn clone_from(&mut self, source: &Self) {
        let Self { nodes, root, free, frontier: _, leaves } = source;
        self.nodes.clone_from(nodes);
        self.root = *root;
        self.free.clone_from(free);
        self.leaves.clone_from(leaves);
    }
}

impl BroadPhase {
    /// A tree without bodies.
    #[must_use]
    #[inline]
    pub fn new() -> Self {
        Self::default()
    }

    /// The box [m] of a body; `None` if it has none.
    #[must_use]
    #[inline]
    pub fn bounds(&self, body: BodyId) -> Option<&Aabb> {
        self.leaves.get(body.index())?.as_ref().map(|leaf| &leaf.bounds)
    }

    /// Sets the box [m] of a body, in place of the one it had, if any. A side that is not a number counts as infinitely
    /// far out.
    pub fn set(&mut self, body: BodyId, bounds: Aabb) {
        let bounds = without_nan(bounds);
        if self.leaves.len() <= body.index() {
            self.leaves.resize(body.index() + 1, None);
        }
        // A box that moves seldom goes far: the search for its new place begins at its old one.
        let near = self.take_out(body).map(|sibling| self.least_around(sibling, &bounds));
        self.insert(body, bounds, near);
    }

    /// Removes the box of a body, such as one that leaves the scene (which none does in the layers above). Does nothing
    /// if the body has no box.
    #[inline]
    pub fn remove(&mut self, body: BodyId) {
        self.take_out(body);
    }

    /// Removes the box of a body and returns its sibling, if there was one.
    fn take_out(&mut self, body: BodyId) -> Option<Link> {
        let leaf = self.leaves.get_mut(body.index()).and_then(Option::take)?;
        let Some((parent, side)) = leaf.slot.place() else {
            self.root = None;
            return None;
        };
        self.free.push(parent);
        let (sibling, above) = (self.nodes[parent].children[1 - side], self.nodes[parent].slot);
        self.hang(sibling, above);
        self.refit_from(above);
        Some(sibling.link)
    }

    /// The lowest of a child and its ancestors whose box contains the given one; the root if none does.
    fn least_around(&self, mut link: Link, bounds: &Aabb) -> Link {
        while let Some((node, side)) = self.slot_of(link).place() {
            if self.nodes[node].children[side].bounds.contains(bounds) {
                break;
            }
            link = Link::of_node(number(node));
        }
        link
    }

    /// Replaces the contents of `found` by all bodies whose boxes overlap the given one [m], in the order of their
    /// levels from the root down.
    pub fn find_overlapping(&mut self, bounds: &Aabb, found: &mut Vec<BodyId>) {
        found.clear();
        let Some(root) = self.root else { return };
        if root.is_body() {
            let body = BodyId(number(root.index()));
            found.extend(self.bounds(body).filter(|own| own.overlaps(bounds)).map(|_| body));
            return;
        }
        // Level by level: the next nodes are known long before their boxes have come from memory. Whether boxes overlap
        // is unpredictable: every child is written down without a branch, and kept if it overlaps.
        let (mut next, mut end, mut count) = (0, 1, 0);
        self.frontier.resize(self.frontier.len().max(FIRST_ROOM), 0);
        self.frontier[0] = root.0;
        while next < end {
            let children = &self.nodes[self.frontier[next] as usize].children;
            next += 1;
            if self.frontier.len() < end + 2 {
                self.frontier.resize(2 * end, 0);
            }
            if found.len() < count + 2 {
                found.resize(2 * count + FIRST_ROOM, BodyId(0));
            }
            for child in children {
                let (overlaps, is_body) = (child.bounds.overlaps(bounds), child.link.is_body());
                found[count] = BodyId(number(child.link.index()));
                count += usize::from(overlaps & is_body);
                self.frontier[end] = child.link.0;
                end += usize::from(overlaps & !is_body);
            }
        }
        found.truncate(count);
    }

    fn allocate(&mut self, node: Node) -> usize {
        if let Some(index) = self.free.pop() {
            self.nodes[index] = node;
            return index;
        }
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    fn slot_of(&self, link: Link) -> Slot {
        match link.node() {
            Some(node) => self.nodes[node].slot,
            None => self.leaves[link.index()].map_or(Slot::ROOT, |leaf| leaf.slot),
        }
    }

    /// Puts a child into a slot, in place of the child that may have been there.
    fn hang(&mut self, child: Child, slot: Slot) {
        match child.link.node() {
            Some(node) => self.nodes[node].slot = slot,
            None => self.leaves[child.link.index()] = Some(Leaf { bounds: child.bounds, slot }),
        }
        match slot.place() {
            Some((node, side)) => self.nodes[node].children[side] = child,
            None => self.root = Some(child.link),
        }
    }

    /// The entry of a node among its parent's children.
    fn as_child(&self, node: usize) -> Child {
        let here = &self.nodes[node];
        Child { bounds: here.bounds(), link: Link::of_node(number(node)), height: here.height() }
    }

    /// Inserts a body below a child or, without one, below the root.
    fn insert(&mut self, body: BodyId, bounds: Aabb, below: Option<Link>) {
        let own = Child { bounds, link: Link::of_body(body), height: 0 };
        let Some(below) = below.or(self.root) else {
            self.hang(own, Slot::ROOT);
            return;
        };
        let sibling = self.best_sibling(self.child(below), &bounds);
        let above = self.slot_of(sibling.link);
        let parent = self.allocate(Node { children: [sibling, own], slot: above });
        self.hang(sibling, Slot::new(parent, 0));
        self.hang(own, Slot::new(parent, 1));
        self.hang(self.as_child(parent), above);
        self.refit_from(above);
    }

    /// The child that a link refers to, with its box and height.
    fn child(&self, link: Link) -> Child {
        match (self.slot_of(link).place(), link.node()) {
            (Some((node, side)), _) => self.nodes[node].children[side],
            (None, Some(root)) => self.as_child(root),
            (None, None) => {
                let bounds = self.bounds(BodyId(number(link.index()))).copied();
                Child { bounds: bounds.unwrap_or(Aabb::around(DVec2::ZERO)), link, height: 0 }
            }
        }
    }

    /// Descends from a child to the sibling for which a new box makes the boxes above grow least.
    fn best_sibling(&self, mut child: Child, bounds: &Aabb) -> Child {
        while let Some(node) = child.link.node() {
            let here = &self.nodes[node];
            let together = child.bounds.union(*bounds).half_perimeter();
            let growth = together - child.bounds.half_perimeter();
            let [left, right] = [0, 1].map(|side: usize| descent_cost(&here.children[side], bounds) + growth);
            if together <= left && together <= right {
                break;
            }
            child = here.children[usize::from(right < left)];
        }
        child
    }

    /// Updates boxes, heights and balance from a node up to the root, or until nothing changes any more.
    fn refit_from(&mut self, mut slot: Slot) {
        while let Some((node, _)) = slot.place() {
            slot = self.nodes[node].slot;
            let before = slot.place().map(|(above, side)| self.nodes[above].children[side]);
            let highest = self.balance(node);
            let now = self.as_child(highest);
            if before == Some(now) {
                break;
            }
            self.hang(now, slot);
        }
    }

    /// Swaps one child of a node with a child of the other one, if that shrinks the other's box.
    fn swap_with_niece(&mut self, node: usize) {
        let children = self.nodes[node].children;
        let mut best = (0.0, 0, 0);
        for side in 0..2 {
            let (child, other) = (&children[side], &children[1 - side]);
            let Some(other_node) = other.link.node() else { continue };
            let size = other.bounds.half_perimeter();
            for niece_side in 0..2 {
                let stays = &self.nodes[other_node].children[1 - niece_side];
                let saved = size - stays.bounds.union(child.bounds).half_perimeter();
                if saved > best.0 {
                    best = (saved, side, niece_side);
                }
            }
        }
        let (saved, side, niece_side) = best;
        let Some(other) = children[1 - side].link.node().filter(|_| saved > 0.0) else { return };
        let niece = self.nodes[other].children[niece_side];
        self.hang(niece, Slot::new(node, side));
        self.hang(children[side], Slot::new(other, niece_side));
        self.hang(self.as_child(other), Slot::new(node, 1 - side));
    }

    /// Rotates the higher child up if the heights differ by more than [`LOPSIDED`]; returns the root of the subtree,
    /// which has to take the node's place.
    fn balance(&mut self, node: usize) -> usize {
        let [left, right] = self.nodes[node].children;
        let side = usize::from(right.height > left.height);
        let (high, low) = if side == 0 { (left, right) } else { (right, left) };
        let Some(high_node) = high.link.node().filter(|_| high.height > low.height + LOPSIDED) else {
            self.swap_with_niece(node);
            return node;
        };
        // The high child takes the node's place; its lower child moves under the node.
        let [first, second] = self.nodes[high_node].children;
        let (lower, lower_side) = if first.height <= second.height { (first, 0) } else { (second, 1) };
        self.hang(lower, Slot::new(node, side));
        self.hang(self.as_child(node), Slot::new(high_node, lower_side));
        high_node
    }
}

/// Least growth [m] of half perimeters, from a child down, if a new box goes below it.
fn descent_cost(child: &Child, bounds: &Aabb) -> f64 {
    let together = child.bounds.union(*bounds).half_perimeter();
    if child.link.is_body() { together } else { together - child.bounds.half_perimeter() }
}

/// An index in 32 bits: bodies are counted in as many, and a tree has fewer nodes than bodies.
#[inline]
fn number(index: usize) -> u32 {
    debug_assert!(u32::try_from(index).is_ok());
    index as u32
}

/// A box [m] whose unknown sides lie infinitely far out: the boxes around it would hold nothing.
fn without_nan(bounds: Aabb) -> Aabb {
    let known = |side: f64, outside: f64| if side.is_nan() { outside } else { side };
    let [min, max] = [(bounds.min, f64::NEG_INFINITY), (bounds.max, f64::INFINITY)]
        .map(|(corner, outside)| DVec2::new(known(corner.x, outside), known(corner.y, outside)));
    Aabb { min, max }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    /// A cheap generator of pseudo-random places.
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
    fn a_box_that_is_no_number_hides_no_other() {
        let mut broad = BroadPhase::new();
        let boxes: Vec<Aabb> = (0..40).map(|index| Aabb::around_disc(place(index), 20.0)).collect();
        for (index, bounds) in boxes.iter().enumerate() {
            broad.set(BodyId(index as u32), *bounds);
        }
        broad.set(BodyId(40), Aabb::around(DVec2::NAN));
        for query in &boxes {
            let expected: Vec<u32> = (0..40).filter(|&other| boxes[other as usize].overlaps(query)).collect();
            assert_eq!(found(&mut broad, query), [expected, vec![40]].concat());
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
        let height = broad.root.map(|root| broad.child(root).height);
        assert!(height.is_some_and(|height| (9..=20).contains(&height)), "height {height:?}");
    }

    #[test]
    fn the_tree_of_a_sorted_row_stays_shallow() {
        let mut broad = BroadPhase::new();
        for index in 0..1024 {
            broad.set(BodyId(index), Aabb::around_disc(DVec2::new(f64::from(index), 0.0), 0.4));
        }
        let height = broad.root.map(|root| broad.child(root).height);
        assert!(height.is_some_and(|height| (9..=20).contains(&height)), "height {height:?}");
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
