//! The region of an event: the bodies that touch each other around some seeds, with the groups that they belong to, and
//! the records of all places where they touch.

use super::cause::Cause;
use crate::rigid::motion::lane::LaneKind;
use crate::rigid::search::pairs::Link;
use crate::rigid::step::rows::{HeldRow, RowSource};
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{
    BodyId, Collision, FeatureRule, Moment, Zone, detect_features_of_pair, merge_collisions, record_features,
};
use halfgap_contact::{Impact, InverseInertia, Problem, ProblemBody, Row};
use halfgap_geometry::FeatureId;

/// A pair of features that touches, the lesser body first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Touch {
    pub(crate) bodies: [BodyId; 2],
    pub(crate) features: [FeatureId; 2],
}

/// Bodies and records of an event. Buffers are kept from one event to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Region {
    /// The movable bodies, in the order in which they were found.
    pub(crate) bodies: Vec<BodyId>,
    /// Records of all places where they touch, each once.
    pub(crate) records: Vec<Collision>,
    /// All pairs of features that touch.
    pub(crate) touches: Vec<Touch>,
    /// Gap [m] and rate [m/s] of each pair in `touches` after the event.
    pub(crate) motions: Vec<(f64, f64)>,
    /// Leaders of the groups of these bodies.
    pub(crate) groups: Vec<BodyId>,
    /// Cause of the event.
    pub(crate) cause: Cause,
    /// True if the event is one too many in a short time.
    pub(crate) in_storm: bool,
    /// True if steps have become so short that contacts that count as resting seem to take turns.
    pub(crate) is_hasty: bool,
    /// True if the rows that would be held were found to be unsound: contacts that nearly depend on others are spared,
    /// and all are held where they are.
    pub(crate) is_unsound: bool,
    fresh: Vec<Collision>,
    /// Change of the velocities (x, y, angle) of each body by an impact [m/s, m/s, rad/s].
    pub(crate) changes: Vec<[f64; 3]>,
    /// Whether an impulse acts on each body.
    pub(crate) struck: Vec<bool>,
    /// Records that were left out because they jam.
    pub(super) left_out: Vec<Collision>,
    /// Stamp and place in `bodies` of each body, valid where the stamp is the present one.
    places: Vec<(u32, u32)>,
    stamp: u32,
}

impl Region {
    pub(crate) fn clear(&mut self, body_count: usize) {
        self.bodies.clear();
        self.records.clear();
        self.touches.clear();
        self.motions.clear();
        self.groups.clear();
        self.is_unsound = false;
        self.places.resize(body_count, (0, 0));
        self.stamp = self.stamp.wrapping_add(1);
        if self.stamp == 0 {
            self.places.fill((0, 0));
            self.stamp = 1;
        }
    }

    /// Place of a body in the region; `None` for bodies outside it and those that cannot move.
    pub(crate) fn place(&self, body: BodyId) -> Option<usize> {
        let &(stamp, place) = self.places.get(body.index())?;
        (stamp == self.stamp).then_some(place as usize)
    }

    /// Sums the changes of the bodies' velocities by an impact, and notes which bodies an impulse acts on.
    pub(super) fn sum_changes(&mut self, impact: &Impact) {
        let (mut changes, mut struck) = (std::mem::take(&mut self.changes), std::mem::take(&mut self.struck));
        changes.clear();
        changes.resize(self.bodies.len(), [0.0; 3]);
        struck.clear();
        struck.resize(self.bodies.len(), false);
        for (row, &impulse) in impact.rows().iter().zip(impact.impulses()) {
            for (side, place) in row.bodies.iter().map(|&body| self.place(body)).enumerate() {
                let Some(place) = place else { continue };
                struck[place] |= impulse != 0.0;
                for (change, response) in changes[place].iter_mut().zip(&row.response[3 * side..]) {
                    *change += response * impulse;
                }
            }
        }
        (self.changes, self.struck) = (changes, struck);
    }

    /// Row of a record in a problem of the region's bodies, in their order; `None` if neither of its bodies moves.
    pub(crate) fn row_of(&self, record: &Collision, offset: f64) -> Option<Row> {
        let place = |body: BodyId| u32::try_from(self.place(body)?).ok().map(ProblemBody);
        let sides = record.bodies().map(place);
        let row = Row::between(sides, &record.motion.kinematics.jacobian, offset)?;
        Some(if record.parties.bilateral { row.bilateral() } else { row })
    }

    /// Fills a problem with the region's bodies, without rows.
    pub(crate) fn begin(&self, problem: &mut Problem, inertia: impl Fn(BodyId) -> InverseInertia) {
        problem.clear();
        for &body in &self.bodies {
            problem.add_body(inertia(body)).expect("inertias were checked when the body was made");
        }
    }

