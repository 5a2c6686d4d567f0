//! A body with the segment along which it moves.

use crate::ode::SegmentPolynomial;
use crate::rigid::bodies::path::{DensePath, Path};
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{Body, BodyMotion, BodyState, Flight, Motion, MovedPath, Moving, Polynomial};
#[cfg(feature = "save")]
use halfgap_geometry::ShapePool;
use std::f64::consts::TAU;

/// Difference [rad] between a full turn 2π and [`TAU`], the nearest floating-point number.
const TAU_REST: f64 = 2.449_293_598_294_706_4e-16;

/// Uniform acceleration and linear damping of a body in free flight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct FreeMotion {
    /// Uniform acceleration [m/s^2].
    pub acceleration: DVec2,
    /// Damping rate [1/s] of the velocity: damping alone makes it decay by exp(-rate t).
    pub linear_rate: f64,
    /// Damping rate [1/s] of the angular velocity: damping alone makes it decay by exp(-rate t).
    pub angular_rate: f64,
}

impl FreeMotion {
    /// True if the body is damped.
    #[must_use]
    #[inline]
    pub fn is_damped(&self) -> bool {
        self.linear_rate != 0.0 || self.angular_rate != 0.0
    }
}

/// A body and its segment: its present motion and the start of it.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[repr(align(64))]
pub struct Trajectory {
    start: Time,
    flight: Flight,
    reach: f64,
    /// Radius [m], if the body is nothing but a disc about its centre of mass.
    disc: Option<f64>,
    body: Body,
    /// Number of whole turns to be added to the angles of the present motion.
    turns: f64,
    present: Present,
    /// Motions of the last segments that were no flight, if there were any, and a prescribed one.
    led: Option<Box<Led>>,
}

/// Motions of a body that moves along with others, or as prescribed.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Led {
    /// Dense output of the last integrated segment.
    dense: DensePath,
    /// Uniform motion in the last step of a region, if there was one.
    coast: Option<Flight>,
    /// Prescribed motion of a fixed body that is moved.
    moved: Option<MovedPath>,
}

/// Kind of a body's present motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
enum Present {
    /// In closed form, under the body's own acceleration and damping.
    Flight,
    /// Dense output of an integrator.
    Integrated,
    /// Uniform, in a step of a region whose events accumulate.
    Coasting,
    /// Prescribed, for ever.
    Moved,
}

impl Trajectory {
    pub(crate) fn new(body: Body, free_motion: FreeMotion, state: BodyState, time: Time) -> Self {
        // A fixed body does not move, whatever its velocity, unless it is told to.
        let free_motion = if body.is_fixed() { FreeMotion::default() } else { free_motion };
        let flight = if body.is_fixed() {
            Flight::fixed(state.position, state.angle)
        } else {
            Flight::new(state, free_motion.acceleration, free_motion.linear_rate, free_motion.angular_rate)
        };
        let (reach, disc) = (body.shape.reach(), body.shape.centered_disc());
        Self { start: time, flight, reach, disc, body, turns: 0.0, present: Present::Flight, led: None }
    }

    /// The same body, moved from now on; for a fixed body.
    pub(crate) fn moved_by(mut self, motion: &BodyMotion) -> Self {
        let BodyState { position, angle, .. } = *self.flight.start();
        let moved = MovedPath::new(motion.clone(), position, angle, self.start.seconds());
        self.led.get_or_insert_default().moved = Some(moved);
        self.present = Present::Moved;
        self
    }

    /// The prescribed motion of a fixed body that is moved.
    #[inline]
    pub(crate) fn moved(&self) -> Option<&MovedPath> {
        self.led.as_deref().and_then(|led| led.moved.as_ref())
    }

    /// Takes a shape that is equal to its own from a pool, or leaves its own there.
    #[cfg(feature = "save")]
    pub(super) fn share_shape(&mut self, pool: &mut ShapePool) {
        self.body.shape = pool.share(self.body.shape.clone());
    }

    /// The body.
    #[must_use]
    #[inline]
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// Acceleration and damping of the body in free flight.
    #[must_use]
    #[inline]
    pub fn free_motion(&self) -> FreeMotion {
        let (acceleration, [linear_rate, angular_rate]) = (self.flight.acceleration(), self.flight.rates());
        FreeMotion { acceleration, linear_rate, angular_rate }
    }

    /// State of the body at a time of the present segment, in the world frame; its angle [rad] includes whole turns.
    #[must_use]
    #[inline]
    pub fn state_at(&self, time: Time) -> BodyState {
        let state = self.unwound_at(time);
        BodyState { angle: self.with_turns(state.angle), ..state }
    }

    /// An angle [rad] of the present motion, with the whole turns that were taken out of it.
    pub(crate) fn with_turns(&self, angle: f64) -> f64 {
        angle + (self.turns * TAU + self.turns * TAU_REST)
    }

    /// Number of whole turns that were taken out of the angles of the present motion.
    #[inline]
    pub(crate) fn turns(&self) -> f64 {
        self.turns
    }

    /// State at a time of the present segment, with an angle that lacks the whole turns made before: motions start from
    /// it.
    pub(crate) fn unwound_at(&self, time: Time) -> BodyState {
        self.path().state_at(self.offset(time))
    }

    /// Takes whole turns out of the angle at the start of a flight, so that it lies within a turn of zero: the larger
    /// an angle, the larger its rounding, and that of the places of corners.
    pub(crate) fn unwind(&mut self) {
        let angle = self.flight.start().angle;
        if self.present == Present::Flight && angle.abs() > TAU {
            let turns = (angle / TAU).round();
            // The fused product is exact, and with the correction the difference has only the rounding of the angle.
            let unwound = turns.mul_add(-TAU, angle) - turns * TAU_REST;
            self.turns += turns;
            self.flight.restart(BodyState { angle: unwound, ..*self.flight.start() });
        }
    }

