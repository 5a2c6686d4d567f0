//! Slots whose normals turn, rods, ropes that go taut, rails: against closed forms and conserved quantities.

use halfgap::force::Spring;
use halfgap::geometry::{DVec2, EdgeSpec};
use halfgap::{Anchor, BodyId, ConnectorKind, RailPath, SlotFrame, World};
use halfgap_tests::mechanism::{
    GRAVITY, Workshop, advance, at_rest, block, connector_error, disc, pendulum_period, thrown,
};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

const WORLD: BodyId = BodyId::WORLD;

fn center(body: BodyId) -> Anchor {
    Anchor { body, point: DVec2::ZERO }
}

/// Angular momentum of all bodies about the origin [kg m^2/s].
fn angular_momentum(world: &World) -> f64 {
    let of = |body: BodyId| {
        let (state, inertia) = (world.state(body), world.inertia(body)?);
        Some(inertia.mass * state.position.perp_dot(state.velocity) + inertia.moment * state.angular_velocity)
    };
    world.bodies().filter_map(of).sum()
}

/// A bead in a slot of a plate that turns about a pin, on a spring to the pin.
fn bead_in_a_turning_slot(frame: SlotFrame) -> World {
    let mut shop = Workshop::weightless(1e-11);
    let plate = shop.body("plate", block(4.0, 4.0), 2.0, at_rest(0.0, 0.0));
    let bead = shop.body("bead", disc(0.2), 1.0, thrown(1.0, 0.25, DVec2::new(0.0, 2.0)));
    shop.builder.let_pass(plate, bead);
    shop.pin(WORLD, plate, DVec2::ZERO);
    // The slot runs along the plate's x-axis, beside its centre.
    let (on_plate, normal) = (Anchor { body: plate, point: DVec2::new(0.0, 0.25) }, DVec2::Y);
    let kind = match frame {
        SlotFrame::A => ConnectorKind::Slot { a: on_plate, b: center(bead), normal, frame },
        _ => ConnectorKind::Slot { a: center(bead), b: on_plate, normal, frame },
    };
    shop.connect(kind, 0.0);
    let spring = Spring::new("spring", [center(WORLD), center(bead)], 0.0, 5.0);
    shop.builder.add_force(Arc::new(spring));
    shop.build()
}

#[test]
fn a_slot_that_turns_with_a_body_does_not_drift() {
    for frame in [SlotFrame::A, SlotFrame::B] {
        let mut world = bead_in_a_turning_slot(frame);
        let (energy, momentum) = (world.energy().total(), angular_momentum(&world));
        let mut error = 0.0f64;
        for piece in 1..=1000 {
            advance(&mut world, 0.1 * f64::from(piece));
            error = error.max(connector_error(&world));
        }
        println!(
            "{frame:?}: {error:e} m, energy {:e}, momentum {:e}",
            world.energy().total() / energy - 1.0,
            angular_momentum(&world) / momentum - 1.0
        );
        assert!(error < 1e-9, "{frame:?}: {error} m");
        assert!((world.energy().total() / energy - 1.0).abs() < 1e-9, "{frame:?}: energy");
        assert!((angular_momentum(&world) / momentum - 1.0).abs() < 1e-9, "{frame:?}: angular momentum");
        let plate = world.find("plate").expect("it is there");
        assert!(world.state(plate).angle.abs() > TAU, "the slot turns: {}", world.state(plate).angle);
    }
}

#[test]
fn a_disc_on_a_rod_is_a_pendulum() {
    let (length, amplitude) = (1.25, 2.0);
    let mut shop = Workshop::new(1e-11);
    let place = DVec2::from_angle(amplitude - FRAC_PI_2) * length;
    let bob = shop.body("bob", disc(0.25), 3.0, at_rest(place.x, place.y));
    shop.connect(ConnectorKind::Rod { a: center(WORLD), b: center(bob), length }, 0.0);
    let mut world = shop.build();
    let period = pendulum_period((GRAVITY / length).sqrt(), amplitude);
    advance(&mut world, 9.5 * period);
    let there = (world.state(bob).position - DVec2::new(-place.x, place.y)).length();
    assert!(there < 1e-9, "{there} m from the other side after nine and a half swings");
    advance(&mut world, 10.0 * period);
    let back = (world.state(bob).position - place).length();
    assert!(back < 1e-9, "{back} m from the start after ten swings");
    assert!(connector_error(&world) < 1e-13);
}

