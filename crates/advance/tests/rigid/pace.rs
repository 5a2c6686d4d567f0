//! Pace: a run whose steps would never reach its end is told.

use crate::box_of_bodies::*;
use glam::DVec2;
use halfgap_advance::rigid::{AdvanceError, ForceLaw, RigidParts, RigidSystem, Snapshot, Wrenches};
use halfgap_advance::{Time, advance_until};
use halfgap_collision::BodyId;
use std::f64::consts::PI;
use std::sync::Arc;

/// A disc of 1 m width that a spring holds to the origin.
#[derive(Debug)]
struct Hum;

/// Frequency [rad/s] of its swing.
const FREQUENCY: f64 = 1e8;

impl ForceLaw for Hum {
    fn name(&self) -> &str {
        "hum"
    }

    fn bodies(&self) -> &[BodyId] {
        &[BodyId(0)]
    }

    fn apply(&self, now: &Snapshot<'_>, out: &mut Wrenches<'_>) {
        let stiffness = 0.25 * PI * FREQUENCY * FREQUENCY;
        out.add_force(BodyId(0), -stiffness * now.body(BodyId(0)).pose.position, DVec2::ZERO);
    }
}

/// Advances a humming body through some 150,000 steps of a run with the given duration [s].
fn hum(duration: f64) -> (Result<(), AdvanceError>, RigidSystem) {
    let disc = body(&disc(0.5), moving(DVec2::new(1e-3, 0.0), DVec2::ZERO, 0.0));
    let parts = RigidParts { bodies: vec![disc], force_laws: vec![Arc::new(Hum)], ..RigidParts::default() };
    let mut system = RigidSystem::new(parts, SETTINGS, Time::ZERO).expect("nothing touches");
    system.set_duration(duration);
    let outcome = advance_until(&mut system, Time::from_seconds(6e4 / FREQUENCY), |_, _| ());
    (outcome, system)
}

#[test]
fn steps_that_would_never_come_to_an_end_are_told() {
    let (outcome, system) = hum(1e6);
    let Err(AdvanceError::Crawls { time, step, duration, bodies, force_laws }) = outcome else {
        panic!("{outcome:?}, {:?}", system.counts())
    };
    assert!(step > 0.01 / FREQUENCY && step < 10.0 / FREQUENCY, "{step}");
    assert!((time / step - 1e5).abs() < 1e3, "after {} steps", time / step);
    assert_eq!((duration, bodies, force_laws), (1e6, vec![BodyId(0)], vec!["hum".to_owned()]));
}

#[test]
fn steps_that_will_come_to_an_end_are_not() {
    for duration in [0.0, 10.0] {
        let (outcome, system) = hum(duration);
        assert_eq!(outcome, Ok(()));
        assert!(system.counts().segments > 100_000, "{:?}", system.counts());
    }
}
