//! An event-driven system of its own: a point bounces on a table that moves up and down like a saw tooth.
//!
//! Nothing here knows of bodies: only the trait, the clock and the queue are used.
//!
//! `cargo run -p halfgap-advance --no-default-features --example bouncing_point`

use halfgap_advance::{EventDriven, EventQueue, SourceId, Time, advance_until};
use std::convert::Infallible;

/// Acceleration of the point [m/s^2], downwards.
const GRAVITY: f64 = 9.81;
/// Speed of the table [m/s], up and down by turns.
const TABLE_SPEED: f64 = 0.4;
/// Time [s] for which the table goes in one direction.
const TABLE_HALF_PERIOD: f64 = 0.25;
/// Speed after a bounce as a fraction of that before it [-].
const ELASTICITY: f64 = 0.8;

const BOUNCE: SourceId = SourceId(0);
const TURN: SourceId = SourceId(1);

/// Motion along a vertical line: a parabola from some time on.
#[derive(Clone, Copy)]
struct Segment {
    start: Time,
    height: f64,
    velocity: f64,
    acceleration: f64,
}

impl Segment {
    fn velocity_at(&self, time: Time) -> f64 {
        self.velocity + self.acceleration * time.since(self.start)
    }

    fn height_at(&self, time: Time) -> f64 {
        let t = time.since(self.start);
        self.height + (self.velocity + 0.5 * self.acceleration * t) * t
    }

    /// Goes on from a time with another velocity [m/s].
    fn cut(&mut self, time: Time, velocity: f64) {
        *self = Self { height: self.height_at(time), start: time, velocity, ..*self };
    }
}

struct PointOnTable {
    point: Segment,
    table: Segment,
    queue: EventQueue,
}

impl PointOnTable {
    fn new() -> Self {
        let start = Time::ZERO;
        let mut system = Self {
            point: Segment { start, height: 0.5, velocity: 0.0, acceleration: -GRAVITY },
            table: Segment { start, height: 0.0, velocity: TABLE_SPEED, acceleration: 0.0 },
            queue: EventQueue::new(),
        };
        system.queue.set(TURN, start.plus(TABLE_HALF_PERIOD));
        system.predict_bounce(start);
        system
    }

    /// The point meets the table when height + speed t - g t^2/2 = 0, in the form in which nothing cancels.
    fn predict_bounce(&mut self, now: Time) {
        let height = (self.point.height_at(now) - self.table.height_at(now)).max(0.0);
        let speed = self.point.velocity_at(now) - self.table.velocity_at(now);
        let root = (speed * speed + 2.0 * GRAVITY * height).sqrt();
        let wait = if speed > 0.0 { (speed + root) / GRAVITY } else { 2.0 * height / (root - speed) };
        self.queue.set(BOUNCE, now.plus(wait));
    }
}

/// Report of an event.
enum Told {
    Bounce { closing: f64, leaving: f64 },
    Turn,
}

impl EventDriven for PointOnTable {
    type Report = (Time, Told);
    type Error = Infallible;

    fn next_event(&self) -> Option<Time> {
        self.queue.first().map(|event| event.time)
    }

    fn handle_next(&mut self) -> Result<Option<Self::Report>, Infallible> {
        let Some(event) = self.queue.first() else { return Ok(None) };
        let now = event.time;
        let told = if event.source == BOUNCE {
            let table = self.table.velocity_at(now);
            let closing = table - self.point.velocity_at(now);
            let leaving = ELASTICITY * closing;
            self.point.cut(now, table + leaving);
            Told::Bounce { closing, leaving }
        } else {
            self.table.cut(now, -self.table.velocity);
            self.queue.set(TURN, now.plus(TABLE_HALF_PERIOD));
            Told::Turn
        };
        // Either way the old prediction is worth nothing: it is replaced in its place.
        self.predict_bounce(now);
        Ok(Some((now, told)))
    }
}

fn main() -> Result<(), Infallible> {
    let mut system = PointOnTable::new();
    advance_until(&mut system, Time::from_seconds(1.5), |system, (time, told)| {
        let height = system.table.height_at(*time);
        match told {
            Told::Bounce { closing, leaving } => println!(
                "{time:.6} s  bounce at {height:+.3} m: comes at {closing:.3} m/s, leaves at {leaving:.3} m/s"
            ),
            Told::Turn if system.table.velocity > 0.0 => {
                println!("{time:.6} s  the table rises from {height:+.3} m")
            }
            Told::Turn => println!("{time:.6} s  the table sinks from {height:+.3} m"),
        }
    })
}
