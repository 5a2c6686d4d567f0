//! A light body between a wall and a heavy one that closes on it: it rattles ever faster until it has turned the heavy
//! one back, in hundreds of impacts within a time too short for anything else.

use super::{impacts, within};
use halfgap::World;
use halfgap::geometry::DVec2;
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc, thrown};
use halfgap_tests::world_of;
use std::f64::consts::PI;

/// Distance [m] from the wall at which the light disc rests, and at which the heavy one starts.
const LIGHT: f64 = 1.0;
const HEAVY: f64 = 2.5;

/// A light disc of 1 kg at rest between a wall and a heavy one that closes on it with 1 m/s. A body falls far away, so
/// that the scene has an acceleration.
fn rattle(heavy: f64) -> World {
    let mut shop = Workshop::weightless(1e-8);
    shop.fixed("wall", block(1.0, 4.0), DVec2::new(-0.5, 0.0));
    shop.body("light", disc(0.1), 1.0, at_rest(LIGHT, 0.0));
    shop.body("heavy", disc(0.5), heavy, thrown(HEAVY, 0.0, DVec2::new(-1.0, 0.0)));
    let far = shop.body("far", disc(0.1), 1.0, at_rest(-50.0, 0.0));
    shop.builder.add_gravity(far, DVec2::new(0.0, -GRAVITY));
    shop.build()
}

/// The digits of pi are the number of impacts until a heavy disc leaves that is 100^k times as heavy (G. Galperin,
/// "Playing pool with pi", Regular and Chaotic Dynamics 8, 2003): in velocities weighed by the roots of the masses,
/// the two impacts of a round turn the motion by twice the angle whose tangent is the root of the ratio of the masses.
#[test]
fn a_light_disc_between_a_wall_and_a_heavy_one_counts_the_digits_of_pi() {
    for (heavy, digits) in [(1e4, 314), (1e6, 3141), (1e8, 31415)] {
        let mut world = rattle(heavy);
        // The heavy disc turns back once and is then as fast as before; the light one, slower, may take its
        // time for the last.
        let count = impacts(&mut world, 20.0);
        assert_eq!(count, digits, "{heavy:e} times as heavy");
        let body = world.find("heavy").expect("it is there");
        let angle = (1.0 / heavy).sqrt().atan();
        let hits = count.div_ceil(2) as f64;
        let speed = -(2.0 * hits * angle).cos();
        let what = format!("light disc between a wall and one {heavy:e} times as heavy: speed [m/s]");
        within(&what, world.state(body).velocity.x - speed, 1e-10);
        assert!((PI / angle - count as f64) < 1.0, "the angle tells the same");
        assert_eq!(world.ledger().captures, 0.0);
    }
}

#[test]
fn a_light_disc_under_a_heavy_block_throws_it_up_again_at_a_loose_tolerance() {
    // At 150 m/s the light disc crosses a distance of many target gaps between two blows, so each of them counts.
    let mut shop = Workshop::new(1e-2);
    shop.fixed("floor", block(10.0, 1.0), DVec2::new(0.0, -0.5));
    shop.body("light", disc(0.1), 1.0, at_rest(0.0, 0.15));
    shop.body("heavy", block(1.0, 1.0), 1e4, at_rest(0.0, 0.9));
    let mut world = shop.build();
    let energy = world.energy().total();
    assert!(impacts(&mut world, 2.0) > 1000);
    let kept = world.energy().total() / energy - 1.0;
    within("light disc under a heavy block at 1e-2: energy, relative", kept, 1e-9);
}

/// A hub with a slot through its centre, and in that a die with a play of 1 mm; both are pinned, the die `beside` [m]
/// from the hub's centre, so that it jams where the slot has turned away.
fn die_in_a_slot(tolerance: f64, beside: f64, rate: f64) -> World {
    let slower = 0.9 * rate;
    let text = format!(
        "format = \"halfgap-scene-1\"\ntitle = \"die\"\nrun = {{ duration = 1.5, tolerance = {tolerance} }}\n\
         [[body]]\nname = \"hub\"\nmass = 2.0\nmoment = 0.6\ncenter_of_mass = [0.0, 0.0]\nangular_velocity = {rate}\n\
         shape = {{ outline = {{ paths = [\n\
         {{ start = [0.8, 0.0], edges = [{{ arc = {{ to = [0.8, 0.0], center = [0.0, 0.0], clockwise = false }} }}] }},\n\
         {{ start = [-0.6, -0.101], edges = [{{ line = [0.6, -0.101] }}, {{ line = [0.6, 0.101] }}, \
         {{ line = [-0.6, 0.101] }}, {{ line = [-0.6, -0.101] }}] }}] }} }}\n\
         [[body]]\nname = \"die\"\nmass = 0.5\nangular_velocity = {slower}\nposition = [{beside}, 0.0]\n\
         shape = {{ block = {{ width = 0.4, height = 0.2 }} }}\n\
         [[connector]]\npin = {{ a = {{ body = \"world\", point = [0.0, 0.0] }}, b = {{ body = \"hub\", point = [0.0, 0.0] }} }}\n\
         [[connector]]\npin = {{ a = {{ body = \"world\", point = [{beside}, 0.0] }}, b = {{ body = \"die\", point = [0.0, 0.0] }} }}\n"
    );
    world_of(&text)
}

#[test]
fn a_die_that_jams_in_its_slot_keeps_its_energy() {
    for (tolerance, allowed) in [(1e-2, 1e-4), (1e-3, 1e-9), (1e-4, 1e-9)] {
        let mut most: f64 = 0.0;
        for beside in [0.01, 0.02, 0.04] {
            for rate in [2.0, 3.5] {
                let mut world = die_in_a_slot(tolerance, beside, rate);
                let energy = world.energy().total();
                advance(&mut world, 1.5);
                most = most.max((world.energy().total() / energy - 1.0).abs());
            }
        }
        within(
            &format!("six dies that jam in their slots at {tolerance:e}: energy, relative"),
            most,
            allowed,
        );
    }
}
