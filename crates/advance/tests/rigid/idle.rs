//! Contacts that touch without force, and ropes that are taut without force, are watched from step to step: the search
//! does not look for them.

use crate::box_of_bodies::*;
use glam::DVec2;
use halfgap_advance::Time;
use halfgap_advance::rigid::{RigidParts, RigidSystem};
use halfgap_collision::{Anchor, BodyId, BodyState, Connector, ConnectorKind};

/// Number of times at which anything happens in a few swings: far fewer than a search would look.
const FEW: u64 = 1000;
/// Duration [s] of a run.
const WHILE: f64 = 3.0;

/// Discs of radius 0.5 m that touch side by side, each on rods or ropes of 1 m from above, let go at 0.5 rad.
fn swinging(discs: usize, ties: &[fn(Anchor, Anchor) -> ConnectorKind]) -> RigidSystem {
    let arm = DVec2::from_angle(0.5 - std::f64::consts::FRAC_PI_2);
    let hangs = |index: usize| DVec2::new(index as f64 * (1.0 + TOLERANCES.target_gap), 0.0);
    let parts = (0..discs).map(|index| {
        let state = BodyState { position: hangs(index) + arm, ..BodyState::default() };
        let mut part = body(&disc(0.5), state);
        part.free_motion.acceleration = DVec2::new(0.0, -10.0);
        part
    });
    let connectors = (0..discs).flat_map(|index| {
        ties.iter().map(move |tie| {
            let a = Anchor { body: BodyId::WORLD, point: hangs(index) };
            let b = Anchor { body: BodyId(index as u32), point: DVec2::ZERO };
            Connector::new(tie(a, b), 0.0).expect("a fine connector")
        })
    });
    let parts =
        RigidParts { bodies: parts.collect(), connectors: connectors.collect(), ..RigidParts::default() };
    RigidSystem::new(parts, SETTINGS, Time::ZERO).expect("it hangs")
}

fn rod(a: Anchor, b: Anchor) -> ConnectorKind {
    ConnectorKind::Rod { a, b, length: 1.0 }
}

fn rope(a: Anchor, b: Anchor) -> ConnectorKind {
    ConnectorKind::Rope { a, b, length: 1.0 }
}

/// Requires that the bodies swing as a single one does, and that few events are handled.
fn require_idle(mut system: RigidSystem, alone: &mut RigidSystem, what: &str) {
    advance(&mut system, WHILE).expect("it swings");
    advance(alone, WHILE).expect("it swings");
    let (found, expected) = (states(&system, WHILE)[0].position, states(alone, WHILE)[0].position);
    assert!(found.distance(expected) < 1e-7, "{what}: {found} m for {expected} m");
    assert!(system.counts().events < FEW, "{what}: {:?}", system.counts());
}

#[test]
fn discs_that_swing_side_by_side_are_not_searched() {
    require_idle(swinging(5, &[rod]), &mut swinging(1, &[rod]), "five discs");
}

#[test]
fn a_rope_beside_what_holds_already_is_not_searched() {
    require_idle(swinging(1, &[rod, rope]), &mut swinging(1, &[rod]), "a rope beside a rod");
    require_idle(swinging(1, &[rope, rope]), &mut swinging(1, &[rod]), "two ropes");
}

#[test]
fn a_block_that_turns_in_a_ring_it_just_fits_is_not_searched() {
    let side = 1.0;
    let inner = 0.5 * side * 2f64.sqrt() + TOLERANCES.target_gap;
    let ring = halfgap_geometry::Shape::ring(2.0 * inner, inner).expect("fine radii");
    let turning = body(&block(side, side), moving(DVec2::ZERO, DVec2::ZERO, 1.0));
    let mut system = system(vec![fixed(&ring, DVec2::ZERO), turning]);
    advance(&mut system, WHILE).expect("it turns");
    let state = states(&system, WHILE)[1];
    assert!((state.angle - WHILE).abs() < 1e-9 && state.position.length() < 1e-9, "{state:?}");
    assert!(system.counts().events < FEW, "{:?}", system.counts());
}
