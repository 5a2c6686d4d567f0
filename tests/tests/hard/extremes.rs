//! Numbers far from one.

use super::{bounced, within};
use halfgap::geometry::{DVec2, EdgeSpec, PathSpec, Shape};
use halfgap::{BodyId, BodyState, World};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc, pendulum_period, thrown};
use halfgap_tests::{reference_scene, world_of};

#[test]
fn a_small_disc_meets_one_ten_thousand_times_as_large_and_a_billion_times_as_heavy() {
    let mut shop = Workshop::weightless(1e-10);
    let large = shop.body("large", disc(1e4), 1e9, at_rest(0.0, 0.0));
    let small = shop.body("small", disc(1.0), 1.0, thrown(1e4 + 3.0, 0.0, DVec2::new(-1.0, 0.0)));
    let mut world = shop.build();
    advance(&mut world, 4.0);
    // Two masses on a line, elastic: u1 = 2 m2 v/(m1 + m2), u2 = (m2 - m1) v/(m1 + m2).
    let (m1, m2) = (1e9, 1.0);
    let (u1, u2) = (-2.0 * m2 / (m1 + m2), (m1 - m2) / (m1 + m2));
    within("sizes 1e4:1, masses 1e9:1: the small one [m/s]", world.state(small).velocity.x - u2, 1e-14);
    within(
        "sizes 1e4:1, masses 1e9:1: the large one, relative",
        world.state(large).velocity.x / u1 - 1.0,
        1e-13,
    );
}

#[test]
fn a_small_disc_bounces_on_a_planet_of_a_million_metres() {
    let mut shop = Workshop::new(1e-10);
    shop.fixed("planet", disc(1e6), DVec2::new(0.0, -1e6));
    let ball = shop.body("ball", disc(0.5), 1.0, at_rest(0.0, 1.75));
    let mut world = shop.build();
    let depth = 1.25 - world.tolerances().target_gap;
    advance(&mut world, 10.25);
    let off = world.state(ball).position.y - (1.75 - bounced(depth, 10.25));
    within("ball on a planet of 1e6 m, 10 bounces: height [m]", off, 1e-7);
    within("ball on a planet of 1e6 m: energy [J]", world.energy().total() - 17.5, 1e-9);
}

/// The top of a circle, 10 m wide; the ends of the arc are at height 0.
fn cap(radius: f64) -> Shape {
    let center = DVec2::new(0.0, -(radius * radius - 25.0).sqrt());
    let edges = vec![
        EdgeSpec::Line { to: DVec2::new(5.0, -1.0) },
        EdgeSpec::Line { to: DVec2::new(5.0, 0.0) },
        EdgeSpec::Arc { to: DVec2::new(-5.0, 0.0), center, clockwise: false },
        EdgeSpec::Line { to: DVec2::new(-5.0, -1.0) },
    ];
    Shape::from_paths(&[PathSpec { start: DVec2::new(-5.0, -1.0), edges }]).expect("a cap")
}

/// Height [m] of a block above its place of rest, and energy [J] that is not accounted for, 3 s after it fell on a cap
/// at an angle [rad].
fn on_a_cap(radius: f64, tolerance: f64, angle: f64) -> (f64, f64) {
    let mut shop = Workshop::new(tolerance);
    let middle = cap(radius).mass_properties().centroid;
    shop.fixed("planet", cap(radius), middle);
    let state = BodyState { angle, ..at_rest(0.0, 0.55) };
    let settler = shop.settler("block", block(0.5, 0.5), 1.0, state, 0.3);
    let mut world = shop.build();
    advance(&mut world, 3.0);
    (world.state(settler).position.y - 0.25, world.ledger().integration_error())
}

