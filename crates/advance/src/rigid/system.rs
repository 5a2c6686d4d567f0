//! Bodies in free flight as an event-driven system.
//!
//! Three kinds of events: a body leaves its box, a pair's search goes on, two bodies come into contact. Between events
//! nothing is computed; an event touches only its bodies and the pairs near them.

use super::boxes::Room;
use super::error::{AdvanceError, Between};
use super::flyer::{FlightLaw, Flyer};
use super::impacts::{ImpactReport, ImpactWork};
use super::pairs::{Pair, PairId, Pairs, Prediction};
use crate::queue::{EventQueue, SourceId};
use crate::system::EventDriven;
use crate::time::Time;
use halfgap_collision::{
    Body, BodyId, BodyState, BroadPhase, Flight, MovingShape, Search, SearchSettings, Tolerances,
    disc_contact, search_step,
};
use halfgap_contact::{ImpactLaw, ImpactOrder};

/// A pair may collide so many times without time going by before the advance is stuck.
const MOST_REPEATS: u32 = 100;
/// One search looks at most this far ahead [s], then goes on: bounds over the span stay finite.
const LONGEST_SPAN: f64 = 1e6;
/// Two contacts are at one time when they differ by at most this many machine epsilons of the clock.
const SAME_TIME: f64 = 4.0;

/// How contacts are judged and impacts resolved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidSettings {
    /// The thresholds of touching.
    pub tolerances: Tolerances,
    /// The impact law.
    pub law: ImpactLaw,
    /// The order in which serial laws take the rows.
    pub order: ImpactOrder,
    /// False if bodies pass through each other.
    pub collisions: bool,
    /// Limits of the search for contacts.
    pub search: SearchSettings,
}

/// What was done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// Segments started.
    pub segments: u64,
    /// Events handled, of all kinds.
    pub events: u64,
    /// Impacts resolved.
    pub impacts: u64,
    /// Segments cut short by an impact.
    pub backups: u64,
    /// Complementarity problems solved.
    pub contact_solves: u64,
    /// Smallest gap [m] seen at an impact.
    pub smallest_gap: Option<f64>,
}

impl Counts {
    pub(crate) fn note_gap(&mut self, gap: f64) {
        self.smallest_gap = Some(self.smallest_gap.map_or(gap, |least| least.min(gap)));
    }
}

/// Rigid bodies in free flight with impacts.
#[derive(Clone, Debug)]
pub struct RigidSystem {
    pub(crate) settings: RigidSettings,
    pub(crate) counts: Counts,
    pub(crate) pairs: Pairs,
    flyers: Vec<Flyer>,
    rooms: Vec<Room>,
    /// Until when each body surely stays in its box; `None` for ever.
    stays: Vec<Option<Time>>,
    broad: BroadPhase,
    /// Pairs that never collide, the lesser id first, sorted.
    excluded: Vec<(BodyId, BodyId)>,
    queue: EventQueue,
    now: Time,
    work: ImpactWork,
    last_impact: ImpactReport,
    touched: Vec<PairId>,
    neighbours: Vec<BodyId>,
}

impl RigidSystem {
    /// The system of the given bodies, laws and states at a time; pairs in `excluded` pass through each other.
    #[must_use]
    pub fn new(
        bodies: Vec<(Body, FlightLaw, BodyState)>,
        excluded: &[(BodyId, BodyId)],
        settings: RigidSettings,
        start: Time,
    ) -> Self {
        let flyers: Vec<Flyer> =
            bodies.into_iter().map(|(body, law, state)| Flyer::new(body, law, state, start)).collect();
        let skin = settings.tolerances.distance_tol();
        let rooms = flyers.iter().map(|flyer| Room::new(flyer.body().shape.reach(), skin)).collect();
        let mut excluded: Vec<_> = excluded.iter().map(|&(a, b)| (a.min(b), a.max(b))).collect();
        excluded.sort_unstable();
        let mut system = Self {
            settings,
            counts: Counts { segments: flyers.len() as u64, ..Counts::default() },
            pairs: Pairs::new(flyers.iter().map(|flyer| flyer.body().is_fixed()).collect()),
            stays: vec![None; flyers.len()],
            flyers,
            rooms,
            broad: BroadPhase::new(),
            excluded,
            queue: EventQueue::new(),
            now: start,
            work: ImpactWork::default(),
            last_impact: ImpactReport::default(),
            touched: Vec::new(),
            neighbours: Vec::new(),
        };
        if settings.collisions {
            system.set_up();
        }
        system
    }

    /// How many bodies there are.
    #[must_use]
    pub fn body_count(&self) -> usize {
        self.flyers.len()
    }

