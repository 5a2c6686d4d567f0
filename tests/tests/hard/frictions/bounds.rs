//! Friction at its bounds, and between bodies of a million to one.

use super::{block, body, disc, floor, gravity, state, world_of};
use crate::within;
use halfgap::geometry::DVec2;
use halfgap::{Event, World};
use halfgap_tests::mechanism::{GRAVITY, advance};
use std::f64::consts::TAU;

/// The slope is a floor under gravity that leans: so its tangent is exact.
#[test]
fn a_block_on_a_slope_sticks_a_billionth_below_the_bound_and_slips_a_billionth_above() {
    let time = 100.0;
    for (off, name) in [(-1e-9, "less 1e-9"), (0.0, "exactly"), (1e-9, "plus 1e-9"), (1e-6, "plus 1e-6")] {
        let lean = gravity(GRAVITY * 0.5 * (1.0 + off), -GRAVITY);
        let parts = [floor(1e3, 0.5), body("block", &block(1.0, 0.2), [0.0, 0.1], 0.5, ""), lean];
        let mut world = world_of(&parts.concat());
        advance(&mut world, time);
        let way = 0.5 * GRAVITY * 0.5 * off.max(0.0) * time * time;
        let allowed = if off > 0.0 { 1e-10 } else { 1e-20 };
        let what = format!("slope at the bound {name}, 100 s: way [m]");
        within(&what, state(&world, "block").position.x - way, allowed);
    }
}

/// A disc never presses itself into the floor: it slides until its speed has fallen to two thirds, and rolls.
#[test]
fn a_disc_slides_until_it_rolls_with_any_coefficient() {
    let (speed, time) = (3.0, 2.0);
    for friction in [0.0, 1e-9, 10.0, 1e3] {
        let thrown = body("disc", &disc(0.5), [0.0, 0.5], friction, "velocity = [3.0, 0.0]");
        let mut world = world_of(&[floor(100.0, friction), thrown, gravity(0.0, -GRAVITY)].concat());
        advance(&mut world, time);
        let slowing = friction * GRAVITY;
        let slides = if slowing > 0.0 { time.min(speed / (3.0 * slowing)) } else { time };
        let rolls = (time - slides) * (speed - slowing * slides);
        let way = speed * slides - 0.5 * slowing * slides * slides + rolls;
        let what = format!("disc that slides with mu {friction:e}: way [m]");
        within(&what, state(&world, "disc").position.x - way, 1e-12);
    }
}

/// A block under another on a floor without friction, with a spring to a wall 10 m away that pulls it to 0.
fn on_a_spring([below, above]: [f64; 2], stiffness: f64, start: f64) -> World {
    let lower = format!("mass = {below:?}");
    let upper = format!("mass = {above:?}");
    let parts = [
        floor(100.0, 0.0),
        body("lower", &block(20.0, 0.5), [start, 0.25], 0.5, &lower),
        body("upper", &block(1.0, 0.5), [start, 0.75], 0.5, &upper),
        gravity(0.0, -GRAVITY),
        format!(
            "[[force]]\nspring = {{ a = {{ body = \"world\", point = [-10.0, 0.25] }}, \
             b = {{ body = \"lower\", point = [0.0, 0.0] }}, rest_length = 10.0, stiffness = {stiffness:?} }}\n"
        ),
    ];
    world_of(&parts.concat())
}

#[test]
fn blocks_a_million_times_as_heavy_as_each_other_swing_as_one() {
    for (masses, name) in [([1.0, 1e6], "heavy above"), ([1e6, 1.0], "light above")] {
        let mut world = on_a_spring(masses, 4.0 * (1e6 + 1.0), 0.5);
        advance(&mut world, 5.0);
        // At a rate of 2 rad/s they ask for 2 m/s^2 of the 5 that friction has.
        for part in ["lower", "upper"] {
            let off = state(&world, part).position.x - 0.5 * (2.0f64 * 5.0).cos();
            within(&format!("masses 1e6:1, {name}, sticking: {part} [m]"), off, 1e-10);
        }
        assert_eq!(world.ledger().friction, 0.0);
    }
}

#[test]
fn a_light_block_slips_on_one_a_million_times_as_heavy() {
    let (stiffness, time) = (4e6, 0.7);
    let mut world = on_a_spring([1e6, 1.0], stiffness, 4.0);
    advance(&mut world, time);
    // The upper one gets 5 m/s^2 of the 16 of the lower one, which it pulls back with 5 N.
    let shift = 5.0 / stiffness;
    let lower = shift + (4.0 - shift) * (2.0 * time).cos();
    within("light block slips on a heavy one: lower [m]", state(&world, "lower").position.x - lower, 1e-11);
    let upper = 4.0 - 2.5 * time * time;
    within("light block slips on a heavy one: upper [m]", state(&world, "upper").position.x - upper, 1e-11);
}

