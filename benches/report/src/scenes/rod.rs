//! A uniform rod on a pin of the world at one end: what the scenes with one or two of them share.

use crate::scene::Body;
use glam::DVec2;
use halfgap::BodyState;
use std::f64::consts::FRAC_PI_2;

/// Length of a rod [m].
pub(super) const LENGTH: f64 = 1.0;
/// Its thickness, in its picture only [m].
const WIDTH: f64 = 0.1;
/// Acceleration of gravity [m/s^2].
pub(super) const GRAVITY: f64 = 9.81;

/// The end of a rod that hangs on a point with a velocity, at an angle from the downward vertical and with a rate.
pub(super) fn tip(from: [DVec2; 2], angle: f64, rate: f64) -> [DVec2; 2] {
    let along = LENGTH * DVec2::from_angle(angle - FRAC_PI_2);
    [from[0] + along, from[1] + rate * along.perp()]
}

/// State of that rod. Its own axis points from the pin to its end.
pub(super) fn state(from: [DVec2; 2], angle: f64, rate: f64) -> BodyState {
    let to = tip(from, angle, rate);
    BodyState {
        position: 0.5 * (from[0] + to[0]),
        angle: angle - FRAC_PI_2,
        velocity: 0.5 * (from[1] + to[1]),
        angular_velocity: rate,
    }
}

/// A rod of a mass [kg].
pub(super) fn body(name: &str, mass: f64, start: BodyState) -> Body {
    let mut body = Body::block(name, DVec2::new(LENGTH, WIDTH), mass, start).with_elasticity(0.0);
    if let Some(inertia) = &mut body.inertia {
        inertia.moment = mass * LENGTH * LENGTH / 12.0;
    }
    body
}

/// The end of a rod that hangs, and the other one, in its own coordinates.
pub(super) const ENDS: [DVec2; 2] = [DVec2::new(-0.5 * LENGTH, 0.0), DVec2::new(0.5 * LENGTH, 0.0)];
