//! Bodies that would pass through others within a step: what is not held by a row stops where it first touches, and its own time with
//! it; it goes on from there in the next step.
//!
//! *Invariant*: on their straight ways through the step no two bodies come to touch by features that have no row, nor sink by those that
//! have.

use crate::stepping::bodies::{Bodies, farthest};
use crate::stepping::pairs::{Pair, Pairs};
use crate::stepping::ties::Ties;
use glam::DVec2;
use halfgap_collision::{
    BodyId, BodyState, FeatureRule, Flight, MovingShape, PairSearch, Search, SearchSettings, Tolerances,
};

/// Way of a pair in a step, as a fraction of the lesser thickness [-], up to which it passes through nothing: what it comes to overlap
/// is found in the next step.
pub(super) const FAST: f64 = 0.25;

/// Largest number of searches of one pair in a step: it is stopped where the last one ended.
const MOST_SEARCHES: u32 = 64;

/// What finding out works with.
#[derive(Clone, Debug, Default)]
pub(super) struct Passing {
    /// Time [s] after the start of the step at which each body stops, and its way [m] in a whole step.
    stops: Vec<f64>,
    ways: Vec<f64>,
    /// Times at which pairs first touch.
    meetings: Vec<Meeting>,
    rules: Vec<FeatureRule>,
    /// Bodies that a meeting stops: those that meet, and what is tied to them.
    stopped: Vec<u32>,
    /// Pairs whose contacts are to be found anew.
    renewed: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Meeting {
    time: f64,
    bodies: [BodyId; 2],
    pair: u32,
}

impl Passing {
    /// Stops bodies that would pass through others in a step of a length `span` [s].
    pub(super) fn stop(
        &mut self,
        bodies: &mut Bodies,
        (pairs, ties): (&mut Pairs, &Ties),
        tolerances: &Tolerances,
        (span, fall): (f64, f64),
    ) {
        self.ways.clear();
        self.ways.extend(
            bodies
                .natures
                .iter()
                .zip(&bodies.courses)
                .map(|(nature, course)| span * farthest(nature.reach, course.middle)),
        );
        let least = FAST * bodies.least_thickness;
        if self.ways.iter().all(|&way| way <= least) {
            return;
        }
        for place in (0..bodies.count()).filter(|&place| self.ways[place] > 0.0) {
            let motion = bodies.courses[place].middle.map(|velocity| span * velocity);
            pairs.extend(bodies, BodyId::from_index(place), motion, span * fall);
        }
        self.stops.clear();
        self.stops.resize(bodies.count(), span);
        self.meetings.clear();
        self.renewed.clear();
        for (index, pair) in pairs.all().iter().enumerate() {
            self.meet(bodies, (index as u32, pair), tolerances, (0.0, span));
        }
        while let Some(Meeting { time, bodies: met, pair }) = self.next_meeting() {
            self.renewed.push(pair);
            self.stopped.clear();
            for body in met {
                self.stop_at(bodies, body, time, span);
            }
            let mut next = 0;
            while let Some(&body) = self.stopped.get(next) {
                next += 1;
                let body = BodyId(body);
                for connector in
                    ties.all.iter().filter(|connector| connector.all_bodies().any(|one| one == body))
                {
                    connector.all_bodies().for_each(|other| self.stop_at(bodies, other, time, span));
                }
                self.meetings.retain(|meeting| !meeting.bodies.contains(&body));
                for &pair in pairs.of(body) {
                    self.meet(bodies, (pair, &pairs.all()[pair as usize]), tolerances, (time, span));
                }
            }
        }
        // They touch by other features than those that were near.
        for &pair in &self.renewed {
            pairs.all_mut()[pair as usize].known_until = f64::NEG_INFINITY;
        }
        for (place, &stop) in self.stops.iter().enumerate() {
            if stop < span {
                bodies.courses[place].delay = 1.0 - stop / span;
            }
        }
    }

    /// Takes the earliest meeting.
    fn next_meeting(&mut self) -> Option<Meeting> {
        let earliest = (0..self.meetings.len())
            .min_by(|&i, &j| self.meetings[i].time.total_cmp(&self.meetings[j].time))?;
        Some(self.meetings.swap_remove(earliest))
    }

    /// Stops a body unless it has been stopped before.
    fn stop_at(&mut self, bodies: &Bodies, body: BodyId, time: f64, span: f64) {
        if !bodies.is_fixed(body) && self.stops[body.index()] >= span {
            self.stops[body.index()] = time;
            self.stopped.push(body.0);
        }
    }

    /// Notes when a pair first touches after a time `from` [s], by features that have no row, on the ways that its bodies go now.
    fn meet(
        &mut self,
        bodies: &Bodies,
        (index, pair): (u32, &Pair),
        tolerances: &Tolerances,
        (from, span): (f64, f64),
    ) {
        let places = pair.bodies.map(BodyId::index);
        let is_still = |place: usize| self.stops[place] <= from || self.ways[place] == 0.0;
        let velocities =
            places.map(|place| if is_still(place) { [0.0; 3] } else { bodies.courses[place].middle });
        let way = bodies.way_past(places, velocities, span).min(self.ways[places[0]] + self.ways[places[1]]);
        let slow = FAST * bodies.thinner(places);
        if way <= slow {
            return;
        }
        let are_discs = places.iter().all(|&place| bodies.natures[place].body.shape.features().len() == 1);
        if are_discs && pair.contacts.iter().any(|contact| contact.is_listed) {
            // The distance of two points that go straight is convex: it is never less than the row has it.
            return;
        }
        // What has a row may sink a little, and no more than that: rows know nothing of what turns far.
        let sunk = pair.deepest + slow;
        self.rules.clear();
        self.rules.extend(
            pair.contacts
                .iter()
                .filter(|contact| contact.is_listed)
                .map(|contact| FeatureRule { features: contact.features, target: Some(-sunk) }),
        );
        let flights = places.map(|place| {
            let course = &bodies.courses[place];
            if is_still(place) {
                let [x, y, turn] = course.middle.map(|velocity| self.stops[place].min(from) * velocity);
                return Flight::fixed(course.position + DVec2::new(x, y), course.angle + turn);
            }
            let [x, y, angular_velocity] = course.middle;
            let start = BodyState {
                position: course.position,
                angle: course.angle,
                velocity: DVec2::new(x, y),
                angular_velocity,
            };
            Flight::new(start, DVec2::ZERO, 0.0, 0.0)
        });
        let [a, b] = [0, 1].map(|side: usize| MovingShape {
            shape: &bodies.natures[places[side]].body.shape,
            motion: &flights[side],
            offset: 0.0,
        });
        // Where a corner with a row has sunk, another one may turn out the deeper.
        let settings = SearchSettings { depth: sunk, ..SearchSettings::STANDARD };
        let search = PairSearch { a: &a, b: &b, tolerances, settings: &settings, rules: &self.rules };
        let mut time = from;
        for _ in 0..MOST_SEARCHES {
            match search.step(time, span) {
                Search::NoneBefore(clear) if clear >= span => return,
                Search::NoneBefore(clear) => time = clear,
                Search::Contact(contact) => {
                    time = contact.time;
                    break;
                }
            }
        }
        if !self.rules.is_empty() {
            // It touches and must get on: by as little as passes through nothing.
            time = time.max(from + span * slow / way);
        }
        if time < span {
            self.meetings.push(Meeting { time, bodies: pair.bodies, pair: index });
        }
    }
}
