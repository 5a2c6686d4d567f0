//! A path of lines and arcs, open or closed.

use super::box_tree::BoxTree;
use super::edge_piece::EdgePiece;
use super::error::RailError;
use super::path::{Foot, RailHint, RailKnot, RailPlace};
use glam::DVec2;
use halfgap_geometry::{Aabb, Arc, Edge, EdgeError, EdgeSpec};
use std::f64::consts::PI;

/// Turn of a joint [rad] below which it is smooth; one that falls short of half a turn by less is a cusp.
const SMOOTH_TURN: f64 = 1e-6;

/// Distance of a point, as a fraction of the path's length [-]: off the path, up to which its place as followed from a
/// hint is not doubted; beyond the end of a piece, up to which it counts as beside the piece.
const ASTRAY: f64 = 1e-9;
/// Ratio of distances from a point [-] below which a place elsewhere on the path replaces the one followed from a hint.
pub(super) const NEARER: f64 = 0.5;

/// A path of edges. An open one has its two straight continuations as first and last piece.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct EdgePath {
    pieces: Vec<EdgePiece>,
    closed: bool,
    length: f64,
    /// Tree over the pieces, without the continuations.
    tree: BoxTree,
    knots: Vec<RailKnot>,
}

impl EdgePath {
    pub(super) fn new(start: DVec2, specs: &[EdgeSpec]) -> Result<Self, RailError> {
        let edges = build_edges(start, specs)?;
        let (Some(first), Some(last)) = (edges.first(), edges.last()) else {
            return Err(RailError::NoEdges);
        };
        let closed = first.from() == last.to();
        let mut pieces = Vec::with_capacity(edges.len() + 2);
        if !closed {
            pieces.push(EdgePiece::ray(first.from(), first.start_direction(), 0.0, [f64::NEG_INFINITY, 0.0]));
        }
        let mut length = 0.0;
        for edge in &edges {
            pieces.push(EdgePiece::new(edge, length));
            length += edge.length();
        }
        if !closed {
            pieces.push(EdgePiece::ray(last.to(), last.end_direction(), length, [0.0, f64::INFINITY]));
        }
        let boxes: Vec<Aabb> = edges.iter().map(Edge::bounds).collect();
        let tree = BoxTree::new(&boxes).ok_or(RailError::NoEdges)?;
        let knots = find_knots(&pieces, &edges, closed);
        if let Some(cusp) = knots.iter().find(|knot| knot.turn.abs() > PI - SMOOTH_TURN) {
            // An open path has a piece before its first edge.
            return Err(RailError::TurnsBack(cusp.after as usize - usize::from(!closed)));
        }
        Ok(Self { pieces, closed, length, tree, knots })
    }

    pub(super) fn length(&self) -> f64 {
        self.length
    }

    pub(super) fn is_closed(&self) -> bool {
        self.closed
    }

    pub(super) fn bounds(&self) -> Aabb {
        self.tree.bounds()
    }

    pub(super) fn knots(&self) -> &[RailKnot] {
        &self.knots
    }

    /// The joint at an end of a piece, forward or backward. Joints are in the order of pieces; the first piece of an open
    /// path has none before it.
    pub(super) fn knot_at_end(&self, piece: usize, forward: bool) -> Option<&RailKnot> {
        let after = if forward { self.neighbor(piece, true) } else { piece };
        self.knots.get(if self.closed { after } else { after.checked_sub(1)? })
    }

    /// Place [m] at which a piece is entered: its first one if it is entered forward, else its last one.
    pub(super) fn place_at_knot(&self, piece: usize, forward: bool) -> f64 {
        self.pieces.get(piece).map_or(0.0, |piece| piece.range[usize::from(!forward)])
    }

    pub(super) fn nearest(&self, point: DVec2, hint: Option<&RailHint>) -> RailPlace {
        let (piece, along) = match hint {
            None => {
                let (foot, start) = self.nearest_foot(point);
                return RailPlace::new(foot, start + foot.parameter);
            }
            Some(hint) if hint.stays => {
                let piece = self.hinted_piece(hint);
                (piece, self.pieces[piece].along(point, hint.parameter))
            }
            Some(hint) => self.follow(point, hint),
        };
        let mut foot = self.pieces[piece].foot(piece, point);
        foot.parameter = along;
        RailPlace::new(foot, self.pieces[piece].start + along)
    }

    #[inline]
    pub(super) fn foot(&self, point: DVec2, hint: Option<&RailHint>) -> Foot {
        let piece = match hint {
            None => return self.nearest_foot(point).0,
            Some(hint) if hint.stays => self.hinted_piece(hint),
            Some(hint) => self.follow(point, hint).0,
        };
        self.pieces[piece].foot(piece, point)
    }

