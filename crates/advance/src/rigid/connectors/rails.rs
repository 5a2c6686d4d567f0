//! Positions on their paths of the points of rails and stops: pieces, joints and laps.
//!
//! A row on a path of pieces stays on the piece of its point until an event at a joint is handled, so that nothing
//! jumps. On a closed path a point just behind a stop and one that has gone a lap since lie at the same place: the
//! distance that was left before the stop tells them apart.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::ends::{RailEnd, end_rooms};
use crate::rigid::connectors::store::Connectors;
use crate::rigid::shares::{ROUNDED, ROUNDS};
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{ConnectorId, ConnectorKind, RailHint};

impl Connectors {
    /// Hint for the place of a connector's row on its rail at a time. It tells the distance left before a stop, for the
    /// point may go round by more than half within the segment of its body.
    pub(crate) fn hint_at(
        &self,
        assembly: &Assembly,
        id: ConnectorId,
        row: usize,
        time: Time,
    ) -> Option<RailHint> {
        let hint = self.states.get(id.index())?.hint_of(row).copied()?;
        Some(hint.with_before_stop(self.followed(assembly, id, time).or(hint.before_stop())))
    }

    /// Notes the distance left before a stop of a closed rail at a time.
    pub(crate) fn note_left(&mut self, assembly: &Assembly, id: ConnectorId, time: Time) {
        let stop = self.connector(id);
        if !(stop.is_stop() && stop.path().is_some_and(|path| path.is_closed())) {
            return;
        }
        let left = self.within_lap(id, self.measure_connector(assembly, id, 0, time).gap);
        let state = &mut self.states[id.index()];
        state.hint = state.hint.map(|hint| hint.with_before_stop(Some(left)));
    }

    /// The way [m] to a stop, less a lap if it is a lap or more: the point has then passed the stop from behind, where
    /// the stop does not hold it.
    fn within_lap(&self, id: ConnectorId, left: f64) -> f64 {
        let lap = self.connector(id).path().map_or(f64::INFINITY, |path| path.length());
        if left >= (1.0 - ROUNDED) * lap { left - lap } else { left }
    }

    /// Notes the place of a rail's point, for the rail and its stops: beyond a sharp corner the piece before it seems
    /// as near to these. They are measured along the piece as if it went on: its end is an event.
    pub(crate) fn set_hint(&mut self, id: ConnectorId, hint: RailHint) {
        self.states[id.index()].hint = Some(hint);
        for index in 0..self.of(self.connector(id).bodies()[0]).len() {
            let stop = self.of(self.connector(id).bodies()[0])[index];
            if self.connector(stop).is_stop_of(self.connector(id)) {
                let left = self.states[stop.index()].hint.and_then(|hint| hint.before_stop());
                self.states[stop.index()].hint = Some(hint.with_before_stop(left));
            }
        }
    }

    /// True for a stop that holds its point on the piece of a hint, where that piece ends in a corner.
    pub(crate) fn is_at_end(&self, stop: ConnectorId, hint: &RailHint) -> bool {
        let ConnectorKind::RailStop { path, at, upper, .. } = &self.connector(stop).kind else {
            return false;
        };
        path.ends_in_corner(hint, *upper, *at)
    }

    /// True for a stop whose rail is a connector of the system, too.
    pub(crate) fn is_led(&self, id: ConnectorId) -> bool {
        let stop = self.connector(id);
        let beside = self.of(stop.bodies()[0]);
        beside.iter().any(|&rail| stop.is_stop_of(self.connector(rail)))
    }

    /// Position [m] of the first point of a connector at a time, in world coordinates: that of a rail or a stop.
    pub(crate) fn point_on_rail(&self, assembly: &Assembly, id: ConnectorId, time: Time) -> DVec2 {
        let [anchor, _] = self.connector(id).anchors();
        anchor.map_or(DVec2::ZERO, |anchor| {
            assembly.moving_at(anchor.body, time).pose.point_to_world(anchor.point)
        })
    }

    /// Moves the hint of a rail, whose point comes to a joint of the path, on to the next piece. True if the joint is a
    /// corner, in which the point then is.
    pub(crate) fn pass_knot(&mut self, assembly: &Assembly, id: ConnectorId, time: Time) -> bool {
        let Some(path) = self.connector(id).path() else { return false };
        let place =
            path.nearest(self.point_on_rail(assembly, id, time), self.states[id.index()].hint.as_ref());
        let ends = end_rooms(path, &place).into_iter().flatten();
        let nearest = ends.min_by(|p, q| p.room.abs().total_cmp(&q.room.abs()));
        let Some(RailEnd { knot, is_forward, .. }) = nearest else { return false };
        let hint = path.hint_past(knot, is_forward).staying();
        let corner = (knot.turn != 0.0).then(|| path.corner_sides(knot));
        self.set_hint(id, hint);
        self.states[id.index()].corner = corner;
        corner.is_some()
    }
}

impl Connectors {
    /// Distance [m] left before a stop of a closed rail at a time, followed along the segment of the group that watches
    /// the stop; `None` for other connectors and stops.
    fn followed(&self, assembly: &Assembly, id: ConnectorId, time: Time) -> Option<f64> {
        let connector = self.connector(id);
        let (anchor, path) =
            connector.on_rail().filter(|(_, path)| connector.is_stop() && path.is_closed())?;
        let (start, mut hint) = self.states[id.index()].follow?;
        let span = time.since(start);
        for look in 1..=ROUNDS {
            let at = start.plus(span * f64::from(look) / f64::from(ROUNDS));
            let [a, b] = connector.bodies().map(|body| assembly.moving_at(body, at));
            let left = connector.measure_near(0, &a, &b, Some(&hint)).gap;
            let next = path.hint_near(a.pose.point_to_world(anchor.point), Some(&hint));
            hint = if hint.is_staying() { next.staying() } else { next }.with_before_stop(Some(left));
        }
        hint.before_stop()
    }
}