#[test]
fn a_block_comes_down_on_the_top_of_a_planet_whatever_its_radius() {
    // However short its arc, the distance of a planet's surface is known no better than to the rounding of its radius.
    for (tolerance, asked) in [(1e-5, 2e-3), (1e-8, 2e-4), (1e-10, 2e-4)] {
        let mut worst = 0.0f64;
        for radius in [1e3, 1e5, 1e6, 6.371e6] {
            for angle in [0.2, 0.5, 1.0] {
                let (height, lost) = on_a_cap(radius, tolerance, angle);
                assert!(
                    (-1e-3..0.11).contains(&height),
                    "{radius} m, {tolerance:e}, {angle} rad: {height} m"
                );
                worst = worst.max(lost.abs());
            }
        }
        within(&format!("block on caps of 1e3 to 6.4e6 m at {tolerance:e}: energy [J]"), worst, asked);
    }
}

#[test]
fn a_million_metres_from_the_origin_a_ball_bounces_as_well_as_there() {
    let away = DVec2::new(1e6, -1e6);
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(4.0, 1.0), away + DVec2::new(0.0, -0.5));
    let start = away + DVec2::new(0.0, 1.75);
    let ball = shop.body("ball", disc(0.5), 1.0, at_rest(start.x, start.y));
    let mut world = shop.build();
    assert!(!world.warnings().is_empty(), "the gap is wider than the tolerance asks for");
    // Coordinates are rounded to 1.2e-10 m, and the target gap is a thousand times that.
    let depth = 1.25 - world.tolerances().target_gap;
    advance(&mut world, 10.25);
    let off = world.state(ball).position.y - (start.y - bounced(depth, 10.25));
    within("ball 1e6 m from the origin, 10 bounces: height [m]", off, 3e-8);
}

#[test]
fn a_pendulum_a_million_metres_from_the_origin_swings_as_well_as_there() {
    let away = DVec2::new(1e6, 1e6);
    let mut shop = Workshop::new(1e-8);
    let bar = shop.bar("bar", away, away + DVec2::new(1.0, 0.0));
    shop.pin(halfgap::BodyId::WORLD, bar, away);
    let mut world = shop.build();
    let start = world.energy().total();
    advance(&mut world, 10.0);
    let change = world.energy().total() - start;
    within("pendulum 1e6 m from the origin, 10 s: energy [J]", change, 1e-6);
}

#[test]
fn a_block_with_a_spin_of_10000_rad_s_keeps_its_energy_in_a_room() {
    let mut shop = Workshop::weightless(1e-10);
    shop.fixed("room", Shape::ring(4.0, 3.0).expect("a ring"), DVec2::ZERO);
    let state = BodyState { angular_velocity: 1e4, ..thrown(0.0, 0.1, DVec2::new(1.0, 0.3)) };
    shop.body("block", block(1.0, 0.5), 1.0, state);
    let mut world = shop.build();
    let start = world.energy().kinetic;
    advance(&mut world, 20.0);
    let impacts = world.statistics().impacts;
    assert!(impacts > 5, "{impacts} impacts");
    within("block at 1e4 rad/s in a room: energy, relative", world.energy().kinetic / start - 1.0, 1e-12);
}

#[test]
fn a_bar_that_spins_on_a_pin_is_where_it_should_be_between_steps() {
    // The bar turns evenly in its angle, so that only the relation of angles and places limits its steps.
    let mut shop = Workshop::weightless(1e-9);
    let state = BodyState { angular_velocity: 10.0, ..thrown(0.5, 0.0, DVec2::new(0.0, 5.0)) };
    let bar = shop.body("bar", block(1.0, 0.1), 1.0, state);
    shop.pin(BodyId::WORLD, bar, DVec2::ZERO);
    let mut world = shop.build();
    let mut worst: f64 = 0.0;
    for piece in 1..=100 {
        let time = 0.37 * f64::from(piece);
        advance(&mut world, time);
        let expected = 0.5 * DVec2::from_angle(10.0 * time);
        worst = worst.max(world.state(bar).position.distance(expected));
    }
    within("bar that spins on a pin, 37 s: place [m]", worst, 1e-9);
}

