//! Points in which two edges cross.
//!
//! Two lines cross if each has the ends of the other on both of its sides (and the crossing lies on both, which only
//! rounding denies); a line meets a circle half a chord to either side of the centre's foot; two circles meet
//! on the radical line, whose offset is measured from the centre of the lesser circle (seen from the larger
//! one a crossing is known only to rounding times the ratio of the radii). Rounding decides whether edges that only
//! touch are found to cross: their distance is zero to rounding either way.

use crate::arc::Arc;
use crate::edge::Edge;
use crate::line::Line;
use glam::DVec2;

/// Rounding of a crossing of two lines, as a fraction of the sum of their lengths [-]: up to this distance from a line
/// a point counts as on it.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The points in which two edges cross: at most two [m].
///
/// Edges that lie on the same line or circle have no single crossings, so none are given.
///
/// # Examples
///
/// ```
/// # use halfgap_geometry::{Arc, DVec2, Edge, Line, edge_crossings};
/// let line = Edge::Line(Line::new(DVec2::new(-2.0, 0.6), DVec2::new(2.0, 0.6))?);
/// let circle = Edge::Arc(Arc::circle(DVec2::ZERO, DVec2::X, false)?);
/// let crossings: Vec<DVec2> = edge_crossings(&line, &circle).collect();
/// assert_eq!(crossings.len(), 2);
/// assert!((crossings[0] - DVec2::new(-0.8, 0.6)).length() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[inline]
pub fn edge_crossings(a: &Edge, b: &Edge) -> impl Iterator<Item = DVec2> {
    let found = match (a, b) {
        (Edge::Line(a), Edge::Line(b)) => [line_line(a, b), None],
        (Edge::Line(line), Edge::Arc(arc)) | (Edge::Arc(arc), Edge::Line(line)) => line_arc(line, arc),
        (Edge::Arc(a), Edge::Arc(b)) if a.radius() <= b.radius() => arc_arc(a, b),
        (Edge::Arc(a), Edge::Arc(b)) => arc_arc(b, a),
    };
    found.into_iter().flatten()
}

fn line_line(a: &Line, b: &Line) -> Option<DVec2> {
    let (from_b, to_b) = (a.signed_distance(b.from()), a.signed_distance(b.to()));
    let (from_a, to_a) = (b.signed_distance(a.from()), b.signed_distance(a.to()));
    if from_a == to_a || from_b == to_b || from_a * to_a > 0.0 || from_b * to_b > 0.0 {
        return None;
    }
    // At an end of `a` that lies on the other line the fraction is exactly 0 or 1.
    let point = a.from() + (a.to() - a.from()) * (from_a / (from_a - to_a));
    // The sides of lines that are parallel to rounding are noise, and the point may be anywhere.
    let off = (b.nearest(point) - point).length();
    (off <= ROUNDING * (a.length() + b.length())).then_some(point)
}

fn line_arc(line: &Line, arc: &Arc) -> [Option<DVec2>; 2] {
    let offset = line.signed_distance(arc.center()).abs();
    let half_chord_sq = (arc.radius() - offset) * (arc.radius() + offset);
    if half_chord_sq < 0.0 {
        return [None; 2];
    }
    let foot = line.direction().dot(arc.center() - line.from());
    let half_chord = half_chord_sq.sqrt();
    [foot - half_chord, foot + half_chord].map(|along| {
        let point = line.from() + line.direction() * along;
        ((0.0..=line.length()).contains(&along) && is_on(arc, point)).then_some(point)
    })
}

/// Crossings of two arcs, of which `a` has the lesser radius.
fn arc_arc(a: &Arc, b: &Arc) -> [Option<DVec2>; 2] {
    let offset = b.center() - a.center();
    let distance = offset.length();
    if distance == 0.0 {
        return [None; 2];
    }
    let towards = offset / distance;
    let power = (distance - b.radius()) * (distance + b.radius());
    let along = (power + a.radius() * a.radius()) / (2.0 * distance);
    let half_chord_sq = (a.radius() - along) * (a.radius() + along);
    if half_chord_sq < 0.0 {
        return [None; 2];
    }
    let half_chord = half_chord_sq.sqrt();
    [-half_chord, half_chord].map(|across| {
        let point = a.center() + towards * along + towards.perp() * across;
        (is_on(a, point) && is_on(b, point)).then_some(point)
    })
}

/// True if a point of the arc's circle lies on the arc.
fn is_on(arc: &Arc, point: DVec2) -> bool {
    arc.directions().contains((point - arc.center()) / arc.radius())
}
