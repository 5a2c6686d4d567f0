//! The past that the limits decide by, for each body and for the system.

use crate::rigid::bodies::instant::is_same_time;
use crate::rigid::contacts::friction::Axis;
use crate::rigid::error::AdvanceError;
use crate::rigid::zeno::budget::Spent;
use crate::rigid::zeno::stepped::AllStepped;
use crate::rigid::zeno::steps::Pace;
use crate::time::Time;
use halfgap_collision::BodyId;

/// Recent events and steps, from which sequences that would never end are recognised.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Zeno {
    /// Recent events of each body.
    pub(super) recent: Vec<Recent>,
    /// The pace of the group that each body leads.
    pub(super) paces: Vec<Pace>,
    /// Total time [s] to be simulated; 0 if it is not known.
    pub(super) duration: f64,
    /// Time at which a pair last fired more often than [`CALM_REPEATS`](super::repeats::CALM_REPEATS).
    pub(super) last_insistent: Option<Time>,
    /// Time at which a group was last ended as soon as it was made, because one of its contacts pulled.
    pub(super) last_pull: Option<Time>,
    /// Groups whose steps collapsed while contacts slipped, each a leader and its bodies, and when that last was.
    pub(super) collapsed: (Option<Time>, Vec<(BodyId, Vec<BodyId>)>),
    /// Slips that have come to a stop, each with its axis and the side to which it went, and when the last did.
    pub(super) stopped: (Option<Time>, Vec<StoppedSlip>),
    /// [`AdvanceError::Crawls`] or [`AdvanceError::TooFast`], to be returned once the present event is over; the system
    /// stays valid.
    pub(super) crawls: Option<AdvanceError>,
    /// What each body has spent of its budget.
    pub(super) spent: Vec<Spent>,
    /// The regions that are in a step.
    stepped: AllStepped,
}

/// A slip between two bodies that has come to a stop: the bodies, the axis, and true if it went to the positive side.
pub(crate) type StoppedSlip = ([BodyId; 2], Axis, bool);

impl Zeno {
    /// The regions that are in a step.
    #[inline]
    pub(crate) fn stepped(&self) -> &AllStepped {
        &self.stepped
    }

    /// The regions that are in a step, to be changed.
    #[inline]
    pub(crate) fn stepped_mut(&mut self) -> &mut AllStepped {
        &mut self.stepped
    }

    /// Sets the total time [s] to be simulated.
    pub(crate) fn set_duration(&mut self, duration: f64) {
        self.duration = duration;
    }

    /// Notes that a group is ended now, as soon as it was made, because one of its contacts pulled.
    pub(crate) fn note_pull(&mut self, now: Time) {
        self.last_pull = Some(now);
    }

    /// Notes that the steps of a group of some bodies, which one of them leads, have collapsed; false if they have before at the same time.
    pub(crate) fn note_collapse(&mut self, leader: BodyId, bodies: &[BodyId], now: Time) -> bool {
        let (last, groups) = &mut self.collapsed;
        if !last.is_some_and(|last| is_same_time(last, now)) {
            groups.clear();
        }
        *last = Some(now);
        let is_new = !groups.iter().any(|(other, _)| *other == leader);
        groups.push((leader, bodies.to_vec()));
        is_new
    }

    /// Notes that a slip has come to a stop.
    pub(crate) fn note_stop(&mut self, slip: StoppedSlip, now: Time) {
        let (last, slips) = &mut self.stopped;
        if !last.is_some_and(|last| is_same_time(last, now)) {
            slips.clear();
        }
        *last = Some(now);
        slips.push(slip);
    }

    /// The slips that have come to a stop at a time.
    pub(crate) fn stopped(&self, now: Time) -> &[StoppedSlip] {
        let (last, slips) = &self.stopped;
        if last.is_some_and(|last| is_same_time(last, now)) { slips } else { &[] }
    }

    /// The bodies of the group that a body led, if its steps have collapsed at a time.
    pub(crate) fn collapsed(&self, leader: BodyId, now: Time) -> Option<&[BodyId]> {
        let (last, groups) = &self.collapsed;
        let is_now = last.is_some_and(|last| is_same_time(last, now));
        let mut latest_first = groups.iter().rev().filter(|_| is_now);
        latest_first.find(|(other, _)| *other == leader).map(|(_, bodies)| bodies.as_slice())
    }

    /// Takes out the error that is to be returned once the present event is over.
    pub(crate) fn take_crawls(&mut self) -> Option<AdvanceError> {
        self.crawls.take()
    }

    /// Forgets the recent events of a body.
    pub(crate) fn forget_events(&mut self, body: BodyId) {
        self.recent[body.index()] = Recent::default();
        self.spent[body.index()] = Spent::default();
    }

    /// Makes the memory of `body_count` bodies without any events.
    pub(crate) fn new(body_count: usize) -> Self {
        Self {
            recent: vec![Recent::default(); body_count],
            paces: vec![Pace::default(); body_count],
            duration: 0.0,
            last_insistent: None,
            last_pull: None,
            collapsed: (None, Vec::new()),
            stopped: (None, Vec::new()),
            crawls: None,
            spent: vec![Spent::default(); body_count],
            stepped: AllStepped::new(body_count),
        }
    }
}

/// Recent events of one body.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Recent {
    /// Time at which counting began; `None` if it has not.
    pub(super) since: Option<Time>,
    /// Load since then [-]: the sum of the loads of its events.
    pub(super) load: usize,
    /// Time of the last event, if there was any.
    pub(super) last: Option<Time>,
}

impl Zeno {
    /// Time at which a pair last fired more often than [`CALM_REPEATS`](super::repeats::CALM_REPEATS).
    #[inline]
    pub(crate) fn last_insistent(&self) -> Option<Time> {
        self.last_insistent
    }
}
