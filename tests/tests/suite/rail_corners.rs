//! Rails whose points come to joints at the same time: one event, whatever the order of bodies and connectors.

use halfgap::geometry::{DVec2, EdgeSpec};
use halfgap::{BodyId, ConnectorKind, RailPath, World};
use halfgap_tests::mechanism::{Workshop, advance, block, disc, thrown};
use std::sync::Arc;

/// Error of a state [m, m/s].
const ROUNDING: f64 = 1e-9;

/// A rail of edges from a place [m].
fn rail(start: [f64; 2], edges: &[EdgeSpec]) -> Arc<RailPath> {
    Arc::new(RailPath::from_edges(DVec2::from_array(start), edges).expect("a fine path"))
}

fn line(x: f64, y: f64) -> EdgeSpec {
    EdgeSpec::Line { to: DVec2::new(x, y) }
}

/// Lets the centre of a body follow a rail.
fn follow(shop: &mut Workshop, body: BodyId, path: Arc<RailPath>) {
    let place = shop.builder.body(body).state.position;
    shop.connect(ConnectorKind::Rail { a: shop.anchor(body, place), path }, 0.0);
}

/// Kinetic energy [J] and velocities [m/s] of the movable bodies.
fn motion(world: &World) -> (f64, Vec<DVec2>) {
    (world.energy().kinetic, world.bodies().map(|body| world.state(body).velocity).collect())
}

#[test]
fn a_carriage_on_two_rails_that_bend_alike_loses_what_a_bead_would() {
    // Both points leave a level rail at 1 m/s for a slope of 2 in 5, at one time.
    let bent = |x: f64| rail([x - 3.0, 0.0], &[line(x, 0.0), line(x + 2.0, 0.8)]);
    let left = 1.0 / 1.16;
    for order in [[-0.1, 0.4], [0.4, -0.1]] {
        let mut shop = Workshop::weightless(1e-8);
        let body = shop.body("carriage", block(0.7, 0.2), 1.0, thrown(-1.0, 0.0, DVec2::X));
        for at in order {
            let a = shop.anchor(body, DVec2::new(at - 1.0, 0.0));
            shop.connect(ConnectorKind::Rail { a, path: bent(at) }, 0.0);
        }
        let mut world = shop.build();
        advance(&mut world, 2.0);
        let (energy, velocities) = motion(&world);
        assert!((energy - 0.5 * left).abs() < ROUNDING, "{order:?}: {energy} J");
        let off = velocities[0] - left * DVec2::new(1.0, 0.4);
        assert!(off.length() < ROUNDING, "{order:?}: {velocities:?} m/s");
    }
}

#[test]
fn a_carriage_meets_the_stop_in_the_corner_of_one_of_its_rails() {
    // Both points come to their corners at one time; the stop, wholly elastic, ends the rail of the front one there.
    let bent = |x: f64| rail([-2.5, 0.0], &[line(x, 0.0), line(x + 2.0, 1.0)]);
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let mut shop = Workshop::weightless(1e-8);
        let body = shop.body("carriage", block(0.7, 0.2), 1.0, thrown(-1.0, 0.0, DVec2::X));
        let [back, front] = [0.0, 0.5].map(|at| shop.anchor(body, DVec2::new(at - 1.0, 0.0)));
        for which in order {
            let (kind, elasticity) = match which {
                0 => (ConnectorKind::Rail { a: back, path: bent(0.0) }, 0.0),
                1 => (ConnectorKind::Rail { a: front, path: bent(0.5) }, 0.0),
                _ => (ConnectorKind::RailStop { a: front, path: bent(0.5), at: 3.0, upper: true }, 1.0),
            };
            shop.connect(kind, elasticity);
        }
        let mut world = shop.build();
        advance(&mut world, 1.5);
        let off = (motion(&world).1[0] + DVec2::X).length();
        assert!(off < ROUNDING, "{order:?}: {:?}", motion(&world));
    }
}

