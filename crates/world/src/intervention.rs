//! Changes of velocity from outside while a world runs: velocities and impulses that the caller gives to bodies.

use crate::advance::tell;
use crate::builder::LARGEST;
use crate::event::Event;
use crate::run_error::RunError;
use crate::strategy::Strategy;
use crate::world::World;
use glam::DVec2;
use halfgap_advance::Time;
use halfgap_advance::rigid::{AdvanceError, Handled, VelocityChange};
use halfgap_collision::{BodyId, BodyState};
use std::ops::ControlFlow;

/// A change of a body's velocity at one moment, made by the caller; positions do not change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Intervention {
    /// Sets the velocity of a body.
    Velocity {
        /// The body.
        body: BodyId,
        /// Velocity of its centre of mass [m/s].
        velocity: DVec2,
        /// Angular velocity, counter-clockwise [rad/s].
        angular_velocity: f64,
    },
    /// Applies an impulse to a body at a point.
    Impulse {
        /// The body.
        body: BodyId,
        /// The impulse [N s].
        impulse: DVec2,
        /// The point at which it acts [m], in world coordinates.
        point: DVec2,
    },
    /// Applies an angular impulse to a body, which changes its angular velocity alone.
    AngularImpulse {
        /// The body.
        body: BodyId,
        /// The angular impulse, counter-clockwise [N m s].
        impulse: f64,
    },
}

impl Intervention {
    fn body(&self) -> BodyId {
        match *self {
            Self::Velocity { body, .. } | Self::Impulse { body, .. } | Self::AngularImpulse { body, .. } => {
                body
            }
        }
    }

    fn is_finite(&self) -> bool {
        match *self {
            Self::Velocity { velocity, angular_velocity, .. } => {
                velocity.is_finite() && angular_velocity.is_finite()
            }
            Self::Impulse { impulse, point, .. } => impulse.is_finite() && point.is_finite(),
            Self::AngularImpulse { impulse, .. } => impulse.is_finite(),
        }
    }
}

impl World {
    /// Changes velocities of bodies at the present time, all in one event; of two changes of one body the second adds
    /// to the first. Connectors and contacts against which the bodies then move respond by the world's impact law, in
    /// an [`Impact`](crate::Impact) that is reported: an impulse on the lowest block of a stack reaches all of it, and
    /// a velocity that connectors do not allow does not come about. Give velocities that belong together, such as those
    /// of a linkage, in one call.
    ///
    /// Steps are computed ahead. A force law whose parameters you changed takes effect at the next intervention on one of
    /// its bodies; setting the present velocity is enough. [`add_force`](Self::add_force) adds one while the world lives.
    ///
    /// Thresholds and steps follow the scales of the world as it was built. If interventions will make bodies much
    /// faster, say so in [`WorldSettings::usual_speed`](crate::WorldSettings::usual_speed).
    ///
    /// ```
    /// use halfgap::geometry::{DVec2, Shape};
    /// use halfgap::{BodySpec, BodyState, Intervention, WorldBuilder, WorldSettings};
    ///
    /// let mut builder = WorldBuilder::new(WorldSettings { usual_speed: Some(2.0), ..WorldSettings::default() });
    /// let puck = builder.add(BodySpec::movable("puck", Shape::disc(0.1)?, 0.5, BodyState::default()));
    /// let mut world = builder.build()?;
    /// let (impulse, point) = (DVec2::new(1.0, 0.0), DVec2::new(0.0, 0.05));
    /// world.intervene(&[Intervention::Impulse { body: puck, impulse, point }], &mut |_| ())?;
    /// world.advance_to(3.0, &mut |_| ())?;
    /// assert_eq!(world.state(puck).position, DVec2::new(6.0, 0.0));
    /// assert!(world.state(puck).angular_velocity < 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`RunError::NoSuchBody`], [`RunError::Immovable`] for a fixed body, [`RunError::BadIntervention`] for a number
    /// that is not finite or a change of a velocity by more than 1e60 m/s or rad/s: nothing is done then. Another error
    /// if the impact, or the forces after it, cannot be found: the world cannot go on then, as after such an error of
    /// [`advance_to`](Self::advance_to).
    pub fn intervene(
        &mut self,
        interventions: &[Intervention],
        on_event: &mut dyn FnMut(&Event),
    ) -> Result<(), RunError> {
        interventions.iter().try_for_each(|intervention| self.check_intervention(intervention))?;
        let changes = self.changes_by(interventions);
        changes.iter().try_for_each(|change| self.check_change(change))?;
        self.interrupt(on_event, |strategy, now| strategy.intervene(now, &changes))
    }

