//! Shapes that nearly fit, and shapes of nearly no width.

use super::{impacts, within};
use halfgap::BodyState;
use halfgap::geometry::{DVec2, Shape};
use halfgap_tests::mechanism::{GRAVITY, Workshop, advance, at_rest, block, disc, thrown};
use halfgap_tests::world_of;
use std::fmt::Write;

#[test]
fn a_disc_in_a_ring_wider_by_1e_9_stays_in_and_keeps_its_energy() {
    let clearance = 1e-9;
    let mut shop = Workshop::weightless(1e-8);
    let ring = Shape::ring(2.0, 1.0 + clearance).expect("a fine ring");
    shop.fixed("ring", ring, DVec2::ZERO);
    let speed = 1e-6;
    let ball = shop.body("disc", disc(1.0), 1.0, thrown(0.0, 0.0, DVec2::new(0.6 * speed, 0.8 * speed)));
    let mut world = shop.build();
    let mut count = 0;
    let mut furthest: f64 = 0.0;
    for piece in 1..=200 {
        count += impacts(&mut world, 1e-4 * f64::from(piece));
        furthest = furthest.max(world.state(ball).position.length());
    }
    // Twice the clearance is crossed in 2e-3 s.
    assert!((9..=25).contains(&count), "{count} impacts");
    within("disc in a ring of radius 1 + 1e-9: off its middle [m]", furthest, clearance);
    within(
        "disc in a ring of radius 1 + 1e-9: speed",
        world.state(ball).velocity.length() / speed - 1.0,
        1e-12,
    );
}

#[test]
fn a_disc_hangs_in_a_ring_wider_by_1e_9_and_swings() {
    // A pendulum of 1e-9 m: at rest at the lowest point, it swings if it is moved aside by a tenth of its length. Its
    // frequency, sqrt(g/1e-9) = 1e5 rad/s, is too high to follow, but the contact can be held.
    let clearance = 1e-9;
    let mut shop = Workshop::new(1e-8);
    shop.fixed("ring", Shape::ring(2.0, 1.0 + clearance).expect("a fine ring"), DVec2::ZERO);
    let ball = shop.dull("disc", disc(1.0), 1.0, at_rest(0.0, 0.0));
    let mut world = shop.build();
    advance(&mut world, 1e-2);
    within(
        "disc hangs in a ring of radius 1 + 1e-9: off its middle [m]",
        world.state(ball).position.length(),
        clearance,
    );
    let forces = world.contact_forces();
    assert_eq!(forces.len(), 1);
    within("disc hangs in a ring of radius 1 + 1e-9: force [N]", forces[0].force - GRAVITY, 1e-6);
}

#[test]
fn a_block_that_is_askew_by_1e_9_comes_to_rest_flat() {
    let mut shop = Workshop::new(1e-8);
    shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
    let state = BodyState { angle: 1e-9, ..at_rest(0.0, 1.0) };
    let body = shop.dull("block", block(2.0, 1.0), 1.0, state);
    let mut world = shop.build();
    advance(&mut world, 3.0);
    let state = world.state(body);
    within("block askew by 1e-9 rad at rest: angle [rad]", state.angle, 1e-10);
    within("block askew by 1e-9 rad at rest: spin [rad/s]", state.angular_velocity, 1e-12);
    assert_eq!(world.contact_forces().len(), 2);
}

#[test]
fn two_blocks_askew_by_1e_9_meet_face_to_face() {
    let mut shop = Workshop::weightless(1e-8);
    let bodies = [(-2.0, 0.0, 1.0), (2.0, 1e-9, -1.0)].map(|(x, angle, speed)| {
        let state = BodyState { angle, ..thrown(x, 0.0, DVec2::new(speed, 0.0)) };
        shop.body(if x < 0.0 { "left" } else { "right" }, block(1.0, 1.0), 1.0, state)
    });
    let mut world = shop.build();
    advance(&mut world, 4.0);
    let energy = world.energy().kinetic;
    within("blocks face to face, askew by 1e-9 rad: energy [J]", energy - 1.0, 1e-13);
    let [left, right] = bodies.map(|body| world.state(body));
    assert!(left.velocity.x < 0.0 && right.velocity.x > 0.0, "{left:?} {right:?}");
    within(
        "blocks face to face, askew by 1e-9 rad: momentum [N s]",
        (left.velocity + right.velocity).length(),
        1e-14,
    );
}