    /// State at the start of the present segment, if it is a flight in closed form.
    #[must_use]
    #[inline]
    pub fn flight_start(&self) -> Option<&BodyState> {
        self.flight().map(Flight::start)
    }

    pub(crate) fn moving_at(&self, time: Time) -> Moving {
        self.path().moving_at(self.offset(time))
    }

    /// The present motion.
    #[inline]
    pub(crate) fn path(&self) -> Path<'_> {
        match (self.present, self.led.as_deref()) {
            (Present::Integrated, Some(led)) => Path::Dense(&led.dense),
            (Present::Coasting, Some(Led { coast: Some(coast), .. })) => Path::Flight(coast),
            (Present::Moved, Some(Led { moved: Some(moved), .. })) => Path::Moved(moved),
            _ => Path::Flight(&self.flight),
        }
    }

    /// Time at which the present segment started.
    pub(crate) fn start(&self) -> Time {
        self.start
    }

    /// Offset [s] of a time in the present segment.
    #[inline]
    pub(crate) fn offset(&self, time: Time) -> f64 {
        time.since(self.start)
    }

    /// Largest distance [m] of a point of the body from its centre of mass.
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// Bound on the speed [m/s] of a point of the body, at a velocity (x, y, angle) of its centre of mass; also used
    /// for accelerations and displacements.
    pub(crate) fn fastest_point(&self, [x, y, angle]: [f64; 3]) -> f64 {
        DVec2::new(x, y).length() + angle.abs() * self.reach
    }

    /// Load [N] of an acceleration (x, y, angle) of the body: its mass times the bound on the acceleration of its
    /// points.
    pub(crate) fn load(&self, acceleration: &[f64]) -> f64 {
        let linear = DVec2::new(acceleration[0], acceleration[1]).length();
        (linear + acceleration[2].abs() * self.reach()) / self.body().inverse_mass
    }

    pub(crate) fn disc(&self) -> Option<f64> {
        self.disc
    }

    /// The present motion in closed form, if it has one.
    #[inline]
    pub(crate) fn flight(&self) -> Option<&Flight> {
        match self.path() {
            Path::Flight(flight) => Some(flight),
            Path::Dense(_) | Path::Moved(_) => None,
        }
    }

    /// The parabola of the centre of mass from the start of the segment on, if it follows one.
    #[inline]
    pub(crate) fn parabola(&self) -> Option<Polynomial> {
        match self.path() {
            Path::Flight(flight) => flight.parabola(),
            Path::Moved(moved) => moved.polynomial_from(0.0),
            Path::Dense(_) => None,
        }
    }

    /// True if the body neither moves nor is about to.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.present == Present::Flight && self.flight.is_at_rest()
    }

    /// Cuts the segment at a time and starts a flight with changed velocities.
    pub(crate) fn cut(&mut self, time: Time, velocity_change: DVec2, spin_change: f64) {
        let state = self.unwound_at(time);
        let state = BodyState {
            velocity: state.velocity + velocity_change,
            angular_velocity: state.angular_velocity + spin_change,
            ..state
        };
        self.fly_from(time, state);
    }

    /// Starts a flight from a state at a time.
    pub(crate) fn fly_from(&mut self, time: Time, state: BodyState) {
        self.start = time;
        self.present = Present::Flight;
        self.flight.restart(state);
    }

    /// Starts a uniform motion from a state at a time.
    pub(crate) fn coast_from(&mut self, time: Time, state: BodyState) {
        self.start = time;
        self.present = Present::Coasting;
        match &mut self.led.get_or_insert_default().coast {
            Some(coast) => coast.restart(state),
            coast @ None => *coast = Some(Flight::new(state, DVec2::ZERO, 0.0, 0.0)),
        }
    }

    /// True if the body moves uniformly in a step of its region.
    #[inline]
    pub(crate) fn is_coasting(&self) -> bool {
        self.present == Present::Coasting
    }

    /// Starts an integrated segment of a length `span` [s]; `polynomials` are x, y and angle.
    pub(crate) fn follow(&mut self, start: Time, polynomials: &[SegmentPolynomial; 3], span: f64) {
        self.start = start;
        self.present = Present::Integrated;
        self.led.get_or_insert_default().dense.set(polynomials, span);
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use halfgap_geometry::Shape;

    #[test]
    fn an_angle_of_many_turns_is_unwound_and_told_in_full() {
        let shape = Shape::block(1.0, 0.5).expect("a fine size");
        let body = Body { shape, inverse_mass: 1.0, inverse_moment: 1.0, elasticity: 1.0 };
        for angle in [0.3, -4.0, 12_345.678, -4_618.926_598_942_698, 1e9] {
            let start = Time::from_seconds(2.0);
            let state = BodyState { angle, angular_velocity: 3.0, ..BodyState::default() };
            let mut trajectory = Trajectory::new(body.clone(), FreeMotion::default(), state, start);
            let later = start.plus(0.25);
            let before = trajectory.moving_at(later).pose.rotation;
            // The second time there is no turn left to take out.
            for _ in 0..2 {
                trajectory.unwind();
                assert_eq!(trajectory.state_at(start).angle, angle);
                assert!(trajectory.unwound_at(start).angle.abs() <= TAU);
            }
            let after = trajectory.moving_at(later).pose.rotation;
            // An angle within the segment has the rounding of a number of its own size.
            let sharp = f64::EPSILON * (1.0 + angle.abs());
            assert!(
                (before.cos - after.cos).abs() <= sharp && (before.sin - after.sin).abs() <= sharp,
                "{angle}"
            );
        }
    }
}
