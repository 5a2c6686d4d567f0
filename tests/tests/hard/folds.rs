//! Linkages with two parts that fold at the same moment, each of which could go on in two ways.

use super::within;
use halfgap::geometry::DVec2;
use halfgap::{BodyId, BodyState, World};
use halfgap_tests::mechanism::{Workshop, block, connector_error};

const WORLD: BodyId = BodyId::WORLD;

/// Radius of the crank, length of the long arms and of the sides of the rhombus [m].
const CRANK: f64 = 0.5;
const ARM: f64 = 2.0;
const SIDE: f64 = 1.2;
/// Angle [rad] at which the crank is let go.
const START: f64 = 0.5;

/// Peaucellier's linkage, by which the last corner of the rhombus goes along a straight line, with bars of different
/// masses under gravity; without the outer sides of the rhombus it is two dyads (`is_whole` false). Both arms come
/// into line with their inner sides at the same moment, where the crank turns back. Returns the numbers of the arms
/// and of the last bar.
fn linkage(tolerance: f64, is_whole: bool) -> (World, [BodyId; 3]) {
    let mut shop = Workshop::passing(tolerance);
    let hub = DVec2::new(CRANK, 0.0);
    let inner = hub + CRANK * DVec2::from_angle(START);
    let along = inner.normalize();
    // The ends of the arms are as far from the inner corner as a side is long.
    let way = (ARM * ARM - SIDE * SIDE + inner.length_squared()) / (2.0 * inner.length());
    let off = (ARM * ARM - way * way).sqrt();
    let ends = [1.0, -1.0].map(|side| way * along + side * off * along.perp());
    let outer = ends[0] + ends[1] - inner;
    let mut bar = |name: &str, mass: f64, from: DVec2, to: DVec2| {
        let way = to - from;
        let state = BodyState { position: 0.5 * (from + to), angle: way.to_angle(), ..BodyState::default() };
        shop.body(name, block(way.length(), 0.03), mass, state)
    };
    let crank = bar("crank", 1.5, hub, inner);
    let arms = [bar("upper arm", 0.9, DVec2::ZERO, ends[0]), bar("lower arm", 1.1, DVec2::ZERO, ends[1])];
    let sides = [bar("upper side", 0.6, inner, ends[0]), bar("lower side", 0.9, inner, ends[1])];
    let mut last = sides[1];
    let outer_sides = is_whole.then(|| {
        let sides =
            [bar("upper outer side", 0.7, ends[0], outer), bar("lower outer side", 0.5, ends[1], outer)];
        last = sides[1];
        sides
    });
    shop.pin(WORLD, crank, hub);
    for (place, &end) in ends.iter().enumerate() {
        shop.pin(WORLD, arms[place], DVec2::ZERO);
        shop.pin(crank, sides[place], inner);
        shop.pin(arms[place], sides[place], end);
        if let Some(outer_sides) = outer_sides {
            shop.pin(arms[place], outer_sides[place], end);
        }
    }
    if let Some([upper, lower]) = outer_sides {
        shop.pin(upper, lower, outer);
    }
    (shop.build(), [arms[0], arms[1], last])
}

/// Runs a linkage for 10 s; returns the largest change of its energy [J].
fn lost(tolerance: f64, is_whole: bool) -> f64 {
    let (mut world, bodies) = linkage(tolerance, is_whole);
    let energy = world.energy().total();
    let what = if is_whole { "straight-line linkage" } else { "two dyads" };
    let (mut lost, mut bent, mut apart): (f64, f64, f64) = (0.0, 0.0, f64::INFINITY);
    for piece in 1..=1000 {
        let outcome = world.advance_to(0.01 * f64::from(piece), &mut |_| {});
        assert!(outcome.is_ok(), "{what} at {tolerance}: {outcome:?}");
        lost = lost.max((world.energy().total() - energy).abs());
        let [upper, lower, last] = bodies.map(|body| world.state(body));
        apart = apart.min((upper.angle - lower.angle).sin().abs());
        if is_whole {
            let end = last.pose().point_to_world(DVec2::new(0.5 * SIDE, 0.0));
            bent = bent.max((end.x - (ARM * ARM - SIDE * SIDE) / (2.0 * CRANK)).abs());
        }
    }
    assert!(apart < 0.02, "{what} at {tolerance}: its arms come no closer than {apart}");
    if is_whole {
        within(&format!("{what} at {tolerance}: off its line [m]"), bent, (0.1 * tolerance).max(1e-9));
    }
    within(&format!("{what} at {tolerance}: connectors [m]"), connector_error(&world), 1e-9);
    lost
}

#[test]
fn dyads_that_fold_at_once_keep_their_energy_whatever_the_tolerance() {
    for is_whole in [false, true] {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
            let what = if is_whole { "straight-line linkage" } else { "two dyads" };
            let lost = lost(tolerance, is_whole);
            within(&format!("{what}, 10 s at {tolerance}: energy [J]"), lost, (1e3 * tolerance).max(1e-5));
        }
    }
}

#[test]
fn dyads_that_fold_at_once_go_on_in_the_same_way_at_any_tolerance() {
    for is_whole in [false, true] {
        let place = |tolerance: f64| {
            let (mut world, [upper, ..]) = linkage(tolerance, is_whole);
            world.advance_to(3.0, &mut |_| {}).expect("it goes on");
            world.state(upper).angle
        };
        let known = place(1e-11);
        for tolerance in [1e-5, 1e-7, 1e-9] {
            let what = if is_whole { "straight-line linkage" } else { "two dyads" };
            let wrong = place(tolerance) - known;
            within(&format!("{what}, 3 s at {tolerance}: angle [rad]"), wrong, (30.0 * tolerance).max(1e-6));
        }
    }
}
