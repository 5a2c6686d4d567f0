//! Bodies that connectors hold still: what hits them, and what hangs on them.

use super::within;
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
