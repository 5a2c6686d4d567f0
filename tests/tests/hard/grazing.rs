//! Contacts that nearly happen, and contacts that nearly fail to happen.

use super::{impacts, within};
use halfgap::BodyState;
use halfgap::geometry::DVec2;
use halfgap_tests::mechanism::{Workshop, at_rest, block, disc, thrown};

/// Distance [m] by which a path misses or meets.
const MARGIN: f64 = 1e-12;

/// A disc flies past a fixed one at the distance at which they fire, plus a margin [m]. Returns the number of impacts
/// and the velocity after.
fn past_a_disc(margin: f64) -> (usize, DVec2) {
    let mut shop = Workshop::weightless(1e-8);
    shop.fixed("post", disc(1.0), DVec2::ZERO);
    let gap = 0.5e-10;
    let ball = shop.body("ball", disc(0.5), 1.0, thrown(-3.0, 1.5 + gap + margin, DVec2::new(1.0, 0.0)));
    let mut world = shop.build();
    assert!((world.tolerances().target_gap - gap).abs() < 1e-24);
    let count = impacts(&mut world, 6.0);
    (count, world.state(ball).velocity)
}

#[test]
fn a_disc_that_misses_by_1e_12_is_not_touched() {
    assert_eq!(past_a_disc(MARGIN), (0, DVec2::new(1.0, 0.0)));
}

#[test]
fn a_disc_that_meets_by_1e_12_is_reflected() {
    let (count, velocity) = past_a_disc(-MARGIN);
    assert_eq!(count, 1);
    // The angle to the tangent is the arc cosine of 1 - margin/R, and elastic reflection turns by twice that.
    let expected = (2.0 * (2.0 * MARGIN / 1.5).sqrt()).sin();
    within("grazing disc, meets by 1e-12 m: deflection [rad]", velocity.y - expected, 1e-3 * expected);
    within("grazing disc, meets by 1e-12 m: speed [m/s]", velocity.length() - 1.0, 1e-14);
}

/// The corner of a square, which points down, flies past a disc at the distance at which they fire, plus a margin [m].
fn corner_past_a_disc(margin: f64) -> (usize, f64) {
    let mut shop = Workshop::weightless(1e-8);
    shop.fixed("post", disc(1.0), DVec2::ZERO);
    let reach = 0.5 * 2f64.sqrt();
    let mut state = thrown(-3.0, 1.0 + reach + margin, DVec2::new(1.0, 0.0));
    state.angle = std::f64::consts::FRAC_PI_4;
    let body = shop.body("square", block(1.0, 1.0), 1.0, state);
    let mut world = shop.build();
    let count = impacts(&mut world, 6.0);
    (count, world.state(body).velocity.y)
}

#[test]
fn a_corner_that_misses_a_disc_by_1e_12_is_not_touched() {
    let gap = 1e-10 * 0.5 * 2f64.sqrt();
    assert_eq!(corner_past_a_disc(gap + MARGIN), (0, 0.0));
}

#[test]
fn a_corner_that_meets_a_disc_by_1e_12_is_lifted() {
    let gap = 1e-10 * 0.5 * 2f64.sqrt();
    let (count, velocity) = corner_past_a_disc(gap - MARGIN);
    assert_eq!(count, 1);
    // The corner meets a circle of 1 m; the impulse acts below the centre of mass, without an arm to first order: the
    // block leaves with the closing speed, as the disc does.
    let expected = 2.0 * (2.0 * MARGIN).sqrt();
    within("grazing corner, meets by 1e-12 m: speed upwards [m/s]", velocity - expected, 2e-3 * expected);
}

#[test]
fn a_disc_that_flies_along_a_wall_is_not_touched_on_either_side_of_touching() {
    for margin in [MARGIN, 0.0, -MARGIN] {
        let mut shop = Workshop::weightless(1e-8);
        shop.fixed("floor", block(100.0, 1.0), DVec2::new(0.0, -0.5));
        let ball =
            shop.body("ball", disc(0.5), 1.0, thrown(-20.0, 0.5 + 0.5e-10 + margin, DVec2::new(1.0, 0.0)));
        let mut world = shop.build();
        assert_eq!(impacts(&mut world, 40.0), 0, "margin {margin}");
        assert_eq!(world.state(ball).velocity, DVec2::new(1.0, 0.0), "margin {margin}");
    }
}

#[test]
fn a_ball_that_turns_back_1e_12_before_the_floor_never_touches_it() {
    // A throw upwards, turned over: gravity points up, and the ball approaches the floor from above until it turns
    // back.
    for (margin, expected) in [(MARGIN, 0), (-MARGIN, 1)] {
        let mut shop = Workshop::weightless(1e-8);
        shop.fixed("floor", block(4.0, 1.0), DVec2::new(0.0, -0.5));
        // Closing at 1 m/s and slowed by 1 m/s^2 the ball stops after half a metre.
        let height = 0.5 + 0.5 + 0.5e-10 + margin;
        let ball = shop.builder.add(halfgap::BodySpec::movable(
            "ball",
            disc(0.5),
            1.0,
            BodyState { velocity: DVec2::new(0.0, -1.0), ..at_rest(0.0, height) },
        ));
        shop.builder.add_gravity(ball, DVec2::new(0.0, 1.0));
        let mut world = shop.build();
        let count = impacts(&mut world, 2.0);
        assert_eq!(count, expected, "margin {margin}");
        // If it went on past the floor, it would be back at its start at the speed it had. Reflected, it is spared the
        // 1e-12 m there and back: 2 sqrt(2 margin) s.
        let spared = if margin < 0.0 { 2.0 * (2.0 * MARGIN).sqrt() } else { 0.0 };
        let state = world.state(ball);
        let what =
            if margin < 0.0 { "turning 1e-12 m beyond touching" } else { "turning 1e-12 m before touching" };
        within(&format!("{what}: position [m]"), state.position.y - height - spared, 1e-9);
        within(&format!("{what}: velocity [m/s]"), state.velocity.y - 1.0 - spared, 1e-9);
    }
}
