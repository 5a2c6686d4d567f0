//! What a run leaves behind: states at output times, impacts, energies.

mod csv;
mod json;

use crate::event::Impact;
use crate::world::{Energy, World};
use halfgap_collision::{BodyId, BodyState};

/// The recording of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Title of the scene.
    pub title: String,
    /// All bodies, in the order of the scene.
    pub bodies: Vec<RecordedBody>,
    /// The bodies whose states the frames hold, in that order: the movable ones.
    pub movable: Vec<BodyId>,
    /// States at output times, the first at the start.
    pub frames: Vec<Frame>,
    /// Every impact.
    pub impacts: Vec<Impact>,
}

/// What a recording says about a body.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedBody {
    /// Its name.
    pub name: String,
    /// It is immovable.
    pub fixed: bool,
}

/// The world at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// When [s].
    pub time: f64,
    /// States of the movable bodies.
    pub states: Vec<BodyState>,
    /// Energy of all bodies.
    pub energy: Energy,
}

impl Recording {
    /// A recording of a world, without frames yet.
    #[must_use]
    pub fn new(title: impl Into<String>, world: &World) -> Self {
        let bodies: Vec<_> = body_ids(world)
            .map(|body| RecordedBody { name: world.name(body).to_owned(), fixed: world.is_fixed(body) })
            .collect();
        let movable = body_ids(world).filter(|&body| !world.is_fixed(body)).collect();
        Self { title: title.into(), bodies, movable, frames: Vec::new(), impacts: Vec::new() }
    }

    /// The world as it is now.
    #[must_use]
    pub fn frame_of(&self, world: &World) -> Frame {
        let states = self.movable.iter().map(|&body| world.state(body)).collect();
        Frame { time: world.time(), states, energy: world.energy() }
    }

    /// Name of a body.
    #[must_use]
    pub fn name(&self, body: BodyId) -> &str {
        self.bodies.get(body.0 as usize).map_or("", |body| &body.name)
    }

    /// Place of a body among the movable ones.
    #[must_use]
    pub fn place(&self, body: BodyId) -> Option<usize> {
        self.movable.binary_search(&body).ok()
    }
}

/// All bodies of a world.
pub(crate) fn body_ids(world: &World) -> impl Iterator<Item = BodyId> {
    (0..u32::try_from(world.body_count()).unwrap_or(u32::MAX)).map(BodyId)
}