/// A triangle with a corner of one degree, its length 1 m, the corner at the lower end.
fn needle() -> Shape {
    let half = 0.5f64.to_radians().tan();
    Shape::polygon(&[DVec2::new(0.0, 0.0), DVec2::new(half, 1.0), DVec2::new(-half, 1.0)]).expect("a needle")
}

#[test]
fn a_needle_falls_on_its_point_and_bounces_straight() {
    let mut shop = Workshop::new(1e-10);
    shop.fixed("floor", block(20.0, 1.0), DVec2::new(0.0, -0.5));
    let body = shop.body("needle", needle(), 1.0, at_rest(0.0, 2.0 / 3.0 + 1.25));
    let mut world = shop.build();
    advance(&mut world, 1.0);
    let state = world.state(body);
    within("needle of 1 degree on its point: height [m]", state.position.y - (2.0 / 3.0 + 1.25), 1e-9);
    within("needle of 1 degree on its point: spin [rad/s]", state.angular_velocity, 1e-10);
}

#[test]
fn two_needles_that_meet_point_to_point_keep_energy_and_momentum() {
    let mut shop = Workshop::weightless(1e-10);
    let up = shop.body("up", needle(), 1.0, thrown(0.0, 1.0, DVec2::new(0.0, -1.0)));
    let down = BodyState { angle: std::f64::consts::PI, ..thrown(1e-3, -1.0, DVec2::new(0.0, 1.0)) };
    let down = shop.body("down", needle(), 1.0, down);
    let mut world = shop.build();
    advance(&mut world, 3.0);
    let momentum = world.state(up).velocity + world.state(down).velocity;
    assert!(world.statistics().impacts > 0);
    within("needles point to point: momentum [N s]", momentum.length(), 1e-14);
    within("needles point to point: energy [J]", world.energy().kinetic - 1.0, 1e-13);
}

/// Error [m] of the place of a block of 1 m that falls for 1.3 s in a channel between walls, which is wider than the
/// block by a clearance [m]. The whole is rotated by an angle [rad] about the origin and shifted.
fn off_through_channel(
    (tolerance, elasticity): (f64, f64),
    (clearance, height): (f64, f64),
    (angle, shift): (f64, DVec2),
) -> f64 {
    const TIME: f64 = 1.3;
    let place = |x: f64, y: f64| DVec2::from_angle(angle).rotate(DVec2::new(x, y)) + shift;
    let down = DVec2::from_angle(angle).rotate(DVec2::new(0.0, -GRAVITY));
    let body = |name: &str, size: &str, place: DVec2| {
        format!(
            "[[body]]\nname = '{name}'\nshape = {{ block = {{ width = 1.0, height = {size} }} }}\n\
             position = [{:?}, {:?}]\nangle = {angle:?}\nelasticity = {elasticity:?}\n",
            place.x, place.y
        )
    };
    let wall = |name: &str, side: f64| body(name, "4.0", place(side * (1.0 + 0.5 * clearance), 0.0));
    let scene = format!(
        "format = 'halfgap-scene-1'\ntitle = 'channel'\n[run]\nduration = 2.0\ntolerance = {tolerance:?}\n\
         {}fixed = true\n{}fixed = true\n{}mass = 1.0\n[[force]]\ngravity = {{ acceleration = [{:?}, {:?}] }}\n",
        wall("left", -1.0),
        wall("right", 1.0),
        body("block", "1.0", place(0.0, height)),
        down.x,
        down.y
    );
    let mut world = world_of(&scene);
    let block = world.find("block").expect("it is there");
    advance(&mut world, TIME);
    world.state(block).position.distance(place(0.0, height - 0.5 * GRAVITY * TIME * TIME))
}

