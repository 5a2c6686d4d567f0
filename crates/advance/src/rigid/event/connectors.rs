//! Connectors in events: their records in a region, and when ropes go taut.

use super::region::Region;
use crate::rigid::by_body::ByBody;
use crate::rigid::held::settling::Settling;
use crate::rigid::limits::repeats::is_same_time;
use crate::rigid::motion::path::Path;
use crate::rigid::search::predictions::LONGEST_SPAN;
use crate::rigid::sources::Source;
use crate::rigid::step::group::Stop;
use crate::rigid::step::rows::RowSource;
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use halfgap_collision::{
    BodyId, Collision, Connector, ConnectorId, ConnectorKind, ConnectorSample, Detector, Flight, Motion,
    MotionBounds, Moving, RailHint, Rope, RopeSearch, rope_contact,
};

/// Number of times at which a rope is tested for having gone slack before it is taut again.
const LOOKS: u32 = 8;

/// All connectors with their states, and lists of them by body.
#[derive(Clone, Debug)]
pub(crate) struct Connectors {
    pub(crate) all: Vec<Connector>,
    /// Connectors of each body.
    of: ByBody<ConnectorId>,
    pub(crate) states: Vec<ConnectorState>,
}

impl Connectors {
    /// Lists connectors between a number of bodies.
    pub(crate) fn new(all: Vec<Connector>, body_count: usize) -> Self {
        let ids = (0..).map(ConnectorId);
        Self {
            of: ByBody::new(body_count, ids.zip(all.iter().map(Connector::bodies))),
            states: vec![ConnectorState::default(); all.len()],
            all,
        }
    }

    /// Connectors that are tied to a body.
    pub(crate) fn of(&self, body: BodyId) -> &[ConnectorId] {
        self.of.of(body)
    }
}

/// State of a connector.
#[derive(Clone, Debug, Default)]
pub(crate) struct ConnectorState {
    /// Place of its point on a rail.
    pub(crate) hint: Option<RailHint>,
    /// Sides, before and after, of the corner of a rail that the point is in; `None` if it is in none.
    pub(super) corner: Option<[RailHint; 2]>,
    /// Time before which a rope does not go taut.
    clear: Time,
    /// Time at which a rope goes taut; `None` if it does not while the motions are known, or the search has not come so
    /// far.
    taut: Option<Time>,
    /// Excess length [m] that a rope is given while it is at its length and does not tighten: it goes taut at the sum
    /// of both.
    slack: f64,
    /// True if it is unilateral and held: its row then takes part in events at any gap.
    held: bool,
    /// Time at which the rope last went taut, or the stop was met.
    last_taut: Option<Time>,
    /// Number of times that it did so before without time going by.
    repeats: u32,
}

impl ConnectorState {
    /// Hint for the place of a row on the rail: that of a side, if the point is in a corner.
    pub(crate) fn hint_of(&self, row: usize) -> Option<&RailHint> {
        match &self.corner {
            Some(sides) => sides.get(row),
            None => self.hint.as_ref(),
        }
    }

    /// Number of earlier times that the rope has gone taut, or the stop was met, at the present time: a rope then lies
    /// nearer to its length than the search can tell.
    pub(super) fn repeats_at(&self, now: Time) -> u32 {
        if self.last_taut.is_some_and(|last| is_same_time(last, now)) { self.repeats } else { 0 }
    }

    pub(super) fn note_taut(&mut self, now: Time) {
        let is_repeat = self.last_taut.is_some_and(|last| is_same_time(last, now));
        self.repeats = if is_repeat { self.repeats + 1 } else { 0 };
        self.last_taut = Some(now);
    }
}

impl RigidSystem {
    /// True if unilateral rows of a connector were held until now.
    pub(super) fn is_held_unilaterally(&self, id: ConnectorId) -> bool {
        let state = &self.connectors.states[id.index()];
        state.held || state.corner.is_some()
    }

    pub(crate) fn connector(&self, id: ConnectorId) -> &Connector {
        &self.connectors.all[id.index()]
    }

