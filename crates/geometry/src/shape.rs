//! A shape: oriented paths, mass properties, features and their tree, in body coordinates.

use crate::bounds::Aabb;
use crate::edge::Edge;
use crate::error::ShapeError;
use crate::feature::{
    DirectionRange, EdgeId, Feature, FeatureId, FeatureKind, FeatureSource, LineFeature, RoundFeature,
};
use crate::mass::MassProperties;
use crate::outline::build_outline;
use crate::path::{Path, PathSpec};
use crate::pose::Pose;
use crate::tree::{FeatureTree, Node};
use glam::DVec2;
use std::f64::consts::PI;
use std::sync::Arc as Shared;

/// Turn [rad] between two edges up to which their joint is smooth: the edges carry all contacts there.
const SMOOTH_CORNER: f64 = 1e-9;
/// Size of the largest bodies for which a line extends beyond a smooth joint with another line, as a multiple of the
/// size of the line's shape [-].
const LARGEST_NEIGHBOUR: f64 = 64.0;

/// A flat, rigid shape in body coordinates, which may have holes and several pieces. Clones share their data.
#[derive(Clone, Debug)]
pub struct Shape {
    parts: Shared<Parts>,
}

#[derive(Debug)]
struct Parts {
    paths: Vec<Path>,
    mass: MassProperties,
    bounds: Aabb,
    reach: f64,
    features: Vec<Feature>,
    sources: Vec<FeatureSource>,
    /// Lever [m] of each feature, see [`Shape::lever`].
    levers: Vec<f64>,
    tree: FeatureTree,
}

impl Shape {
    /// Builds the shape that the given closed paths outline: points that an odd number of paths surround are solid,
    /// whichever way the paths run.
    ///
    /// End points and arc radii may be off by 1e-6 of the shape's size, and are then made exact. The ends of an arc of more
    /// than half a turn must be better by as much as their distance is less than its radius: an error of either turns
    /// the arc about the other end.
    ///
    /// # Errors
    /// No paths; open, empty, crossing or degenerate paths: the error names path and edge. Shapes so small or so large
    /// that the fourth power of their size under- or overflows.
    pub fn from_paths(specs: &[PathSpec]) -> Result<Self, ShapeError> {
        let shape = Self::from_oriented(build_outline(specs)?);
        if shape.parts.mass.is_sound() {
            Ok(shape)
        } else {
            Err(ShapeError::NoMoments { reach: shape.reach() })
        }
    }

    /// The shape moved by `shift` [m] in body coordinates.
    #[must_use]
    pub fn translated(&self, shift: DVec2) -> Self {
        if shift == DVec2::ZERO {
            return self.clone();
        }
        Self::from_oriented(self.parts.paths.iter().map(|path| path.translated(shift)).collect())
    }

    /// True if two shapes are one and the same in memory.
    #[cfg(test)]
    pub(crate) fn is_shared_with(&self, other: &Shape) -> bool {
        Shared::ptr_eq(&self.parts, &other.parts)
    }

    /// The closed paths, each with the solid on its left.
    #[must_use]
    #[inline]
    pub fn paths(&self) -> &[Path] {
        &self.parts.paths
    }

    /// All edges of all paths, in the order of [`paths`](Self::paths).
    #[inline]
    pub fn edges(&self) -> impl Iterator<Item = &Edge> {
        self.parts.paths.iter().flat_map(Path::edges)
    }

    /// Area, centroid and second moment of the solid.
    #[must_use]
    #[inline]
    pub fn mass_properties(&self) -> MassProperties {
        self.parts.mass
    }

    /// Smallest axis-aligned box [m] around the shape in body coordinates.
    #[must_use]
    #[inline]
    pub fn bounds(&self) -> Aabb {
        self.parts.bounds
    }

    /// Smallest axis-aligned box [m] around the shape at `pose`, in world coordinates.
    #[must_use]
    #[inline]
    pub fn bounds_at(&self, pose: &Pose) -> Aabb {
        let x_axis = pose.vector_to_body(DVec2::X);
        let y_axis = pose.vector_to_body(DVec2::Y);
        let max = DVec2::new(self.extent(x_axis), self.extent(y_axis));
        let min = DVec2::new(-self.extent(-x_axis), -self.extent(-y_axis));
        Aabb { min: pose.position + min, max: pose.position + max }
    }

