//! Accelerations of bodies without contacts and connectors, and the work of what causes them.

use crate::rigid::{ForceLaws, FreeMotion, Snapshot, Wrench, Wrenches};
use crate::stepping::bodies::{Bodies, Motion3, farthest};
use halfgap_collision::BodyId;

/// Accelerations at the start of a step.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Kicks {
    /// Acceleration of each body by uniform fields and force laws, without damping.
    pub(super) accelerations: Vec<Motion3>,
    wrenches: Vec<Wrench>,
    /// Wrenches of laws without potential, by law and body: their work is booked.
    working: Vec<(u32, BodyId, Wrench)>,
}

impl Kicks {
    /// Finds the accelerations of all movable bodies at a time, at the places and velocities of the start of the step.
    pub(super) fn find(&mut self, bodies: &Bodies, laws: &ForceLaws, time: f64) {
        self.accelerations.clear();
        self.accelerations.extend(bodies.natures.iter().map(|nature| {
            let acceleration = nature.free_motion.acceleration;
            [acceleration.x, acceleration.y, 0.0]
        }));
        // That of the background.
        self.accelerations.push([0.0; 3]);
        self.working.clear();
        if laws.all.is_empty() {
            return;
        }
        self.wrenches.resize(bodies.count(), Wrench::default());
        let snapshot = Snapshot::new(time, &bodies.movings);
        for (index, law) in laws.all.iter().enumerate().filter(|&(index, _)| laws.is_on(index)) {
            law.apply(&snapshot, &mut Wrenches::new(&mut self.wrenches));
            for &body in law.bodies().iter().filter(|body| !body.is_world()) {
                // A body that a law names twice is taken once: its wrench is none afterwards.
                let wrench = std::mem::take(&mut self.wrenches[body.index()]);
                if !laws.has_potential[index] {
                    self.working.push((index as u32, body, wrench));
                }
                let inertia = bodies.inertia(body);
                let sum = &mut self.accelerations[body.index()];
                sum[0] += inertia.inverse_mass * wrench.force.x;
                sum[1] += inertia.inverse_mass * wrench.force.y;
                sum[2] += inertia.inverse_moment * wrench.torque;
            }
        }
    }

    /// Bound on the acceleration [m/s^2] that any point of a body has, if it does not turn.
    pub(super) fn fastest(&self, bodies: &Bodies) -> f64 {
        let all = bodies.natures.iter().zip(&self.accelerations);
        all.map(|(nature, &acceleration)| farthest(nature.reach, acceleration)).fold(0.0, f64::max)
    }

    /// Power [W] of each law without potential on a body, if it is among some, at the velocities that `velocity` tells.
    pub(super) fn powers(
        &self,
        velocity: impl Fn(BodyId) -> Option<Motion3>,
    ) -> impl Iterator<Item = (usize, f64)> {
        self.working.iter().filter_map(move |&(law, body, Wrench { force, torque })| {
            let [x, y, spin] = velocity(body)?;
            Some((law as usize, force.x * x + force.y * y + torque * spin))
        })
    }
}

/// Velocity after a time `span` [s] from one before, under a constant acceleration and damping: the implicit midpoint rule.
#[inline]
pub(super) fn kicked(free: &FreeMotion, before: Motion3, acceleration: Motion3, span: f64) -> Motion3 {
    let rates = [free.linear_rate, free.linear_rate, free.angular_rate];
    std::array::from_fn(|k| {
        let half = 0.5 * span * rates[k];
        if half == 0.0 {
            before[k] + span * acceleration[k]
        } else {
            (before[k] * (1.0 - half) + span * acceleration[k]) / (1.0 + half)
        }
    })
}