    pub(super) fn place_at(&self, arc_length: f64) -> RailPlace {
        let arc_length = if self.closed { arc_length.rem_euclid(self.length) } else { arc_length };
        // The continuation before the path starts at 0 like the first edge, and ends there.
        let after = self.pieces.partition_point(|piece| piece.start + piece.range[0] <= arc_length);
        let piece = after.saturating_sub(1);
        let along = arc_length - self.pieces[piece].start;
        let mut foot = self.pieces[piece].foot_at(piece, along);
        foot.parameter = along;
        RailPlace::new(foot, arc_length)
    }

    /// The foot of a point on the whole path, and the arc length at which its piece starts [m]. The foot of a point
    /// beyond a corner is the corner itself, unless the point is so near that rounding would decide the direction to
    /// it.
    fn nearest_foot(&self, point: DVec2) -> (Foot, f64) {
        let index = self.nearest_piece(point);
        let piece = &self.pieces[index];
        let along = piece.along(point, self.near_middle(index));
        let nearest = along.clamp(piece.range[0], piece.range[1]);
        let is_beyond = (along - nearest).abs() > ASTRAY * self.length;
        let foot = if is_beyond {
            Foot { parameter: nearest, ..from_corner(&piece.foot_at(index, nearest), point) }
        } else {
            Foot { parameter: along, ..piece.foot(index, point) }
        };
        (foot, piece.start)
    }

    /// Index of the piece nearest to a point: a continuation, if the nearest place is an end and the point lies beyond
    /// it.
    #[inline]
    fn nearest_piece(&self, point: DVec2) -> usize {
        let rays = usize::from(!self.closed);
        let (mut best, mut least) = (rays, f64::INFINITY);
        self.tree.visit_nearest(point, &mut |index| {
            let distance_sq = self.pieces[index + rays].distance_sq(point);
            if distance_sq < least {
                (best, least) = (index + rays, distance_sq);
            }
            least
        });
        if !self.closed {
            let last = self.pieces.len() - 1;
            for (ray, beside) in [(0, 1), (last, last - 1)] {
                // On the continuation the point is at least as near as at the end itself.
                let place = self.pieces[ray].along(point, 0.0);
                let beyond = place > self.pieces[ray].range[0] && place < self.pieces[ray].range[1];
                let end = self.pieces[ray].foot_at(ray, 0.0).point;
                if best == beside && beyond && (point - end).length_squared() <= least {
                    return ray;
                }
            }
        }
        best
    }

    /// Follows the path from the hint to the place of the point on it: piece and place in it [m]. A point that has gone
    /// round more than half of a circle since the hint seems to have gone the other way: if that leads off the path,
    /// the whole path is searched.
    fn follow(&self, point: DVec2, hint: &RailHint) -> (usize, f64) {
        let (piece, along) = self.walk(point, hint);
        let off = self.off(piece, point);
        if piece == self.hinted_piece(hint) || off <= ASTRAY * self.length {
            return (piece, along);
        }
        let nearest = self.nearest_piece(point);
        if self.off(nearest, point) >= NEARER * off {
            return (piece, along);
        }
        (nearest, self.pieces[nearest].along(point, self.near_middle(nearest)))
    }

    /// Distance [m] of a point from the whole line or circle of a piece.
    fn off(&self, piece: usize, point: DVec2) -> f64 {
        self.pieces[piece].foot(piece, point).gap.abs()
    }

    /// Follows the path from the hint to the first piece on which the point has a foot, or to a corner between two: a
    /// point beyond both has its place there, although either piece goes on straight.
    fn walk(&self, point: DVec2, hint: &RailHint) -> (usize, f64) {
        let mut piece = self.hinted_piece(hint);
        let mut along = self.pieces[piece].along(point, hint.parameter);
        let mut last_step = 0;
        for _ in 0..=self.pieces.len() {
            let [first, last] = self.pieces[piece].range;
            let step = i32::from(along > last) - i32::from(along < first);
            if step == 0 {
                break;
            }
            if step == -last_step {
                // Without a corner, the point may have gone round more than half of an arc's circle: its place stays.
                if self.is_corner(piece, step > 0) {
                    along = along.clamp(first, last);
                }
                break;
            }
            piece = self.neighbor(piece, step > 0);
            let [first, last] = self.pieces[piece].range;
            along = self.pieces[piece].along(point, if step > 0 { first } else { last });
            last_step = step;
        }
        (piece, along)
    }

