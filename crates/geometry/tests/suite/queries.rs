//! Queries against sampling and against brute force over every edge.

use crate::sampling::{SAMPLES, coarseness, outline_points, sampled_contains};
use crate::shapes::{any_angle, any_pose, any_shape, any_vector, map_spec, specs_of};
use halfgap_geometry::{
    Aabb, DVec2, Edge, EdgeSpec, Feature, FeatureId, FeatureKind, MotionBound, PathSpec, Pose, Ray, Relation,
    Rotation, Shape, ShapeError, edge_distance,
};
use proptest::prelude::*;

/// Rounding allowed, as a fraction of the sizes involved.
const ROUNDING: f64 = 2e-14;

fn sampled_distance(a: &[DVec2], b: &[DVec2]) -> f64 {
    let to_b = |p: &DVec2| b.iter().map(|q| (*p - *q).length_squared()).fold(f64::INFINITY, f64::min);
    a.iter().map(to_b).fold(f64::INFINITY, f64::min).sqrt()
}

fn to_world(points: &[DVec2], pose: &Pose) -> Vec<DVec2> {
    points.iter().map(|&p| pose.point_to_world(p)).collect()
}

/// Largest radius or length of the shape: arcs are no better known than their centers.
fn scale(shape: &Shape) -> f64 {
    let radius = |edge: &Edge| match edge {
        Edge::Line(_) => 0.0,
        Edge::Arc(arc) => arc.radius() + arc.center().length(),
    };
    shape.reach() + shape.edges().map(radius).fold(0.0, f64::max)
}