    /// Adds the records of the connectors of a body of the region, and the bodies at their other ends.
    pub(crate) fn collect_connectors(&self, region: &mut Region, place: usize, time: Time) {
        let body = region.bodies[place];
        for &id in self.connectors.of(body) {
            let connector = self.connector(id);
            let [a, b] = connector.bodies();
            let other = if a == body { b } else { a };
            if region.place(other).is_some_and(|earlier| earlier < place) {
                continue;
            }
            let moving = [a, b].map(|body| self.moving_at(body, time));
            for row in 0..self.row_count(id) {
                let record = self.connector_record(id, row, &moving, time);
                let is_held = connector.is_bilateral() || self.is_held_unilaterally(id);
                if !is_held && record.geometry.distance > self.settings.tolerances.accuracy {
                    continue;
                }
                // A row at rest is held, or may be; a held rope does not graze, though dense output may have it
                // closing.
                let closes = !is_held && record.motion.normal_velocity < -self.rest_speed();
                if is_rope(connector) && closes && self.rope_grazes(id) {
                    continue;
                }
                region.records.push(record);
                if self.is_movable(other) {
                    region.add(other);
                }
            }
        }
    }

    /// Number of rows of a connector now: two where the point of a rail is in a corner.
    fn row_count(&self, id: ConnectorId) -> usize {
        self.connectors.states[id.index()].corner.map_or(self.connector(id).row_count(), |sides| sides.len())
    }

    /// Record of a row of a connector whose bodies move as given at a time. The sides of a corner are unilateral and
    /// without elasticity.
    pub(super) fn connector_record(
        &self,
        id: ConnectorId,
        row: usize,
        moving: &[Moving; 2],
        time: Time,
    ) -> Collision {
        let (connector, state) = (self.connector(id), &self.connectors.states[id.index()]);
        let hint = self.hint_at(id, row, time);
        let sample = connector.measure_near(row, &moving[0], &moving[1], hint.as_ref());
        let row = u32::try_from(row).unwrap_or(u32::MAX);
        let (bodies, tolerances) = ([&moving[0], &moving[1]], &self.settings.tolerances);
        let mut record =
            Collision::of_connector(id, row, connector, &sample, bodies, tolerances, time.seconds());
        if state.corner.is_some() {
            record.parties.bilateral = false;
            record.response.elasticity = 0.0;
        }
        record
    }

    /// Measures the record of a connector's row anew, and keeps its response.
    pub(crate) fn remeasure_connector(&self, record: &mut Collision, id: ConnectorId, row: u32, time: Time) {
        let moving = self.connector(id).bodies().map(|body| self.moving_at(body, time));
        let response = record.response;
        *record = self.connector_record(id, row as usize, &moving, time);
        record.response = response;
    }

    /// Measures a row of a connector at a time.
    pub(super) fn measure_connector(&self, id: ConnectorId, row: usize, time: Time) -> ConnectorSample {
        let connector = self.connector(id);
        let [a, b] = connector.bodies().map(|body| self.moving_at(body, time));
        connector.measure_near(row, &a, &b, self.hint_at(id, row, time).as_ref())
    }

    /// Source of the row of a record.
    pub(crate) fn source_of(&self, record: &Collision) -> Option<RowSource> {
        if let Detector::Connector { id, row } = record.parties.detector {
            return Some(RowSource::Connector(id, row as usize));
        }
        Some(RowSource::Contact([record.parties.primary.feature()?, record.parties.normal.feature()?]))
    }

    /// Notes which unilateral connectors of a region are held from now on.
    pub(crate) fn note_held_connectors(&mut self, region: &Region, settling: &Settling) {
        for &body in &region.bodies {
            let Connectors { all, of, states } = &mut self.connectors;
            for &id in of.of(body) {
                if !all[id.index()].is_bilateral() {
                    let mut held = settling.held.iter();
                    let is_held = held.any(|(_, row)| row.source == RowSource::Connector(id, 0));
                    states[id.index()].held = is_held;
                }
            }
        }
    }

