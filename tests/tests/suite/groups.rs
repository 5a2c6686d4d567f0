//! Bodies that do not touch do not share a step; reads in between change nothing.

use halfgap::force::Spring;
use halfgap::geometry::DVec2;
use halfgap::{Anchor, BodyId, BodyState, ConnectorKind, World, WorldBuilder, WorldSettings};
use halfgap_tests::mechanism::{Workshop, advance, at_rest, block, disc, thrown};
use std::sync::Arc;

const WORLD: BodyId = BodyId::WORLD;

fn at(body: BodyId, x: f64, y: f64) -> Anchor {
    Anchor { body, point: DVec2::new(x, y) }
}

fn bits(state: &BodyState) -> [u64; 6] {
    let (x, v) = (state.position, state.velocity);
    [x.x, x.y, state.angle, v.x, v.y, state.angular_velocity].map(f64::to_bits)
}

/// A pendulum about the origin and, on request, bodies that move ten times as fast far away.
fn pendulum(with_neighbour: bool) -> (World, BodyId) {
    let mut shop = Workshop::new(1e-9);
    // A post as far away as all the other bodies: the scene has the same size with and without them.
    shop.fixed("post", block(1.0, 1.0), DVec2::new(20.0, 0.0));
    let bob = shop.body("bob", disc(0.25), 1.0, at_rest(1.0, 0.0));
    shop.connect(ConnectorKind::Rod { a: at(WORLD, 0.0, 0.0), b: at(bob, 0.0, 0.0), length: 1.0 }, 0.0);
    if with_neighbour {
        let fast = shop.body("fast", disc(0.25), 1.0, at_rest(10.0, 3.0));
        let ends = [at(WORLD, 10.0, 0.0), at(fast, 0.0, 0.0)];
        shop.builder.add_force(Arc::new(Spring::new("spring", ends, 2.0, 1000.0)));
        shop.body("bouncer", disc(0.25), 1.0, at_rest(15.0, 2.0));
        shop.fixed("plate", block(2.0, 0.5), DVec2::new(15.0, 0.0));
    }
    (shop.build(), bob)
}

#[test]
fn a_pendulum_moves_by_the_same_bits_whatever_happens_elsewhere() {
    let (mut alone, bob) = pendulum(false);
    let (mut beside, same) = pendulum(true);
    assert_eq!(bob, same);
    for piece in 1..=100 {
        let time = 0.2 * f64::from(piece);
        advance(&mut alone, time);
        advance(&mut beside, time);
        assert_eq!(bits(&alone.state(bob)), bits(&beside.state(bob)), "at {time} s");
    }
    assert!(beside.statistics().impacts > 10, "{:?}", beside.statistics());
    // The fast body alone takes most of the steps.
    let (one, all) = (alone.statistics().evaluations, beside.statistics().evaluations);
    assert!(all > 5 * one, "{one} evaluations alone, {all} in all");
}

/// Two pendulums, one ten times as fast as the other, which cannot collide with anything, or are far from everything.
fn two_pendulums(collisions: bool) -> World {
    let mut shop = Workshop::new(1e-9);
    shop.builder =
        WorldBuilder::new(WorldSettings { tolerance: 1e-9, collisions, ..WorldSettings::default() });
    for (name, x, length) in [("slow", 0.0, 3.0), ("fast", 20.0, 0.03)] {
        let bob = shop.body(name, disc(0.01), 1.0, at_rest(x + length, 0.0));
        shop.connect(ConnectorKind::Rod { a: at(WORLD, x, 0.0), b: at(bob, 0.0, 0.0), length }, 0.0);
    }
    shop.build()
}

#[test]
fn bodies_that_nothing_can_meet_move_by_the_same_bits_and_cost_less_where_nobody_looks() {
    let (mut watched, mut unwatched) = (two_pendulums(true), two_pendulums(false));
    let same = |one: &World, other: &World| {
        one.bodies().all(|body| bits(&one.state(body)) == bits(&other.state(body)))
    };
    assert!(same(&watched, &unwatched), "at the start");
    for piece in 1..=500 {
        let time = 0.0137 * f64::from(piece);
        advance(&mut watched, time);
        advance(&mut unwatched, time);
        assert!(same(&watched, &unwatched), "at {time} s");
    }
    let mut unseen = two_pendulums(false);
    advance(&mut unseen, unwatched.time());
    assert!(same(&unseen, &unwatched), "without a look in between");
    let [one, two] = [&unseen, &watched].map(|world| world.statistics().evaluations as f64);
    assert!(one < 0.9 * two, "{one} and {two} evaluations");
}

