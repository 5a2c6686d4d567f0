//! Closest points of two edges.
//!
//! Edges that cross are at distance 0. Otherwise, at a closest pair, either one point is an end of its edge, or both
//! lie on a common normal: the perpendicular from an arc's centre to a line, or the line of two centres. Each such
//! candidate on one edge is paired with its nearest point of the other; the least pair wins.

use crate::arc::Arc;
use crate::crossing::edge_crossings;
use crate::edge::Edge;
use glam::DVec2;

/// A closest pair of points of two edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPair {
    /// Distance [m] of the points: 0 if the edges cross.
    pub distance: f64,
    /// Point of the first edge [m].
    pub point_a: DVec2,
    /// Point of the second edge [m].
    pub point_b: DVec2,
}

impl ClosestPair {
    fn between(point_a: DVec2, point_b: DVec2) -> Self {
        Self { distance: (point_a - point_b).length(), point_a, point_b }
    }
}

/// Finds a closest pair of points of two edges.
///
/// Edges are curves, not regions: an arc within a circle is apart from it. Every pair of edges has an answer, good to a
/// few units in the last place of the largest radius or coordinate [m].
///
/// # Examples
///
/// ```
/// # use halfgap_geometry::{Arc, DVec2, Edge, edge_distance};
/// // Half circles of radius 1 m with centres 3 m apart leave a gap of 1 m.
/// let half = |x: f64| Arc::new(DVec2::new(x, 0.0), 1.0, 0.0, std::f64::consts::PI);
/// let pair = edge_distance(&Edge::Arc(half(0.0)?), &Edge::Arc(half(3.0)?));
/// assert!((pair.distance - 1.0).abs() < 1e-15);
/// # Ok::<(), halfgap_geometry::ArcError>(())
/// ```
#[must_use]
pub fn edge_distance(a: &Edge, b: &Edge) -> ClosestPair {
    if let Some(point) = edge_crossings(a, b).next() {
        return ClosestPair { distance: 0.0, point_a: point, point_b: point };
    }
    let common = common_normal_points(a, b).into_iter().flatten();
    let from_a = [a.from(), a.to()].into_iter().chain(common).map(|p| ClosestPair::between(p, b.nearest(p)));
    let from_b = [b.from(), b.to()].into_iter().map(|p| ClosestPair::between(a.nearest(p), p));
    let first = ClosestPair::between(a.from(), b.nearest(a.from()));
    from_a.chain(from_b).fold(first, |best, pair| if pair.distance < best.distance { pair } else { best })
}

/// Points of `a` through which a common normal of both edges may run.
fn common_normal_points(a: &Edge, b: &Edge) -> [Option<DVec2>; 2] {
    match (a, b) {
        (Edge::Line(_), Edge::Line(_)) => [None; 2],
        (Edge::Line(line), Edge::Arc(arc)) => [Some(line.nearest(arc.center())), None],
        (Edge::Arc(arc), Edge::Line(line)) => {
            // Only the side of the circle that faces the line can be nearest without crossing it.
            let towards =
                if line.signed_distance(arc.center()) > 0.0 { -line.normal() } else { line.normal() };
            [arc_point(arc, towards), None]
        }
        (Edge::Arc(a), Edge::Arc(b)) => {
            let offset = b.center() - a.center();
            let distance = offset.length();
            if distance == 0.0 {
                return [None; 2];
            }
            [arc_point(a, offset / distance), arc_point(a, -offset / distance)]
        }
    }
}

fn arc_point(arc: &Arc, direction: DVec2) -> Option<DVec2> {
    arc.directions().contains(direction).then(|| arc.center() + direction * arc.radius())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::line::Line;
    use std::f64::consts::PI;

    fn line(from: (f64, f64), to: (f64, f64)) -> Edge {
        Edge::Line(Line::new(from.into(), to.into()).expect("a fine line"))
    }

    fn arc(center: (f64, f64), radius: f64, start: f64, sweep: f64) -> Edge {
        Edge::Arc(Arc::new(center.into(), radius, start, sweep).expect("a fine arc"))
    }

    #[test]
    fn concentric_arcs_are_apart_by_the_radius_difference() {
        let (inner, outer) = (arc((1.0, 2.0), 1.0, 0.1, 3.0), arc((1.0, 2.0), 1.5, 2.0, -1.0));
        assert!((edge_distance(&inner, &outer).distance - 0.5).abs() < 1e-15);
        assert!((edge_distance(&outer, &inner).distance - 0.5).abs() < 1e-15);
    }

    #[test]
    fn overlapping_edges_are_at_no_distance() {
        assert_eq!(edge_distance(&line((0.0, 0.0), (2.0, 0.0)), &line((1.0, 0.0), (3.0, 0.0))).distance, 0.0);
        let same_circle = edge_distance(&arc((0.0, 0.0), 1.0, 0.0, 2.0), &arc((0.0, 0.0), 1.0, 1.0, 2.0));
        assert!(same_circle.distance < 1e-15);
    }

    #[test]
    fn an_arc_over_a_line_is_nearest_at_its_lowest_point() {
        let floor = line((-5.0, 0.0), (5.0, 0.0));
        let bowl = arc((0.5, 3.0), 2.0, PI, PI);
        let pair = edge_distance(&bowl, &floor);
        assert!((pair.distance - 1.0).abs() < 1e-15);
        assert!((pair.point_b - DVec2::new(0.5, 0.0)).length() < 1e-15);
        let roof = arc((0.5, 3.0), 2.0, 0.0, PI);
        assert!((edge_distance(&floor, &roof).distance - 3.0).abs() < 1e-15);
    }

    #[test]
    fn edges_that_cross_are_at_no_distance() {
        let circle = arc((0.0, 0.0), 1.0, 0.0, 2.0 * PI);
        assert_eq!(edge_distance(&circle, &line((0.0, 0.0), (2.0, 0.3))).distance, 0.0);
        assert_eq!(edge_distance(&circle, &arc((1.5, 0.0), 1.0, 2.0, 2.0)).distance, 0.0);
        assert!((edge_distance(&circle, &line((0.0, 0.0), (0.3, 0.4))).distance - 0.5).abs() < 1e-15);
    }

    #[test]
    fn edges_on_one_line_are_apart_by_what_is_between_them() {
        for turn in 0..400 {
            let angle = 0.017 * f64::from(turn);
            let at = |place: f64| DVec2::new(0.3, -0.2) + DVec2::new(angle.cos(), angle.sin()) * place;
            let line = |from, to| Edge::Line(Line::new(at(from), at(to)).expect("a fine line"));
            for (first, last) in [(0.1, 1.0), (1.0, 0.1)] {
                let pair = edge_distance(&line(first, last), &line(1.5, 2.7));
                assert!((pair.distance - 0.5).abs() < 1e-15 * 2.0, "at {angle} rad: {}", pair.distance);
            }
        }
    }
}
