//! What cannot be simulated is refused by name and time.

use crate::box_of_bodies::*;
use glam::DVec2;
use halfgap_advance::rigid::{AdvanceError, Between};
use halfgap_collision::BodyId;

#[test]
fn a_ball_that_comes_to_rest_is_refused_with_bodies_and_time() {
    let mut ball = body(&disc(0.5), moving(DVec2::new(0.0, 1.5), DVec2::ZERO, 0.0));
    ball.0.elasticity = 0.0;
    ball.1.acceleration = DVec2::new(0.0, -10.0);
    let mut system = system(vec![fixed(&block(10.0, 1.0), DVec2::new(0.0, -0.5)), ball]);
    let error = advance(&mut system, 2.0).expect_err("it does not bounce");
    let AdvanceError::RestingContact { time, between } = error else { panic!("{error}") };
    assert_eq!(between, Between { primary: BodyId(1), normal: BodyId(0) });
    assert!((time - 0.2f64.sqrt()).abs() < 1e-9, "at {time} s");
    assert_eq!(system.now().seconds(), time);
}

#[test]
fn a_ball_that_is_stopped_where_nothing_pulls_it_goes_on() {
    let mut ball = body(&disc(0.5), moving(DVec2::new(0.0, 1.5), DVec2::new(0.5, -1.0), 0.0));
    ball.0.elasticity = 0.0;
    let mut system = system(vec![fixed(&block(10.0, 1.0), DVec2::new(0.0, -0.5)), ball]);
    advance(&mut system, 5.0).expect("it slides along");
    let state = states(&system, 5.0)[1];
    assert!((state.velocity - DVec2::new(0.5, 0.0)).length() < 1e-15);
    assert_eq!(system.counts().impacts, 1);
}

#[test]
fn a_system_that_refused_does_not_go_on() {
    let mut ball = body(&disc(0.5), moving(DVec2::new(0.0, 1.5), DVec2::ZERO, 0.0));
    ball.0.elasticity = 0.0;
    ball.1.acceleration = DVec2::new(0.0, -10.0);
    let mut system = system(vec![fixed(&block(10.0, 1.0), DVec2::new(0.0, -0.5)), ball]);
    let first = advance(&mut system, 2.0).expect_err("it does not bounce");
    let again = advance(&mut system, 3.0).expect_err("it still does not");
    let AdvanceError::RestingContact { time: first, .. } = first else { panic!("{first}") };
    let AdvanceError::RestingContact { time: again, .. } = again else { panic!("{again}") };
    // The ball was stopped and may fall back on its target gap, by rounding.
    assert!(again - first < 1e-12, "at {first} s and at {again} s");
}
