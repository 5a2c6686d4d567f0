//! Bodies whose events accumulate go on by steps, as long as that lasts, and by events afterwards.

use halfgap::World;
use halfgap::geometry::DVec2;
use halfgap::scene::Scene;
use halfgap_tests::data;
use halfgap_tests::mechanism::{Workshop, at_rest, block, disc};
use std::fmt::Write;
use std::ops::ControlFlow;

/// Events in which the pile must be over, those included that are not reported; one by one there are more than 300,000 before
/// its end.
const MOST_EVENTS: u64 = 200_000;
/// Part of the energy in play that the books may lack [-].
const BOOKS: f64 = 1e-9;
/// Radius [m] of the discs of the pile.
const RADIUS: f64 = 0.3;
/// Overlap of discs in a step as a part of their radius [-].
const OVERLAP: f64 = 1e-3;

fn pile() -> Scene {
    Scene::read(data("faults/pile100.toml")).expect("a fine scene")
}

fn world_of(scene: &Scene) -> World {
    World::from_scene(scene).expect("a fine scene")
}

/// Advances a world to a time, or fails after too many events.
fn advance(world: &mut World, time: f64) {
    let outcome = world.advance_for(time, MOST_EVENTS, &mut |_| ());
    assert_eq!(outcome.expect("it can go on"), ControlFlow::Continue(()), "at {} s", world.time());
}

fn states(world: &World) -> String {
    let mut told = String::new();
    for body in world.bodies() {
        writeln!(told, "{:?}", world.state(body)).expect("a string has room");
    }
    told
}

#[test]
fn a_hundred_discs_settle_with_closed_books() {
    let scene = pile();
    let mut world = world_of(&scene);
    let start = world.energy().total();
    for frame in 1..=120 {
        advance(&mut world, f64::from(frame) / 60.0);
        let error = world.ledger().integration_error();
        assert!(error.abs() < BOOKS * start, "{error} J at {} s", world.time());
        let discs: Vec<_> = world.bodies().filter(|&body| !world.is_fixed(body)).collect();
        for (index, &a) in discs.iter().enumerate() {
            for &b in &discs[..index] {
                let apart = world.state(a).position.distance(world.state(b).position);
                assert!(apart > (2.0 - OVERLAP) * RADIUS, "{apart} m at {} s", world.time());
            }
        }
    }
    let energy = world.energy();
    assert!(world.statistics().region_steps > 0);
    assert!(world.ledger().steps < 0.0, "steps take energy, as impacts do");
    // One by one, the events leave it 1423 J at 1.9 s, of which 5.5 J are kinetic.
    assert!(energy.total() < 0.28 * start && energy.kinetic < 0.01 * start, "{energy:?}");
    let findings = world.findings(start);
    assert!(findings.is_empty(), "{findings:?}");
}

#[test]
fn steps_do_not_depend_on_when_a_run_stops_or_is_saved() {
    let scene = pile();
    let (mut once, mut often, mut saved) = (world_of(&scene), world_of(&scene), world_of(&scene));
    let end = 1.4;
    advance(&mut once, end);
    for stop in 0..=140 {
        advance(&mut often, f64::from(stop) / 100.0);
    }
    for time in [1.1, 1.2, 1.3, end] {
        advance(&mut saved, time);
        saved = World::load(&saved.save().expect("it has no laws of its own")).expect("sound bytes");
    }
    assert!(once.statistics().region_steps > 0);
    assert_eq!(states(&once), states(&often));
    assert_eq!(states(&once), states(&saved));
}

#[test]
fn a_ball_that_bounces_hundreds_of_times_is_followed_bounce_by_bounce() {
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(10.0, 1.0), DVec2::new(0.0, -0.5));
    shop.settler("ball", disc(0.5), 1.0, at_rest(0.0, 0.7), 0.97);
    let mut world = shop.build();
    advance(&mut world, 20.0);
    let statistics = world.statistics();
    assert!(statistics.impacts > 300, "{} impacts", statistics.impacts);
    assert_eq!(statistics.region_steps, 0);
}