    pub(crate) fn add(&mut self, body: BodyId) {
        if self.place(body).is_none() {
            let place = u32::try_from(self.bodies.len()).unwrap_or(u32::MAX);
            self.places[body.index()] = (self.stamp, place);
            self.bodies.push(body);
        }
    }
}

impl RigidSystem {
    /// Collects the region around some bodies at a time, along their present segments.
    pub(crate) fn collect_region(&self, region: &mut Region, seeds: &[BodyId], time: Time) {
        region.clear(self.body_count());
        for &seed in seeds.iter().filter(|seed| self.is_movable(**seed)) {
            region.add(seed);
        }
        let mut next = 0;
        while next < region.bodies.len() {
            let body = region.bodies[next];
            if let Some(group) = self.group_of(body)
                && !region.groups.contains(&group.leader())
            {
                region.groups.push(group.leader());
                for &mate in &group.bodies {
                    region.add(mate);
                }
            }
            self.collect_connectors(region, next, time);
            self.collect_touches(region, next, time);
            next += 1;
        }
    }

    /// Adds the records of a body of the region with all bodies that it touches, and these bodies.
    fn collect_touches(&self, region: &mut Region, place: usize, time: Time) {
        let body = region.bodies[place];
        let moving = self.flyer(body).moving_at(time);
        for &Link { other, .. } in self.pairs.of_body(body) {
            // A pair within the region was looked at with its first body.
            if region.place(other).is_some_and(|earlier| earlier < place) {
                continue;
            }
            let lanes = [&self.search.lanes[body.index()], &self.search.lanes[other.index()]];
            let reach = lanes[0].reach + lanes[1].reach + self.settings.tolerances.distance_tol();
            let offset = moving.pose.position - self.position_of(other, time);
            // A contact that has fired may be farther apart by rounding.
            let has_fired = region.cause.fired().is_some_and(|fired| fired.bodies == sorted(body, other));
            if offset.length_squared() > reach * reach && !has_fired {
                continue;
            }
            let (flyer, other_flyer) = (self.flyer(body), self.flyer(other));
            let other_moving = other_flyer.moving_at(time);
            // The lesser body first: records do not depend on which of the two was found first.
            let mut moments = [
                Moment { id: body, body: flyer.body(), moving },
                Moment { id: other, body: other_flyer.body(), moving: other_moving },
            ];
            if other < body {
                moments.swap(0, 1);
            }
            if self.touch(region, &moments, time) && self.is_movable(other) {
                region.add(other);
            }
        }
    }

    /// Position [m] of a body's centre of mass at a time of its present segment.
    fn position_of(&self, body: BodyId, time: Time) -> DVec2 {
        let lane = &self.search.lanes[body.index()];
        let flown = || self.flyer(body).moving_at(time).pose.position;
        if lane.kind == LaneKind::Other {
            return flown();
        }
        debug_assert_eq!(lane.position_at(time), flown(), "lanes are renewed with their bodies");
        lane.position_at(time)
    }

