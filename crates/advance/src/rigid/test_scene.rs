//! Settings and bodies for tests: discs at rest on a floor, for what happens between bodies that are held.

use super::flyer::FlightLaw;
use super::segment::StepControl;
use super::system::{RigidParts, RigidSettings, RigidSystem};
use crate::ode::Method;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{Body, BodyState, SearchSettings, Tolerances};
use halfgap_contact::{ImpactLaw, ImpactOrder};
use halfgap_geometry::Shape;

const TARGET_GAP: f64 = 1e-6;

/// Far finer than anything that happens.
pub(super) const FINE: RigidSettings = RigidSettings {
    tolerances: Tolerances { target_gap: 1e-10, accuracy: 0.6e-10, velocity_tol: 1e-9 },
    law: ImpactLaw::Hybrid,
    order: ImpactOrder::Fastest,
    collisions: true,
    search: SearchSettings::STANDARD,
    method: Method::Dop853,
    steps: StepControl { local_error: 1e-11, length: 1.0, speed: 1.0, largest_step: None },
    projection: true,
    extra: None,
    impulse_step: None,
    joint_small_impacts: false,
    rest_speed: 1e-12,
    resolution_time: 1e-10,
};

const COARSE: RigidSettings = RigidSettings {
    tolerances: Tolerances { target_gap: TARGET_GAP, accuracy: 0.6 * TARGET_GAP, velocity_tol: 1e-3 },
    steps: StepControl { local_error: 1e-6, length: 0.5, speed: 1.0, largest_step: None },
    rest_speed: 1e-10,
    resolution_time: 1e-4,
    ..FINE
};

/// Discs of radius 0.5 m and 1 kg at rest on a floor, which is body 0, under gravity, with their centres at the given places [m].
pub(super) fn resting_discs(places: &[f64]) -> RigidSystem {
    let floor = Body {
        shape: Shape::block(20.0, 1.0).expect("a fine size"),
        inverse_mass: 0.0,
        inverse_moment: 0.0,
        elasticity: 0.0,
    };
    let below = BodyState { position: DVec2::new(0.0, -0.5), ..BodyState::default() };
    let mut bodies = vec![(floor, FlightLaw::default(), below)];
    bodies.extend(places.iter().map(|&place| {
        let shape = Shape::disc(0.5).expect("a fine radius");
        let body = Body { shape, inverse_mass: 1.0, inverse_moment: 8.0, elasticity: 0.0 };
        let gravity = FlightLaw { acceleration: DVec2::new(0.0, -9.81), ..FlightLaw::default() };
        let position = DVec2::new(place, 0.5 + TARGET_GAP);
        (body, gravity, BodyState { position, ..BodyState::default() })
    }));
    RigidSystem::new(RigidParts { bodies, ..RigidParts::default() }, COARSE, Time::ZERO)
        .expect("discs that rest on a floor")
}
