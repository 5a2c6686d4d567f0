//! What the limits remember: of each body, and of the system.

use super::pace::Pace;
use super::storms::Recent;
use crate::rigid::error::AdvanceError;
use crate::time::Time;

/// By what happened lately it is told what would go on for ever.
#[derive(Clone, Debug)]
pub(crate) struct Memory {
    /// Recent events of each body.
    pub(crate) recent: Vec<Recent>,
    /// When the velocity of each body was last changed at once.
    pub(crate) struck: Vec<Option<Time>>,
    /// The pace of the group that each body leads.
    pub(super) paces: Vec<Pace>,
    /// For how long [s] the system will be advanced in all; 0 if nothing is known.
    pub(super) duration: f64,
    /// When contacts have fired again and again without time going by.
    pub(crate) last_insistent: Option<Time>,
    /// When a group was ended as it was made, because a contact pulled.
    pub(crate) last_pull: Option<Time>,
    /// What is to be told of steps that will never come to an end: nothing else is wrong.
    pub(crate) crawls: Option<AdvanceError>,
}

impl Memory {
    /// Of so many bodies that nothing has happened to.
    pub(crate) fn new(body_count: usize) -> Self {
        Self {
            recent: vec![Recent::default(); body_count],
            struck: vec![None; body_count],
            paces: vec![Pace::default(); body_count],
            duration: 0.0,
            last_insistent: None,
            last_pull: None,
            crawls: None,
        }
    }
}
