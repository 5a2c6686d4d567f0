//! The way that all bodies go together in a run, where nothing holds any of them to the world.

use super::BodySpec;
use crate::connector::ConnectorSpec;
use crate::force::ForceLaw;
use glam::DVec2;
use halfgap_advance::rigid::FreeMotion;
use halfgap_collision::BodyId;
use std::sync::Arc;

/// Bounds the distance [m] by which the centre of mass of several bodies moves in a duration [s] by its velocity and
/// gravity; `None` for one body, if a fixed body, a connector or a force law ties any of them to the world, or if their
/// motion is damped.
///
/// Coordinates grow by that, and their rounding with them, although the bodies stay together. Forces other than gravity do
/// not count: between the bodies they cancel, and those from outside may turn.
pub(super) fn drift(
    bodies: &[BodySpec],
    free_motions: &[FreeMotion],
    (connectors, forces): (&[ConnectorSpec], &[Arc<dyn ForceLaw>]),
    duration: f64,
) -> Option<f64> {
    let is_tied = connectors.iter().any(|spec| spec.connector.bodies().contains(&BodyId::WORLD))
        || forces.iter().any(|law| law.bodies().contains(&BodyId::WORLD) || ends_in_world(law.as_ref()))
        || free_motions.iter().any(FreeMotion::is_damped);
    if is_tied || bodies.len() < 2 {
        return None;
    }
    let (mut mass, mut momentum, mut force) = (0.0, DVec2::ZERO, DVec2::ZERO);
    for (body, law) in bodies.iter().zip(free_motions) {
        let inertia = body.inertia.as_ref()?;
        mass += inertia.mass;
        momentum += inertia.mass * body.state.velocity;
        force += inertia.mass * law.acceleration;
    }
    Some((momentum.length() + 0.5 * force.length() * duration) * duration / mass)
}

fn ends_in_world(law: &dyn ForceLaw) -> bool {
    law.ends().is_some_and(|ends| ends.iter().any(|end| end.body.is_world()))
}
