//! Ropes that pull tight.

use super::within;
use halfgap::geometry::DVec2;
use halfgap::{Anchor, BodyId, ConnectorKind, World};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, disc, thrown};

fn rope(shop: &mut Workshop, from: DVec2, body: BodyId, length: f64, elasticity: f64) {
    let a = Anchor { body: BodyId::WORLD, point: from };
    shop.connect(ConnectorKind::Rope { a, b: Anchor { body, point: DVec2::ZERO }, length }, elasticity);
}

/// A ball flies past the rope's end until it pulls tight at an angle, without weight: its velocity after.
fn taut_at_an_angle(elasticity: f64) -> (World, BodyId) {
    let mut shop = Workshop::weightless(1e-10);
    let ball = shop.body("ball", disc(0.1), 1.0, thrown(0.0, -0.6, DVec2::new(1.0, 0.0)));
    rope(&mut shop, DVec2::ZERO, ball, 1.0, elasticity);
    let mut world = shop.build();
    // Taut at (0.8, -0.6) m, after 0.8 s.
    advance(&mut world, 0.9);
    (world, ball)
}

#[test]
fn a_rope_that_pulls_tight_at_an_angle_takes_the_speed_along_itself() {
    let (world, ball) = taut_at_an_angle(0.0);
    // Across the rope, (0.6, 0.8), the speed is 0.6 m/s and stays.
    within("rope taut at an angle, dull: speed [m/s]", world.state(ball).velocity.length() - 0.6, 1e-9);
    within("rope taut at an angle, dull: length [m]", world.state(ball).position.length() - 1.0, 1e-9);
}

#[test]
fn a_rope_that_pulls_tight_at_an_angle_gives_the_speed_along_itself_back() {
    let (world, ball) = taut_at_an_angle(1.0);
    // Reflected in the direction (0.8, -0.6): v - 2 (v.n) n.
    let expected = DVec2::new(1.0 - 2.0 * 0.64, 2.0 * 0.48);
    within(
        "rope taut at an angle, elastic: velocity [m/s]",
        (world.state(ball).velocity - expected).length(),
        1e-9,
    );
}

/// A ball falls on two ropes of 1 m that are tied at (-0.6, 0) and (0.6, 0): taut at once at a depth of 0.8 m.
fn two_at_once(elasticity: f64, until: f64) -> (World, BodyId) {
    let mut shop = Workshop::new(1e-10);
    let ball = shop.body("ball", disc(0.1), 1.0, at_rest(0.0, -0.3));
    for x in [-0.6, 0.6] {
        rope(&mut shop, DVec2::new(x, 0.0), ball, 1.0, elasticity);
    }
    let mut world = shop.build();
    advance(&mut world, until);
    (world, ball)
}

#[test]
fn two_ropes_that_pull_tight_at_once_throw_a_ball_straight_back() {
    // Half a metre down takes sqrt(0.1) s, and so does the way back.
    let (world, ball) = two_at_once(1.0, 2.0 * 0.1f64.sqrt());
    let state = world.state(ball);
    within("two ropes at once, elastic: back [m]", (state.position - DVec2::new(0.0, -0.3)).length(), 1e-8);
    within("two ropes at once, elastic: aside [m/s]", state.velocity.x, 1e-9);
}

#[test]
fn two_ropes_that_pull_tight_at_once_hold_a_ball() {
    let (world, ball) = two_at_once(0.0, 3.0);
    let state = world.state(ball);
    within("two ropes at once, dull: hangs [m]", (state.position - DVec2::new(0.0, -0.8)).length(), 1e-9);
    within("two ropes at once, dull: speed [m/s]", state.velocity.length(), 1e-9);
    let forces = world.contact_forces();
    assert_eq!(forces.len(), 2);
    // Each carries half the weight over the cosine, 0.8.
    let off = forces.iter().map(|row| (row.force - 0.5 * GRAVITY / 0.8).abs()).fold(0.0, f64::max);
    within("two ropes at once, dull: forces [N]", off, 1e-8);
}
