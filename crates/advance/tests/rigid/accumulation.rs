//! Accumulations: a light disc between two heavy ones that close in on it is hit faster and faster.

use crate::box_of_bodies::*;
use glam::DVec2;
use halfgap_advance::rigid::{RigidParts, RigidSettings, RigidSystem};
use halfgap_advance::{Time, advance_until};

/// Time [s] at which the run ends.
const END: f64 = 2.0;
/// Speeds [m/s] of the light disc: slower than the heavy discs that close in on it, or much faster.
const SLOW: f64 = 0.3;
const FAST: f64 = 30.0;

/// Two discs of 1 kg that close in on a third with a larger inverse mass [1/kg], a distance [m] from each of them,
/// which moves at a speed [m/s].
fn vise(resolution_time: f64, lighter: f64, room: f64, speed: f64) -> RigidSystem {
    let mut light = body(&disc(0.1), moving(DVec2::ZERO, DVec2::new(speed, 0.0), 0.0));
    (light.body.inverse_mass, light.body.inverse_moment) = (lighter, 100.0 * lighter);
    let heavy = |side: f64| {
        let state = moving(DVec2::new((0.6 + room) * side, 0.0), DVec2::new(-side, 0.0), 0.0);
        let mut part = body(&disc(0.5), state);
        (part.body.inverse_mass, part.body.inverse_moment) = (1.0, 1.0);
        part
    };
    let settings = RigidSettings { resolution_time, ..SETTINGS };
    let bodies = vec![heavy(-1.0), light, heavy(1.0)];
    let parts = RigidParts { bodies, ..RigidParts::default() };
    RigidSystem::new(parts, settings, Time::ZERO).expect("nothing touches")
}

fn momentum(system: &RigidSystem, time: f64) -> f64 {
    let of = |body| {
        let trajectory = system.trajectory(body);
        trajectory.state_at(Time::from_seconds(time)).velocity.x / trajectory.body().inverse_mass
    };
    bodies(system).map(of).sum()
}

/// Lets a system run to the end without an accumulation: with more than `impacts` impacts, and all energy kept.
fn goes_on_elastically(system: &mut RigidSystem, impacts: u64) {
    let before = energy(system, 0.0);
    advance(system, END).expect("they part again");
    let counts = system.counts();
    assert!(counts.impacts > impacts, "{counts:?}");
    assert_eq!(counts.accumulations, 0);
    assert!((energy(system, END) / before - 1.0).abs() < 1e-12);
}

#[test]
fn a_motion_that_forces_can_resolve_is_no_accumulation_however_many_impacts_there_are() {
    let mut system = vise(1e-10, 1e4, 0.5, SLOW);
    goes_on_elastically(&mut system, 150);
    assert_eq!(system.ledger_at(Time::from_seconds(END)).captures, 0.0);
}

/// Lets a light disc be crushed within the resolution time: exactly the first `calm` impacts are elastic.
fn ends_after(calm: usize, lighter: f64, room: f64, speed: f64) {
    let mut system = vise(2.0 * END, lighter, room, speed);
    let (energy_before, momentum_before) = (energy(&system, 0.0), momentum(&system, 0.0));
    let mut rates = Vec::new();
    advance_until(&mut system, Time::from_seconds(END), |system, _| {
        rates.extend(system.last_impact().rows.first().map(|row| (row.rate_before, row.rate_after)));
    })
    .expect("it ends");
    for (index, (before, after)) in rates[..calm].iter().enumerate() {
        assert!((after + before).abs() < 1e-12 * after, "impact {index} from {before} to {after} m/s");
    }
    let (before, after) = rates[calm];
    assert!(before < -1.0 && after.abs() < 1e-12 * -before, "from {before} to {after} m/s");
    // After that the light disc lies on a heavy one, and the other drives both back.
    assert!(rates.len() < calm + 20, "{} impacts", rates.len());
    assert_eq!(system.counts().accumulations, 1);
    // The energy lost is just that of the inelastic impact: nearly m/2 times the square of its closing speed.
    let ledger = system.ledger_at(Time::from_seconds(END));
    let lost = 0.5 * before * before / (lighter + 1.0);
    assert!((ledger.captures + lost).abs() < 1e-12, "{ledger:?}, {lost} J");
    let change = energy(&system, END) - energy_before;
    assert!((change - ledger.captures - ledger.impacts).abs() < 1e-12, "{change} J, {ledger:?}");
    assert!((momentum(&system, END) - momentum_before).abs() < 1e-12);
    assert!(system.counts().smallest_gap.is_some_and(|gap| gap > 0.3 * TOLERANCES.target_gap));
}

#[test]
fn one_impact_more_than_a_row_may_have_in_the_resolution_time_is_without_elasticity() {
    // A region of one row may have twenty events, and ten more for that row.
    ends_after(30, 1e10, 4.0 * TOLERANCES.target_gap, FAST);
}

#[test]
fn a_disc_that_goes_far_between_its_impacts_may_have_fifty_times_as_many() {
    ends_after(1500, 1e10, 0.5, SLOW);
}

#[test]
fn costly_impacts_may_be_fifty_times_as_many_though_the_disc_goes_nowhere() {
    let mut system = vise(2.0 * END, 1e4, 4.0 * TOLERANCES.target_gap, FAST);
    goes_on_elastically(&mut system, 100);
}

#[test]
fn costly_impacts_far_apart_may_be_a_hundred_times_as_many_again() {
    let mut system = vise(2.0 * END, 1e8, 0.5, SLOW);
    let before = energy(&system, 0.0);
    advance(&mut system, END).expect("they part again");
    let counts = system.counts();
    assert!(counts.impacts > 10_000, "{counts:?}");
    assert_eq!(counts.accumulations, 0);
    assert!((energy(&system, END) / before - 1.0).abs() < 1e-10);
}
