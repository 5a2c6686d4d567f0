//! Collision records: detection, merging, zones, first detection, updates, tight fits.

use glam::DVec2;
use halfgap_collision::{
    Body, BodyId, BodyState, Collision, Detector, EstimatePoint, Flight, Moment, Motion, Moving, Tolerances,
    Zone, detect_pair, estimate_target_time,
};
use halfgap_geometry::{GapSample, Shape};

const TOLERANCES: Tolerances = Tolerances { target_gap: 1e-3, accuracy: 6e-4, velocity_tol: 0.01 };

fn solid(shape: Shape) -> Body {
    Body { shape, inverse_mass: 1.0, inverse_moment: 1.0, elasticity: 0.5 }
}

fn block(width: f64, height: f64) -> Body {
    solid(Shape::block(width, height).expect("fine sides"))
}

fn disc(radius: f64) -> Body {
    solid(Shape::disc(radius).expect("a fine radius"))
}

fn at(x: f64, y: f64, angle: f64, velocity: DVec2) -> Moving {
    Moving::from(&BodyState { position: DVec2::new(x, y), angle, velocity, angular_velocity: 0.0 })
}

fn still(x: f64, y: f64) -> Moving {
    at(x, y, 0.0, DVec2::ZERO)
}

fn detect_to(depth: f64, a: (&Body, Moving), b: (&Body, Moving)) -> Vec<Collision> {
    let a = Moment { id: BodyId(3), body: a.0, moving: a.1 };
    let b = Moment { id: BodyId(8), body: b.0, moving: b.1 };
    let mut found = Vec::new();
    detect_pair(&a, &b, &TOLERANCES, depth, 1.0, &mut found);
    found
}

fn detect(a: (&Body, Moving), b: (&Body, Moving)) -> Vec<Collision> {
    detect_to(TOLERANCES.distance_tol(), a, b)
}

/// A disc of radius 1/2 at rest over the top of a block, `gap` away and moving up at `rate`.
fn over(gap: f64, rate: f64) -> Option<Collision> {
    let disc_at = at(0.1, 1.0 + gap, 0.0, DVec2::new(0.2, rate));
    detect_to(0.1, (&disc(0.5), disc_at), (&block(4.0, 1.0), still(0.0, 0.0))).first().copied()
}

#[test]
fn predicates_change_at_the_borders_of_the_zones() {
    let zone = |gap: f64| over(gap, 0.0).map(|record| record.gap_state().zone());
    assert_eq!(zone(2.001e-3), None);
    assert_eq!(zone(1.999e-3), Some(Zone::BeyondTarget));
    assert_eq!(zone(1.599e-3), Some(Zone::Target));
    assert_eq!(zone(0.401e-3), Some(Zone::Target));
    assert_eq!(zone(0.399e-3), Some(Zone::Near));
    assert_eq!(zone(-1e-6), Some(Zone::Penetrating));

    let record = |gap: f64, rate: f64| over(gap, rate).expect("in range");
    const REST: f64 = 1e-3;
    // (gap, rate): contact, close enough, colliding, illegal.
    let says = |gap: f64, rate: f64| {
        let found = record(gap, rate);
        let state = found.gap_state();
        assert!(state.is_touching());
        [
            found.is_contact(-REST..=REST),
            found.is_close_enough(0.0, REST),
            state.is_colliding(REST),
            state.is_illegal(0.0),
        ]
    };
    assert_eq!(says(1.8e-3, -0.02), [false, false, true, false]);
    assert_eq!(says(1.8e-3, -0.5e-3), [true, false, false, false]);
    assert_eq!(says(1.5e-3, -0.02), [false, true, true, false]);
    assert_eq!(says(1.5e-3, 0.5e-3), [true, false, false, false]);
    assert_eq!(says(0.2e-3, -0.02), [false, true, true, false]);
    assert_eq!(says(0.2e-3, 0.02), [false, true, false, false]);
    assert_eq!(says(0.2e-3, 0.5e-3), [true, true, false, false]);
    assert_eq!(says(-0.2e-3, 0.02), [false, true, false, true]);
    // What must be handled is close enough, wherever it is.
    let must_handle = |mut found: Collision| {
        found.must_handle = true;
        found
    };
    assert!(must_handle(record(1.8e-3, 0.02)).is_close_enough(0.0, REST));
    let mut away = record(1.8e-3, 0.0);
    away.geometry.distance = 0.05;
    assert!(must_handle(away).is_contact(-REST..=REST) && !away.is_contact(-REST..=REST));
}

