//! Determinism: the same input gives the same bits, in whatever pieces the run is asked for, and a motion can be
//! undone.

use crate::box_of_bodies::*;
use glam::DVec2;
use halfgap_advance::Time;
use halfgap_advance::rigid::{BodyPart, RigidParts, RigidSystem};
use halfgap_collision::BodyState;
use halfgap_geometry::Shape;

fn bits(system: &RigidSystem, time: f64) -> Vec<[u64; 6]> {
    let of = |state: BodyState| {
        let (x, v) = (state.position, state.velocity);
        [x.x, x.y, state.angle, v.x, v.y, state.angular_velocity].map(f64::to_bits)
    };
    states(system, time).into_iter().map(of).collect()
}

fn mixed() -> RigidSystem {
    let shapes =
        [disc(0.3), block(0.6, 0.3), Shape::capsule(0.7, 0.15).expect("fine"), block(0.4, 0.4), disc(0.2)];
    system(crowd(&shapes, 2.0, &mut Random(5)))
}

#[test]
fn two_equal_systems_end_in_the_same_bits() {
    let (mut one, mut other) = (mixed(), mixed());
    advance(&mut one, 20.0).expect("a lively box");
    advance(&mut other, 20.0).expect("a lively box");
    assert!(one.counts().impacts > 50);
    assert_eq!(bits(&one, 20.0), bits(&other, 20.0));
    assert_eq!(one.counts(), other.counts());
}

#[test]
fn a_thousand_pieces_end_in_the_same_bits_as_one() {
    let (mut whole, mut pieces) = (mixed(), mixed());
    advance(&mut whole, 20.0).expect("a lively box");
    for piece in 1..=1000 {
        let time = 20.0 * f64::from(piece) / 1000.0;
        advance(&mut pieces, time).expect("a lively box");
        // Reading a state changes nothing.
        assert!(energy(&pieces, time) > 0.0);
    }
    assert_eq!(bits(&whole, 20.0), bits(&pieces, 20.0));
    assert_eq!(whole.counts(), pieces.counts());
}

#[test]
fn elastic_discs_run_backwards_to_where_they_started() {
    let start = |count| discs_in_a_box(count, &mut Random(11));
    let until = 2.0;
    let mut there = system(start(9));
    advance(&mut there, until).expect("single impacts");
    assert!((20..100).contains(&there.counts().impacts), "{} impacts", there.counts().impacts);
    let turned = states(&there, until).into_iter().map(|state| BodyState {
        velocity: -state.velocity,
        angular_velocity: -state.angular_velocity,
        ..state
    });
    let back = start(9).into_iter().zip(turned).map(|(part, state)| BodyPart { state, ..part });
    let mut back = system(back.collect());
    advance(&mut back, until).expect("single impacts");
    assert_eq!(back.counts().impacts, there.counts().impacts);
    for (part, last) in start(9).iter().zip(states(&back, until)) {
        let first = part.state;
        let error = (first.position - last.position).length();
        assert!(error < 1e-9, "off by {error} m");
        assert!((first.velocity + last.velocity).length() < 1e-8);
    }
}

#[test]
fn a_late_clock_changes_nothing_but_the_clock() {
    let parts = || discs_in_a_box(9, &mut Random(3));
    let offset = 1024.0;
    let mut early = system(parts());
    let mut late =
        system_of(RigidParts { bodies: parts(), ..RigidParts::default() }, Time::from_seconds(offset));
    advance(&mut early, 4.0).expect("single impacts");
    advance(&mut late, offset + 4.0).expect("single impacts");
    assert_eq!(early.counts().impacts, late.counts().impacts);
    for (a, b) in states(&early, 4.0).iter().zip(states(&late, offset + 4.0)) {
        let error: DVec2 = a.position - b.position;
        assert!(error.length() < 1e-9, "off by {} m", error.length());
    }
}
