//! The gap between features: symmetry, invariance, and its relation to the distance of shapes.

use crate::shapes::{any_angle, any_pose, any_shape, any_vector, map_spec, specs_of};
use halfgap_geometry::{DVec2, Edge, Feature, GapSample, Pose, Relation, Rotation, Shape};
use proptest::prelude::*;

/// Rounding allowed, as a fraction of the sizes involved.
const ROUNDING: f64 = 2e-14;
/// Contacts this close [rad or m] to the end of a feature count as inside: where two smooth edges meet, rounding may
/// place the contact on neither.
const END_SLACK: f64 = 1e-7;

/// True for a convex and a concave arc of the same radius: rounding decides whether they fit.
fn barely_fits(p: &Feature, q: &Feature) -> bool {
    let (Some(p), Some(q)) = (p.radius(), q.radius()) else { return false };
    (p < 0.0) != (q < 0.0) && (p + q).abs() <= ROUNDING * p.abs()
}

fn samples(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> Vec<GapSample> {
    let pairs = a.features().iter().flat_map(|p| b.features().iter().map(move |q| (p, q)));
    let pairs = pairs.filter(|(p, q)| !barely_fits(p, q));
    pairs.filter_map(|(p, q)| GapSample::measure(p, pose_a, q, pose_b)).collect()
}

fn is_nearly_valid(sample: &GapSample) -> bool {
    // An angle is a length on an arc.
    let primary = (sample.point_primary - sample.center_primary).length().max(1.0);
    let normal = (sample.point_normal - sample.center_normal).length().max(1.0);
    let beyond = (sample.excess_primary * primary).max(sample.excess_normal * normal);
    beyond.max(sample.overrun) <= END_SLACK
}

fn size(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> f64 {
    let radius = |edge: &Edge| match edge {
        Edge::Line(_) => 0.0,
        Edge::Arc(arc) => arc.radius() + arc.center().length(),
    };
    let of = |shape: &Shape, pose: &Pose| {
        shape.edges().map(radius).fold(shape.reach(), f64::max) + pose.position.length()
    };
    of(a, pose_a) + of(b, pose_b)
}

fn turned(pose: &Pose, turn: Rotation, shift: DVec2) -> Pose {
    let (p, q) = (turn, pose.rotation);
    Pose {
        position: turn.apply(pose.position) + shift,
        rotation: Rotation { cos: p.cos * q.cos - p.sin * q.sin, sin: p.sin * q.cos + p.cos * q.sin },
    }
}

proptest! {
    #[test]
    fn the_least_valid_gap_is_the_distance_of_shapes_that_are_apart(
        a in any_shape(), pose_a in any_pose(), b in any_shape(), pose_b in any_pose(),
    ) {
        let found = a.distance(&pose_a, &b, &pose_b);
        let rounding = ROUNDING * size(&a, &pose_a, &b, &pose_b);
        if found.relation != Relation::Apart || found.distance <= rounding {
            return Ok(());
        }
        let gaps = samples(&a, &pose_a, &b, &pose_b);
        let valid = gaps.iter().filter(|sample| is_nearly_valid(sample));
        let least = valid.map(|sample| sample.gap.abs()).fold(f64::INFINITY, f64::min);
        // The gap of a contact beyond the end of a feature by the slack is too small by at most the square of the
        // slack.
        let slack = END_SLACK * END_SLACK * size(&a, &pose_a, &b, &pose_b);
        prop_assert!((least - found.distance).abs() <= rounding + slack, "{least} {}", found.distance);
    }

    #[test]
    fn gaps_are_symmetric(a in any_shape(), pose_a in any_pose(), b in any_shape(), pose_b in any_pose()) {
        for p in a.features() {
            for q in b.features() {
                let (here, there) =
                    (GapSample::measure(p, &pose_a, q, &pose_b), GapSample::measure(q, &pose_b, p, &pose_a));
                prop_assert_eq!(here.is_some(), there.is_some());
                let (Some(here), Some(there)) = (here, there) else { continue };
                prop_assert_eq!(here.gap, there.gap);
                prop_assert_eq!(here.is_valid(), there.is_valid());
                let from_b_to_a = |sample: &GapSample, swapped: bool| {
                    if sample.primary_is_a == swapped { -sample.normal } else { sample.normal }
                };
                prop_assert_eq!(from_b_to_a(&here, false), from_b_to_a(&there, true));
            }
        }
    }

    #[test]
    fn gap_points_are_apart_by_the_gap_along_the_normal(
        a in any_shape(), pose_a in any_pose(), b in any_shape(), pose_b in any_pose(),
    ) {
        let rounding = ROUNDING * size(&a, &pose_a, &b, &pose_b);
        for sample in samples(&a, &pose_a, &b, &pose_b) {
            let between = sample.point_primary - sample.point_normal;
            prop_assert!((between - sample.normal * sample.gap).length() <= rounding);
            prop_assert!((sample.normal.length() - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn gaps_move_along(
        a in any_shape(), pose_a in any_pose(), b in any_shape(), pose_b in any_pose(),
        angle in any_angle(), shift in any_vector(10.0),
    ) {
        let turn = Rotation::from_angle(angle);
        let (moved_a, moved_b) = (turned(&pose_a, turn, shift), turned(&pose_b, turn, shift));
        let rounding = ROUNDING * (size(&a, &pose_a, &b, &pose_b) + 20.0);
        let (here, there) = (samples(&a, &pose_a, &b, &pose_b), samples(&a, &moved_a, &b, &moved_b));
        for (here, there) in here.iter().zip(&there) {
            prop_assert!((here.gap - there.gap).abs() <= rounding);
            let arm = (here.center_primary - here.center_normal).length();
            // Near the other's center the normal is only as good as the place of the center.
            if arm > 1e-3 {
                prop_assert!((turn.apply(here.normal) - there.normal).length() * arm <= rounding);
            }
            prop_assert!((here.overrun - there.overrun).abs() <= rounding);
        }
    }

    #[test]
    fn gaps_survive_mirror_and_scale(
        a in any_shape(), pose_a in any_pose(), b in any_shape(), pose_b in any_pose(),
        factor in prop_oneof![Just(1e-3), Just(1e3), 0.1..10.0],
    ) {
        let mapped = |shape: &Shape| {
            let flip = |p: DVec2| DVec2::new(p.x, -p.y) * factor;
            let specs: Vec<_> = specs_of(shape).iter().map(|spec| map_spec(spec, &flip, true)).collect();
            Shape::from_paths(&specs).expect("mirrored and scaled")
        };
        let pose = |pose: &Pose| Pose {
            position: DVec2::new(pose.position.x, -pose.position.y) * factor,
            rotation: Rotation { cos: pose.rotation.cos, sin: -pose.rotation.sin },
        };
        let all = |samples: Vec<GapSample>, factor: f64| {
            let mut gaps: Vec<f64> = samples.iter().map(|sample| sample.gap * factor).collect();
            gaps.sort_by(f64::total_cmp);
            gaps
        };
        let here = all(samples(&a, &pose_a, &b, &pose_b), factor);
        let there = all(samples(&mapped(&a), &pose(&pose_a), &mapped(&b), &pose(&pose_b)), 1.0);
        prop_assert_eq!(here.len(), there.len());
        let rounding = ROUNDING * factor * size(&a, &pose_a, &b, &pose_b);
        for (here, there) in here.iter().zip(&there) {
            prop_assert!((here - there).abs() <= rounding, "{here} {there}");
        }
    }
}
