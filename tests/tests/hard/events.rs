//! Events inside long steps: their time and their gap are right to the tolerance, not to that of dense output.

use super::within;
use halfgap::force::{ForceLaw, Snapshot, Wrenches};
use halfgap::geometry::{DVec2, Shape};
use halfgap::{Anchor, BodyId, ConnectorKind, Event, Impact, ToleranceOverrides, World, WorldSettings};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc, pendulum_period, thrown};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

const LENGTH: f64 = 1.0;
const AMPLITUDE: f64 = 2.0;
const RADIUS: f64 = 0.25;
/// Target gap [m], far less than the error of dense output at the tolerances of the tests.
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

/// The impacts up to a time [s].
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
        let hits = impacts(&mut world, 10.0 * quarter);
        assert_eq!(hits.len(), 5, "one in each half period");
        for (index, impact) in hits.iter().enumerate() {
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

/// A force law without force that changes branch again and again.
#[derive(Debug)]
struct Clock {
    bodies: [BodyId; 1],
    /// Time [s] between two changes.
    tick: f64,
}

impl ForceLaw for Clock {
    fn name(&self) -> &str {
        "clock"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn apply(&self, _now: &Snapshot<'_>, _wrenches: &mut Wrenches<'_>) {}

    fn potential(&self, _now: &Snapshot<'_>) -> Option<f64> {
        Some(0.0)
    }

    fn switches(&self) -> usize {
        1
    }

    fn switch(&self, _index: usize, now: &Snapshot<'_>) -> f64 {
        (PI * now.time / self.tick).sin()
    }
}

#[test]
fn a_pendulum_that_is_cut_in_every_step_is_as_exact_as_one_that_is_not() {
    let period = pendulum_period((GRAVITY / LENGTH).sqrt(), AMPLITUDE);
    let tolerance = 1e-8;
    let error = |tick: Option<f64>| {
        let mut shop = Workshop::new(tolerance);
        let place = LENGTH * DVec2::from_angle(AMPLITUDE - FRAC_PI_2);
        let bob = shop.body("bob", disc(RADIUS), 1.0, at_rest(place.x, place.y));
        let ends = [BodyId::WORLD, bob].map(|body| Anchor { body, point: DVec2::ZERO });
        shop.connect(ConnectorKind::Rod { a: ends[0], b: ends[1], length: LENGTH }, 0.0);
        if let Some(tick) = tick {
            shop.builder.add_force(Arc::new(Clock { bodies: [bob], tick }));
        }
        let mut world = shop.build();
        // The pendulum is fastest where it hangs straight down.
        advance(&mut world, 4.25 * period);
        let ticks = tick.map_or(0, |tick| (world.time() / tick) as u64);
        assert!(world.statistics().backups >= ticks, "{:?}", world.statistics());
        (world.state(bob).position - DVec2::new(0.0, -LENGTH)).length()
    };
    let whole = error(None);
    for tick in [0.017, 0.031, 0.047] {
        let cut = error(Some(tick));
        within(&format!("pendulum cut every {tick} s: place [m]"), cut, whole);
    }
}

/// A cord that pulls a body towards the origin when it is stretched.
#[derive(Debug)]
struct Cord {
    bodies: [BodyId; 1],
    /// Length without force [m].
    length: f64,
    /// Force over stretch [N/m].
    stiffness: f64,
}

impl Cord {
    fn stretch(&self, now: &Snapshot<'_>) -> f64 {
        now.body(self.bodies[0]).pose.position.length() - self.length
    }
}

impl ForceLaw for Cord {
    fn name(&self) -> &str {
        "cord"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        let pull = -self.stiffness * self.stretch(now).max(0.0);
        let along = now.body(self.bodies[0]).pose.position.normalize_or_zero();
        wrenches.add_force(self.bodies[0], pull * along, DVec2::ZERO);
    }

    fn potential(&self, now: &Snapshot<'_>) -> Option<f64> {
        Some(0.5 * self.stiffness * self.stretch(now).max(0.0).powi(2))
    }

    fn switches(&self) -> usize {
        1
    }

    fn switch(&self, _index: usize, now: &Snapshot<'_>) -> f64 {
        self.stretch(now)
    }
}

#[test]
fn a_law_changes_branch_at_its_moment() {
    let (length, stiffness, speed, mass) = (1.0, 25.0, 2.0, 1.0f64);
    let mut shop = Workshop::weightless(1e-10);
    let ball = shop.body("ball", disc(0.1), mass, thrown(0.0, 0.0, DVec2::new(speed, 0.0)));
    shop.builder.add_force(Arc::new(Cord { bodies: [ball], length, stiffness }));
    let mut world = shop.build();
    // The cord is slack for 2 l/v and taut for half a period: to and fro through the origin.
    let round = 4.0 * length / speed + 2.0 * PI * (mass / stiffness).sqrt();
    for rounds in 1..=10 {
        advance(&mut world, f64::from(rounds) * round);
        within(
            &format!("ball on a cord, round {rounds}: place [m]"),
            world.state(ball).position.length(),
            3e-10,
        );
    }
    let ledger = world.ledger();
    within("ball on a cord: energy [J]", ledger.integration_error(), 1e-9);
}

/// A force of 1 N along x from a given time on; `is_there_at_once` includes that moment itself.
#[derive(Debug)]
struct Push {
    bodies: [BodyId; 1],
    /// Time [s] at which the force begins.
    from: f64,
    is_there_at_once: bool,
}

impl ForceLaw for Push {
    fn name(&self) -> &str {
        "push"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.bodies
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        if now.time > self.from || (self.is_there_at_once && now.time == self.from) {
            wrenches.add_force(self.bodies[0], DVec2::X, DVec2::ZERO);
        }
    }

    fn switches(&self) -> usize {
        1
    }

    fn switch(&self, _index: usize, now: &Snapshot<'_>) -> f64 {
        now.time - self.from
    }
}

/// A ball at rest begins to move within digits of the clock: nothing that it does before shows how long a step may be.
#[test]
fn a_push_begins_at_its_moment_whichever_branch_has_it_and_whatever_the_clock_says() {
    for start_time in [0.0, 1e3, 1e6] {
        for is_there_at_once in [false, true] {
            let mut worst = 0.0f64;
            for index in 0..100 {
                let from = start_time + 0.1 + 0.007 * f64::from(index);
                let settings = WorldSettings {
                    tolerance: 1e-10,
                    start_time,
                    duration: Some(1.0),
                    ..WorldSettings::default()
                };
                let mut shop = Workshop::weightless(1e-10);
                shop.builder = halfgap::WorldBuilder::new(settings);
                let ball = shop.body("ball", disc(0.1), 1.0, at_rest(0.0, 0.0));
                shop.builder.add_force(Arc::new(Push { bodies: [ball], from, is_there_at_once }));
                let mut world = shop.build();
                advance(&mut world, start_time + 1.0);
                let gained = world.state(ball).velocity.x;
                worst = worst.max((gained - (start_time + 1.0 - from)).abs());
            }
            let what = format!(
                "push on what rests, clock at {start_time:e} s, at once: {is_there_at_once}: speed [m/s]"
            );
            within(&what, worst, 1e-9 + 8.0 * f64::EPSILON * start_time);
        }
    }
}

/// Distance [m] by which a disc that slides in a bowl comes nearer to it than its target gap, inside of steps.
fn nearer_inside_of_steps(tolerance: f64, gap: f64) -> (f64, f64) {
    let overrides = ToleranceOverrides { target_gap: Some(gap), ..ToleranceOverrides::default() };
    let mut shop = Workshop::new(tolerance);
    shop.builder =
        halfgap::WorldBuilder::new(WorldSettings { tolerance, overrides, ..WorldSettings::default() });
    shop.fixed("bowl", Shape::ring(4.0, 3.0).expect("a fine ring"), DVec2::ZERO);
    let place = (2.5 - gap) * DVec2::from_angle(-0.1);
    let ball = shop.dull("ball", disc(0.5), 1.0, at_rest(place.x, place.y));
    let mut world = shop.build();
    let mut least = f64::INFINITY;
    for piece in 1..=2000 {
        advance(&mut world, 2e-3 * f64::from(piece));
        least = least.min(2.5 - world.state(ball).position.length());
    }
    (gap - least, world.tolerances().accuracy)
}

#[test]
fn a_disc_in_a_bowl_keeps_its_distance_inside_of_long_steps() {
    for (tolerance, gap) in [(1e-3, 1e-6), (1e-4, 1e-6), (1e-5, 1e-7), (1e-6, 1e-7)] {
        let (nearer, accuracy) = nearer_inside_of_steps(tolerance, gap);
        within(&format!("disc in a bowl at {tolerance:.0e}, inside of steps: gap [m]"), nearer, accuracy);
    }
}
