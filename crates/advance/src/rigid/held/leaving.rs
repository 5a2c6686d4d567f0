//! Contacts that run off their features at once: those of a corner at the very end of an edge, along which it moves.
//!
//! Such a contact ends before it has had any effect, but as long as it is held its gap follows the continuation of the
//! edge: as a lid opens, the corner of the box below its hinge would be pressed into the lid. It is left out if no
//! forces are found with it.

use super::settling::Settling;
use crate::rigid::event::region::Region;
use crate::rigid::step::dynamics::Stage;
use crate::rigid::step::rows::RowSource;
use crate::rigid::system::RigidSystem;
use glam::DVec2;
use halfgap_collision::{BodyId, Collision, Moving};
use halfgap_geometry::{Pose, Rotation};

/// Multiple of the resolution time within which a leaving contact slides by `accuracy`; one that slides more slowly
/// stays.
const SOON: f64 = 1e3;

impl RigidSystem {
    /// Leaves out the candidates that run off their features while they slide by `accuracy`; true if there are any. The
    /// bodies are in the stage.
    pub(crate) fn drop_leaving(&self, region: &Region, settling: &mut Settling, stage: &Stage) -> bool {
        let before = settling.candidates.len();
        settling.candidates.retain(|&index| {
            let record = &region.records[index];
            !self.leaves_at_once(record, |body| stage.movings[body.index()])
        });
        settling.candidates.len() < before
    }

    /// Leaves out the records of a region that run off their features while they slide by `accuracy`.
    pub(crate) fn retain_staying(&self, region: &mut Region) {
        region.records.retain(|record| !self.leaves_at_once(record, |body| self.moving_at(body, self.now)));
    }

    fn leaves_at_once(&self, record: &Collision, moving: impl Fn(BodyId) -> Moving) -> bool {
        let Some(RowSource::Contact(features)) = self.source_of(record) else { return false };
        let bodies = record.bodies();
        let wait = self.settings.tolerances.accuracy / record.motion.lateral_velocity.abs();
        if wait.is_nan() || wait > SOON * self.settings.resolution_time {
            return false;
        }
        let moved = bodies.map(|body| after(&moving(body), wait));
        self.mechanism().has_left(bodies, features, [&moved[0], &moved[1]])
    }
}

/// The motion of a body after a time `wait` [s], at constant velocities.
fn after(moving: &Moving, wait: f64) -> Moving {
    let Moving { pose, angle, velocity, angular_velocity } = *moving;
    let turn = Rotation::from_angle(angular_velocity * wait);
    let direction = turn.apply(DVec2::new(pose.rotation.cos, pose.rotation.sin));
    let rotation = Rotation { cos: direction.x, sin: direction.y };
    let pose = Pose { position: pose.position + velocity * wait, rotation };
    Moving { pose, angle: angle + angular_velocity * wait, velocity, angular_velocity }
}
