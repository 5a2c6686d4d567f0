//! The path of a rail, fixed in the world: edges joined to each other, or a spline through points.
//!
//! Arc length counts from the path's first point. An open path goes on straight beyond its ends, so that
//! every point has a nearest one.

use super::edge_path::EdgePath;
use super::error::RailError;
use super::spline::Spline;
use glam::DVec2;
use halfgap_geometry::{Aabb, EdgeSpec};

/// Difference of arc lengths up to which they belong to one place, as a fraction of the path's length [-].
pub(super) const SAME_PLACE: f64 = 1e-12;

/// The path of a rail, fixed in the world.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct RailPath {
    curve: Curve,
}

#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
enum Curve {
    Edges(EdgePath),
    Spline(Spline),
}

/// A place on a path: the one nearest to a point, or the one at an arc length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RailPlace {
    foot: Foot,
    /// Arc length [m] from the path's first point; beyond the ends, negative or more than the path's length.
    pub arc_length: f64,
}

/// The nearest point of a path, without its arc length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Foot {
    /// Index of the piece.
    pub(super) piece: u32,
    /// Place in the piece [m]; on a spline, the parameter of its cubic.
    pub(super) parameter: f64,
    /// The point of the path [m].
    pub(super) point: DVec2,
    /// Unit vector of travel.
    pub(super) tangent: DVec2,
    /// Unit vector to the left of the tangent.
    pub(super) normal: DVec2,
    /// Curvature [1/m], positive to the left.
    pub(super) curvature: f64,
    /// Derivative of the curvature by the arc length [1/m^2].
    pub(super) curvature_rate: f64,
    /// Signed distance [m] of the query point from the path, positive to the left.
    pub(super) gap: f64,
}

/// Place on a path near which to search the nearest point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct RailHint {
    pub(super) piece: u32,
    pub(super) parameter: f64,
    pub(super) stays: bool,
    /// True if the row's normal points to the right of the path, not to the left.
    pub(super) faces_right: bool,
    /// Arc length [m] that the point last had left before a stop: tells laps of a closed path apart.
    pub(super) before_stop: Option<f64>,
}

/// A joint of two pieces of a path, at which its curvature, or even its direction, may jump.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct RailKnot {
    /// Arc length from the path's first point [m].
    pub arc_length: f64,
    /// Index of the piece before the joint.
    pub before: u32,
    /// Index of the piece after the joint.
    pub after: u32,
    /// Turn [rad] of the direction of travel at the joint, positive to the left; 0 for a smooth joint.
    pub turn: f64,
    /// Curvatures of the pieces before and after the joint [1/m], positive to the left.
    pub curvatures: [f64; 2],
}

/// A joint of a path through points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplineJoint {
    /// Point of the joint [m].
    pub point: DVec2,
    /// Unit vector along the path, in the direction in which the joint is approached.
    pub tangent: DVec2,
    /// Width in the parameter [m] of the piece up to the joint: the distance of the two points that the piece joins.
    pub width: f64,
    /// Size [1/m^2] of the jump, at the joint, of the third derivative of the path by its parameter, which is nearly
    /// its length.
    pub jump: f64,
}

impl RailPath {
    /// Builds the path of lines and arcs that starts at a point [m]; it is closed if it ends there.
    ///
    /// End points and arc radii may be off by 1e-6 of the path's size and are then made exact, as those of shapes
    /// ([`Shape::from_paths`]). An arc that ends where it starts is a full circle.
    ///
    /// [`Shape::from_paths`]: halfgap_geometry::Shape::from_paths
    ///
    /// # Errors
    /// No edges, numbers that are not finite, or an edge that cannot be built.
    pub fn from_edges(start: DVec2, edges: &[EdgeSpec]) -> Result<Self, RailError> {
        Ok(Self { curve: Curve::Edges(EdgePath::new(start, edges)?) })
    }

    /// Builds the cubic spline through points [m], with their distances as parameter: periodic if `closed`, else
    /// natural.
    ///
    /// A closed spline runs from the last point to the first; the first may be repeated at the end.
    ///
    /// # Errors
    /// Fewer than two points (closed: three), numbers that are not finite, neighbours that coincide, or a cusp.
    pub fn through(points: &[DVec2], closed: bool) -> Result<Self, RailError> {
        Ok(Self { curve: Curve::Spline(Spline::new(points, closed)?) })
    }

    /// Length [m] of the path, without the continuations beyond open ends.
    #[must_use]
    #[inline]
    pub fn length(&self) -> f64 {
        match &self.curve {
            Curve::Edges(path) => path.length(),
            Curve::Spline(spline) => spline.length(),
        }
    }

    /// True if the path ends at its start and goes on from there.
    #[must_use]
    #[inline]
    pub fn is_closed(&self) -> bool {
        match &self.curve {
            Curve::Edges(path) => path.is_closed(),
            Curve::Spline(spline) => spline.is_closed(),
        }
    }

