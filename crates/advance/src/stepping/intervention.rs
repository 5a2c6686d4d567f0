//! What callers change about a system, and how it is taken up again after it was saved.

#[cfg(feature = "save")]
use crate::rigid::PartsError;
use crate::rigid::{
    AdvanceError, ForceLaw, Handled, Snapshot, VelocityChange, check_bodies_of_force_law, check_finite,
};
use crate::stepping::books::StepBooks;
use crate::stepping::step::{From, Scene};
use crate::stepping::system::SteppingSystem;
use crate::time::Time;
use halfgap_collision::Moving;
use std::sync::Arc;

impl SteppingSystem {
    /// Changes velocities of bodies at a time of the present step, all at once; a new step begins there.
    ///
    /// # Errors
    /// A time or a change that is not finite: nothing is done.
    ///
    /// # Panics
    /// If there is no such body.
    pub fn intervene(
        &mut self,
        time: Time,
        changes: &[VelocityChange],
    ) -> Result<Option<Handled>, AdvanceError> {
        check_finite(time, changes)?;
        self.interrupt(time, |scene, books| {
            for change in changes {
                if scene.bodies.is_fixed(change.body) {
                    continue;
                }
                let place = change.body.index();
                let moving = &mut scene.bodies.movings[place];
                let motion =
                    |moving: &Moving| [moving.velocity.x, moving.velocity.y, moving.angular_velocity];
                let before = motion(moving);
                moving.velocity += change.velocity;
                moving.angular_velocity += change.angular_velocity;
                let after = motion(moving);
                let energy = |motion| scene.bodies.kinetic_energy(place, motion);
                books.book_intervention(energy(after) - energy(before));
            }
        })
    }

    /// Adds a force law that acts from a time of the present step on.
    ///
    /// # Errors
    /// A time that is not finite, or a law that names a body that is not there: nothing is done.
    pub fn add_force_law(
        &mut self,
        time: Time,
        law: Arc<dyn ForceLaw>,
    ) -> Result<Option<Handled>, AdvanceError> {
        check_finite(time, &[])?;
        check_bodies_of_force_law(self.force_laws().len(), law.as_ref(), self.body_count())?;
        self.interrupt(time, |scene, books| {
            let snapshot = Snapshot::new(time.seconds(), &scene.bodies.movings);
            let potential = law.potential(&snapshot);
            books.book_intervention(potential.unwrap_or(0.0));
            books.add_law();
            scene.laws.add(law, potential.is_some());
        })
    }

    /// Removes the force law at an index from a time of the present step on. Does nothing if the law does not act.
    ///
    /// # Errors
    /// A time that is not finite: nothing is done.
    pub fn remove_force_law(&mut self, time: Time, law: usize) -> Result<Option<Handled>, AdvanceError> {
        check_finite(time, &[])?;
        if !self.is_acting(law) {
            return Ok(None);
        }
        self.interrupt(time, |scene, books| {
            let snapshot = Snapshot::new(time.seconds(), &scene.bodies.movings);
            books.book_intervention(-scene.laws.all[law].potential(&snapshot).unwrap_or(0.0));
            scene.laws.remove(law);
        })
    }

    /// Lets something happen at a time, at which a new step begins.
    fn interrupt(
        &mut self,
        time: Time,
        act: impl FnOnce(&mut Scene, &mut StepBooks),
    ) -> Result<Option<Handled>, AdvanceError> {
        let time = time.max(self.node);
        let since = time.since(self.node);
        self.books.begin(since - 0.5 * self.span);
        self.go_to(time);
        self.scene.sleep.wake_all();
        act(&mut self.scene, &mut self.books);
        Ok(self.begin(From::Start(since)))
    }
}

/// A system that was saved, which waits for its force laws.
#[cfg(feature = "save")]
#[derive(Debug, serde::Deserialize)]
pub struct SavedStepping {
    system: SteppingSystem,
}

#[cfg(feature = "save")]
impl SavedStepping {
    /// The system as it was when it was saved, given the force laws that it had: it goes on with the same bits.
    ///
    /// # Errors
    /// Laws that are too many, too few, or name a body that is not there.
    pub fn with_force_laws(self, laws: Vec<Arc<dyn ForceLaw>>) -> Result<SteppingSystem, PartsError> {
        let mut system = self.system;
        for (index, law) in laws.iter().enumerate() {
            check_bodies_of_force_law(index, law.as_ref(), system.body_count())?;
        }
        system.scene.laws.restore(laws)?;
        Ok(system)
    }
}
