//! A cam with a roller on it: the contact goes round base, flanks and nose. Half a turn later the line of every flank,
//! continued without end, passes the roller from behind.

use super::within;
use halfgap::geometry::{DVec2, EdgeSpec, PathSpec, Shape};
use halfgap::{Anchor, BodyId, BodySpec, BodyState, ConnectorKind, Inertia, SlotFrame, World};
use halfgap_tests::mechanism::{Workshop, advance, at_rest, disc};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const BASE: f64 = 0.5;
const NOSE: f64 = 0.2;
/// Distance of the two centres [m].
const REACH: f64 = 0.6;
const ROLLER: f64 = 0.15;

/// Angle between the nose and the normal of a flank [rad].
fn flank() -> f64 {
    ((BASE - NOSE) / REACH).acos()
}

/// A base circle about the origin, a nose circle along +x, and the two tangents.
fn outline() -> Shape {
    let (nose, up, down) = (DVec2::new(REACH, 0.0), DVec2::from_angle(flank()), DVec2::from_angle(-flank()));
    let edges = vec![
        EdgeSpec::Arc { to: BASE * down, center: DVec2::ZERO, clockwise: false },
        EdgeSpec::Line { to: nose + NOSE * down },
        EdgeSpec::Arc { to: nose + NOSE * up, center: nose, clockwise: false },
        EdgeSpec::Line { to: BASE * up },
    ];
    Shape::from_paths(&[PathSpec { start: BASE * up, edges }]).expect("a fine cam")
}

/// Height [m] of the roller over the cam's axle, for a direction of the nose [rad].
fn lift(cam: f64) -> f64 {
    let seen = ((FRAC_PI_2 - cam + PI).rem_euclid(TAU) - PI).abs();
    let flank_end = flank() - (REACH * flank().sin() / (BASE + ROLLER)).atan();
    if seen >= flank() {
        BASE + ROLLER
    } else if seen >= flank_end {
        (BASE + ROLLER) / (flank() - seen).cos()
    } else {
        REACH * seen.cos() + ((NOSE + ROLLER).powi(2) - (REACH * seen.sin()).powi(2)).sqrt()
    }
}

/// The cam, turning on its axle with the nose down at the start, and the roller, which goes up and down above it.
fn cam_and_roller(tolerance: f64) -> (World, [BodyId; 2]) {
    let mut shop = Workshop::new(tolerance);
    let turning = BodyState { angle: -FRAC_PI_2, angular_velocity: 2.0, ..BodyState::default() };
    let mut spec = BodySpec { elasticity: 0.0, ..BodySpec::movable("cam", outline(), 5.0, turning) };
    spec.center_of_mass = Some(DVec2::ZERO);
    spec.inertia = Some(Inertia { mass: 5.0, moment: 1.0 });
    let cam = shop.builder.add(spec);
    shop.pin(cam, BodyId::WORLD, DVec2::ZERO);
    let roller = shop.dull("roller", disc(ROLLER), 0.2, at_rest(0.0, BASE + ROLLER));
    let ends = [roller, BodyId::WORLD].map(|body| Anchor { body, point: DVec2::ZERO });
    let guide = ConnectorKind::Slot { a: ends[0], b: ends[1], normal: DVec2::X, frame: SlotFrame::World };
    shop.connect(guide, 0.0);
    (shop.build(), [cam, roller])
}

#[test]
fn a_roller_follows_its_cam_turn_after_turn() {
    for tolerance in [1e-4, 1e-8, 1e-12] {
        let (mut world, [cam, roller]) = cam_and_roller(tolerance);
        let energy = world.energy().total();
        let (mut off, mut lost) = (0.0f64, 0.0f64);
        for piece in 1..=120 {
            advance(&mut world, 0.1 * f64::from(piece));
            off = off.max((world.state(roller).position.y - lift(world.state(cam).angle)).abs());
            lost = lost.max((world.energy().total() - energy).abs());
        }
        assert!(world.state(cam).angle > 3.0 * TAU, "{:?}", world.state(cam));
        let rounding = 1e-11;
        within(&format!("roller on a cam, at {tolerance:e}: off its lift [m]"), off, tolerance + rounding);
        within(&format!("roller on a cam, at {tolerance:e}: energy [J]"), lost, tolerance + rounding);
    }
}
