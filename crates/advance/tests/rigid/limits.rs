//! Cases with known answers.

use crate::box_of_bodies::*;
use glam::DVec2;
use halfgap_advance::Time;
use halfgap_advance::rigid::{AdvanceError, VelocityChange};
use halfgap_collision::{BodyId, BodyState};

#[test]
fn a_damped_disc_coasts_into_a_wall_when_the_exponential_says() {
    // x(t) = v (1 - e^(-k t))/k: the gap of 1 m less the target gap is gone at t = -ln(1 - k s/v)/k.
    let (speed, rate) = (2.0, 0.5);
    let mut disc = body(&disc(0.5), moving(DVec2::ZERO, DVec2::new(speed, 0.0), 0.0));
    disc.free_motion.linear_rate = rate;
    let mut system = system(vec![disc, fixed(&block(1.0, 4.0), DVec2::new(2.0, 0.0))]);
    let way = 1.0 - TOLERANCES.target_gap;
    let impact = -(1.0 - rate * way / speed).ln() / rate;
    advance(&mut system, impact * (1.0 - 1e-12)).expect("nothing yet");
    assert_eq!(system.counts().impacts, 0);
    advance(&mut system, impact * (1.0 + 1e-12)).expect("one impact");
    assert_eq!(system.counts().impacts, 1);
    let state: BodyState = states(&system, impact)[0];
    assert!((state.velocity.x + speed - rate * way).abs() < 1e-11, "it leaves at {}", state.velocity.x);
}

#[test]
fn a_disc_thrown_short_of_a_wall_by_damping_never_arrives() {
    let mut disc = body(&disc(0.5), moving(DVec2::ZERO, DVec2::new(1.0, 0.0), 0.0));
    disc.free_motion.linear_rate = 1.0;
    let mut system = system(vec![disc, fixed(&block(1.0, 4.0), DVec2::new(2.001, 0.0))]);
    advance(&mut system, 1e3).expect("nothing happens");
    assert_eq!(system.counts().impacts, 0);
    assert!(system.counts().events < 1000, "{} events", system.counts().events);
}

#[test]
fn equal_discs_swap_their_velocities_head_on() {
    let state = |x: f64, v: f64| moving(DVec2::new(x, 0.0), DVec2::new(v, 0.0), 0.7);
    let mut system = system(vec![body(&disc(0.5), state(-2.0, 3.0)), body(&disc(0.5), state(2.0, -1.0))]);
    advance(&mut system, 2.0).expect("one impact");
    let after = states(&system, 2.0);
    assert!((after[0].velocity - DVec2::new(-1.0, 0.0)).length() < 1e-15);
    assert!((after[1].velocity - DVec2::new(3.0, 0.0)).length() < 1e-15);
    assert_eq!(after[0].angular_velocity, 0.7);
}

#[test]
fn bodies_far_from_each_other_cost_nothing() {
    let away = |x: f64| body(&disc(0.1), moving(DVec2::new(10.0 * x, 0.0), DVec2::new(0.0, 0.1 * x), 1.0));
    let mut system = system((1..100).map(|x| away(f64::from(x))).collect());
    advance(&mut system, 10.0).expect("nothing happens");
    assert_eq!(system.counts().impacts, 0);
    assert!(system.counts().events < 3000, "{} events", system.counts().events);
}

#[test]
fn an_intervention_without_numbers_is_refused_and_nothing_is_done() {
    let mut system = system(vec![body(&disc(0.5), BodyState::default())]);
    let (now, never) = (Time::from_seconds(0.5), Time::from_seconds(f64::NAN));
    let times = [(now, f64::NAN, 0.0), (now, 0.0, f64::INFINITY), (never, 1.0, 0.0)];
    for (time, speed, angular_velocity) in times {
        let change = VelocityChange { body: BodyId(0), velocity: DVec2::new(0.0, speed), angular_velocity };
        let refused = system.intervene(time, &[change]);
        assert!(matches!(refused, Err(AdvanceError::BadIntervention { .. })), "{refused:?}");
    }
    advance(&mut system, 1.0).expect("it goes on");
    assert_eq!(states(&system, 1.0)[0], BodyState::default());
}
