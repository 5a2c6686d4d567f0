//! Closed paths of edges, and the specification from which they are made. That of an edge is in `edge_spec`.

use crate::arc::Arc;
use crate::bounds::Aabb;
use crate::edge::Edge;
use crate::edge_spec::EdgeSpec;
use crate::error::{EdgeError, LineError, ShapeError};
use glam::DVec2;

/// Distance up to which vertices count as one point, as a fraction of the outline's size [-].
const COINCIDENT: f64 = 1e-9;

/// Specification of a closed path, whose last edge ends at `start`.
#[derive(Clone, Debug, PartialEq)]
pub struct PathSpec {
    /// Start of the first edge and end of the last one [m].
    pub start: DVec2,
    /// The edges in order.
    pub edges: Vec<EdgeSpec>,
}

impl PathSpec {
    /// The closed polygon through the given vertices [m].
    #[must_use]
    pub fn polygon(vertices: &[DVec2]) -> Self {
        let Some((&start, rest)) = vertices.split_first() else {
            return Self { start: DVec2::ZERO, edges: Vec::new() };
        };
        let edges = rest.iter().chain([&start]).map(|&to| EdgeSpec::Line { to }).collect();
        Self { start, edges }
    }

    /// The full counter-clockwise circle about `center` [m] of the given radius [m].
    #[must_use]
    pub fn circle(center: DVec2, radius: f64) -> Self {
        let start = center + DVec2::X * radius;
        Self { start, edges: vec![EdgeSpec::Arc { to: start, center, clockwise: false }] }
    }

    /// Index of the first edge with a number that is not finite; 0 if the start is not.
    pub(crate) fn first_not_finite(&self) -> Option<usize> {
        let edge = self.edges.iter().position(|edge| !edge.is_finite());
        if self.start.is_finite() { edge } else { Some(0) }
    }

    /// Box around all end points, the circles of all arcs of half a turn or more, and that of a path of a single arc.
    /// The size of the outline is measured on these boxes.
    fn rough_bounds(&self) -> Aabb {
        let mut from = self.start;
        let mut bounds = Aabb::around(from);
        for edge in &self.edges {
            bounds = bounds.including(edge.to());
            let circle = match *edge {
                // A single arc is a full circle, on whichever side of its start rounding puts its end.
                EdgeSpec::Arc { center, .. } if self.edges.len() == 1 => {
                    Some((center, (from - center).length()))
                }
                _ => edge.major_circle(from),
            };
            if let Some((center, radius)) = circle {
                bounds = bounds.union(Aabb::around_disc(center, radius));
            }
            from = edge.to();
        }
        bounds
    }
}

/// A closed path of edges, each starting exactly where the one before it ends.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Path {
    edges: Vec<Edge>,
}

impl Path {
    /// The edges in order.
    #[must_use]
    #[inline]
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Smallest axis-aligned box [m] around the path.
    #[must_use]
    #[inline]
    pub fn bounds(&self) -> Aabb {
        let start = Aabb::around(self.edges[0].from());
        self.edges.iter().fold(start, |bounds, edge| bounds.union(edge.bounds()))
    }

    /// True if the path runs around the point [m], in either direction. On the path itself the answer is either.
    #[must_use]
    #[inline]
    pub fn surrounds(&self, point: DVec2) -> bool {
        self.edges.iter().map(|edge| winding(edge, point)).sum::<i32>() != 0
    }

    pub(crate) fn reversed(&self) -> Self {
        Self { edges: self.edges.iter().rev().map(Edge::reversed).collect() }
    }

    pub(crate) fn translated(&self, shift: DVec2) -> Self {
        Self { edges: self.edges.iter().map(|edge| edge.translated(shift)).collect() }
    }
}

/// Size [m] of an outline: the larger side of the box around all its paths.
pub(crate) fn outline_size(specs: &[PathSpec]) -> f64 {
    let boxes = specs.iter().map(PathSpec::rough_bounds);
    boxes.reduce(Aabb::union).map_or(0.0, |bounds| bounds.size().max_element())
}

/// Distance [m] up to which two points of an outline of the given size [m] count as one.
pub(crate) fn coincidence_tol(size: f64) -> f64 {
    COINCIDENT * size
}

/// Builds the path with index `path` of an outline of the given size [m]; the numbers of `spec` must be finite.
pub(crate) fn build_path(spec: &PathSpec, path: usize, size: f64) -> Result<Path, ShapeError> {
    let Some(last) = spec.edges.len().checked_sub(1) else {
        return Err(ShapeError::EmptyPath { path });
    };
    let gap = (spec.edges[last].to() - spec.start).length();
    if gap > EdgeSpec::FIT * size {
        return Err(ShapeError::OpenPath { path, edge: last, gap });
    }
    if let [EdgeSpec::Arc { center, clockwise, .. }] = spec.edges[..] {
        let circle = Arc::circle(center, spec.start, clockwise);
        let circle = circle.map_err(|source| ShapeError::Arc { path, edge: 0, source })?;
        return Ok(Path { edges: vec![Edge::Arc(circle)] });
    }
    let mut edges = Vec::with_capacity(spec.edges.len());
    let mut from = spec.start;
    for (edge, part) in spec.edges.iter().enumerate() {
        let to = if edge == last { spec.start } else { part.to() };
        let length = (to - from).length();
        if length <= coincidence_tol(size) {
            return Err(ShapeError::CoincidentVertices { path, edge, length });
        }
        let built = part.edge_between(from, to, EdgeSpec::FIT * size);
        edges.push(built.map_err(|error| path_error(error, path, edge))?);
        from = to;
    }
    Ok(Path { edges })
}