#[test]
fn a_block_falls_through_a_channel_as_wide_as_itself() {
    // The block's corners come out past those of the walls, at distances of mere rounding.
    let placements =
        [(0.0, DVec2::ZERO), (0.7, DVec2::ZERO), (-2.3, DVec2::new(3.0, 4.0)), (1.9, DVec2::new(-4.4, 0.3))];
    let mut furthest = 0.0f64;
    for tolerance in [1e-5, 1e-8, 1e-10] {
        for clearance in [0.0, 1e-12, 1e-11, 5e-11, 1e-10, 1e-8] {
            for (elasticity, height) in [(0.0, 1.0), (1.0, 1.0), (0.0, 3.0), (1.0, 3.0)] {
                for placement in placements {
                    let off = off_through_channel((tolerance, elasticity), (clearance, height), placement);
                    furthest = furthest.max(off);
                }
            }
        }
    }
    within("block falls through a channel as wide as itself: place [m]", furthest, 1e-7);
}

#[test]
fn a_disc_in_a_hollow_that_just_holds_it_fires_where_it_closes_and_nowhere_else() {
    // A disc falls into a groove with a round bottom, 5e-10 m wider than itself, and bounces there. A contact that
    // opens fires again at its own target, which is a fraction of the clearance in a fit as tight as this: at the
    // target of others it would fire all the time.
    let (disc, bottom) = (0.06742892346340036, 0.06742892396340036);
    let mut world = world_of(&format!(
        "format = \"halfgap-scene-1\"\ntitle = \"test\"\nrun = {{ duration = 0.6, tolerance = 1e-5 }}\n\
         force = [{{ gravity = {{ acceleration = [0.0, -9.81] }} }}]\n\
         [[body]]\nname = \"groove\"\nfixed = true\nelasticity = 0.3\ncenter_of_mass = [0.0, 0.0]\n\
         shape = {{ outline = {{ paths = [{{ start = [-1.0, -1.0], edges = [{{ line = [1.0, -1.0] }}, {{ line = [1.0, 1.0] }}, \
         {{ line = [{bottom}, 1.0] }}, {{ line = [{bottom}, 0.0] }}, {{ arc = {{ to = [-{bottom}, 0.0], center = [0.0, 0.0], clockwise = true }} }}, \
         {{ line = [-{bottom}, 1.0] }}, {{ line = [-1.0, 1.0] }}, {{ line = [-1.0, -1.0] }}] }}] }} }}\n\
         [[body]]\nname = \"disc\"\nelasticity = 0.3\nmass = 1.0\nshape = {{ disc = {{ radius = {disc} }} }}\n\
         position = [0.0, 0.6]\nvelocity = [0.0, -2.9090472377626666]\n"
    ));
    let count = impacts(&mut world, 0.6);
    assert!((5..50).contains(&count), "{count} impacts");
    let steps = world.statistics().steps;
    assert!(steps < 200, "{steps} steps");
    let disc = world.find("disc").expect("the disc");
    within("disc in a groove that just holds it: depth [m]", world.state(disc).position.y, 1e-9);
}

