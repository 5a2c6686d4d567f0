//! The event queue: at most one predicted event per source, the earliest first.
//!
//! A heap with four children per node that knows where each source's entry lies: a prediction that an event has made
//! void is replaced in place, and no stale one ever comes out. Equal times come in the order of their sources, so that
//! runs repeat to the bit. Compare M. Bannerman et al., "Stable algorithm for event detection in event-driven particle
//! dynamics", arXiv 1211.6718, and the queues they cite.

use crate::time::Time;

/// Index of a source of events, such as a pair, a body or a force law. Keep indices small: the queue holds a slot for
/// each up to the largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceId(pub u32);

/// An entry of the queue: the predicted event of one source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Scheduled {
    /// Time of the event.
    pub time: Time,
    /// Source of the event.
    pub source: SourceId,
}

/// Place of a source that has no event.
const ABSENT: u32 = u32::MAX;
/// Number of children of a node of the heap.
const CHILDREN: usize = 4;
/// Number of slots before the root, so that the children of a node fill one family.
const BEFORE_ROOT: usize = CHILDREN - 1;

/// The part of an entry that mostly decides its order: the first number [s] of its time. Between equal ones the rest of
/// the time decides, which is kept in `sources`, and then the source.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Key {
    seconds: f64,
    source: u32,
}

/// Content of an empty slot: later than every entry.
const NOTHING: Key = Key { seconds: f64::INFINITY, source: ABSENT };

/// The children of a node, in one cache line: a heap of many sources costs as much as the lines it touches.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[repr(align(64))]
struct Family([Key; CHILDREN]);

/// Queue of predicted events, at most one per source.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct EventQueue {
    families: Vec<Family>,
    len: usize,
    /// By source.
    sources: Vec<Source>,
}

/// Place and rest of the time of one source's event.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Source {
    /// Place of its entry in the heap, or `ABSENT`.
    place: u32,
    /// Second number [s] of its time.
    rest: f64,
}

impl Source {
    /// A source that has no event.
    const IDLE: Self = Self { place: ABSENT, rest: 0.0 };
}

impl EventQueue {
    /// An empty queue.
    #[must_use]
    #[inline]
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of sources that have an event.
    #[must_use]
    #[inline]
    pub fn len(&self) -> usize {
        self.len
    }

    /// True if no source has an event.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The earliest event; among equal times that of the least source. `None` if no source has an event.
    #[must_use]
    #[inline]
    pub fn first(&self) -> Option<Scheduled> {
        let key = (self.len > 0).then(|| self.key(0))?;
        Some(Scheduled { time: self.time(key), source: SourceId(key.source) })
    }

    /// Predicted time of the source's event; `None` if it has none.
    #[must_use]
    #[inline]
    pub fn time_of(&self, source: SourceId) -> Option<Time> {
        Some(self.time(self.key(self.place_of(source)?)))
    }

    /// Sets the source's event to `time`, in place of any earlier prediction. An event at [`Time::NEVER`] is an event, the
    /// last of all: [`clear`](Self::clear) a source for which none is predicted.
    pub fn set(&mut self, source: SourceId, time: Time) {
        let index = source.0 as usize;
        if index >= self.sources.len() {
            self.sources.resize(index + 1, Source::IDLE);
        }
        let (seconds, rest) = time.parts();
        let key = Key { seconds, source: source.0 };
        let Some(place) = self.place_of(source) else {
            self.sources[index].rest = rest;
            let place = self.grow();
            self.rise(place, key);
            return;
        };
        let is_earlier = time < self.time(self.key(place));
        self.sources[index].rest = rest;
        if is_earlier { self.rise(place, key) } else { self.sink(place, key) }
    }

    /// Removes the source's event, if it has one.
    #[inline]
    pub fn clear(&mut self, source: SourceId) {
        let Some(place) = self.place_of(source) else { return };
        self.sources[source.0 as usize].place = ABSENT;
        self.len -= 1;
        let (gone, last) = (self.key(place), self.key(self.len));
        *self.slot(self.len) = NOTHING;
        if place < self.len {
            if self.is_before(last, gone) { self.rise(place, last) } else { self.sink(place, last) }
        }
    }

    fn place_of(&self, source: SourceId) -> Option<usize> {
        let place = self.sources.get(source.0 as usize)?.place;
        (place != ABSENT).then_some(place as usize)
    }

    fn time(&self, key: Key) -> Time {
        Time::from_parts(key.seconds, self.sources[key.source as usize].rest)
    }

