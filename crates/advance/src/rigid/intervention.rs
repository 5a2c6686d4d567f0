//! Velocity changes by the caller: they take effect at once, and contacts and connectors respond as to an impact.
//! Forces that last are laws.

use super::error::AdvanceError;
use super::event::cause::{Cause, EventWork};
use super::limits::storms::Recent;
use super::parts::{FINITE, keep_to};
use super::system::{Handled, RigidSystem};
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState};

/// A change of the velocities of a body. A zero change restarts the body's group, which makes changed force laws take
/// effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityChange {
    /// The body; a fixed body and the background keep their velocities.
    pub body: BodyId,
    /// Change of the velocity of the centre of mass [m/s].
    pub velocity: DVec2,
    /// Change of the angular velocity [rad/s].
    pub angular_velocity: f64,
}

impl RigidSystem {
    /// Changes velocities of bodies at a time, all at once: connectors and contacts against which they move then
    /// respond by the impact law. Handle all earlier events first; a time before that of the last event counts as that.
    /// The change of energy is in the ledger's `interventions`. Returns the report, or `None` if nothing is to be
    /// reported.
    ///
    /// # Errors
    /// A time or a change that is not finite: nothing is done. An impact, or forces after it, that cannot be found: the
    /// system cannot go on from it.
    ///
    /// # Panics
    /// If there is no such body.
    pub fn intervene(
        &mut self,
        time: Time,
        changes: &[VelocityChange],
    ) -> Result<Option<Handled>, AdvanceError> {
        check_finite(time, changes)?;
        let outcome = self.happen(time.max(self.now), |system| {
            system.with_work(Cause::Other, |system, work| system.change_velocities(work, changes))
        });
        self.complete_dense();
        outcome
    }

    fn change_velocities(
        &mut self,
        work: &mut EventWork,
        changes: &[VelocityChange],
    ) -> Result<(), AdvanceError> {
        work.seeds.clear();
        work.seeds.extend(changes.iter().map(|change| change.body).filter(|&body| self.is_movable(body)));
        if work.seeds.is_empty() {
            return Ok(());
        }
        self.collect_region(&mut work.region, &work.seeds, self.now);
        work.before.clear();
        work.before.extend(work.seeds.iter().map(|&body| self.flyer(body).unwound_at(self.now)));
        self.cut_groups(&mut work.region);
        self.take_back_cut(&work.seeds, &work.before);
        for change in changes {
            if self.is_movable(change.body) {
                self.change_velocity(change);
            }
        }
        self.forget_past(work);
        // Velocities decide which contacts take part, and they have changed.
        self.collect_again(work);
        self.collide(work)
    }

    /// Restores, to the bit, the velocities that bodies had before their groups were cut: the end of a cut step is
    /// projected onto its rows, which callers that change a velocity do not expect.
    fn take_back_cut(&mut self, bodies: &[BodyId], seen: &[BodyState]) {
        for (&body, &BodyState { velocity, angular_velocity, .. }) in bodies.iter().zip(seen) {
            let cut = self.flyer(body).unwound_at(self.now);
            if (cut.velocity, cut.angular_velocity) == (velocity, angular_velocity) {
                continue;
            }
            self.book_damping(body, self.now);
            let change = VelocityChange {
                body,
                velocity: velocity - cut.velocity,
                angular_velocity: angular_velocity - cut.angular_velocity,
            };
            self.ledger.projections += self.work_of(body, &cut, &change);
            self.flyers[body.index()].fly_from(self.now, BodyState { velocity, angular_velocity, ..cut });
        }
    }

    /// Changes the velocities of a body in flight.
    fn change_velocity(&mut self, change: &VelocityChange) {
        let &VelocityChange { body, velocity, angular_velocity } = change;
        self.book_damping(body, self.now);
        let before = self.flyer(body).unwound_at(self.now);
        self.ledger.interventions += self.work_of(body, &before, change);
        let now = self.now;
        self.interrupt(body).cut(now, velocity, angular_velocity);
    }

    /// Change of the kinetic energy [J] of a body in a state.
    fn work_of(&self, body: BodyId, before: &BodyState, change: &VelocityChange) -> f64 {
        let inertia = self.inertia(body);
        let linear = change.velocity.dot(before.velocity + 0.5 * change.velocity) / inertia.inverse_mass;
        let spin = before.angular_velocity + 0.5 * change.angular_velocity;
        linear + change.angular_velocity * spin / inertia.inverse_moment
    }

    /// Forgets the past events of a region's bodies: impacts that follow are neither a storm nor bounces that have
    /// become low.
    fn forget_past(&mut self, work: &EventWork) {
        for &body in &work.region.bodies {
            self.limits.recent[body.index()] = Recent::default();
            let mut links = std::mem::take(&mut self.search.links);
            links.clear();
            links.extend_from_slice(self.pairs.of_body(body));
            for link in &links {
                self.pairs.seen_mut(link.pair).clear();
            }
            self.search.links = links;
        }
        self.forget_paces(&work.region.bodies);
    }
}

fn check_finite(time: Time, changes: &[VelocityChange]) -> Result<(), AdvanceError> {
    let check = |numbers: &[(&'static str, f64)]| {
        let bad = |(quantity, _, value)| AdvanceError::BadIntervention { quantity, value };
        keep_to(&[(FINITE.0, FINITE.1, numbers)]).map_err(bad)
    };
    check(&[("time", time.seconds())])?;
    changes.iter().try_for_each(|&VelocityChange { velocity, angular_velocity, .. }| {
        check(&[
            ("velocity.x", velocity.x),
            ("velocity.y", velocity.y),
            ("angular velocity", angular_velocity),
        ])
    })
}
