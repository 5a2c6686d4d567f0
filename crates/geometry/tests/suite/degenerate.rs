//! Awkward shapes: full circles and halves, horns, nests of holes, several pieces, flat arcs, far from the origin.

use crate::errors::gear;
use halfgap_geometry::{
    Arc, DVec2, DirectionRange, Edge, EdgeSpec, FeatureKind, GapSample, PathSpec, Pose, Ray, Relation, Shape,
};
use std::f64::consts::{PI, TAU};

fn v(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn kinds(shape: &Shape) -> Vec<FeatureKind> {
    shape.features().iter().map(halfgap_geometry::Feature::kind).collect()
}

fn bulges(start: DVec2, edges: &[(DVec2, f64)]) -> Shape {
    let edges = edges.iter().map(|&(to, bulge)| EdgeSpec::Bulge { to, bulge }).collect();
    Shape::from_paths(&[PathSpec { start, edges }]).expect("a fine shape")
}

#[test]
fn a_disc_is_the_same_however_its_circle_is_cut() {
    let whole = Shape::disc(1.0).expect("a fine disc");
    let halves = bulges(DVec2::X, &[(DVec2::NEG_X, 1.0), (DVec2::X, 1.0)]);
    let unequal = bulges(DVec2::X, &[(DVec2::Y, 0.414_213_562_373_095_03), (DVec2::X, 1.0 + 2f64.sqrt())]);
    for shape in [&halves, &unequal] {
        assert!((shape.mass_properties().area - PI).abs() < 1e-14);
        assert!((shape.mass_properties().moment_per_mass - 0.5).abs() < 1e-14);
        assert_eq!(kinds(shape), [FeatureKind::ConvexArc; 2], "no vertex where arcs go on");
        for x in [-1.5, -0.9, -0.3, 0.0, 0.7, 1.1] {
            for y in [-0.4, 0.0, 0.3] {
                assert_eq!(shape.contains(v(x, y)), whole.contains(v(x, y)), "({x}, {y})");
            }
        }
        let size = (shape.bounds().min, shape.bounds().max);
        assert!((size.0 + DVec2::ONE).length() < 1e-15 && (size.1 - DVec2::ONE).length() < 1e-15);
    }
}

#[test]
fn clockwise_input_gives_the_same_features() {
    let corners = [v(0.0, 0.0), v(2.0, 0.0), v(2.0, 1.0), v(0.0, 1.0)];
    let reversed: Vec<DVec2> = corners.iter().rev().copied().collect();
    let (one, other) = (Shape::polygon(&corners).expect("fine"), Shape::polygon(&reversed).expect("fine"));
    assert_eq!(one.mass_properties().area, other.mass_properties().area);
    assert_eq!(one.features().len(), other.features().len());
    let clockwise = PathSpec {
        start: DVec2::X,
        edges: vec![EdgeSpec::Arc { to: DVec2::X, center: DVec2::ZERO, clockwise: true }],
    };
    assert_eq!(kinds(&Shape::from_paths(&[clockwise]).expect("a disc")), [FeatureKind::ConvexArc]);
}

#[test]
fn islands_lie_in_holes_and_pieces_side_by_side() {
    let circles = [4.0, 3.0, 2.0, 1.0].map(|radius| PathSpec::circle(DVec2::ZERO, radius));
    let nest = Shape::from_paths(&circles).expect("a ring in a ring");
    assert!((nest.mass_properties().area - PI * (16.0 - 9.0 + 4.0 - 1.0)).abs() < 1e-13);
    use FeatureKind::{ConcaveArc, ConvexArc};
    assert_eq!(kinds(&nest), [ConvexArc, ConcaveArc, ConvexArc, ConcaveArc]);
    for (radius, inside) in [(0.5, false), (1.5, true), (2.5, false), (3.5, true), (4.5, false)] {
        assert_eq!(nest.contains(v(0.6, 0.8) * radius), inside);
    }
    let pieces = Shape::from_paths(&[PathSpec::circle(DVec2::ZERO, 1.0), PathSpec::circle(v(5.0, 0.0), 1.0)])
        .expect("a dumbbell without its bar");
    assert!((pieces.mass_properties().centroid - v(2.5, 0.0)).length() < 1e-15 * 4.0);
    assert!(pieces.contains(v(5.5, 0.0)) && !pieces.contains(v(2.5, 0.0)));
    // A disc around one of the pieces overlaps the shape, and neither lies wholly within the other.
    let big = Shape::disc(2.0).expect("a fine disc");
    let found = pieces.distance(&Pose::IDENTITY, &big, &Pose::IDENTITY);
    assert_eq!(found.relation, Relation::Overlapping);
    assert!((found.distance - 1.0).abs() < 1e-15);
}

#[test]
fn horns_are_vertices_and_clefts_are_not() {
    // An arbelos: a half disc less two half discs that touch it in its horns, and each other in a cleft.
    let shape = bulges(v(-2.0, 0.0), &[(v(0.5, 0.0), -1.0), (v(2.0, 0.0), -1.0), (v(-2.0, 0.0), 1.0)]);
    use FeatureKind::{ConcaveArc, ConvexArc, Vertex};
    assert_eq!(kinds(&shape), [Vertex, ConcaveArc, Vertex, ConcaveArc, Vertex, ConvexArc]);
    assert!(shape.mass_properties().area > 0.0);
    // Two discs that touch from outside leave a cleft without width: a vertex there would point into it.
    let cleft = bulges(
        v(-2.0, 0.0),
        &[
            (v(0.0, 0.0), 1.0),
            (v(2.0, 0.0), 1.0),
            (v(2.0, 3.0), 0.0),
            (v(-2.0, 3.0), 0.0),
            (v(-2.0, 0.0), 0.0),
        ],
    );
    assert_eq!(kinds(&cleft).iter().filter(|&&kind| kind == Vertex).count(), 2, "only the upper corners");
    for turn in 0..50 {
        // Rounding does not decide, whichever way the cusp is turned.
        let pose = Pose::new(DVec2::ZERO, f64::from(turn) * 0.13);
        let p = |x: f64, y: f64| pose.point_to_world(v(x, y));
        let turned = bulges(p(-2.0, 0.0), &[(p(0.5, 0.0), -1.0), (p(2.0, 0.0), -1.0), (p(-2.0, 0.0), 1.0)]);
        assert_eq!(kinds(&turned).iter().filter(|&&kind| kind == Vertex).count(), 3);
    }
}

#[test]
fn arcs_of_nearly_a_full_turn_leave_a_narrow_gap() {
    for gap in [1e-3, 1e-6, 1e-8] {
        let shape = Shape::sector(1.0, TAU - gap).expect("a fine pie");
        assert!((shape.mass_properties().area - (PI - gap / 2.0)).abs() < 1e-13);
        assert!(!shape.contains(v(-0.9, 0.0)) && shape.contains(v(-0.9, 2.0 * gap)));
        let near = shape.nearest(v(-2.0, 0.0));
        assert!((near.signed_distance - 1.0).abs() < gap * gap + 1e-15 * 4.0);
    }
}

#[test]
fn direction_ranges_decide_their_ends_to_rounding() {
    let at = |angle: f64| v(angle.cos(), angle.sin());
    for start in [0.0, 1.0, 2.0, 3.0, -2.5] {
        for sweep in [1e-12, 0.5, PI / 2.0, PI - 1e-12, PI, PI + 1e-12, 5.0, TAU - 1e-12] {
            let range = DirectionRange::between(at(start), at(start + sweep), sweep);
            assert!(range.excess(at(start)) < 1e-15 && range.excess(at(start + sweep)) < 1e-15);
            assert!(range.contains(at(start + sweep / 2.0)));
            let outside = TAU - sweep;
            let excess = range.excess(at(start + sweep + outside / 2.0));
            assert!((excess - outside / 2.0).abs() < 1e-14, "{start} {sweep} {excess}");
        }
    }
}

#[test]
fn a_shape_with_one_feature_answers_every_query() {
    let disc = Shape::disc(2.0).expect("a fine disc");
    assert_eq!(disc.features().len(), 1);
    assert!(disc.contains(DVec2::ZERO) && !disc.contains(v(2.0, 2.0)));
    assert_eq!(disc.nearest(DVec2::ZERO).signed_distance, -2.0);
    let ray = Ray { origin: v(-3.0, 0.0), direction: DVec2::X };
    assert!((disc.cast_ray(&ray, 10.0).expect("it hits").distance - 1.0).abs() < 1e-15);
    let inner = Shape::disc(0.5).expect("a fine disc");
    let found = inner.distance(&Pose::IDENTITY, &disc, &Pose::IDENTITY);
    assert_eq!((found.distance, found.relation), (1.5, Relation::FirstInside));
    let found = disc.distance(&Pose::IDENTITY, &inner, &Pose::IDENTITY);
    assert_eq!((found.distance, found.relation), (1.5, Relation::SecondInside));
}

#[test]
fn far_from_the_origin_only_the_positions_rounding_is_lost() {
    let (a, b) = (Shape::capsule(1.0, 0.25).expect("fine"), Shape::regular_polygon(5, 1.0).expect("fine"));
    let (here_a, here_b) = (Pose::new(v(2.5, 0.5), 0.3), Pose::new(v(0.0, 0.0), -1.1));
    let far = v(1048576.0, -1048576.0);
    let moved = |pose: &Pose| Pose { position: pose.position + far, ..*pose };
    let here = a.distance(&here_a, &b, &here_b);
    let there = a.distance(&moved(&here_a), &b, &moved(&here_b));
    assert!((here.distance - there.distance).abs() < 1e-15, "the shift is exact, and so is the answer");
    assert_eq!((here.edge_a, here.edge_b), (there.edge_a, there.edge_b));
    // Features are measured in world coordinates and lose the digits that those cannot hold.
    for (p, q) in a.features().iter().flat_map(|p| b.features().iter().map(move |q| (p, q))) {
        let here = GapSample::measure(p, &here_a, q, &here_b).map(|sample| sample.gap);
        let there = GapSample::measure(p, &moved(&here_a), q, &moved(&here_b)).map(|sample| sample.gap);
        let difference = here.zip(there).map_or(0.0, |(here, there)| (here - there).abs());
        assert!(difference < 4.0 * f64::EPSILON * 1048576.0);
    }
}

#[test]
fn an_arc_as_flat_as_they_come_keeps_its_ends() {
    let shape = bulges(DVec2::ZERO, &[(v(1.0, 0.0), 1e-6), (v(1.0, 1.0), 0.0), (DVec2::ZERO, 0.0)]);
    let Edge::Arc(arc) = shape.paths()[0].edges()[0] else { panic!("still an arc") };
    assert!((arc.radius() / 2.5e5 - 1.0).abs() < 1e-11);
    assert!((shape.nearest(v(0.5, -1.0)).signed_distance - (1.0 - 0.5e-6)).abs() < 1e-10);
    assert!(Arc::new(DVec2::ZERO, 1.0, 0.0, TAU).expect("a circle").is_circle());
}

#[test]
fn a_gear_is_found_by_its_tree() {
    let wheel = gear(125, 1.0);
    let pose = Pose::new(v(2.2, 0.1), 0.01);
    let found = wheel.distance(&pose, &wheel, &Pose::IDENTITY);
    assert!(found.distance > 0.0 && found.distance < 0.2);
    let on_wheel = pose.point_to_body(found.point_a);
    assert!((wheel.edge(found.edge_a).nearest(on_wheel) - on_wheel).length() < 1e-15 * 4.0);
    assert!(wheel.contains(v(0.0, 0.999)) && !wheel.contains(v(0.0, 1.1)));
}

#[test]
fn an_arc_that_is_all_of_a_path_is_a_circle_however_its_end_is_rounded() {
    for step in 0..200 {
        let angle = 0.031 * f64::from(step);
        let start = v(angle.cos(), angle.sin());
        for off in [0.0, 1e-7, -1e-7] {
            let (sin, cos) = (angle + TAU + off).sin_cos();
            for clockwise in [false, true] {
                let arc = EdgeSpec::Arc { to: v(cos, sin), center: DVec2::ZERO, clockwise };
                let disc = Shape::from_paths(&[PathSpec { start, edges: vec![arc] }]);
                let area = disc.expect("a circle").mass_properties().area;
                assert!((area - PI).abs() < 1e-12, "{angle} {off}: {area}");
            }
        }
    }
    let half = EdgeSpec::Arc { to: v(-1.0, 0.0), center: DVec2::ZERO, clockwise: false };
    assert!(Shape::from_paths(&[PathSpec { start: DVec2::X, edges: vec![half] }]).is_err());
}

#[test]
fn the_tip_of_a_needle_is_a_vertex_however_sharp() {
    let (along, aside) = (v(0.6, 0.8), v(-0.8, 0.6));
    for width in [0.9e-9, 1.1e-9, 1e-6] {
        let tip = DVec2::ZERO;
        let ends = [along - 0.5 * width * aside, along + 0.5 * width * aside];
        match Shape::polygon(&[tip, ends[0], ends[1]]) {
            Ok(needle) => {
                let vertices = kinds(&needle).iter().filter(|kind| **kind == FeatureKind::Vertex).count();
                assert_eq!(vertices, 3, "{width}");
            }
            // A needle as narrow as the tolerance of coinciding points may be refused, but not taken without its tip.
            Err(error) => assert!(width < 1e-8, "{width}: {error}"),
        }
    }
}
