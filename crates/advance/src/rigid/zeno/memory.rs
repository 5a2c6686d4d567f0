//! The past that the limits decide by, for each body and for the system.

use crate::rigid::error::AdvanceError;
use crate::rigid::zeno::steps::Pace;
use crate::time::Time;

/// Recent events and steps, from which sequences that would never end are recognised.
#[derive(Clone, Debug)]
pub(crate) struct Zeno {
    /// Recent events of each body.
    pub(crate) recent: Vec<Recent>,
    /// The pace of the group that each body leads.
    pub(crate) paces: Vec<Pace>,
    /// Total time [s] to be simulated; 0 if it is not known.
    pub(crate) duration: f64,
    /// Time at which a pair last fired more often than [`CALM_REPEATS`](super::repeats::CALM_REPEATS).
    pub(crate) last_insistent: Option<Time>,
    /// Time at which a group was last ended as soon as it was made, because one of its contacts pulled.
    pub(crate) last_pull: Option<Time>,
    /// [`AdvanceError::Crawls`] or [`AdvanceError::TooFast`], to be returned once the present event is over; the system
    /// stays valid.
    pub(crate) crawls: Option<AdvanceError>,
}

impl Zeno {
    /// Makes the memory of `body_count` bodies without any events.
    pub(crate) fn new(body_count: usize) -> Self {
        Self {
            recent: vec![Recent::default(); body_count],
            paces: vec![Pace::default(); body_count],
            duration: 0.0,
            last_insistent: None,
            last_pull: None,
            crawls: None,
        }
    }
}

/// Recent events of one body.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Recent {
    /// Time at which counting began; `None` if it has not.
    pub(super) since: Option<Time>,
    /// Storm load since then [-]: the sum of the loads of its events.
    pub(super) load: usize,
    /// Time of the last event, if there was any.
    pub(super) last: Option<Time>,
}
