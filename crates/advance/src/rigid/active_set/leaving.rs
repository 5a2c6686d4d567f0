//! Contacts that run off their features at once: those of a corner at the very end of an edge, along which it moves.
//!
//! Such a contact ends before it has had any effect, but as long as it is active its gap follows the continuation of the
//! edge: as a lid opens, the corner of the box below its hinge would be pressed into the lid. It is excluded if no
//! forces are found with it.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::rows::{RowSource, mechanism, source_of};
use crate::rigid::region::touching::Region;
use crate::rigid::shares::HUGE;
use glam::DVec2;
use halfgap_collision::{BodyId, Collision, Moving};
use halfgap_geometry::{Pose, Rotation};

/// Excludes the records of a region that run off their features while they slide by `accuracy`.
pub(crate) fn retain_staying(assembly: &Assembly, connectors: &Connectors, region: &mut Region) {
    region.retain_records(|record| {
        !leaves_at_once(assembly, connectors, record, |body| assembly.moving_at(body, assembly.now()))
    });
}

fn leaves_at_once(
    assembly: &Assembly,
    connectors: &Connectors,
    record: &Collision,
    moving: impl Fn(BodyId) -> Moving,
) -> bool {
    let Some(RowSource::Contact(features)) = source_of(record) else { return false };
    let bodies = record.bodies();
    let wait = assembly.settings().tolerances.accuracy / record.motion.lateral_velocity.abs();
    if wait.is_nan() || wait > HUGE * assembly.settings().resolution_time {
        return false;
    }
    let moved = bodies.map(|body| after(&moving(body), wait));
    mechanism(assembly, connectors).has_left(bodies, features, [&moved[0], &moved[1]])
}

/// The motion of a body after a time `wait` [s], at constant velocities.
pub(crate) fn after(moving: &Moving, wait: f64) -> Moving {
    let Moving { pose, angle, velocity, angular_velocity } = *moving;
    let turn = Rotation::from_angle(angular_velocity * wait);
    let direction = turn.apply(DVec2::new(pose.rotation.cos, pose.rotation.sin));
    let rotation = Rotation { cos: direction.x, sin: direction.y };
    let pose = Pose { position: pose.position + velocity * wait, rotation };
    Moving { pose, angle: angle + angular_velocity * wait, velocity, angular_velocity }
}