#[test]
fn discs_that_part_slowly_within_their_target_zone_take_no_steps_of_their_own() {
    // Three discs run round in a ring one behind the other, each a little faster than the last. Bounds on their
    // turning do not show that they part: each pair fires again and again, and the rules that it gets for this must
    // outlast the events of the other pair.
    const TARGET: f64 = 1e-9;
    const RADIUS: f64 = 0.1;
    const PARTING: f64 = 1e-9;
    let way = 1.0 - RADIUS - TARGET;
    // The discs are nearer than the target by a quarter of the accuracy.
    let apart = 2.0 * RADIUS + TARGET - 1.5e-10;
    let angle = 2.0 * (0.5 * apart / way).asin();
    let mut text = String::from(
        "format = \"halfgap-scene-1\"\ntitle = \"bearing\"\n\
        [run]\nduration = 0.01\ntarget_gap = 1e-9\naccuracy = 6e-10\n\
        [[body]]\nname = \"ring\"\nfixed = true\nshape = { ring = { outer = 1.2, inner = 1.0 } }\n",
    );
    for place in 0..3 {
        let rate = 1.0 + f64::from(place) * PARTING / (way * (0.5 * angle).cos());
        let out = DVec2::from_angle(f64::from(place) * angle);
        let (at, velocity) = (out * way, out.perp() * (rate * way));
        let _ = write!(
            text,
            "[[body]]\nname = \"{place}\"\nmass = 1.0\nelasticity = 0.3\nshape = {{ disc = {{ radius = {RADIUS} }} }}\n\
            position = [{}, {}]\nvelocity = [{}, {}]\n",
            at.x, at.y, velocity.x, velocity.y
        );
    }
    let mut world = world_of(&text);
    advance(&mut world, 0.01);
    let steps = world.statistics().steps;
    assert!(steps <= 50, "{steps} steps");
    let nearest = world.statistics().smallest_gap.expect("they touch");
    within("discs that part in a ring: gap less target [m]", nearest - TARGET, 2e-10);
}

#[test]
fn a_disc_that_fits_without_play_is_held_as_by_a_pin() {
    for tolerance in [1e-3, 1e-6, 1e-8, 1e-10] {
        // A disc hangs in a ring of its own radius.
        let mut shop = Workshop::new(tolerance);
        shop.fixed("ring", Shape::ring(1.0, 0.5).expect("a fine ring"), DVec2::ZERO);
        let ball = shop.dull("disc", disc(0.5), 1.0, at_rest(0.0, 0.0));
        let mut world = shop.build();
        advance(&mut world, 0.5);
        let name = |what: &str| format!("disc in a ring of its own radius, at {tolerance:e}: {what}");
        within(&name("sunk [m]"), world.state(ball).position.length(), 1e-12);
        let held: f64 = world.contact_forces().iter().map(|contact| contact.force * contact.normal.y).sum();
        within(&name("force [N]"), held - GRAVITY, 1e-6);
        // A pin slides along a slot as wide as itself to its round end.
        let mut world = world_of(&format!(
            "format = \"halfgap-scene-1\"\ntitle = \"slot\"\nrun = {{ duration = 2.0, tolerance = {tolerance:e} }}\n\
             [[body]]\nname = \"slot\"\nfixed = true\nelasticity = 0.0\ncenter_of_mass = [0.0, 0.0]\n\
             shape = {{ outline = {{ paths = [{{ start = [-2.0, -1.0], edges = [{{ line = [2.0, -1.0] }}, {{ line = [2.0, 1.0] }}, \
             {{ line = [-2.0, 1.0] }}, {{ line = [-2.0, -1.0] }}] }}, {{ start = [-1.0, -0.2], edges = [{{ line = [1.0, -0.2] }}, \
             {{ arc = {{ to = [1.0, 0.2], center = [1.0, 0.0] }} }}, {{ line = [-1.0, 0.2] }}, \
             {{ arc = {{ to = [-1.0, -0.2], center = [-1.0, 0.0] }} }}] }}] }} }}\n\
             [[body]]\nname = \"pin\"\nmass = 1.0\nshape = {{ disc = {{ radius = 0.2 }} }}\nvelocity = [1.0, 0.0]\n"
        ));
        advance(&mut world, 2.0);
        let pin = world.state(world.find("pin").expect("the pin"));
        within(
            &format!("pin in a slot of its own width, at {tolerance:e}: end [m]"),
            pin.position.x - 1.0,
            1e-12,
        );
        within(
            &format!("pin in a slot of its own width, at {tolerance:e}: speed [m/s]"),
            pin.velocity.length(),
            1e-12,
        );
    }
}
