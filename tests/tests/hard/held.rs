//! Bodies that connectors hold still, under impacts and loads.

use super::within;
use halfgap::force::{ConstantForce, ForceFrame, Push};
use halfgap::geometry::DVec2;
use halfgap::{Anchor, BodyId, ConnectorKind, SlotFrame};
use halfgap_tests::mechanism::{Workshop, advance, at_rest, block, connector_error, disc, thrown};
use halfgap_tests::world_of;

const WORLD: BodyId = BodyId::WORLD;

#[test]
fn a_disc_held_at_rest_is_seen_by_what_flies_at_it() {
    // Nothing accelerates the disc and nothing moves: its speed is exactly zero, and it stays where rounding has put
    // it. The ball comes at its centre, and the pin there takes the impact: the ball goes back as fast as it came.
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
    // Four rows hold the frame, three of which would do: they share the load. The slide presses on the frame with its
    // weight across the slope, and goes down it as on a plane.
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
    // A slide of a milligram lies on the floor and carries a disc of 100 kg on a pin, which a weak force pushes: the
    // force that moves both is within the rounding of the forces on the slide.
    let (mass, force) = (100.0, 1e-2);
    let mut shop = Workshop::new(1e-10);
    shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
    let slide = shop.body("slide", block(1.0, 0.1), 1e-6, at_rest(0.0, 0.05));
    let disc = shop.body("disc", disc(0.3), mass, at_rest(0.0, 0.6));
    shop.pin(slide, disc, DVec2::new(0.0, 0.6));
    let push =
        Push { frame: ForceFrame::Body, point: DVec2::ZERO, force: DVec2::new(force, 0.0), torque: 0.0 };
    let law = ConstantForce::new("push", disc, push);
    shop.builder.add_force(std::sync::Arc::new(law));
    let mut world = shop.build();
    let mut apart: f64 = 0.0;
    for look in 1..=1000 {
        advance(&mut world, 1e-3 * f64::from(look));
        apart = apart.max(connector_error(&world));
    }
    within("a disc of 100 kg on a slide of a milligram: pin [m]", apart, 1e-12);
    let expected = 0.5 * force / mass;
    within(
        "a disc of 100 kg on a slide of a milligram: place [m]",
        world.state(slide).position.x - expected,
        1e-10,
    );
}

#[test]
fn joints_at_the_ends_of_long_arms_hold_also_between_the_ends_of_steps() {
    // Two bodies of half a metre are pinned 7 m away from one of them, and slotted along that arm: the gap of the slot
    // is of second order in their angles.
    let mut world = world_of(LONG_ARMS);
    let mut error: f64 = 0.0;
    for look in 1..=1000 {
        advance(&mut world, 1.2e-4 * f64::from(look));
        error = error.max(connector_error(&world));
    }
    within("a slot at the ends of arms of 7 m: between the ends of steps [m]", error, 5e-9);
}

/// Two discs, joined 7 m away, and a third body far away that they might meet.
const LONG_ARMS: &str = r#"
format = "halfgap-scene-1"
title = "long arms"
run = { duration = 0.12, tolerance = 1.13e-10 }

[[body]]
name = "left"
mass = 1.0
shape = { disc = { radius = 0.5 } }
position = [-2.3238919212112084, 3.3049677827948045]
velocity = [36.810950172311124, -3.7413659344923]

[[body]]
name = "right"
mass = 1.0
shape = { disc = { radius = 0.5 } }
position = [-1.8195854613761493, -4.217131736292375]
angle = -0.29062457531151775

[[body]]
name = "post"
fixed = true
shape = { disc = { radius = 0.5 } }
position = [0.0, 50.0]

[[connector]]
[connector.pin]
a = { body = "left", point = [-0.03740412829433515, -0.3489362726897265] }
b = { body = "right", point = [-2.5744687000063013, 6.717129761545968] }

[[connector]]
[connector.slot]
a = { body = "right", point = [0.05249768387996006, -0.1840101145589236] }
b = { body = "left", point = [0.501874437412978, -7.71343643225264] }
normal = [0.09198942535218824, 0.7547719848764417]
normal_frame = "world"
"#;