    /// A box [m] around the path, without the continuations beyond open ends.
    #[must_use]
    #[inline]
    pub fn bounds(&self) -> Aabb {
        match &self.curve {
            Curve::Edges(path) => path.bounds(),
            Curve::Spline(spline) => spline.bounds(),
        }
    }

    /// True for a spline through points, whose third derivative jumps at each of them.
    #[must_use]
    #[inline]
    pub fn is_spline(&self) -> bool {
        matches!(self.curve, Curve::Spline(_))
    }

    /// The joints of lines and arcs, and of an open path with its continuations, in the order of arc lengths; none for
    /// a spline.
    #[must_use]
    #[inline]
    pub fn knots(&self) -> &[RailKnot] {
        match &self.curve {
            Curve::Edges(path) => path.knots(),
            Curve::Spline(_) => &[],
        }
    }

    /// The joint at an end of a piece of lines and arcs, forward or backward; `None` at an open end, and for a spline.
    #[must_use]
    #[inline]
    pub fn knot_at_end(&self, piece: u32, forward: bool) -> Option<&RailKnot> {
        match &self.curve {
            Curve::Edges(path) => path.knot_at_end(piece as usize, forward),
            Curve::Spline(_) => None,
        }
    }

    /// The next joint of a spline along a velocity [m/s], from the place of a hint. A joint that is all but
    /// reached counts as passed. `None` if there is no joint before an open end, and on a path of edges.
    #[must_use]
    #[inline]
    pub fn joint_ahead(&self, hint: &RailHint, velocity: DVec2) -> Option<SplineJoint> {
        match &self.curve {
            Curve::Edges(_) => None,
            Curve::Spline(spline) => spline.joint_ahead((hint.piece as usize, hint.parameter), velocity),
        }
    }

    /// The hint to search from a knot forward or backward, along the piece that comes next.
    #[must_use]
    #[inline]
    pub fn hint_past(&self, knot: &RailKnot, forward: bool) -> RailHint {
        let piece = if forward { knot.after } else { knot.before };
        let parameter = match &self.curve {
            Curve::Edges(path) => path.place_at_knot(piece as usize, forward),
            Curve::Spline(_) => 0.0,
        };
        RailHint { piece, parameter, stays: false, faces_right: false, before_stop: None }
    }

    /// The two sides of a corner, before and after a knot: hints to stay on its pieces, whose rows face into the
    /// angle between them. Both gaps are zero at the corner; on either piece the gap to the other is positive.
    #[must_use]
    #[inline]
    pub fn corner_sides(&self, knot: &RailKnot) -> [RailHint; 2] {
        [false, true].map(|forward| RailHint {
            faces_right: knot.turn < 0.0,
            ..self.hint_past(knot, forward).staying()
        })
    }

    /// The two sides of a corner that lies within a distance [m] of a point; `None` if there is none so near.
    #[must_use]
    #[inline]
    pub fn corner_at(&self, point: DVec2, within: f64) -> Option<[RailHint; 2]> {
        let is_near = |knot: &RailKnot| self.place_at(knot.arc_length).point().distance(point) <= within;
        let mut corners = self.knots().iter().filter(|knot| knot.turn != 0.0);
        corners.find(|knot| is_near(knot)).map(|knot| self.corner_sides(knot))
    }

    /// True if the piece of a hint ends, forward or backward, in a corner at the given arc length [m], to rounding.
    #[must_use]
    #[inline]
    pub fn ends_in_corner(&self, hint: &RailHint, forward: bool, arc_length: f64) -> bool {
        let is_there = |knot: &RailKnot| {
            let way = (knot.arc_length - arc_length).abs();
            let way = way.min(if self.is_closed() { (self.length() - way).abs() } else { way });
            way <= SAME_PLACE * self.length()
        };
        self.knot_at_end(hint.piece, forward).is_some_and(|knot| knot.turn != 0.0 && is_there(knot))
    }

    /// The place nearest to a point [m]: on the whole path without a hint, else the first one found along the path from
    /// the hint, or the one on the hint's piece if the hint stays there. Beyond an open end it lies on the straight
    /// continuation.
    #[must_use]
    #[inline]
    pub fn nearest(&self, point: DVec2, hint: Option<&RailHint>) -> RailPlace {
        match &self.curve {
            Curve::Edges(path) => path.nearest(point, hint),
            Curve::Spline(spline) => {
                let foot = spline.foot(point, hint);
                RailPlace { foot, arc_length: spline.arc_length(foot.piece as usize, foot.parameter) }
            }
        }
    }

