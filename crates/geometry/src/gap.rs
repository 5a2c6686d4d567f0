//! The gap between two features: how far apart, along which normal, and by how much outside their validity.
//!
//! Let cA, cB be the centres, rhoA, rhoB the signed radii, d = cA - cB. There are two kinds between features:
//!
//! * centre to centre: s = -1 if a radius is concave, else +1; n = s d/|d|, g = s |d| - (rhoA + rhoB);
//! * centre to line: n = the line's outward normal, b = foot of cA on it, g = n.(cA - b) - rhoA.
//!
//! A is the *primary* side, n points from the *normal* side B to A. A concave arc is touched inside its range only by
//! vertices and by convex arcs of lesser or equal radius (to 1e-12 of it; an equal one is measured as if the concave
//! arc's radius were larger by 1e-12 of itself); its contacts with concave arcs and lines are carried by its end
//! vertices.
//!
//! Sources: D. Baraff, "Fast contact force computation for nonpenetrating rigid bodies", SIGGRAPH '94, 23-34,
//! appendix; E. Neumann, "Curved Edge Physics", 2015.

use crate::feature::{Feature, LineFeature, RoundFeature};
use crate::pose::Pose;
use glam::DVec2;

/// Kind of the distance that is measured between two features.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GapKind {
    /// Distance from centre to centre.
    CenterCenter,
    /// Distance from a centre to a line.
    CenterLine,
}

/// Kind of contact that is possible between two features, `a` and `b`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum PairKind {
    /// Two features that are both convex or vertices.
    Outer,
    /// A vertex or convex arc inside a concave arc, which may be either of the two.
    Inner,
    /// `a` is round, `b` a line.
    RoundLine,
    /// `a` is a line, `b` round.
    LineRound,
}

/// Play given to a convex arc in a concave one of equal radius, as a fraction of the larger radius [-]; also the
/// fraction up to which radii count as equal. Shapes are drawn so, and without play the direction of contact would be
/// undefined.
const LEAST_PLAY: f64 = 1e-12;

/// Sum of the signed radii of two features [m], whose size is the distance of their centres when they touch.
///
/// It is positive or zero for convex arcs and vertices, negative for one of them inside a concave arc of larger radius.
/// For radii equal to 1e-12 of the larger one, the sum is that of a concave arc larger by 1e-12 of itself.
#[must_use]
#[inline]
pub fn touching_distance(a: &RoundFeature, b: &RoundFeature) -> f64 {
    let sum = a.radius + b.radius;
    if a.radius >= 0.0 && b.radius >= 0.0 {
        return sum;
    }
    let play = LEAST_PLAY * a.radius.abs().max(b.radius.abs());
    if sum.abs() <= play { -play } else { sum }
}

/// Returns the kind of contact that two features can have inside their ranges; `None` if they cannot touch there, or if
/// end vertices carry their contact.
#[must_use]
#[inline]
pub fn pair_kind(a: &Feature, b: &Feature) -> Option<PairKind> {
    match (a, b) {
        (Feature::Line(_), Feature::Line(_)) => None,
        (Feature::Round(round), Feature::Line(_)) => (round.radius >= 0.0).then_some(PairKind::RoundLine),
        (Feature::Line(_), Feature::Round(round)) => (round.radius >= 0.0).then_some(PairKind::LineRound),
        (Feature::Round(a), Feature::Round(b)) if a.radius >= 0.0 && b.radius >= 0.0 => Some(PairKind::Outer),
        (Feature::Round(a), Feature::Round(b)) => {
            (touching_distance(a, b) < 0.0 && (a.radius >= 0.0 || b.radius >= 0.0)).then_some(PairKind::Inner)
        }
    }
}

/// The gap of two round features in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CenterGap {
    /// Distance [m] of the touching points along the normal; negative if they overlap.
    pub gap: f64,
    /// Unit normal: from the centre of `b` to that of `a`, or the other way if one of them is a concave arc.
    pub normal: DVec2,
    /// Distance [m] of the centres.
    pub center_distance: f64,
    /// Centre of `a` [m].
    pub center_a: DVec2,
    /// Centre of `b` [m].
    pub center_b: DVec2,
}

impl CenterGap {
    /// Measures the gap of `a` at its pose from `b` at its own; `inner` is true if one of the two is a concave arc.
    ///
    /// If the centres coincide, every normal is right, and +x is returned.
    #[must_use]
    #[inline]
    pub fn measure(a: &RoundFeature, pose_a: &Pose, b: &RoundFeature, pose_b: &Pose, inner: bool) -> Self {
        let center_a = pose_a.point_to_world(a.center);
        let center_b = pose_b.point_to_world(b.center);
        let d = center_a - center_b;
        let center_distance = d.length();
        let sign = if inner { -1.0 } else { 1.0 };
        let normal = if center_distance > 0.0 { d * (sign / center_distance) } else { DVec2::X };
        let gap = sign * center_distance - touching_distance(a, b);
        Self { gap, normal, center_distance, center_a, center_b }
    }

