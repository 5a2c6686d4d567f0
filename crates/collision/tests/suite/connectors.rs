//! Connectors as a whole: the ones that are refused, their errors, their alignment, their records.

use glam::DVec2;
use halfgap_collision::{
    Anchor, BodyId, Collision, Connector, ConnectorError, ConnectorId, ConnectorKind, Detector, Moving,
    RailPath, SlotFrame, Tolerances, Zone, merge_collisions,
};
use halfgap_geometry::{EdgeSpec, Pose};
use std::sync::Arc;

const TOLERANCES: Tolerances = Tolerances { target_gap: 0.5e-3, accuracy: 0.3e-3, velocity_tol: 0.01 };

fn anchor(body: u32, x: f64, y: f64) -> Anchor {
    Anchor { body: BodyId(body), point: DVec2::new(x, y) }
}

fn still(x: f64, y: f64, angle: f64) -> Moving {
    Moving { pose: Pose::new(DVec2::new(x, y), angle), angle, ..Moving::BACKGROUND }
}

fn fine(kind: ConnectorKind) -> Connector {
    Connector::new(kind, 0.25).expect("a fine connector")
}

/// A half circle of radius 2 m over the origin, from right to left.
fn arch() -> Arc<RailPath> {
    let edges = [EdgeSpec::Arc { to: DVec2::new(-2.0, 0.0), center: DVec2::ZERO, clockwise: false }];
    Arc::new(RailPath::from_edges(DVec2::new(2.0, 0.0), &edges).expect("a fine arch"))
}

fn two_body_kinds() -> Vec<ConnectorKind> {
    let (a, b) = (anchor(0, 0.3, -0.2), anchor(1, -0.4, 0.1));
    let normal = DVec2::new(0.6, 0.8);
    vec![
        ConnectorKind::Pin { a, b },
        ConnectorKind::Slot { a, b, normal, frame: SlotFrame::A },
        ConnectorKind::Slot { a, b, normal, frame: SlotFrame::B },
        ConnectorKind::Slot { a, b, normal, frame: SlotFrame::World },
        ConnectorKind::Rod { a, b, length: 1.5 },
        ConnectorKind::Rope { a, b, length: 0.7 },
    ]
}

fn rail_kinds() -> Vec<ConnectorKind> {
    let a = anchor(0, 0.3, -0.2);
    vec![
        ConnectorKind::Rail { a, path: arch() },
        ConnectorKind::RailStop { a, path: arch(), at: 5.0, upper: false },
        ConnectorKind::RailStop { a, path: arch(), at: 0.5, upper: true },
    ]
}

#[test]
fn a_slot_of_the_world_acts_on_a_body_at_the_point_of_the_body() {
    // The slot may begin far away: it is the same everywhere along it.
    let (far, own) = (Anchor { body: BodyId::WORLD, point: DVec2::new(9.0, -3.0) }, anchor(0, 0.3, -0.2));
    let (body, normal) = (still(1.0, 2.0, 0.4), DVec2::new(0.6, 0.8));
    let place = body.pose.point_to_world(own.point);
    for frame in [SlotFrame::World, SlotFrame::A, SlotFrame::B] {
        let kinds = [
            (ConnectorKind::Slot { a: far, b: own, normal, frame }, Moving::BACKGROUND, body),
            (ConnectorKind::Slot { a: own, b: far, normal, frame }, body, Moving::BACKGROUND),
        ];
        for (side, (kind, a, b)) in kinds.into_iter().enumerate() {
            let carried = [SlotFrame::B, SlotFrame::A][side];
            if frame == carried {
                continue;
            }
            let sample = fine(kind).measure(0, &a, &b);
            for point in [sample.point_a, sample.point_b] {
                let off = (point - place).perp_dot(normal);
                assert!(off.abs() < 1e-14, "{frame:?}, body {side}: {off} m along the slot");
            }
        }
    }
}