    /// Radius [m] of a shape that is a single disc about the body's origin, whose angle does not matter; `None` for all
    /// other shapes.
    #[must_use]
    #[inline]
    pub fn centered_disc(&self) -> Option<f64> {
        match self.features() {
            [Feature::Round(round)] if round.center == DVec2::ZERO && round.range == DirectionRange::Full => {
                (round.radius > 0.0).then_some(round.radius)
            }
            _ => None,
        }
    }

    /// Largest distance [m] of a point of the shape from the body's origin.
    #[must_use]
    #[inline]
    pub fn reach(&self) -> f64 {
        self.parts.reach
    }

    /// True if the segment between any two points of the shape lies in it.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        let [path] = self.paths() else { return false };
        let next = path.edges().iter().cycle().skip(1);
        path.edges()
            .iter()
            .zip(next)
            .all(|(before, after)| before.curvature() >= 0.0 && corner_turn(before, after) >= -SMOOTH_CORNER)
    }

    /// Signed distance [m] from the body's origin, along a unit vector [body coordinates], of the shape's farthest
    /// point along it (the support function); negative if the whole shape lies behind the origin.
    #[must_use]
    #[inline]
    pub fn extent(&self, direction: DVec2) -> f64 {
        let bound = |node: &Node| -(node.center.dot(direction) + node.radius);
        let farthest = self.parts.tree.find_least(f64::INFINITY, &bound, &mut |id| {
            Some((-feature_extent(self.feature(id), direction), ()))
        });
        farthest.map_or(0.0, |(least, ())| -least)
    }

    /// Returns the edge of a feature; for a vertex, the edge that starts at it.
    ///
    /// # Panics
    /// If the id is not that of one of this shape's features.
    #[must_use]
    #[inline]
    pub fn edge_of(&self, id: FeatureId) -> &Edge {
        let source = self.source(id);
        self.edge(EdgeId { path: source.path, edge: source.edge })
    }

    /// Returns an edge by its id.
    ///
    /// # Panics
    /// If the id is not that of one of this shape's edges.
    #[must_use]
    #[inline]
    pub fn edge(&self, id: EdgeId) -> &Edge {
        &self.parts.paths[id.path as usize].edges()[id.edge as usize]
    }

    /// Id of the edge of a feature; `None` for a vertex.
    pub(crate) fn whole_edge(&self, id: FeatureId) -> Option<EdgeId> {
        let FeatureSource { path, edge, kind } = self.source(id);
        (kind != FeatureKind::Vertex).then_some(EdgeId { path, edge })
    }

    /// The parts of the shape that can touch others: vertices, arcs and lines, in the order of the edges.
    #[must_use]
    #[inline]
    pub fn features(&self) -> &[Feature] {
        &self.parts.features
    }

    /// Returns a feature by its id.
    ///
    /// # Panics
    /// If the id is not that of one of this shape's features.
    #[must_use]
    #[inline]
    pub fn feature(&self, id: FeatureId) -> &Feature {
        &self.parts.features[id.0 as usize]
    }

    /// Length [m] by which an angle outside of a feature's range is multiplied to become a distance: the radius of an
    /// arc, the length of the shorter of the two edges at a vertex, the length of a line.
    ///
    /// # Panics
    /// If the id is not that of one of this shape's features.
    #[must_use]
    #[inline]
    pub fn lever(&self, feature: FeatureId) -> f64 {
        self.parts.levers[feature.0 as usize]
    }

    /// Part of the outline that a feature stands for.
    ///
    /// # Panics
    /// If the id is not that of one of this shape's features.
    #[must_use]
    #[inline]
    pub fn source(&self, id: FeatureId) -> FeatureSource {
        self.parts.sources[id.0 as usize]
    }

    /// Vertices at the start and at the end of an edge; `None` where the outline goes on smoothly or turns inwards, and
    /// twice `None` for a vertex.
    ///
    /// # Panics
    /// If the id is not that of one of this shape's features.
    #[must_use]
    pub fn ends_of(&self, feature: FeatureId) -> [Option<FeatureId>; 2] {
        let Some(EdgeId { path, edge }) = self.whole_edge(feature) else { return [None; 2] };
        let count = self.parts.paths[path as usize].edges().len();
        let after = if edge as usize + 1 == count { 0 } else { edge + 1 };
        [edge, after].map(|edge| {
            let corner = FeatureSource { path, edge, kind: FeatureKind::Vertex };
            // Features are in the order of their edges, a vertex before the edge that starts at it.
            let place = self.parts.sources.partition_point(|source| source < &corner);
            (self.parts.sources.get(place) == Some(&corner)).then(|| FeatureId::from_index(place))
        })
    }

    /// True if a straight edge continues a convex arc smoothly at one end: the end nearer to `direction`, a vector from
    /// the arc's centre in body coordinates. False for all other features.
    ///
    /// # Panics
    /// If the id is not that of one of this shape's features.
    #[must_use]
    pub fn goes_on_straight(&self, arc: FeatureId, direction: DVec2) -> bool {
        let FeatureSource { path, edge, kind } = self.source(arc);
        let Feature::Round(round) = self.feature(arc) else { return false };
        let ends = round.range.ends().filter(|_| kind == FeatureKind::ConvexArc);
        let Some([from, to]) = ends else { return false };
        let (edges, edge) = (self.parts.paths[path as usize].edges(), edge as usize);
        let neighbour = if direction.dot(to) > direction.dot(from) {
            let after = &edges[(edge + 1) % edges.len()];
            is_smooth(&edges[edge], after).then_some(after)
        } else {
            let before = &edges[(edge + edges.len() - 1) % edges.len()];
            is_smooth(before, &edges[edge]).then_some(before)
        };
        matches!(neighbour, Some(Edge::Line(_)))
    }

    /// The edges that end and start at a vertex, in this order; `None` for an edge.
    ///
    /// # Panics
    /// If the id is not that of one of this shape's features.
    #[must_use]
    pub fn sides_of(&self, feature: FeatureId) -> Option<[FeatureId; 2]> {
        let FeatureSource { path, edge, kind } = self.source(feature);
        if kind != FeatureKind::Vertex {
            return None;
        }
        let before = if edge == 0 { self.parts.paths[path as usize].edges().len() as u32 } else { edge } - 1;
        let whole = |edge: u32| {
            let corner = FeatureSource { path, edge, kind: FeatureKind::Vertex };
            let place = self.parts.sources.partition_point(|source| source <= &corner);
            FeatureId::from_index(place)
        };
        Some([before, edge].map(whole))
    }

    /// The bounding tree over the features.
    #[must_use]
    #[inline]
    pub fn tree(&self) -> &FeatureTree {
        &self.parts.tree
    }

    /// The shape of paths that have the solid on their left.
    pub(crate) fn from_oriented(paths: Vec<Path>) -> Self {
        let boxes = paths.iter().map(Path::bounds);
        let bounds = boxes.reduce(Aabb::union).unwrap_or(Aabb::around(DVec2::ZERO));
        let mass = MassProperties::of_paths(&paths, bounds.center());
        let size = bounds.size().length();
        let all = paths.iter().enumerate().flat_map(|path| path_features(path, size));
        let (features, sources): (Vec<_>, Vec<_>) = all.unzip();
        let boxes: Vec<Aabb> = sources.iter().map(|source| feature_box(&paths, source)).collect();
        let tree = FeatureTree::build(&features, &boxes);
        let reach = features.iter().map(|feature| feature.farthest(DVec2::ZERO)).fold(0.0, f64::max);
        let levers = features.iter().zip(&sources).map(|(f, source)| lever(&paths, f, source)).collect();
        let parts = Parts { paths, mass, bounds, reach, features, sources, levers, tree };
        Self { parts: Shared::new(parts) }
    }
}