    /// Lets an event of the caller's happen at the present time, and reports it.
    pub(crate) fn interrupt(
        &mut self,
        on_event: &mut dyn FnMut(&Event),
        act: impl FnOnce(&mut Strategy, Time) -> Result<Option<Handled>, AdvanceError>,
    ) -> Result<(), RunError> {
        self.ask_guard()?;
        let has_failed = self.strategy.failure().is_some();
        let mut go_on = |event: &Event| {
            on_event(event);
            ControlFlow::Continue(())
        };
        let _ = self.tell_start(&mut go_on);
        let outcome = act(&mut self.strategy, self.now);
        let outcome = outcome.map(|handled| match handled {
            Some(handled) => tell(&mut self.told, (&self.strategy, &self.joints), handled, &mut go_on),
            None => ControlFlow::Continue(()),
        });
        let reached = self.strategy.now();
        if !has_failed {
            self.tell_last_words(&mut go_on);
        }
        self.conclude(outcome, reached).map(|_| ())
    }

    fn check_intervention(&self, intervention: &Intervention) -> Result<(), RunError> {
        let body = intervention.body();
        if body.is_world() || body.index() >= self.body_count() {
            return Err(RunError::NoSuchBody { body });
        }
        let name = || self.name(body).to_owned();
        if self.is_fixed(body) {
            return Err(RunError::Immovable { body: name() });
        }
        if !intervention.is_finite() {
            return Err(RunError::BadIntervention { body: name() });
        }
        Ok(())
    }

    /// Refuses changes of velocity larger than the velocities from which a world can be built.
    fn check_change(&self, change: &VelocityChange) -> Result<(), RunError> {
        let VelocityChange { body, velocity, angular_velocity } = *change;
        let is_sound = velocity.abs().max_element().max(angular_velocity.abs()) <= LARGEST;
        if is_sound { Ok(()) } else { Err(RunError::BadIntervention { body: self.name(body).to_owned() }) }
    }

    /// Changes of the velocities by interventions, each applied after those before it.
    fn changes_by(&self, interventions: &[Intervention]) -> Vec<VelocityChange> {
        let mut changes: Vec<VelocityChange> = Vec::with_capacity(interventions.len());
        for intervention in interventions {
            let body = intervention.body();
            let state = self.state(body);
            let before = changes.iter().filter(|change| change.body == body);
            let (velocity, spin) = before.fold((state.velocity, state.angular_velocity), |sum, change| {
                (sum.0 + change.velocity, sum.1 + change.angular_velocity)
            });
            let now = BodyState { velocity, angular_velocity: spin, ..state };
            let (velocity, angular_velocity) = self.change_by(intervention, &now);
            changes.push(VelocityChange { body, velocity, angular_velocity });
        }
        changes
    }

    /// Change of the velocity [m/s] and angular velocity [rad/s] of a body in a state.
    fn change_by(&self, intervention: &Intervention, now: &BodyState) -> (DVec2, f64) {
        let of_impulse = |impulse: DVec2, angular: f64| match self.inertia(intervention.body()) {
            Some(inertia) => (impulse / inertia.mass, angular / inertia.moment),
            None => (DVec2::ZERO, 0.0),
        };
        match *intervention {
            Intervention::Velocity { velocity, angular_velocity, .. } => {
                (velocity - now.velocity, angular_velocity - now.angular_velocity)
            }
            Intervention::Impulse { impulse, point, .. } => {
                of_impulse(impulse, (point - now.position).perp_dot(impulse))
            }
            Intervention::AngularImpulse { impulse, .. } => of_impulse(DVec2::ZERO, impulse),
        }
    }
}
