//! The collision records of two bodies at one moment.

use crate::body::{Body, BodyId};
use crate::march::UNKNOWN_DIRECTION;
use crate::merge::merge_collisions;
use crate::motion::Moving;
use crate::record::{Collision, Detector, Participant, Parties};
use crate::tolerances::Tolerances;
use halfgap_geometry::{Feature, FeatureId, FeatureKind, GapSample, Shape, touching_distance};

/// A body at the moment of detection.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// Id of the body.
    pub id: BodyId,
    /// Shape, inertia and elasticity of the body.
    pub body: &'a Body,
    /// Pose and velocities of the body.
    pub moving: Moving,
}

/// Adds to `found` a record for every place where the two bodies are within `distance_tol` of each other, overlapping
/// by at most `depth` [m], at the time [s] of the two moments. A place found by several pairs of features is recorded
/// once.
pub fn detect_pair(
    a: &Moment<'_>,
    b: &Moment<'_>,
    tolerances: &Tolerances,
    depth: f64,
    time: f64,
    found: &mut Vec<Collision>,
) {
    let first = found.len();
    detect_features_of_pair(a, b, tolerances, depth, time, found);
    if found.len() > first + 1 {
        let mut fresh = found.split_off(first);
        merge_collisions(&mut fresh);
        found.append(&mut fresh);
    }
}

/// Adds to `found` the records of [`detect_pair`], except that a place found by several pairs of features is recorded
/// for each of them.
pub fn detect_features_of_pair(
    a: &Moment<'_>,
    b: &Moment<'_>,
    tolerances: &Tolerances,
    depth: f64,
    time: f64,
    found: &mut Vec<Collision>,
) {
    if let ([_], [_]) = (a.body.shape.features(), b.body.shape.features()) {
        // Two discs: nothing to choose from.
        found.extend(detect_features([a, b], [FeatureId(0); 2], tolerances, depth, time));
        return;
    }
    let distance = tolerances.distance_tol().max(depth);
    a.body.shape.tree().visit_near_pairs(
        &a.moving.pose,
        b.body.shape.tree(),
        &b.moving.pose,
        distance,
        &mut |feature_a, feature_b| {
            found.extend(detect_features([a, b], [feature_a, feature_b], tolerances, depth, time));
        },
    );
}

