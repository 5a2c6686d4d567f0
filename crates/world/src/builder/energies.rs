//! Energies by which the monitor of a world judges whether its books close.

use super::TIME_TO_MOVE;
use super::joints::Joints;
use crate::force::Wrench;
use crate::invariant_monitor::EnergyScales;
use crate::settings::WorldSettings;
use crate::world::Start;
use halfgap_advance::rigid::BodyPart;
use halfgap_collision::{ConnectorKind, Coordinate, Tolerances};
use halfgap_geometry::Aabb;

/// Least kinetic energy that counts beside rounding, in machine epsilons of the energy of crossing all coordinates in
/// the run.
const LOST_ROUNDINGS: f64 = 1e4;
/// Distance along which the work of the forces is lost to the accuracy of active rows, in tolerances of a body's size.
const LOST_TOLERANCES: f64 = 10.0;

/// Scales of the energy after the correction at the start, under forces [N] and torques [N m] of a size.
pub(super) fn energy_scales(
    bodies: &[BodyPart],
    (forces, torques): (f64, f64),
    start: &Start,
    (settings, tolerances): (&WorldSettings, &Tolerances),
) -> EnergyScales {
    let (usual, still) = (usual_energy(bodies, forces) + torques, still_energy(bodies, settings));
    EnergyScales {
        usual: if usual > still { usual } else { 0.0 },
        rough: tolerances.target_gap * forces,
        lost: lost_energy(bodies, (forces, torques), settings) + still,
        left: f64::EPSILON * start.energy_change.abs(),
    }
}

/// Kinetic energy of the bodies, and work of forces of a size [N] across all of them [J].
fn usual_energy(bodies: &[BodyPart], forces: f64) -> f64 {
    let bounds = bodies.iter().map(|part| part.body.shape.bounds_at(&part.state.pose()));
    let size = bounds.reduce(Aabb::union).map_or(0.0, |all| all.size().length());
    let kinetic = bodies.iter().map(|part| part.body.kinetic_energy(&part.state));
    kinetic.sum::<f64>() + forces * size
}

/// Work of forces of a size [N] within the tolerance of the bodies' sizes, and of torques [N m] within the angle by
/// which that turns a body, and energy of the bodies at a speed that is rounding of their coordinates [J].
fn lost_energy(bodies: &[BodyPart], (forces, torques): (f64, f64), settings: &WorldSettings) -> f64 {
    let reach = movable(bodies).map(|part| part.body.shape.reach()).fold(0.0, f64::max);
    let rounding = settings.duration.map_or(0.0, |duration| crossing_energy(bodies, duration));
    let lost = LOST_TOLERANCES * settings.tolerance;
    LOST_ROUNDINGS * f64::EPSILON * rounding + (forces * reach + torques) * lost
}

/// Energy [J] of bodies that move by a rounding of their coordinates in the whole run.
fn still_energy(bodies: &[BodyPart], settings: &WorldSettings) -> f64 {
    let time = settings.duration.unwrap_or(TIME_TO_MOVE);
    f64::EPSILON * f64::EPSILON * crossing_energy(bodies, time)
}

/// Twice the kinetic energy [J] of the movable bodies at the speed that covers the largest coordinate in a time [s].
fn crossing_energy(bodies: &[BodyPart], time: f64) -> f64 {
    let farthest = |part: &BodyPart| part.state.position.abs().max_element() + part.body.shape.reach();
    let speed = bodies.iter().map(farthest).fold(0.0, f64::max) / time;
    let mass: f64 = movable(bodies).map(|part| part.body.inverse_mass.recip()).sum();
    mass * speed * speed
}

fn movable(bodies: &[BodyPart]) -> impl Iterator<Item = &BodyPart> {
    bodies.iter().filter(|part| !part.body.is_fixed())
}

/// Sums of the sizes of the forces [N] and torques [N m] on the movable bodies, and of the motors.
pub(super) fn acting_on(bodies: &[BodyPart], wrenches: &[Wrench], joints: &Joints) -> (f64, f64) {
    let (mut forces, mut torques) = (forces_on(bodies, wrenches), torques_on(bodies, wrenches));
    for connector in joints.all() {
        match &connector.kind {
            // Dry friction and brakes answer others.
            ConnectorKind::Pull { speed: 0.0, .. } => {}
            ConnectorKind::Pull { coordinate: Coordinate::Angle { .. }, most, .. } => torques += most,
            ConnectorKind::Pull { coordinate: Coordinate::Along { .. }, most, .. } => forces += most,
            _ => {}
        }
    }
    (forces, torques)
}

/// Sum of the sizes of the forces [N] on the movable bodies.
fn forces_on(bodies: &[BodyPart], wrenches: &[Wrench]) -> f64 {
    let movable = bodies.iter().zip(wrenches).filter(|(part, _)| !part.body.is_fixed());
    let forces =
        movable.map(|(part, wrench)| wrench.force + part.free_motion.acceleration / part.body.inverse_mass);
    forces.map(|force| force.length()).sum()
}

/// Sum of the sizes of the torques [N m] on the movable bodies: their work over a radian [J].
fn torques_on(bodies: &[BodyPart], wrenches: &[Wrench]) -> f64 {
    let movable = bodies.iter().zip(wrenches).filter(|(part, _)| !part.body.is_fixed());
    movable.map(|(_, wrench)| wrench.torque.abs()).sum()
}