    /// Adds the records of two bodies that take part in an event; true if there are any.
    fn touch(&self, region: &mut Region, [first, second]: &[Moment<'_>; 2], time: Time) -> bool {
        let tolerances = &self.settings.tolerances;
        let mut fresh = std::mem::take(&mut region.fresh);
        fresh.clear();
        let bodies = [first.id, second.id];
        let depth = tolerances.distance_tol().max(self.may_have_sunk_by(bodies));
        detect_features_of_pair(first, second, tolerances, depth, time.seconds(), &mut fresh);
        let takes_over = region.cause.run_off().is_some_and(|run_off| run_off.bodies == bodies);
        fresh.retain(|record| {
            self.counts_as_touching(record, bodies, region.cause == Cause::Start, takes_over)
                && (!(self.is_passed_over(record) || self.is_grazing(record)) || self.is_carried(record))
        });
        // A contact that has fired takes part, and one that is put back at a tick, though it may have been moved out of
        // its zone or have turned a little since: where a block lies flat, putting back one of its corners would sink
        // the other.
        let moved = self.ticks.moved;
        let fired = region.cause.fired();
        let waiting = if region.cause == Cause::Tick { self.ticks.waiting_of(bodies) } else { &[] };
        for known in fired.iter().filter(|fired| fired.bodies == bodies).chain(waiting) {
            if !fresh.iter().any(|record| touch_of(record, bodies) == Some(*known)) {
                let record = record_features([first, second], known.features, tolerances, time.seconds());
                let farthest = tolerances.distance_tol() + 2.0 * moved;
                let is_near = |record: &Collision| record.geometry.distance <= farthest;
                fresh.extend(record.filter(|record| fired == Some(*known) || is_near(record)));
            }
        }
        region.touches.extend(fresh.iter().filter_map(|record| touch_of(record, [first.id, second.id])));
        if let Some(run_off) = region.cause.run_off() {
            fresh.retain(|record| touch_of(record, [first.id, second.id]) != Some(run_off));
        }
        if fresh.len() > 1 {
            merge_collisions(&mut fresh);
        }
        region.records.append(&mut fresh);
        region.fresh = fresh;
        let last = region.records.last();
        last.is_some_and(|record| record.involves_body(first.id) && record.involves_body(second.id))
    }

    /// True if a record takes part in an event: a contact at its target or nearer, one that closes within the target
    /// zone, one that is held already, or touches at the start, or takes over from a contact that has run off its
    /// features; and one that carries a force, though dense output may have it closing or opening faster than a contact
    /// at rest. Other contacts have room, and fire in their own time if they close.
    fn counts_as_touching(
        &self,
        record: &Collision,
        bodies: [BodyId; 2],
        at_start: bool,
        takes_over: bool,
    ) -> bool {
        let (rest, rate) = (self.rest_speed(), record.motion.normal_velocity);
        if record.zone() == Zone::OutOfRange {
            return false;
        }
        // Corners that pass each other before they come to their target do not meet.
        let passes = rate < -rest && self.passes_by(record);
        record.distance_to_target() <= self.sink()
            || (record.zone() >= Zone::Target && rate < -rest && !passes)
            || (at_start && !passes)
            || (rate.abs() <= rest && (takes_over || self.is_held_contact(record, bodies)))
            || self.is_carried(record)
    }

    /// True if a contact is held now, so that the search skips it.
    fn is_held_contact(&self, record: &Collision, bodies: [BodyId; 2]) -> bool {
        let (Some(touch), Some(pair)) = (touch_of(record, bodies), self.pairs.between(bodies[0], bodies[1]))
        else {
            return false;
        };
        self.pairs.rules(pair).contains(&touch.skipped())
    }

    /// True if a contact is a row of the group of its bodies.
    fn is_carried(&self, record: &Collision) -> bool {
        let Some(touch) = Touch::of(record) else { return false };
        let mut groups = touch.bodies.into_iter().filter_map(|body| self.group_of(body));
        groups.any(|group| group.rows.iter().any(|row| row.touch() == Some(touch)))
    }

    /// `Some(true)` if a record is likely to carry a force, since its contact is held until now; `None` if nothing is
    /// known.
    pub(crate) fn is_likely(&self, record: &Collision) -> Option<bool> {
        let [a, b] = record.bodies();
        self.is_held_contact(record, sorted(a, b)).then_some(true)
    }

    /// Updates the records to the bodies' present motion at a time.
    pub(crate) fn remeasure(&self, region: &mut Region, time: Time) {
        for record in &mut region.records {
            self.remeasure_record(record, time);
        }
    }
}

/// Two bodies, the lesser first.
pub(super) fn sorted(a: BodyId, b: BodyId) -> [BodyId; 2] {
    if a <= b { [a, b] } else { [b, a] }
}

fn touch_of(record: &Collision, bodies: [BodyId; 2]) -> Option<Touch> {
    Touch::of(record).filter(|touch| touch.bodies == bodies)
}

impl HeldRow {
    /// The features of a contact; `None` for a connector's row.
    pub(crate) fn touch(&self) -> Option<Touch> {
        match self.source {
            RowSource::Contact(features) => Some(Touch::new(self.bodies, features)),
            RowSource::Connector(..) => None,
        }
    }
}

impl Touch {
    /// The features of a record, unless it is a connector's.
    pub(crate) fn of(record: &Collision) -> Option<Touch> {
        let (primary, normal) = (&record.parties.primary, &record.parties.normal);
        Some(Touch::new([primary.body, normal.body], [primary.feature()?, normal.feature()?]))
    }

    /// The features of a contact, whichever of its two bodies is named first.
    pub(crate) fn new(bodies: [BodyId; 2], features: [FeatureId; 2]) -> Self {
        if bodies[0] <= bodies[1] {
            Self { bodies, features }
        } else {
            Self { bodies: [bodies[1], bodies[0]], features: [features[1], features[0]] }
        }
    }

    /// Rule by which the search skips the features.
    pub(crate) fn skipped(&self) -> FeatureRule {
        FeatureRule { features: self.features, target: None }
    }

    /// Rule by which the features fire only at a gap [m].
    pub(crate) fn lowered_to(&self, gap: f64) -> FeatureRule {
        FeatureRule { features: self.features, target: Some(gap) }
    }
}
