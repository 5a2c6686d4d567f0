//! Pairs of bodies that are near each other, found by boxes that a body may move in before they are looked at again.
//!
//! *Invariant*: two bodies whose boxes overlap are listed once, unless both are fixed or they pass through each other.

use crate::rigid::{PairRules, PairSurface, Surface};
use crate::stepping::bodies::{Bodies, Motion3, Nature};
use crate::stepping::contacts::Contact;
use glam::DVec2;
use halfgap_collision::{BodyId, BroadPhase};
use halfgap_geometry::Aabb;

/// Number of steps for which a new box is made, and its margin beyond them, as a fraction of the reach of its body [-]: a body at rest is looked
/// up once, one that moves once in two steps or more.
const STEPS: f64 = 2.0;
const MARGIN: f64 = 0.1;

/// A pair of bodies.
#[derive(Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Pair {
    /// The bodies, the lesser first.
    pub(super) bodies: [BodyId; 2],
    pub(super) surface: PairSurface,
    pub(super) elasticity: f64,
    pub(super) contacts: Vec<Contact>,
    /// Deepest overlap [m] in the last step; 0 if there was none.
    pub(super) deepest: f64,
    /// Sum of the ways [m] of both bodies up to which the contacts are all that can touch.
    pub(super) known_until: f64,
}

impl Clone for Pair {
    fn clone(&self) -> Self {
        Self { contacts: self.contacts.clone(), ..*self }
    }

    fn clone_from(&mut self, source: &Self) {
        let mut contacts = std::mem::take(&mut self.contacts);
        contacts.clone_from(&source.contacts);
        *self = Self { contacts, ..*source };
    }
}

/// All pairs.
#[derive(Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Pairs {
    all: Vec<Pair>,
    /// Places of the pairs of each body; none of fixed ones, whose lists would be the longest.
    of_body: Vec<Vec<u32>>,
    broad: BroadPhase,
    /// Pairs that pass through each other, the lesser body first, sorted.
    excluded: Vec<(BodyId, BodyId)>,
    /// Pairs that differ from what their surfaces say.
    rules: PairRules,
    found: Vec<BodyId>,
    /// Buffers of pairs that are no more.
    spare: Vec<Vec<Contact>>,
    target_gap: f64,
}

impl Clone for Pairs {
    fn clone(&self) -> Self {
        let mut pairs = Self::default();
        pairs.clone_from(self);
        pairs
    }

    /// Uses the buffers again.
    fn clone_from(&mut self, source: &Self) {
        let Self { all, of_body, broad, excluded, rules, found: _, spare: _, target_gap } = source;
        self.spare.extend(self.all.drain(all.len().min(self.all.len())..).map(|pair| pair.contacts));
        let (known, further) = all.split_at(self.all.len());
        self.all.clone_from_slice(known);
        for pair in further {
            let mut contacts = self.spare.pop().unwrap_or_default();
            contacts.clone_from(&pair.contacts);
            self.all.push(Pair { contacts, ..*pair });
        }
        self.of_body.clone_from(of_body);
        self.broad.clone_from(broad);
        self.excluded.clone_from(excluded);
        self.rules.clone_from(rules);
        self.target_gap = *target_gap;
    }
}

impl Pairs {
    pub(super) fn new(
        count: usize,
        (excluded, rules): (Vec<(BodyId, BodyId)>, PairRules),
        target_gap: f64,
    ) -> Self {
        let mut excluded: Vec<_> = excluded.into_iter().map(|(a, b)| (a.min(b), a.max(b))).collect();
        excluded.sort_unstable();
        excluded.dedup();
        Self { of_body: vec![Vec::new(); count], excluded, rules, target_gap, ..Self::default() }
    }

    pub(super) fn excluded(&self) -> &[(BodyId, BodyId)] {
        &self.excluded
    }

    pub(super) fn all(&self) -> &[Pair] {
        &self.all
    }

    pub(super) fn all_mut(&mut self) -> &mut [Pair] {
        &mut self.all
    }

    /// Places of the pairs of a movable body.
    pub(super) fn of(&self, body: BodyId) -> &[u32] {
        &self.of_body[body.index()]
    }

