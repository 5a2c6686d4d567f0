//! Fixed bodies that are moved as prescribed, whatever pushes them.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::trajectory::Trajectory;
use crate::time::Time;
use halfgap_collision::{BodyAcceleration, BodyId, BodyMotion, MovedPath, Moving};

impl Trajectory {
    /// Acceleration of a body that is moved, at a time; 0 of others.
    pub(crate) fn prescribed_acceleration(&self, time: Time) -> BodyAcceleration {
        self.moved().map_or(BodyAcceleration::default(), |moved| moved.acceleration_at(self.offset(time)))
    }

    /// The first time [s] later than `after` at which a prescribed motion is not smooth.
    pub(crate) fn next_kink(&self, after: f64) -> Option<f64> {
        self.moved().map(MovedPath::motion)?.next_kink(after)
    }
}

impl Assembly {
    /// True if any body is moved.
    #[inline]
    pub(crate) fn any_moved(&self) -> bool {
        self.any_moved
    }

    /// True for a fixed body that is moved.
    pub(crate) fn is_moved(&self, body: BodyId) -> bool {
        self.any_moved && !body.is_world() && self.trajectory(body).moved().is_some()
    }

    /// Acceleration of a body that is moved, now; 0 of others, also of those that can move.
    pub(crate) fn prescribed_acceleration(&self, body: BodyId) -> BodyAcceleration {
        if self.is_moved(body) {
            self.trajectory(body).prescribed_acceleration(self.now())
        } else {
            BodyAcceleration::default()
        }
    }

    /// Rate [m/s] of what has given coefficients by the velocities of those of two bodies that are moved, at a time.
    pub(crate) fn moved_rate(&self, bodies: [BodyId; 2], coefficients: &[f64; 6], time: Time) -> f64 {
        if !self.any_moved {
            return 0.0;
        }
        let sides = bodies.into_iter().zip(coefficients.as_chunks::<3>().0);
        let of_moved = sides.filter(|(body, _)| self.is_moved(*body));
        of_moved.map(|(body, j)| rate_on(j, &self.moving_at(body, time))).sum()
    }
}

/// Rate [m/s] of what has given coefficients by the velocities of a body.
pub(crate) fn rate_on([x, y, turn]: &[f64; 3], moving: &Moving) -> f64 {
    x * moving.velocity.x + y * moving.velocity.y + turn * moving.angular_velocity
}

/// The motion that a body is told to make: that of one that stays is none.
pub(crate) fn motion_of(motion: Option<BodyMotion>, is_fixed: bool) -> Option<BodyMotion> {
    motion.filter(|motion| is_fixed && !motion.is_still())
}
