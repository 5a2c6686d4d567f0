//! How deep two shapes overlap.

use glam::DVec2;
use halfgap_geometry::{Edge, GapSample, Pose, Relation, Shape};

/// Points at which an edge is looked at, beside its ends and the places where it could touch.
const SAMPLES: u32 = 16;

/// The largest distance [m] of a point of one outline inside the other shape from that shape's outline; `None` if the
/// shapes are apart.
///
/// Exact for a shallow overlap, whose deepest point is a vertex or the touching point of a pair of features.
pub(crate) fn overlap_depth(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> Option<f64> {
    if a.relation(pose_a, b, pose_b) == Relation::Apart {
        return None;
    }
    let touching = feature_points(a, pose_a, b, pose_b);
    let points_of_a =
        outline_points(a).map(|point| pose_a.point_to_world(point)).chain(touching.iter().map(|p| p[0]));
    let points_of_b =
        outline_points(b).map(|point| pose_b.point_to_world(point)).chain(touching.iter().map(|p| p[1]));
    let deepest = |points: &mut dyn Iterator<Item = DVec2>, shape: &Shape, pose: &Pose| {
        points.map(|point| -shape.nearest(pose.point_to_body(point)).signed_distance).fold(0.0, f64::max)
    };
    Some(deepest(&mut { points_of_a }, b, pose_b).max(deepest(&mut { points_of_b }, a, pose_a)))
}

/// The two touching points of every pair of features that overlaps within both of them, that of `a` first.
fn feature_points(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> Vec<[DVec2; 2]> {
    let mut points = Vec::new();
    for feature_a in a.features() {
        for feature_b in b.features() {
            let sample = GapSample::measure(feature_a, pose_a, feature_b, pose_b);
            if let Some(sample) = sample.filter(|sample| sample.is_valid() && sample.gap < 0.0) {
                let (primary, normal) = (sample.point_primary, sample.point_normal);
                points.push(if sample.primary_is_a { [primary, normal] } else { [normal, primary] });
            }
        }
    }
    points
}

/// Points along the outline of a shape in body coordinates.
fn outline_points(shape: &Shape) -> impl Iterator<Item = DVec2> + '_ {
    shape.edges().flat_map(|edge| {
        (0..SAMPLES).map(move |step| point_along(edge, f64::from(step) / f64::from(SAMPLES)))
    })
}

fn point_along(edge: &Edge, part: f64) -> DVec2 {
    match edge {
        Edge::Line(line) => line.from().lerp(line.to(), part),
        Edge::Arc(arc) => {
            let angle = arc.start_angle() + arc.sweep_angle() * part;
            arc.center() + DVec2::from_angle(angle) * arc.radius()
        }
    }
}
