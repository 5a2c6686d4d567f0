//! Features of two bodies that are near each other: what may come to touch within a step.

use crate::motion::Moving;
use halfgap_geometry::{Feature, FeatureId, GapSample, Shape};

/// How near two features have to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearness {
    /// Largest gap [m].
    pub reach: f64,
    /// Largest overlap [m].
    pub depth: f64,
    /// Distance [m] by which a contact may lie beyond the end of a line.
    pub overrun: f64,
}

/// Visits every two features of bodies `a` and `b` that face each other and whose gap lies within the bounds of
/// `nearness`, with the gap as it is measured.
///
/// A convex one may face away from the other by as much as a body can turn while its nearest point goes as far as `reach`, and
/// while what overlaps comes out again: the higher corner of a block that lands a little askew is near, too. Beyond the end of
/// a concave arc, as beyond that of a line, there is nothing to touch.
#[inline]
pub fn visit_near_features(
    [a, b]: [(&Shape, &Moving); 2],
    nearness: &Nearness,
    visit: &mut impl FnMut([FeatureId; 2], &GapSample),
) {
    let Nearness { reach, depth, overrun } = *nearness;
    let mut look = |feature_a: FeatureId, feature_b: FeatureId| {
        let features = [a.0.feature(feature_a), b.0.feature(feature_b)];
        let poses = [&a.1.pose, &b.1.pose];
        let Some(mut sample) = GapSample::measure_unbounded(features[0], poses[0], features[1], poses[1])
        else {
            return;
        };
        if sample.gap > reach || sample.gap < -depth || sample.overrun > overrun {
            return;
        }
        sample.find_excess([(features[0], poses[0]), (features[1], poses[1])]);
        let mut sides = [(a.0.lever(feature_a), features[0]), (b.0.lever(feature_b), features[1])];
        if !sample.primary_is_a {
            sides.swap(0, 1);
        }
        let way = reach + (-sample.gap).max(0.0);
        let faces = |(lever, feature): (f64, &Feature), excess: f64| {
            let is_concave = feature.radius().is_some_and(|radius| radius < 0.0);
            excess * lever <= if is_concave { overrun } else { way }
        };
        if faces(sides[0], sample.excess_primary) && faces(sides[1], sample.excess_normal) {
            visit([feature_a, feature_b], &sample);
        }
    };
    if let ([_], [_]) = (a.0.features(), b.0.features()) {
        look(FeatureId(0), FeatureId(0));
        return;
    }
    a.0.tree().visit_near_pairs(&a.1.pose, b.0.tree(), &b.1.pose, reach.max(depth), &mut look);
}