    /// Predicts when the ropes of a region's bodies go taut.
    pub(crate) fn predict_ropes(&mut self, region: &Region) {
        let sink = self.sink();
        for &body in &region.bodies {
            for index in 0..self.connectors.of(body).len() {
                let id = self.connectors.of(body)[index];
                let Some(rope) = rope_of(self.connector(id)) else { continue };
                let [a, b] = self.connector(id).bodies().map(|body| self.moving_at(body, self.now));
                let sample = self.connector(id).measure(0, &a, &b);
                let slack = self.slack_of(&sample);
                let state = &mut self.connectors.states[id.index()];
                state.slack = slack + f64::from(state.repeats_at(self.now)) * sink;
                state.clear = self.now;
                self.predict_rope(id, &rope);
            }
        }
    }

    /// Continues the search for ropes of some bodies, whose motions are now known for longer.
    pub(crate) fn search_ropes_on(&mut self, bodies: &[BodyId]) {
        for &body in bodies {
            for index in 0..self.connectors.of(body).len() {
                let id = self.connectors.of(body)[index];
                let is_known = self.connectors.states[id.index()].taut.is_some();
                if let (Some(rope), false) = (rope_of(self.connector(id)), is_known) {
                    self.predict_rope(id, &rope);
                }
            }
        }
    }

    fn predict_rope(&mut self, id: ConnectorId, rope: &Rope) {
        let source = self.source_id(Source::Connector(id));
        self.connectors.states[id.index()].taut = None;
        if self.connectors.states[id.index()].held || self.is_rope_watched(id) {
            self.queue.clear(source);
            return;
        }
        let [a, b] = self.connector(id).bodies();
        let known = [a, b].map(|body| self.segment_end(body));
        let until = known.into_iter().flatten().min().unwrap_or(Time::NEVER);
        let mut from = self.connectors.states[id.index()].clear.max(self.now);
        if until <= from {
            self.queue.clear(source);
            return;
        }
        let mut found = self.search_rope(id, rope, from, until);
        if let Some(slack) = self.slackens(id, from, found) {
            // Once slack it goes taut at its own length.
            self.connectors.states[id.index()].slack = 0.0;
            from = slack;
            found = self.search_rope(id, rope, from, until);
        }
        let (clear, taut) = match found {
            RopeSearch::Taut(wait) => (from.plus(wait), Some(from.plus(wait))),
            RopeSearch::NoneBefore(wait) => (from.plus(wait), None),
        };
        let searches_on = taut.is_none() && clear < until;
        let state = &mut self.connectors.states[id.index()];
        (state.clear, state.taut) = (clear, taut);
        if taut.is_some() || searches_on { self.queue.set(source, clear) } else { self.queue.clear(source) }
    }

    /// Searches from a time on for the time at which a rope goes taut, with its present excess length.
    fn search_rope(&self, id: ConnectorId, rope: &Rope, from: Time, until: Time) -> RopeSearch {
        let [a, b] = self.connector(id).bodies();
        let rope = Rope { length: rope.length + self.connectors.states[id.index()].slack, ..*rope };
        let still = Flight::fixed(glam::DVec2::ZERO, 0.0);
        let path = |body: BodyId| {
            if body.is_world() {
                (Path::Flight(&still), 0.0)
            } else {
                (self.flyer(body).path(), self.flyer(body).offset(from))
            }
        };
        let ((path_a, offset_a), (path_b, offset_b)) = (path(a), path(b));
        // Bounds over much more than the time in which the ends move by the rope's length would say little.
        let wait =
            crossing_time(&rope, &path_a.bounds(offset_a, offset_a), &path_b.bounds(offset_b, offset_b));
        let span = until.since(from).min(wait);
        rope_contact(&rope, (&path_a, offset_a), (&path_b, offset_b), 0.0, span, &self.settings.search)
    }