#[test]
fn an_update_after_the_back_up_moves_points_and_arms_and_serves_an_estimate() {
    let (disc, block) = (disc(0.5), block(4.0, 1.0));
    let fall =
        BodyState { position: DVec2::new(0.1, 1.1), velocity: DVec2::new(0.3, -1.0), ..BodyState::default() };
    let (flight, rest) =
        (Flight::new(fall, DVec2::new(0.0, -10.0), 0.0, 0.0), Flight::fixed(DVec2::ZERO, 0.0));
    // 0.1 m of fall: overlapping at 0.09 s.
    let late = 0.09;
    let mut record = detect_to(0.1, (&disc, flight.moving_at(late)), (&block, rest.moving_at(late)))[0];
    record.updated = late;
    assert!(record.gap_state().is_illegal(0.0) && record.must_handle);
    assert_eq!(record.detection().distance, record.geometry.distance);
    let before = record;

    let early = 0.05;
    let moments = [flight.moving_at(early), rest.moving_at(early)];
    let features =
        [record.parties.primary, record.parties.normal].map(|side| side.feature().expect("shapes touch"));
    let (round, line) = (disc.shape.feature(features[0]), block.shape.feature(features[1]));
    let sample = GapSample::measure(round, &moments[0].pose, line, &moments[1].pose).expect("disc over line");
    record.update((&sample, [round.radius(), line.radius()]), [&moments[0], &moments[1]], early);
    assert!(record.must_handle, "it happened, even though the bodies are apart again");
    assert!(!record.gap_state().is_illegal(0.0) && record.updated == early);
    assert_eq!(record.detection(), before.detection());
    let moved = record.geometry.point_primary - before.geometry.point_primary;
    assert!((moved - (moments[0].pose.position - flight.moving_at(late).pose.position)).length() < 1e-15);
    assert!((record.geometry.impact_arm_primary - DVec2::new(0.0, -0.5)).length() < 1e-15);
    assert!((record.geometry.arms.normal.x - (0.1 + 0.3 * early)).abs() < 1e-15);
    // The estimate assumes free fall: y = 1.1 - t - 5 t^2 meets 1 + target.
    let exact = (-1.0 + (1.0f64 + 20.0 * (0.1 - TOLERANCES.target_gap)).sqrt()) / 10.0;
    let state = |record: &Collision, time: f64| EstimatePoint {
        time,
        distance: record.geometry.distance,
        normal_velocity: record.motion.normal_velocity,
    };
    let estimate = estimate_target_time(state(&record, early), state(&before, late), TOLERANCES.target_gap);
    assert!((estimate.expect("it closes in between") - exact).abs() < 1e-12);
}

#[test]
fn a_disc_at_a_corner_of_a_block_is_recorded_once() {
    let gap = 1e-3;
    for direction in [0.0f64, 0.4, 0.785, 1.2, 1.57] {
        let normal = DVec2::from_angle(direction);
        let place = DVec2::new(1.0, 0.5) + normal * (0.5 + gap);
        let found = detect((&disc(0.5), still(place.x, place.y)), (&block(2.0, 1.0), still(0.0, 0.0)));
        assert_eq!(found.len(), 1, "in the direction {direction}: {found:?}");
        assert!((found[0].geometry.distance - gap).abs() < 1e-6);
    }
}

#[test]
fn a_disc_at_a_seam_of_line_and_arc_is_recorded_once() {
    // Right over the place where the straight side of a capsule goes on as its round end.
    let capsule = solid(Shape::capsule(2.0, 0.5).expect("a fine capsule"));
    let seam = [0.25, 0.5, 0.75, 1.0].into_iter();
    let ends: Vec<f64> = capsule.shape.edges().map(|edge| edge.from().x.abs()).collect();
    assert!(ends.iter().all(|x| (x - ends[0]).abs() < 1e-15), "all four seams are as far out");
    for shift in [-1e-9, 0.0, 1e-9].into_iter().chain(seam.map(|part| part * 1e-4)) {
        let disc_at = still(ends[0] + shift, 1.0 + 1e-3);
        let found = detect((&disc(0.5), disc_at), (&capsule, still(0.0, 0.0)));
        assert_eq!(found.len(), 1, "shifted by {shift}: {found:?}");
        assert_eq!(found[0].parties.detector, Detector::EdgeEdge);
    }
}

#[test]
fn a_block_flat_on_an_equal_block_touches_at_two_corners() {
    let found = detect((&block(1.0, 1.0), still(0.0, 1.001)), (&block(1.0, 1.0), still(0.0, 0.0)));
    assert_eq!(found.len(), 2, "{found:?}");
    for record in &found {
        // The contact of a vertex with an edge is more exact than that of two corners.
        assert_eq!(record.parties.detector, Detector::VertexEdge);
        assert!((record.geometry.normal.y.abs() - 1.0).abs() < 1e-15);
        assert!((record.geometry.point_primary.x.abs() - 0.5).abs() < 1e-15);
    }
    assert!(found[0].geometry.point_primary.x * found[1].geometry.point_primary.x < 0.0);
}

