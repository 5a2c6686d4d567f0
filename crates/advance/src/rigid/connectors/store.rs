//! All connectors with their states, and how their rows are measured.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::by_body::ByBody;
use crate::rigid::bodies::instant::is_same_time;
use crate::time::Time;
use halfgap_collision::{BodyId, Connector, ConnectorId, ConnectorKind, GapState, RailHint, Rope};

/// All connectors with their states, and lists of them by body.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Connectors {
    pub(super) all: Vec<Connector>,
    /// Connectors of each body.
    pub(super) of: ByBody<ConnectorId>,
    pub(super) states: Vec<ConnectorState>,
    any_pulls: bool,
}

impl Connectors {
    /// Lists connectors between a number of bodies.
    pub(crate) fn new(all: Vec<Connector>, body_count: usize) -> Self {
        let ids = (0..).map(ConnectorId);
        Self {
            of: ByBody::new(body_count, ids.zip(all.iter().map(named_by))),
            states: vec![ConnectorState::default(); all.len()],
            any_pulls: all.iter().any(Connector::is_pull),
            all,
        }
    }

    /// True if there are motors, or joints with dry friction.
    pub(crate) fn any_pulls(&self) -> bool {
        self.any_pulls
    }

    /// Connectors that are tied to a body, or carried by it.
    pub(crate) fn of(&self, body: BodyId) -> &[ConnectorId] {
        self.of.of(body)
    }
}

/// The bodies that a connector names, the background in place of a third one that is missing.
fn named_by(connector: &Connector) -> [BodyId; 3] {
    let [a, b] = connector.bodies();
    [a, b, connector.third().map_or(BodyId::WORLD, |(body, _)| body)]
}

/// State of a connector.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ConnectorState {
    /// Place of its point on a rail.
    pub(super) hint: Option<RailHint>,
    /// Sides, before and after, of the corner of a rail that the point is in; `None` if it is in none.
    pub(super) corner: Option<[RailHint; 2]>,
    /// Time before which a rope does not go taut.
    pub(super) clear: Time,
    /// Time at which a rope goes taut; `None` if it does not while the motions are known, or the search has not come so
    /// far.
    pub(super) taut: Option<Time>,
    /// Excess length [m] that a rope is given while it is at its length and does not tighten: it goes taut at the sum
    /// of both.
    pub(super) slack: f64,
    /// True if it is unilateral and active: its row then takes part in events at any gap.
    pub(super) active: bool,
    /// Time at which the rope last went taut, or the stop was met.
    pub(super) last_taut: Option<Time>,
    /// Number of times that it did so before without time going by.
    pub(super) repeats: u32,
    /// If it is unilateral: its row at the last event at whose end it was touched.
    pub(super) seen: Option<SeenRow>,
    /// True if a group watches it as a stop.
    pub(super) is_watched: bool,
    /// Of a stop that a group watches: the start of the group's segment, and the place of the point there; `None` once
    /// the place that the point has come to is noted.
    pub(super) follow: Option<(Time, RailHint)>,
}

/// The row of a unilateral connector at the end of an event.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct SeenRow {
    pub(crate) time: Time,
    /// Gap [m].
    pub(crate) gap: f64,
    /// Rate of the gap [m/s].
    pub(crate) rate: f64,
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
    pub(crate) fn repeats_at(&self, now: Time) -> u32 {
        if self.last_taut.is_some_and(|last| is_same_time(last, now)) { self.repeats } else { 0 }
    }

    pub(crate) fn note_taut(&mut self, now: Time) {
        let is_repeat = self.last_taut.is_some_and(|last| is_same_time(last, now));
        self.repeats = if is_repeat { self.repeats + 1 } else { 0 };
        self.last_taut = Some(now);
    }
}

impl Connectors {
    /// True if unilateral rows of a connector were active until now.
    pub(crate) fn is_active_unilaterally(&self, id: ConnectorId) -> bool {
        let state = &self.states[id.index()];
        state.active || state.corner.is_some()
    }

    pub(crate) fn connector(&self, id: ConnectorId) -> &Connector {
        &self.all[id.index()]
    }

    /// Number of rows of a connector now: two where the point of a rail is in a corner.
    pub(crate) fn row_count(&self, id: ConnectorId) -> usize {
        self.states[id.index()].corner.map_or(self.connector(id).row_count(), |sides| sides.len())
    }

    /// A unilateral connector as it is watched along a segment that starts now.
    pub(crate) fn stop(&self, assembly: &Assembly, id: ConnectorId) -> Stop {
        let hint = self.hint_at(assembly, id, 0, assembly.now());
        Stop { id, hint, slack: self.slack_of(assembly, id), is_noted: false }
    }

    /// Distance [m] beyond its length, or its stop, at which a unilateral connector fires from now on: positive only
    /// where it is touched and does not open, or has fired without time going by. That lies nearer than the search can
    /// tell: it fires again only when it has sunk further, by more each time.
    pub(crate) fn slack_of(&self, assembly: &Assembly, id: ConnectorId) -> f64 {
        let sample = self.measure_connector(assembly, id, 0, assembly.now());
        let gap = GapState::of_rope(&sample, &assembly.settings().tolerances);
        let rests = gap.is_touching() && !gap.opens(assembly.rest_speed());
        let times = self.states[id.index()].repeats_at(assembly.now()) + u32::from(rests);
        if times == 0 { 0.0 } else { f64::from(times) * assembly.sink() + (-sample.gap).max(0.0) }
    }
}

/// True for a rope.
pub(crate) fn is_rope(connector: &Connector) -> bool {
    rope_of(connector).is_some()
}

