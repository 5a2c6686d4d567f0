//! Force laws that are added and removed while a world lives.

use crate::builder::{acceleration, check_law};
use crate::event::Event;
use crate::force::{ForceId, ForceLaw, Moving, Snapshot, Wrench};
use crate::run_error::RunError;
use crate::world::World;
use crate::world_error::WorldError;
use glam::DVec2;
use halfgap_collision::BodyId;
use std::sync::Arc;

impl World {
    /// Adds a force law that acts from the present time on: the spring by which a mouse drags a body, say. Bodies that
    /// rest begin to move where it overcomes what holds them. A potential that it has is booked in the
    /// [ledger](World::ledger) as an intervention.
    ///
    /// Thresholds and steps follow the scales of the world as it was built. If the law will make bodies much faster, say
    /// so in [`WorldSettings::usual_speed`](crate::WorldSettings::usual_speed).
    ///
    /// ```
    /// use halfgap::force::{Anchor, Spring};
    /// use halfgap::geometry::{DVec2, Shape};
    /// use halfgap::{BodyId, BodySpec, BodyState, WorldBuilder, WorldSettings};
    /// use std::sync::Arc;
    ///
    /// let mut builder = WorldBuilder::new(WorldSettings { usual_speed: Some(1.0), ..WorldSettings::default() });
    /// let puck = builder.add(BodySpec::movable("puck", Shape::disc(0.1)?, 1.0, BodyState::default()));
    /// let mut world = builder.build()?;
    /// world.advance_to(1.0, &mut |_| ())?;
    ///
    /// let ends = [(puck, DVec2::ZERO), (BodyId::WORLD, DVec2::X)].map(|(body, point)| Anchor { body, point });
    /// let drag = world.add_force(Arc::new(Spring::new("drag", ends, 0.0, 4.0)), &mut |_| ())?;
    /// world.advance_to(1.5, &mut |_| ())?;
    /// world.remove_force(drag, &mut |_| ())?;
    /// let (position, velocity) = (1.0 - 1f64.cos(), 2.0 * 1f64.sin());
    /// assert!((world.state(puck).position.x - position).abs() < 1e-9);
    /// world.advance_to(2.5, &mut |_| ())?;
    /// assert!((world.state(puck).position.x - position - velocity).abs() < 1e-8);
    /// assert!(world.ledger().integration_error().abs() < 1e-8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`RunError::BadForce`] for a law that names a body which is not there, acts on one that it does not name, or whose
    /// force is not finite or too large at the present time: nothing is done then. Another error if the forces with it
    /// cannot be found: the world cannot go on then, as after such an error of [`advance_to`](Self::advance_to).
    pub fn add_force(
        &mut self,
        law: Arc<dyn ForceLaw>,
        on_event: &mut dyn FnMut(&Event),
    ) -> Result<ForceId, RunError> {
        self.check_force(law.as_ref()).map_err(|source| RunError::BadForce { source: Box::new(source) })?;
        let id = ForceId(self.strategy.force_laws().len());
        self.interrupt(on_event, |strategy, now| strategy.add_force_law(now, law))?;
        Ok(id)
    }

    /// Removes a force law, which acts no more from the present time on; its work stays in the [ledger](World::ledger),
    /// and the loss of its potential is booked there as an intervention. Does nothing if it was removed before.
    ///
    /// # Errors
    /// [`RunError::NoSuchForce`] if the world never had it: nothing is done then. Another error as of
    /// [`add_force`](Self::add_force).
    pub fn remove_force(&mut self, force: ForceId, on_event: &mut dyn FnMut(&Event)) -> Result<(), RunError> {
        if force.0 >= self.strategy.force_laws().len() {
            return Err(RunError::NoSuchForce);
        }
        if !self.strategy.is_acting(force.0) {
            return Ok(());
        }
        self.interrupt(on_event, |strategy, now| strategy.remove_force_law(now, force.0))
    }

    fn check_force(&self, law: &dyn ForceLaw) -> Result<(), WorldError> {
        let count = self.body_count();
        let is_missing = |body: &&BodyId| !body.is_world() && body.index() >= count;
        if let Some(missing) = law.bodies().iter().find(is_missing) {
            let what = format!("force law {:?}", law.name());
            return Err(WorldError::NoSuchBody { what, body: missing.0, bodies: count });
        }
        let moving: Vec<_> = self.bodies().map(|body| Moving::from(&self.state(body))).collect();
        let mut own = vec![Wrench::default(); count];
        check_law(law, &Snapshot::new(self.time(), &moving), &mut own, |body, sum| {
            let acceleration = self
                .inertia(body)
                .map_or(0.0, |inertia| acceleration(&inertia, self.shape(body).reach(), DVec2::ZERO, sum));
            (self.name(body).to_owned(), acceleration)
        })?;
        match own.iter().position(|sum| *sum != Wrench::default()) {
            None => Ok(()),
            Some(unnamed) => Err(WorldError::UnnamedBody {
                law: law.name().to_owned(),
                body: self.name(BodyId::from_index(unnamed)).to_owned(),
            }),
        }
    }
}
