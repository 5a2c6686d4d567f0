//! Positions on their paths of the points of rails and stops: pieces, joints and laps.
//!
//! A row on a path of pieces stays on the piece of its point until an event at a joint is handled, so that nothing
//! jumps. On a closed path a point just behind a stop and one that has gone a lap since lie at the same place: the
//! distance that was left before the stop tells them apart.

use super::region::Region;
use crate::rigid::step::dynamics::body_state;
use crate::rigid::step::group::Group;
use crate::rigid::step::rows::{HeldRow, RailEnd, RowSource, end_rooms};
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, ConnectorId, ConnectorKind, RailHint};

/// Fraction of a lap, for rounding, by which the way to a stop may fall short of a lap and count as one.
const PASSED: f64 = 1e-12;
/// Number of times at which a point is sought along a segment: it goes round by less than half in between.
const LOOKS: u32 = 8;

impl RigidSystem {
    /// Hint for the place of a connector's row on its rail at a time. It tells the distance left before a stop, for the
    /// point may go round by more than half within the segment of its body.
    pub(crate) fn hint_at(&self, id: ConnectorId, row: usize, time: Time) -> Option<RailHint> {
        let hint = self.connectors.states.get(id.index())?.hint_of(row).copied()?;
        Some(hint.with_before_stop(self.followed(id, time).or(hint.before_stop())))
    }

    /// Distance [m] left before a stop of a closed rail at a time, followed along the segment of the group that watches
    /// the stop; `None` for other connectors and stops.
    fn followed(&self, id: ConnectorId, time: Time) -> Option<f64> {
        let connector = self.connector(id);
        let path = connector.path().filter(|path| connector.is_stop() && path.is_closed())?;
        let (anchor, _) = connector.anchors();
        let group = self.group_of(anchor.body)?;
        let stop = group.stops.iter().find(|stop| stop.id == id && !stop.is_noted)?;
        let (mut hint, span) = (stop.hint?, time.since(group.start));
        for look in 1..=LOOKS {
            let at = group.start.plus(span * f64::from(look) / f64::from(LOOKS));
            let [a, b] = connector.bodies().map(|body| self.moving_at(body, at));
            let left = connector.measure_near(0, &a, &b, Some(&hint)).gap;
            let next = path.hint_near(a.pose.point_to_world(anchor.point), Some(&hint));
            hint = if hint.is_staying() { next.staying() } else { next }.with_before_stop(Some(left));
        }
        hint.before_stop()
    }

    /// Notes the distance left before a stop of a closed rail at a time.
    fn note_left(&mut self, id: ConnectorId, time: Time) {
        let stop = self.connector(id);
        if !(stop.is_stop() && stop.path().is_some_and(|path| path.is_closed())) {
            return;
        }
        let left = self.within_lap(id, self.measure_connector(id, 0, time).gap);
        let state = &mut self.connectors.states[id.index()];
        state.hint = state.hint.map(|hint| hint.with_before_stop(Some(left)));
    }

    /// Notes the distances left before all stops that a group watches, whose segment ends now.
    pub(super) fn note_ways(&mut self, leader: BodyId) {
        let watched = |system: &Self, place: usize| {
            let group = system.groups.by_leader[leader.index()].as_deref()?;
            group.stops.get(place).map(|stop| stop.id)
        };
        for place in 0.. {
            let Some(id) = watched(self, place) else { break };
            self.note_left(id, self.now);
            if let Some(group) = self.groups.by_leader[leader.index()].as_deref_mut() {
                group.stops[place].is_noted = true;
            }
        }
    }

    /// The way [m] to a stop, less a lap if it is a lap or more: the point has then passed the stop from behind, where
    /// the stop does not hold it.
    fn within_lap(&self, id: ConnectorId, left: f64) -> f64 {
        let lap = self.connector(id).path().map_or(f64::INFINITY, |path| path.length());
        if left >= (1.0 - PASSED) * lap { left - lap } else { left }
    }

    /// Notes the places on their rails of the points of a region's connectors.
    pub(crate) fn note_rails(&mut self, region: &Region, time: Time) {
        for &body in &region.bodies {
            for index in 0..self.connectors.of(body).len() {
                let id = self.connectors.of(body)[index];
                let Some(path) = self.connector(id).path() else { continue };
                let state = &self.connectors.states[id.index()];
                if state.corner.is_some() {
                    continue;
                }
                let point = self.point_on_rail(id, time);
                let hint = path.hint_near(point, state.hint.as_ref());
                // A stop may lie on any piece: its hint must follow its point over the joints before it.
                if !self.connector(id).is_stop() {
                    self.set_hint(id, hint.staying());
                } else if !self.is_led(id) {
                    let left = self.connectors.states[id.index()].hint.and_then(|hint| hint.before_stop());
                    self.connectors.states[id.index()].hint = Some(hint.with_before_stop(left));
                }
            }
            for index in 0..self.connectors.of(body).len() {
                self.note_left(self.connectors.of(body)[index], time);
            }
        }
    }

