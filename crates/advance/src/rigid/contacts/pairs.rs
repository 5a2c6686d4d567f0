//! Pairs of bodies whose boxes overlap, with the prediction of their next contact, or of the time until which there is
//! none.

use crate::rigid::bodies::instant::is_same_time;
use crate::rigid::contacts::table::{Contacts, Mode};
use crate::rigid::contacts::touch::{sorted, touch_of};
use crate::time::Time;
use halfgap_collision::{BodyId, Collision};
use halfgap_geometry::FeatureId;

/// Index of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct PairId(pub(crate) u32);

/// Prediction of a pair's next contact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Prediction {
    /// Contact of these features, at the time until which the pair is clear.
    Contact([FeatureId; 2]),
    /// No contact before the time until which the pair is clear; then the search goes on.
    SearchOn,
    /// No contact before one of the bodies leaves its box: nothing is in the queue.
    Quiet,
}

/// State of a pair of bodies: all that every prediction reads, and no more, within a cache line.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
#[repr(align(32))]
pub(crate) struct Pair {
    /// Time before which there is no contact.
    pub(super) clear: Time,
    pub(super) prediction: Prediction,
    /// Last batch of predictions that the pair was in.
    pub(super) batch: u16,
    /// True if rules change the search of any feature pair.
    pub(super) has_rules: bool,
    pub(super) alive: bool,
}

/// A pair as one of its bodies sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Link {
    pub(crate) pair: PairId,
    pub(crate) other: BodyId,
}

/// Contacts of a pair, and counts of its events.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct PairPast {
    contacts: Contacts,
    /// Number of contacts handled without time going by since the first of them.
    pub(super) repeats: u32,
    /// Time of the last contact.
    pub(super) last_contact: Option<Time>,
    /// Number of times in succession that the search for the next contact went on.
    pub(super) searches: u32,
}

impl PairPast {
    /// Forgets everything but the room of its buffers.
    fn clear(&mut self) {
        self.contacts.clear();
        (self.repeats, self.last_contact, self.searches) = (0, None, 0);
    }
}

/// All pairs, and lists of them by body.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Pairs {
    pairs: Vec<Pair>,
    /// The bodies of each pair, the lesser first.
    bodies: Vec<[BodyId; 2]>,
    pasts: Vec<PairPast>,
    free: Vec<PairId>,
    of_body: Vec<Vec<Link>>,
    /// Number of the present batch of predictions.
    batch: u16,
    /// True for bodies that stay where they are. These keep no list: nothing ever changes that, and their lists would be
    /// the longest.
    stays: Vec<bool>,
}

impl Pairs {
    pub(crate) fn new(stays: Vec<bool>) -> Self {
        Self { of_body: vec![Vec::new(); stays.len()], stays, ..Self::default() }
    }

    pub(crate) fn get(&self, id: PairId) -> &Pair {
        &self.pairs[id.0 as usize]
    }

    pub(crate) fn get_mut(&mut self, id: PairId) -> &mut Pair {
        &mut self.pairs[id.0 as usize]
    }

    /// The bodies of a pair, the lesser first.
    pub(crate) fn bodies(&self, id: PairId) -> [BodyId; 2] {
        self.bodies[id.0 as usize]
    }

    /// The contacts of a pair.
    pub(super) fn contacts(&self, id: PairId) -> &Contacts {
        &self.pasts[id.0 as usize].contacts
    }

    /// Changes the contacts of a pair, and updates `has_rules`.
    pub(super) fn change_contacts(&mut self, id: PairId, change: impl FnOnce(&mut Contacts)) {
        let contacts = &mut self.pasts[id.0 as usize].contacts;
        change(contacts);
        self.pairs[id.0 as usize].has_rules = contacts.any_mode();
    }

    pub(crate) fn past(&self, id: PairId) -> &PairPast {
        &self.pasts[id.0 as usize]
    }

    pub(crate) fn past_mut(&mut self, id: PairId) -> &mut PairPast {
        &mut self.pasts[id.0 as usize]
    }

    /// Counts a contact of a pair at a time; returns how many came before without time going by.
    pub(crate) fn count_contact(&mut self, id: PairId, now: Time) -> u32 {
        let past = &mut self.pasts[id.0 as usize];
        let is_repeat = past.last_contact.is_some_and(|last| is_same_time(last, now));
        past.repeats = if is_repeat { past.repeats + 1 } else { 0 };
        past.last_contact = Some(now);
        past.repeats
    }

    /// Counts a search of a pair that went on, or ended; returns how many have gone on in succession.
    pub(crate) fn count_search(&mut self, id: PairId) -> u32 {
        let goes_on = self.get(id).prediction == Prediction::SearchOn;
        let past = &mut self.pasts[id.0 as usize];
        past.searches = if goes_on { past.searches + 1 } else { 0 };
        past.searches
    }

    /// Counts the searches of a pair anew.
    pub(crate) fn forget_searches(&mut self, id: PairId) {
        self.pasts[id.0 as usize].searches = 0;
    }

