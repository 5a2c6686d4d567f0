//! The event queue: at most one predicted event a source, the earliest first.
//!
//! A heap of four children a node that knows where each source's entry lies, so that a prediction that an event made worthless is replaced
//! in place and nothing stale ever comes out. Equal times come in the order of their sources, so that runs repeat to the
//! bit. Compare M. Bannerman et al., "Stable algorithm for event detection in event-driven particle dynamics",
//! arXiv 1211.6718, and the queues they cite.

use crate::time::Time;

/// Index of whatever predicts events: a pair, a body, a force law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceId(pub u32);

/// An entry of the queue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Scheduled {
    /// When.
    pub time: Time,
    /// Whose event.
    pub source: SourceId,
}

impl Scheduled {
    #[inline]
    fn is_before(&self, other: &Self) -> bool {
        self.time.is_before(other.time) | ((self.time == other.time) & (self.source < other.source))
    }
}

const ABSENT: u32 = u32::MAX;
/// Children of a node of the heap: they lie side by side, and half as many levels are gone through as with two.
const CHILDREN: usize = 4;

/// The predicted events of all sources.
#[derive(Clone, Debug, Default)]
pub struct EventQueue {
    heap: Vec<Scheduled>,
    /// Place in the heap of each source's entry.
    places: Vec<u32>,
}

impl EventQueue {
    /// An empty queue.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// How many sources have an event.
    #[must_use]
    pub fn len(&self) -> usize {
        self.heap.len()
    }

    /// True if no source has an event.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.heap.is_empty()
    }

    /// The earliest event.
    #[must_use]
    pub fn first(&self) -> Option<Scheduled> {
        self.heap.first().copied()
    }

    /// When the source's event is predicted, if it has one.
    #[must_use]
    pub fn time_of(&self, source: SourceId) -> Option<Time> {
        let place = self.places.get(source.0 as usize).copied().filter(|&place| place != ABSENT)?;
        Some(self.heap[place as usize].time)
    }

    /// Predicts the source's event for `time`, in place of any earlier prediction.
    pub fn set(&mut self, source: SourceId, time: Time) {
        let index = source.0 as usize;
        if index >= self.places.len() {
            self.places.resize(index + 1, ABSENT);
        }
        let entry = Scheduled { time, source };
        if self.places[index] == ABSENT {
            self.heap.push(entry);
            self.rise(self.heap.len() - 1);
        } else {
            let place = self.places[index] as usize;
            let is_earlier = entry.is_before(&self.heap[place]);
            self.heap[place] = entry;
            if is_earlier { self.rise(place) } else { self.sink(place) }
        }
    }

    /// Takes the source's event away, if it has one.
    pub fn clear(&mut self, source: SourceId) {
        let Some(place) = self.places.get(source.0 as usize).copied().filter(|&place| place != ABSENT) else {
            return;
        };
        self.places[source.0 as usize] = ABSENT;
        let place = place as usize;
        let Some(last) = self.heap.pop() else { return };
        if place < self.heap.len() {
            let is_earlier = last.is_before(&self.heap[place]);
            self.heap[place] = last;
            if is_earlier { self.rise(place) } else { self.sink(place) }
        }
    }

    fn rise(&mut self, mut place: usize) {
        let entry = self.heap[place];
        while place > 0 {
            let parent = (place - 1) / CHILDREN;
            if !entry.is_before(&self.heap[parent]) {
                break;
            }
            self.put(place, self.heap[parent]);
            place = parent;
        }
        self.put(place, entry);
    }

    fn sink(&mut self, mut place: usize) {
        let entry = self.heap[place];
        while let Some(child) = self.earliest_child(place) {
            if !self.heap[child].is_before(&entry) {
                break;
            }
            self.put(place, self.heap[child]);
            place = child;
        }
        self.put(place, entry);
    }

    /// Place of the earliest child of a place, if it has any.
    #[inline]
    fn earliest_child(&self, place: usize) -> Option<usize> {
        let first = CHILDREN * place + 1;
        let last = (first + CHILDREN).min(self.heap.len());
        let children = self.heap.get(first..last)?;
        // Which child it is cannot be foretold: no branches.
        let earlier = |a: usize, b: usize| if children[b].is_before(&children[a]) { b } else { a };
        match children.len() {
            0 => None,
            CHILDREN => Some(first + earlier(earlier(0, 1), earlier(2, 3))),
            few => Some(first + (1..few).fold(0, earlier)),
        }
    }

    #[inline]
    fn put(&mut self, place: usize, entry: Scheduled) {
        self.heap[place] = entry;
        self.places[entry.source.0 as usize] =
            u32::try_from(place).expect("sources are counted in 32 bits, and each has at most one place");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    proptest! {
        #[test]
        fn the_queue_is_a_sorted_map(changes in prop::collection::vec((0u32..40, prop::option::of(0u8..20)), 1..400)) {
            let mut queue = EventQueue::new();
            let mut model = BTreeMap::new();
            for (source, time) in changes {
                match time {
                    Some(time) => {
                        queue.set(SourceId(source), Time::from_seconds(f64::from(time)));
                        model.insert(source, time);
                    }
                    None => {
                        queue.clear(SourceId(source));
                        model.remove(&source);
                    }
                }
                let first = model.iter().map(|(&source, &time)| (time, source)).min();
                let found = queue.first().map(|entry| (entry.time.seconds() as u8, entry.source.0));
                prop_assert_eq!(found, first);
                prop_assert_eq!(queue.len(), model.len());
            }
        }
    }
}
