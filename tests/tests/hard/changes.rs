//! Contacts that change from feature to feature, and that end.

use super::within;
use halfgap::geometry::{DVec2, EdgeSpec, PathSpec, Shape};
use halfgap::{Anchor, BodyId, BodySpec, BodyState, Connector, ConnectorKind, ConnectorSpec, Event, World};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc, thrown};
use std::f64::consts::FRAC_PI_2;

/// Tolerance of most of these cases.
const TOLERANCE: f64 = 1e-10;

#[test]
fn a_disc_slides_from_line_to_convex_arc_and_leaves_where_theory_says() {
    // A rounded block: its top is straight, its corner an arc of 1 m. The disc comes along the top too slowly
    // to fly off.
    let mut shop = Workshop::new(TOLERANCE);
    let hill = Shape::rounded_block(6.0, 6.0, 1.0).expect("a fine block");
    shop.fixed("hill", hill, DVec2::new(-3.0, -3.0));
    let speed = 1.0;
    let ball = shop.dull("disc", disc(0.5), 1.0, thrown(-2.0, 0.5, DVec2::new(speed, 0.0)));
    let mut world = shop.build();
    let (time, normal) = last_end(&mut world, 3.0);
    // About the arc's centre at a radius of 1.5 m: cos = 2/3 + v^2/(3 g R).
    let cosine = 2.0 / 3.0 + speed * speed / (3.0 * GRAVITY * 1.5);
    within("disc leaves a convex arc: cosine", normal.y - cosine, 1e-8);
    within(
        "disc leaves a convex arc: speed kept until then [m/s]",
        release_speed(&world, ball, time) - (GRAVITY * 1.5 * cosine).sqrt(),
        1e-8,
    );
}

/// Speed [m/s] of a falling body at an earlier time, from its present energy.
fn release_speed(world: &World, body: BodyId, time: f64) -> f64 {
    let state = world.state(body);
    let fallen = world.time() - time;
    (state.velocity + DVec2::new(0.0, GRAVITY * fallen)).length()
}

/// Time [s] and normal of the last contact that ends before a given time [s]. A contact that passes to the next
/// feature ends, too.
fn last_end(world: &mut World, until: f64) -> (f64, DVec2) {
    let mut last = None;
    world
        .advance_to(until, &mut |event| {
            if let Event::ContactEnds(end) = event {
                last = Some((end.time, end.contact.normal));
            }
        })
        .unwrap_or_else(|error| panic!("{error}"));
    last.expect("the contact ends")
}

#[test]
fn a_slow_disc_turns_about_the_corner_of_a_table_before_it_leaves() {
    let mut shop = Workshop::new(TOLERANCE);
    shop.fixed("table", block(6.0, 1.0), DVec2::new(-3.0, -0.5));
    let speed = 1.0;
    shop.dull("disc", disc(0.5), 1.0, thrown(-1.0, 0.5, DVec2::new(speed, 0.0)));
    let mut world = shop.build();
    let (_, normal) = last_end(&mut world, 3.0);
    // Once its centre is past the corner, the disc goes round it at 0.5 m: cos = 2/3 + v^2/(3 g r).
    let cosine = 2.0 / 3.0 + speed * speed / (3.0 * GRAVITY * 0.5);
    within("slow disc leaves a corner: cosine", normal.y.abs() - cosine, 1e-8);
}

#[test]
fn a_fast_disc_flies_off_the_end_of_a_table() {
    let mut shop = Workshop::new(TOLERANCE);
    shop.fixed("table", block(6.0, 1.0), DVec2::new(-3.0, -0.5));
    // The disc is faster than sqrt(g r): gravity cannot hold it to the corner.
    let speed = 3.0;
    let ball = shop.dull("disc", disc(0.5), 1.0, thrown(-1.5, 0.5, DVec2::new(speed, 0.0)));
    let mut world = shop.build();
    let start = world.state(ball).position.y;
    let (time, _) = last_end(&mut world, 1.0);
    within("fast disc off a table: time of leaving [s]", time - 0.5, 1e-9);
    let fall = 0.5 * GRAVITY * 0.25;
    let expected = DVec2::new(1.5, start - fall);
    within("fast disc off a table: its parabola [m]", (world.state(ball).position - expected).length(), 1e-9);
}

#[test]
fn a_block_slides_over_an_edge_and_turns_only_then() {
    let mut shop = Workshop::new(TOLERANCE);
    shop.fixed("table", block(6.0, 1.0), DVec2::new(-3.0, -0.5));
    let body = shop.dull("block", block(1.0, 0.4), 1.0, thrown(-1.0, 0.2, DVec2::new(1.0, 0.0)));
    let mut world = shop.build();
    advance(&mut world, 0.999);
    within("block to an edge: turned before its middle is there [rad]", world.state(body).angle, 1e-11);
    within("block to an edge: still on its way [m]", world.state(body).position.x + 0.001, 1e-11);
    let start = world.energy().total();
    advance(&mut world, 1.3);
    assert!(world.state(body).angle < -0.05, "it tips: {}", world.state(body).angle);
    // Without friction nothing is lost by contacts that only slide.
    within("block to an edge: energy while tipping [J]", world.energy().total() - start, 1e-8);
}

