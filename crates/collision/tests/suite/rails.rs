//! Paths of rails: splines against known curves, nearest places against dense sampling.

use crate::random::Random;
use glam::DVec2;
use halfgap_collision::{Anchor, BodyId, Connector, ConnectorKind, Moving, RailError, RailPath, RailPlace};
use halfgap_geometry::{Aabb, EdgeSpec, Pose};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

fn at(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn spline(points: &[(f64, f64)], closed: bool) -> RailPath {
    let points: Vec<DVec2> = points.iter().copied().map(DVec2::from).collect();
    RailPath::through(&points, closed).expect("a fine spline")
}

fn wave() -> RailPath {
    spline(&[(-3.0, 0.0), (-1.5, 0.8), (0.2, -0.6), (1.4, 0.5), (3.0, 0.2)], false)
}

fn bean() -> RailPath {
    spline(&[(2.0, 0.0), (1.2, 1.4), (-0.4, 0.9), (-2.0, 1.2), (-1.8, -0.8), (0.3, -1.5)], true)
}

/// A lemniscate, which crosses itself at the origin.
fn eight() -> RailPath {
    let points: Vec<DVec2> = (0..24)
        .map(|step| TAU * f64::from(step) / 24.0)
        .map(|t| at(2.0 * t.sin(), 2.0 * t.sin() * t.cos()))
        .collect();
    RailPath::through(&points, true).expect("a fine eight")
}

fn sampled_circle(count: u32) -> RailPath {
    let points: Vec<DVec2> =
        (0..count).map(|step| 1.5 * DVec2::from_angle(TAU * f64::from(step) / f64::from(count))).collect();
    RailPath::through(&points, true).expect("a fine circle")
}

/// Two straight sides of 2 m with half circles of radius 0.5 m, counter-clockwise from the lower left.
fn stadium() -> RailPath {
    let edges = [
        EdgeSpec::Line { to: at(1.0, -0.5) },
        EdgeSpec::Arc { to: at(1.0, 0.5), center: at(1.0, 0.0), clockwise: false },
        EdgeSpec::Line { to: at(-1.0, 0.5) },
        EdgeSpec::Bulge { to: at(-1.0, -0.5), bulge: 1.0 },
    ];
    RailPath::from_edges(at(-1.0, -0.5), &edges).expect("a fine stadium")
}

/// A run-up, a full circle, a run-out.
fn loop_the_loop() -> RailPath {
    let edges = [
        EdgeSpec::Line { to: at(0.0, 0.0) },
        EdgeSpec::Arc { to: at(0.0, 0.0), center: at(0.0, 1.0), clockwise: false },
        EdgeSpec::Line { to: at(4.0, 0.0) },
    ];
    RailPath::from_edges(at(-3.0, 0.0), &edges).expect("a fine loop")
}

/// An open path whose ends are arcs.
fn hook() -> RailPath {
    let edges = [
        EdgeSpec::Arc { to: at(-1.0, 0.0), center: at(-2.0, 0.0), clockwise: true },
        EdgeSpec::Line { to: at(-1.0, -2.0) },
        EdgeSpec::Arc { to: at(0.0, -3.0), center: at(0.0, -2.0), clockwise: false },
    ];
    RailPath::from_edges(at(-3.0, 0.0), &edges).expect("a fine hook")
}

/// A closed path of four lines, and one of two arcs, with corners between them.
fn cornered() -> [RailPath; 2] {
    let line = |x, y| EdgeSpec::Line { to: at(x, y) };
    let square = [line(1.0, 0.0), line(1.0, 1.0), line(0.0, 1.0), line(0.0, 0.0)];
    let arc = |x, center: f64| EdgeSpec::Arc { to: at(x, 0.0), center: at(0.0, center), clockwise: false };
    let lens = [arc(-1.5, -0.5), arc(1.5, 0.5)];
    [(at(0.0, 0.0), &square[..]), (at(1.5, 0.0), &lens[..])]
        .map(|(start, edges)| RailPath::from_edges(start, edges).expect("a fine path"))
}

fn all() -> [RailPath; 6] {
    [wave(), bean(), eight(), stadium(), loop_the_loop(), hook()]
}

/// Largest error of the curvature of a sampled circle, and of its distance from the middle.
fn circle_errors(count: u32) -> [f64; 2] {
    let path = sampled_circle(count);
    let places = (0..1000).map(|step| path.place_at(path.length() * f64::from(step) / 1000.0));
    places.fold([0.0, 0.0], |[curvature, radius], place| {
        let off = (place.point().length() - 1.5).abs();
        [f64::max(curvature, (place.curvature() - 1.0 / 1.5).abs()), f64::max(radius, off)]
    })
}

#[test]
fn the_spline_through_a_circle_nears_it() {
    let errors = [16, 32, 64, 128].map(circle_errors);
    for pair in errors.windows(2) {
        let orders = [0, 1].map(|which: usize| (pair[0][which] / pair[1][which]).log2());
        assert!((orders[0] - 2.0).abs() < 0.1, "curvature: order {}", orders[0]);
        assert!((orders[1] - 4.0).abs() < 0.2, "position: order {}", orders[1]);
    }
    assert!(errors[3][0] < 1e-3 && errors[3][1] < 1e-7, "{errors:?}");
    let missing = (sampled_circle(128).length() - 3.0 * PI).abs();
    assert!(missing < 1e-7, "length off by {missing}");
}

#[test]
fn a_natural_spline_has_no_curvature_at_its_ends() {
    let path = wave();
    for end in [0.0, path.length()] {
        assert!(path.place_at(end).curvature().abs() < 1e-13);
    }
    // Through points on a line it is that line.
    let straight = spline(&[(0.0, 0.0), (1.0, 2.0), (1.5, 3.0), (4.0, 8.0)], false);
    assert!((straight.length() - 80f64.sqrt()).abs() < 1e-14);
    let place = straight.nearest(at(2.0, 3.0), None);
    assert!(place.curvature().abs() < 1e-13 && (place.gap() + 1.0 / 5f64.sqrt()).abs() < 1e-14);
    let two = spline(&[(0.0, 0.0), (0.0, 2.0)], false);
    assert_eq!((two.length(), two.place_at(0.5).point()), (2.0, at(0.0, 0.5)));
}

#[test]
fn splines_pass_through_their_points_with_two_continuous_derivatives() {
    let points = [(2.0, 0.0), (1.2, 1.4), (-0.4, 0.9), (-2.0, 1.2), (-1.8, -0.8), (0.3, -1.5)];
    for closed in [false, true] {
        let path = spline(&points, closed);
        let small = 1e-9;
        for (index, &point) in points.iter().enumerate() {
            let place = path.nearest(point.into(), None);
            assert!((place.point() - DVec2::from(point)).length() < 1e-14, "point {index}");
            let sides = [-small, small].map(|step| path.place_at(place.arc_length + step));
            assert!(sides[0].piece() != sides[1].piece() || (!closed && (index == 0 || index == 5)));
            assert!((sides[0].tangent() - sides[1].tangent()).length() < 1e-8);
            assert!((sides[0].curvature() - sides[1].curvature()).abs() < 1e-6, "point {index}");
        }
    }
}

#[test]
fn a_repeated_first_point_closes_the_spline() {
    let points = [(2.0, 0.0), (1.2, 1.4), (-0.4, 0.9), (-2.0, 1.2), (-1.8, -0.8), (0.3, -1.5), (2.0, 0.0)];
    assert_eq!(spline(&points, true), bean());
}

#[test]
fn the_arc_length_is_what_the_point_runs() {
    for path in all() {
        let (count, length) = (2000, path.length());
        for step in 0..count {
            let arc_length = length * (f64::from(step) + 0.5) / f64::from(count);
            let h = 1e-3;
            let place = path.place_at(arc_length);
            let [before, after] = [-h, h].map(|ahead| path.place_at(arc_length + ahead));
            if before.piece() != after.piece() {
                continue;
            }
            let tangent = (after.point() - before.point()) / (2.0 * h);
            assert!((tangent - place.tangent()).length() < 1e-4, "{tangent} at {arc_length}");
            let turn = (after.tangent() - before.tangent()) / (2.0 * h);
            assert!((turn - place.normal() * place.curvature()).length() < 1e-3, "{turn} at {arc_length}");
            let bend = (after.curvature() - before.curvature()) / (2.0 * h);
            assert!((bend - place.curvature_rate()).abs() < 1e-3 * place.curvature_rate().abs().max(10.0));
            let found = path.nearest(place.point(), Some(&place.hint()));
            assert!((found.arc_length - arc_length).abs() < 1e-13 * length, "{found:?} at {arc_length}");
            assert!(found.gap().abs() < 1e-14 * length);
        }
    }
}

#[test]
fn the_sum_of_chords_nears_the_length() {
    for path in all() {
        let sum = |count: u32| -> f64 {
            let place = |step| path.place_at(path.length() * f64::from(step) / f64::from(count)).point();
            // The last place of a closed path coincides with its first.
            (0..count).map(|step| (place(step + 1) - place(step)).length()).sum()
        };
        let (coarse, fine) = (sum(2000), sum(4000));
        // Chords fall short by h^2: Richardson extrapolation.
        let extrapolated = fine + (fine - coarse) / 3.0;
        assert!((extrapolated - path.length()).abs() < 1e-6 * path.length(), "{extrapolated}");
    }
}

/// The least distance from a point to the path or, beyond an end that is the nearest, its continuation.
fn sampled_distance(path: &RailPath, samples: &[DVec2], point: DVec2) -> f64 {
    let nearest = (0..samples.len())
        .min_by(|&a, &b| {
            (samples[a] - point).length_squared().total_cmp(&(samples[b] - point).length_squared())
        })
        .expect("there are samples");
    let step = path.length() / (samples.len() - 1) as f64;
    let (mut low, mut high) = (step * (nearest as f64 - 1.0), step * (nearest as f64 + 1.0));
    let distance = |arc_length: f64| (path.place_at(arc_length).point() - point).length();
    if !path.is_closed() {
        // Beyond an end the path is straight.
        if nearest == 0 {
            low = -10.0;
        } else if nearest + 1 == samples.len() {
            high += 10.0;
        }
    }
    for _ in 0..100 {
        let [first, last] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if distance(first) <= distance(last) { high = last } else { low = first }
    }
    distance(0.5 * (low + high))
}

#[test]
fn the_nearest_place_is_the_nearest_of_all() {
    let mut random = Random(1);
    for (index, path) in all().iter().chain(&cornered()).enumerate() {
        let samples: Vec<DVec2> =
            (0..=4000).map(|step| path.place_at(path.length() * f64::from(step) / 4000.0).point()).collect();
        for _ in 0..2000 {
            let point = random.point(4.0);
            let place = path.nearest(point, None);
            let distance = (place.point() - point).length();
            let expected = sampled_distance(path, &samples, point);
            let is_told = (path.distance(point) - distance).abs() < 1e-12;
            assert!(is_told || !path.is_closed(), "path {index}, {point}: {}", path.distance(point));
            assert!((distance - expected).abs() < 1e-7, "path {index}, {point}: {distance}, not {expected}");
            assert_foot(&place, point);
        }
    }
}

/// The point lies on the normal through its foot, at the gap.
fn assert_foot(place: &RailPlace, point: DVec2) {
    let off = (place.point() + place.normal() * place.gap() - point).length();
    assert!(off < 1e-12, "{place:?} of {point}: off by {off}");
    assert!((place.tangent().perp() - place.normal()).length() < 1e-15);
}

#[test]
fn a_hint_leads_to_the_same_place_along_the_path() {
    let mut random = Random(2);
    for path in all() {
        for _ in 0..2000 {
            // Close to the path, and far from its crossing with itself, the place near along the path is the nearest
            // of all.
            let along = random.between(0.0, path.length());
            let on_path = path.place_at(along);
            let point = on_path.point() + on_path.normal() * random.between(-0.02, 0.02);
            let place = path.nearest(point, None);
            if (place.arc_length - along).abs() > 1e-6 {
                continue;
            }
            let start = path.place_at(along + random.between(-0.15, 0.15));
            let found = path.nearest(point, Some(&start.hint()));
            assert!((found.point() - place.point()).length() < 1e-13, "{found:?}, not {place:?}");
            assert!((found.curvature() - place.curvature()).abs() < 1e-11 || found.piece() != place.piece());
        }
    }
}

#[test]
fn a_hint_leads_over_many_points() {
    let path = sampled_circle(400);
    let mut random = Random(5);
    for _ in 0..2000 {
        // Up to 1 rad, or 64 points, away and past the joint of the ends: closer than any other place of the spline.
        let start = random.between(-1.0, 1.0) * path.length();
        let place = path.place_at(start + random.between(-1.5, 1.5));
        let point = place.point() + place.normal() * random.between(-0.5, 0.5);
        let found = path.nearest(point, Some(&path.place_at(start).hint()));
        assert!((found.point() - place.point()).length() < 2e-15, "{found:?}, not {place:?}");
        assert!((found.curvature() - place.curvature()).abs() < 1e-10, "{found:?}, not {place:?}");
    }
}

#[test]
fn a_foot_is_exact_where_long_pieces_bend_sharply() {
    // Two pieces of 3 m, which turn round within 0.5 m of the point at which they meet.
    let path = spline(&[(-0.2, 3.0), (-3.0, 6.0), (3.0, 6.0), (0.2, 3.0), (0.0, 0.0)], true);
    let turn = path.nearest(DVec2::ZERO, None).arc_length;
    let mut random = Random(6);
    for _ in 0..5000 {
        let along = turn + random.between(-1.0, 1.0);
        let place = path.place_at(along);
        let point = place.point() + place.normal() * 1e-6;
        let hint = path.place_at(along + random.between(-0.1, 0.1)).hint();
        let found = path.nearest(point, Some(&hint));
        assert!((found.point() - place.point()).length() < 4e-15, "{found:?}, not {place:?}");
    }
}

#[test]
fn a_hint_beyond_an_end_leads_back() {
    let path = wave();
    for beyond in [1e-9, 1e-6, 1e-3, 0.3] {
        for [end, inward] in [[0.0, 1.0], [path.length(), -1.0]] {
            let hint = path.place_at(end - inward * beyond).hint();
            for depth in [1e-9, 1e-6, 1e-4, 1e-2] {
                let place = path.place_at(end + inward * depth);
                let found = path.nearest(place.point() + place.normal() * 0.01, Some(&hint));
                assert!((found.point() - place.point()).length() < 2e-15, "{found:?}, not {place:?}");
                assert!((found.curvature() - place.curvature()).abs() < 1e-13, "{found:?}, not {place:?}");
            }
        }
    }
}

#[test]
fn a_hint_does_for_points_far_away() {
    let mut random = Random(4);
    for path in [wave(), bean(), eight(), sampled_circle(400)] {
        let hint = path.place_at(0.3 * path.length()).hint();
        for size in [1e1, 1e3, 1e6] {
            for _ in 0..200 {
                let point = random.point(size);
                let place = path.nearest(point, Some(&hint));
                let off = (place.point() + place.normal() * place.gap() - point).length();
                assert!(off < 1e-12 * size, "{place:?} of {point}: off by {off}");
                assert_eq!(place.hint(), path.hint_near(point, Some(&hint)));
                if path.is_closed() {
                    assert!((0.0..=path.length()).contains(&place.arc_length), "{place:?} of {point}");
                    assert!(path.bounds().contains(&Aabb::around(place.point())), "{place:?} of {point}");
                }
            }
        }
    }
}

#[test]
fn a_hint_runs_lap_after_lap() {
    for path in [bean(), eight(), sampled_circle(400)] {
        // Strides of several points at a time, forward and back.
        for stride in [0.15, -0.15] {
            let mut hint = path.place_at(0.0).hint();
            for step in 0..300 {
                let arc_length = stride * f64::from(step);
                let on_path = path.place_at(arc_length);
                let place = path.nearest(on_path.point() + on_path.normal() * 0.01, Some(&hint));
                let missing = (place.arc_length - arc_length).rem_euclid(path.length());
                assert!(missing.min(path.length() - missing) < 1e-12, "{place:?} at {arc_length}");
                hint = place.hint();
            }
        }
    }
}

#[test]
fn a_hint_keeps_its_branch_where_the_path_crosses_itself() {
    let path = eight();
    for start in [0.0, 0.5 * path.length()] {
        let mut hint = path.place_at(start - 0.5).hint();
        for step in -50..=50 {
            let arc_length = start + 0.01 * f64::from(step);
            let on_path = path.place_at(arc_length);
            let place = path.nearest(on_path.point(), Some(&hint));
            assert!((place.tangent() - on_path.tangent()).length() < 1e-12, "at {arc_length}");
            hint = place.hint();
        }
    }
    // On the loop the circle starts and ends at one point, and the hint runs round it.
    let path = loop_the_loop();
    let mut hint = path.place_at(-0.5).hint();
    let steps = 1000;
    for step in 0..=steps {
        let arc_length = -0.5 + (path.length() + 1.0) * f64::from(step) / f64::from(steps);
        let place = path.nearest(path.place_at(arc_length).point(), Some(&hint));
        assert!((place.arc_length - arc_length).abs() < 1e-12, "{} at {arc_length}", place.arc_length);
        hint = place.hint();
    }
}

#[test]
fn a_hint_that_stays_does_so_beyond_the_joint() {
    let path = stadium();
    let hint = path.place_at(1.9).hint().staying();
    // Over the half circle, the straight side is continued.
    let place = path.nearest(at(1.3, -0.4), Some(&hint));
    assert!((place.arc_length - 2.3).abs() < 1e-15 && (place.gap() - 0.1).abs() < 1e-15);
    let free = path.nearest(at(1.3, -0.4), Some(&path.place_at(1.9).hint()));
    assert!((free.gap()).abs() < 1e-15 && free.curvature() == 2.0);
    // A circle is continued likewise, lap after lap.
    let path = loop_the_loop();
    let mut hint = path.place_at(3.0 + 0.3).hint().staying();
    for step in 1..40 {
        let arc_length = 3.3 + 0.5 * f64::from(step);
        let angle = arc_length - 3.0 - 0.5 * PI;
        let place = path.nearest(at(0.0, 1.0) + 1.1 * DVec2::from_angle(angle), Some(&hint));
        assert!((place.arc_length - arc_length).abs() < 1e-13 && (place.gap() + 0.1).abs() < 1e-15);
        hint = place.hint().staying();
    }
}

#[test]
fn knots_are_where_pieces_meet() {
    let path = stadium();
    let expected = [0.0, 2.0, 2.0 + 0.5 * PI, 4.0 + 0.5 * PI];
    assert_eq!(path.knots().len(), 4);
    for (knot, arc_length) in path.knots().iter().zip(expected) {
        assert!((knot.arc_length - arc_length).abs() < 1e-14 && knot.turn == 0.0);
        for forward in [false, true] {
            let step = if forward { 0.1 } else { -0.1 };
            let ahead = path.place_at(knot.arc_length + step);
            let place = path.nearest(ahead.point(), Some(&path.hint_past(knot, forward)));
            assert_eq!(place.piece(), ahead.piece());
            assert_eq!(place.curvature(), knot.curvatures[usize::from(forward)]);
            assert!(((place.arc_length - ahead.arc_length).abs() + 1e-13).rem_euclid(path.length()) < 2e-13);
        }
    }
    // Round the loop and back along it; beyond its knots lie the straight continuations.
    let path = loop_the_loop();
    assert_eq!(path.knots().len(), 4);
    for (knot, ahead) in [(path.knots()[1], 0.1), (path.knots()[2], -0.1)] {
        let expected = path.place_at(knot.arc_length + ahead);
        let place = path.nearest(expected.point(), Some(&path.hint_past(&knot, ahead > 0.0)));
        assert!((place.arc_length - expected.arc_length).abs() < 1e-13 && place.curvature() == 1.0);
    }
    // An arc at an open end continues straight, so that the end is a knot.
    let ends: Vec<f64> = hook().knots().iter().map(|knot| knot.arc_length).collect();
    assert_eq!((ends.len(), ends[0], ends[3]), (4, 0.0, hook().length()));
    assert!(bean().knots().is_empty());
    let halves =
        [EdgeSpec::Bulge { to: at(-1.0, 0.0), bulge: 1.0 }, EdgeSpec::Bulge { to: at(1.0, 0.0), bulge: 1.0 }];
    let circle = RailPath::from_edges(at(1.0, 0.0), &halves).expect("a fine circle");
    assert!(circle.knots().len() == 2 && circle.is_closed());
    // A full circle of one piece has no knot.
    let whole = [EdgeSpec::Arc { to: at(1.0, 0.0), center: at(0.0, 0.0), clockwise: false }];
    let circle = RailPath::from_edges(at(1.0, 0.0), &whole).expect("a fine circle");
    assert!(circle.knots().is_empty() && circle.is_closed());
}

#[test]
fn a_corner_is_a_knot_with_a_turn() {
    let edges = [EdgeSpec::Line { to: at(1.0, 0.0) }, EdgeSpec::Line { to: at(1.0, 1.0) }];
    let path = RailPath::from_edges(DVec2::ZERO, &edges).expect("a fine corner");
    let [_, knot, _] = path.knots() else { panic!("one corner, and two ends: {:?}", path.knots()) };
    assert!((knot.turn - 0.5 * PI).abs() < 1e-15 && knot.arc_length == 1.0);
    // In the cone of the corner the walk ends on either of its sides.
    let place = path.nearest(at(1.1, -0.2), Some(&path.place_at(0.5).hint()));
    assert!((1..=2).contains(&place.piece()));
    let place = path.nearest(at(0.9, 0.3), Some(&path.place_at(0.5).hint()));
    assert!((place.gap() - 0.3).abs() < 1e-15, "it has a foot on the first edge: {place:?}");
}

#[test]
fn the_sides_of_a_corner_face_into_its_angle() {
    let bead = |place: DVec2| Moving { pose: Pose::new(place, 0.0), ..Moving::BACKGROUND };
    for turn in [2.5_f64, 1.0, 1e-3, -1e-3, -1.0, -2.5] {
        let back = at(-1.0, 0.0);
        let on = at(turn.cos(), turn.sin());
        let edges = [EdgeSpec::Line { to: DVec2::ZERO }, EdgeSpec::Line { to: on }];
        let path = Arc::new(RailPath::from_edges(back, &edges).expect("a fine corner"));
        assert_eq!(path.corner_at(0.5 * back, 0.1), None);
        let sides = path.corner_at(at(0.0, 0.05), 0.1).expect("a corner is near");
        let a = Anchor { body: BodyId(0), point: DVec2::ZERO };
        let rail = Connector { kind: ConnectorKind::Rail { a, path }, elasticity: 0.0 };
        let gaps = |place: DVec2| {
            sides.map(|side| rail.measure_near(0, &bead(place), &Moving::BACKGROUND, Some(&side)).gap)
        };
        let sin = turn.sin().abs();
        for (place, expected) in [(DVec2::ZERO, [0.0, 0.0]), (back, [0.0, sin]), (on, [sin, 0.0])] {
            let off = gaps(place).iter().zip(expected).fold(0.0, |most: f64, (p, q)| most.max((p - q).abs()));
            assert!(off < 1e-15, "{turn} rad at {place} m: {off} m");
        }
    }
}

#[test]
fn small_misfits_are_made_exact() {
    let off = 1e-7;
    let edges = [
        EdgeSpec::Line { to: at(1.0, -0.5 + off) },
        EdgeSpec::Arc { to: at(1.0, 0.5), center: at(1.0, off), clockwise: false },
        EdgeSpec::Line { to: at(-1.0, 0.5) },
        EdgeSpec::Arc { to: at(-1.0 + off, -0.5), center: at(-1.0, 0.0), clockwise: false },
    ];
    let path = RailPath::from_edges(at(-1.0, -0.5), &edges).expect("a fine stadium");
    assert!(path.is_closed());
    for knot in path.knots() {
        let [before, after] = [-1e-12, 1e-12].map(|step| path.place_at(knot.arc_length + step).point());
        assert!((before - after).length() < 4e-12);
    }
}

#[test]
fn bad_rails_are_refused() {
    let through = |points: &[(f64, f64)], closed| {
        let points: Vec<DVec2> = points.iter().copied().map(DVec2::from).collect();
        RailPath::through(&points, closed).expect_err("no spline")
    };
    assert_eq!(through(&[], false), RailError::TooFewPoints { least: 2, got: 0 });
    assert_eq!(through(&[(0.0, 0.0)], false), RailError::TooFewPoints { least: 2, got: 1 });
    assert_eq!(
        through(&[(0.0, 0.0), (1.0, 0.0), (0.0, 0.0)], true),
        RailError::TooFewPoints { least: 3, got: 2 }
    );
    assert_eq!(through(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.0)], false), RailError::CoincidentPoints(2));
    assert_eq!(through(&[(0.0, 0.0), (1.0, f64::NAN)], false), RailError::NotFinite);
    // There and back again on a line: the spline turns round with no speed.
    assert!(matches!(through(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1e-12)], false), RailError::Cusp(_)));

    let edges = |specs: &[EdgeSpec]| RailPath::from_edges(DVec2::ZERO, specs).expect_err("no path");
    assert_eq!(edges(&[]), RailError::NoEdges);
    assert_eq!(edges(&[EdgeSpec::Line { to: at(f64::INFINITY, 0.0) }]), RailError::NotFinite);
    assert!(matches!(edges(&[EdgeSpec::Line { to: DVec2::ZERO }]), RailError::Line { edge: 0, .. }));
    let misfit = EdgeSpec::Arc { to: at(2.0, 0.0), center: at(1.3, 0.0), clockwise: true };
    assert!(matches!(edges(&[misfit]), RailError::Arc { edge: 0, .. }));
    // There and back again, with two more edges before, and as a closed path.
    let line = |x: f64, y: f64| EdgeSpec::Line { to: at(x, y) };
    let there = [line(0.0, 1.0), line(1.0, 1.0), line(3.0, 1.0)];
    assert_eq!(edges(&[&there[..], &[line(2.0, 1.0)]].concat()), RailError::TurnsBack(3));
    assert_eq!(edges(&[line(1.0, 0.0), line(0.0, 0.0)]), RailError::TurnsBack(0));
    assert!(RailPath::from_edges(DVec2::ZERO, &[&there[..], &[line(2.0, 1.001)]].concat()).is_ok());
}

#[test]
fn beyond_an_open_end_the_distance_is_that_from_the_nearest_continuation() {
    // The first path starts and ends at the same place, in different directions; the others pass their own
    // continuation.
    let drop = spline(&[(0.0, 0.0), (1.0, 2.0), (0.0, 3.0), (-1.0, 2.0), (0.0, 0.0)], false);
    let hook = spline(&[(0.0, 0.0), (0.0, 4.0), (2.0, 5.0), (1.0, 0.0)], false);
    let lines = [(0.0, 4.0), (1.0, 4.0), (1.0, -2.0)].map(|(x, y)| EdgeSpec::Line { to: at(x, y) });
    let edged = RailPath::from_edges(DVec2::ZERO, &lines).expect("a fine path");
    for path in [drop, hook, edged] {
        for (end, way) in [(path.place_at(0.0), -1.0), (path.place_at(path.length()), 1.0)] {
            for (along, aside) in [(0.0, 0.0), (0.1, 0.0), (2.0, 1e-3), (10.0, 0.0)] {
                let beyond = end.point() + way * along * end.tangent() + aside * end.normal();
                let distance = path.distance(beyond);
                assert!((distance - aside).abs() < 1e-12, "{distance} m at {along} m beyond an end");
            }
        }
    }
}
