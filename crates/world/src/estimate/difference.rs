//! How far the states of two runs are apart.

use super::event_times::EventTimes;
use crate::recording::{Frame, Recording};
use crate::world::World;
use halfgap_collision::BodyId;
use serde::Serialize;

/// The largest difference of any body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Difference {
    /// Of its position [m].
    pub position: f64,
    /// Of its angle [rad].
    pub angle: f64,
    /// Of its velocity [m/s].
    ///
    /// A body that collides just then has two velocities, and while it has collided in one of the two runs
    /// only, those differ by the blow: it is left out.
    pub velocity: f64,
    /// Of its angular velocity [rad/s], likewise.
    pub angular_velocity: f64,
}

/// The differences at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimedDifference {
    /// When [s].
    pub time: f64,
    /// What they are.
    pub difference: Difference,
}

impl Difference {
    /// The larger of both, quantity by quantity.
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

    /// A length [m] as a part of the size of the smallest body.
    pub(super) fn part(&self, length: f64) -> f64 {
        self.reach.iter().map(|reach| length / reach).fold(0.0, f64::max)
    }

    /// At each common time [s]: the largest shift of any body, as a part of its own size.
    pub(super) fn shifts(&self, run: &Recording, tighter: &Recording) -> Vec<(f64, f64)> {
        let shift = |(a, b): (&Frame, &Frame)| {
            let states = a.states.iter().zip(&b.states).zip(&self.reach);
            let parts = states
                .map(|((a, b), reach)| a.position.distance(b.position) / reach + (a.angle - b.angle).abs());
            (a.time, parts.fold(0.0, f64::max))
        };
        common(run, tighter).map(shift).collect()
    }

    /// At each common time: the differences of all bodies; `window` [s] is how near an impact velocities may
    /// not be compared.
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

/// The frames of both at the times they share; a run that stops early has a last frame of its own.
fn common<'a>(run: &'a Recording, tighter: &'a Recording) -> impl Iterator<Item = (&'a Frame, &'a Frame)> {
    run.frames.iter().zip(&tighter.frames).filter(|(a, b)| a.time == b.time)
}