    /// Sets the prediction of a pair, and the time until which it is clear; returns the prediction before.
    #[inline]
    pub(crate) fn foresee(&mut self, id: PairId, prediction: Prediction, clear: Time) -> Prediction {
        let pair = &mut self.pairs[id.0 as usize];
        pair.clear = clear;
        std::mem::replace(&mut pair.prediction, prediction)
    }

    /// Begins a new batch of predictions, without pairs.
    pub(crate) fn begin_batch(&mut self) {
        self.batch = self.batch.wrapping_add(1);
        if self.batch == 0 {
            self.pairs.iter_mut().for_each(|pair| pair.batch = 0);
            self.batch = 1;
        }
    }

    /// Puts the pairs of a body into the present batch, and lists those that were not in it yet: all, or only the quiet
    /// ones.
    ///
    /// A loop of its own: pairs lie anywhere in memory, and it asks for the next before the last has come.
    #[inline]
    pub(crate) fn enter_batch(&mut self, body: BodyId, only_quiet: bool, entered: &mut Vec<Link>) {
        entered.clear();
        for &link in &self.of_body[body.index()] {
            let pair = &mut self.pairs[link.pair.0 as usize];
            let is_new = std::mem::replace(&mut pair.batch, self.batch) != self.batch;
            if is_new && (!only_quiet || pair.prediction == Prediction::Quiet) {
                entered.push(link);
            }
        }
    }

    /// Pairs of a body that does not stay where it is, in an order that depends on the past alone.
    pub(crate) fn of_body(&self, body: BodyId) -> &[Link] {
        &self.of_body[body.index()]
    }

    /// The pair of two bodies, if there is one.
    pub(crate) fn between(&self, a: BodyId, b: BodyId) -> Option<PairId> {
        let (few, other) = if self.stays[a.index()] { (b, a) } else { (a, b) };
        self.of_body(few).iter().find(|link| link.other == other).map(|link| link.pair)
    }

    pub(crate) fn add(&mut self, a: BodyId, b: BodyId, clear: Time) -> PairId {
        let bodies = if a < b { [a, b] } else { [b, a] };
        let pair = Pair { clear, prediction: Prediction::Quiet, batch: 0, has_rules: false, alive: true };
        let id = match self.free.pop() {
            Some(id) => {
                *self.get_mut(id) = pair;
                self.bodies[id.0 as usize] = bodies;
                self.past_mut(id).clear();
                id
            }
            None => {
                self.pairs.push(pair);
                self.bodies.push(bodies);
                self.pasts.push(PairPast::default());
                PairId(
                    u32::try_from(self.pairs.len() - 1)
                        .expect("pairs of 32-bit bodies that are near each other"),
                )
            }
        };
        for (body, other) in [(a, b), (b, a)] {
            if !self.stays[body.index()] {
                self.of_body[body.index()].push(Link { pair: id, other });
            }
        }
        id
    }

    pub(crate) fn remove(&mut self, id: PairId) {
        debug_assert!(self.get(id).alive, "a pair is removed once");
        self.get_mut(id).alive = false;
        for body in self.bodies(id) {
            let list = &mut self.of_body[body.index()];
            if let Some(place) = list.iter().position(|link| link.pair == id) {
                list.swap_remove(place);
            }
        }
        self.free.push(id);
    }
}

/// True if a contact is active or watched now, so that the search skips it.
pub(crate) fn is_active_contact(pairs: &Pairs, record: &Collision, bodies: [BodyId; 2]) -> bool {
    let (Some(touch), Some(pair)) = (touch_of(record, bodies), pairs.between(bodies[0], bodies[1])) else {
        return false;
    };
    matches!(pairs.mode(pair, touch.features), Some(Mode::Active | Mode::Idle | Mode::Passed))
}

/// `Some(true)` if a record is likely to carry a force, since its contact is active until now; `None` if nothing is
/// known. Of rows that nearly depend on each other a side is more likely, whose normal stays, than a corner, about which it turns.
pub(crate) fn is_likely(pairs: &Pairs, record: &Collision) -> Option<bool> {
    let [a, b] = record.bodies();
    let is_active = is_active_contact(pairs, record, sorted(a, b));
    is_active.then_some(true).or_else(|| record.turns_about_corner().then_some(false))
}

impl PairPast {
    /// Time of the last contact.
    #[inline]
    pub(crate) fn last_contact(&self) -> Option<Time> {
        self.last_contact
    }

    /// Number of contacts handled without time going by since the first of them.
    #[inline]
    pub(crate) fn repeats(&self) -> u32 {
        self.repeats
    }
}

impl Pair {
    /// Time before which there is no contact.
    #[inline]
    pub(crate) fn clear(&self) -> Time {
        self.clear
    }

    /// True if rules change the search of any feature pair.
    #[inline]
    pub(crate) fn has_rules(&self) -> bool {
        self.has_rules
    }

    /// The prediction.
    #[inline]
    pub(crate) fn prediction(&self) -> Prediction {
        self.prediction
    }
}