#[test]
fn a_disc_slides_from_line_to_concave_arc_to_line_and_comes_as_high_as_it_was() {
    let mut shop = Workshop::new(TOLERANCE);
    let shape = valley();
    let center = shape.mass_properties().centroid;
    shop.builder.add(BodySpec::fixed("valley", shape, center));
    // On the left slope, 0.5 m off it along its normal.
    let start = DVec2::new(-3.0, 3.0 - 2.0 * 2f64.sqrt()) + 0.5 * DVec2::new(0.5f64.sqrt(), 0.5f64.sqrt());
    let ball = shop.dull("disc", disc(0.5), 1.0, at_rest(start.x, start.y));
    let mut world = shop.build();
    let height = world.state(ball).position.y;
    let turns = turning_time(&world, ball, 0.5, 3.0);
    advance(&mut world, turns);
    let state = world.state(ball);
    within("disc in a valley: height on the other side [m]", state.position.y - height, 1e-9);
    within("disc in a valley: mirrored place [m]", state.position.x + start.x, 1e-9);
    // After the same time again it is back, at rest.
    advance(&mut world, 2.0 * turns);
    within("disc in a valley: back at the start [m]", (world.state(ball).position - start).length(), 1e-8);
    within("disc in a valley: energy [J]", world.ledger().integration_error(), 1e-8);
}

/// A block with a smooth valley on top: slopes of 45 degrees, tangent to an arc of 2 m about the origin below.
fn valley() -> Shape {
    let end = 2f64.sqrt();
    let line = |x: f64, y: f64| EdgeSpec::Line { to: DVec2::new(x, y) };
    let arc = EdgeSpec::Arc { to: DVec2::new(-end, -end), center: DVec2::ZERO, clockwise: true };
    let edges = vec![
        line(6.0, -3.0),
        line(6.0, 6.0 - 2.0 * end),
        line(end, -end),
        arc,
        line(-6.0, 6.0 - 2.0 * end),
        line(-6.0, -3.0),
    ];
    Shape::from_paths(&[PathSpec { start: DVec2::new(-6.0, -3.0), edges }]).expect("a valley")
}

/// Time [s] at which a body stops moving to the right, bisected between two times.
fn turning_time(world: &World, body: BodyId, mut early: f64, mut late: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (early + late);
        let mut there = world.clone();
        advance(&mut there, middle);
        if there.state(body).velocity.x > 0.0 { early = middle } else { late = middle }
    }
    early
}

/// Pins a bar of 0.6 m by 0.2 m to a point [m] of another body, with which it collides; the pin is 0.1 m beyond the
/// bar's end.
fn hinge(shop: &mut Workshop, (body, point): (BodyId, DVec2), bar: BodyId) {
    let kind = ConnectorKind::Pin { a: Anchor { body, point }, b: Anchor { body: bar, point: HINGE } };
    let pin = Connector::new(kind, 0.0).expect("a fine pin");
    shop.builder.add_connector(ConnectorSpec { collide: true, ..ConnectorSpec::new(pin) });
}

/// Place [m] of the pin on a bar that [`hinge`] pins, in coordinates of the bar.
const HINGE: DVec2 = DVec2::new(-0.4, 0.0);

/// Two bars on a hinge at the origin: as they fold, their corners meet when the bars are at right angles.
#[test]
fn bars_that_fold_until_their_corners_meet_stop_before_they_do() {
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let mut shop = Workshop::weightless(tolerance);
        let still = shop.fixed("still", block(0.6, 0.2), -HINGE);
        let (angle, rate) = (2.2, -1.0);
        let arm = 0.4 * DVec2::from_angle(angle);
        let state = BodyState { position: arm, angle, velocity: rate * arm.perp(), angular_velocity: rate };
        let bar = shop.dull("bar", block(0.6, 0.2), 1.0, state);
        hinge(&mut shop, (still, HINGE), bar);
        let mut world = shop.build();
        advance(&mut world, 1.0);
        // The corners are 0.1 sqrt(2) m from the hinge, and the target gap apart.
        let open = world.tolerances().target_gap / (0.1 * 2.0f64.sqrt());
        let what = format!("bars folded to their corners at {tolerance:e}: open by, in parts of that");
        within(&what, (world.state(bar).angle - FRAC_PI_2) / open - 1.0, 1e-2);
    }
}

/// Three bars stand one on the other on hinges, at angles [rad], and are let go; the first two fold until their
/// corners meet, and part again. Returns the place of the last bar after 2.5 s.
fn hanging_bars(tolerance: f64) -> DVec2 {
    let mut shop = Workshop::weightless(tolerance);
    let (mut end, mut above) = (DVec2::ZERO, (BodyId::WORLD, DVec2::ZERO));
    for (name, angle) in [("first", 1.84), ("second", 1.37), ("third", 1.44)] {
        let arm = 0.4 * DVec2::from_angle(angle);
        let state = BodyState { position: end + arm, angle, ..BodyState::default() };
        let bar = shop.dull(name, block(0.6, 0.2), 0.12, state);
        shop.builder.add_gravity(bar, DVec2::new(0.0, -9.81));
        hinge(&mut shop, above, bar);
        (end, above) = (end + 2.0 * arm, (bar, -HINGE));
    }
    let mut world = shop.build();
    advance(&mut world, 2.5);
    world.state(above.0).position
}

#[test]
fn bars_that_have_folded_to_their_corners_part_when_nothing_presses_them() {
    let exact = hanging_bars(1e-11);
    let errors = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9]
        .map(|tolerance: f64| hanging_bars(tolerance).distance(exact) / tolerance);
    let largest = errors.into_iter().fold(0.0, f64::max);
    within("three bars that fold to their corners: place, by the tolerance [m]", largest, 1.0);
}
