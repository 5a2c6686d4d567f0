//! Differences between the states of two runs.

use super::event_times::EventTimes;
use crate::recording::{Frame, Recording};
use crate::world::World;
use halfgap_collision::BodyId;
use serde::Serialize;

/// Largest difference of each quantity over all bodies, between two runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Difference {
    /// Difference of the position of the centre of mass [m].
    pub position: f64,
    /// Difference of the angle [rad].
    pub angle: f64,
    /// Difference of the velocity of the centre of mass [m/s].
    ///
    /// Bodies that have made an impact in only one of the two runs so far, shortly before or after the other, are left
    /// out: their velocities differ by the whole impact.
    pub velocity: f64,
    /// Difference of the angular velocity [rad/s], with the same bodies left out as for `velocity`.
    pub angular_velocity: f64,
}

/// Differences between two runs at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimedDifference {
    /// The time [s].
    pub time: f64,
    /// The differences at that time.
    pub difference: Difference,
}

impl Difference {
    /// Returns the larger of both, quantity by quantity.
    pub(super) fn largest(&self, other: &Self) -> Self {
        Self {
            position: self.position.max(other.position),
            angle: self.angle.max(other.angle),
            velocity: self.velocity.max(other.velocity),
            angular_velocity: self.angular_velocity.max(other.angular_velocity),
        }
    }
}

/// Compares the frames of two recordings.
pub(super) struct Comparison {
    bodies: Vec<BodyId>,
    /// Largest distance of a point of each body from its centre of mass [m].
    reach: Vec<f64>,
}

impl Comparison {
    pub(super) fn new(world: &World, recording: &Recording) -> Self {
        let bodies = recording.movable.clone();
        let reach = bodies.iter().map(|&body| world.shape(body).reach()).collect();
        Self { bodies, reach }
    }

    /// Returns a length [m] as a fraction of the size of the smallest body.
    pub(super) fn part(&self, length: f64) -> f64 {
        self.reach.iter().map(|reach| length / reach).fold(0.0, f64::max)
    }

    /// Returns pairs of a common time [s] and the largest shift of any body then, as a fraction of its own size.
    pub(super) fn shifts(&self, run: &Recording, tighter: &Recording) -> Vec<(f64, f64)> {
        let shift = |(a, b): (&Frame, &Frame)| {
            let states = a.states.iter().zip(&b.states).zip(&self.reach);
            let parts = states
                .map(|((a, b), reach)| a.position.distance(b.position) / reach + (a.angle - b.angle).abs());
            (a.time, parts.fold(0.0, f64::max))
        };
        common(run, tighter).map(shift).collect()
    }

    /// Returns the differences at each common time; velocities are not compared within `window` [s] of an impact that
    /// only one run has made so far.
    pub(super) fn curve(
        &self,
        run: &Recording,
        tighter: &Recording,
        times: &[EventTimes; 2],
        window: f64,
    ) -> Vec<TimedDifference> {
        let of_body = |time: f64, body: BodyId, [a, b]: [&halfgap_collision::BodyState; 2]| {
            let moving = if EventTimes::is_between(times, body, time, window) { 0.0 } else { 1.0 };
            Difference {
                position: a.position.distance(b.position),
                angle: (a.angle - b.angle).abs(),
                velocity: moving * a.velocity.distance(b.velocity),
                angular_velocity: moving * (a.angular_velocity - b.angular_velocity).abs(),
            }
        };
        let of_frames = |(a, b): (&Frame, &Frame)| {
            let pairs = self.bodies.iter().zip(a.states.iter().zip(&b.states));
            let all = pairs.map(|(&body, (of_run, of_tighter))| of_body(a.time, body, [of_run, of_tighter]));
            let difference = all.fold(Difference::default(), |largest, one| largest.largest(&one));
            TimedDifference { time: a.time, difference }
        };
        common(run, tighter).map(of_frames).collect()
    }
}

/// Returns the pairs of frames at common times; a run that stops early has a last frame of its own.
fn common<'a>(run: &'a Recording, tighter: &'a Recording) -> impl Iterator<Item = (&'a Frame, &'a Frame)> {
    run.frames.iter().zip(&tighter.frames).filter(|(a, b)| a.time == b.time)
}