    /// A body with its segment.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    pub fn flyer(&self, body: BodyId) -> &Flyer {
        &self.flyers[body.index()]
    }

    /// What was done so far.
    #[must_use]
    pub fn counts(&self) -> &Counts {
        &self.counts
    }

    /// How contacts are judged.
    #[must_use]
    pub fn settings(&self) -> &RigidSettings {
        &self.settings
    }

    /// The last impact.
    #[must_use]
    pub fn last_impact(&self) -> &ImpactReport {
        &self.last_impact
    }

    /// Time of the last event handled.
    #[must_use]
    pub fn now(&self) -> Time {
        self.now
    }

    pub(crate) fn flyer_mut(&mut self, body: BodyId) -> &mut Flyer {
        self.counts.segments += 1;
        self.counts.backups += 1;
        &mut self.flyers[body.index()]
    }

    fn bodies(&self) -> impl Iterator<Item = BodyId> + use<> {
        (0..u32::try_from(self.flyers.len()).unwrap_or(u32::MAX)).map(BodyId)
    }

    fn set_up(&mut self) {
        for body in self.bodies() {
            self.place_box(body);
        }
        let movable: Vec<BodyId> =
            self.bodies().filter(|&body| !self.flyer(body).body().is_fixed()).collect();
        for &body in &movable {
            self.find_neighbours(body);
        }
        // Each pair once, when all are known: a prediction taken up again would go on from the contact that it found.
        self.predict_all_of(&movable, true);
    }

    fn place_box(&mut self, body: BodyId) {
        let (flyer, room) = (&self.flyers[body.index()], &self.rooms[body.index()]);
        let fat_box = room.fat_box(flyer, self.now);
        self.broad.set(body, fat_box);
        self.renew_stay(body);
    }

    /// Predicts anew when the body leaves its box.
    fn renew_stay(&mut self, body: BodyId) {
        let (flyer, room) = (&self.flyers[body.index()], &self.rooms[body.index()]);
        let stay = self.broad.bounds(body).and_then(|fat_box| room.stays_until(flyer, fat_box, self.now));
        self.stays[body.index()] = stay;
        match stay {
            Some(time) => self.queue.set(SourceId(body.0), time),
            None => self.queue.clear(SourceId(body.0)),
        }
    }

    /// Pairs the body with all whose boxes overlap its own, and with no others.
    fn find_neighbours(&mut self, body: BodyId) {
        let Some(fat_box) = self.broad.bounds(body).copied() else { return };
        let mut near = std::mem::take(&mut self.neighbours);
        near.clear();
        self.broad.visit_overlapping(&fat_box, &mut |other| near.push(other));
        near.retain(|&other| other != body && self.may_collide(body, other));
        near.sort_unstable();
        self.touched.clear();
        self.touched.extend_from_slice(self.pairs.of_body(body));
        for index in 0..self.touched.len() {
            let pair = self.touched[index];
            let [a, b] = self.pairs.get(pair).bodies;
            let other = if a == body { b } else { a };
            if near.binary_search(&other).is_err() {
                self.queue.clear(self.pair_source(pair));
                self.pairs.remove(pair);
            }
        }
        for &other in &near {
            if self.pairs.between(body, other).is_none() {
                self.pairs.add(body, other, self.now);
            }
        }
        self.rooms[body.index()].adapt(near.len());
        self.neighbours = near;
    }

    fn may_collide(&self, a: BodyId, b: BodyId) -> bool {
        let both_fixed = self.flyer(a).body().is_fixed() && self.flyer(b).body().is_fixed();
        !both_fixed && self.excluded.binary_search(&(a.min(b), a.max(b))).is_err()
    }

    fn pair_source(&self, pair: PairId) -> SourceId {
        SourceId(u32::try_from(self.flyers.len()).unwrap_or(u32::MAX).saturating_add(pair.0))
    }

    /// Searches on for the pair's next contact, from where it is known to be clear, while both stay in their boxes.
    fn predict(&mut self, pair: PairId) {
        let Pair { bodies: [a, b], clear, .. } = *self.pairs.get(pair);
        let until = match (self.stays[a.index()], self.stays[b.index()]) {
            (Some(a), Some(b)) => a.min(b),
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) => Time::NEVER,
        };
        let from = clear.max(self.now);
        let prediction = if until <= from {
            Prediction::Quiet
        } else {
            let span = until.since(from).min(LONGEST_SPAN);
            match self.search([a, b], from, span) {
                Search::Contact(contact) => Prediction::Contact(from.plus(contact.time)),
                Search::NoneBefore(time) if time >= span && span < LONGEST_SPAN => Prediction::Quiet,
                Search::NoneBefore(time) => Prediction::SearchOn(from.plus(time)),
            }
        };
        let source = self.pair_source(pair);
        let entry = self.pairs.get_mut(pair);
        entry.prediction = prediction;
        match prediction {
            Prediction::Contact(time) | Prediction::SearchOn(time) => {
                entry.clear = time;
                self.queue.set(source, time);
            }
            Prediction::Quiet => {
                entry.clear = until.max(from);
                self.queue.clear(source);
            }
        }
    }

    /// Searches for a contact of two bodies in the given span [s] from a time on.
    fn search(&self, [a, b]: [BodyId; 2], from: Time, span: f64) -> Search {
        let (flyer_a, flyer_b) = (self.flyer(a), self.flyer(b));
        let tolerances = &self.settings.tolerances;
        if let (Some(radius_a), Some(radius_b)) = (flyer_a.disc(), flyer_b.disc()) {
            let side_a = (flyer_a.flight(), flyer_a.offset(from), radius_a);
            let side_b = (flyer_b.flight(), flyer_b.offset(from), radius_b);
            if let Some(found) = disc_contact(side_a, side_b, span, tolerances) {
                return found;
            }
        }
        let (side_a, side_b) = (moving_shape(flyer_a, from), moving_shape(flyer_b, from));
        search_step(&side_a, &side_b, 0.0, span, tolerances, &self.settings.search)
    }

    fn leave_box(&mut self, body: BodyId) {
        self.place_box(body);
        self.find_neighbours(body);
        self.predict_all_of(&[body], false);
    }

    /// Predicts the pairs of some bodies: all of them if their motions changed, else those not searched far enough.
    fn predict_all_of(&mut self, bodies: &[BodyId], changed: bool) {
        let mut touched = std::mem::take(&mut self.touched);
        touched.clear();
        touched.extend(bodies.iter().flat_map(|&body| self.pairs.of_body(body)));
        touched.sort_unstable();
        touched.dedup();
        for &pair in &touched {
            if changed {
                self.pairs.get_mut(pair).clear = self.now;
                self.predict(pair);
            } else if self.pairs.get(pair).prediction == Prediction::Quiet {
                self.predict(pair);
            }
        }
        self.touched = touched;
    }

    fn handle_contact(&mut self, pair: PairId) -> Result<Option<Time>, AdvanceError> {
        let bodies = self.pairs.get(pair).bodies;
        self.note_repeat(pair)?;
        let mut work = std::mem::take(&mut self.work);
        let mut report = std::mem::take(&mut self.last_impact);
        let outcome = self.resolve_impact(&mut work, &mut report, bodies, self.now);
        self.last_impact = report;
        if outcome.is_ok() {
            self.counts.impacts += 1;
            for &body in work.group() {
                self.renew_stay(body);
            }
            self.predict_all_of(work.group(), true);
        }
        self.work = work;
        Ok(outcome?.then_some(self.now))
    }

    fn note_repeat(&mut self, pair: PairId) -> Result<(), AdvanceError> {
        let now = self.now;
        let entry = self.pairs.get_mut(pair);
        let same_time = SAME_TIME * f64::EPSILON * now.seconds().abs();
        let is_repeat = entry.last_contact.is_some_and(|last| now.since(last) <= same_time);
        entry.repeats = if is_repeat { entry.repeats + 1 } else { 0 };
        entry.last_contact = Some(now);
        let (events, [primary, normal]) = (entry.repeats, entry.bodies);
        if events > MOST_REPEATS {
            let between = Between { primary, normal };
            return Err(AdvanceError::Stuck { time: now.seconds(), between, events });
        }
        Ok(())
    }
}

fn moving_shape(flyer: &Flyer, from: Time) -> MovingShape<'_, Flight> {
    MovingShape { shape: &flyer.body().shape, motion: flyer.flight(), offset: flyer.offset(from) }
}

impl EventDriven for RigidSystem {
    /// The time of an impact; [`RigidSystem::last_impact`] tells the rest.
    type Report = Time;
    type Error = AdvanceError;

    fn next_event(&self) -> Option<Time> {
        self.queue.first().map(|entry| entry.time)
    }

    fn handle_next(&mut self) -> Result<Option<Time>, AdvanceError> {
        let Some(event) = self.queue.first() else { return Ok(None) };
        self.counts.events += 1;
        self.now = event.time;
        let bodies = u32::try_from(self.flyers.len()).unwrap_or(u32::MAX);
        let Some(pair) = event.source.0.checked_sub(bodies).map(PairId) else {
            self.leave_box(BodyId(event.source.0));
            return Ok(None);
        };
        if matches!(self.pairs.get(pair).prediction, Prediction::Contact(_)) {
            return self.handle_contact(pair);
        }
        self.predict(pair);
        Ok(None)
    }
}
