//! What a run leaves behind: states, energies and forces at output times, and all events in between.

mod csv;
mod json;

use crate::event::{ContactEvent, ContactForce, Impact};
use crate::ledger::Ledger;
use crate::scene::WORLD;
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
    /// Every contact that began or ended.
    pub contacts: Vec<ContactRecord>,
    /// Where the energy went from the start to the last frame.
    pub ledger: Ledger,
}

/// A contact that began or ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactRecord {
    /// Which of both.
    pub change: ContactChange,
    /// When, where and how strong.
    pub event: ContactEvent,
}

/// What became of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactChange {
    /// It began.
    Begins,
    /// It ended.
    Ends,
}

impl ContactChange {
    /// The word for it in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Begins => "begins",
            Self::Ends => "ends",
        }
    }
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
    /// Forces of all contacts and connectors.
    pub forces: Vec<ContactForce>,
}

impl Recording {
    /// A recording of a world, without frames yet.
    #[must_use]
    pub fn new(title: impl Into<String>, world: &World) -> Self {
        let bodies: Vec<_> = world
            .bodies()
            .map(|body| RecordedBody { name: world.name(body).to_owned(), fixed: world.is_fixed(body) })
            .collect();
        let movable = world.bodies().filter(|&body| !world.is_fixed(body)).collect();
        Self {
            title: title.into(),
            bodies,
            movable,
            frames: Vec::new(),
            impacts: Vec::new(),
            contacts: Vec::new(),
            ledger: world.ledger(),
        }
    }

    /// The world as it is now.
    #[must_use]
    pub fn frame_of(&self, world: &World) -> Frame {
        let states = self.movable.iter().map(|&body| world.state(body)).collect();
        Frame { time: world.time(), states, energy: world.energy(), forces: world.contact_forces() }
    }

    /// Name of a body; "world" for the background.
    #[must_use]
    pub fn name(&self, body: BodyId) -> &str {
        if body.is_world() {
            return WORLD;
        }
        self.bodies.get(body.0 as usize).map_or("", |body| &body.name)
    }

    /// Place of a body among the movable ones.
    #[must_use]
    pub fn place(&self, body: BodyId) -> Option<usize> {
        self.movable.binary_search(&body).ok()
    }
}
