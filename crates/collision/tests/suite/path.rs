//! Bodies whose motion is known at any time.

use glam::DVec2;
use halfgap_collision::{BodyAcceleration, Moving};
use halfgap_geometry::Pose;
use proptest::prelude::*;

/// A body on a path of constant acceleration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path {
    pub(crate) position: DVec2,
    pub(crate) angle: f64,
    pub(crate) velocity: DVec2,
    pub(crate) spin: f64,
    pub(crate) push: BodyAcceleration,
}

impl Path {
    pub(crate) fn at(&self, t: f64) -> Moving {
        let angle = self.angle + self.spin * t + 0.5 * self.push.angular * t * t;
        let position = self.position + self.velocity * t + self.push.linear * (0.5 * t * t);
        Moving {
            pose: Pose::new(position, angle),
            angle,
            velocity: self.velocity + self.push.linear * t,
            angular_velocity: self.spin + self.push.angular * t,
        }
    }
}

pub(crate) fn any_vector(size: f64) -> impl Strategy<Value = DVec2> {
    (-size..size, -size..size).prop_map(|(x, y)| DVec2::new(x, y))
}

pub(crate) fn any_path() -> impl Strategy<Value = Path> {
    let push =
        (any_vector(2.0), -2.0..2.0f64).prop_map(|(linear, angular)| BodyAcceleration { linear, angular });
    (any_vector(2.0), -3.2..3.2f64, any_vector(1.0), -1.0..1.0f64, push)
        .prop_map(|(position, angle, velocity, spin, push)| Path { position, angle, velocity, spin, push })
}