fn lever(paths: &[Path], feature: &Feature, source: &FeatureSource) -> f64 {
    match feature {
        Feature::Line(line) => line.end - line.start,
        Feature::Round(round) if round.radius != 0.0 => round.radius.abs(),
        Feature::Round(_) => {
            let edges = paths[source.path as usize].edges();
            let (after, count) = (source.edge as usize, edges.len());
            edges[after].length().min(edges[(after + count - 1) % count].length())
        }
    }
}

/// Box around a feature, taken from its edge: the center of a flat arc would place its ends less exactly.
fn feature_box(paths: &[Path], source: &FeatureSource) -> Aabb {
    let edge = &paths[source.path as usize].edges()[source.edge as usize];
    if source.kind == FeatureKind::Vertex { Aabb::around(edge.from()) } else { edge.bounds() }
}

/// Signed distance [m] from the body's origin, along a unit vector, of the feature's farthest point along it.
fn feature_extent(feature: &Feature, direction: DVec2) -> f64 {
    match feature {
        Feature::Line(line) => {
            line.point_at(line.start).dot(direction).max(line.point_at(line.end).dot(direction))
        }
        Feature::Round(round) => {
            let (center, radius) = (round.center.dot(direction), round.radius.abs());
            match round.range.ends() {
                // The neighbours of a concave arc reach farther than its inner points.
                Some(ends) if round.radius < 0.0 || !round.range.contains(direction) => {
                    center + radius * ends[0].dot(direction).max(ends[1].dot(direction))
                }
                _ => center + radius,
            }
        }
    }
}

