//! Mechanisms that touch something at, or near, a point where their connectors leave the contact next to no lever.

use super::{impacts, within};
use halfgap::geometry::DVec2;
use halfgap::{Anchor, BodyId, BodyState, ConnectorKind, ConnectorSpec, World};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc};

const WORLD: BodyId = BodyId::WORLD;
const TOLERANCES: [f64; 4] = [1e-5, 1e-8, 1e-10, 1e-12];

/// A bar of 1 m that hangs by the middle of its upper end and swings, from an angle [rad] at 1 rad/s, against a wall
/// that is flush with its side.
fn door(tolerance: f64, angle: f64, elasticity: f64) -> (World, BodyId) {
    let mut shop = Workshop::weightless(tolerance);
    shop.fixed("wall", block(1.0, 6.0), DVec2::new(-0.55, -1.0));
    let arm = 0.5 * DVec2::new(angle.sin(), -angle.cos());
    let state = BodyState { position: arm, angle, velocity: -arm.perp(), angular_velocity: -1.0 };
    let bar = shop.settler("bar", block(0.1, 1.0), 1.0, state, elasticity);
    shop.pin(WORLD, bar, DVec2::ZERO);
    (shop.build(), bar)
}

#[test]
fn a_door_that_falls_flush_against_a_wall_comes_back_as_its_elasticity_says() {
    for tolerance in TOLERANCES {
        for elasticity in [1.0, 0.5] {
            let (mut world, bar) = door(tolerance, 0.5, elasticity);
            advance(&mut world, 1.0);
            // The bar reaches the wall after 0.5 s, but for the gap under its lower end.
            let what = format!("door at {tolerance:e}, e = {elasticity}");
            let state = world.state(bar);
            within(&format!("{what}: rate [rad/s]"), state.angular_velocity - elasticity, 1e-9);
            within(&format!("{what}: angle [rad]"), state.angle - 0.5 * elasticity, tolerance.max(1e-10));
        }
    }
}

#[test]
fn a_block_on_a_pin_straight_above_its_corner_settles_flush() {
    for tolerance in TOLERANCES {
        let mut shop = Workshop::new(tolerance);
        shop.fixed("floor", block(20.0, 2.0), DVec2::new(0.0, -1.0));
        let kicked = BodyState { velocity: DVec2::new(1.0, 0.0), ..at_rest(0.0, 0.5) };
        let body = shop.settler("block", block(1.0, 1.0), 1.0, kicked, 0.5);
        shop.pin(WORLD, body, DVec2::new(0.5, 1.0));
        let mut world = shop.build();
        let count = impacts(&mut world, 2.0);
        assert!(count > 3, "it bounces");
        let what = format!("block on a pin at {tolerance:e}");
        // Its corner lies at the target gap, 1 m from the pin.
        let angle = world.state(body).angle + world.tolerances().target_gap;
        within(&format!("{what}: angle [rad]"), angle, tolerance.max(1e-12));
        within(&format!("{what}: captures [J]"), world.ledger().captures, 10.0 * tolerance);
    }
}

#[test]
fn a_lid_falls_shut() {
    for tolerance in TOLERANCES {
        let mut shop = Workshop::new(tolerance);
        shop.fixed("floor", block(10.0, 2.0), DVec2::new(0.0, -1.0));
        let base = shop.settler("box", block(1.0, 0.5), 5.0, at_rest(0.0, 0.25), 0.5);
        let hinge = DVec2::new(-0.5, 0.55);
        let state =
            BodyState { position: hinge + DVec2::from_angle(1.0) * 0.5, angle: 1.0, ..BodyState::default() };
        let lid = shop.settler("lid", block(1.0, 0.1), 1.0, state, 0.5);
        let pin = ConnectorKind::Pin { a: shop.anchor(base, hinge), b: shop.anchor(lid, hinge) };
        let pin = halfgap::Connector::new(pin, 0.0).expect("a fine pin");
        shop.builder.add_connector(ConnectorSpec { collide: true, ..ConnectorSpec::new(pin) });
        let mut world = shop.build();
        advance(&mut world, 3.0);
        let open = world.state(lid).angle - world.state(base).angle;
        within(&format!("lid at {tolerance:e}: open by [rad]"), open, tolerance.max(1e-11));
        // All the energy left of the fall is lost, and the lid lies as high as the box.
        let left = world.energy().total() - GRAVITY * (5.0 * 0.25 + 0.55);
        within(&format!("lid at {tolerance:e}: energy left [J]"), left, 10.0 * tolerance.max(1e-10));
    }
}

/// A bob on a rod of 1 m, let go at an angle [rad], that passes the floor with a clearance [m].
fn bob_over_floor(clearance: f64, angle: f64, tolerance: f64) -> (World, f64) {
    let mut shop = Workshop::new(tolerance);
    shop.fixed("floor", block(10.0, 1.0), DVec2::new(0.0, -1.6 - clearance));
    let place = DVec2::from_angle(angle - std::f64::consts::FRAC_PI_2);
    let bob = shop.dull("bob", disc(0.1), 1.0, BodyState { position: place, ..BodyState::default() });
    let [a, b] = [(WORLD, DVec2::ZERO), (bob, place)].map(|(body, place)| shop.anchor(body, place));
    shop.connect(ConnectorKind::Rod { a, b, length: 1.0 }, 0.0);
    (shop.build(), GRAVITY * place.y)
}

#[test]
fn a_bob_that_just_clears_the_floor_swings_through() {
    // Within a step the bob is off its rod by more than its clearance.
    for clearance in [0.0, 1e-12] {
        for angle in (1..14).map(|tenths| 0.1 * f64::from(tenths)) {
            for tolerance in [1e-6, 1e-8, 1e-10] {
                let (mut world, _) = bob_over_floor(clearance, angle, tolerance);
                let what = format!("clearance {clearance}, {angle} rad, {tolerance:e}");
                assert_eq!(impacts(&mut world, 5.0), 0, "{what}");
            }
        }
        let (mut world, start) = bob_over_floor(clearance, 0.5, 1e-8);
        advance(&mut world, 5.0);
        let energy = world.energy().total() - start;
        within(&format!("bob that clears the floor by {clearance:e}: energy [J]"), energy, 1e-8);
    }
}

#[test]
fn a_rope_that_is_just_long_enough_holds_nothing() {
    for tolerance in TOLERANCES {
        let mut shop = Workshop::weightless(tolerance);
        let along = DVec2::from_angle(-0.5);
        let state = BodyState {
            position: 0.5 * along,
            angle: -0.5,
            velocity: 0.5 * along.perp(),
            angular_velocity: 1.0,
        };
        let arm = shop.body("arm", block(1.0, 0.1), 1.0, state);
        shop.pin(WORLD, arm, DVec2::ZERO);
        let a = Anchor { body: WORLD, point: DVec2::new(-1.0, 0.0) };
        let b = Anchor { body: arm, point: DVec2::new(0.5, 0.0) };
        shop.connect(ConnectorKind::Rope { a, b, length: 2.0 }, 0.0);
        let mut world = shop.build();
        advance(&mut world, 1.0);
        within(&format!("arm on a rope at {tolerance:e}: angle [rad]"), world.state(arm).angle - 0.5, 1e-8);
    }
}