#[test]
fn two_beads_on_a_rod_turn_into_like_rails_at_one_time() {
    // The rod stands at these angles to the level rails, which bend up by 1 in 2; nothing turns.
    for angle in [0.3, 0.8, 1.2, std::f64::consts::FRAC_PI_2] {
        for swapped in [false, true] {
            let mut shop = Workshop::weightless(1e-8);
            let span = DVec2::from_angle(angle);
            let places = if swapped { [span, DVec2::ZERO] } else { [DVec2::ZERO, span] };
            let beads = places.map(|place| {
                let state = thrown(place.x - 1.0, place.y, DVec2::X);
                let body = shop.body(&format!("bead at {place}"), disc(0.1), 1.0, state);
                let bend = [line(place.x, place.y), line(place.x + 2.0, place.y + 1.0)];
                follow(&mut shop, body, rail([place.x - 2.0, place.y], &bend));
                body
            });
            let [a, b] = [0, 1].map(|bead: usize| shop.anchor(beads[bead], places[bead] - DVec2::X));
            shop.connect(ConnectorKind::Rod { a, b, length: 1.0 }, 0.0);
            let mut world = shop.build();
            advance(&mut world, 1.5);
            let (energy, velocities) = motion(&world);
            assert!((energy - 0.8).abs() < ROUNDING, "{angle}, swapped: {swapped}: {energy} J");
            let off = velocities.iter().map(|v| (*v - DVec2::new(0.8, 0.4)).length()).fold(0.0, f64::max);
            assert!(off < ROUNDING, "{angle}, swapped: {swapped}: {velocities:?} m/s");
        }
    }
}

#[test]
fn two_beads_on_a_rod_square_to_their_rails_go_over_to_arcs_at_one_time() {
    let mut shop = Workshop::weightless(1e-8);
    let beads = [0.0, 0.5].map(|y| {
        let body = shop.body(&format!("bead at {y}"), disc(0.1), 1.0, thrown(-1.0, y, DVec2::X));
        let center = DVec2::new(0.0, y + 1.0);
        let arc = EdgeSpec::Arc { to: DVec2::new(1.0, y + 1.0), center, clockwise: false };
        follow(&mut shop, body, rail([-3.0, y], &[line(0.0, y), arc]));
        shop.anchor(body, DVec2::new(-1.0, y))
    });
    shop.connect(ConnectorKind::Rod { a: beads[0], b: beads[1], length: 0.5 }, 0.0);
    let mut world = shop.build();
    advance(&mut world, 1.5);
    let (energy, velocities) = motion(&world);
    assert!((energy - 1.0).abs() < ROUNDING, "{energy} J");
    let expected = DVec2::from_angle(0.5);
    assert!(velocities.iter().all(|v| (*v - expected).length() < 1e-8), "{velocities:?} m/s");
}

#[test]
fn a_bar_on_two_beads_that_fall_onto_slopes_stays_level() {
    // Without forces between them before, the beads and the bar are no group: they only touch.
    for swapped in [false, true] {
        let mut shop = Workshop::new(1e-8);
        let sides = if swapped { [0.5, -0.5] } else { [-0.5, 0.5] };
        for side in sides {
            let state = thrown(side, 0.5, DVec2::NEG_Y);
            let body = shop.dull(&format!("bead at {side}"), disc(0.1), 1.0, state);
            let out = side.signum();
            follow(&mut shop, body, rail([side, 1.0], &[line(side, 0.0), line(side + 0.7 * out, -0.7)]));
        }
        let bar = shop.dull("bar", block(2.0, 0.1), 2.0, thrown(0.0, 0.65, DVec2::NEG_Y));
        let mut world = shop.build();
        advance(&mut world, 0.4);
        let state = world.state(bar);
        let off = state.angle.abs().max(state.position.x.abs());
        assert!(off < 1e-12, "swapped: {swapped}: {state:?}");
        assert!(state.velocity.y > -3.5, "the beads have held it back: {state:?}");
    }
}