    /// Angles [rad] by which the contact lies outside the ranges of `a` and of `b`, 0 inside.
    #[must_use]
    #[inline]
    pub fn excess(&self, a: &RoundFeature, pose_a: &Pose, b: &RoundFeature, pose_b: &Pose) -> [f64; 2] {
        [
            a.range.excess(pose_a.vector_to_body(self.normal * -a.sign())),
            b.range.excess(pose_b.vector_to_body(self.normal * b.sign())),
        ]
    }
}

/// The gap of a round feature and a line in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineGap {
    /// Distance [m] of the touching points along the normal; negative if they overlap.
    pub gap: f64,
    /// Outward unit normal of the line.
    pub normal: DVec2,
    /// Centre of the round feature [m].
    pub center: DVec2,
    /// Position [m] of the centre's foot along the line, measured as [`LineFeature::start`] is.
    pub along: f64,
}

impl LineGap {
    /// Measures the gap of the round feature from the line.
    #[must_use]
    #[inline]
    pub fn measure(round: &RoundFeature, pose_round: &Pose, line: &LineFeature, pose_line: &Pose) -> Self {
        let center = pose_round.point_to_world(round.center);
        let seen = center - pose_line.position;
        let normal = pose_line.vector_to_world(line.normal);
        let gap = normal.dot(seen) - line.offset - round.radius;
        Self { gap, normal, center, along: normal.perp().dot(seen) }
    }

    /// Distance [m] by which the centre's foot lies beyond the line's ends, 0 between them.
    #[must_use]
    #[inline]
    pub fn overrun(&self, line: &LineFeature) -> f64 {
        (line.start - self.along).max(self.along - line.end).max(0.0)
    }

    /// Angle [rad] by which the contact lies outside the round feature's range, 0 inside.
    #[must_use]
    #[inline]
    pub fn excess(&self, round: &RoundFeature, pose_round: &Pose) -> f64 {
        round.range.excess(pose_round.vector_to_body(-self.normal))
    }

    /// Foot of the centre on the line [m, world coordinates].
    #[must_use]
    #[inline]
    pub fn foot(&self, line: &LineFeature, pose_line: &Pose) -> DVec2 {
        pose_line.position + self.normal * line.offset + self.normal.perp() * self.along
    }
}

/// The gap of two features with normal, points and distances outside the features' ranges, in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapSample {
    /// Kind of the distance that was measured.
    pub kind: GapKind,
    /// True if `a` is the primary side, false if `b` is.
    pub primary_is_a: bool,
    /// Distance [m] of the touching points along the normal; negative if they overlap.
    pub gap: f64,
    /// Unit vector from the normal side to the primary side.
    pub normal: DVec2,
    /// Centre of the primary feature [m].
    pub center_primary: DVec2,
    /// Centre of the normal feature [m]; for a line the foot of the primary centre.
    pub center_normal: DVec2,
    /// Point of the primary feature that would touch [m].
    pub point_primary: DVec2,
    /// Point of the normal feature that would touch [m].
    pub point_normal: DVec2,
    /// Angle [rad] by which the contact lies outside the primary feature's range, 0 inside.
    pub excess_primary: f64,
    /// Angle [rad] by which the contact lies outside the normal feature's range, 0 inside or for a line.
    pub excess_normal: f64,
    /// Distance [m] by which the contact lies beyond the ends of a line, 0 inside or where there is no line.
    pub overrun: f64,
}

impl GapSample {
    /// Measures the gap of two features of two bodies; `None` if the two cannot touch inside their ranges.
    #[must_use]
    #[inline]
    pub fn measure(a: &Feature, pose_a: &Pose, b: &Feature, pose_b: &Pose) -> Option<Self> {
        let mut sample = Self::measure_unbounded(a, pose_a, b, pose_b)?;
        sample.find_excess([(a, pose_a), (b, pose_b)]);
        Some(sample)
    }

