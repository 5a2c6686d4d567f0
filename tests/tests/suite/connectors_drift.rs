//! Mechanisms neither come apart nor change their energy, however long they run.

use halfgap::geometry::DVec2;
use halfgap::{Anchor, BodyId, ConnectorKind, Integrator, Stabilization, World, WorldBuilder, WorldSettings};
use halfgap_tests::mechanism::{Workshop, advance, at_rest, connector_error, disc, pendulum_period};
use halfgap_tests::reference_scene;
use std::f64::consts::TAU;

const WORLD: BodyId = BodyId::WORLD;

/// Runs a world in pieces, and returns the largest connector error [m] and the largest change of energy [J] met.
fn drift(world: &mut World, until: f64) -> (f64, f64) {
    let start = world.energy().total();
    let (mut error, mut change) = (0.0f64, 0.0f64);
    for piece in 1..=1000 {
        advance(world, until * f64::from(piece) / 1000.0);
        error = error.max(connector_error(world));
        change = change.max((world.energy().total() - start).abs());
    }
    let seen = world.statistics().largest_connector_error.expect("there are connectors");
    (error.max(seen), change)
}

#[test]
fn a_pendulum_holds_together_and_keeps_its_energy_for_a_thousand_seconds() {
    let mut scene = reference_scene("exact__pendulum");
    scene.set_tolerance(1e-10, "tolerance").expect("a fine tolerance");
    let mut world = World::from_scene(&scene).expect("a fine scene");
    let energy = world.energy().total();
    let (error, change) = drift(&mut world, 1000.0);
    println!("pendulum: connector {error:e} m, energy {:e}, {:?}", change / energy, world.statistics());
    assert!(error <= 1e-10, "{error} m");
    assert!(change <= 1e-8 * energy, "{change} J of {energy} J");
}

/// Intersection of two circles about two points, to the left of the way from one to the other.
fn meeting(a: DVec2, radius_a: f64, b: DVec2, radius_b: f64) -> DVec2 {
    let along = (b - a).normalize();
    let distance = (b - a).length();
    let x = (distance * distance + radius_a * radius_a - radius_b * radius_b) / (2.0 * distance);
    a + along * x + along.perp() * (radius_a * radius_a - x * x).sqrt()
}

#[test]
fn a_four_bar_linkage_holds_together_and_keeps_its_energy_for_a_thousand_seconds() {
    let (ground_a, ground_b) = (DVec2::ZERO, DVec2::new(3.0, 0.0));
    let crank_end = DVec2::new(0.0, 1.0);
    let rocker_end = meeting(crank_end, 3.0, ground_b, 2.5);
    let mut shop = Workshop::new(1e-10);
    let crank = shop.bar("crank", ground_a, crank_end);
    let coupler = shop.bar("coupler", crank_end, rocker_end);
    let rocker = shop.bar("rocker", ground_b, rocker_end);
    shop.pin(WORLD, crank, ground_a);
    shop.pin(crank, coupler, crank_end);
    shop.pin(coupler, rocker, rocker_end);
    shop.pin(WORLD, rocker, ground_b);

    shop.builder.let_pass(crank, rocker);
    let mut world = shop.build();
    let energy = world.energy().total();
    let (error, change) = drift(&mut world, 1000.0);
    println!("four-bar: connector {error:e} m, energy {:e}, {:?}", change / energy, world.statistics());
    assert!(error <= 1e-10, "{error} m");
    assert!(change <= 1e-8 * energy, "{change} J of {energy} J");
    assert!(world.state(crank).angle.abs() > TAU, "the crank turns round: {}", world.state(crank).angle);
}