/// Friction of 5e6 N shifts the middle of the light block's swings by 0.3125 m, against its motion. So it swings
/// from 1 m to -0.375, from there to -0.25, and sticks there, as the spring pulls with less than friction holds.
#[test]
fn a_heavy_block_stops_a_light_one_below_it_in_two_swings() {
    let mut world = on_a_spring([1.0, 1e6], 1.6e7, 1.0);
    let mut sticks = Vec::new();
    let mut tell = |event: &Event| {
        if let Event::Sticks(contact) = event {
            sticks.push(contact.time);
        }
    };
    world.advance_to(0.002, &mut tell).expect("it sticks");
    // The heavy one moves by 3e-6 m meanwhile, and the light one sticks to it, not to the floor.
    let swings = TAU / 4000.0;
    within("heavy block on a light one: when it sticks [s]", sticks[0] - swings, 5e-9);
    within("heavy block on a light one: where [m]", state(&world, "lower").position.x + 0.25, 1e-6);
    let relative = state(&world, "lower").velocity.x - state(&world, "upper").velocity.x;
    within("heavy block on a light one: slip [m/s]", relative, 1e-9);
    assert!(world.ledger().integration_error().abs() < 1e-12 * 1.5e7);
}

/// A column of ten boxes, 1 m by 0.3 m, on a plank that a spring swings at 2 rad/s: it tips as one where 4 a exceeds
/// g 1 m/(3 m), before any of it slips at g/2.
#[test]
fn a_column_on_a_plank_that_swings_stays_as_it_is_up_to_the_acceleration_at_which_it_tips() {
    let bound = GRAVITY / 3.0 / 4.0;
    for (swing, stays) in [(0.6 * bound, true), (bound - 1e-5, true), (bound + 1e-4, false)] {
        let mut parts = floor(100.0, 0.0) + &body("plank", &block(3.0, 0.2), [swing, 0.1], 0.5, "");
        for place in 0..10 {
            let y = 0.35 + 0.3 * f64::from(place);
            parts += &body(&place.to_string(), &block(1.0, 0.3), [swing, y], 0.5, "");
        }
        parts += &gravity(0.0, -GRAVITY);
        parts += "[[force]]\nspring = { a = { body = \"world\", point = [-10.0, 0.1] }, b = { body = \"plank\", point = [0.0, 0.0] }, rest_length = 10.0, stiffness = 44.0 }\n";
        let mut world = world_of(&parts);
        let mut events = 0;
        world.advance_to(2.0, &mut |_| events += 1).expect("it swings");
        assert_eq!(events == 0, stays, "swing of {swing} m: {events} events");
        if stays {
            let off = state(&world, "9").position.x - swing * (2.0f64 * 2.0).cos();
            within(&format!("column on a plank that swings by {swing:.4} m: top [m]"), off, 1e-11);
        }
    }
}

/// A box of 0.5 by 1 m on a slope, by mu and by the tangent of the slope, both over the tangent 0.5 at which it would
/// tip, after a second.
fn box_on_slope([friction, tangent]: [f64; 2]) -> World {
    let lean = gravity(0.5 * GRAVITY * tangent, -GRAVITY);
    let tall = body("box", &block(0.5, 1.0), [0.0, 0.5], 0.5 * friction, "");
    let mut world = world_of(&[floor(1e3, 0.5 * friction), tall, lean].concat());
    advance(&mut world, 1.0);
    world
}

#[test]
fn a_box_between_sliding_and_tipping_does_what_its_slope_and_roughness_say() {
    let slides = [
        ("below both bounds by 1e-9", [1.0, 1.0 - 1e-9]),
        ("at both bounds", [1.0, 1.0]),
        ("slope above both by 1e-6", [1.0, 1.0 + 1e-6]),
        ("slope above both by 1e-3", [1.0, 1.0 + 1e-3]),
        ("less rough by 1e-3, slope by 5e-4", [1.0 - 1e-3, 1.0 - 5e-4]),
        ("less rough by 1e-9, slope above by 1e-3", [1.0 - 1e-9, 1.0 + 1e-3]),
    ];
    for (name, [friction, tangent]) in slides {
        let found = state(&box_on_slope([friction, tangent]), "box");
        let way = 0.25 * GRAVITY * (tangent - friction).max(0.0);
        within(&format!("box {name}: way [m]"), found.position.x - way, 1e-11);
        within(&format!("box {name}: turned [rad]"), found.angle, 1e-14);
    }
    let world = box_on_slope([1.0 + 2e-3, 1.0 + 1e-3]);
    let found = state(&world, "box");
    let corner = found.position + DVec2::from_angle(found.angle).rotate(DVec2::new(0.25, -0.5));
    assert!(found.angle < -5e-3, "it tips: {found:?}");
    within("box too rough to slide: corner moved [m]", corner.x - 0.25, 1e-12);
    assert_eq!(world.ledger().friction, 0.0);
}

