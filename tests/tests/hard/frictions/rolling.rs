//! Discs that roll over many turns, joints and plates, and belts.

use super::{block, body, disc, energy_change, floor, gravity, state, world_of};
use crate::within;
use halfgap::Event;
use halfgap::geometry::DVec2;
use halfgap_tests::mechanism::{GRAVITY, advance};
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

#[test]
fn a_disc_rolls_a_thousand_turns_on_a_plane_as_far_as_it_has_turned() {
    let rolling = "velocity = [3.0, 0.0]\nangular_velocity = -6.0";
    let parts = [floor(8e3, 0.5), body("disc", &disc(0.5), [0.0, 0.5], 0.5, rolling), gravity(0.0, -GRAVITY)];
    let mut world = world_of(&parts.concat());
    let way = 1000.0 * PI;
    advance(&mut world, way / 3.0);
    let disc = state(&world, "disc");
    within("1,000 turns on a plane: way [m]", disc.position.x - way, 1e-9);
    within("1,000 turns on a plane: way less the turn's [m]", disc.position.x + 0.5 * disc.angle, 1e-12);
    within("1,000 turns on a plane: energy [J]", energy_change(&world), 1e-12);
}

/// The disc's centre goes round at a distance of 1.5 m with 3 m/s, and the disc turns back three times a round.
#[test]
fn a_disc_rolls_round_the_inside_of_a_ring_a_thousand_times() {
    let ring = "[[body]]\nname = \"ring\"\nfixed = true\nfriction = 0.5\nelasticity = 0.0\nshape = { ring = { outer = 2.5, inner = 2.0 } }\n";
    let rolling = "velocity = [3.0, 0.0]\nangular_velocity = -6.0";
    let mut world = world_of(&(ring.to_owned() + &body("disc", &disc(0.5), [0.0, -1.5], 0.5, rolling)));
    advance(&mut world, 1000.0 * TAU / 2.0);
    let disc = state(&world, "disc");
    within("1,000 turns in a ring: phase [turns]", disc.position.x.atan2(-disc.position.y) / TAU, 1e-8);
    within("1,000 turns in a ring: turned [turns]", disc.angle / TAU + 3000.0, 3e-8);
    within("1,000 turns in a ring: energy, relative", world.energy().kinetic / 6.75 - 1.0, 1e-10);
    within("1,000 turns in a ring: heat [J]", world.ledger().friction, 1e-15);
}

/// No impulse turns the disc about the point below it: v r - w r^2/2 stays, and rolling it is 3/2 v r.
#[test]
fn a_disc_that_bounces_ever_lower_ends_rolling_with_the_speed_that_its_turn_leaves() {
    for friction in [0.05, 0.1, 0.3] {
        let lively = floor(100.0, friction).replace("elasticity = 0.0", "elasticity = 0.5");
        let more = "elasticity = 0.5\nvelocity = [1.0, 0.0]\nangular_velocity = 3.0";
        let thrown = body("disc", &disc(0.5), [0.0, 0.55], friction, more);
        let mut world = world_of(&[lively, thrown, gravity(0.0, -GRAVITY)].concat());
        advance(&mut world, 3.0);
        let disc = state(&world, "disc");
        let what = format!("disc that bounces out with mu {friction}");
        within(&format!("{what}: speed [m/s]"), disc.velocity.x - (2.0 - 0.5 * 3.0) / 3.0, 1e-12);
        within(&format!("{what}: slip [m/s]"), disc.velocity.x + 0.5 * disc.angular_velocity, 1e-12);
        within(&format!("{what}: books [J]"), world.ledger().integration_error(), 1e-13);
    }
}

/// A surface of lines and arcs that go on from each other without a corner.
#[derive(Default)]
struct Track {
    end: DVec2,
    direction: f64,
    edges: Vec<String>,
}

impl Track {
    fn line(&mut self, length: f64) {
        self.end += length * DVec2::from_angle(self.direction);
        self.edges.push(format!("{{ line = [{:?}, {:?}] }}", self.end.x, self.end.y));
    }

    fn arc(&mut self, radius: f64, turn: f64) {
        let out = radius * turn.signum() * DVec2::from_angle(self.direction).perp();
        let center = self.end + out;
        self.direction += turn;
        self.end = center - radius * turn.signum() * DVec2::from_angle(self.direction).perp();
        self.edges.push(format!(
            "{{ arc = {{ to = [{:?}, {:?}], center = [{:?}, {:?}], clockwise = {} }} }}",
            self.end.x,
            self.end.y,
            center.x,
            center.y,
            turn < 0.0
        ));
    }
}