    /// Notes the place of a rail's point, for the rail and its stops: beyond a sharp corner the piece before it seems
    /// as near to these. They are measured along the piece as if it went on: its end is an event.
    pub(super) fn set_hint(&mut self, id: ConnectorId, hint: RailHint) {
        self.connectors.states[id.index()].hint = Some(hint);
        for index in 0..self.connectors.of(self.connector(id).bodies()[0]).len() {
            let stop = self.connectors.of(self.connector(id).bodies()[0])[index];
            if self.connector(stop).is_stop_of(self.connector(id)) {
                let left = self.connectors.states[stop.index()].hint.and_then(|hint| hint.before_stop());
                self.connectors.states[stop.index()].hint = Some(hint.with_before_stop(left));
            }
        }
    }

    /// True for a stop that holds its point on the piece of a hint, where that piece ends in a corner.
    pub(super) fn is_at_end(&self, stop: ConnectorId, hint: &RailHint) -> bool {
        let ConnectorKind::RailStop { path, at, upper, .. } = &self.connector(stop).kind else {
            return false;
        };
        path.ends_in_corner(hint, *upper, *at)
    }

    /// True for a stop whose rail is a connector of the system, too.
    fn is_led(&self, id: ConnectorId) -> bool {
        let stop = self.connector(id);
        let beside = self.connectors.of(stop.bodies()[0]);
        beside.iter().any(|&rail| stop.is_stop_of(self.connector(rail)))
    }

    /// Position [m] of the point of a rail or a stop at a time, in world coordinates.
    pub(super) fn point_on_rail(&self, id: ConnectorId, time: Time) -> DVec2 {
        let (anchor, _) = self.connector(id).anchors();
        self.moving_at(anchor.body, time).pose.point_to_world(anchor.point)
    }

    /// Moves the hint of a rail, whose point comes to a joint of the path, on to the next piece. True if the joint is a
    /// corner, in which the point then is.
    pub(crate) fn pass_knot(&mut self, id: ConnectorId, time: Time) -> bool {
        let Some(path) = self.connector(id).path() else { return false };
        let place =
            path.nearest(self.point_on_rail(id, time), self.connectors.states[id.index()].hint.as_ref());
        let ends = end_rooms(path, &place).into_iter().flatten();
        let nearest = ends.min_by(|p, q| p.room.abs().total_cmp(&q.room.abs()));
        let Some(RailEnd { knot, is_forward, .. }) = nearest else { return false };
        let hint = path.hint_past(knot, is_forward).staying();
        let corner = (knot.turn != 0.0).then(|| path.corner_sides(knot));
        self.set_hint(id, hint);
        self.connectors.states[id.index()].corner = corner;
        corner.is_some()
    }

    /// Notes the places on their rails of a group's points at its start: laps of an arc are told apart by the last
    /// place. Rows on splines were followed to it.
    pub(super) fn renew_hints(&mut self, group: &mut Group) {
        let count = group.bodies.len();
        let Group { bodies, state, rows, stops, .. } = group;
        let found = |id: ConnectorId, hint: Option<&RailHint>| -> Option<RailHint> {
            let connector = self.connector(id);
            let (anchor, _) = connector.anchors();
            let (path, place) = (connector.path()?, bodies.binary_search(&anchor.body).ok()?);
            let point = body_state(state, count, place).pose().point_to_world(anchor.point);
            Some(path.hint_near(point, hint))
        };
        for stop in stops {
            stop.is_noted = false;
            let left = self.connectors.states[stop.id.index()].hint.and_then(|hint| hint.before_stop());
            // Ropes that are watched like stops have no hints.
            let hint = found(stop.id, stop.hint.as_ref()).map(|hint| hint.with_before_stop(left));
            stop.hint = hint.map(|hint| if self.is_led(stop.id) { hint.staying() } else { hint });
        }
        let mechanism = self.mechanism();
        for row in rows.iter_mut().filter(|row| !mechanism.is_in_corner(row)) {
            if let RowSource::Connector(id, _) = row.source
                && self.connector(id).path().is_some_and(|path| !path.knots().is_empty())
            {
                row.hint = found(id, row.hint.as_ref()).map(RailHint::staying);
            }
        }
        self.note_hints(rows);
    }

    /// Notes the hints of rows for their rails, except for points that rest in a corner.
    pub(super) fn note_hints(&mut self, rows: &[HeldRow]) {
        for row in rows {
            if let (RowSource::Connector(id, _), Some(hint)) = (row.source, row.hint)
                && !self.mechanism().is_in_corner(row)
            {
                self.set_hint(id, hint);
            }
        }
    }
}
