//! When ropes go taut.

use crate::rigid::agenda::Source;
use crate::rigid::bodies::path::Path;
use crate::rigid::connectors::store::rope_of;
use crate::rigid::search::dead_point::{dead_point_slack, rope_is_near_dead_point};
use crate::rigid::search::predictions::LONGEST_SPAN;
use crate::rigid::search::searching::Searching;
use crate::rigid::shares::ROUNDS;
use crate::time::Time;
use halfgap_collision::{BodyId, ConnectorId, Flight, Motion, MotionBounds, Rope, RopeSearch, rope_contact};

impl Searching<'_> {
    /// Predicts when the ropes of some bodies go taut.
    pub(crate) fn predict_ropes(&mut self, bodies: &[BodyId]) {
        for &body in bodies {
            for index in 0..self.connectors.of(body).len() {
                let id = self.connectors.of(body)[index];
                let Some(rope) = rope_of(self.connectors.connector(id)) else { continue };
                let taut = self.connectors.states()[id.index()].taut();
                self.connectors.set_slack(id, self.connectors.slack_of(self.assembly, id));
                self.connectors.set_taut(id, self.assembly.now(), taut);
                self.predict_rope(id, &rope);
            }
        }
    }

    /// Continues the search for ropes of some bodies, whose motions are now known for longer.
    pub(crate) fn search_ropes_on(&mut self, bodies: &[BodyId]) {
        for &body in bodies {
            for index in 0..self.connectors.of(body).len() {
                let id = self.connectors.of(body)[index];
                let is_known = self.connectors.states()[id.index()].taut().is_some();
                if let (Some(rope), false) = (rope_of(self.connectors.connector(id)), is_known) {
                    self.predict_rope(id, &rope);
                }
            }
        }
    }

    fn predict_rope(&mut self, id: ConnectorId, rope: &Rope) {
        let source = Source::Connector(id);
        let clear = self.connectors.states()[id.index()].clear();
        self.connectors.set_taut(id, clear, None);
        if self.connectors.states()[id.index()].active() || self.connectors.is_rope_watched(id) {
            self.agenda.clear(source);
            return;
        }
        let [a, b] = self.connectors.connector(id).bodies();
        let known = [a, b].map(|body| self.assembly.segment_end(body));
        let until = known.into_iter().flatten().min().unwrap_or(Time::NEVER);
        let mut from = self.connectors.states()[id.index()].clear().max(self.assembly.now());
        if until <= from {
            self.agenda.clear(source);
            return;
        }
        let mut found = self.search_rope(id, rope, from, until);
        if let Some(slack) = self.slackens(id, from, found) {
            // Once slack it goes taut at its own length.
            self.connectors.set_slack(id, 0.0);
            from = slack;
            found = self.search_rope(id, rope, from, until);
        }
        let (clear, taut) = match found {
            RopeSearch::Taut(wait) => (from.plus(wait), Some(from.plus(wait))),
            RopeSearch::NoneBefore(wait) => (from.plus(wait), None),
        };
        let searches_on = taut.is_none() && clear < until;
        self.connectors.set_taut(id, clear, taut);
        if taut.is_some() || searches_on { self.agenda.set(source, clear) } else { self.agenda.clear(source) }
    }

    /// Searches from a time on for the time at which a rope goes taut, with its present excess length.
    fn search_rope(&self, id: ConnectorId, rope: &Rope, from: Time, until: Time) -> RopeSearch {
        let [a, b] = self.connectors.connector(id).bodies();
        let rope = Rope { length: rope.length + self.connectors.states()[id.index()].slack(), ..*rope };
        let still = Flight::fixed(glam::DVec2::ZERO, 0.0);
        let path = |body: BodyId| {
            if body.is_world() {
                (Path::Flight(&still), 0.0)
            } else {
                (self.assembly.trajectory(body).path(), self.assembly.trajectory(body).offset(from))
            }
        };
        let ((path_a, offset_a), (path_b, offset_b)) = (path(a), path(b));
        // Bounds over much more than the time in which the ends move by the rope's length would say little.
        let wait =
            crossing_time(&rope, &path_a.bounds(offset_a, offset_a), &path_b.bounds(offset_b, offset_b));
        let span = until.since(from).min(wait);
        rope_contact(
            &rope,
            (&path_a, offset_a),
            (&path_b, offset_b),
            0.0,
            span,
            &self.assembly.settings().search,
        )
    }

    /// Time at which a rope with an excess length has clearly gone slack, on the way to the time that a search from a
    /// time on has come to; `None` if it has no excess, or does not slacken.
    fn slackens(&self, id: ConnectorId, from: Time, found: RopeSearch) -> Option<Time> {
        let slack = self.connectors.states()[id.index()].slack();
        if slack <= 0.0 {
            return None;
        }
        let (RopeSearch::Taut(wait) | RopeSearch::NoneBefore(wait)) = found;
        let mut times = (0..ROUNDS).map(|look| from.plus(wait * f64::from(look) / f64::from(ROUNDS)));
        times.find(|&time| {
            let [a, b] =
                self.connectors.connector(id).bodies().map(|body| self.assembly.moving_at(body, time));
            self.connectors.connector(id).measure(0, &a, &b).gap > slack + self.assembly.sink()
        })
    }

    /// True if the event of a connector is a rope that goes taut; otherwise the search goes on.
    pub(crate) fn rope_fires(&mut self, id: ConnectorId) -> bool {
        let now = self.assembly.now();
        let is_taut = self.connectors.states()[id.index()].taut().is_some();
        let slack = dead_point_slack(self.assembly);
        if is_taut
            && self.connectors.states()[id.index()].slack() < slack
            && rope_is_near_dead_point(self.assembly, self.connectors, id)
        {
            self.connectors.set_slack(id, slack);
        } else if is_taut {
            self.connectors.note_taut(id, now);
            return true;
        }
        if let Some(rope) = rope_of(self.connectors.connector(id)) {
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
