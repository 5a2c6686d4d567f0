//! Copies of the properties of a body that are read most often: its parabola, its size, the time for which it stays in
//! its box.
//!
//! An event reads these for every neighbour of its bodies, and need not load the bodies themselves: memory is slower
//! than the computation.

use crate::rigid::bodies::path::Path;
use crate::rigid::bodies::trajectory::Trajectory;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{Motion, Polynomial};

/// Kind of a body's motion, as far as its lane knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum LaneKind {
    /// Not a parabola: only the body itself knows its motion.
    Other,
    /// The centre of mass follows the parabola.
    Parabola,
    /// The centre of mass follows the parabola, and the body is a disc about it.
    Disc,
}

/// A copy of the motion of one body, renewed whenever that changes. It fills two cache lines that are read together.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[repr(align(128))]
pub(crate) struct Lane {
    /// Position [m] at the start; of an integrated motion, the middle of the box that holds its course.
    pub(super) position: DVec2,
    /// Velocity [m/s] at the start; 0 for an integrated motion.
    pub(super) velocity: DVec2,
    /// Time at which the segment started.
    pub(super) start: Time,
    /// Time until which the body surely stays in its box.
    pub(super) stay: Time,
    /// Acceleration [m/s^2].
    pub(super) acceleration: DVec2,
    /// Largest distance [m] of a point of the body from its centre of mass.
    pub(super) reach: f64,
    /// Radius [m] of a disc about the centre of mass; 0 for any other body.
    pub(super) radius: f64,
    /// Gap [m] at which the body fires.
    pub(super) trigger_gap: f64,
    /// Without a parabola: largest distance [m] of the centre of mass from `position` during the segment, beyond that
    /// which `velocity` and `acceleration` make.
    pub(super) course: f64,
    pub(super) kind: LaneKind,
    /// The body neither moves nor is about to.
    pub(super) is_at_rest: bool,
}

/// A disc in which a centre of mass stays for some time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Course {
    pub(crate) center: DVec2,
    /// Radius [m]; infinite where nothing is known.
    pub(crate) radius: f64,
}

impl Lane {
    /// Sets the gap [m] at which the body fires.
    pub(super) fn set_trigger_gap(&mut self, trigger_gap: f64) {
        self.trigger_gap = trigger_gap;
    }

    /// The lane of a body that stays in its box for ever and fires at a gap [m].
    pub(crate) fn new(trajectory: &Trajectory, trigger_gap: f64) -> Self {
        let mut lane = Self {
            position: DVec2::ZERO,
            velocity: DVec2::ZERO,
            start: Time::ZERO,
            stay: Time::NEVER,
            acceleration: DVec2::ZERO,
            reach: trajectory.reach(),
            radius: trajectory.disc().unwrap_or(0.0),
            trigger_gap,
            course: f64::INFINITY,
            kind: LaneKind::Other,
            is_at_rest: false,
        };
        lane.follow(trajectory);
        lane
    }

    /// Copies the present motion of the body.
    pub(crate) fn follow(&mut self, trajectory: &Trajectory) {
        self.is_at_rest = trajectory.is_at_rest();
        let Some(parabola) = trajectory.parabola() else {
            self.kind = LaneKind::Other;
            self.start = trajectory.start();
            match trajectory.path() {
                Path::Dense(dense) => {
                    let stay = dense.center_box();
                    (self.position, self.course) = (stay.center(), 0.5 * stay.size().length());
                    (self.velocity, self.acceleration) = (DVec2::ZERO, DVec2::ZERO);
                }
                Path::Moved(_) => {
                    (self.position, self.course) =
                        (trajectory.moving_at(self.start).pose.position, f64::INFINITY);
                    (self.velocity, self.acceleration) = (DVec2::ZERO, DVec2::ZERO);
                }
                Path::Flight(flight) => {
                    (self.position, self.velocity) = flight.center_at(0.0);
                    (self.acceleration, self.course) = (flight.acceleration(), 0.0);
                }
            }
            return;
        };
        let Polynomial { position, velocity, acceleration } = parabola;
        (self.position, self.velocity, self.acceleration) = (position, velocity, acceleration);
        self.start = trajectory.start();
        // Whether discs that coast may meet at all depends on the steps that they are in.
        let is_plain = trajectory.disc().is_some() && !trajectory.is_coasting();
        self.kind = if is_plain { LaneKind::Disc } else { LaneKind::Parabola };
    }

    /// A disc in which the centre of mass stays from a time on, for a span [s] within its segment.
    #[inline]
    pub(crate) fn course_from(&self, time: Time, span: f64) -> Course {
        let way =
            |velocity: DVec2, span: f64| (velocity.length() + 0.5 * self.acceleration.length() * span) * span;
        if self.kind == LaneKind::Other {
            // With damping no body goes farther than without.
            let radius = self.course + way(self.velocity, time.since(self.start) + span);
            return Course { center: self.position, radius };
        }
        let Polynomial { position, velocity, .. } = self.parabola_from(time);
        Course { center: position, radius: way(velocity, span) }
    }

