//! Sequences of events that end, or that do not.

use super::{bounced, within};
use halfgap::BodyState;
use halfgap::geometry::DVec2;
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc, rest_time};

#[test]
fn a_ball_rests_when_its_geometric_series_ends_at_every_tolerance() {
    for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
        let mut shop = Workshop::new(tolerance);
        shop.fixed("floor", block(4.0, 1.0), DVec2::new(0.0, -0.5));
        shop.settler("ball", disc(0.5), 1.0, at_rest(0.0, 1.75), 0.5);
        let mut world = shop.build();
        // Half a second down, then bounces of 2 v/g with v halved each time: 0.5 + 0.5 + 0.25 + ... s.
        let rest = rest_time(&mut world, 5.0);
        // The ball is caught below the velocity tolerance v: at most 2 v/(g (1 - e)) of the series is left. The gap
        // makes each fall shorter by its size over the speed.
        let caught = 2.0 * world.tolerances().velocity_tol / (GRAVITY * 0.5);
        let what = format!("ball bounces to rest at tolerance {tolerance:.0e}: time [s]");
        within(&what, rest - 1.5, caught + 100.0 * world.tolerances().target_gap);
    }
}

#[test]
fn a_block_clatters_to_rest_on_two_corners() {
    for angle in [0.01, 0.1] {
        let mut shop = Workshop::new(1e-8);
        shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
        let state = BodyState { angle, ..at_rest(0.0, 0.8) };
        let body = shop.settler("block", block(2.0, 1.0), 1.0, state, 0.5);
        let mut world = shop.build();
        let rest = rest_time(&mut world, 20.0);
        println!("clatters until {rest} s: {:?}", world.statistics());
        assert!(rest < 10.0, "it clatters until {rest} s");
        let state = world.state(body);
        within(&format!("block clatters to rest from {angle} rad: angle [rad]"), state.angle, 1e-9);
        within(&format!("block clatters to rest from {angle} rad: speed [m/s]"), state.velocity.y, 1e-12);
        let weight: f64 = world.contact_forces().iter().map(|row| row.force).sum();
        within(&format!("block clatters to rest from {angle} rad: weight [N]"), weight - GRAVITY, 1e-10);
    }
}

#[test]
fn a_ball_that_loses_nothing_bounces_for_a_thousand_seconds() {
    let mut shop = Workshop::new(1e-12);
    shop.fixed("floor", block(4.0, 1.0), DVec2::new(0.0, -0.5));
    let ball = shop.body("ball", disc(0.5), 1.0, at_rest(0.0, 1.75));
    let mut world = shop.build();
    let gap = world.tolerances().target_gap;
    // Measured where it falls at 2.5 m/s: at the top of a bounce the height would not tell the time.
    let time = 1000.25;
    advance(&mut world, time);
    let height = 1.75 - bounced(1.25 - gap, time);
    within("ball bounces 1000 times: height [m]", world.state(ball).position.y - height, 1e-9);
    within("ball bounces 1000 times: energy [J]", world.energy().total() - 17.5, 1e-11);
}