    /// Makes room for one more entry and returns its place.
    fn grow(&mut self) -> usize {
        let place = self.len;
        self.len += 1;
        if (place + BEFORE_ROOT) / CHILDREN >= self.families.len() {
            self.families.push(Family([NOTHING; CHILDREN]));
        }
        place
    }

    #[inline]
    fn key(&self, place: usize) -> Key {
        let slot = place + BEFORE_ROOT;
        self.families[slot / CHILDREN].0[slot % CHILDREN]
    }

    #[inline]
    fn slot(&mut self, place: usize) -> &mut Key {
        let slot = place + BEFORE_ROOT;
        &mut self.families[slot / CHILDREN].0[slot % CHILDREN]
    }

    #[inline]
    fn is_before(&self, a: Key, b: Key) -> bool {
        if a.seconds == b.seconds { self.breaks_tie(a, b) } else { a.seconds < b.seconds }
    }

    /// True if `a` is earlier than `b`, given equal first numbers of their times, which is rare.
    #[cold]
    fn breaks_tie(&self, a: Key, b: Key) -> bool {
        let of = |key: Key| {
            (self.sources.get(key.source as usize).map_or(f64::INFINITY, |source| source.rest), key.source)
        };
        let ((rest_a, source_a), (rest_b, source_b)) = (of(a), of(b));
        rest_a < rest_b || (rest_a == rest_b && source_a < source_b)
    }

    /// Puts an entry at a place and moves it towards the root past all later ones.
    fn rise(&mut self, mut place: usize, key: Key) {
        while place > 0 {
            let parent = (place - 1) / CHILDREN;
            let above = self.key(parent);
            if !self.is_before(key, above) {
                break;
            }
            self.put(place, above);
            place = parent;
        }
        self.put(place, key);
    }

    /// Puts an entry at a place and moves it away from the root past all earlier ones.
    fn sink(&mut self, mut place: usize, key: Key) {
        while let Some((child, least)) = self.earliest_child(place) {
            if !self.is_before(least, key) {
                break;
            }
            self.put(place, least);
            place = child;
        }
        self.put(place, key);
    }

    /// Place and key of the earliest child of a place; `None` if the place has no family of children.
    #[inline]
    fn earliest_child(&self, place: usize) -> Option<(usize, Key)> {
        let Family(family) = self.families.get(place + 1)?;
        let earlier = |a: usize, b: usize| if self.is_before(family[b], family[a]) { b } else { a };
        let least = earlier(earlier(0, 1), earlier(2, 3));
        Some((CHILDREN * place + 1 + least, family[least]))
    }

    #[inline]
    fn put(&mut self, place: usize, key: Key) {
        *self.slot(place) = key;
        self.sources[key.source as usize].place =
            u32::try_from(place).expect("sources are counted in 32 bits, and each has at most one place");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    /// Time [s] too short for the first number of a [`Time`] of some seconds to resolve.
    const LITTLE: f64 = 1e-20;

    fn time((seconds, rest): (u8, u8)) -> Time {
        Time::from_seconds(f64::from(seconds)).plus(LITTLE * f64::from(rest))
    }

    proptest! {
        #[test]
        fn the_queue_is_a_sorted_map(
            changes in prop::collection::vec((0u32..40, prop::option::of((1u8..12, 0u8..3))), 1..400),
        ) {
            let mut queue = EventQueue::new();
            let mut model = BTreeMap::new();
            for (source, at) in changes {
                match at {
                    Some(at) => {
                        queue.set(SourceId(source), time(at));
                        model.insert(source, at);
                    }
                    None => {
                        queue.clear(SourceId(source));
                        model.remove(&source);
                    }
                }
                let first = model.iter().map(|(&source, &at)| (at, source)).min();
                let found = queue.first().map(|entry| (entry.time, entry.source.0));
                prop_assert_eq!(found, first.map(|(at, source)| (time(at), source)));
                prop_assert_eq!(queue.len(), model.len());
                prop_assert_eq!(queue.time_of(SourceId(source)), at.map(time));
            }
        }
    }

    #[test]
    fn an_event_that_never_happens_comes_last() {
        let mut queue = EventQueue::new();
        (0..9).for_each(|source| queue.set(SourceId(source), Time::NEVER));
        queue.set(SourceId(9), Time::from_seconds(1.0));
        assert_eq!(queue.first().map(|entry| entry.source), Some(SourceId(9)));
        queue.clear(SourceId(9));
        assert_eq!(queue.first(), Some(Scheduled { time: Time::NEVER, source: SourceId(0) }));
    }

    #[test]
    fn a_family_fills_a_line_of_the_cache() {
        assert_eq!((size_of::<Family>(), align_of::<Family>()), (64, 64));
    }
}
