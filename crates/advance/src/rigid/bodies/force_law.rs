//! Force laws: forces and torques on bodies as a function of time and state.
//!
//! Uniform acceleration and linear damping are not laws of this kind: they belong to the [`FreeMotion`] of a body, whose
//! motion they leave in closed form. A body on which a [`ForceLaw`] acts is integrated.
//!
//! [`FreeMotion`]: crate::rigid::FreeMotion

use crate::rigid::bodies::trajectory::Trajectory;
use glam::DVec2;
use halfgap_collision::{Anchor, BodyId, Moving};
use std::any::Any;
use std::fmt::Debug;

/// Poses and velocities of all bodies at one moment, for a law to read.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot<'a> {
    /// Time [s].
    pub time: f64,
    /// Motions of all bodies of the system; only those that the law names are sure to be up to date.
    bodies: &'a [Moving],
    /// The same bodies, which know the whole turns that the angles of the motions lack; empty if they lack none.
    trajectories: &'a [Trajectory],
}

impl<'a> Snapshot<'a> {
    /// Makes a snapshot of all bodies, in the order of their ids, at a time [s].
    #[must_use]
    #[inline]
    pub fn new(time: f64, bodies: &'a [Moving]) -> Self {
        Self { time, bodies, trajectories: &[] }
    }

    /// Makes a snapshot of all bodies of a system, whose motions lack the turns that were taken out of their angles.
    pub(crate) fn of_unwound(time: f64, bodies: &'a [Moving], trajectories: &'a [Trajectory]) -> Self {
        Self { time, bodies, trajectories }
    }

    /// Returns the pose and the velocities of a body; the background rests at the origin. The angle includes all whole
    /// turns since the start, so that a law may wind up a spring.
    ///
    /// # Panics
    /// If there is no such body. A law reads only bodies that it names, and these are checked when the law is added.
    #[must_use]
    #[inline]
    pub fn body(&self, body: BodyId) -> Moving {
        if body.is_world() {
            return Moving::BACKGROUND;
        }
        let moving = self.bodies[body.index()];
        match self.trajectories.get(body.index()) {
            Some(trajectory) => Moving { angle: trajectory.with_turns(moving.angle), ..moving },
            None => moving,
        }
    }
}

/// Force and torque on a body, in the world frame; a positive torque acts counter-clockwise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Wrench {
    /// Force at the centre of mass [N].
    pub force: DVec2,
    /// Torque about the centre of mass [N m].
    pub torque: f64,
}

/// The sums of forces and torques, one for each body; those of a fixed body or the background have no effect.
#[derive(Debug)]
pub struct Wrenches<'a> {
    sums: &'a mut [Wrench],
    /// What is added is taken times this.
    factor: f64,
}

impl<'a> Wrenches<'a> {
    /// Wraps sums to which a law adds, in the order of the bodies' ids.
    #[inline]
    pub fn new(sums: &'a mut [Wrench]) -> Self {
        Self { sums, factor: 1.0 }
    }

    /// The same sums, to which all is added that many times: for a law that lets another vary.
    #[must_use]
    #[inline]
    pub fn scaled(&mut self, factor: f64) -> Wrenches<'_> {
        Wrenches { sums: self.sums, factor: self.factor * factor }
    }

    /// Adds a force [N] that acts at an arm [m] from the body's centre of mass, both in world directions.
    #[inline]
    pub fn add_force(&mut self, body: BodyId, force: DVec2, arm: DVec2) {
        if let Some(sum) = self.sums.get_mut(body.index()) {
            sum.force += self.factor * force;
            sum.torque += self.factor * arm.perp_dot(force);
        }
    }

    /// Adds a torque [N m], positive counter-clockwise.
    #[inline]
    pub fn add_torque(&mut self, body: BodyId, torque: f64) {
        if let Some(sum) = self.sums.get_mut(body.index()) {
            sum.torque += self.factor * torque;
        }
    }
}

/// A force law.
///
/// A law must be smooth inside a step: where it changes branch, a switching function must change sign, and the step is
/// made to end there; where it does so at a known time, [`next_kink`](Self::next_kink) tells that. The functions are sampled at five moments of each step, so two changes of sign within one step may
/// be missed, as may a smooth force that comes and goes: where forces last for a shorter time than the motion without
/// them would take steps, bound these, by [`length`](Self::length) where forces depend on places, or by a longest step
/// where they depend on the time.
///
/// A body must not stay where a law changes branch, pressed there from both sides, as under dry friction: it would take a
/// step for each crossing. Change the parameters of a law only together with an intervention on one of its bodies,
/// which restarts their steps; a change of velocity by zero will do.
pub trait ForceLaw: Any + Debug + Send + Sync {
    /// Name of the law in messages and in the energy ledger.
    fn name(&self) -> &str;

    /// Every body whose state the law reads or on which it acts. The movable ones among them share their steps. Forces
    /// on other bodies are ignored, and refused where a world is built.
    fn bodies(&self) -> &[BodyId];

    /// Adds the forces [N] and torques [N m] of one moment. They must depend on the snapshot alone: this is called any
    /// number of times, not in the order of time, and for moments and places beyond those that are reached.
    fn apply(&self, now: &Snapshot<'_>, wrenches: &mut Wrenches<'_>);

    /// Potential energy V [J], with force = -dV/dposition and torque = -dV/dangle; `None` if there is none: the law's
    /// work is then integrated. V must not depend on the time: a change of V by itself would not be work of the forces.
    fn potential(&self, now: &Snapshot<'_>) -> Option<f64> {
        let _ = now;
        None
    }

    /// The two points between which the law acts, for pictures; `None` if it does not act between two points.
    fn ends(&self) -> Option<[Anchor; 2]> {
        None
    }

    /// A body on which the law pushes at a point of the world [m] that stays where it is while the body moves; `None`
    /// for other laws. A run tells when the body has left the point.
    fn fixed_point(&self) -> Option<(BodyId, DVec2)> {
        None
    }

    /// Length [m] over which the forces vary by their own size, |F| / |dF/dposition|; `None` if it is never less than
    /// the size of the bodies. In one step bodies in contact move by no more than half of it, and so does a free body by no
    /// more than all of it, if the law names no other body.
    fn length(&self, now: &Snapshot<'_>) -> Option<f64> {
        let _ = now;
        None
    }

    /// The first time [s] later than `after` at which the forces, as a function of the time alone, jump or have a kink; `None` if there
    /// is none any more. A step ends there, however many there are within it.
    fn next_kink(&self, after: f64) -> Option<f64> {
        let _ = after;
        None
    }

    /// Number of switching functions of the law.
    fn switches(&self) -> usize {
        0
    }

    /// Value of the switching function with an index below [`switches`](Self::switches), in any unit. The forces are
    /// smooth while no sign changes; where a function is zero, they may be those of either branch.
    fn switch(&self, index: usize, now: &Snapshot<'_>) -> f64 {
        let _ = (index, now);
        1.0
    }
}
