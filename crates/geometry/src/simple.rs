//! Test of whether the paths of an outline are simple: no two edges meet, except neighbours in their common vertex.
//!
//! Boxes are swept along x so that only pairs whose boxes overlap are tested. Edges that are not neighbours meet if
//! their distance is within the tolerance. Neighbours lie on two lines or circles through their common vertex, which
//! share at most one more point, its mirror image in the line of centres: they meet if that point lies on both edges,
//! or if the far end of one lies on the other (which covers edges that fold back onto each other).

use crate::bounds::Aabb;
use crate::edge::Edge;
use crate::edge_distance::edge_distance;
use crate::error::ShapeError;
use crate::path::Path;
use glam::DVec2;

/// Two edges that meet where they must not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting {
    a: Place,
    b: Place,
    point: DVec2,
}

/// Indices of a path and of an edge in it.
type Place = (usize, usize);

impl From<Meeting> for ShapeError {
    fn from(meeting: Meeting) -> Self {
        let ((path_a, edge_a), (path_b, edge_b)) = (meeting.a, meeting.b);
        ShapeError::Crossing { path_a, edge_a, path_b, edge_b, x: meeting.point.x, y: meeting.point.y }
    }
}

/// Finds the first pair of edges (in the order of paths and edges) that come within `tol` [m] of each other other than
/// in a common vertex.
pub(crate) fn find_meeting(paths: &[Path], tol: f64) -> Option<Meeting> {
    let mut items = sorted_items(paths, tol);
    let mut found: Option<Meeting> = None;
    let mut active: Vec<Item> = Vec::new();
    for item in items.drain(..) {
        active.retain(|other| other.bounds.max.x >= item.bounds.min.x);
        for other in active.iter().filter(|other| other.bounds.overlaps(&item.bounds)) {
            let (a, b) = if other.place < item.place { (other, &item) } else { (&item, other) };
            if found.is_some_and(|best| (best.a, best.b) <= (a.place, b.place)) {
                continue;
            }
            if let Some(point) = meeting_point(paths, a, b, tol) {
                found = Some(Meeting { a: a.place, b: b.place, point });
            }
        }
        active.push(item);
    }
    found
}

#[derive(Clone, Copy)]
struct Item<'a> {
    place: Place,
    edge: &'a Edge,
    bounds: Aabb,
}

fn sorted_items(paths: &[Path], tol: f64) -> Vec<Item<'_>> {
    let mut items: Vec<Item> = Vec::new();
    for (path, edges) in paths.iter().map(Path::edges).enumerate() {
        items.extend(edges.iter().enumerate().map(|(index, edge)| Item {
            place: (path, index),
            edge,
            bounds: edge.bounds().grown(tol),
        }));
    }
    items.sort_by(|p, q| p.bounds.min.x.total_cmp(&q.bounds.min.x).then(p.place.cmp(&q.place)));
    items
}

fn meeting_point(paths: &[Path], a: &Item, b: &Item, tol: f64) -> Option<DVec2> {
    let ((path_a, edge_a), (path_b, edge_b)) = (a.place, b.place);
    let count = paths[path_a].edges().len();
    let (a_then_b, b_then_a) = ((edge_a + 1) % count == edge_b, (edge_b + 1) % count == edge_a);
    if path_a == path_b && (a_then_b || b_then_a) {
        let common = [a_then_b.then(|| a.edge.to()), b_then_a.then(|| b.edge.to())];
        return neighbours_meet(a.edge, b.edge, common, tol);
    }
    let pair = edge_distance(a.edge, b.edge);
    (pair.distance <= tol).then_some(0.5 * (pair.point_a + pair.point_b))
}

/// Point [m] at which two neighbours meet apart from their common vertices; `None` if they do not.
fn neighbours_meet(a: &Edge, b: &Edge, common: [Option<DVec2>; 2], tol: f64) -> Option<DVec2> {
    let is_common = |p: DVec2| common.iter().flatten().any(|&vertex| (p - vertex).length() <= tol);
    let is_on = |edge: &Edge, p: DVec2| (edge.nearest(p) - p).length() <= tol;
    if let [Some(_), Some(_)] = common {
        // Two lines with both ends in common coincide.
        if let (Edge::Line(line), Edge::Line(_)) = (a, b) {
            return Some(0.5 * (line.from() + line.to()));
        }
        // Two arcs with both ends in common coincide if their middles do.
        let middle = middle_of(a);
        return is_on(b, middle).then_some(middle);
    }
    let vertex = common.into_iter().flatten().next()?;
    let ends = [a.from(), a.to(), b.from(), b.to()].into_iter();
    ends.chain(mirror_image(a, b, vertex)).find(|&p| !is_common(p) && is_on(a, p) && is_on(b, p))
}

/// Second common point of the whole lines or circles of two edges, given the first.
fn mirror_image(a: &Edge, b: &Edge, shared: DVec2) -> Option<DVec2> {
    let (on_mirror, along) = match (a, b) {
        (Edge::Line(_), Edge::Line(_)) => return None,
        (Edge::Line(line), Edge::Arc(arc)) | (Edge::Arc(arc), Edge::Line(line)) => {
            (arc.center(), line.normal())
        }
        (Edge::Arc(a), Edge::Arc(b)) => (a.center(), (b.center() - a.center()).try_normalize()?),
    };
    let across = along.perp();
    Some(shared - across * (2.0 * across.dot(shared - on_mirror)))
}

fn middle_of(edge: &Edge) -> DVec2 {
    match edge {
        Edge::Line(line) => 0.5 * (line.from() + line.to()),
        Edge::Arc(arc) => arc.center() + arc.middle_direction() * arc.radius(),
    }
}
