//! Bodies so light that the forces that slow them act at once: their motion is slow, but an explicit method would have
//! to follow transients that decay within a microsecond. Each case counts the steps.

use super::within;
use halfgap::force::{Dashpot, Spring};
use halfgap::geometry::DVec2;
use halfgap::{Anchor, BodyId, BodyState, ConnectorKind, World};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc, thrown};
use std::sync::Arc;

/// Number of steps beyond which the steps follow the decay: an explicit method would take nearly a million or more in
/// each case.
const FEW_STEPS: u64 = 20_000;

fn few_steps(what: &str, world: &World) {
    let steps = world.statistics().steps;
    println!("REACHED | {what} | {FEW_STEPS} | {steps}");
    assert!(steps < FEW_STEPS, "{what}: {steps}");
}

#[test]
fn a_light_body_creeps_back_on_a_damped_spring() {
    // m x'' + c x' + k x = 0 with m = 1 mg, c = 1 N s/m, k = 1 N/m: rates of about 1e6 and 1 a second.
    let (mass, damping, stiffness, stretch) = (1e-6, 1.0, 1.0, 0.5);
    let mut shop = Workshop::weightless(1e-9);
    let bob = shop.body("bob", disc(0.1), mass, at_rest(1.0 + stretch, 0.0));
    let ends = [(BodyId::WORLD, DVec2::ZERO), (bob, DVec2::ZERO)].map(|(body, point)| Anchor { body, point });
    shop.builder.add_force(Arc::new(Spring::new("spring", ends, 1.0, stiffness)));
    shop.builder.add_force(Arc::new(Dashpot::new("dashpot", ends, damping)));
    let mut world = shop.build();
    advance(&mut world, 10.0);
    let root = f64::sqrt(damping * damping - 4.0 * mass * stiffness);
    let [slow, fast] = [2.0 * stiffness / (damping + root), (damping + root) / (2.0 * mass)];
    let expected = stretch * (fast * (-slow * 10.0).exp() - slow * (-fast * 10.0).exp()) / (fast - slow);
    within("damped spring on 1 mg, 10 s: place [m]", world.state(bob).position.x - 1.0 - expected, 1e-8);
    within("damped spring on 1 mg, 10 s: books [J]", world.ledger().integration_error(), 1e-8);
    few_steps("damped spring on 1 mg, 10 s: steps", &world);
}

#[test]
fn a_light_block_is_driven_through_syrup_along_a_floor() {
    // v' = a - k v from rest, with k = 1e6 a second; the block keeps to the floor.
    let (drive, rate, mass, time): (f64, f64, f64, f64) = (1e5, 1e6, 1e-6, 5.0);
    let mut shop = Workshop::new(1e-9);
    shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
    let sled = shop.dull("sled", block(1.0, 0.5), mass, at_rest(0.0, 0.25));
    shop.builder.add_gravity(sled, DVec2::new(drive, 0.0));
    shop.builder.add_damping(sled, rate * mass, 0.0);
    let mut world = shop.build();
    let start = world.state(sled).position;
    advance(&mut world, time);
    let way = drive / rate * (time - (1.0 - (-rate * time).exp()) / rate);
    let moved = world.state(sled).position - start;
    within("block in syrup, 5 s: way [m]", moved.x - way, 1e-9);
    within("block in syrup, 5 s: lifted [m]", moved.y, 1e-11);
    few_steps("block in syrup, 5 s: steps", &world);
}

#[test]
fn a_pendulum_in_syrup_creeps_down() {
    // Without inertia k l^2 a' = -g l sin a, so tan(a/2) decays at g/(k l); inertia changes the rate by about
    // g/(k^2 l) of itself, and the start from rest shifts the time by 1/k: 1e-11 both.
    let (length, mass, rate, time, start): (f64, f64, f64, f64, f64) = (1.0, 1e-3, 1e6, 1e5, 2.0);
    let mut shop = Workshop::new(1e-9);
    let bob =
        shop.body("bob", disc(0.1), mass, thrown(length * start.sin(), -length * start.cos(), DVec2::ZERO));
    let [a, b] =
        [(BodyId::WORLD, DVec2::ZERO), (bob, DVec2::ZERO)].map(|(body, point)| Anchor { body, point });
    shop.connect(ConnectorKind::Rod { a, b, length }, 0.0);
    shop.builder.add_damping(bob, rate * mass, 0.0);
    let mut world = shop.build();
    advance(&mut world, time);
    let angle = 2.0 * ((0.5 * start).tan() * (-GRAVITY / (rate * length) * time).exp()).atan();
    let place = world.state(bob).position;
    within("pendulum in syrup, 1e5 s: angle [rad]", place.x.atan2(-place.y) - angle, 1e-7);
    few_steps("pendulum in syrup, 1e5 s: steps", &world);
}