    /// Measures the gap as [`GapSample::measure`] does, but leaves both excesses at 0: the angles cost more than
    /// everything else. [`GapSample::find_excess`] fills them in.
    #[must_use]
    #[inline(always)]
    pub fn measure_unbounded(a: &Feature, pose_a: &Pose, b: &Feature, pose_b: &Pose) -> Option<Self> {
        let kind = pair_kind(a, b)?;
        Some(match (kind, a, b) {
            (PairKind::RoundLine, Feature::Round(round), Feature::Line(line)) => {
                Self::of_line(round, pose_a, line, pose_b, true)
            }
            (PairKind::LineRound, Feature::Line(line), Feature::Round(round)) => {
                Self::of_line(round, pose_b, line, pose_a, false)
            }
            (_, Feature::Round(a), Feature::Round(b)) => {
                // A concave arc is the normal side; otherwise the feature of lesser radius, such as a vertex, is the
                // primary side.
                let primary_is_a =
                    if kind == PairKind::Inner { b.radius < 0.0 } else { a.radius <= b.radius };
                if primary_is_a {
                    Self::of_centers(a, pose_a, b, pose_b, kind == PairKind::Inner, true)
                } else {
                    Self::of_centers(b, pose_b, a, pose_a, kind == PairKind::Inner, false)
                }
            }
            _ => return None,
        })
    }

    /// Sets the angles [rad] by which the contact lies outside the ranges of the features `a` and `b`, which must be
    /// those that were measured, at their poses.
    #[inline]
    pub fn find_excess(&mut self, [a, b]: [(&Feature, &Pose); 2]) {
        let (primary, other) = if self.primary_is_a { (a, b) } else { (b, a) };
        let Feature::Round(round) = primary.0 else { return };
        let toward = match (self.kind, other.0) {
            (GapKind::CenterCenter, Feature::Round(other_round)) => {
                self.excess_normal =
                    other_round.range.excess(other.1.vector_to_body(self.normal * other_round.sign()));
                self.normal * -round.sign()
            }
            _ => -self.normal,
        };
        self.excess_primary = round.range.excess(primary.1.vector_to_body(toward));
    }

    /// True if the contact lies within both features: no excess and no overrun.
    #[must_use]
    #[inline]
    pub fn is_valid(&self) -> bool {
        self.excess_primary <= 0.0 && self.excess_normal <= 0.0 && self.overrun <= 0.0
    }

    #[inline(always)]
    fn of_line(
        round: &RoundFeature,
        pose_round: &Pose,
        line: &LineFeature,
        pose_line: &Pose,
        primary_is_a: bool,
    ) -> Self {
        let measured = LineGap::measure(round, pose_round, line, pose_line);
        let foot = measured.foot(line, pose_line);
        Self {
            kind: GapKind::CenterLine,
            primary_is_a,
            gap: measured.gap,
            normal: measured.normal,
            center_primary: measured.center,
            center_normal: foot,
            point_primary: measured.center - measured.normal * round.radius,
            point_normal: foot,
            excess_primary: 0.0,
            excess_normal: 0.0,
            overrun: measured.overrun(line),
        }
    }

    #[inline(always)]
    fn of_centers(
        primary: &RoundFeature,
        pose_primary: &Pose,
        other: &RoundFeature,
        pose_other: &Pose,
        inner: bool,
        primary_is_a: bool,
    ) -> Self {
        let measured = CenterGap::measure(primary, pose_primary, other, pose_other, inner);
        Self {
            kind: GapKind::CenterCenter,
            primary_is_a,
            gap: measured.gap,
            normal: measured.normal,
            center_primary: measured.center_a,
            center_normal: measured.center_b,
            point_primary: measured.center_a - measured.normal * primary.radius,
            point_normal: measured.center_b + measured.normal * other.radius,
            excess_primary: 0.0,
            excess_normal: 0.0,
            overrun: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feature::DirectionRange;

    #[test]
    fn a_hollow_that_just_fits_has_a_little_play_and_a_smaller_one_takes_nothing_in() {
        let round = |radius: f64| RoundFeature { center: DVec2::ZERO, radius, range: DirectionRange::Full };
        let disc = round(0.5);
        for (hollow, play) in [(0.5, 5e-13), (0.5 + 1e-13, 5e-13), (0.5 - 1e-13, 5e-13), (0.5 + 1e-9, 1e-9)] {
            let distance = touching_distance(&disc, &round(-hollow));
            assert!((distance + play).abs() < 1e-16, "{hollow} m: {distance} m");
            let kind = pair_kind(&Feature::Round(disc), &Feature::Round(round(-hollow)));
            assert_eq!(kind, Some(PairKind::Inner));
        }
        let smaller = round(-0.5 + 1e-9);
        assert_eq!(pair_kind(&Feature::Round(disc), &Feature::Round(smaller)), None);
        assert_eq!(touching_distance(&disc, &disc), 1.0);
    }
}
