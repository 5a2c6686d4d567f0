//! Contacts that run off their features at once: of a corner at the very end of an edge, along which it moves.
//!
//! Such a contact is over before it has done anything, but as long as it is held to be one its gap bends with
//! the edge, continued: where a lid opens, the corner of the box below its hinge would be pressed into the
//! lid. It is left out where no forces are found with it.

use super::settling::Settling;
use crate::rigid::event::region::Region;
use crate::rigid::step::dynamics::Stage;
use crate::rigid::step::rows::RowSource;
use crate::rigid::system::RigidSystem;
use glam::DVec2;
use halfgap_collision::{BodyId, Collision, Moving};
use halfgap_geometry::{Pose, Rotation};

/// What leaves does so within so many resolution times: what slides more slowly stays.
const SOON: f64 = 1e3;

impl RigidSystem {
    /// Leaves out the candidates that run off their features while they move by what a contact may be off;
    /// true if there are any. The bodies are in the stage.
    pub(crate) fn drop_leaving(&self, region: &Region, settling: &mut Settling, stage: &Stage) -> bool {
        let before = settling.candidates.len();
        settling.candidates.retain(|&index| !self.leaves_at_once(&region.records[index], stage));
        settling.candidates.len() < before
    }

    fn leaves_at_once(&self, record: &Collision, stage: &Stage) -> bool {
        let Some(RowSource::Contact(features)) = self.source_of(record) else { return false };
        let bodies = record.bodies();
        let wait = self.settings.tolerances.accuracy / record.motion.lateral_velocity.abs();
        if wait.is_nan() || wait > SOON * self.settings.resolution_time {
            return false;
        }
        let moved = bodies.map(|body: BodyId| after(&stage.movings[body.index()], wait));
        self.mechanism().has_left(bodies, features, [&moved[0], &moved[1]])
    }
}

/// A body a little later [s].
fn after(moving: &Moving, wait: f64) -> Moving {
    let Moving { pose, velocity, angular_velocity } = *moving;
    let turn = Rotation::from_angle(angular_velocity * wait);
    let direction = turn.apply(DVec2::new(pose.rotation.cos, pose.rotation.sin));
    let rotation = Rotation { cos: direction.x, sin: direction.y };
    Moving { pose: Pose { position: pose.position + velocity * wait, rotation }, velocity, angular_velocity }
}