#[test]
fn a_light_body_on_a_stiff_spring_follows_a_heavy_one_where_rounding_is_told() {
    // m x'' + c x' + k (x - place) = 0 with m = 1.6 mg: beside the decay at 1e6 a second, forces are so steep that the
    // velocity error from the rounding of places exceeds the tolerance, however short a step of an explicit method.
    let (damping, stiffness, length) = (1.9, 9000.0, 1.9);
    let mut shop = Workshop::weightless(3e-12);
    let moving = BodyState { angular_velocity: -2.0, ..thrown(1.6, -0.5, DVec2::new(-1.8, -0.4)) };
    let heavy = shop.body("heavy", disc(0.8), 2.0, moving);
    let light = shop.body("light", disc(0.3), 1.6e-6, at_rest(0.0, -1.0));
    let ends =
        [(heavy, DVec2::new(-0.2, 0.2)), (light, DVec2::ZERO)].map(|(body, point)| Anchor { body, point });
    shop.builder.add_force(Arc::new(Spring::new("spring", ends, length, stiffness)));
    shop.builder.add_force(Arc::new(Dashpot::new("dashpot", ends, damping)));
    let mut world = shop.build();
    advance(&mut world, 0.5);
    let [end, held] = ends.map(|end| world.state(end.body).pose().point_to_world(end.point));
    within("stiff spring on 1.6 mg, 0.5 s: length [m]", (end - held).length() - length, 1e-9);
    within("stiff spring on 1.6 mg, 0.5 s: books [J]", world.ledger().integration_error(), 1e-9);
    few_steps("stiff spring on 1.6 mg, 0.5 s: steps", &world);
}

#[test]
fn a_spring_far_from_the_origin_is_not_followed_through_rounding() {
    // Places are known to 6e-11 m, of which the spring makes 2e-5 m/s^2: more than the tolerance allows in 3e-7 s, but
    // not more than that error of place is worth in the 2e-3 s in which the spring acts.
    let (mass, rate, far, stretch, time) = (0.25, 600.0, 3e5, 0.01, 1.0);
    let length = 5.0;
    let mut shop = Workshop::weightless(1e-12);
    let bob = shop.body("bob", disc(0.1), mass, at_rest(far + length + stretch, 0.0));
    let ends = [(BodyId::WORLD, DVec2::new(far, 0.0)), (bob, DVec2::ZERO)]
        .map(|(body, point)| Anchor { body, point });
    shop.builder.add_force(Arc::new(Spring::new("spring", ends, length, mass * rate * rate)));
    let mut world = shop.build();
    advance(&mut world, time);
    let expected = stretch * (rate * time).cos();
    within("spring at 3e5 m, 1 s: place [m]", world.state(bob).position.x - far - length - expected, 1e-7);
    let turned_over = 0.5 * mass * (rate * stretch).powi(2);
    let open = world.ledger().integration_error() / turned_over;
    within("spring at 3e5 m, 1 s: books, part of the energy turned over", open, 1e-5);
    few_steps("spring at 3e5 m, 1 s: steps", &world);
}

#[test]
fn a_dot_whose_spin_has_decayed_does_not_spin_between_steps() {
    // The spin decays at 2e6 a second; after that nothing shows that an explicit step of the right length for the
    // spring is too long for the spin.
    let (mass, radius, damping, spin) = (1.5, 1e-3, 1.5, 0.4);
    let mut shop = Workshop::weightless(1e-11);
    let turning = BodyState { angular_velocity: spin, ..thrown(-3.9, 2.9, DVec2::new(2.2, 1.2)) };
    let dot = shop.body("dot", disc(radius), mass, turning);
    let other = shop.body("other", disc(0.3), 0.4, at_rest(-1.2, -3.4));
    shop.builder.add_damping(dot, 0.5, damping);
    shop.builder.add_damping(other, 0.5, damping);
    let ends =
        [(other, DVec2::new(-0.2, -0.3)), (dot, DVec2::ZERO)].map(|(body, point)| Anchor { body, point });
    shop.builder.add_force(Arc::new(Spring::new("spring", ends, 0.7, 1000.0)));
    let mut world = shop.build();
    let mut most: f64 = 0.0;
    for look in 1..=2000 {
        advance(&mut world, 1e-4 + 1e-5 * f64::from(look));
        most = most.max(world.state(dot).angular_velocity.abs());
    }
    within("dot in syrup, 20 ms: spin [rad/s]", most, 1e-9);
    few_steps("dot in syrup, 20 ms: steps", &world);
}

#[test]
fn a_chain_of_dots_in_syrup_creeps_however_many_they_are() {
    // On dashpots and stiff springs, damped by c: all dots fall at m g/c up to the rest of their start, while the
    // chain hangs on nothing and keeps its length.
    let (mass, damping, spacing) = (1.0, 1e3, 1.0);
    for count in [10, 60] {
        let mut shop = Workshop::new(1e-6);
        let place = |index: u32| DVec2::new(spacing * f64::from(index), 0.0);
        let dots: Vec<BodyId> = (0..count)
            .map(|index| shop.body(&format!("dot {index}"), disc(0.1), mass, at_rest(place(index).x, 0.0)))
            .collect();
        for (index, pair) in dots.windows(2).enumerate() {
            let ends = [pair[0], pair[1]].map(|body| Anchor { body, point: DVec2::ZERO });
            let spring = Spring::new(format!("spring {index}"), ends, spacing, 1e4);
            shop.builder.add_force(Arc::new(spring));
            shop.builder.add_force(Arc::new(Dashpot::new(format!("dashpot {index}"), ends, 1e3)));
        }
        dots.iter().for_each(|&dot| shop.builder.add_damping(dot, damping, damping));
        let mut world = shop.build();
        advance(&mut world, 1.0);
        let rate = damping / mass;
        let fallen = GRAVITY / rate * (1.0 - (1.0 - (-rate).exp()) / rate);
        let last = *dots.last().expect("there are dots");
        within(
            &format!("{count} dots in syrup, 1 s: fallen [m]"),
            world.state(last).position.y + fallen,
            1e-6,
        );
        let length = world.state(last).position.x - world.state(dots[0]).position.x;
        within(&format!("{count} dots in syrup, 1 s: length [m]"), length - place(count - 1).x, 1e-6);
        few_steps(&format!("{count} dots in syrup, 1 s: steps"), &world);
    }
}