    /// The hint to search near the place that [`RailPath::nearest`] finds, at less cost: arc lengths on splines are not
    /// computed.
    #[must_use]
    #[inline]
    pub fn hint_near(&self, point: DVec2, hint: Option<&RailHint>) -> RailHint {
        match &self.curve {
            Curve::Edges(path) => path.nearest(point, hint).hint(),
            Curve::Spline(spline) => spline.foot(point, hint).hint(),
        }
    }

    /// The place at an arc length [m]: beyond the ends of an open path on its continuations, of a closed path in
    /// another lap.
    #[must_use]
    #[inline]
    pub fn place_at(&self, arc_length: f64) -> RailPlace {
        match &self.curve {
            Curve::Edges(path) => path.place_at(arc_length),
            Curve::Spline(spline) => spline.place_at(arc_length),
        }
    }

    /// Distance [m] of a point from the path or, beyond its open ends, from its straight continuations.
    #[must_use]
    pub fn distance(&self, point: DVec2) -> f64 {
        let to_path = self.foot(point, None).gap.abs();
        if self.is_closed() {
            return to_path;
        }
        let ends = [(self.place_at(0.0), -1.0), (self.place_at(self.length()), 1.0)];
        let to_rays = ends.iter().filter_map(|(end, outward)| {
            let seen = point - end.point();
            (outward * end.tangent().dot(seen) >= 0.0).then(|| end.normal().dot(seen).abs())
        });
        to_rays.fold(to_path, f64::min)
    }

    /// [`RailPath::nearest`] without the arc length, which costs as much as everything else.
    #[inline]
    pub(super) fn foot(&self, point: DVec2, hint: Option<&RailHint>) -> Foot {
        match &self.curve {
            Curve::Edges(path) => path.foot(point, hint),
            Curve::Spline(spline) => spline.foot(point, hint),
        }
    }
}

impl RailPlace {
    pub(super) fn new(foot: Foot, arc_length: f64) -> Self {
        Self { foot, arc_length }
    }

    pub(super) fn foot(&self) -> &Foot {
        &self.foot
    }

    /// Index of the piece of the path; the continuations of an open path of edges count as its first and last piece.
    #[must_use]
    #[inline]
    pub fn piece(&self) -> u32 {
        self.foot.piece
    }

    /// The point of the path [m].
    #[must_use]
    #[inline]
    pub fn point(&self) -> DVec2 {
        self.foot.point
    }

    /// Unit vector of travel.
    #[must_use]
    #[inline]
    pub fn tangent(&self) -> DVec2 {
        self.foot.tangent
    }

    /// Unit normal, on the left of the direction of travel.
    #[must_use]
    #[inline]
    pub fn normal(&self) -> DVec2 {
        self.foot.normal
    }

    /// Curvature [1/m], positive to the left.
    #[must_use]
    #[inline]
    pub fn curvature(&self) -> f64 {
        self.foot.curvature
    }

    /// Derivative of the curvature by the arc length [1/m^2].
    #[must_use]
    #[inline]
    pub fn curvature_rate(&self) -> f64 {
        self.foot.curvature_rate
    }

    /// Signed distance [m] of the query point from the path, positive to the left; 0 for a place at an arc length.
    #[must_use]
    #[inline]
    pub fn gap(&self) -> f64 {
        self.foot.gap
    }

    /// A hint to search near this place.
    #[must_use]
    #[inline]
    pub fn hint(&self) -> RailHint {
        self.foot.hint()
    }
}

impl Foot {
    fn hint(&self) -> RailHint {
        let (piece, parameter) = (self.piece, self.parameter);
        RailHint { piece, parameter, stays: false, faces_right: false, before_stop: None }
    }
}

impl RailHint {
    /// The hint to stay on the piece, continued as the circle or straight line that it is, although another piece
    /// may be nearer: no gap then jumps before an event at the joint is handled. It has no effect on a spline, where
    /// nothing jumps.
    #[must_use]
    #[inline]
    pub fn staying(self) -> Self {
        Self { stays: true, ..self }
    }

    /// The hint for a stop before which the point last had the arc length `before_stop` [m] left: on a closed path, of the
    /// gaps that differ by laps, the one nearest to it is measured. `None` if it is not known: the point then is before
    /// the stop, or just at it.
    #[must_use]
    #[inline]
    pub fn with_before_stop(self, before_stop: Option<f64>) -> Self {
        Self { before_stop, ..self }
    }

    /// True if the hint stays on its piece.
    #[must_use]
    #[inline]
    pub fn is_staying(&self) -> bool {
        self.stays
    }

    /// Arc length [m] that the point last had left before a stop, if it is known.
    #[must_use]
    #[inline]
    pub fn before_stop(&self) -> Option<f64> {
        self.before_stop
    }

    /// The hint with the row of a rail facing left again, as everywhere but in a corner.
    #[must_use]
    #[inline]
    pub fn facing_left(self) -> Self {
        Self { faces_right: false, ..self }
    }
}