#[test]
fn a_free_spin_of_10000_rad_s_keeps_its_angle_for_a_thousand_seconds() {
    let mut shop = Workshop::new(1e-8);
    let state = BodyState { angular_velocity: 1e4, ..at_rest(0.0, 0.0) };
    let body = shop.body("block", block(1.0, 0.5), 1.0, state);
    let mut world = shop.build();
    for piece in 1..=1000 {
        advance(&mut world, f64::from(piece));
    }
    within("free spin of 1e4 rad/s for 1000 s: angle, relative", world.state(body).angle / 1e7 - 1.0, 1e-15);
}

#[test]
fn a_pendulum_keeps_its_phase_for_ten_thousand_seconds() {
    let mut scene = reference_scene("exact__pendulum");
    scene.set_tolerance(1e-13, "tolerance").expect("a fine tolerance");
    let mut world = World::from_scene(&scene).expect("a fine world");
    let rod = world.find("rod").expect("it is there");
    let start = world.state(rod);
    let energy = world.energy().total();
    // A block of 1 by 0.2 m about its end: I = m (1 + 0.04)/12 + m/4, arm 0.5 m; released 2.5 rad from hanging.
    let moment: f64 = 1.04 / 12.0 + 0.25;
    let period = pendulum_period((9.81 * 0.5 / moment).sqrt(), 2.5);
    let swings = (1e4 / period).floor();
    advance(&mut world, swings * period);
    let state = world.state(rod);
    within("pendulum, 1e4 s: angle after whole swings [rad]", state.angle - start.angle, 1e-6);
    // At the turning point the angle is stationary, the rate is not.
    within("pendulum, 1e4 s: rate there [rad/s]", state.angular_velocity, 1e-6);
    within("pendulum, 1e4 s: energy, relative", world.energy().total() / energy - 1.0, 1e-9);
}

#[test]
fn a_stiff_spring_swings_at_its_frequency() {
    // 1e8 N/m on 1 kg: 1e4 rad/s, stretched by 1 mm; 1 s is 1592 periods.
    let mut shop = Workshop::weightless(1e-12);
    let ball = shop.body("ball", disc(0.1), 1.0, at_rest(1.001, 0.0));
    let ends = [(halfgap::BodyId::WORLD, DVec2::ZERO), (ball, DVec2::ZERO)];
    let [a, b] = ends.map(|(body, point)| halfgap::Anchor { body, point });
    let spring = halfgap::force::Spring::new("spring", [a, b], 1.0, 1e8);
    shop.builder.add_force(std::sync::Arc::new(spring));
    let mut world = shop.build();
    let energy = world.energy().total();
    advance(&mut world, 1.0);
    let expected = 1.0 + 1e-3 * 1e4f64.cos();
    within(
        "spring of 1e4 rad/s, 1 s: place, parts of its swing",
        (world.state(ball).position.x - expected) / 1e-3,
        1e-6,
    );
    within("spring of 1e4 rad/s, 1 s: energy, relative", world.energy().total() / energy - 1.0, 1e-7);
}

#[test]
fn a_weight_a_million_times_as_heavy_rests_on_a_light_block() {
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
    let light = shop.dull("light", block(1.0, 1.0), 1.0, at_rest(0.0, 0.5));
    let heavy = shop.dull("heavy", block(1.0, 1.0), 1e6, at_rest(0.0, 1.5));
    let mut world = shop.build();
    let start = [light, heavy].map(|body| world.state(body));
    advance(&mut world, 10.0);
    for (body, before) in [light, heavy].into_iter().zip(start) {
        let state = world.state(body);
        within("1e6 kg on 1 kg, 10 s: sunk [m]", state.position.y - before.position.y, 1e-11);
        within("1e6 kg on 1 kg, 10 s: turned [rad]", state.angle, 1e-11);
    }
    let on_floor: f64 = world
        .contact_forces()
        .iter()
        .filter(|row| row.bodies.contains(&halfgap::BodyId(0)))
        .map(|row| row.force)
        .sum();
    within(
        "1e6 kg on 1 kg, 10 s: force on the floor, relative",
        on_floor / (1_000_001.0 * GRAVITY) - 1.0,
        1e-10,
    );
}