#[test]
fn parallel_bars_swing_as_one_pendulum_although_one_of_them_is_too_many() {
    // Three bars of 1 m carry a plate: two would keep it level, the third is redundant.
    let tilt = DVec2::from_angle(-0.9);
    let mut shop = Workshop::new(1e-10);
    let tops = [0.0, 1.0, 2.0].map(|x| DVec2::new(x, 0.0));
    let plate = shop.bar("plate", tops[0] + tilt, tops[2] + tilt);
    for (index, top) in tops.into_iter().enumerate() {
        let bar = shop.bar(&format!("bar {index}"), top, top + tilt);
        shop.pin(WORLD, bar, top);
        shop.pin(bar, plate, top + tilt);
        shop.builder.let_pass(bar, plate);
    }
    let mut world = shop.build();
    let start: Vec<_> = world.bodies().map(|body| world.state(body)).collect();
    // About its top a bar has m l^2/3 + m h^2/12, the plate m l^2; gravity pulls on half of l for each bar.
    let moment: f64 = 1.0 + 3.0 * (1.0 / 3.0 + 0.01 / 12.0);
    let rate = (10.0 * (1.0 + 3.0 * 0.5) / moment).sqrt();
    let period = pendulum_period(rate, std::f64::consts::FRAC_PI_2 - 0.9);
    let (error, change) = drift(&mut world, 10.0 * period);
    assert!(error < 1e-10, "{error} m");
    assert!(change < 1e-8 * world.energy().total().abs(), "{change} J");
    for (body, start) in world.bodies().zip(start) {
        let off = (world.state(body).position - start.position).length();
        assert!(off < 1e-8, "{}: {off} m from where it was ten swings ago", world.name(body));
    }
}

#[test]
fn a_body_on_three_pins_stays_and_its_pins_carry_its_weight() {
    let mut shop = Workshop::new(1e-9);
    let places = [DVec2::new(-1.0, 0.0), DVec2::new(0.0, 0.0), DVec2::new(1.0, 0.0)];
    let beam = shop.bar("beam", places[0], places[2]);
    for place in places {
        shop.pin(WORLD, beam, place);
    }
    let mut world = shop.build();
    advance(&mut world, 100.0);
    assert!(world.state(beam).position.length() < 1e-13, "{}", world.state(beam).position);
    assert!(world.state(beam).angle.abs() < 1e-13);
    let on_beam = |row: &halfgap::ContactForce| if row.bodies[0] == beam { row.force } else { -row.force };
    let total: DVec2 = world.contact_forces().iter().map(|row| on_beam(row) * row.normal).sum();
    assert!((total - DVec2::new(0.0, 10.0)).length() < 1e-11, "{total} N");
    assert!(world.statistics().steps < 100, "{} steps at rest", world.statistics().steps);
}

#[test]
fn the_older_remedies_against_drift_still_work() {
    let error = |stabilization, joint_small_impacts| {
        let settings = WorldSettings {
            stabilization,
            joint_small_impacts,
            integrator: Integrator::Rk4,
            time_step: Some(0.02),
            ..WorldSettings::default()
        };
        let mut shop = Workshop::new(1e-8);
        shop.builder = WorldBuilder::new(settings);
        let bob = shop.body("bob", disc(0.25), 1.0, at_rest(1.0, 0.0));
        let ends = [WORLD, bob].map(|body| Anchor { body, point: DVec2::ZERO });
        shop.connect(ConnectorKind::Rod { a: ends[0], b: ends[1], length: 1.0 }, 0.0);
        let mut world = shop.build();
        drift(&mut world, 100.0).0
    };
    let bare = error(Stabilization::None, false);
    assert!(bare > 1e-3, "{bare} m without any");
    let remedies = [
        (Stabilization::Velocity, false),
        (Stabilization::VelocityJoints, false),
        (Stabilization::VelocityAndDistance, false),
        (Stabilization::VelocityAndDistanceJoints, false),
        (Stabilization::None, true),
    ];
    for (stabilization, joint_small_impacts) in remedies {
        let left = error(stabilization, joint_small_impacts);
        assert!(left < 1e-2 * bare, "{stabilization:?}: {left} m of {bare} m");
    }
}
