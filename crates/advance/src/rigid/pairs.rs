//! Predictions of pairs of bodies whose boxes overlap: when their next contact is, or until when there is none.

use crate::time::Time;
use halfgap_collision::{BodyId, FeatureRule};
use halfgap_geometry::FeatureId;

/// Index of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PairId(pub(crate) u32);

/// What is known of a pair's next contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Prediction {
    /// A contact at this time, of these features.
    Contact(Time, [FeatureId; 2]),
    /// No contact before this time, at which the search goes on.
    SearchOn(Time),
    /// No contact before one of the bodies leaves its box.
    Quiet,
}

/// Two bodies whose boxes overlap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub(crate) bodies: [BodyId; 2],
    /// No contact before this time, other than a predicted one.
    pub(crate) clear: Time,
    pub(crate) prediction: Prediction,
    /// Contacts of this pair handled one after another without time going by.
    pub(crate) repeats: u32,
    /// Time of its last contact.
    pub(crate) last_contact: Option<Time>,
    alive: bool,
}

/// Two features as they were at the last event in which they touched.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Of the lesser body and of the other.
    pub(crate) features: [FeatureId; 2],
    pub(crate) time: Time,
    /// Gap [m].
    pub(crate) gap: f64,
    /// Rate of the gap [m/s].
    pub(crate) rate: f64,
}

/// All pairs, and those of each body.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pairs {
    pairs: Vec<Pair>,
    /// Feature pairs that are searched otherwise, of each pair.
    rules: Vec<Vec<FeatureRule>>,
    /// Feature pairs that have touched lately, of each pair.
    seen: Vec<Vec<Seen>>,
    free: Vec<PairId>,
    of_body: Vec<Vec<PairId>>,
    /// Fixed bodies keep no list: nothing ever changes their motion, and theirs would be the longest.
    is_fixed: Vec<bool>,
}

impl Pairs {
    pub(crate) fn new(is_fixed: Vec<bool>) -> Self {
        Self { of_body: vec![Vec::new(); is_fixed.len()], is_fixed, ..Self::default() }
    }

    pub(crate) fn get(&self, id: PairId) -> &Pair {
        &self.pairs[id.0 as usize]
    }

    pub(crate) fn get_mut(&mut self, id: PairId) -> &mut Pair {
        &mut self.pairs[id.0 as usize]
    }

    /// Rules for single pairs of features.
    pub(crate) fn rules(&self, id: PairId) -> &[FeatureRule] {
        &self.rules[id.0 as usize]
    }

    pub(crate) fn rules_mut(&mut self, id: PairId) -> &mut Vec<FeatureRule> {
        &mut self.rules[id.0 as usize]
    }

    /// Feature pairs that have touched lately.
    pub(crate) fn seen(&self, id: PairId) -> &[Seen] {
        &self.seen[id.0 as usize]
    }

    pub(crate) fn seen_mut(&mut self, id: PairId) -> &mut Vec<Seen> {
        &mut self.seen[id.0 as usize]
    }

    /// Pairs of a body that is not fixed, in an order that depends on the past alone.
    pub(crate) fn of_body(&self, body: BodyId) -> &[PairId] {
        &self.of_body[body.index()]
    }

    /// The pair of two bodies, if there is one.
    pub(crate) fn between(&self, a: BodyId, b: BodyId) -> Option<PairId> {
        let (few, other) = if self.is_fixed[a.index()] { (b, a) } else { (a, b) };
        self.of_body(few).iter().copied().find(|&pair| self.get(pair).bodies.contains(&other))
    }

    pub(crate) fn add(&mut self, a: BodyId, b: BodyId, clear: Time) -> PairId {
        let bodies = if a < b { [a, b] } else { [b, a] };
        let pair = Pair {
            bodies,
            clear,
            prediction: Prediction::Quiet,
            repeats: 0,
            last_contact: None,
            alive: true,
        };
        let id = match self.free.pop() {
            Some(id) => {
                *self.get_mut(id) = pair;
                self.rules_mut(id).clear();
                self.seen_mut(id).clear();
                id
            }
            None => {
                self.pairs.push(pair);
                self.rules.push(Vec::new());
                self.seen.push(Vec::new());
                PairId(
                    u32::try_from(self.pairs.len() - 1)
                        .expect("pairs of 32-bit bodies that are near each other"),
                )
            }
        };
        for body in bodies.into_iter().filter(|body| !self.is_fixed[body.index()]) {
            self.of_body[body.index()].push(id);
        }
        id
    }

    pub(crate) fn remove(&mut self, id: PairId) {
        debug_assert!(self.get(id).alive, "a pair is removed once");
        self.get_mut(id).alive = false;
        for body in self.get(id).bodies {
            let list = &mut self.of_body[body.index()];
            if let Some(place) = list.iter().position(|&pair| pair == id) {
                list.swap_remove(place);
            }
        }
        self.free.push(id);
    }
}
