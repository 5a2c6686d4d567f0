//! The contacts of a pair of bodies: the mode of each, and what was seen of it last. The only place where a mode changes.
//!
//! | what has happened | mode |
//! |---|---|
//! | nothing is known of two features, or the contact has opened beyond its zone | none: open, and fires at the target gap |
//! | an event has left it without force, and no group watches it | [`Mode::Open`], with the gap at which it fires |
//! | the search has found that it grazes, or may sink | [`Mode::Open`], at a lower gap |
//! | it fires again and again at one time | [`Mode::Open`], lower by more each time |
//! | an event has left it without force at rest, in a group | [`Mode::Idle`] |
//! | it belongs to corners that pass over each other | [`Mode::Passed`] |
//! | its row is active | [`Mode::Active`] |
//!
//! An event forgets the modes of all contacts of its bodies, and gives the touching ones new ones once it knows which rows
//! are active. The rules of the search are a view of the modes.

use crate::rigid::contacts::pairs::{PairId, Pairs};
use crate::time::Time;
use halfgap_collision::{BodyId, FeatureRule};
use halfgap_geometry::FeatureId;

/// Number of feature pairs that are remembered for a pair of bodies after they have touched: those of two blocks in a
/// corner of a third, several times over. With more, a list is long to read; with fewer, a low bounce counts as a first one.
const MOST_SEEN: usize = 16;

/// Mode of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Mode {
    /// It carries no force; the search tells when it fires, at this gap [m].
    Open(f64),
    /// It touches without force, and the group of its bodies watches whether it sinks.
    Idle,
    /// It is no contact of the surfaces, though its features come near: nothing looks at it.
    Passed,
    /// It is a row of a group, and carries its force.
    Active,
}

/// A contact of two features.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Contact {
    /// Features of the lesser body and of the other.
    features: [FeatureId; 2],
    /// `None` where it is open and fires at the target gap.
    mode: Option<Mode>,
    /// What was seen at the last event in which it touched; `None` if it has not touched lately.
    seen: Option<Seen>,
}

/// State of two features at the last event in which they touched.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Seen {
    pub(crate) time: Time,
    /// Gap [m].
    pub(crate) gap: f64,
    /// Largest gap [m] at which they have touched.
    pub(crate) formed: f64,
    /// Rate of the gap [m/s].
    pub(crate) rate: f64,
    /// Number of low bounces in a row before that event.
    pub(crate) low: u32,
    /// True if they fired although they did not close, and have not left their target since: they open too slowly for
    /// the search to see them leave.
    pub(crate) fires_open: bool,
}

/// Contacts of a pair of bodies, at most one of the same features. Those seen last come last.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Contacts {
    list: Vec<Contact>,
    /// The modes as rules of the search.
    rules: Vec<FeatureRule>,
}

impl Contacts {
    pub(super) fn clear(&mut self) {
        self.list.clear();
        self.rules.clear();
    }

    /// True if a contact has a mode, which changes the search.
    pub(super) fn any_mode(&self) -> bool {
        !self.rules.is_empty()
    }

    fn find(&self, features: [FeatureId; 2]) -> Option<&Contact> {
        self.list.iter().find(|contact| contact.features == features)
    }

    fn set_mode(&mut self, features: [FeatureId; 2], mode: Mode) {
        match self.list.iter_mut().find(|contact| contact.features == features) {
            Some(contact) => contact.mode = Some(mode),
            None => self.list.push(Contact { features, mode: Some(mode), seen: None }),
        }
        self.list_rules();
    }

    /// Keeps the modes of which a test is true.
    fn retain_modes(&mut self, stays: impl Fn([FeatureId; 2], Mode) -> bool) {
        self.list.retain_mut(|contact| {
            contact.mode = contact.mode.filter(|&mode| stays(contact.features, mode));
            contact.mode.is_some() || contact.seen.is_some()
        });
        self.list_rules();
    }

    fn list_rules(&mut self) {
        self.rules.clear();
        self.rules.extend(self.list.iter().filter_map(|&Contact { features, mode, .. }| {
            let target = match mode? {
                Mode::Open(gap) => Some(gap),
                Mode::Idle | Mode::Passed | Mode::Active => None,
            };
            Some(FeatureRule { features, target })
        }));
    }

    fn see(&mut self, features: [FeatureId; 2], seen: Seen) {
        let place = self.list.iter().position(|contact| contact.features == features);
        let mode = place.and_then(|place| self.list.remove(place).mode);
        let known = self.list.iter().filter(|contact| contact.seen.is_some()).count();
        if known == MOST_SEEN
            && let Some(oldest) = self.list.iter().position(|contact| contact.seen.is_some())
        {
            match self.list[oldest].mode {
                Some(_) => self.list[oldest].seen = None,
                None => drop(self.list.remove(oldest)),
            }
        }
        self.list.push(Contact { features, mode, seen: Some(seen) });
    }

    fn forget_seen(&mut self) {
        self.list.retain_mut(|contact| {
            contact.seen = None;
            contact.mode.is_some()
        });
    }
}

