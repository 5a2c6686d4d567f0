//! Events inside long steps: their time and their gap are right to the tolerance, not to that of dense output.

use super::within;
use halfgap::geometry::DVec2;
use halfgap::{Anchor, BodyId, ConnectorKind, Event, Impact, ToleranceOverrides, World, WorldSettings};
use halfgap_tests::mechanism::{GRAVITY, Workshop, at_rest, block, disc, pendulum_period};
use std::f64::consts::FRAC_PI_2;

const LENGTH: f64 = 1.0;
const AMPLITUDE: f64 = 2.0;
const RADIUS: f64 = 0.25;
/// Far less than what dense output errs by at the tolerance of the tests.
const GAP: f64 = 1e-12;

/// A pendulum let go at its amplitude that just meets a wall where it hangs straight down.
fn pendulum_and_wall(tolerance: f64) -> World {
    let overrides = ToleranceOverrides { target_gap: Some(GAP), ..ToleranceOverrides::default() };
    let mut shop = Workshop::new(tolerance);
    shop.builder =
        halfgap::WorldBuilder::new(WorldSettings { tolerance, overrides, ..WorldSettings::default() });
    shop.fixed("wall", block(1.0, 1.0), DVec2::new(-0.5 - RADIUS - GAP, -LENGTH));
    let place = LENGTH * DVec2::from_angle(AMPLITUDE - FRAC_PI_2);
    let bob = shop.body("bob", disc(RADIUS), 1.0, at_rest(place.x, place.y));
    let ends = [BodyId::WORLD, bob].map(|body| Anchor { body, point: DVec2::ZERO });
    shop.connect(ConnectorKind::Rod { a: ends[0], b: ends[1], length: LENGTH }, 0.0);
    shop.build()
}

/// The impacts up to a time.
fn impacts(world: &mut World, until: f64) -> Vec<Impact> {
    let mut impacts = Vec::new();
    world
        .advance_to(until, &mut |event| {
            if let Event::Impact(impact) = event {
                impacts.push(impact.clone());
            }
        })
        .unwrap_or_else(|error| panic!("{error}"));
    impacts
}

#[test]
fn a_pendulum_hits_a_wall_at_its_time_and_its_gap() {
    let quarter = 0.25 * pendulum_period((GRAVITY / LENGTH).sqrt(), AMPLITUDE);
    let speed = (2.0 * GRAVITY * LENGTH * (1.0 - AMPLITUDE.cos())).sqrt();
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let mut world = pendulum_and_wall(tolerance);
        let (bob, wall) = (world.find("bob").expect("it is there"), world.find("wall").expect("it is there"));
        for (index, impact) in impacts(&mut world, 10.0 * quarter).iter().enumerate() {
            let row = impact.rows.iter().find(|row| (row.primary, row.normal_body) == (bob, wall));
            let row = row.expect("it is the wall that is hit");
            let what =
                |quantity: &str| format!("pendulum on a wall at {tolerance:.0e}, hit {index}: {quantity}");
            let due = quarter * f64::from(2 * u32::try_from(index).expect("a few") + 1);
            within(&what("gap [m]"), row.gap - GAP, 1e-2 * GAP);
            within(&what("time [s]"), impact.time - due, tolerance);
            within(&what("speed [m/s]"), row.velocity_before.abs() - speed, tolerance);
        }
    }
}
