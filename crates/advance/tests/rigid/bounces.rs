//! Bounces that end: bounces lower than the target zone is wide are cut off, and their time is told.

use crate::box_of_bodies::*;
use glam::DVec2;
use halfgap_advance::rigid::{RigidParts, RigidSettings, RigidSystem};
use halfgap_advance::{Time, advance_until};
use halfgap_collision::Tolerances;

/// Gravity [m/s^2].
const GRAVITY: f64 = 10.0;
/// Drop to the target gap [m].
const DROP: f64 = 1.25;

/// A ball above a floor, in a world where every speed but the least counts as fast.
fn ball(elasticity: f64) -> RigidSystem {
    let tolerances = Tolerances { velocity_tol: 1e-11, ..TOLERANCES };
    let height = DROP + 0.5 + TOLERANCES.target_gap;
    let mut ball = body(&disc(0.5), moving(DVec2::new(0.0, height), DVec2::ZERO, 0.0));
    ball.body.elasticity = elasticity;
    ball.free_motion.acceleration = DVec2::new(0.0, -GRAVITY);
    let bodies = vec![fixed(&block(10.0, 1.0), DVec2::new(0.0, -0.5)), ball];
    let settings = RigidSettings { tolerances, ..SETTINGS };
    RigidSystem::new(RigidParts { bodies, ..RigidParts::default() }, settings, Time::ZERO)
        .expect("nothing touches")
}

/// End of a ball's bounces.
struct Rest {
    /// Time [s] at which the contact began, and time [s] for which the bounces cut off would have gone on.
    begin: f64,
    bouncing: f64,
    /// Speed [m/s] before the last impact, and after it.
    speeds: [f64; 2],
    impacts: u64,
}

fn rest(elasticity: f64) -> Rest {
    let mut system = ball(elasticity);
    let mut rests = Vec::new();
    advance_until(&mut system, Time::from_seconds(30.0), |system, _| {
        let last = &system.last_impact().rows[0];
        rests.extend(system.contact_changes().begin.iter().map(|begin| Rest {
            begin: system.now().seconds(),
            bouncing: begin.bouncing.expect("a single contact under gravity"),
            speeds: [-last.rate_before, last.rate_after],
            impacts: system.counts().impacts,
        }));
    })
    .expect("it comes to rest");
    assert_eq!(rests.len(), 1, "it rests once");
    rests.remove(0)
}

#[test]
fn a_bounce_that_stays_within_the_target_zone_is_the_last() {
    for elasticity in [0.5, 0.8, 0.9] {
        let rest = rest(elasticity);
        // The first bounce that rises by no more than the accuracy: v^2 = 2 g a, after falls of v0 e^n.
        let (first, low) = ((2.0 * GRAVITY * DROP).sqrt(), (2.0 * GRAVITY * TOLERANCES.accuracy).sqrt());
        let bounces = ((low / first).ln() / elasticity.ln()).ceil();
        assert_eq!(rest.impacts, bounces as u64 + 1, "e = {elasticity}");
        let speed = first * elasticity.powf(bounces);
        // A fall of the size of the target gap has the rounding of coordinates.
        assert!((rest.speeds[0] / speed - 1.0).abs() < 1e-3, "e = {elasticity}: {:?}, {speed}", rest.speeds);
        assert_eq!(rest.speeds[1], 0.0, "e = {elasticity}");
    }
}

#[test]
fn the_time_of_the_bounces_cut_off_is_told() {
    for elasticity in [0.5, 0.8, 0.9] {
        let rest = rest(elasticity);
        let left = 2.0 * elasticity * rest.speeds[0] / (GRAVITY * (1.0 - elasticity));
        assert!(
            (rest.bouncing / left - 1.0).abs() < 1e-12,
            "e = {elasticity}: {} s, {left} s",
            rest.bouncing
        );
        // A fall of duration T, then bounces of 2 e T, 2 e^2 T and so on.
        let fall = (2.0 * DROP / GRAVITY).sqrt();
        let at_rest = fall * (1.0 + elasticity) / (1.0 - elasticity);
        let error = rest.begin + rest.bouncing - at_rest;
        assert!(rest.bouncing > 1e-6 && error.abs() < 1e-10, "e = {elasticity}: off by {error} s");
    }
}

#[test]
fn a_ball_without_bounce_has_no_bounces_to_cut_off() {
    let rest = rest(0.0);
    assert_eq!((rest.bouncing, rest.impacts), (0.0, 1));
}