impl Pairs {
    /// Gives a contact of a pair a mode.
    pub(crate) fn set_mode(&mut self, id: PairId, features: [FeatureId; 2], mode: Mode) {
        self.change_contacts(id, |contacts| contacts.set_mode(features, mode));
    }

    /// Lets contacts of a pair go on as open ones that fire at their target gap, unless a test of their features and
    /// mode is true.
    pub(crate) fn retain_modes(&mut self, id: PairId, stays: impl Fn([FeatureId; 2], Mode) -> bool) {
        self.change_contacts(id, |contacts| contacts.retain_modes(stays));
    }

    /// Lowers the gaps at which open contacts of a pair fire by a distance [m].
    pub(crate) fn lower_open(&mut self, id: PairId, distance: f64) {
        self.change_contacts(id, |contacts| {
            for contact in &mut contacts.list {
                if let Some(Mode::Open(gap)) = &mut contact.mode {
                    *gap -= distance;
                }
            }
            contacts.list_rules();
        });
    }

    /// Forgets a contact of a pair, which has left its zone: its return is no low bounce.
    pub(crate) fn forget_contact(&mut self, id: PairId, features: [FeatureId; 2]) {
        self.change_contacts(id, |contacts| {
            contacts.list.retain(|contact| contact.features != features);
            contacts.list_rules();
        });
    }

    /// Forgets the modes of the contacts of all pairs of a body.
    pub(crate) fn forget_modes_of(&mut self, body: BodyId) {
        for place in 0..self.of_body(body).len() {
            let pair = self.of_body(body)[place].pair;
            if self.get(pair).has_rules() {
                self.retain_modes(pair, |_, _| false);
            }
        }
    }

    /// Mode of a contact; `None` if it is open and fires at the target gap.
    pub(crate) fn mode(&self, id: PairId, features: [FeatureId; 2]) -> Option<Mode> {
        self.contacts(id).find(features)?.mode
    }

    /// The modes of the contacts of a pair, as rules of the search.
    pub(crate) fn rules(&self, id: PairId) -> &[FeatureRule] {
        &self.contacts(id).rules
    }

    /// Notes what an event has seen of a contact.
    pub(crate) fn see(&mut self, id: PairId, features: [FeatureId; 2], seen: Seen) {
        self.change_contacts(id, |contacts| contacts.see(features, seen));
    }

    /// What was seen of a contact at the last event in which it touched, if that was lately.
    pub(crate) fn seen(&self, id: PairId, features: [FeatureId; 2]) -> Option<&Seen> {
        self.contacts(id).find(features)?.seen.as_ref()
    }

    /// Forgets what was seen of the contacts of all pairs of a body.
    pub(crate) fn forget_seen_of(&mut self, body: BodyId) {
        for place in 0..self.of_body(body).len() {
            let pair = self.of_body(body)[place].pair;
            self.change_contacts(pair, Contacts::forget_seen);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(gap: f64) -> Seen {
        Seen { time: Time::ZERO, gap, formed: gap, rate: 0.0, low: 0, fires_open: false }
    }

    fn pair() -> (Pairs, PairId) {
        let mut pairs = Pairs::new(vec![false; 2]);
        let pair = pairs.add(BodyId(0), BodyId(1), Time::ZERO);
        (pairs, pair)
    }

    fn features(index: u32) -> [FeatureId; 2] {
        [FeatureId(index), FeatureId(0)]
    }

    #[test]
    fn the_search_skips_what_is_held_idle_or_passed_and_knows_where_others_fire() {
        let (mut pairs, pair) = pair();
        let modes = [Mode::Active, Mode::Idle, Mode::Passed, Mode::Open(0.5)];
        for (index, mode) in (0..).zip(modes) {
            pairs.set_mode(pair, features(index), mode);
            assert_eq!(pairs.mode(pair, features(index)), Some(mode));
        }
        let targets: Vec<_> = pairs.rules(pair).iter().map(|rule| rule.target).collect();
        assert_eq!(targets, [None, None, None, Some(0.5)]);
        pairs.lower_open(pair, 0.25);
        assert_eq!(pairs.mode(pair, features(3)), Some(Mode::Open(0.25)));
        pairs.forget_modes_of(BodyId(1));
        assert!(pairs.rules(pair).is_empty() && !pairs.get(pair).has_rules());
    }

    #[test]
    fn a_contact_that_loses_its_mode_is_remembered_as_long_as_it_was_seen_lately() {
        let (mut pairs, pair) = pair();
        pairs.set_mode(pair, features(0), Mode::Active);
        for index in 0..=16 {
            pairs.see(pair, features(index), seen(f64::from(index)));
        }
        assert!(pairs.seen(pair, features(0)).is_none(), "sixteen others were seen since");
        assert_eq!(pairs.mode(pair, features(0)), Some(Mode::Active));
        pairs.retain_modes(pair, |_, _| false);
        assert_eq!(pairs.seen(pair, features(1)).map(|seen| seen.gap), Some(1.0));
        pairs.forget_seen_of(BodyId(0));
        assert!(pairs.seen(pair, features(1)).is_none());
    }
}
