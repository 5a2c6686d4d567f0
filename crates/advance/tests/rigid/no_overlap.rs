//! Nothing tunnels: brute force checks every two bodies at many times.

use crate::box_of_bodies::*;
use glam::DVec2;
use halfgap_advance::Time;
use halfgap_advance::rigid::{RigidParts, RigidSystem};
use halfgap_collision::{BodyId, BodyState};
use halfgap_geometry::{EdgeSpec, PathSpec, Shape};

/// A block with a round bite out of its top.
fn cradle() -> Shape {
    let at = DVec2::new;
    let edges = vec![
        EdgeSpec::Line { to: at(0.5, -0.3) },
        EdgeSpec::Line { to: at(0.5, 0.2) },
        EdgeSpec::Line { to: at(0.3, 0.2) },
        EdgeSpec::Bulge { to: at(-0.3, 0.2), bulge: -0.7 },
        EdgeSpec::Line { to: at(-0.5, 0.2) },
        EdgeSpec::Line { to: at(-0.5, -0.3) },
    ];
    Shape::from_paths(&[PathSpec { start: at(-0.5, -0.3), edges }]).expect("a fine cradle")
}

fn mixed_shapes() -> Vec<Shape> {
    let fine = "fine measures";
    vec![
        disc(0.3),
        block(0.8, 0.4),
        Shape::capsule(0.9, 0.2).expect(fine),
        Shape::ring(0.5, 0.4).expect(fine),
        Shape::rounded_block(0.7, 0.5, 0.1).expect(fine),
        Shape::regular_polygon(5, 0.4).expect(fine),
        disc(0.15),
        cradle(),
        block(0.9, 0.02),
        Shape::sector(0.5, 2.0).expect(fine),
        disc(0.45),
        Shape::regular_polygon(3, 0.5).expect(fine),
    ]
}

/// Advances in small steps and checks all pairs after each.
fn watch(system: &mut RigidSystem, until: f64, steps: u32) {
    let nearest = TOLERANCES.target_gap - 2.0 * TOLERANCES.accuracy;
    for step in 1..=steps {
        let time = until * f64::from(step) / f64::from(steps);
        advance(system, time).expect("impacts of one or two rows");
        let (distance, [a, b]) = least_distance(system, time);
        assert!(distance >= nearest, "bodies {a:?} and {b:?} are {distance} m apart at {time} s");
    }
}

#[test]
fn mixed_shapes_tumble_in_a_box_without_touching_deeper_than_allowed() {
    for seed in 1..=3 {
        let mut parts = crowd(&mixed_shapes(), 2.0, &mut Random(seed));
        // One disc lives inside of the ring.
        let ring = parts[4 + 3].state;
        parts.push(body(&disc(0.2), moving(ring.position, DVec2::new(1.0, -3.0), 2.0)));
        let mut system = system(parts);
        let before = energy(&system, 0.0);
        watch(&mut system, 10.0, 1500);
        assert!(system.counts().impacts > 150, "{} impacts", system.counts().impacts);
        assert!((energy(&system, 10.0) / before - 1.0).abs() < 1e-12);
    }
}

#[test]
fn nothing_tunnels_while_all_are_pulled_and_damped() {
    let mut parts = crowd(&mixed_shapes(), 2.0, &mut Random(9));
    for (index, part) in parts.iter_mut().enumerate() {
        // Each body is pulled in a direction of its own, so that pairs accelerate against each other.
        part.free_motion.acceleration = DVec2::from_angle(index as f64) * 0.5;
        part.free_motion.linear_rate = 0.02 * (index % 3) as f64;
        part.free_motion.angular_rate = 0.03 * (index % 2) as f64;
    }
    watch(&mut system(parts), 5.0, 800);
}

#[test]
fn a_fast_thin_bullet_does_not_tunnel() {
    let speed = 1e4;
    let mut parts =
        vec![fixed(&block(2.0, 1e-4), DVec2::ZERO), fixed(&block(2.0, 1e-4), DVec2::new(0.0, 3.0))];
    parts.push(body(&block(0.01, 1e-4), moving(DVec2::new(0.1, 1.0), DVec2::new(0.0, speed), 1e3)));
    let mut system = system(parts);
    advance(&mut system, 1.0).expect("one body between two plates");
    assert!(system.counts().impacts > 2000, "{} impacts", system.counts().impacts);
    let state = states(&system, 1.0)[2];
    assert!(state.position.y > 0.0 && state.position.y < 3.0, "it is at {}", state.position);
}

#[test]
fn excluded_pairs_pass_through_each_other() {
    let state = |x: f64, v: f64| moving(DVec2::new(x, 0.0), DVec2::new(v, 0.0), 0.0);
    let parts = || vec![body(&disc(0.5), state(-2.0, 1.0)), body(&disc(0.5), state(2.0, -1.0))];
    let mut apart = system(parts());
    advance(&mut apart, 4.0).expect("one impact");
    assert!(states(&apart, 4.0)[0].velocity.x < 0.0);
    // The order in which the two are named does not matter.
    for excluded in [(BodyId(0), BodyId(1)), (BodyId(1), BodyId(0))] {
        let parts = RigidParts { bodies: parts(), excluded: vec![excluded], ..RigidParts::default() };
        let mut through = system_of(parts, Time::ZERO);
        advance(&mut through, 4.0).expect("nothing happens");
        assert_eq!(states(&through, 4.0)[0].position, DVec2::new(2.0, 0.0));
        assert_eq!(through.counts().impacts, 0);
    }
}

#[test]
fn a_body_set_spinning_in_place_is_seen_to_sweep_more_room_than_it_had() {
    // Two discs hit a resting bar at the same time at its two ends from opposite sides: it spins without moving, and
    // its tips reach a disc that was outside of its box.
    let bar = body(&block(4.0, 0.1), BodyState::default());
    let hit = |x: f64, v: f64| body(&disc(0.25), moving(DVec2::new(x, -v), DVec2::new(0.0, v), 0.0));
    let target = body(&disc(0.25), moving(DVec2::new(0.0, 1.5), DVec2::ZERO, 0.0));
    let mut system = system(vec![bar, hit(1.75, 1.0), hit(-1.75, -1.0), target]);
    advance(&mut system, 1.0).expect("two impacts at once");
    let bar = states(&system, 1.0)[0];
    assert!(bar.velocity.length() < 1e-15 && bar.angular_velocity > 0.1);
    watch(&mut system, 20.0, 2000);
    assert!(states(&system, 20.0)[3].velocity.length() > 0.0, "the bar passed through the disc");
}
