//! Worlds as bytes, from which they go on.
//!
//! *Invariant*: a loaded world advances with the same bits as the saved one. So everything is saved that a later event
//! could read, steps computed ahead included; left out are buffers, and what follows from the rest with the same bits.
//! `header` tells damaged bytes from sound ones before any is decoded, `law` knows the force laws, `kind` the words that
//! a world holds by reference, `error` is why bytes cannot be made or read.

mod error;
mod header;
pub(crate) mod kind;
mod law;

pub use error::{LoadError, SaveError};

use crate::builder::{Joints, Parts};
use crate::event::{Event, Impact};
use crate::invariant_monitor::InvariantMonitor;
use crate::strategy::SavedStrategy;
use crate::world::{Named, Start, World};
use halfgap_advance::Time;
use law::SavedLaw;
use serde::{Deserialize, Serialize};

/// What is saved of a world: of borrowed parts when it is written, of owned ones when it is read.
#[derive(Serialize, Deserialize)]
struct Content<S, B, W, M> {
    force_laws: Vec<SavedLaw>,
    strategy: S,
    bodies: B,
    parts: Parts,
    now: Time,
    warnings: W,
    start: Start,
    owes_first_report: bool,
    monitor: M,
}

impl World {
    /// Writes the world to bytes, from which [`load`](Self::load) makes a world that goes on with the same bits: states,
    /// events, ledger, statistics. A world that has failed is saved with its error.
    ///
    /// The bytes are for this version of the crate alone, built with the same features. Worlds that are to be kept for longer are described by scene
    /// files.
    ///
    /// ```
    /// use halfgap::geometry::{DVec2, Shape};
    /// use halfgap::{BodySpec, BodyState, World, WorldBuilder, WorldSettings};
    ///
    /// let mut builder = WorldBuilder::new(WorldSettings::default());
    /// builder.add(BodySpec::fixed("floor", Shape::block(10.0, 1.0)?, DVec2::new(0.0, -0.5)));
    /// let start = BodyState { position: DVec2::new(0.0, 2.0), ..BodyState::default() };
    /// let ball = builder.add(BodySpec::movable("ball", Shape::disc(0.5)?, 1.0, start));
    /// builder.add_gravity(ball, DVec2::new(0.0, -10.0));
    /// let mut world = builder.build()?;
    /// world.advance_to(0.7, &mut |_| ())?;
    ///
    /// let bytes = world.save()?;
    /// let mut other = World::load(&bytes)?;
    /// world.advance_to(5.0, &mut |_| ())?;
    /// other.advance_to(5.0, &mut |_| ())?;
    /// assert_eq!(other.state(ball), world.state(ball));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SaveError::OwnLaw`] if the world has, or had, a force law that is not one of this crate's.
    pub fn save(&self) -> Result<Vec<u8>, SaveError> {
        let force_laws = self.strategy.force_laws().iter().map(|law| SavedLaw::of(law.as_ref()));
        let content = Content {
            force_laws: force_laws.collect::<Result<_, _>>()?,
            strategy: &self.strategy,
            bodies: &self.bodies,
            parts: self.joints.saved_parts(),
            now: self.now,
            warnings: &self.warnings,
            start: self.start,
            owes_first_report: self.owes_first_report,
            monitor: &self.monitor,
        };
        let written = postcard::to_extend(&content, header::room());
        let written = written.map_err(|error| SaveError::Unwritten { reason: error.to_string() })?;
        Ok(header::close(written))
    }

    /// Makes a world from bytes that [`save`](Self::save) wrote.
    ///
    /// A checksum tells damaged bytes, in time proportional to their number. It is no protection from bytes that were made
    /// to deceive: load only what you have saved.
    ///
    /// # Errors
    /// [`LoadError`] for bytes that are damaged, of another version, or no saved world.
    pub fn load(bytes: &[u8]) -> Result<Self, LoadError> {
        type Owned = Content<SavedStrategy, Vec<Named>, Vec<String>, InvariantMonitor>;
        let content: Owned = match postcard::take_from_bytes(header::open(bytes)?) {
            Ok((content, [])) => content,
            Ok((_, left)) => {
                return Err(LoadError::Unreadable { reason: format!("{} bytes are left", left.len()) });
            }
            Err(error) => return Err(LoadError::Unreadable { reason: error.to_string() }),
        };
        let force_laws = content.force_laws.into_iter().map(SavedLaw::into_law).collect();
        let strategy = content
            .strategy
            .with_force_laws(force_laws)
            .map_err(|error| LoadError::Unreadable { reason: error.to_string() })?;
        let mut driven = Vec::new();
        strategy.write_driven_states(content.now, &mut driven);
        Ok(Self {
            driven,
            joints: Joints::restored(strategy.connectors().to_vec(), content.parts),
            strategy,
            bodies: content.bodies,
            now: content.now,
            warnings: content.warnings,
            start: content.start,
            told: Event::Impact(Impact::default()),
            owes_first_report: content.owes_first_report,
            monitor: content.monitor,
        })
    }
}