/// The rope of a connector, if it is one.
pub(crate) fn rope_of(connector: &Connector) -> Option<Rope> {
    match &connector.kind {
        ConnectorKind::Rope { a, b, length } => {
            Some(Rope { point_a: a.point, point_b: b.point, length: *length })
        }
        _ => None,
    }
}

/// A stop of a rail that is not active.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Stop {
    pub(crate) id: ConnectorId,
    /// Piece of the rail.
    pub(crate) hint: Option<RailHint>,
    /// Distance [m] by which it may sink before it fires; more than 0 where it is touched without force.
    pub(crate) slack: f64,
    /// The place that its point has come to is noted: its body is about to leave the segment.
    pub(crate) is_noted: bool,
}

impl Stop {
    /// Sets the place of its point at the start of a segment.
    pub(crate) fn renew(&mut self, hint: Option<RailHint>) {
        (self.hint, self.is_noted) = (hint, false);
    }

    /// Notes that the place to which its point has come is known.
    pub(crate) fn note(&mut self) {
        self.is_noted = true;
    }
}

impl Connectors {
    /// True if a group watches a rope or a stop.
    pub(crate) fn is_rope_watched(&self, id: ConnectorId) -> bool {
        self.states[id.index()].is_watched
    }

    /// Notes whether a unilateral connector is active.
    pub(crate) fn set_active(&mut self, id: ConnectorId, active: bool) {
        self.states[id.index()].active = active;
    }

    /// Notes the row of a unilateral connector at the end of an event, if it is touched.
    pub(crate) fn note_seen(&mut self, assembly: &Assembly, id: ConnectorId) {
        let sample = self.measure_connector(assembly, id, 0, assembly.now());
        if GapState::of_rope(&sample, &assembly.settings().tolerances).is_touching() {
            let (gap, rate) = (sample.gap, sample.kinematics.rate);
            self.states[id.index()].seen = Some(SeenRow { time: assembly.now(), gap, rate });
        }
    }

    /// Forgets how the unilateral connectors of a body were seen.
    pub(crate) fn forget_seen_of(&mut self, body: BodyId) {
        for id in self.of.of(body) {
            self.states[id.index()].seen = None;
        }
    }

    /// Notes that a rope has gone taut, or a stop is met, at a time.
    pub(crate) fn note_taut(&mut self, id: ConnectorId, now: Time) {
        self.states[id.index()].note_taut(now);
    }

    /// Sets the time before which a rope does not go taut, and that at which it does, if known.
    pub(crate) fn set_taut(&mut self, id: ConnectorId, clear: Time, taut: Option<Time>) {
        let state = &mut self.states[id.index()];
        (state.clear, state.taut) = (clear, taut);
    }

    /// Sets the excess length [m] that a rope is given.
    pub(crate) fn set_slack(&mut self, id: ConnectorId, slack: f64) {
        self.states[id.index()].slack = slack;
    }

    /// Sets the place of the point of a stop; the distance left before the stop stays.
    pub(crate) fn set_stop_hint(&mut self, id: ConnectorId, hint: RailHint) {
        let state = &mut self.states[id.index()];
        let left = state.hint.and_then(|hint| hint.before_stop());
        state.hint = Some(hint.with_before_stop(left));
    }

    /// Notes that a group watches a stop along a segment that starts at a time.
    pub(crate) fn watch(&mut self, stop: &Stop, start: Time) {
        let state = &mut self.states[stop.id.index()];
        state.is_watched = true;
        state.follow = stop.hint.filter(|_| !stop.is_noted).map(|hint| (start, hint));
    }

    /// Notes that the place to which the point of a stop has come is known: it is followed no more.
    pub(crate) fn stop_following(&mut self, id: ConnectorId) {
        self.states[id.index()].follow = None;
    }

    /// Notes that no group watches a connector any more.
    pub(crate) fn unwatch(&mut self, id: ConnectorId) {
        let state = &mut self.states[id.index()];
        (state.is_watched, state.follow) = (false, None);
    }
}

impl Connectors {
    /// The all.
    #[inline]
    pub(crate) fn all(&self) -> &[Connector] {
        &self.all
    }

    /// The states.
    #[inline]
    pub(crate) fn states(&self) -> &[ConnectorState] {
        &self.states
    }
}

impl ConnectorState {
    /// Time before which a rope does not go taut.
    #[inline]
    pub(crate) fn clear(&self) -> Time {
        self.clear
    }

    /// Sides, before and after, of the corner of a rail that the point is in; `None` if it is in none.
    #[inline]
    pub(crate) fn corner(&self) -> Option<[RailHint; 2]> {
        self.corner
    }

    /// If it is unilateral: its row at the last event at whose end it was touched.
    #[inline]
    pub(crate) fn seen(&self) -> Option<SeenRow> {
        self.seen
    }

    /// True if it is unilateral and active: its row then takes part in events at any gap.
    #[inline]
    pub(crate) fn active(&self) -> bool {
        self.active
    }

    /// Place of its point on a rail.
    #[inline]
    pub(crate) fn hint(&self) -> Option<RailHint> {
        self.hint
    }

    /// Excess length [m] that a rope is given while it is at its length and does not tighten: it goes taut at the sum
    /// of both.
    #[inline]
    pub(crate) fn slack(&self) -> f64 {
        self.slack
    }

    /// Time at which a rope goes taut; `None` if it does not while the motions are known, or the search has not come so
    /// far.
    #[inline]
    pub(crate) fn taut(&self) -> Option<Time> {
        self.taut
    }
}