    /// Index of the piece after or before. The infinite ranges of continuations keep the walk from going beyond them.
    fn neighbor(&self, piece: usize, forward: bool) -> usize {
        let count = self.pieces.len();
        if forward { (piece + 1) % count } else { (piece + count - 1) % count }
    }

    /// True if a piece ends in a corner, forward or backward.
    fn is_corner(&self, piece: usize, forward: bool) -> bool {
        self.knot_at_end(piece, forward).is_some_and(|knot| knot.turn != 0.0)
    }

    fn hinted_piece(&self, hint: &RailHint) -> usize {
        (hint.piece as usize).min(self.pieces.len() - 1)
    }

    fn near_middle(&self, piece: usize) -> f64 {
        let middle = self.pieces[piece].half_way();
        if middle.is_finite() { middle } else { 0.0 }
    }
}

/// The foot, at a corner of the path, of a point that has no foot on either piece: the normal lies along the line to
/// the point, on the side of the corner's normal.
fn from_corner(corner: &Foot, point: DVec2) -> Foot {
    let offset = point - corner.point;
    let side = if corner.normal.dot(offset) < 0.0 { -1.0 } else { 1.0 };
    let normal = side * offset.normalize_or(side * corner.normal);
    Foot { normal, tangent: -normal.perp(), curvature: 0.0, gap: side * offset.length(), ..*corner }
}

/// The edges, each starting exactly where the one before it ends.
fn build_edges(start: DVec2, specs: &[EdgeSpec]) -> Result<Vec<Edge>, RailError> {
    let Some(last) = specs.len().checked_sub(1) else { return Err(RailError::NoEdges) };
    if !(start.is_finite() && specs.iter().all(|spec| spec.to().is_finite())) {
        return Err(RailError::NotFinite);
    }
    let size = path_size(start, specs);
    let mut from = start;
    let mut edges = Vec::with_capacity(specs.len());
    for (index, spec) in specs.iter().enumerate() {
        let returns = (spec.to() - start).length() <= EdgeSpec::FIT * size;
        let to = if index == last && returns { start } else { spec.to() };
        edges.push(build_edge(index, from, to, spec, size)?);
        from = to;
    }
    Ok(edges)
}

/// Larger side of the box around the ends and the centers [m].
fn path_size(start: DVec2, specs: &[EdgeSpec]) -> f64 {
    let mut bounds = Aabb::around(start);
    for spec in specs {
        bounds = bounds.including(spec.to());
        if let EdgeSpec::Arc { center, .. } = spec {
            bounds = bounds.including(*center);
        }
    }
    bounds.size().max_element()
}

fn build_edge(index: usize, from: DVec2, to: DVec2, spec: &EdgeSpec, size: f64) -> Result<Edge, RailError> {
    let fit_tol = EdgeSpec::FIT * size;
    let edge = match *spec {
        EdgeSpec::Arc { center, clockwise, .. } if (to - from).length() <= fit_tol => {
            Arc::circle(center, from, clockwise).map(Edge::Arc).map_err(EdgeError::from)
        }
        _ => spec.edge_between(from, to, fit_tol),
    };
    edge.map_err(|error| match error {
        EdgeError::Line(source) => RailError::Line { edge: index, source },
        EdgeError::Arc(source) => RailError::Arc { edge: index, source },
    })
}

/// The joints of pieces, also those without any jump: a hint that stays on a piece must be moved to the next. An open
/// path has two pieces more than edges, its continuations.
fn find_knots(pieces: &[EdgePiece], edges: &[Edge], closed: bool) -> Vec<RailKnot> {
    let count = pieces.len();
    let directions = |piece: usize| -> [DVec2; 2] {
        let edge =
            if closed { Some(&edges[piece]) } else { piece.checked_sub(1).and_then(|at| edges.get(at)) };
        match edge {
            Some(edge) => [edge.start_direction(), edge.end_direction()],
            None => [pieces[piece].foot_at(piece, 0.0).tangent; 2],
        }
    };
    let joints = if closed { 0..count } else { 1..count };
    let mut knots = Vec::new();
    for after in joints {
        let before = (after + count - 1) % count;
        let ([_, arriving], [leaving, _]) = (directions(before), directions(after));
        let turn = libm::atan2(arriving.perp_dot(leaving), arriving.dot(leaving));
        let turn = if turn.abs() < SMOOTH_TURN { 0.0 } else { turn };
        if before == after && turn == 0.0 {
            continue;
        }
        let index = |piece: usize| u32::try_from(piece).unwrap_or(u32::MAX);
        knots.push(RailKnot {
            arc_length: pieces[after].start,
            before: index(before),
            after: index(after),
            turn,
            curvatures: [pieces[before].curvature(), pieces[after].curvature()],
        });
    }
    knots
}
