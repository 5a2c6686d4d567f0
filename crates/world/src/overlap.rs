//! Depth of the overlap of two shapes.

use glam::DVec2;
use halfgap_geometry::{Edge, GapSample, Pose, Ray, Relation, Shape, edge_crossings};
use std::f64::consts::TAU;

/// Number of evenly spaced sample points of an edge, beside the middles of its pieces and the touching points.
const SAMPLES: u32 = 16;
/// Distance inside the outline at which a ray into a shape starts, as a fraction of the shape's reach.
const STEP_IN: f64 = 1e-9;

/// Returns the depth [m] of an overlap: the largest distance, from the other shape's outline, of a point of one outline
/// that lies in the other shape. `None` if the shapes are apart.
///
/// Exact for a shallow overlap, whose deepest point is a vertex or the touching point of a pair of features. For a deep
/// one it is a lower bound, from sample points on every piece of an outline that lies in the other shape, however short
/// the piece. Where the shapes cover each other, outline on outline, a point well inside each counts, with its depth in
/// both.
pub(crate) fn overlap_depth(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> Option<f64> {
    if a.relation(pose_a, b, pose_b) == Relation::Apart {
        return None;
    }
    let touching = feature_points(a, pose_a, b, pose_b);
    let [edges_a, edges_b] = [(a, pose_a), (b, pose_b)].map(|(shape, pose)| {
        let edges = shape.edges().map(|edge| edge.posed(pose));
        edges.collect::<Vec<_>>()
    });
    let points_of_a = outline_points(&edges_a, &edges_b).chain(touching.iter().map(|p| p[0]));
    let points_of_b = outline_points(&edges_b, &edges_a).chain(touching.iter().map(|p| p[1]));
    let deepest = |points: &mut dyn Iterator<Item = DVec2>, shape: &Shape, pose: &Pose| {
        points.map(|point| -shape.nearest(pose.point_to_body(point)).signed_distance).fold(0.0, f64::max)
    };
    let covered = covered_depth((a, pose_a), (b, pose_b)).max(covered_depth((b, pose_b), (a, pose_a)));
    let crossed = deepest(&mut { points_of_a }, b, pose_b).max(deepest(&mut { points_of_b }, a, pose_a));
    Some(crossed.max(covered))
}

/// Depth [m] of a point well inside a shape in both that shape and the other; 0 if it lies outside the other.
fn covered_depth((shape, pose): (&Shape, &Pose), (other, other_pose): (&Shape, &Pose)) -> f64 {
    let Some(inner) = inner_point(shape) else { return 0.0 };
    let in_other = other_pose.point_to_body(pose.point_to_world(inner));
    let depths = [shape.nearest(inner), other.nearest(in_other)].map(|near| -near.signed_distance);
    depths[0].min(depths[1]).max(0.0)
}

/// A point inside a shape: halfway from the middle of its longest edge straight across to the other side.
fn inner_point(shape: &Shape) -> Option<DVec2> {
    let edge = shape.edges().max_by(|p, q| p.length().total_cmp(&q.length()))?;
    let middle = point_along(edge, 0.5);
    let inward = -edge.normal_at(middle);
    // A ray that starts on the outline may meet it at once.
    let start = middle + STEP_IN * shape.reach() * inward;
    let hit = shape.cast_ray(&Ray { origin: start, direction: inward }, f64::INFINITY)?;
    Some(0.5 * (middle + hit.point))
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

/// Points along the edges of an outline, at least one on each piece between two crossings with other edges.
fn outline_points<'a>(edges: &'a [Edge], others: &'a [Edge]) -> impl Iterator<Item = DVec2> + 'a {
    edges.iter().flat_map(|edge| {
        let crossings = others.iter().flat_map(|other| edge_crossings(edge, other));
        let mut ends: Vec<f64> = crossings.map(|point| part_at(edge, point)).chain([0.0, 1.0]).collect();
        ends.sort_by(f64::total_cmp);
        let evenly = (0..SAMPLES).map(|step| f64::from(step) / f64::from(SAMPLES));
        let middles = ends.windows(2).map(|piece| 0.5 * (piece[0] + piece[1]));
        let parts: Vec<f64> = evenly.chain(middles).collect();
        parts.into_iter().map(move |part| point_along(edge, part))
    })
}

/// Fraction of an edge that lies before a point on it, 0 to 1.
fn part_at(edge: &Edge, point: DVec2) -> f64 {
    let part = match edge {
        Edge::Line(line) => (point - line.from()).dot(line.direction()) / line.length(),
        Edge::Arc(arc) => {
            let turn = (point - arc.center()).to_angle() - arc.start_angle();
            (turn * arc.sweep_angle().signum()).rem_euclid(TAU) / arc.sweep_angle().abs()
        }
    };
    part.clamp(0.0, 1.0)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Depth [m] to which a bar of a length and width [m], at a pose, lies in a shape.
    fn depth_of_bar(shape: &Shape, length: f64, width: f64, pose: Pose) -> f64 {
        let bar = Shape::block(length, width).expect("a bar");
        overlap_depth(shape, &Pose::IDENTITY, &bar, &pose).expect("they cross")
    }

    #[test]
    fn of_a_bar_through_a_wall_the_thicker_one_counts() {
        let wall = Shape::block(0.05, 4.0).expect("a wall");
        for (x, y, width) in [(0.06, 0.1, 0.02), (-0.7, 1.3, 0.002), (0.3, 0.3, 0.2)] {
            let depth = depth_of_bar(&wall, 2.0, width, Pose::new(DVec2::new(x, y), 0.0));
            assert!((depth - 0.5 * width.max(0.05)).abs() < 1e-12, "{depth} m of a bar of {width} m");
        }
    }

    #[test]
    fn shapes_that_cover_each_other_overlap_by_all_they_have() {
        let hexagon: Vec<DVec2> =
            (0..6).map(|corner| DVec2::from_angle(TAU * f64::from(corner) / 6.0)).collect();
        // Expected depth: that of the shape's middle, for a ring that of the middle of its wall.
        let shapes = [
            (Shape::disc(0.7), 0.7),
            (Shape::ring(1.0, 0.6), 0.2),
            (Shape::block(3.0, 0.4), 0.2),
            (Shape::rounded_block(1.0, 0.5, 0.1), 0.25),
            (Shape::polygon(&hexagon), 0.75f64.sqrt()),
        ];
        for (shape, expected) in shapes {
            let shape = shape.expect("a fine shape");
            for shift in [0.0, 1e-9, 1e-5] {
                let pose = Pose::new(DVec2::new(0.3, -1.0), 0.4);
                let beside = Pose::new(pose.position + DVec2::new(shift, 0.0), 0.4);
                let depth = overlap_depth(&shape, &pose, &shape, &beside).expect("they overlap");
                assert!(
                    (depth - expected).abs() <= shift + 1e-12,
                    "{depth} m for {expected}, moved by {shift} m"
                );
            }
        }
    }

    #[test]
    fn a_bar_through_a_thin_ring_is_found_wherever_it_goes_through() {
        let ring = Shape::ring(2.02, 2.0).expect("a ring");
        for angle in [0.0, 0.2, 1.0, 2.0, 3.1, 4.4] {
            let depth = depth_of_bar(&ring, 10.0, 0.3, Pose::new(DVec2::new(0.1, -0.2), angle));
            assert!((0.149..=0.15).contains(&depth), "{depth} m at {angle} rad");
        }
    }
}