fn brute_distance(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> f64 {
    let placed = |shape: &Shape, pose: &Pose| shape.edges().map(|e| e.posed(pose)).collect::<Vec<_>>();
    let (a, b) = (placed(a, pose_a), placed(b, pose_b));
    a.iter().flat_map(|p| b.iter().map(|q| edge_distance(p, q).distance)).fold(f64::INFINITY, f64::min)
}

proptest! {
    #[test]
    fn no_sampled_pair_of_points_is_closer(
        a in any_shape(), pose_a in any_pose(), b in any_shape(), pose_b in any_pose(),
    ) {
        let found = a.distance(&pose_a, &b, &pose_b);
        let (points_a, points_b) = (to_world(&outline_points(&a), &pose_a), to_world(&outline_points(&b), &pose_b));
        let sampled = sampled_distance(&points_a, &points_b);
        let rounding = ROUNDING * (scale(&a) + scale(&b) + pose_a.position.length() + pose_b.position.length());
        prop_assert!(found.distance <= sampled + rounding, "{} {sampled}", found.distance);
        prop_assert!(sampled - found.distance <= coarseness(&a) + coarseness(&b) + rounding);
        // The witnesses are apart by the distance returned, and lie on the edges named.
        prop_assert!(((found.point_a - found.point_b).length() - found.distance).abs() <= rounding);
        let (on_a, on_b) = (pose_a.point_to_body(found.point_a), pose_b.point_to_body(found.point_b));
        prop_assert!((a.edge(found.edge_a).nearest(on_a) - on_a).length() <= rounding);
        prop_assert!((b.edge(found.edge_b).nearest(on_b) - on_b).length() <= rounding);
    }

    #[test]
    fn the_trees_find_what_every_pair_of_edges_has(
        a in any_shape(), pose_a in any_pose(), b in any_shape(), pose_b in any_pose(),
    ) {
        let (found, brute) = (a.distance(&pose_a, &b, &pose_b).distance, brute_distance(&a, &pose_a, &b, &pose_b));
        let rounding = ROUNDING * (scale(&a) + scale(&b) + pose_a.position.length() + pose_b.position.length());
        prop_assert!((found - brute).abs() <= rounding, "{found} {brute}");
    }

    #[test]
    fn distance_is_symmetric_and_moves_along(
        a in any_shape(), pose_a in any_pose(), b in any_shape(), pose_b in any_pose(),
        shift in any_vector(10.0), angle in any_angle(),
    ) {
        let found = a.distance(&pose_a, &b, &pose_b);
        prop_assert_eq!(a.relation(&pose_a, &b, &pose_b), found.relation);
        let swapped = b.distance(&pose_b, &a, &pose_a);
        let size = scale(&a) + scale(&b) + pose_a.position.length() + pose_b.position.length() + 20.0;
        prop_assert!((found.distance - swapped.distance).abs() <= ROUNDING * size);
        let turn = Rotation::from_angle(angle);
        let moved = |pose: &Pose| Pose {
            position: turn.apply(pose.position) + shift,
            rotation: Rotation {
                cos: turn.cos * pose.rotation.cos - turn.sin * pose.rotation.sin,
                sin: turn.sin * pose.rotation.cos + turn.cos * pose.rotation.sin,
            },
        };
        let there = a.distance(&moved(&pose_a), &b, &moved(&pose_b));
        prop_assert!((found.distance - there.distance).abs() <= ROUNDING * size);
        if found.distance > ROUNDING * size {
            prop_assert_eq!(found.relation, there.relation);
            let expected = match swapped.relation {
                Relation::FirstInside => Relation::SecondInside,
                Relation::SecondInside => Relation::FirstInside,
                other => other,
            };
            prop_assert_eq!(found.relation, expected);
        }
    }

    #[test]
    fn distance_survives_mirror_and_scale(
        a in any_shape(), pose_a in any_pose(), b in any_shape(), pose_b in any_pose(),
        factor in prop_oneof![Just(1e-3), Just(1e3), 0.1..10.0],
    ) {
        let mapped = |shape: &Shape| {
            let flip = |p: DVec2| DVec2::new(-p.x, p.y) * factor;
            let specs: Vec<_> = specs_of(shape).iter().map(|spec| map_spec(spec, &flip, true)).collect();
            Shape::from_paths(&specs).expect("mirrored and scaled")
        };
        let pose = |pose: &Pose| Pose {
            position: DVec2::new(-pose.position.x, pose.position.y) * factor,
            rotation: Rotation { cos: pose.rotation.cos, sin: -pose.rotation.sin },
        };
        let here = a.distance(&pose_a, &b, &pose_b).distance * factor;
        let there = mapped(&a).distance(&pose(&pose_a), &mapped(&b), &pose(&pose_b)).distance;
        let size = scale(&a) + scale(&b) + pose_a.position.length() + pose_b.position.length();
        prop_assert!((here - there).abs() <= ROUNDING * size * factor, "{here} {there}");
    }

    #[test]
    fn aligned_blocks_are_apart_by_the_air_between_them(
        sides in prop::array::uniform4(1u8..9), place in (-12i8..13, -12i8..13), angle in any_angle(),
        origin in any_vector(3.0),
    ) {
        let [width_a, height_a, width_b, height_b] = sides.map(|side| f64::from(side) / 4.0);
        let (a, b) = (Shape::block(width_a, height_a).expect("fine"), Shape::block(width_b, height_b).expect("fine"));
        let place = DVec2::new(f64::from(place.0), f64::from(place.1)) / 4.0;
        let turn = Rotation::from_angle(angle);
        let found = a.distance(&Pose::new(origin + turn.apply(place), angle), &b, &Pose::new(origin, angle));
        let half = DVec2::new(width_a + width_b, height_a + height_b) / 2.0;
        let air = place.abs() - half;
        let rounding = ROUNDING * 10.0;
        if air.max_element() > 0.0 {
            prop_assert!((found.distance - air.max(DVec2::ZERO).length()).abs() <= rounding);
            prop_assert_eq!(found.relation, Relation::Apart);
        } else if air.max_element() == 0.0 {
            prop_assert!(found.distance <= rounding);
            prop_assert_eq!(found.relation, Relation::Crossing);
        } else {
            // Distance to the nearest edge of the other block, seen from inside of it.
            let inside = |outer: DVec2, inner: DVec2| ((outer - inner) / 2.0 - place.abs()).min_element();
            let (size_a, size_b) = (DVec2::new(width_a, height_a), DVec2::new(width_b, height_b));
            let depth = inside(size_b, size_a).max(inside(size_a, size_b));
            prop_assert!((found.distance - depth.max(0.0)).abs() <= rounding);
            let expected = match (depth > 0.0, inside(size_b, size_a) > 0.0) {
                (false, _) => Relation::Crossing,
                (true, true) => Relation::FirstInside,
                (true, false) => Relation::SecondInside,
            };
            prop_assert_eq!(found.relation, expected);
        }
    }

    #[test]
    fn polygons_are_refused_exactly_if_edges_meet(
        corners in prop::collection::vec(prop_oneof![
            any_vector(1.0), (-3i8..4, -3i8..4).prop_map(|(x, y)| DVec2::new(f64::from(x), f64::from(y))),
        ], 3..8),
    ) {
        let count = corners.len();
        let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
        let between = |p: DVec2, q: DVec2, r: DVec2| {
            side(p, q, r) == 0.0 && (p - r).dot(q - r) <= 0.0
        };
        let meet = |i: usize, j: usize| {
            let (p, q) = (corners[i], corners[(i + 1) % count]);
            let (r, s) = (corners[j], corners[(j + 1) % count]);
            if (i + 1) % count == j {
                // Neighbours share q = r.
                return between(p, q, s) || between(r, s, p);
            }
            if (j + 1) % count == i {
                return between(r, s, q) || between(p, q, r);
            }
            let crosses = side(p, q, r) * side(p, q, s) < 0.0 && side(r, s, p) * side(r, s, q) < 0.0;
            crosses || between(p, q, r) || between(p, q, s) || between(r, s, p) || between(r, s, q)
        };
        let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (j, i)));
        let expected = pairs.clone().any(|(i, j)| meet(i, j)) || (0..count).any(|i| corners[i] == corners[(i + 1) % count]);
        let built = Shape::polygon(&corners);
        prop_assert_eq!(built.is_err(), expected, "{:?}", built.err());
        if let Err(ShapeError::Crossing { edge_a, edge_b, .. }) = built {
            prop_assert_eq!(pairs.filter(|&(i, j)| meet(i, j)).min(), Some((edge_a, edge_b)));
        }
    }

    #[test]
    fn a_point_is_inside_where_the_sampled_outline_winds(shape in any_shape(), point in any_vector(2.5)) {
        let near = shape.nearest(point);
        // The chords of the samples cut off a little of each arc.
        let cut = shape.edges().map(|edge| {
            let Edge::Arc(arc) = edge else { return 0.0 };
            arc.radius() * (arc.sweep_angle() / f64::from(SAMPLES)).powi(2) / 8.0
        }).fold(0.0, f64::max);
        prop_assert_eq!(shape.contains(point), near.signed_distance < 0.0);
        if near.signed_distance.abs() > cut + ROUNDING * scale(&shape) {
            prop_assert_eq!(shape.contains(point), sampled_contains(&shape, point));
        }
    }

    #[test]
    fn points_level_with_a_vertex_are_judged_right(shape in any_shape(), which in 0usize..40, x in -3.0..3.0) {
        let edges: Vec<&Edge> = shape.edges().collect();
        let point = DVec2::new(x, edges[which % edges.len()].from().y);
        let brute = shape.paths().iter().filter(|path| path.surrounds(point)).count() % 2 == 1;
        prop_assert_eq!(shape.contains(point), brute);
        let near = shape.nearest(point);
        if near.signed_distance.abs() > 1e-9 {
            // Just above and below the answer is the same.
            for nudge in [-1e-10, 1e-10] {
                prop_assert_eq!(shape.contains(point + DVec2::new(0.0, nudge)), brute);
            }
        }
    }

    #[test]
    fn the_nearest_point_is_nearest(shape in any_shape(), point in any_vector(3.0)) {
        let near = shape.nearest(point);
        let brute = shape.edges().map(|e| (e.nearest(point) - point).length()).fold(f64::INFINITY, f64::min);
        prop_assert_eq!(near.signed_distance.abs(), brute);
        let sampled = sampled_distance(&[point], &outline_points(&shape));
        prop_assert!(brute <= sampled + ROUNDING * (scale(&shape) + 3.0));
        prop_assert!(sampled <= brute + coarseness(&shape) + ROUNDING * scale(&shape));
        let on_edge = shape.edge(near.edge).nearest(near.point);
        prop_assert!((on_edge - near.point).length() <= ROUNDING * scale(&shape));
    }

    #[test]
    fn a_ray_stops_where_inside_and_outside_meet(shape in any_shape(), origin in any_vector(3.0), angle in any_angle()) {
        let direction = DVec2::new(angle.cos(), angle.sin());
        let ray = Ray { origin, direction };
        let hit = shape.cast_ray(&ray, f64::INFINITY);
        let brute = shape.edges().filter_map(|e| ray.distance_to(e)).fold(f64::INFINITY, f64::min);
        prop_assert_eq!(hit.map_or(f64::INFINITY, |hit| hit.distance), brute);
        let rounding = 1e-6;
        let end = hit.map_or(10.0, |hit| hit.distance);
        for step in 1..200 {
            let point = origin + direction * (end * f64::from(step) / 200.0);
            if shape.nearest(point).signed_distance.abs() > rounding {
                prop_assert_eq!(shape.contains(point), shape.contains(origin), "at {}", point);
            }
        }
        if let Some(hit) = hit {
            prop_assert!(shape.nearest(hit.point).signed_distance.abs() < ROUNDING * (scale(&shape) + 6.0) * 100.0);
            prop_assert!((hit.normal.length() - 1.0).abs() < 1e-9);
            prop_assert_eq!(shape.cast_ray(&ray, hit.distance), Some(hit));
            let entering = hit.normal.dot(direction) < 0.0;
            if hit.normal.dot(direction).abs() > 1e-3 && shape.nearest(origin).signed_distance.abs() > rounding {
                prop_assert_eq!(entering, !shape.contains(origin));
            }
        }
    }

    #[test]
    fn how_long_the_direction_of_a_ray_is_does_not_matter(shape in any_shape(), origin in any_vector(3.0), angle in any_angle(), power in -40i32..40) {
        let direction = DVec2::from_angle(angle);
        let of_length = |length: f64| shape.cast_ray(&Ray { origin, direction: direction * length }, f64::INFINITY);
        // Multiplication by a power of two rounds nothing.
        prop_assert_eq!(of_length(2.0_f64.powi(power)), of_length(1.0));
        prop_assert_eq!(of_length(0.0), None);
        prop_assert_eq!(of_length(f64::NAN), None);
    }

    #[test]
    fn a_ray_at_a_vertex_does_not_slip_through(shape in any_shape(), origin in any_vector(3.0), which in 0usize..40) {
        let edges: Vec<&Edge> = shape.edges().collect();
        let target = edges[which % edges.len()].from();
        prop_assume!((target - origin).length() > 1e-3);
        let distance = (target - origin).length();
        let ray = Ray { origin, direction: (target - origin) / distance };
        // The ray may only graze a corner, and go on as it came.
        let end = shape.cast_ray(&ray, f64::INFINITY).map_or(10.0, |hit| hit.distance);
        for step in 1..200 {
            let point = origin + ray.direction * (end * f64::from(step) / 200.0);
            if shape.nearest(point).signed_distance.abs() > 1e-6 {
                prop_assert_eq!(shape.contains(point), shape.contains(origin), "at {}", point);
            }
        }
    }

    #[test]
    fn bounds_are_tight(shape in any_shape(), pose in any_pose()) {
        let bounds = shape.bounds_at(&pose);
        let points = to_world(&outline_points(&shape), &pose);
        let sampled = points.iter().fold(Aabb::around(points[0]), |b, &p| b.including(p));
        let rounding = ROUNDING * (scale(&shape) + pose.position.length());
        prop_assert!(bounds.grown(rounding).contains(&sampled));
        prop_assert!(sampled.grown(2e-3 * shape.reach() + rounding).contains(&bounds));
        let at_rest = shape.bounds_at(&Pose::IDENTITY);
        prop_assert!(at_rest.grown(rounding).contains(&shape.bounds()));
        prop_assert!(shape.bounds().grown(rounding).contains(&at_rest));
    }

    #[test]
    fn swept_bounds_are_tight(
        shape in any_shape(), from_angle in any_angle(),
        turn in prop_oneof![Just(0.0), Just(7.0), 0.0..6.5, 0.0..0.01],
        low in any_vector(1.0), size in (0.0..1.0, 0.0..1.0),
    ) {
        let positions = Aabb { min: low, max: low + DVec2::from(size) };
        let swept = shape.swept_bounds(&MotionBound { positions, from_angle, to_angle: from_angle + turn });
        let steps = 300;
        let mut sampled: Option<Aabb> = None;
        for step in 0..=steps {
            let angle = from_angle + turn * f64::from(step) / f64::from(steps);
            for corner in [positions.min, positions.max] {
                let bounds = shape.bounds_at(&Pose::new(corner, angle));
                sampled = Some(sampled.map_or(bounds, |all| all.union(bounds)));
            }
        }
        let sampled = sampled.expect("there are steps");
        let rounding = ROUNDING * (scale(&shape) + 2.0);
        prop_assert!(swept.grown(rounding).contains(&sampled), "{swept:?} {sampled:?}");
        let coarse = shape.reach() * (turn / f64::from(steps)).powi(2);
        prop_assert!(sampled.grown(coarse + rounding).contains(&swept), "{swept:?} {sampled:?}");
    }
}

