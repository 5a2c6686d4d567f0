//! Fixed bodies that are moved, as a world is built: their velocities at the start, and how fast and far they go.

use super::{BodySpec, TIME_TO_MOVE};
use crate::settings::{AdvanceBy, WorldSettings};
use glam::DVec2;
use halfgap_advance::rigid::Scales;
use halfgap_collision::{BodyState, Motion, MotionBounds, MovedPath};

/// Number of parts of the run after each of which it is looked how far a moved body has gone.
const LOOKS: u32 = 64;

/// State of a fixed body at the start [s]: with the velocities of its motion, if it is moved.
pub(super) fn state_at(body: &BodySpec, start: f64) -> BodyState {
    let [x, y, spin] = match &body.motion {
        Some(motion) => motion.laws().map(|law| law.at(start).rate),
        None => [0.0; 3],
    };
    BodyState { velocity: DVec2::new(x, y), angular_velocity: spin, ..body.state }
}

/// Includes in the scales of a scene how fast, and how far from the origin, points of a moved body come that are `reach` [m] from
/// its centre of mass.
pub(super) fn include(body: &BodySpec, reach: f64, settings: &WorldSettings, scales: &mut Scales) {
    let Some(motion) = body.motion.clone().filter(|_| settings.strategy == AdvanceBy::Events) else {
        return;
    };
    let span = settings.duration.unwrap_or(TIME_TO_MOVE);
    let path = MovedPath::new(motion, body.state.position, body.state.angle, settings.start_time);
    let MotionBounds { velocity, angular_speed, .. } = path.bounds(0.0, span);
    let speed = velocity.largest() + angular_speed * reach;
    if speed.is_finite() {
        scales.speed = scales.speed.max(speed);
    }
    for look in 0..=LOOKS {
        let (center, _) = path.center_at(span * f64::from(look) / f64::from(LOOKS));
        scales.include_distance(center.abs().max_element() + reach);
    }
}