#[test]
fn aligned_connectors_are_satisfied() {
    let (a, b) = (still(0.2, 1.1, 0.4), still(-1.0, 0.3, -2.0));
    let moved = |body: &Moving, shift: DVec2| Moving {
        pose: Pose { position: body.pose.position + shift, ..body.pose },
        ..*body
    };
    for kind in two_body_kinds() {
        let connector = fine(kind);
        assert!(connector.error(&a, &b, None) > 0.1, "{connector:?}");
        for can_move in [[true, true], [false, true], [true, false]] {
            let found = connector.align(&a.pose, &b.pose, can_move).expect("one may move");
            assert_eq!(found.moves_b, can_move[1]);
            let (a, b) =
                if found.moves_b { (a, moved(&b, found.shift)) } else { (moved(&a, found.shift), b) };
            assert!(
                connector.error(&a, &b, None) < 1e-15,
                "{connector:?}: {}",
                connector.error(&a, &b, None)
            );
        }
        assert_eq!(connector.align(&a.pose, &b.pose, [false, false]), None);
    }
    for kind in rail_kinds() {
        let connector = fine(kind);
        assert!(connector.error(&a, &Moving::BACKGROUND, None) > 0.1, "{connector:?}");
        let found = connector.align(&a.pose, &Pose::IDENTITY, [true, true]).expect("a may move");
        assert!(!found.moves_b);
        let error = connector.error(&moved(&a, found.shift), &Moving::BACKGROUND, None);
        assert!(error < 1e-15 * 4.0, "{connector:?}: {error}");
        assert_eq!(connector.align(&a.pose, &Pose::IDENTITY, [false, true]), None);
    }
}

#[test]
fn a_satisfied_connector_moves_no_body() {
    let (a, b) = (anchor(0, 0.0, 0.0), anchor(1, 0.0, 0.0));
    let rope = fine(ConnectorKind::Rope { a, b, length: 2.0 });
    let near = [still(0.5, 0.0, 0.0), still(0.0, 1.0, 0.0)];
    let found = rope.align(&near[0].pose, &near[1].pose, [true, true]).expect("both may move");
    assert_eq!((found.shift, rope.error(&near[0], &near[1], None)), (DVec2::ZERO, 0.0));
    let stop = fine(ConnectorKind::RailStop { a, path: arch(), at: 1.0, upper: false });
    let top = still(0.0, 2.0, 0.0);
    let found = stop.align(&top.pose, &Pose::IDENTITY, [true, true]).expect("a may move");
    assert_eq!((found.shift, stop.error(&top, &Moving::BACKGROUND, None)), (DVec2::ZERO, 0.0));
}

#[test]
fn a_stop_counts_what_is_left_of_the_rail() {
    let (a, quarter) = (anchor(0, 0.0, 0.0), std::f64::consts::PI);
    let top = still(0.0, 2.0, 0.0);
    let gap = |path: &Arc<RailPath>, at, upper, body: &Moving| {
        let stop = fine(ConnectorKind::RailStop { a, path: path.clone(), at, upper });
        stop.measure(0, body, &Moving::BACKGROUND).gap
    };
    assert!((gap(&arch(), 1.0, false, &top) - (quarter - 1.0)).abs() < 1e-15);
    assert!((gap(&arch(), 4.0, true, &top) - (4.0 - quarter)).abs() < 1e-15);
    assert!((gap(&arch(), 3.0, true, &top) - (3.0 - quarter)).abs() < 1e-15);
    // Beyond the end the rail goes on straight down.
    assert!((gap(&arch(), 0.0, false, &still(2.0, -0.3, 0.0)) + 0.3).abs() < 1e-15);
    // On a closed rail a point that lies beyond the stop by next to nothing is at the stop; any other point has come
    // round, unless it is known that it was nearer.
    let start = DVec2::new(2.0, 0.0);
    let circle = [EdgeSpec::Arc { to: start, center: DVec2::ZERO, clockwise: false }];
    let circle = Arc::new(RailPath::from_edges(start, &circle).expect("a fine circle"));
    let at_angle = |angle: f64| still(2.0 * angle.cos(), 2.0 * angle.sin(), 0.0);
    let lap = 4.0 * quarter;
    assert!((gap(&circle, 0.0, false, &at_angle(-1e-10)) + 2e-10).abs() < 1e-14);
    assert!((gap(&circle, 0.0, false, &at_angle(-0.001)) - (lap - 0.002)).abs() < 1e-14);
    assert!((gap(&circle, 0.0, false, &at_angle(-0.1)) - (lap - 0.2)).abs() < 1e-14);
    assert!((gap(&circle, lap, true, &at_angle(1e-10)) + 2e-10).abs() < 1e-14);
    assert!((gap(&circle, 6.0, true, &at_angle(1.0)) - 4.0).abs() < 1e-14);
    let stop = fine(ConnectorKind::RailStop { a, path: circle.clone(), at: lap, upper: true });
    for (left, expected) in
        [(0.0, -0.002), (0.5 * lap - 0.1, -0.002), (lap, lap - 0.002), (2.0 * lap, 2.0 * lap - 0.002)]
    {
        let body = at_angle(0.001);
        let hint = circle.hint_near(body.pose.position, None).with_before_stop(Some(left));
        let gap = stop.measure_near(0, &body, &Moving::BACKGROUND, Some(&hint)).gap;
        assert!((gap - expected).abs() < 1e-14, "{left}: {gap}");
    }
}

