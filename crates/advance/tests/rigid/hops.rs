//! Hops of contacts that are kicked open and come back at once: hops that stay within the target zone, and in which
//! nothing moves much, are held from the kick on.

use crate::box_of_bodies::*;
use glam::DVec2;
use halfgap_advance::Time;
use halfgap_advance::rigid::{RigidParts, RigidSettings, RigidSystem};
use halfgap_collision::Tolerances;

/// Radius [m] of the disc that rests on the floor, and of the one that kicks it.
const RADII: [f64; 2] = [0.5, 0.3];
/// Speed [m/s] of the kick.
const KICK: f64 = 1.0;
/// Time [s] long after the kick.
const END: f64 = 2.0;

/// A disc that rests on a floor, and another disc, as heavy but without weight, that flies at it and gives it an
/// upward speed [m/s] that is small against its own.
fn kicked(gravity: f64, upward: f64) -> RigidSystem {
    kicked_where_fast_is(1e-3, gravity, upward)
}

/// The kicked disc in a system where speeds [m/s] count as fast from a given one on.
fn kicked_where_fast_is(velocity_tol: f64, gravity: f64, upward: f64) -> RigidSystem {
    let height = RADII[0] + TOLERANCES.target_gap;
    let mut resting = body(&disc(RADII[0]), moving(DVec2::new(0.0, height), DVec2::ZERO, 0.0));
    resting.free_motion.acceleration = DVec2::new(0.0, -gravity);
    let lower = (RADII[0] + RADII[1]) * upward / KICK;
    let place = DVec2::new(-1.8, height - lower);
    let mut kicking = body(&disc(RADII[1]), moving(place, DVec2::new(KICK, 0.0), 0.0));
    kicking.body.inverse_mass = resting.body.inverse_mass;
    let tolerances = Tolerances { velocity_tol, ..TOLERANCES };
    let bodies = vec![fixed(&block(10.0, 1.0), DVec2::new(0.0, -0.5)), resting, kicking];
    let settings = RigidSettings { tolerances, ..SETTINGS };
    let mut system = RigidSystem::new(RigidParts { bodies, ..RigidParts::default() }, settings, Time::ZERO)
        .expect("one contact at rest");
    advance(&mut system, END).expect("it slides along");
    system
}

/// Upward speed [m/s] of a hop whose height is a fraction of the accuracy.
fn speed_to(part: f64, gravity: f64) -> f64 {
    (2.0 * gravity * part * TOLERANCES.accuracy).sqrt()
}

/// Checks that the disc slides along the floor at its target gap, and returns the number of impacts.
fn impacts(system: &RigidSystem) -> u64 {
    let state = states(system, END)[1];
    assert!((state.position.y - RADII[0] - TOLERANCES.target_gap).abs() < 1e-13, "{state:?}");
    assert!((state.velocity - DVec2::new(KICK, 0.0)).length() < 1e-8, "{state:?}");
    system.counts().impacts
}

#[test]
fn a_short_hop_within_the_target_zone_is_held_from_the_kick_on() {
    let upward = speed_to(0.3, 10.0);
    let system = kicked(10.0, upward);
    assert_eq!(impacts(&system), 1);
    // The energy that the hop would have lost at its landing is lost at once.
    let lost = 0.5 * upward * upward / system.trajectory(halfgap_collision::BodyId(1)).body().inverse_mass;
    let captures = system.ledger_at(Time::from_seconds(END)).captures;
    assert!((captures / -lost - 1.0).abs() < 1e-6, "{captures} J of {lost} J");
}

#[test]
fn a_short_hop_beside_other_contacts_is_held_however_fast_it_begins() {
    let upward = speed_to(0.3, 10.0);
    let fast = 1e-2 * upward;
    assert_eq!(impacts(&kicked_where_fast_is(fast, 10.0, upward)), 1);
}

#[test]
fn a_hop_that_leaves_the_target_zone_is_flown() {
    assert_eq!(impacts(&kicked(10.0, speed_to(1.2, 10.0))), 2);
}

#[test]
fn a_hop_in_which_its_body_slides_on_is_flown() {
    // The hop takes a millisecond: there is time for forces to change.
    assert_eq!(impacts(&kicked(1e-4, speed_to(0.3, 1e-4))), 2);
}