    /// Tells how a body goes in the step, as far as is known, and by how much [m] it may go otherwise; its pairs are found anew if it can
    /// leave its box.
    pub(super) fn cover(&mut self, bodies: &Bodies, body: BodyId, motion: Motion3, play: f64) {
        if let Some(boxed) = self.extend(bodies, body, motion, play)
            && !bodies.is_fixed(body)
        {
            self.drop_far(bodies, body, &boxed);
        }
    }

    /// As [`cover`](Self::cover), but drops no pair; returns the box of the body if it is a new one.
    pub(super) fn extend(
        &mut self,
        bodies: &Bodies,
        body: BodyId,
        [x, y, turn]: Motion3,
        play: f64,
    ) -> Option<Aabb> {
        let nature = &bodies.natures[body.index()];
        let here = nature.body.shape.bounds_at(&bodies.movings[body.index()].pose);
        let along = |steps: f64, margin: f64| {
            let shift = steps * DVec2::new(x, y);
            let there = Aabb { min: here.min + shift, max: here.max + shift };
            here.union(there).grown(steps * (turn.abs() * nature.reach + play) + margin + self.target_gap)
        };
        if self.broad.bounds(body).is_some_and(|boxed| boxed.contains(&along(1.0, 0.0))) {
            return None;
        }
        let boxed = along(STEPS, MARGIN * nature.reach);
        self.broad.set(body, boxed);
        let mut found = std::mem::take(&mut self.found);
        self.broad.find_overlapping(&boxed, &mut found);
        for &other in &found {
            self.add(bodies, [body.min(other), body.max(other)]);
        }
        self.found = found;
        Some(boxed)
    }

    /// Drops the pairs of a body whose boxes no longer overlap, but for those whose contacts have yet to end.
    fn drop_far(&mut self, bodies: &Bodies, body: BodyId, boxed: &Aabb) {
        let mut next = 0;
        while let Some(&place) = self.of_body[body.index()].get(next) {
            let Pair { bodies: [a, b], contacts, .. } = &self.all[place as usize];
            let other = if *a == body { *b } else { *a };
            let is_told = contacts.iter().any(|contact| contact.is_told);
            if is_told || self.broad.bounds(other).is_some_and(|bounds| bounds.overlaps(boxed)) {
                next += 1;
            } else {
                self.remove(bodies, place);
            }
        }
    }

    fn add(&mut self, bodies: &Bodies, [a, b]: [BodyId; 2]) {
        let listed = if bodies.is_fixed(a) { b } else { a };
        if a == b || bodies.is_fixed(listed) || self.excluded.binary_search(&(a, b)).is_ok() {
            return;
        }
        let is_known = |&place: &u32| self.all[place as usize].bodies == [a, b];
        if self.of_body[listed.index()].iter().any(is_known) {
            return;
        }
        let place = self.all.len() as u32;
        let natures: [&Nature; 2] = [a, b].map(|body| &bodies.natures[body.index()]);
        let surfaces: [&Surface; 2] = natures.map(|nature| &nature.surface);
        let mut contacts = self.spare.pop().unwrap_or_default();
        contacts.clear();
        let elasticity = natures[0].body.elasticity.min(natures[1].body.elasticity);
        let elasticity = self.rules.of([a, b]).and_then(|rule| rule.elasticity).unwrap_or(elasticity);
        self.all.push(Pair {
            bodies: [a, b],
            surface: self.rules.together([a, b], surfaces),
            elasticity,
            contacts,
            deepest: 0.0,
            known_until: f64::NEG_INFINITY,
        });
        for body in [a, b].into_iter().filter(|&body| !bodies.is_fixed(body)) {
            self.of_body[body.index()].push(place);
        }
    }

    /// Removes a pair; the last one takes its place.
    fn remove(&mut self, bodies: &Bodies, place: u32) {
        let last = (self.all.len() - 1) as u32;
        for body in self.all[place as usize].bodies.into_iter().filter(|&body| !bodies.is_fixed(body)) {
            self.of_body[body.index()].retain(|&other| other != place);
        }
        if last != place {
            for body in self.all[last as usize].bodies.into_iter().filter(|&body| !bodies.is_fixed(body)) {
                for other in self.of_body[body.index()].iter_mut().filter(|other| **other == last) {
                    *other = place;
                }
            }
        }
        self.spare.push(self.all.swap_remove(place as usize).contacts);
    }
}