#[test]
fn a_rope_goes_taut_in_flight_takes_the_speed_along_it_and_hangs() {
    let mut shop = Workshop::new(1e-10);
    let bob = shop.body("bob", disc(0.1), 2.0, at_rest(0.6, 0.0));
    shop.connect(ConnectorKind::Rope { a: center(WORLD), b: center(bob), length: 1.0 }, 0.0);
    let mut world = shop.build();
    // The bob falls 0.8 m until the rope is taut, and keeps the part of its speed across the rope.
    let taut = (2.0 * 0.8 / GRAVITY).sqrt();
    let mut times = Vec::new();
    world.advance_to(2.0 * taut, &mut |event| times.push(event.time())).expect("it goes taut");
    assert!((times[0] - taut).abs() < 1e-10, "taut at {} s, not at {taut} s", times[0]);
    let speed = (2.0 * GRAVITY * 0.8f64).sqrt();
    let left = 0.5 * 2.0 * (0.6 * speed).powi(2) - 2.0 * GRAVITY * 0.8;
    assert!((world.energy().total() - left).abs() < 1e-8, "{} J, not {left} J", world.energy().total());
    let ledger = world.ledger();
    assert!((ledger.impacts + 0.5 * 2.0 * (0.8 * speed).powi(2)).abs() < 1e-8, "{ledger:?}");
    let mut highest = f64::NEG_INFINITY;
    for piece in 0..2000 {
        advance(&mut world, 2.0 * taut + 0.01 * f64::from(piece));
        highest = highest.max(world.state(bob).position.y);
        assert!((world.state(bob).position.length() - 1.0).abs() < 1e-10, "at {} s", world.time());
    }
    // All of its energy is height at the ends of its swing.
    let top = left / (2.0 * GRAVITY);
    assert!(highest < top + 1e-9 && highest > top - 1e-3, "as high as {highest} m, not {top} m");
    assert!((world.energy().total() - left).abs() < 1e-8, "{} J", world.energy().total());
    assert_eq!(world.statistics().impacts, 1, "taut, it stays so");
}

#[test]
fn an_elastic_rope_gives_the_speed_back() {
    let mut shop = Workshop::new(1e-10);
    let bob = shop.body("bob", disc(0.1), 2.0, at_rest(0.0, -0.2));
    shop.connect(ConnectorKind::Rope { a: center(WORLD), b: center(bob), length: 1.0 }, 1.0);
    let mut world = shop.build();
    let fall = (2.0 * 0.8 / GRAVITY).sqrt();
    // The bob rises again to its first height, over and over.
    for bounce in 1..=20 {
        advance(&mut world, 2.0 * fall * f64::from(bounce));
        let off = (world.state(bob).position - DVec2::new(0.0, -0.2)).length();
        assert!(off < 1e-9, "{off} m off after {bounce} bounces");
    }
    assert_eq!(world.statistics().impacts, 20);
}

#[test]
fn a_rope_that_hangs_pulls_with_the_weight_and_costs_nothing() {
    let mut shop = Workshop::new(1e-9);
    let bob = shop.body("bob", disc(0.1), 2.0, at_rest(0.0, -1.0));
    shop.connect(ConnectorKind::Rope { a: center(WORLD), b: center(bob), length: 1.0 }, 1.0);
    let mut world = shop.build();
    advance(&mut world, 100.0);
    let forces = world.contact_forces();
    assert!(forces.len() == 1 && (forces[0].force - 20.0).abs() < 1e-11, "{forces:?}");
    assert!((world.state(bob).position - DVec2::new(0.0, -1.0)).length() < 1e-9);
    assert!(world.statistics().steps < 100, "{} steps", world.statistics().steps);
}

/// An upright track of two straights and two half circles.
fn stadium(half_length: f64, radius: f64) -> Arc<RailPath> {
    let (l, r) = (half_length, radius);
    let bulge = |x, y| EdgeSpec::Bulge { to: DVec2::new(x, y), bulge: 1.0 };
    let line = |x, y| EdgeSpec::Line { to: DVec2::new(x, y) };
    let edges = [line(l, -r), bulge(l, r), line(-l, r), bulge(-l, -r)];
    Arc::new(RailPath::from_edges(DVec2::new(-l, -r), &edges).expect("a fine track"))
}

#[test]
fn a_bead_on_a_stadium_rail_keeps_its_energy_for_a_hundred_seconds() {
    let mut shop = Workshop::new(1e-10);
    let bead = shop.body("bead", disc(0.1), 1.0, thrown(0.0, -1.0, DVec2::new(8.0, 0.0)));
    shop.connect(ConnectorKind::Rail { a: center(bead), path: stadium(1.5, 1.0) }, 0.0);
    let mut world = shop.build();
    let energy = world.energy().total();
    let (mut change, mut error) = (0.0f64, 0.0f64);
    for piece in 1..=1000 {
        advance(&mut world, 0.1 * f64::from(piece));
        change = change.max((world.energy().total() / energy - 1.0).abs());
        error = error.max(connector_error(&world));
    }
    println!("stadium rail: energy {change:e}, off {error:e} m, {:?}", world.statistics());
    assert!(change < 1e-8, "{change}");
    assert!(error < 1e-10, "{error} m");
}

#[test]
fn a_bead_goes_round_a_stadium_rail_in_the_time_that_its_speed_tells() {
    // Where nothing falls the speed is constant.
    let mut shop = Workshop::weightless(1e-10);
    let bead = shop.body("bead", disc(0.1), 1.0, thrown(0.0, -1.0, DVec2::new(2.0, 0.0)));
    shop.connect(ConnectorKind::Rail { a: center(bead), path: stadium(1.5, 1.0) }, 0.0);
    let mut world = shop.build();
    let round = (6.0 + TAU) / 2.0;
    advance(&mut world, 20.0 * round);
    let off = (world.state(bead).position - DVec2::new(0.0, -1.0)).length();
    assert!(off < 1e-8, "{off} m off after twenty rounds");
    advance(&mut world, 20.25 * round);
    let quarter = 0.25 * (6.0 + TAU) - 1.5;
    let expected = DVec2::new(1.5, 0.0) + DVec2::from_angle(quarter - 0.5 * PI);
    let off = (world.state(bead).position - expected).length();
    assert!(off < 1e-8, "{off} m off after a quarter more");
}