#[test]
fn corners_that_pass_each_other_by_less_than_the_accuracy_touch_once() {
    // The lower left corner of one block is beyond the upper right one of the other: each of them is near an edge of
    // the other block, too, but beyond its end.
    let apart = 0.1 * TOLERANCES.accuracy;
    for angle in [-1e-3, 0.0, 1e-3] {
        let corner = DVec2::from_angle(angle).rotate(DVec2::new(-0.5, -0.5));
        let place = DVec2::new(1.0 + apart, 0.5 + TOLERANCES.target_gap) - corner;
        let found = detect(
            (&block(2.0, 1.0), still(0.0, 0.0)),
            (&block(1.0, 1.0), at(place.x, place.y, angle, DVec2::ZERO)),
        );
        assert_eq!(found.len(), 1, "{angle} rad: {found:?}");
        assert_eq!(found[0].parties.detector, Detector::CornerCorner);
    }
}

#[test]
fn corners_that_meet_at_a_distance_of_rounding_touch_as_their_sides_do() {
    // Side by side, corner at corner, and so near that the direction between the corners is off by some 1e-4 rad.
    let apart = 1e-12;
    for turn in [0.0f64, 0.3, 1.0, -2.4] {
        let offset = DVec2::from_angle(turn).rotate(DVec2::new(1.0 + apart, 1.0));
        let squares =
            [DVec2::ZERO, offset].map(|offset| at(3.0 + offset.x, 2.0 + offset.y, turn, DVec2::ZERO));
        let found = detect((&block(1.0, 1.0), squares[0]), (&block(1.0, 1.0), squares[1]));
        let is_of_corners = |record: &Collision| record.parties.detector == Detector::CornerCorner;
        assert!(!found.is_empty() && !found.iter().any(is_of_corners), "{turn}: {found:?}");
    }
}

#[test]
fn a_corner_leans_off_a_short_side_as_far_as_that_side_shows() {
    // A small block lies over the corner of a large one, and its end sinks: along its own side by less than the
    // accuracy, though along the side of the large block it would be by more.
    let (large, small) = (block(2.0, 2.0), block(0.1, 0.1));
    let found = |angle: f64| {
        detect((&large, still(0.0, 0.0)), (&small, at(1.0, 1.05 + TOLERANCES.target_gap, angle, DVec2::ZERO)))
    };
    for [few, many] in [[2e-3, 8e-3], [5e-3, 7e-3]] {
        let corner = |record: &Collision| record.parties.primary.body == BodyId(3);
        assert!(found(few).iter().any(corner), "{few}: {:?}", found(few));
        assert!(!found(many).iter().any(corner), "{many}: {:?}", found(many));
    }
}

#[test]
fn a_tight_fit_has_its_own_thresholds() {
    // A pin in a bore with a clearance of two target gaps: its target is a quarter of the clearance.
    let clearance = 2.0 * TOLERANCES.target_gap;
    let ring = solid(Shape::ring(2.0, 1.0 + clearance).expect("a fine ring"));
    let found = detect((&disc(1.0), still(0.55 * clearance, 0.0)), (&ring, still(0.0, 0.0)));
    assert_eq!(found.len(), 1);
    let tight = found[0].tolerances;
    assert!((tight.target_gap - clearance / 4.0).abs() < 1e-15);
    assert!((tight.accuracy / tight.target_gap - TOLERANCES.accuracy / TOLERANCES.target_gap).abs() < 1e-12);
    assert_eq!(tight.velocity_tol, TOLERANCES.velocity_tol);
    assert_eq!(found[0].gap_state().zone(), Zone::BeyondTarget);
    assert_eq!(TOLERANCES.for_clearance(4.0 * TOLERANCES.target_gap), TOLERANCES);
}

#[test]
fn records_name_their_parties() {
    let record = over(1e-3, 0.0).expect("in range");
    let site = record.parties.normal.site.expect("a shape touches");
    assert!(
        record.involves_body(BodyId(3))
            && record.involves_body(BodyId(8))
            && !record.involves_body(BodyId(0))
    );
    assert_eq!(record.parties.normal.feature(), Some(site.feature));
    assert_eq!(record.response.elasticity, 0.5);
    assert!((record.distance_to_target()).abs() < 1e-15);
    assert!((record.motion.lateral_velocity.abs() - 0.2).abs() < 1e-15);
}