    /// Position [m] of the centre of mass at a time, bit for bit that of the body itself; not for `LaneKind::Other`.
    #[inline]
    pub(crate) fn position_at(&self, time: Time) -> DVec2 {
        let t = time.since(self.start);
        self.position + (self.velocity + self.acceleration * (0.5 * t)) * t
    }

    /// The parabola from a time on, if the body follows one.
    #[inline]
    pub(crate) fn flight_from(&self, time: Time) -> Option<Polynomial> {
        (self.kind != LaneKind::Other).then(|| self.parabola_from(time))
    }

    /// The parabola from a time on; not for `LaneKind::Other`.
    #[inline]
    pub(crate) fn parabola_from(&self, time: Time) -> Polynomial {
        let t = time.since(self.start);
        Polynomial {
            position: self.position_at(time),
            velocity: self.velocity + self.acceleration * t,
            acceleration: self.acceleration,
        }
    }
}

impl Lane {
    /// Gap [m] at which the body fires.
    #[inline]
    pub(crate) fn trigger_gap(&self) -> f64 {
        self.trigger_gap
    }

    /// The kind.
    #[inline]
    pub(crate) fn kind(&self) -> LaneKind {
        self.kind
    }

    /// Radius [m] of a disc about the centre of mass; 0 for any other body.
    #[inline]
    pub(crate) fn radius(&self) -> f64 {
        self.radius
    }

    /// Largest distance [m] of a point of the body from its centre of mass.
    #[inline]
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::bodies::trajectory::FreeMotion;
    use crate::rigid::contacts::pairs::Pair;
    use crate::rigid::test_scene::resting_discs;
    use halfgap_collision::{Body, BodyId, BodyState};
    use halfgap_geometry::Shape;

    fn thrown(linear_rate: f64) -> Trajectory {
        let shape = Shape::disc(0.7).expect("a fine radius");
        let body = Body { shape, inverse_mass: 1.0, inverse_moment: 1.0, elasticity: 1.0 };
        let free_motion = FreeMotion { acceleration: DVec2::new(0.1, -9.81), linear_rate, angular_rate: 0.0 };
        let (position, velocity) = (DVec2::new(1.0 / 3.0, 2.0), DVec2::new(-0.7, 1.1));
        let state = BodyState { position, velocity, angular_velocity: 3.0, ..BodyState::default() };
        Trajectory::new(body, free_motion, state, Time::from_seconds(1.1))
    }

    #[test]
    fn a_lane_says_to_the_bit_what_its_body_says() {
        let trajectory = thrown(0.0);
        let lane = Lane::new(&trajectory, 0.0);
        assert_eq!(lane.kind, LaneKind::Disc);
        for time in [1.1, 1.3, 7.9, 0.2].map(Time::from_seconds) {
            let offset = trajectory.offset(time);
            assert_eq!(lane.position_at(time), trajectory.state_at(time).position);
            let expected = trajectory.flight().and_then(|flight| flight.polynomial_from(offset));
            assert_eq!(Some(lane.parabola_from(time)), expected);
        }
    }

    #[test]
    fn a_damped_body_has_no_parabola() {
        assert_eq!(Lane::new(&thrown(0.3), 0.0).kind, LaneKind::Other);
    }

    #[test]
    fn a_course_holds_the_flight_damped_or_not() {
        for linear_rate in [0.0, 0.3, 30.0] {
            let trajectory = thrown(linear_rate);
            let start = Time::from_seconds(1.3);
            let course = Lane::new(&trajectory, 0.0).course_from(start, 0.5);
            for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
                let position = trajectory.state_at(start.plus(0.5 * part)).position;
                assert!((position - course.center).length() <= course.radius);
            }
            assert!(course.radius < 6.0, "{} m", course.radius);
        }
    }

    #[test]
    fn a_course_holds_what_an_integrator_finds() {
        let rooms = resting_discs(&[0.0]);
        let (trajectory, lane) = (rooms.assembly.trajectory(BodyId(1)), &rooms.search.lanes[1]);
        assert_eq!(lane.kind, LaneKind::Other);
        let course = lane.course_from(trajectory.start(), 1e-3);
        let position = trajectory.state_at(trajectory.start().plus(1e-3)).position;
        assert!((position - course.center).length() <= course.radius + 1e-15 && course.radius < 1e-3);
    }

    #[test]
    fn the_data_that_events_read_fit_into_lines_of_the_cache() {
        assert_eq!([size_of::<Lane>(), size_of::<Trajectory>(), size_of::<Pair>()], [128, 192, 32]);
    }
}