/// The error of a path whose edge with index `edge` cannot be built.
fn path_error(error: EdgeError, path: usize, edge: usize) -> ShapeError {
    match error {
        EdgeError::Arc(source) => ShapeError::Arc { path, edge, source },
        EdgeError::Line(LineError::NotFinite) => ShapeError::NotFinite { path, edge },
        EdgeError::Line(LineError::ZeroLength(..)) => {
            ShapeError::CoincidentVertices { path, edge, length: 0.0 }
        }
    }
}

/// Number of crossings of the edge with the ray from `point` towards +x, upward ones counted +1 and downward ones -1.
///
/// An arc counts as its chord plus the border of the circular segment between the two, which winds around the point
/// once or not at all.
///
/// A point on a chord counts as lying just beyond it towards +x, and above its ends, for chord and segment alike.
pub(crate) fn winding(edge: &Edge, point: DVec2) -> i32 {
    let (from, to) = (edge.from() - point, edge.to() - point);
    // Positive if the point is on the left of the chord.
    let side = from.perp_dot(to);
    let chord = match (from.y <= 0.0, to.y <= 0.0) {
        (true, false) if side > 0.0 => 1,
        (false, true) if side < 0.0 => -1,
        _ => 0,
    };
    let Edge::Arc(arc) = edge else { return chord };
    if (point - arc.center()).length_squared() >= arc.radius() * arc.radius() {
        return chord;
    }
    let turn = if arc.is_convex() { 1 } else { -1 };
    if arc.is_circle() {
        return turn;
    }
    let on_chord_is_right = if from.y == to.y { to.x < from.x } else { to.y > from.y };
    let is_right = side < 0.0 || (side == 0.0 && on_chord_is_right);
    // A counter-clockwise arc lies on the right of its chord, however far it sweeps.
    chord + if is_right == arc.is_convex() { turn } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn pie(sweep: f64) -> Path {
        let at = |angle: f64| DVec2::new(angle.cos(), angle.sin());
        let spec = PathSpec {
            start: DVec2::ZERO,
            edges: vec![
                EdgeSpec::Line { to: DVec2::X },
                EdgeSpec::Arc { to: at(sweep), center: DVec2::ZERO, clockwise: false },
                EdgeSpec::Line { to: DVec2::ZERO },
            ],
        };
        build_path(&spec, 0, 2.0).expect("a fine pie")
    }

    #[test]
    fn a_pie_surrounds_what_lies_in_its_sweep() {
        for sweep in [0.5, 2.0, 3.0, 4.0, 5.5, 6.0] {
            let path = pie(sweep);
            for step in 0..100 {
                let angle = f64::from(step) / 100.0 * TAU + 0.001;
                for radius in [0.05, 0.5, 0.95, 1.05] {
                    let point = DVec2::new(angle.cos(), angle.sin()) * radius;
                    let expected = angle < sweep && radius < 1.0;
                    assert_eq!(path.surrounds(point), expected, "sweep {sweep}, {radius} m at {angle} rad");
                    assert_eq!(path.reversed().surrounds(point), expected);
                }
            }
        }
    }

    #[test]
    fn a_bulge_of_one_is_a_half_circle() {
        let spec = PathSpec {
            start: DVec2::NEG_X,
            edges: vec![
                EdgeSpec::Bulge { to: DVec2::X, bulge: 1.0 },
                EdgeSpec::Bulge { to: DVec2::NEG_X, bulge: 0.0 },
            ],
        };
        let path = build_path(&spec, 0, 2.0).expect("a fine half disc");
        let Edge::Arc(arc) = path.edges()[0] else { panic!("a bulge is an arc") };
        assert!(arc.center().length() < 1e-15 && (arc.radius() - 1.0).abs() < 1e-15);
        assert!((arc.sweep_angle() - TAU / 2.0).abs() < 1e-15 * 4.0);
        assert!(path.surrounds(DVec2::new(0.0, -0.5)) && !path.surrounds(DVec2::new(0.0, 0.5)));
    }

    #[test]
    fn two_half_circles_surround_their_common_chord() {
        for angle in [0.0, 0.3, 1.0, TAU / 4.0, 2.0, TAU / 2.0, 4.0, 5.5] {
            let ends = DVec2::new(f64::cos(angle), f64::sin(angle));
            for bulge in [1.0, -1.0] {
                let spec = PathSpec {
                    start: ends,
                    edges: vec![EdgeSpec::Bulge { to: -ends, bulge }, EdgeSpec::Bulge { to: ends, bulge }],
                };
                let path = build_path(&spec, 0, 2.0).expect("a fine circle");
                for place in [-0.9, -0.5, 0.0, 0.25, 0.75] {
                    assert!(path.surrounds(ends * place), "angle {angle}, place {place}");
                    assert!(!path.surrounds(ends * (2.0 + place)));
                }
            }
        }
    }

    #[test]
    fn a_nearly_straight_arc_is_straight() {
        let spec = |bulge| PathSpec {
            start: DVec2::ZERO,
            edges: vec![
                EdgeSpec::Line { to: DVec2::X },
                EdgeSpec::Line { to: DVec2::Y },
                EdgeSpec::Bulge { to: DVec2::ZERO, bulge },
            ],
        };
        let last = |bulge| build_path(&spec(bulge), 0, 1.0).expect("a fine triangle").edges()[2];
        assert!(matches!(last(1e-9), Edge::Line(_)) && matches!(last(-1e-300), Edge::Line(_)));
        assert!(matches!(last(1e-7), Edge::Arc(_)));
    }
}
