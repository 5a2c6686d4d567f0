//! Stacks and rows of boxes.

use super::{block, body, disc, floor, gravity, state, world_of};
use crate::within;
use halfgap::Event;
use halfgap_tests::mechanism::GRAVITY;
use std::fmt::Write;

#[test]
fn a_stack_of_ten_boxes_rests_for_a_thousand_seconds_without_an_event() {
    let mut parts = floor(100.0, 0.5) + &gravity(0.0, -GRAVITY);
    for place in 0..10 {
        let y = f64::from(place) + 0.5;
        parts += &body(&format!("box {place}"), &block(1.0, 1.0), [0.0, y], 0.5, "");
    }
    let mut world = world_of(&parts);
    let before: Vec<_> = world.bodies().map(|body| world.state(body)).collect();
    let mut events = 0;
    world.advance_to(1000.0, &mut |_| events += 1).expect("it rests");
    assert_eq!(events, 0);
    let moved = world.bodies().zip(before).map(|(body, before)| {
        let now = world.state(body);
        now.position.distance(before.position).max((now.angle - before.angle).abs())
    });
    within("stack of 10 boxes, 1,000 s: moved [m, rad]", moved.fold(0.0, f64::max), 1e-12);
}

/// A box is pushed with 100 N and collects 19 others, 5 cm apart, that do not bounce: k boxes get 100/k - mu g, and
/// each new one leaves k of k + 1 parts of the speed.
#[test]
fn a_box_that_is_pushed_collects_a_row_of_boxes_one_after_the_other() {
    let (friction, apart, push, count) = (0.3, 0.05, 100.0, 20);
    let mut parts = floor(200.0, friction) + &gravity(0.0, -GRAVITY);
    for place in 0..count {
        let x = f64::from(place) * (1.0 + apart);
        parts += &body(&place.to_string(), &block(1.0, 0.5), [x, 0.25], friction, "");
    }
    parts += "[[force]]\nconstant = { body = \"0\", point = [0.0, 0.0], force = [100.0, 0.0], frame = \"body\", torque = 0.0 }\n";
    let mut world = world_of(&parts);
    let mut hits = Vec::new();
    let mut tell = |event: &Event| hits.extend(event.impact().map(|impact| impact.time));
    world.advance_to(1.0, &mut tell).expect("they are collected");
    let (mut time, mut speed) = (0.0, 0.0f64);
    assert_eq!(hits.len(), 19);
    let mut worst = 0.0f64;
    for (boxes, hit) in (1..count).zip(hits) {
        let boxes = f64::from(boxes);
        let faster = (speed * speed + 2.0 * (push / boxes - friction * GRAVITY) * apart).sqrt();
        time += 2.0 * apart / (speed + faster);
        worst = worst.max((hit - time).abs());
        speed = faster * boxes / (boxes + 1.0);
    }
    within("box that collects 19 others: times of impacts [s]", worst, 5e-10);
    within("box that collects 19 others: books [J]", world.ledger().integration_error(), 1e-11);
}

/// A spring whose far end comes at 1 m/s presses on a row of boxes with 3 N t a box: after a second friction is beaten
/// in all of them at once, and with s = t - 1 they go s - sin(w s)/w, w^2 = 3.
#[test]
fn boxes_in_a_row_stick_until_a_spring_at_its_end_moves_all_of_them_at_once() {
    let count = 8;
    let mut parts = floor(200.0, 0.3);
    for place in 0..count {
        parts += &body(&place.to_string(), &block(1.0, 0.5), [f64::from(place), 0.25], 0.3, "");
    }
    let names: Vec<_> = (0..count).map(|place| place.to_string()).collect();
    let _ = write!(
        parts,
        "{}[[force]]\ngravity = {{ acceleration = [0.0, -10.0], bodies = {names:?} }}\n[[force]]\n\
         spring = {{ a = {{ body = \"hand\", point = [0.0, 0.0] }}, b = {{ body = \"0\", point = [0.0, 0.0] }}, rest_length = 5.0, stiffness = {:?} }}\n",
        body(
            "hand",
            &disc(0.1),
            [-5.0, 0.25],
            0.0,
            "mass = 1e12\nvelocity = [1.0, 0.0]\npasses_through = [\"floor\"]"
        ),
        3.0 * f64::from(count)
    );
    let mut world = world_of(&parts);
    let mut slips = Vec::new();
    let mut tell = |event: &Event| {
        if let Event::Slips(contact) = event {
            slips.push(contact.time);
        }
    };
    world.advance_to(2.0, &mut tell).expect("they stick, then slide");
    // Earlier slips close the gaps between them, or come 1e-7 s before friction is beaten and stick again at once:
    // where forces are not unique their bounds are known no better.
    let last = slips.last().expect("they slip");
    within("8 boxes in a row on a spring: when they slip for good [s]", last - 1.0, 5e-9);
    let rate = 3f64.sqrt();
    let way = 1.0 - rate.sin() / rate;
    for place in [0, count - 1] {
        let x = state(&world, &place.to_string()).position.x;
        within(
            &format!("8 boxes in a row on a spring: number {place} [m]"),
            x - f64::from(place) - way,
            2e-9,
        );
    }
}
