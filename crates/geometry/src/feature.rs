//! Features: the vertices, arcs and lines between which gaps are measured, and where each is valid.

use glam::DVec2;

/// Index of a feature in its shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct FeatureId(pub u32);

impl FeatureId {
    /// The id of the feature at an index of [`Shape::features`](crate::Shape::features).
    ///
    /// # Panics
    /// If the index does not fit into 32 bits.
    #[must_use]
    #[inline]
    pub fn from_index(index: usize) -> Self {
        Self(u32::try_from(index).expect("a shape has fewer than 2^32 features"))
    }
}

/// Index of an edge of a shape: its path, and its place in the path in the direction in which the shape runs it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct EdgeId {
    /// Index of the path.
    pub path: u32,
    /// Index of the edge in the path.
    pub edge: u32,
}

/// The four kinds of features.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum FeatureKind {
    /// A corner that points outwards.
    Vertex,
    /// An arc that bulges outwards.
    ConvexArc,
    /// An arc that bulges inwards: the solid lies outside of its circle.
    ConcaveArc,
    /// A straight edge.
    Line,
}

/// Part of the outline that a feature stands for: an edge, or the vertex at which an edge starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FeatureSource {
    /// Index of the path.
    pub path: u32,
    /// Index of the edge; for a vertex, of the edge that starts at it.
    pub edge: u32,
    /// Kind of the feature.
    pub kind: FeatureKind,
}

/// A vertex or an arc: the points at one distance from a center, in a range of directions from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundFeature {
    /// Center in body coordinates [m].
    pub center: DVec2,
    /// Signed radius [m]: vertex 0, convex arc positive, concave arc negative.
    pub radius: f64,
    /// Directions, in body coordinates: for an arc, of its points as seen from the center; for a vertex, of its outward
    /// normals (the normal cone).
    pub range: DirectionRange,
}

impl RoundFeature {
    /// +1 where the outward normal points away from the center, -1 for a concave arc.
    #[must_use]
    #[inline]
    pub fn sign(&self) -> f64 {
        if self.radius < 0.0 { -1.0 } else { 1.0 }
    }
}

/// A straight edge, as the part of a half-plane's border between two bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineFeature {
    /// Outward unit normal in body coordinates.
    pub normal: DVec2,
    /// Unit vector of travel in body coordinates: the normal turned +90 degrees.
    pub direction: DVec2,
    /// Signed offset [m] of the line from the body's origin along the normal.
    pub offset: f64,
    /// Start of the edge [m], measured along `direction` from the foot of the body's origin on the line.
    pub start: f64,
    /// End of the edge [m], measured as `start` is; more than `start`.
    pub end: f64,
}

impl LineFeature {
    /// Point of the line [m, body coordinates] at `along` [m], measured as [`start`](Self::start) is.
    #[must_use]
    #[inline]
    pub fn point_at(&self, along: f64) -> DVec2 {
        self.normal * self.offset + self.direction * along
    }
}

/// A part of a shape that can touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feature {
    /// A vertex or an arc.
    Round(RoundFeature),
    /// A straight edge.
    Line(LineFeature),
}

impl Feature {
    /// Kind of this feature.
    #[must_use]
    #[inline]
    pub fn kind(&self) -> FeatureKind {
        match self {
            Feature::Line(_) => FeatureKind::Line,
            Feature::Round(round) if round.radius == 0.0 => FeatureKind::Vertex,
            Feature::Round(round) if round.radius > 0.0 => FeatureKind::ConvexArc,
            Feature::Round(_) => FeatureKind::ConcaveArc,
        }
    }

    /// Signed radius of curvature [m]: vertex 0, convex arc positive, concave arc negative; `None` for a straight edge.
    #[must_use]
    #[inline]
    pub fn radius(&self) -> Option<f64> {
        match self {
            Feature::Line(_) => None,
            Feature::Round(round) => Some(round.radius),
        }
    }

    /// Largest distance [m] of a point of the feature from `place` [m, body coordinates].
    #[must_use]
    pub fn farthest(&self, place: DVec2) -> f64 {
        match self {
            Feature::Line(line) => {
                let to_start = (line.point_at(line.start) - place).length();
                to_start.max((line.point_at(line.end) - place).length())
            }
            Feature::Round(round) => {
                let offset = round.center - place;
                let (distance, radius) = (offset.length(), round.radius.abs());
                let away = if distance > 0.0 { offset / distance } else { DVec2::X };
                match round.range.ends() {
                    Some(ends) if radius > 0.0 && !round.range.contains(away) => {
                        ends.map(|end| (offset + end * radius).length()).into_iter().fold(0.0, f64::max)
                    }
                    _ => distance + radius,
                }
            }
        }
    }
}

/// A range of directions, run counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum DirectionRange {
    /// All directions.
    Full,
    /// Between two unit vectors at most a quarter turn apart.
    Narrow {
        /// First direction.
        from: DVec2,
        /// Last direction.
        to: DVec2,
    },
    /// Between two unit vectors more than a quarter and at most half a turn apart.
    Wide {
        /// First direction.
        from: DVec2,
        /// Last direction.
        to: DVec2,
    },
    /// Between two unit vectors more than half a turn apart.
    Major {
        /// First direction.
        from: DVec2,
        /// Last direction.
        to: DVec2,
    },
}

