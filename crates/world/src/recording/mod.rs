//! Recordings of runs: states, energies and forces at output times, and all events in between.

mod csv;
mod json;

pub use csv::csv_field;

use crate::event::{ContactEvent, ContactForce, Impact};
use crate::ledger::Ledger;
use crate::scene::WORLD;
use crate::world::{Energy, World};
use halfgap_collision::{BodyId, BodyState};

/// The recording of a run. With [`Record::Ends`](crate::Record::Ends) it has no events, and frames at the ends only.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Title of the scene.
    pub title: String,
    /// All bodies, in the order of the scene.
    pub bodies: Vec<RecordedBody>,
    /// The movable bodies; frames hold their states in this order.
    pub movable: Vec<BodyId>,
    /// The fixed bodies that are moved; frames hold their states after those of the movable ones.
    pub moved: Vec<BodyId>,
    /// States at output times, the first at the start.
    pub frames: Vec<Frame>,
    /// Impacts, in order.
    pub impacts: Vec<Impact>,
    /// Contacts that began or ended, in order.
    pub contacts: Vec<ContactRecord>,
    /// Changes of the energy from the start to the last frame, by their causes.
    pub ledger: Ledger,
}

/// A contact that began, ended or changed otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactRecord {
    /// What happened to the contact.
    pub change: ContactChange,
    /// Time, place and force.
    pub event: ContactEvent,
}

/// Change of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactChange {
    /// The contact began.
    Begins,
    /// The contact ended.
    Ends,
    /// The contact has stuck, and slips now.
    Slips,
    /// The contact has slipped, and sticks now.
    Sticks,
    /// The contact has slipped, and velocities jump.
    Jams,
    /// The contact slips, and might go on in several ways.
    Undecided,
}

impl ContactChange {
    /// Name in tables: "begins", "ends", "slips", "sticks", "jams" or "undecided".
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Begins => "begins",
            Self::Ends => "ends",
            Self::Slips => "slips",
            Self::Sticks => "sticks",
            Self::Jams => "jams",
            Self::Undecided => "undecided",
        }
    }
}

/// A body of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedBody {
    /// Name of the body.
    pub name: String,
    /// Whether the body is immovable.
    pub fixed: bool,
}

/// The world at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The time [s].
    pub time: f64,
    /// States of the movable bodies, in the order of [`Recording::movable`], then of those that are moved.
    pub states: Vec<BodyState>,
    /// Energy of all bodies.
    pub energy: Energy,
    /// Forces of all contacts and connectors.
    pub forces: Vec<ContactForce>,
}

impl Recording {
    /// Makes a recording of a world, without frames yet.
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
            moved: world.bodies().filter(|&body| world.is_moved(body)).collect(),
            frames: Vec::new(),
            impacts: Vec::new(),
            contacts: Vec::new(),
            ledger: world.ledger(),
        }
    }

    /// Returns a frame of the world at its present time.
    #[must_use]
    pub fn frame_of(&self, world: &World) -> Frame {
        let states = self.movable.iter().chain(&self.moved).map(|&body| world.state(body)).collect();
        Frame { time: world.time(), states, energy: world.energy(), forces: world.contact_forces() }
    }

    /// Name of a body; "world" for the background, empty if there is no such body.
    #[must_use]
    pub fn name(&self, body: BodyId) -> &str {
        if body.is_world() {
            return WORLD;
        }
        self.bodies.get(body.0 as usize).map_or("", |body| &body.name)
    }

    /// Place of a body in the states of frames: its index in [`Recording::movable`], and after those for one that is moved; `None` for
    /// fixed bodies that stay, and the background.
    #[must_use]
    pub fn place(&self, body: BodyId) -> Option<usize> {
        let of_moved = || Some(self.movable.len() + self.moved.binary_search(&body).ok()?);
        self.movable.binary_search(&body).ok().or_else(of_moved)
    }
}