/// Error [m] of the height of a ball that bounces by 0.8 with a spin [rad/s] on a floor of a width [m], 1 m below it;
/// a bullet may fly far above at a speed [m/s].
fn bounce_beside(tolerance: f64, spin: f64, width: f64, bullet: f64) -> f64 {
    let mut shop = Workshop::new(tolerance);
    shop.fixed("floor", block(width, 2.0), DVec2::new(0.0, -1.0));
    let state = BodyState { angular_velocity: spin, ..at_rest(0.0, 1.5) };
    let ball = shop.settler("ball", disc(0.5), 1.0, state, 0.8);
    if bullet > 0.0 {
        shop.body("bullet", disc(0.5), 1.0, thrown(0.0, 20.0, DVec2::new(bullet, 0.0)));
    }
    let mut world = shop.build();
    let fall = (2.0 / GRAVITY).sqrt();
    // Measured at the top of the first bounce.
    advance(&mut world, 1.8 * fall);
    world.state(ball).position.y - 0.5 - 0.64
}

#[test]
fn a_large_speed_or_size_elsewhere_does_not_make_a_bounce_slow() {
    for tolerance in [1e-1, 1e-2, 1e-3, 1e-5] {
        let cases =
            [("a bullet", 0.0, 10.0, 1e4), ("its spin", 1e4, 10.0, 0.0), ("a long floor", 0.0, 1e5, 0.0)];
        for (what, spin, width, bullet) in cases {
            let off = bounce_beside(tolerance, spin, width, bullet);
            within(&format!("bounce beside {what} at {tolerance:e}: height [m]"), off, tolerance);
        }
    }
}

/// Place [m] of a slider of 1 kg, 0.5 s after the start at a given clock time [s]. At 5 m/s it goes through the anchor
/// of its spring, 1 m long when slack, whose force turns about there within no time.
fn through_anchor(start: f64) -> f64 {
    let mut world = world_of(&format!(
        r#"
format = "halfgap-scene-1"
title = "Through the anchor of a spring"
run = {{ start_time = {start:?}, duration = 1.0 }}

[[body]]
name = "slider"
shape = {{ block = {{ width = 0.3, height = 0.3 }} }}
mass = 1.0
position = [0.5, 0.0]
velocity = [-5.0, 0.0]

[[force]]
[force.spring]
a = {{ body = "world", point = [0.0, 0.0] }}
b = {{ body = "slider", point = [0.0, 0.0] }}
rest_length = 1.0
stiffness = 10.0
"#
    ));
    world.advance_to(start + 0.5, &mut |_| {}).unwrap_or_else(|error| panic!("{error}"));
    world.state(world.find("slider").expect("it is there")).position.x
}

#[test]
fn a_late_clock_takes_steps_as_short_as_an_early_one() {
    let expected = {
        // Harmonic on either side: x = 1 + a cos wt + b sin wt up to the anchor, then its mirror image.
        let rate = 10.0_f64.sqrt();
        let (mut low, mut high) = (0.0, 0.5);
        let before = |t: f64| 1.0 - 0.5 * (rate * t).cos() - 5.0 / rate * (rate * t).sin();
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            (low, high) = if before(middle) > 0.0 { (middle, high) } else { (low, middle) };
        }
        let speed = (0.5 * rate * (rate * low).sin() - 5.0 * (rate * low).cos()).abs();
        let since = rate * (0.5 - low);
        -1.0 + since.cos() - speed / rate * since.sin()
    };
    for start in [0.0, 1e3, 1e6, 1e9] {
        within(
            &format!("through the anchor of a spring at {start:e} s: place [m]"),
            through_anchor(start) - expected,
            // A time held as two numbers is read as one.
            1e-8 + 5.0 * f64::EPSILON * start,
        );
    }
}
