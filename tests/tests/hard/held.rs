//! Bodies that connectors hold still: what hits them, and what hangs on them.

use super::within;
use halfgap::force::{ConstantForce, ForceFrame};
use halfgap::geometry::DVec2;
use halfgap::{Anchor, BodyId, ConnectorKind, SlotFrame};
use halfgap_tests::mechanism::{Workshop, advance, at_rest, block, connector_error, disc, thrown};

const WORLD: BodyId = BodyId::WORLD;

#[test]
fn a_disc_held_at_rest_is_seen_by_what_flies_at_it() {
    // Nothing accelerates it and nothing moves: its speed is exactly zero, and it stays where rounding has put it. The ball
    // comes at its centre, and the pin there takes the impact: the ball goes back as fast as it came.
    for place in [DVec2::ZERO, DVec2::new(0.6224402073456548, 1.1595762182850256)] {
        let mut shop = Workshop::weightless(1e-9);
        let held = shop.body("held", disc(0.3335888210548019), 1.8, at_rest(place.x, place.y));
        shop.pin(held, WORLD, place);
        let way = DVec2::from_angle(1.1);
        let from = place - 2.0 * way;
        let ball = shop.body("ball", disc(0.1), 1.0, thrown(from.x, from.y, 5.0 * way));
        let mut world = shop.build();
        let meets = (2.0 - 0.1 - 0.3335888210548019) / 5.0;
        advance(&mut world, 2.0 * meets);
        within(
            "a ball off a disc held at rest: place [m]",
            (world.state(ball).position - from).length(),
            1e-7,
        );
    }
}

#[test]
fn a_heavy_slide_on_a_light_frame_that_is_pinned_twice_keeps_to_its_slope() {
    // The frame is held by four rows, of which three do: they share what they hold. The slide presses on it with its weight
    // across the slope, and goes down it as on a plane.
    let (mass, slope) = (1e5, 0.6);
    let mut shop = Workshop::new(1e-9);
    let frame = shop.body("frame", block(1.0, 0.2), 1e-3, at_rest(0.0, 0.0));
    shop.pin(frame, WORLD, DVec2::new(-0.4, 0.05));
    shop.pin(frame, WORLD, DVec2::new(0.3, -0.05));
    let slide = shop.body("slide", block(0.3, 0.3), mass, at_rest(0.0, 3.0));
    shop.builder.let_pass(frame, slide);
    let normal = DVec2::from_angle(slope + std::f64::consts::FRAC_PI_2);
    let ends = [(slide, DVec2::ZERO), (frame, DVec2::new(0.0, 3.0))];
    let [a, b] = ends.map(|(body, point)| Anchor { body, point });
    shop.connect(ConnectorKind::Slot { a, b, normal, frame: SlotFrame::World }, 0.0);
    let mut world = shop.build();
    advance(&mut world, 1.0);
    let expected = DVec2::new(0.0, 3.0) - DVec2::from_angle(slope) * (0.5 * 10.0 * slope.sin());
    let what = "a slide of 1e5 kg on a frame of a gram";
    within(&format!("{what}: place [m]"), (world.state(slide).position - expected).length(), 1e-8);
    within(&format!("{what}: frame moved [m]"), world.state(frame).position.length(), 1e-10);
    within(&format!("{what}: connectors [m]"), connector_error(&world), 1e-10);
}

#[test]
fn a_light_slide_goes_along_with_the_heavy_disc_that_it_carries() {
    // A slide of a milligram lies on the floor and carries a disc of 100 kg on a pin, which a weak force pushes: what is
    // rounding of the forces on the slide is what they move by.
    let (mass, push) = (100.0, 1e-2);
    let mut shop = Workshop::new(1e-10);
    shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
    let slide = shop.body("slide", block(1.0, 0.1), 1e-6, at_rest(0.0, 0.05));
    let disc = shop.body("disc", disc(0.3), mass, at_rest(0.0, 0.6));
    shop.pin(slide, disc, DVec2::new(0.0, 0.6));
    let at = [DVec2::ZERO, DVec2::new(push, 0.0)];
    let law = ConstantForce::new("push", disc, ForceFrame::Body, at, 0.0);
    shop.builder.add_force(std::sync::Arc::new(law));
    let mut world = shop.build();
    let mut apart: f64 = 0.0;
    for look in 1..=1000 {
        advance(&mut world, 1e-3 * f64::from(look));
        apart = apart.max(connector_error(&world));
    }
    within("a disc of 100 kg on a slide of a milligram: pin [m]", apart, 1e-12);
    let expected = 0.5 * push / mass;
    within(
        "a disc of 100 kg on a slide of a milligram: place [m]",
        world.state(slide).position.x - expected,
        1e-10,
    );
}

#[test]
fn joints_at_the_ends_of_long_arms_hold_also_between_the_ends_of_steps() {
    // Two bodies of half a metre are pinned 7 m away from both, where a slot keeps them from turning against each other.
    let mut shop = Workshop::new(1e-10);
    let left = shop.body("left", disc(0.5), 2.6, thrown(-1.3, 3.3, DVec2::new(27.0, -0.7)));
    let right = shop.body("right", block(0.85, 0.7), 2.9, at_rest(-1.8, -4.2));
    shop.builder.let_pass(left, right);
    shop.pin(left, right, DVec2::new(-1.1, 2.9));
    let ends = [left, right].map(|body| shop.anchor(body, DVec2::new(-1.8, -4.4)));
    let normal = DVec2::new(0.12, 0.99);
    shop.connect(ConnectorKind::Slot { a: ends[0], b: ends[1], normal, frame: SlotFrame::World }, 0.0);
    let mut world = shop.build();
    let mut apart: f64 = 0.0;
    for look in 1..=1000 {
        advance(&mut world, 1e-3 * f64::from(look));
        apart = apart.max(connector_error(&world));
    }
    within("a slot at the ends of arms of 8 m: between the ends of steps [m]", apart, 5e-9);
}