#[test]
fn a_stop_at_the_end_of_its_rail_is_there_however_that_is_rounded() {
    let edges = [EdgeSpec::Line { to: DVec2::new(0.1, 0.0) }, EdgeSpec::Line { to: DVec2::new(0.1, 0.2) }];
    let path = Arc::new(RailPath::from_edges(DVec2::ZERO, &edges).expect("a fine path"));
    let stop =
        |at: f64| ConnectorKind::RailStop { a: anchor(0, 0.0, 0.0), path: path.clone(), at, upper: true };
    for at in [path.length(), path.length().next_up(), path.length().next_down()] {
        assert!(Connector::new(stop(at), 0.0).is_ok(), "{at}");
    }
    assert!(Connector::new(stop(0.3 + 1e-9), 0.0).is_err());
}

#[test]
fn where_a_rail_crosses_itself_a_stop_goes_by_where_its_point_was_seen() {
    let edges = [
        EdgeSpec::Line { to: DVec2::new(1.0, 0.0) },
        EdgeSpec::Arc { to: DVec2::new(0.0, 1.0), center: DVec2::ONE, clockwise: false },
        EdgeSpec::Line { to: DVec2::new(0.0, -3.0) },
    ];
    let path = RailPath::from_edges(DVec2::new(-3.0, 0.0), &edges).expect("a fine path");
    let seen = [DVec2::new(-0.1, 0.0), DVec2::new(0.0, 0.1)].map(|point| path.hint_near(point, None));
    let beyond = 1.5 * std::f64::consts::PI;
    let (a, path, crossing) = (anchor(0, 0.0, 0.0), Arc::new(path), still(0.0, 0.0, 0.0));
    for (upper, errors) in [(true, [0.0, beyond]), (false, [2.0, 0.0])] {
        let stop = fine(ConnectorKind::RailStop { a, path: path.clone(), at: 5.0, upper });
        let found = seen.map(|hint| stop.error(&crossing, &Moving::BACKGROUND, Some(&hint)));
        assert!(found.iter().zip(errors).all(|(found, error)| (found - error).abs() < 1e-14), "{found:?}");
    }
}

#[test]
fn a_point_that_a_rail_has_seen_may_be_on_a_continuation_that_passes_the_path() {
    let edges = [(0.0, 4.0), (1.0, 4.0), (1.0, -2.0)].map(|(x, y)| EdgeSpec::Line { to: DVec2::new(x, y) });
    let path = RailPath::from_edges(DVec2::ZERO, &edges).expect("a fine path");
    let (hint, a) = (path.hint_near(DVec2::ZERO, None), anchor(0, 0.0, 0.0));
    let rail = fine(ConnectorKind::Rail { a, path: Arc::new(path) });
    let beyond = still(0.0, -1.5, 0.0);
    assert_eq!(rail.error(&beyond, &Moving::BACKGROUND, Some(&hint)), 0.0);
    assert_eq!(rail.error(&beyond, &Moving::BACKGROUND, None), 1.0);
}

#[test]
fn bad_connectors_are_refused() {
    let (a, b) = (anchor(0, 0.0, 0.0), anchor(1, 0.0, 0.0));
    let refused = |kind| Connector::new(kind, 0.5).expect_err("no connector");
    assert_eq!(refused(ConnectorKind::Pin { a, b: a }), ConnectorError::SameBody);
    let nowhere = anchor(1, f64::NAN, 0.0);
    assert_eq!(refused(ConnectorKind::Pin { a, b: nowhere }), ConnectorError::NotFinite);
    assert_eq!(refused(ConnectorKind::Rod { a, b, length: 0.0 }), ConnectorError::BadLength(0.0));
    assert_eq!(refused(ConnectorKind::Rope { a, b, length: -1.0 }), ConnectorError::BadLength(-1.0));
    let slot = |normal| ConnectorKind::Slot { a, b, normal, frame: SlotFrame::World };
    assert_eq!(refused(slot(DVec2::ZERO)), ConnectorError::BadNormal(0.0, 0.0));
    assert_eq!(refused(slot(DVec2::new(0.0, f64::INFINITY))), ConnectorError::BadNormal(0.0, f64::INFINITY));
    let stop = ConnectorKind::RailStop { a, path: arch(), at: 7.0, upper: true };
    assert!(matches!(refused(stop), ConnectorError::BadStop { at: 7.0, .. }));
    let world = Anchor { body: BodyId::WORLD, point: DVec2::ZERO };
    assert_eq!(refused(ConnectorKind::Rail { a: world, path: arch() }), ConnectorError::SameBody);
    let pin = ConnectorKind::Pin { a, b };
    assert_eq!(Connector::new(pin.clone(), 1.5), Err(ConnectorError::BadElasticity(1.5)));
    assert!(Connector::new(pin, f64::NAN).is_err());
    // A direction of any length becomes a unit vector.
    for size in [1e-200, 1.0, 1e200] {
        let connector = fine(slot(DVec2::new(3.0, 4.0) * size));
        let ConnectorKind::Slot { normal, .. } = connector.kind else { panic!("it is a slot") };
        assert!((normal - DVec2::new(0.6, 0.8)).length() < 1e-15);
    }
}

