//! The distance of two shapes at two poses, with the points that are nearest.
//!
//! Outlines are compared as curves: the least distance of two edges (`edge_distance`), found by branch and bound over
//! both trees. Where outlines do not meet, each path of one shape lies wholly inside or outside of the other's solid,
//! and one point of the path tells which.
//!
//! The first shape is measured in the body coordinates of the second, so that nothing is lost far from the origin.

use crate::edge::Edge;
use crate::edge_distance::{ClosestPair, edge_distance};
use crate::feature::EdgeId;
use crate::path::Path;
use crate::pose::Pose;
use crate::shape::Shape;
use crate::tree::{Below, FeatureTree};
use glam::DVec2;

/// Distance up to which outlines touch, as a fraction of the sum of both reaches and the distance of the bodies'
/// origins [-]: rounding.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Position of two posed shapes relative to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// The shapes have no point in common. One may lie in a hole of the other.
    Apart,
    /// The outlines cross, or touch to rounding.
    Crossing,
    /// All paths of the first shape lie in the solid of the second.
    FirstInside,
    /// All paths of the second shape lie in the solid of the first.
    SecondInside,
    /// The outlines do not meet, but some paths (of shapes in several pieces) lie in the other shape's solid.
    Overlapping,
}

/// The distance of two shapes at two poses, in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeDistance {
    /// Distance [m] of the outlines; 0 where they cross.
    pub distance: f64,
    /// Position of the shapes relative to each other.
    pub relation: Relation,
    /// A point of the first outline nearest to the second [m]; where they cross, one of the crossings.
    pub point_a: DVec2,
    /// A point of the second outline nearest to the first [m].
    pub point_b: DVec2,
    /// Edge of the first shape on which `point_a` lies.
    pub edge_a: EdgeId,
    /// Edge of the second shape on which `point_b` lies.
    pub edge_b: EdgeId,
}

impl Shape {
    /// Finds the distance of the outlines of this shape at `pose` and another at its own pose, and a nearest pair of
    /// points.
    ///
    /// The result is good to a few units in the last place of the shapes' size, of the radii of their arcs, and of
    /// their distance from each other: a nearly straight arc is known no better than the place of its centre.
    ///
    /// # Examples
    ///
    /// ```
    /// # use halfgap_geometry::{DVec2, Pose, Relation, Shape};
    /// let (ring, ball) = (Shape::ring(3.0, 2.0)?, Shape::disc(0.5)?);
    /// let ball_pose = Pose::new(DVec2::new(1.0, 0.0), 0.0);
    /// let found = ball.distance(&ball_pose, &ring, &Pose::IDENTITY);
    /// assert!((found.distance - 0.5).abs() < 1e-15);
    /// assert_eq!(found.relation, Relation::Apart);
    /// assert!((found.point_b - DVec2::new(2.0, 0.0)).length() < 1e-15);
    /// # Ok::<(), halfgap_geometry::ShapeError>(())
    /// ```
    ///
    /// # Panics
    /// If a number of a pose, or the square of a distance, is not finite: at coordinates from about 1e150 m on.
    #[must_use]
    pub fn distance(&self, pose: &Pose, other: &Shape, other_pose: &Pose) -> ShapeDistance {
        let relative = pose.seen_from(other_pose);
        assert!(relative.is_finite(), "the numbers of a pose are finite");
        let mut search = Search { a: self, b: other, relative, best: f64::INFINITY, found: None };
        search.improve(0, 0, 0.0);
        let (pair, edge_a, edge_b) =
            search.found.expect("shapes have edges, and finite poses finite distances");
        let touches = pair.distance <= touching_distance(self, other, &relative);
        ShapeDistance {
            distance: pair.distance,
            relation: if touches { Relation::Crossing } else { relation_of_apart(self, other, &relative) },
            point_a: other_pose.point_to_world(pair.point_a),
            point_b: other_pose.point_to_world(pair.point_b),
            edge_a,
            edge_b,
        }
    }

