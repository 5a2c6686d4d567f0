//! One body with the segment that it flies.

use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{Body, BodyState, Flight, Motion, Moving, Spin};
use halfgap_geometry::{DirectionRange, Feature, Shape};
use std::sync::Arc;

/// What acts on a body in free flight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlightLaw {
    /// Uniform acceleration [m/s^2].
    pub acceleration: DVec2,
    /// Rate [1/s] at which damping takes the velocity.
    pub linear_rate: f64,
    /// Rate [1/s] at which damping takes the angular velocity.
    pub angular_rate: f64,
}

/// A body and its segment: a flight and when it started.
#[derive(Clone, Debug)]
pub struct Flyer {
    start: Time,
    flight: Flight,
    reach: f64,
    /// Radius [m], if the body is nothing but a disc about its centre of mass.
    disc: Option<f64>,
    law: FlightLaw,
    /// Shared with clones, and away from what every prediction reads.
    body: Arc<Body>,
}

impl Flyer {
    pub(crate) fn new(body: Body, law: FlightLaw, state: BodyState, time: Time) -> Self {
        // Nothing moves a fixed body, not even its own velocity.
        let law = if body.is_fixed() { FlightLaw::default() } else { law };
        let flight = if body.is_fixed() {
            Flight::fixed(state.position, state.angle)
        } else {
            Flight::new(state, law.acceleration, law.linear_rate, law.angular_rate)
        };
        let (reach, disc) = (body.shape.reach(), disc_radius(&body.shape));
        Self { start: time, flight, reach, disc, law, body: Arc::new(body) }
    }

    /// The body.
    #[must_use]
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// What acts on it.
    #[must_use]
    pub fn law(&self) -> &FlightLaw {
        &self.law
    }

    /// State at a time of the present segment.
    #[must_use]
    pub fn state_at(&self, time: Time) -> BodyState {
        self.flight.state_at(self.offset(time))
    }

    pub(crate) fn moving_at(&self, time: Time) -> Moving {
        self.flight.moving_at(self.offset(time))
    }

    /// Accelerations at a time [m/s^2, rad/s^2].
    pub(crate) fn accelerations_at(&self, time: Time) -> Spin {
        let offset = self.offset(time);
        Spin {
            linear: self.flight.acceleration_at(offset),
            angular: self.flight.angular_acceleration_at(offset),
        }
    }

    /// Offset [s] of a time in the present segment.
    pub(crate) fn offset(&self, time: Time) -> f64 {
        time.since(self.start)
    }

    /// Largest distance [m] of a point of the body from its centre of mass.
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    pub(crate) fn disc(&self) -> Option<f64> {
        self.disc
    }

    pub(crate) fn flight(&self) -> &Flight {
        &self.flight
    }

    /// Cuts the segment at a time and starts another with changed velocities.
    pub(crate) fn cut(&mut self, time: Time, velocity_change: DVec2, spin_change: f64) {
        let state = self.state_at(time);
        let state = BodyState {
            velocity: state.velocity + velocity_change,
            angular_velocity: state.angular_velocity + spin_change,
            ..state
        };
        self.start = time;
        self.flight = Flight::new(state, self.law.acceleration, self.law.linear_rate, self.law.angular_rate);
    }
}

/// The radius of a shape that is one full circle about the origin.
fn disc_radius(shape: &Shape) -> Option<f64> {
    match shape.features() {
        [Feature::Round(round)] if round.center == DVec2::ZERO && round.range == DirectionRange::Full => {
            (round.radius > 0.0).then_some(round.radius)
        }
        _ => None,
    }
}