#[test]
fn outlines_go_on_straight_beyond_round_corners_and_not_beyond_sharp_ones() {
    let ids =
        |shape: &Shape| (0..shape.features().len()).map(|index| FeatureId(index as u32)).collect::<Vec<_>>();
    let straight = |shape: &Shape| -> Vec<Option<[bool; 2]>> {
        let of = |id: FeatureId| match shape.feature(id) {
            Feature::Round(arc) if arc.radius > 0.0 => {
                Some(arc.range.ends().map(|ends| ends.map(|end| shape.goes_on_straight(id, end))))
            }
            _ => None,
        };
        ids(shape).into_iter().filter_map(of).collect()
    };
    let rounded = Shape::rounded_block(2.0, 1.0, 0.25).expect("a fine radius");
    assert_eq!(straight(&rounded), [Some([true; 2]); 4]);
    assert_eq!(straight(&Shape::disc(1.0).expect("a fine radius")), [None]);
    // A half disc, whose arc ends at corners.
    let arc = EdgeSpec::Arc { to: -DVec2::X, center: DVec2::ZERO, clockwise: false };
    let spec = PathSpec { start: DVec2::X, edges: vec![arc, EdgeSpec::Line { to: DVec2::X }] };
    assert_eq!(straight(&Shape::from_paths(&[spec]).expect("half a disc")), [Some([false; 2])]);
    // A quarter disc on a block as wide: the arc goes on straight at its end, and starts at a corner.
    let arc = EdgeSpec::Arc { to: DVec2::X, center: DVec2::ZERO, clockwise: true };
    let sides = [DVec2::new(1.0, -1.0), DVec2::new(0.0, -1.0), DVec2::Y].map(|to| EdgeSpec::Line { to });
    let edges = std::iter::once(arc).chain(sides).collect();
    let quarter =
        Shape::from_paths(&[PathSpec { start: DVec2::Y, edges }]).expect("a quarter disc on a block");
    assert_eq!(straight(&quarter), [Some([true, false])]);
    let block = Shape::block(2.0, 1.0).expect("fine sides");
    assert!(ids(&block).into_iter().all(|id| !block.goes_on_straight(id, DVec2::Y)));
}