#[test]
fn a_connector_has_a_record_for_every_row() {
    let a = Moving { velocity: DVec2::new(1.0, 2.0), angular_velocity: 3.0, ..still(0.2, 1.1, 0.4) };
    let b = Moving { velocity: DVec2::new(-1.0, 0.5), angular_velocity: -2.0, ..still(-1.0, 0.3, -2.0) };
    let id = ConnectorId(7);
    for kind in two_body_kinds().into_iter().chain(rail_kinds()) {
        let connector = fine(kind);
        let b = if connector.path().is_some() { Moving::BACKGROUND } else { b };
        let mut records = Vec::new();
        for row in 0..connector.row_count() {
            let sample = connector.measure(row, &a, &b);
            let index = row as u32;
            let record = Collision::of_connector(id, index, &connector, &sample, [&a, &b], &TOLERANCES, 2.0);
            assert_eq!(record.parties.detector, Detector::Connector { id, row: index });
            assert_eq!(record.bodies(), connector.bodies());
            assert_eq!(record.parties.primary.feature(), None);
            assert_eq!(record.parties.bilateral, connector.is_bilateral());
            assert_eq!((record.response.elasticity, record.updated), (0.25, 2.0));
            assert_eq!(record.tolerances, Tolerances { target_gap: 0.0, ..TOLERANCES });
            assert_eq!((record.geometry.distance, record.distance_to_target()), (sample.gap, sample.gap));
            assert_eq!(record.motion.normal_velocity, sample.kinematics.rate);
            assert_eq!(record.gap_state().is_contact(0.0..=0.0), connector.is_bilateral());
            // All of these are far beyond their limit.
            assert_eq!(record.gap_state().is_illegal(0.0), !connector.is_bilateral());
            let radius = record.geometry.radius_normal;
            match connector.kind {
                ConnectorKind::Rod { length, .. } => assert_eq!(radius, Some(length)),
                ConnectorKind::Rope { length, .. } => assert_eq!(radius, Some(-length)),
                // Seen from its left, an arch that turns left is hollow.
                ConnectorKind::Rail { .. } => assert_eq!(radius, Some(-2.0)),
                _ => {}
            }
            records.push(record);
        }
        // Neither two rows of one connector nor rows of two connectors are ever one collision.
        records.extend(records.clone());
        merge_collisions(&mut records);
        assert_eq!(records.len(), 2 * connector.row_count());
    }
}

#[test]
fn a_record_of_a_connector_can_be_updated() {
    let (a, b) = (anchor(0, 0.0, 0.0), anchor(1, 0.0, 0.0));
    let rope = fine(ConnectorKind::Rope { a, b, length: 2.0 });
    let other = still(0.0, 0.0, 0.0);
    let fall = |y: f64| Moving { velocity: DVec2::new(0.0, -1.0), ..still(0.0, y, 0.0) };
    let measured = |y: f64| rope.measure(0, &fall(y), &other);
    let late = fall(-2.1);
    let sample = measured(-2.1);
    let mut record =
        Collision::of_connector(ConnectorId(0), 0, &rope, &sample, [&late, &other], &TOLERANCES, 1.0);
    assert!(record.gap_state().is_illegal(0.0) && record.must_handle);
    let early = fall(-1.9);
    record.update_connector(&rope, &measured(-1.9), [&early, &other], 0.8);
    assert!(!record.gap_state().is_illegal(0.0) && record.must_handle && record.updated == 0.8);
    assert_eq!((record.detection().time, record.detection().distance), (1.0, sample.gap));
    // Within the accuracy of its length a rope is taut, not overstretched.
    for (y, zone) in [(-1.99, Zone::OutOfRange), (-1.9999, Zone::Target), (-2.0001, Zone::Target)] {
        record.update_connector(&rope, &measured(y), [&fall(y), &other], 0.9);
        assert_eq!(record.gap_state().zone(), zone);
        assert_eq!(record.gap_state().is_touching(), zone == Zone::Target);
    }
    record.update_connector(&rope, &measured(-2.001), [&fall(-2.001), &other], 0.9);
    assert_eq!(record.gap_state().zone(), Zone::Penetrating);
}