    /// Returns the position of this shape at `pose` relative to another at its own pose: the relation of
    /// [`distance`](Self::distance), in less time, since edges that do not meet need not be measured. Shapes at poses
    /// that are not finite are apart.
    #[must_use]
    pub fn relation(&self, pose: &Pose, other: &Shape, other_pose: &Pose) -> Relation {
        let relative = pose.seen_from(other_pose);
        if !relative.is_finite() {
            return Relation::Apart;
        }
        let best = touching_distance(self, other, &relative).next_up();
        let mut search = Search { a: self, b: other, relative, best, found: None };
        search.improve(0, 0, 0.0);
        match search.found {
            Some(_) => Relation::Crossing,
            None => relation_of_apart(self, other, &relative),
        }
    }
}

struct Search<'a> {
    a: &'a Shape,
    b: &'a Shape,
    /// Pose of `a` in the coordinates of `b`.
    relative: Pose,
    best: f64,
    found: Option<(ClosestPair, EdgeId, EdgeId)>,
}

impl Search<'_> {
    /// Looks for a pair nearer than the best below two nodes, which are at least `bound` apart.
    fn improve(&mut self, node_a: usize, node_b: usize, bound: f64) {
        if bound >= self.best {
            return;
        }
        let (tree_a, tree_b) = (self.a.tree(), self.b.tree());
        let pairs = match (tree_a.below(node_a), tree_b.below(node_b)) {
            (Below::Leaf(a), Below::Leaf(b)) => {
                if let (Some(a), Some(b)) = (self.a.whole_edge(a), self.b.whole_edge(b)) {
                    self.compare(a, b);
                }
                return;
            }
            (Below::Branch(children), Below::Leaf(_)) => children.map(|child| (child, node_b)),
            (Below::Branch(children), Below::Branch(_))
                if tree_a.node(node_a).radius >= tree_b.node(node_b).radius =>
            {
                children.map(|child| (child, node_b))
            }
            (_, Below::Branch(children)) => children.map(|child| (node_a, child)),
        };
        let mut pairs = pairs.map(|(a, b)| (self.bound(tree_a, a, tree_b, b), a, b));
        pairs.sort_by(|p, q| p.0.total_cmp(&q.0));
        for (bound, a, b) in pairs {
            self.improve(a, b, bound);
        }
    }

    fn compare(&mut self, id_a: EdgeId, id_b: EdgeId) {
        let edge: Edge = self.a.edge(id_a).posed(&self.relative);
        let pair = edge_distance(&edge, self.b.edge(id_b));
        if pair.distance < self.best {
            self.best = pair.distance;
            self.found = Some((pair, id_a, id_b));
        }
    }

    /// Lower bound [m] of the distance of the features below two nodes; may be negative.
    fn bound(&self, tree_a: &FeatureTree, a: usize, tree_b: &FeatureTree, b: usize) -> f64 {
        let (a, b) = (tree_a.node(a), tree_b.node(b));
        let center_a = self.relative.point_to_world(a.center);
        let center_b = self.relative.point_to_body(b.center);
        let of_circles = (center_a - b.center).length() - a.radius - b.radius;
        let of_box_b = b.bounds.distance_to(center_a) - a.radius;
        let of_box_a = a.bounds.distance_to(center_b) - b.radius;
        of_circles.max(of_box_a).max(of_box_b)
    }
}

/// Distance [m] up to which two outlines touch, `relative` being the pose of `a` in the coordinates of `b`.
fn touching_distance(a: &Shape, b: &Shape, relative: &Pose) -> f64 {
    ROUNDING * (a.reach() + b.reach() + relative.position.length())
}

/// Relation of two shapes whose outlines do not touch.
fn relation_of_apart(a: &Shape, b: &Shape, relative: &Pose) -> Relation {
    let start = |path: &Path| path.edges()[0].from();
    let in_b = |path: &&Path| b.contains(relative.point_to_world(start(path)));
    let in_a = |path: &&Path| a.contains(relative.point_to_body(start(path)));
    let first = a.paths().iter().filter(in_b).count();
    let second = b.paths().iter().filter(in_a).count();
    match (first, second) {
        (0, 0) => Relation::Apart,
        (count, 0) if count == a.paths().len() => Relation::FirstInside,
        (0, count) if count == b.paths().len() => Relation::SecondInside,
        _ => Relation::Overlapping,
    }
}