proptest! {
    #[test]
    fn the_ends_of_an_edge_are_the_corners_where_it_starts_and_ends(shape in any_shape()) {
        let ids = || (0..shape.features().len()).map(|index| FeatureId(index as u32));
        let is_corner = |id: FeatureId| shape.source(id).kind == FeatureKind::Vertex;
        for id in ids() {
            let path = shape.source(id).path;
            let corner_at = |place: DVec2| {
                ids().find(|&corner| {
                    is_corner(corner)
                        && shape.source(corner).path == path
                        && shape.edge_of(corner).from() == place
                })
            };
            let edge = shape.edge_of(id);
            let ends = if is_corner(id) { [None; 2] } else { [edge.from(), edge.to()].map(corner_at) };
            prop_assert_eq!(shape.ends_of(id), ends);
        }
    }

    #[test]
    fn the_sides_of_a_corner_are_the_edges_that_end_and_start_there(shape in any_shape()) {
        for id in (0..shape.features().len()).map(|index| FeatureId(index as u32)) {
            if shape.source(id).kind != FeatureKind::Vertex {
                prop_assert_eq!(shape.sides_of(id), None);
                continue;
            }
            let place = shape.edge_of(id).from();
            let sides = shape.sides_of(id).expect("a corner has sides");
            prop_assert!(sides.iter().all(|&side| shape.source(side).kind != FeatureKind::Vertex));
            let ends = [shape.edge_of(sides[0]).to(), shape.edge_of(sides[1]).from()];
            prop_assert_eq!(ends, [place; 2]);
        }
    }
}