#[test]
fn a_disc_rolls_over_a_hundred_joints_of_lines_and_arcs_without_loss() {
    let mut track = Track::default();
    track.line(4.0);
    for _ in 0..20 {
        track.arc(5.0, -0.3);
        track.line(0.5);
        track.arc(5.0, 0.6);
        track.line(0.5);
        track.arc(5.0, -0.3);
    }
    track.line(4.0);
    let right = track.end.x;
    let surface = track.edges.join(", ");
    let shape = format!(
        "outline = {{ paths = [{{ start = [0.0, 0.0], edges = [{surface}, {{ line = [{right:?}, -8.0] }}, {{ line = [0.0, -8.0] }}, {{ line = [0.0, 0.0] }}] }}] }}"
    );
    let rolling = "velocity = [2.0, 0.0]\nangular_velocity = -5.0";
    let parts = [
        format!(
            "[[body]]\nname = \"track\"\nfixed = true\nfriction = 2.0\nelasticity = 0.0\norigin = [0.0, 0.0]\nshape = {{ {shape} }}\n"
        ),
        body("disc", &disc(0.4), [1.0, 0.4], 2.0, rolling),
        gravity(0.0, -GRAVITY),
    ];
    let mut world = world_of(&parts.concat());
    let (mut joints, mut others) = (0, 0);
    let mut tell = |event: &Event| match event {
        Event::ContactBegins(_) => joints += 1,
        Event::ContactEnds(_) => {}
        _ => others += 1,
    };
    world.advance_to(55.5, &mut tell).expect("it rolls");
    let disc = state(&world, "disc");
    assert!(disc.position.x > right - 4.0 && joints >= 100 && others == 0, "{disc:?}, {joints}, {others}");
    within("disc over 100 joints: energy [J]", energy_change(&world), 1e-9);
    within("disc over 100 joints: slip [m/s]", disc.velocity.length() + 0.4 * disc.angular_velocity, 1e-10);
    // On the plane at the end the disc has turned as on the plane at the start.
    within("disc over 100 joints: speed [m/s]", disc.velocity.x - 2.0, 1e-9);
    assert_eq!(world.ledger().friction, 0.0);
}

/// Plates of M with a spring between them and two discs of m that roll on both: either plate goes u, the discs turn by
/// u/r where they are, and (M + m/2) u'' = k (c - 2 u) if the spring is c too short at the start.
#[test]
fn discs_between_plates_that_a_spring_drives_apart_turn_where_they_are() {
    let plate = block(6.0, 0.2);
    let (radius, stiffness, short, time) = (0.25, 8.0, 0.3, 3.0);
    let parts = [
        floor(100.0, 0.0),
        body("lower", &plate, [0.0, 0.1], 0.5, "mass = 2.0"),
        body("left", &disc(radius), [-1.0, 0.45], 0.5, ""),
        body("right", &disc(radius), [1.0, 0.45], 0.5, ""),
        body("upper", &plate, [0.0, 0.8], 0.5, "mass = 2.0"),
        gravity(0.0, -GRAVITY),
        format!(
            "[[force]]\nspring = {{ a = {{ body = \"lower\", point = [-2.0, 0.7] }}, b = {{ body = \"upper\", point = [2.0, 0.0] }}, \
             rest_length = {:?}, stiffness = {stiffness:?} }}\n",
            4.0 + short
        ),
    ];
    let mut world = world_of(&parts.concat());
    let mut events = 0;
    world.advance_to(time, &mut |_| events += 1).expect("they roll");
    let rate = (2.0 * stiffness / 2.5f64).sqrt();
    let way = 0.5 * short * (1.0 - (rate * time).cos());
    within("plates on discs: upper [m]", state(&world, "upper").position.x - way, 1e-10);
    within("plates on discs: lower [m]", state(&world, "lower").position.x + way, 1e-10);
    within("plates on discs: disc moved [m]", state(&world, "left").position.x + 1.0, 1e-12);
    within("plates on discs: disc turned [rad]", state(&world, "left").angle + way / radius, 1e-10);
    assert_eq!(events, 0);
}

/// Belts that run to each other pull a block h/2 above them to the middle between them, 2 d apart: the nearer one
/// bears more, and x'' = -mu g x/(d - mu h/2).
#[test]
fn a_block_on_belts_that_run_to_each_other_swings() {
    let (friction, apart, half, time) = (0.3, 1.0, 0.1, 10.0);
    let mut parts = gravity(0.0, -GRAVITY);
    for side in [-1.0, 1.0] {
        let _ = write!(
            parts,
            "[[body]]\nname = \"roller {side}\"\nfixed = true\nelasticity = 0.0\nfriction = {friction:?}\nsurface_velocity = {:?}\n\
             shape = {{ disc = {{ radius = 0.5 }} }}\nposition = [{:?}, -0.5]\n",
            5.0 * side,
            apart * side
        );
    }
    for (start, what) in [(0.4, "block on two belts"), (0.0, "block in the middle of two belts")] {
        let plank = body("block", &block(6.0, 2.0 * half), [start, half], friction, "");
        let mut world = world_of(&(parts.clone() + &plank));
        advance(&mut world, time);
        let rate = (friction * GRAVITY / (apart - friction * half)).sqrt();
        let off = state(&world, "block").position.x - start * (rate * time).cos();
        within(&format!("{what}, 10 s: place [m]"), off, 1e-10);
        within(&format!("{what}, 10 s: books [J]"), world.ledger().integration_error(), 1e-11);
    }
}
