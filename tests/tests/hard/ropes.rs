//! Ropes that pull tight.

use super::within;
use halfgap::geometry::DVec2;
use halfgap::{Anchor, BodyId, ConnectorKind, World};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, disc, thrown};
use halfgap_tests::world_of;

fn rope(shop: &mut Workshop, from: DVec2, body: BodyId, length: f64, elasticity: f64) {
    let a = Anchor { body: BodyId::WORLD, point: from };
    shop.connect(ConnectorKind::Rope { a, b: Anchor { body, point: DVec2::ZERO }, length }, elasticity);
}

/// Velocity of a weightless ball after it has flown past the rope's end until the rope pulls tight at an angle.
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
    // Across the rope, along (0.6, 0.8), the speed is 0.6 m/s and stays.
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

/// Start of two discs on ropes.
struct Swing {
    /// Velocity [m/s] and spin [rad/s] of the upper one.
    velocity: [f64; 2],
    spin: f64,
    /// Offsets [m] from the middle of the upper disc at which the ropes up and down are tied to it.
    ends: [f64; 2],
    /// Horizontal place [m] and velocity [m/s] of the lower disc.
    x: f64,
    below: [f64; 2],
}

/// Two discs on ropes, one below the other, the lower one elastic, optionally with a spring beside them. Returns the
/// place of the lower one after a second.
fn discs_on_ropes(tolerance: f64, swing: &Swing, spring: bool) -> DVec2 {
    let &Swing { velocity, spin, ends: [first, second], x, below } = swing;
    let spring = match spring {
        true => {
            r#"
        [[force]]
        spring = { a = { body = "world", point = [1, -1] }, b = { body = "a", point = [0.1, 0] }, rest_length = 0.5, stiffness = 40.0 }"#
        }
        false => "",
    };
    let mut world = world_of(&format!(
        r#"
        format = "halfgap-scene-1"
        title = "Two discs on ropes"
        run = {{ duration = 1.0, collisions = false, impact_law = "simultaneous", tolerance = {tolerance:e} }}
        [[body]]
        name = "a"
        shape = {{ disc = {{ radius = 0.1 }} }}
        mass = 1.0
        moment = 0.05
        position = [0, -1]
        velocity = {velocity:?}
        angular_velocity = {spin}
        [[body]]
        name = "b"
        shape = {{ disc = {{ radius = 0.1 }} }}
        mass = 1.0
        position = [{x}, -1.6]
        velocity = {below:?}
        [[connector]]
        rope = {{ a = {{ body = "world", point = [0, 0] }}, b = {{ body = "a", point = [{first}, 0.1] }}, length = 1.0, elasticity = 0.0 }}
        [[connector]]
        rope = {{ a = {{ body = "a", point = [{second}, -0.1] }}, b = {{ body = "b", point = [0, 0] }}, length = 0.9, elasticity = 1.0 }}
        [[force]]
        gravity = {{ acceleration = [0, -9.81] }}{spring}
        "#
    ));
    advance(&mut world, 1.0);
    world.state(world.find("b").expect("it is there")).position
}

#[test]
fn a_rope_that_is_held_hands_on_what_one_below_it_gives() {
    // When the lower rope goes taut, rounding decides whether the upper one opens or closes, and the steps decide
    // where the upper one was when it went taut itself: it is held all the same.
    let swings = [
        Swing { velocity: [0.02, 0.9], spin: -1.42, ends: [0.13, -0.04], x: 0.27, below: [-0.38, -0.15] },
        Swing { velocity: [-0.48, -0.81], spin: 1.26, ends: [0.04, 0.18], x: 0.27, below: [0.19, 0.72] },
        Swing { velocity: [0.85, 0.32], spin: 0.77, ends: [-0.11, 0.06], x: -0.12, below: [-0.66, 0.41] },
    ];
    let tolerances = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
    for (spring, beside) in [(false, ""), (true, " and a spring")] {
        let mut largest = 0.0f64;
        for swing in &swings {
            let exact = discs_on_ropes(1e-12, swing, spring);
            for tolerance in tolerances {
                let error = discs_on_ropes(tolerance, swing, spring).distance(exact);
                largest = largest.max(error / tolerance);
            }
        }
        within(&format!("two discs on ropes{beside}: place, by the tolerance [m]"), largest, 0.1);
    }
}
