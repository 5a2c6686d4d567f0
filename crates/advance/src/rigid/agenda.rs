//! Sources of events and their numbers in the queue.

use crate::queue::{EventQueue, SourceId};
use crate::rigid::contacts::pairs::PairId;
use crate::time::Time;
use halfgap_collision::{BodyId, ConnectorId};

/// Source of an event. The queue takes events of one time in the order of these variants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Source {
    /// A body leaves its box.
    Box(BodyId),
    /// The group that a body leads comes to the end of its segment, or to an event on it.
    Group(BodyId),
    /// A rope goes taut.
    Connector(ConnectorId),
    /// The step that a body leads is over.
    Step(BodyId),
    /// Sunk contacts are put back, where contacts carry impulses only.
    Tick,
    /// A pair comes into contact, or its search goes on.
    Pair(PairId),
}

/// Numbers of bodies and of connectors, which fix the numbers of all sources.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Sources {
    bodies: u32,
    connectors: u32,
}

impl Sources {
    fn first_connector(self) -> u32 {
        self.bodies.saturating_mul(2)
    }

    fn first_step(self) -> u32 {
        self.first_connector().saturating_add(self.connectors)
    }

    fn tick(self) -> u32 {
        self.first_step().saturating_add(self.bodies)
    }

    fn id(self, source: Source) -> SourceId {
        SourceId(match source {
            Source::Box(body) => body.0,
            Source::Group(leader) => self.bodies.saturating_add(leader.0),
            Source::Connector(id) => self.first_connector().saturating_add(id.0),
            Source::Step(leader) => self.first_step().saturating_add(leader.0),
            Source::Tick => self.tick(),
            Source::Pair(pair) => self.tick().saturating_add(1).saturating_add(pair.0),
        })
    }

    fn source(self, SourceId(id): SourceId) -> Source {
        if id < self.bodies {
            Source::Box(BodyId(id))
        } else if id < self.first_connector() {
            Source::Group(BodyId(id - self.bodies))
        } else if id < self.first_step() {
            Source::Connector(ConnectorId(id - self.first_connector()))
        } else if id < self.tick() {
            Source::Step(BodyId(id - self.first_step()))
        } else if id == self.tick() {
            Source::Tick
        } else {
            Source::Pair(PairId(id - self.tick() - 1))
        }
    }
}

/// The queue of events by their sources.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Agenda {
    queue: EventQueue,
    sources: Sources,
}

impl Agenda {
    /// An empty queue for so many bodies and connectors.
    pub(crate) fn new(bodies: usize, connectors: usize) -> Self {
        let count = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
        let sources = Sources { bodies: count(bodies), connectors: count(connectors) };
        Self { queue: EventQueue::new(), sources }
    }

    /// The earliest event.
    pub(crate) fn first(&self) -> Option<(Time, Source)> {
        self.queue.first().map(|entry| (entry.time, self.sources.source(entry.source)))
    }

    /// Time of the event of a source, if one is predicted.
    pub(crate) fn time_of(&self, source: Source) -> Option<Time> {
        self.queue.time_of(self.sources.id(source))
    }

    /// Sets the time of the event of a source.
    pub(crate) fn set(&mut self, source: Source, time: Time) {
        self.queue.set(self.sources.id(source), time);
    }

    /// Takes back the event of a source.
    pub(crate) fn clear(&mut self, source: Source) {
        self.queue.clear(self.sources.id(source));
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn every_number_is_one_source() {
        let sources = Sources { bodies: 3, connectors: 2 };
        let found: Vec<Source> = (0..14).map(|id| sources.source(SourceId(id))).collect();
        let [a, b, c] = [BodyId(0), BodyId(1), BodyId(2)];
        let boxes_and_groups = [a, b, c].map(Source::Box).into_iter().chain([a, b, c].map(Source::Group));
        let connectors = [ConnectorId(0), ConnectorId(1)].map(Source::Connector);
        let rest = connectors.into_iter().chain([a, b, c].map(Source::Step)).chain([Source::Tick]);
        let pairs = [PairId(0), PairId(1)].map(Source::Pair);
        assert_eq!(found, boxes_and_groups.chain(rest).chain(pairs).collect::<Vec<_>>());
        assert!(found.iter().zip(0..).all(|(&source, id)| sources.id(source) == SourceId(id)));
    }
}