#[test]
fn groups_cost_what_they_cost_alone() {
    let evaluations = |count: i32| {
        let mut shop = Workshop::new(1e-9);
        shop.fixed("post", block(1.0, 1.0), DVec2::new(99.0, 0.0));
        for index in 0..count {
            let x = 4.0 * f64::from(index);
            let bob = shop.body(&format!("bob {index}"), disc(0.25), 1.0, at_rest(x + 1.0, 0.0));
            shop.connect(ConnectorKind::Rod { a: at(WORLD, x, 0.0), b: at(bob, 0.0, 0.0), length: 1.0 }, 0.0);
        }
        let mut world = shop.build();
        advance(&mut world, 10.0);
        world.statistics().evaluations
    };
    let (one, ten) = (evaluations(1), evaluations(10));
    assert!(one > 100 && ten <= 10 * one + one, "{one} for one, {ten} for ten");
}

#[test]
fn bodies_far_from_an_impact_are_not_cut() {
    let segments = |with_bouncer: bool| {
        let mut shop = Workshop::new(1e-9);
        shop.fixed("plate", block(2.0, 0.5), DVec2::new(15.0, 0.0));
        let bob = shop.body("bob", disc(0.25), 1.0, at_rest(1.0, 0.0));
        shop.connect(ConnectorKind::Rod { a: at(WORLD, 0.0, 0.0), b: at(bob, 0.0, 0.0), length: 1.0 }, 0.0);
        if with_bouncer {
            shop.body("bouncer", disc(0.25), 1.0, at_rest(15.0, 2.0));
        }
        let mut world = shop.build();
        advance(&mut world, 20.0);
        world.statistics()
    };
    let (alone, beside) = (segments(false), segments(true));
    assert!(beside.impacts >= 15, "{beside:?}");
    // The bouncer has a segment after each of its impacts, and its first one.
    assert_eq!(beside.steps, alone.steps + beside.impacts + 1, "{alone:?} {beside:?}");
    assert_eq!(beside.evaluations, alone.evaluations);
}

/// A scene with a block that slides and falls, a pendulum that hits it, a slack rope, and a spring.
fn busy() -> World {
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(8.0, 1.0), DVec2::new(0.0, -0.5));
    let sled = shop.body("sled", block(1.0, 0.5), 2.0, thrown(-2.0, 0.25, DVec2::new(1.0, 0.0)));
    let bob = shop.body("bob", disc(0.25), 1.0, at_rest(2.5, 2.5));
    shop.connect(ConnectorKind::Rod { a: at(WORLD, 0.5, 2.5), b: at(bob, 0.0, 0.0), length: 2.0 }, 0.0);
    let kite = shop.body("kite", disc(0.2), 0.5, thrown(-3.0, 3.0, DVec2::new(1.0, 2.0)));
    shop.connect(ConnectorKind::Rope { a: at(WORLD, -3.0, 3.0), b: at(kite, 0.0, 0.0), length: 1.0 }, 0.5);
    let ends = [at(WORLD, -4.0, 0.25), at(sled, 0.0, 0.0)];
    shop.builder.add_force(Arc::new(Spring::new("spring", ends, 1.0, 3.0)));
    shop.build()
}

#[test]
fn outputs_change_no_bit() {
    let (mut whole, mut pieces) = (busy(), busy());
    advance(&mut whole, 10.0);
    for piece in 1..=1000 {
        advance(&mut pieces, 0.01 * f64::from(piece));
        assert!(!pieces.contact_forces().is_empty() && pieces.ledger().start > 0.0);
    }
    for body in whole.bodies() {
        assert_eq!(bits(&whole.state(body)), bits(&pieces.state(body)), "{}", whole.name(body));
    }
    assert_eq!(whole.statistics(), pieces.statistics());
    assert!(whole.statistics().impacts > 5, "{:?}", whole.statistics());
}

#[test]
fn the_same_world_twice_ends_in_the_same_bits() {
    let (mut one, mut other) = (busy(), busy());
    advance(&mut one, 10.0);
    advance(&mut other, 10.0);
    for body in one.bodies() {
        assert_eq!(bits(&one.state(body)), bits(&other.state(body)), "{}", one.name(body));
    }
}