    /// Time at which a rope with an excess length has clearly gone slack, on the way to the time that a search from a
    /// time on has come to; `None` if it has no excess, or does not slacken.
    fn slackens(&self, id: ConnectorId, from: Time, found: RopeSearch) -> Option<Time> {
        let slack = self.connectors.states[id.index()].slack;
        if slack <= 0.0 {
            return None;
        }
        let (RopeSearch::Taut(wait) | RopeSearch::NoneBefore(wait)) = found;
        let mut times = (0..LOOKS).map(|look| from.plus(wait * f64::from(look) / f64::from(LOOKS)));
        times.find(|&time| {
            let [a, b] = self.connector(id).bodies().map(|body| self.moving_at(body, time));
            self.connector(id).measure(0, &a, &b).gap > slack + self.sink()
        })
    }

    /// A stop as it is watched along a segment that starts now.
    pub(crate) fn stop(&self, id: ConnectorId) -> Stop {
        let connector = self.connector(id);
        let hint = self.hint_at(id, 0, self.now);
        let [a, b] = connector.bodies().map(|body| self.moving_at(body, self.now));
        let sample = connector.measure_near(0, &a, &b, hint.as_ref());
        // A stop of a rail that fires again without time going by lies nearer than the search can tell: it fires again
        // only when its point has sunk further, by more each time.
        let repeats = f64::from(self.connectors.states[id.index()].repeats_at(self.now));
        let lies_beyond = connector.is_stop() && repeats > 0.0;
        let slack = if lies_beyond { repeats * self.sink() + (-sample.gap).max(0.0) } else { 0.0 };
        Stop { id, hint, slack: slack.max(self.slack_of(&sample)), is_noted: false }
    }

    /// Distance [m] by which a unilateral connector may sink from where it was measured before it fires: positive only
    /// where it is touched and does not open.
    fn slack_of(&self, sample: &ConnectorSample) -> f64 {
        let touches = sample.gap <= self.settings.tolerances.accuracy;
        let rests = touches && sample.kinematics.rate <= self.rest_speed();
        if rests { self.sink() + (-sample.gap).max(0.0) } else { 0.0 }
    }

    /// True if the event of a connector is a rope that goes taut; otherwise the search goes on.
    pub(crate) fn rope_fires(&mut self, id: ConnectorId) -> bool {
        let now = self.now;
        let is_taut = self.connectors.states[id.index()].taut.is_some();
        let slack = self.grazing_slack();
        if is_taut && self.connectors.states[id.index()].slack < slack && self.rope_grazes(id) {
            self.connectors.states[id.index()].slack = slack;
        } else if is_taut {
            self.connectors.states[id.index()].note_taut(now);
            return true;
        }
        if let Some(rope) = rope_of(self.connector(id)) {
            self.predict_rope(id, &rope);
        }
        false
    }
}

/// Rough time [s] in which the ends of a rope, as they move now, go as far as the rope is long.
fn crossing_time(rope: &Rope, a: &MotionBounds, b: &MotionBounds) -> f64 {
    let turning = a.angular_speed * rope.point_a.length() + b.angular_speed * rope.point_b.length();
    let speed = a.velocity.largest_difference(&b.velocity) + turning;
    let acceleration = a.acceleration.largest_difference(&b.acceleration);
    let by_speed = if speed > 0.0 { rope.length / speed } else { LONGEST_SPAN };
    let by_acceleration = if acceleration > 0.0 { (rope.length / acceleration).sqrt() } else { LONGEST_SPAN };
    by_speed.min(by_acceleration).min(LONGEST_SPAN)
}

/// True for a rope.
pub(crate) fn is_rope(connector: &Connector) -> bool {
    rope_of(connector).is_some()
}

/// The rope of a connector, if it is one.
fn rope_of(connector: &Connector) -> Option<Rope> {
    match &connector.kind {
        ConnectorKind::Rope { a, b, length } => {
            Some(Rope { point_a: a.point, point_b: b.point, length: *length })
        }
        _ => None,
    }
}