/// The features of a path, each edge after the vertex at which it starts.
fn path_features((index, path): (usize, &Path), size: f64) -> Vec<(Feature, FeatureSource)> {
    let edges = path.edges();
    let mut found = Vec::with_capacity(2 * edges.len());
    for (place, edge) in edges.iter().enumerate() {
        let source = |kind| FeatureSource {
            path: u32::try_from(index).unwrap_or(u32::MAX),
            edge: u32::try_from(place).unwrap_or(u32::MAX),
            kind,
        };
        let before = &edges[(place + edges.len() - 1) % edges.len()];
        let after = &edges[(place + 1) % edges.len()];
        if let Some(vertex) = corner(before, edge) {
            found.push((Feature::Round(vertex), source(FeatureKind::Vertex)));
        }
        let joints = [(before, corner_turn(before, edge)), (after, corner_turn(edge, after))];
        let smooth = joints.map(|(other, turn)| (turn.abs() <= SMOOTH_CORNER).then_some((other, turn.abs())));
        let feature = edge_feature(edge, smooth, size);
        found.push((feature, source(feature.kind())));
    }
    found
}

/// Angle [rad] from the end of one edge to the start of the next, positive at a corner that points outwards.
fn corner_turn(before: &Edge, after: &Edge) -> f64 {
    let (arriving, leaving) = (before.end_direction(), after.start_direction());
    let turn = libm::atan2(arriving.perp_dot(leaving), arriving.dot(leaving));
    let bend = before.curvature() + after.curvature();
    if PI - turn.abs() >= SMOOTH_CORNER || bend == 0.0 {
        return turn;
    }
    // At a cusp the directions are opposite to rounding: the curvatures tell which edge lies on the left.
    let solid_between = bend < 0.0;
    if solid_between { PI } else { -PI }
}

fn is_smooth(before: &Edge, after: &Edge) -> bool {
    corner_turn(before, after).abs() <= SMOOTH_CORNER
}

/// The vertex between two edges; `None` if the joint is smooth or points inwards.
fn corner(before: &Edge, after: &Edge) -> Option<RoundFeature> {
    let turn = corner_turn(before, after);
    // The outward normal is the direction of travel turned by -90 degrees.
    let range =
        DirectionRange::between(-before.end_direction().perp(), -after.start_direction().perp(), turn.abs());
    (turn > SMOOTH_CORNER).then_some(RoundFeature { center: after.from(), radius: 0.0, range })
}

/// The feature of an edge of a shape of the given size [m]. `smooth` holds, for each end at which the outline goes on
/// smoothly, the neighbouring edge and the turn [rad] towards it, not negative.
///
/// No vertex stands at a smooth joint, so features extend over the opening that the turn leaves between neighbours; the
/// surface differs from them there by the square of the turn.
fn edge_feature(edge: &Edge, smooth: [Option<(&Edge, f64)>; 2], size: f64) -> Feature {
    match edge {
        Edge::Line(line) => {
            let (normal, direction) = (line.normal(), line.direction());
            let [before, after] = smooth.map(|joint| match joint {
                Some((Edge::Line(other), turn)) => (turn * LARGEST_NEIGHBOUR * size).min(other.length()),
                _ => 0.0,
            });
            let start = direction.dot(line.from());
            // Both ends lie on the line only to rounding; the middle is farthest from both.
            let offset = normal.dot(0.5 * (line.from() + line.to()));
            let (start, end) = (start - before, start + line.length() + after);
            Feature::Line(LineFeature { normal, direction, offset, start, end })
        }
        Edge::Arc(arc) => {
            // An arc flatter than one as large as its shape extends beyond its end by no greater length than that one.
            let flatness = (size / arc.radius()).min(1.0);
            let [first, last] =
                smooth.map(|joint| joint.map_or(0.0, |(_, turn)| turn.max(SMOOTH_CORNER * flatness)));
            let (radius, grown) =
                if arc.is_convex() { (arc.radius(), [first, last]) } else { (-arc.radius(), [last, first]) };
            let range = arc.directions().grown(grown[0], grown[1], arc.sweep_angle().abs());
            Feature::Round(RoundFeature { center: arc.center(), radius, range })
        }
    }
}