/// Returns the record at `time` [s] of one pair of features that a search found in contact, wherever on the features
/// the contact lies and however far apart they are.
///
/// `None` if features of these kinds cannot touch inside their ranges ([`halfgap_geometry::pair_kind`]), or if they are
/// two vertices and the direction between them lies outside of a normal cone by more than 0.1 rad: between vertices that
/// nearly coincide the direction is all rounding.
#[must_use]
#[inline]
pub fn record_features(
    [a, b]: [&Moment<'_>; 2],
    features: [FeatureId; 2],
    tolerances: &Tolerances,
    time: f64,
) -> Option<Collision> {
    let (shape_a, shape_b) = (a.body.shape.feature(features[0]), b.body.shape.feature(features[1]));
    let sample = GapSample::measure(shape_a, &a.moving.pose, shape_b, &b.moving.pose)?;
    let is_known = shape_a.radius() != Some(0.0)
        || shape_b.radius() != Some(0.0)
        || sample.excess_primary.max(sample.excess_normal) <= UNKNOWN_DIRECTION;
    is_known.then(|| record([a, b], features, &sample, pair_tolerances(shape_a, shape_b, tolerances), time))
}

fn detect_features(
    [a, b]: [&Moment<'_>; 2],
    [feature_a, feature_b]: [FeatureId; 2],
    tolerances: &Tolerances,
    depth: f64,
    time: f64,
) -> Option<Collision> {
    let (shape_a, shape_b) = (a.body.shape.feature(feature_a), b.body.shape.feature(feature_b));
    let sides = [(shape_a, &a.moving.pose), (shape_b, &b.moving.pose)];
    let mut sample = GapSample::measure_unbounded(sides[0].0, sides[0].1, sides[1].0, sides[1].1)?;
    let tolerances = pair_tolerances(shape_a, shape_b, tolerances);
    if sample.gap > tolerances.distance_tol() || sample.gap < -depth {
        return None;
    }
    sample.find_excess(sides);
    if !is_within(&sample, [(&a.body.shape, feature_a), (&b.body.shape, feature_b)], &tolerances) {
        return None;
    }
    Some(record([a, b], [feature_a, feature_b], &sample, tolerances, time))
}

fn record(
    [a, b]: [&Moment<'_>; 2],
    [feature_a, feature_b]: [FeatureId; 2],
    sample: &GapSample,
    tolerances: Tolerances,
    time: f64,
) -> Collision {
    let (primary, normal, primary_feature, normal_feature) =
        if sample.primary_is_a { (a, b, feature_a, feature_b) } else { (b, a, feature_b, feature_a) };
    let (shape_primary, shape_normal) = (&primary.body.shape, &normal.body.shape);
    let sides = [
        Participant::new(primary.id, shape_primary, primary_feature),
        Participant::new(normal.id, shape_normal, normal_feature),
    ];
    let kinds = [shape_primary.source(primary_feature).kind, shape_normal.source(normal_feature).kind];
    let parties = Parties {
        primary: sides[0],
        normal: sides[1],
        third: None,
        bilateral: false,
        detector: detector(kinds),
    };
    let radii = [
        primary.body.shape.feature(primary_feature).radius(),
        normal.body.shape.feature(normal_feature).radius(),
    ];
    let elasticity = a.body.elasticity.min(b.body.elasticity);
    Collision::new(parties, (sample, radii), [&primary.moving, &normal.moving], tolerances, elasticity, time)
}

fn detector(kinds: [FeatureKind; 2]) -> Detector {
    match kinds {
        [FeatureKind::Vertex, FeatureKind::Vertex] => Detector::CornerCorner,
        [FeatureKind::Vertex, _] | [_, FeatureKind::Vertex] => Detector::VertexEdge,
        _ => Detector::EdgeEdge,
    }
}

/// Returns the thresholds of a pair of features: the given ones, or lesser ones for a vertex or convex arc in a barely
/// larger concave arc (see [`Tolerances::for_clearance`]).
#[must_use]
#[inline]
pub fn pair_tolerances(a: &Feature, b: &Feature, tolerances: &Tolerances) -> Tolerances {
    match (a, b) {
        (Feature::Round(a), Feature::Round(b)) if a.radius < 0.0 || b.radius < 0.0 => {
            tolerances.for_clearance(-touching_distance(a, b))
        }
        _ => *tolerances,
    }
}

/// True if the contact lies within both features, or outside by no more than the accuracy.
///
/// A vertex outside of its normal cone is not the nearest point of its body: its neighbour along an edge is.
/// While the neighbour is nearer by less than the accuracy, both touch; thus a block lands flat on two corners.
/// An angle outside of a range counts as a distance: the angle times the feature's lever.
fn is_within(sample: &GapSample, sides: [(&Shape, FeatureId); 2], tolerances: &Tolerances) -> bool {
    let excess = if sample.primary_is_a {
        [sample.excess_primary, sample.excess_normal]
    } else {
        [sample.excess_normal, sample.excess_primary]
    };
    let levers = contact_levers(sides);
    let leans = |side: usize| excess[side] <= tolerances.accuracy / levers[side];
    sample.overrun <= tolerances.accuracy && leans(0) && leans(1)
}

/// Lengths [m] by which angles outside of the ranges of two touching features are multiplied to become distances: the
/// [`Shape::lever`]s of both, except that the lever of a vertex on a line is at most the line's length, over which the
/// two bodies can lie flat on each other.
#[must_use]
#[inline]
pub fn contact_levers(sides: [(&Shape, FeatureId); 2]) -> [f64; 2] {
    let [own, other] = sides.map(|(shape, id)| shape.lever(id));
    match sides.map(|(shape, id)| shape.feature(id)) {
        [Feature::Round(corner), Feature::Line(_)] if corner.radius == 0.0 => [own.min(other), other],
        [Feature::Line(_), Feature::Round(corner)] if corner.radius == 0.0 => [own, other.min(own)],
        _ => [own, other],
    }
}