/// A box that slides and is by e too rough to stay flat tips as f'' = 24 e + 60 f: it leaves a state that it could not
/// keep, and what e is it takes a thousandfold within a second.
#[test]
fn a_box_that_slides_tips_when_it_is_rougher_than_slender_by_a_ten_millionth() {
    let growth = 60f64.sqrt().cosh() - 1.0;
    for rougher in [1e-6, 1e-7] {
        let turned = -state(&box_on_slope([1.0 + rougher, 2.0]), "box").angle;
        let expected = 24.0 * rougher / 60.0 * growth;
        let what = format!("box that slides, rougher by {rougher:.0e}: turned, relative");
        within(&what, turned / expected - 1.0, 1e-3);
    }
    // Wrong: by 1e-8 it would turn by 4.6e-6 rad, and does not leave its base.
    let turned = state(&box_on_slope([1.0 + 1e-8, 2.0]), "box").angle;
    assert!(turned.abs() < 1e-12, "better than this test knows: {turned}");
}

#[test]
fn a_million_metres_from_the_origin_a_disc_slides_and_rolls_as_well_as_there() {
    let away = DVec2::new(1e6, -1e6);
    let ground = floor(100.0, 0.5)
        .replace("position = [0.0, -0.5]", &format!("position = [{:?}, {:?}]", away.x, away.y - 0.5));
    let thrown = body("disc", &disc(0.5), [away.x, away.y + 0.5], 0.5, "velocity = [3.0, 0.0]");
    let mut world = world_of(&[ground, thrown, gravity(0.0, -GRAVITY)].concat());
    advance(&mut world, 2.0);
    // 0.2 s at 3 to 2 m/s, then 2 m/s.
    let disc = state(&world, "disc");
    within("disc 1e6 m from the origin, slides and rolls: place [m]", disc.position.x - away.x - 4.1, 1e-9);
    within("disc 1e6 m from the origin, slides and rolls: spin [rad/s]", disc.angular_velocity + 4.0, 1e-10);
}

/// A spring whose far end goes at 1 m/s pulls a block that friction holds with up to 4 N: it slips after 4 N/(k 1 m/s).
/// How late it does is no matter of the tolerance: a force that lacks less than 1e-9 of the loads counts as enough.
#[test]
fn a_block_that_is_pulled_ever_harder_slips_when_friction_is_beaten() {
    for stiffness in [1.0, 10.0, 100.0] {
        let hand = "mass = 1e12\nvelocity = [1.0, 0.0]";
        let parts = [
            floor(200.0, 0.4),
            body("block", &block(1.0, 0.5), [0.0, 0.25], 0.4, ""),
            body("hand", &disc(0.1), [5.0, 0.25], 0.0, hand),
            "[[force]]\ngravity = { acceleration = [0.0, -10.0], bodies = [\"block\"] }\n".to_owned(),
            format!(
                "[[force]]\nspring = {{ a = {{ body = \"hand\", point = [0.0, 0.0] }}, b = {{ body = \"block\", point = [0.0, 0.0] }}, \
                 rest_length = 5.0, stiffness = {stiffness:?} }}\n"
            ),
        ];
        let mut world = world_of(&parts.concat());
        let mut slips = Vec::new();
        let mut tell = |event: &Event| {
            if let Event::Slips(contact) = event {
                slips.push(contact.time);
            }
        };
        world.advance_to(4.0 / stiffness + 0.1, &mut tell).expect("it slips");
        let late = (slips[0] - 4.0 / stiffness) * stiffness;
        within(&format!("block pulled by {stiffness} N/s: force beyond friction [N]"), late, 3e-8);
    }
}

/// Static friction holds up to 4 N, kinetic friction is 2 N, and the spring gains 5 N/s. The block slips as a swing
/// about the place of kinetic friction, from V = 0.5 m/s to the same speed, and sticks for the rest of a period.
#[test]
fn a_block_on_a_belt_sticks_and_slips_450_times_in_its_period() {
    let (belt, stiffness) = (0.5, 10.0f64);
    let statics = "static_friction = 0.4";
    let parts = [
        floor(200.0, 0.2) + &format!("{statics}\nsurface_velocity = {:?}\n", -belt),
        body("block", &block(0.4, 0.1), [0.0, 0.05], 0.2, statics),
        gravity(0.0, -GRAVITY),
        format!(
            "[[force]]\nspring = {{ a = {{ body = \"world\", point = [-5.0, 0.05] }}, b = {{ body = \"block\", point = [0.0, 0.0] }}, \
             rest_length = 5.0, stiffness = {stiffness:?} }}\n"
        ),
    ];
    let mut world = world_of(&parts.concat());
    let mut slips: Vec<f64> = Vec::new();
    let mut tell = |event: &Event| {
        if let Event::Slips(contact) = event
            && slips.last().is_none_or(|&last| contact.time > last + 0.1)
        {
            slips.push(contact.time);
        }
    };
    world.advance_to(1000.0, &mut tell).expect("it sticks and slips");
    let (rate, gain) = (stiffness.sqrt(), (4.0 - 2.0) / stiffness);
    let period = (TAU - 2.0 * (gain * rate / belt).atan()) / rate + 2.0 * gain / belt;
    assert_eq!(slips.len(), 451);
    // Each slip comes later than it should by what the test above finds.
    let drift = (slips[450] - slips[0]) / 450.0 - period;
    within("block on a belt, 450 times stick and slip: period [s]", drift, 1e-8);
    within("block on a belt, 450 times stick and slip: books [J]", world.ledger().integration_error(), 1e-9);
}