#[test]
fn rays_go_in_directions_of_any_length() {
    let block = Shape::block(1.0, 1.0).expect("a fine block");
    for length in [1e-320, 1e-200, 1e-160, 1.0, 1e160, 1e300] {
        let ray = Ray { origin: DVec2::new(-2.0, 0.1), direction: DVec2::new(length, 0.0) };
        let hit = block.cast_ray(&ray, f64::INFINITY).expect("it meets the block");
        assert_eq!(hit.distance, 1.5, "{length}");
    }
    for direction in [DVec2::ZERO, DVec2::new(f64::NAN, 1.0), DVec2::new(f64::INFINITY, 1.0)] {
        let ray = Ray { origin: DVec2::new(-2.0, 0.1), direction };
        assert_eq!(block.cast_ray(&ray, f64::INFINITY), None, "{direction}");
    }
}

#[test]
fn convex_shapes_are_told_from_those_with_a_hollow_a_hole_or_a_corner_that_points_inwards() {
    let shape = |shape: Result<Shape, _>| shape.expect("a fine shape");
    let points =
        |points: &[[f64; 2]]| -> Vec<DVec2> { points.iter().map(|&[x, y]| DVec2::new(x, y)).collect() };
    let dart = points(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.5], [1.0, 2.0]]);
    let lens = PathSpec {
        start: DVec2::new(-1.0, 0.0),
        edges: vec![
            EdgeSpec::Arc { to: DVec2::new(1.0, 0.0), center: DVec2::new(0.0, 2.0), clockwise: false },
            EdgeSpec::Arc { to: DVec2::new(-1.0, 0.0), center: DVec2::new(0.0, -2.0), clockwise: false },
        ],
    };
    let hollow = PathSpec {
        start: DVec2::new(-1.0, 0.0),
        edges: vec![
            EdgeSpec::Line { to: DVec2::new(1.0, 0.0) },
            EdgeSpec::Line { to: DVec2::new(1.0, 2.0) },
            EdgeSpec::Arc { to: DVec2::new(-1.0, 2.0), center: DVec2::new(0.0, 4.0), clockwise: true },
            EdgeSpec::Line { to: DVec2::new(-1.0, 0.0) },
        ],
    };
    for (made, is_convex) in [
        (shape(Shape::disc(1.0)), true),
        (shape(Shape::block(2.0, 1.0)), true),
        (shape(Shape::rounded_block(2.0, 1.0, 0.2)), true),
        (shape(Shape::from_paths(&[lens])), true),
        (shape(Shape::from_paths(&[hollow])), false),
        (shape(Shape::polygon(&dart)), false),
        (shape(Shape::ring(2.0, 1.0)), false),
    ] {
        assert_eq!(made.is_convex(), is_convex, "{made:?}");
    }
}