impl DirectionRange {
    /// The range from one unit vector counter-clockwise to another, which are `sweep` [rad] apart.
    #[must_use]
    #[inline]
    pub fn between(from: DVec2, to: DVec2, sweep: f64) -> Self {
        use std::f64::consts::{FRAC_PI_2, PI};
        if sweep <= FRAC_PI_2 {
            DirectionRange::Narrow { from, to }
        } else if sweep <= PI {
            DirectionRange::Wide { from, to }
        } else {
            DirectionRange::Major { from, to }
        }
    }

    /// The range extended by small angles [rad] at its first and at its last end; `sweep` [rad] is its width before.
    #[must_use]
    pub(crate) fn grown(self, first: f64, last: f64, sweep: f64) -> Self {
        let Some([from, to]) = self.ends() else { return self };
        if sweep + first + last >= std::f64::consts::TAU {
            return DirectionRange::Full;
        }
        let turned = |direction: DVec2, angle: f64| (direction + direction.perp() * angle).normalize();
        Self::between(turned(from, -first), turned(to, last), sweep + first + last)
    }

    /// True if the unit vector lies in the range, ends included.
    #[must_use]
    #[inline]
    pub fn contains(&self, direction: DVec2) -> bool {
        match *self {
            DirectionRange::Full => true,
            DirectionRange::Narrow { from, to } => {
                from.perp_dot(direction) >= 0.0
                    && direction.perp_dot(to) >= 0.0
                    && direction.dot(from + to) > 0.0
            }
            DirectionRange::Wide { from, to } => {
                from.perp_dot(direction) >= 0.0 && direction.perp_dot(to) >= 0.0
            }
            DirectionRange::Major { from, to } => {
                from.perp_dot(direction) >= 0.0 || direction.perp_dot(to) >= 0.0
            }
        }
    }

    /// Angle [rad] by which a unit vector lies outside of the range: 0 inside, at most half a turn.
    #[must_use]
    #[inline]
    pub fn excess(&self, direction: DVec2) -> f64 {
        if self.contains(direction) {
            return 0.0;
        }
        self.ends().map_or(0.0, |[from, to]| angle_between(from, direction).min(angle_between(to, direction)))
    }

    /// Lower bound [rad] of the angle between a unit vector in the range and the nearer end; 0 outside of the range,
    /// infinite for all directions. It is the chord to that end, which is shorter than the angle.
    #[must_use]
    #[inline]
    pub fn margin(&self, direction: DVec2) -> f64 {
        let Some([from, to]) = self.ends() else { return f64::INFINITY };
        if !self.contains(direction) {
            return 0.0;
        }
        (direction - from).length_squared().min((direction - to).length_squared()).sqrt()
    }

    /// The unit vectors at the first and at the last end; `None` for all directions.
    #[must_use]
    #[inline]
    pub fn ends(&self) -> Option<[DVec2; 2]> {
        match *self {
            DirectionRange::Full => None,
            DirectionRange::Narrow { from, to }
            | DirectionRange::Wide { from, to }
            | DirectionRange::Major { from, to } => Some([from, to]),
        }
    }
}

fn angle_between(a: DVec2, b: DVec2) -> f64 {
    libm::atan2(a.perp_dot(b).abs(), a.dot(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn at(angle: f64) -> DVec2 {
        DVec2::new(angle.cos(), angle.sin())
    }

    #[test]
    fn ranges_of_every_width_contain_what_lies_between_their_ends() {
        for width in [1e-9, 0.3, 1.5, 1.6, 3.1, 3.2, 5.0, 6.27] {
            let range = DirectionRange::between(at(1.0), at(1.0 + width), width);
            for step in 0..200 {
                let turn = (f64::from(step) + 0.5) / 200.0 * TAU;
                let expected_excess = if turn < width { 0.0 } else { (turn - width).min(TAU - turn) };
                let excess = range.excess(at(1.0 + turn));
                assert!((excess - expected_excess).abs() < 1e-12, "width {width}, turn {turn}: {excess}");
                let from_end = if turn < width { turn.min(width - turn) } else { 0.0 };
                let margin = range.margin(at(1.0 + turn));
                assert!(margin <= from_end + 1e-12 && margin >= 0.6 * from_end, "{width}, {turn}: {margin}");
            }
        }
    }

    #[test]
    fn all_directions_have_no_ends() {
        assert_eq!(DirectionRange::Full.margin(at(0.3)), f64::INFINITY);
    }

    #[test]
    fn the_farthest_point_of_an_arc_may_be_an_end() {
        let arc = RoundFeature {
            center: DVec2::ZERO,
            radius: 1.0,
            range: DirectionRange::between(at(0.0), at(1.0), 1.0),
        };
        let feature = Feature::Round(arc);
        assert!((feature.farthest(at(0.5) * -3.0) - 4.0).abs() < 1e-15 * 4.0);
        assert!((feature.farthest(at(0.5) * 3.0) - (at(0.5) * 3.0 - at(0.0)).length()).abs() < 1e-15 * 4.0);
    }
}
