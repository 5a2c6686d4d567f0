//! The specification of an edge, of an outline or a rail, and the edge that is made from it.

use crate::arc::Arc;
use crate::edge::Edge;
use crate::error::EdgeError;
use crate::line::Line;
use glam::DVec2;

/// Radius, in multiples of the chord [-], beyond which a minor arc is made a straight edge.
///
/// The rise of such an arc is less than 1.25e-8 chords; the rounding of a center that far away would be as large.
const FLATTEST: f64 = 1e7;

/// Specification of an edge, which starts at the end of the edge before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeSpec {
    /// A straight edge.
    Line {
        /// End point [m].
        to: DVec2,
    },
    /// An arc about a center.
    Arc {
        /// End point [m].
        to: DVec2,
        /// Center of the circle [m].
        center: DVec2,
        /// True for an arc that runs clockwise, false for one that runs counter-clockwise.
        clockwise: bool,
    },
    /// An arc given by its bulge, the tangent of a quarter of its sweep; positive counter-clockwise, 0 a straight edge.
    Bulge {
        /// End point [m].
        to: DVec2,
        /// Tangent of a quarter of the sweep [-], positive counter-clockwise.
        bulge: f64,
    },
}

impl EdgeSpec {
    /// Largest error of end points and arc radii that outlines and rails accept, as a fraction of their size [-]; within it
    /// the numbers are made exact. It is less for long arcs between near ends ([`Shape::from_paths`]).
    ///
    /// [`Shape::from_paths`]: crate::Shape::from_paths
    pub const FIT: f64 = 1e-6;

    /// End point of the edge [m].
    #[must_use]
    #[inline]
    pub fn to(&self) -> DVec2 {
        match *self {
            EdgeSpec::Line { to } | EdgeSpec::Arc { to, .. } | EdgeSpec::Bulge { to, .. } => to,
        }
    }

    /// The same edge, moved by a shift [m].
    #[must_use]
    pub fn translated(&self, shift: DVec2) -> Self {
        match *self {
            Self::Line { to } => Self::Line { to: to + shift },
            Self::Arc { to, center, clockwise } => {
                Self::Arc { to: to + shift, center: center + shift, clockwise }
            }
            Self::Bulge { to, bulge } => Self::Bulge { to: to + shift, bulge },
        }
    }

    /// Center and radius [m] of an arc of half a turn or more that starts at `from`; `None` for other edges.
    pub(crate) fn major_circle(&self, from: DVec2) -> Option<(DVec2, f64)> {
        let chord = self.to() - from;
        match *self {
            EdgeSpec::Line { .. } => None,
            EdgeSpec::Arc { center, clockwise, .. } => {
                let left = chord.perp_dot(center - from);
                let major = if clockwise { left >= 0.0 } else { left <= 0.0 };
                major.then(|| (center, (from - center).length()))
            }
            EdgeSpec::Bulge { bulge, .. } => (bulge.abs() >= 1.0).then(|| {
                let center = bulge_center(from, chord, bulge);
                (center, (from - center).length())
            }),
        }
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.to().is_finite()
            && match *self {
                EdgeSpec::Line { .. } => true,
                EdgeSpec::Arc { center, .. } => center.is_finite(),
                EdgeSpec::Bulge { bulge, .. } => bulge.is_finite(),
            }
    }

    /// Builds the edge from one point to another [m], which takes the place of the specified end point.
    ///
    /// An arc whose radius is more than 1e7 chords becomes a straight edge. `fit_tol` [m] bounds by how much the distances
    /// of the two points from a given center may differ; the center is moved so that they agree.
    ///
    /// # Errors
    ///
    /// [`EdgeError`] if the points coincide, a number is not finite, or an arc does not fit.
    pub fn edge_between(&self, from: DVec2, to: DVec2, fit_tol: f64) -> Result<Edge, EdgeError> {
        let arc = match *self {
            EdgeSpec::Line { .. } => return Ok(Edge::Line(Line::new(from, to)?)),
            EdgeSpec::Bulge { bulge, .. } if 4.0 * FLATTEST * bulge.abs() < 1.0 => {
                return Ok(Edge::Line(Line::new(from, to)?));
            }
            EdgeSpec::Arc { center, clockwise, .. } => Arc::between(from, to, center, clockwise, fit_tol)?,
            EdgeSpec::Bulge { bulge, .. } => {
                let center = bulge_center(from, to - from, bulge);
                Arc::between(from, to, center, bulge < 0.0, f64::INFINITY)?
            }
        };
        let is_flat = FLATTEST * arc.sweep_angle().abs() < 1.0;
        Ok(if is_flat { Edge::Line(Line::new(from, to)?) } else { Edge::Arc(arc) })
    }
}

/// Center of the arc over a chord: on the bisector, (1 - bulge^2) / (4 bulge) chords to the left of the chord.
fn bulge_center(from: DVec2, chord: DVec2, bulge: f64) -> DVec2 {
    from + 0.5 * chord + chord.perp() * ((1.0 - bulge * bulge) / (4.0 * bulge))
}
