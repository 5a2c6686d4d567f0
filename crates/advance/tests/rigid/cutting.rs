//! Events in the middle of steps: contacts are met at their target gap however loose the steps are, and active rows stay
//! where they were.

use crate::box_of_bodies::*;
use glam::DVec2;
use halfgap_advance::rigid::{
    ForceLaw, RigidParts, RigidSettings, RigidSystem, Snapshot, StepControl, Wrenches,
};
use halfgap_advance::{Time, advance_until};
use halfgap_collision::{Anchor, BodyId, Connector, ConnectorKind, Tolerances};
use std::sync::Arc;

/// A spring of 1 N/m from the origin to the centre of a body.
#[derive(Debug)]
struct Home([BodyId; 1]);

impl ForceLaw for Home {
    fn name(&self) -> &str {
        "home"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.0
    }

    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>) {
        let position = now.body(self.0[0]).pose.position;
        wrenches.add_force(self.0[0], -position, DVec2::ZERO);
    }
}

/// Least gap [m] at which a disc meets a wall, if it swings to and fro by a little more than there is room.
fn gap_of_a_swing(room: f64, until: f64) -> f64 {
    let mut disc = body(&disc(0.5), moving(DVec2::new(-1.0, 0.0), DVec2::ZERO, 0.0));
    disc.body.inverse_mass = 1.0;
    let wall = fixed(&block(1.0, 4.0), DVec2::new(room + 0.5 + 0.5, 0.0));
    let force_laws: Vec<Arc<dyn ForceLaw>> = vec![Arc::new(Home([BodyId(1)]))];
    let parts = RigidParts { bodies: vec![wall, disc], force_laws, ..RigidParts::default() };
    let settings = RigidSettings {
        tolerances: Tolerances { velocity_tol: 1e-2, ..TOLERANCES },
        steps: StepControl { local_error: 1e-6, ..SETTINGS.steps },
        ..SETTINGS
    };
    let mut system = RigidSystem::new(parts, settings, Time::ZERO).expect("nothing touches");
    advance_until(&mut system, Time::from_seconds(until), |_, _| {}).expect("one contact");
    assert!(system.counts().impacts > 0, "it does not meet the wall");
    system.counts().smallest_gap.expect("it meets the wall")
}

#[test]
fn a_slow_contact_is_met_at_its_target_by_steps_that_err_by_more() {
    // The disc turns back at 1 m: that near to it, it is slower than the speed from which elasticity acts.
    let gap = gap_of_a_swing(1.0 - 1e-5, 4.0);
    assert!((gap - TOLERANCES.target_gap).abs() <= TOLERANCES.accuracy, "{gap:e} m");
}

#[test]
fn a_rope_that_is_nearly_taut_is_held_where_it_is() {
    let anchor = |body, y| Anchor { body, point: DVec2::new(0.0, y) };
    let slack = 0.5 * TOLERANCES.accuracy;
    for (a, b) in [(0.0, 0.0), (0.0, 0.01)] {
        let hung = moving(DVec2::new(0.0, -1.0 - b + slack), DVec2::ZERO, 0.0);
        let mut disc = body(&disc(0.5), hung);
        disc.free_motion.acceleration = DVec2::new(0.0, -10.0);
        let rope = ConnectorKind::Rope { a: anchor(BodyId::WORLD, a), b: anchor(BodyId(0), b), length: 1.0 };
        let connectors = vec![Connector::new(rope, 0.0).expect("a fine rope")];
        let parts = RigidParts { bodies: vec![disc], connectors, ..RigidParts::default() };
        let system = system_of(parts, Time::ZERO);
        assert_eq!(system.row_forces(Time::ZERO).len(), 1, "it hangs on it");
        assert_eq!(system.trajectory(BodyId(0)).state_at(Time::ZERO), hung);
    }
}
