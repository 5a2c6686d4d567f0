//! Settings and bodies for tests of groups: discs and a block on a floor.

use crate::ode::Method;
use crate::rigid::bodies::trajectory::FreeMotion;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::group::state::Group;
use crate::rigid::parts::{BodyPart, RigidParts};
use crate::rigid::remedies::RemedySet;
use crate::rigid::settings::{RigidSettings, StepControl};
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{Body, BodyState, SearchSettings, Tolerances};
use halfgap_contact::{ImpactLaw, ImpactOrder, Restitution};
use halfgap_geometry::Shape;
use std::f64::consts::{FRAC_PI_4, SQRT_2};

/// Half-width of the target zone as a fraction of the target gap.
const ZONE: f64 = 0.6;

/// Target gap [m] of [`FINE`], far below all that happens in a scene, like the constants after it.
const FINE_GAP: f64 = 1e-10;
/// Relative error of a step of [`FINE`].
const FINE_ERROR: f64 = 1e-11;
/// Velocity tolerance [m/s] of [`FINE`].
const FINE_SLOW: f64 = 1e-9;
/// Rest speed [m/s] of [`FINE`].
const FINE_REST: f64 = 1e-12;
/// Resolution time [s] of [`FINE`].
const FINE_SOON: f64 = 1e-10;

/// Target gap [m] of [`DISCS`].
const DISCS_GAP: f64 = 1e-6;
/// Relative error of a step of [`DISCS`].
const DISCS_ERROR: f64 = 1e-6;
/// Velocity tolerance [m/s] of [`DISCS`].
const DISCS_SLOW: f64 = 1e-3;
/// Rest speed [m/s] of [`DISCS`].
const DISCS_REST: f64 = 1e-10;
/// Resolution time [s] of [`DISCS`].
const DISCS_SOON: f64 = 1e-4;

/// Settings with thresholds far below anything that happens.
pub(crate) const FINE: RigidSettings = RigidSettings {
    impact_law: ImpactLaw::Hybrid,
    order: ImpactOrder::Fastest,
    restitution: Restitution::Energetic,
    method: Method::Dop853,
    search: SearchSettings::STANDARD,
    tolerances: Tolerances { target_gap: FINE_GAP, accuracy: ZONE * FINE_GAP, velocity_tol: FINE_SLOW },
    rest_speed: FINE_REST,
    resolution_time: FINE_SOON,
    region_steps: None,
    steps: StepControl { local_error: FINE_ERROR, length: 1.0, speed: 1.0, largest_step: None },
    collisions: true,
    projection: true,
    joint_small_impacts: false,
    extra: None,
    impulse_step: None,
    without: RemedySet::NONE,
};

/// Settings for discs at rest.
const DISCS: RigidSettings = RigidSettings {
    tolerances: Tolerances { target_gap: DISCS_GAP, accuracy: ZONE * DISCS_GAP, velocity_tol: DISCS_SLOW },
    steps: StepControl { local_error: DISCS_ERROR, length: 0.5, speed: 1.0, largest_step: None },
    rest_speed: DISCS_REST,
    resolution_time: DISCS_SOON,
    ..FINE
};

/// Makes discs of radius 0.5 m and 1 kg at rest on a floor, which is body 0, under gravity, with their centres at the
/// given places [m].
pub(crate) fn resting_discs(places: &[f64]) -> Rooms {
    let disc = Shape::disc(0.5).expect("a fine radius");
    let on_floor = |&place: &f64| {
        let position = DVec2::new(place, 0.5 + DISCS_GAP);
        (disc.clone(), BodyState { position, ..BodyState::default() })
    };
    resting(places.iter().map(on_floor))
}

/// Makes a rounded block of 1 kg that stands on one of its corners, of radius 0.1 m, on such a floor, tilted to 0.2 rad
/// before the end of the corner.
pub(crate) fn block_on_its_corner() -> Rooms {
    let shape = Shape::rounded_block(1.0, 1.0, 0.1).expect("a fine size");
    let tilt = FRAC_PI_4 - 0.2;
    let position = DVec2::new(0.0, 0.1 + 0.4 * SQRT_2 * tilt.cos() + DISCS_GAP);
    let state = BodyState { position, angle: FRAC_PI_4 + tilt, ..BodyState::default() };
    resting([(shape, state)].into_iter())
}

/// Turns the block of [`block_on_its_corner`], whose group this is, to an angle [rad] at a spin [rad/s]; its
/// corner stays on the floor.
pub(crate) fn turn_on_its_corner(group: &mut Group, angle: f64, spin: f64) {
    let tilt = angle - FRAC_PI_4;
    let (height, rise) = (0.1 + 0.4 * SQRT_2 * tilt.cos() + DISCS_GAP, -0.4 * SQRT_2 * tilt.sin() * spin);
    let state = group.state_mut();
    (state[1], state[2]) = (height, angle);
    (state[4], state[5]) = (rise, spin);
}

/// Makes bodies of 1 kg, with the moment of inertia of a disc of radius 0.5 m, at rest on a floor.
fn resting(placed: impl Iterator<Item = (Shape, BodyState)>) -> Rooms {
    let floor = Body {
        shape: Shape::block(20.0, 1.0).expect("a fine size"),
        inverse_mass: 0.0,
        inverse_moment: 0.0,
        elasticity: 0.0,
    };
    let below = BodyState { position: DVec2::new(0.0, -0.5), ..BodyState::default() };
    let mut bodies = vec![BodyPart::new(floor, FreeMotion::default(), below)];
    bodies.extend(placed.map(|(shape, state)| {
        let body = Body { shape, inverse_mass: 1.0, inverse_moment: 8.0, elasticity: 0.0 };
        let free_motion = FreeMotion { acceleration: DVec2::new(0.0, -9.81), ..FreeMotion::default() };
        BodyPart::new(body, free_motion, state)
    }));
    rooms_of(RigidParts { bodies, ..RigidParts::default() }, DISCS, Time::ZERO)
}

/// The rooms of a system of the given parts, at its start.
pub(crate) fn rooms_of(parts: RigidParts, settings: RigidSettings, start: Time) -> Rooms {
    RigidSystem::new(parts, settings, start).expect("fine parts").into_rooms()
}
