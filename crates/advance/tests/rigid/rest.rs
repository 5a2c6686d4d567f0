//! Rest: a body that stops on another stays there, and its contact is told.

use crate::box_of_bodies::*;
use glam::DVec2;
use halfgap_advance::rigid::RigidSystem;
use halfgap_advance::{Time, advance_until};
use halfgap_collision::BodyId;

const GRAVITY: f64 = 10.0;

/// A ball without bounce, 1 m above a floor.
fn dropped(velocity: DVec2) -> (RigidSystem, f64) {
    let mut ball = body(&disc(0.5), moving(DVec2::new(0.0, 1.5), velocity, 0.0));
    ball.body.elasticity = 0.0;
    ball.free_motion.acceleration = DVec2::new(0.0, -GRAVITY);
    let weight = GRAVITY / ball.body.inverse_mass;
    (system(vec![fixed(&block(10.0, 1.0), DVec2::new(0.0, -0.5)), ball]), weight)
}

#[test]
fn a_ball_without_bounce_rests_where_it_fell_and_presses_with_its_weight() {
    let (mut system, weight) = dropped(DVec2::ZERO);
    let mut begun = Vec::new();
    advance_until(&mut system, Time::from_seconds(1.0), |system, _| {
        begun.extend(system.contact_changes().begin.iter().map(|row| (system.now().seconds(), *row)));
        assert!(system.contact_changes().end.is_empty());
    })
    .expect("it comes to rest");
    let [(time, row)] = begun[..] else { panic!("one contact begins: {begun:?}") };
    assert!((time - (2.0 * (1.0 - TOLERANCES.target_gap) / GRAVITY).sqrt()).abs() < 1e-12, "at {time} s");
    assert_eq!(row.bodies, [BodyId(1), BodyId(0)]);
    assert_eq!(row.normal, DVec2::Y);
    assert!((row.force / weight - 1.0).abs() < 1e-12, "{} N for {weight} N", row.force);
    let there = states(&system, 1.0)[1];
    advance(&mut system, 1e3).expect("nothing happens");
    let still = states(&system, 1e3)[1];
    assert!((still.position - there.position).length() < 1e-15, "it moved to {}", still.position);
    assert!((still.position.y - 0.5 - TOLERANCES.target_gap).abs() < 1e-15);
    assert_eq!(system.counts().impacts, 1);
    let forces = system.row_forces(Time::from_seconds(1e3));
    assert!(forces.len() == 1 && (forces[0].force / weight - 1.0).abs() < 1e-12, "{forces:?}");
}

#[test]
fn a_ball_that_rests_slides_on_without_friction() {
    let (mut system, _) = dropped(DVec2::new(0.25, 0.0));
    advance(&mut system, 10.0).expect("the floor is long enough");
    let state = states(&system, 10.0)[1];
    assert!((state.position.x - 2.5).abs() < 1e-12 && state.velocity.y == 0.0, "{state:?}");
}

#[test]
fn a_ball_that_slides_off_the_edge_falls_freely() {
    let (mut system, _) = dropped(DVec2::new(2.0, 0.0));
    // The vertex of the floor at x = 5 m is below the centre after 2.5 s; then the ball turns about it.
    let mut ends = Vec::new();
    advance_until(&mut system, Time::from_seconds(4.0), |system, _| {
        ends.extend(system.contact_changes().end.iter().map(|_| system.now().seconds()));
    })
    .expect("it falls");
    assert_eq!(ends.len(), 2, "the contact changes from edge to vertex and ends: {ends:?}");
    assert!((ends[0] - 2.5).abs() < 1e-9, "{ends:?}");
    // The ball leaves the vertex where the force that turns it is all of gravity along the radius: v^2 = g r cos a,
    // with v^2 = v0^2 + 2 g r (1 - cos a), so that cos a = v0^2/(3 g r) + 2/3.
    let radius = 0.5 + TOLERANCES.target_gap;
    let cosine = 2.0 * 2.0 / (3.0 * GRAVITY * radius) + 2.0 / 3.0;
    assert!(cosine < 1.0);
    let speed = (GRAVITY * radius * cosine).sqrt();
    let state = states(&system, 4.0)[1];
    assert!((state.velocity.x - speed * cosine).abs() < 1e-8, "{} for {}", state.velocity.x, speed * cosine);
}

#[test]
fn a_ball_that_is_stopped_where_nothing_pulls_it_goes_on() {
    let mut ball = body(&disc(0.5), moving(DVec2::new(0.0, 1.5), DVec2::new(0.5, -1.0), 0.0));
    ball.body.elasticity = 0.0;
    let mut system = system(vec![fixed(&block(10.0, 1.0), DVec2::new(0.0, -0.5)), ball]);
    advance(&mut system, 5.0).expect("it slides along");
    let state = states(&system, 5.0)[1];
    assert!((state.velocity - DVec2::new(0.5, 0.0)).length() < 1e-15);
    assert_eq!(system.counts().impacts, 1);
}
