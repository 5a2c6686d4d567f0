//! Predictions: which bodies are near each other, and when pairs of them come into contact.

use crate::rigid::agenda::Source;
use crate::rigid::bodies::path::Path;
use crate::rigid::contacts::pairs::{Link, PairId, Prediction};
use crate::rigid::contacts::table::Mode;
use crate::rigid::search::lane::{Lane, LaneKind};
use crate::rigid::search::searching::Searching;
use crate::rigid::sinking::depth::may_have_sunk_by;
use crate::time::Time;
use halfgap_collision::{
    BodyId, FeatureRule, Motion, MovingShape, PairSearch, Polynomial, Search, SearchSettings, Tolerances,
    Zone, disc_contact,
};
use halfgap_geometry::{FeatureId, GapSample};

/// Longest span [s] of one search: bounds over it stay finite.
pub(crate) const LONGEST_SPAN: f64 = 1e6;

impl Searching<'_> {
    pub(crate) fn set_up_boxes(&mut self) {
        for body in self.assembly.bodies() {
            if !self.search.loners[body.index()] {
                self.place_box(body);
            }
        }
        for body in self.assembly.bodies() {
            if !self.search.loners[body.index()] && self.assembly.is_movable(body) {
                self.find_neighbours(body);
            }
        }
    }

    /// Gives a body a new box around its present motion, and predicts when it leaves that.
    fn place_box(&mut self, body: BodyId) {
        let (lane, trajectory) = (&self.search.lanes[body.index()], self.assembly.trajectory(body));
        let fat_box = self.search.rooms[body.index()].fat_box(lane, trajectory, self.assembly.now());
        self.search.broad.set(body, fat_box);
        self.predict_leaving(body);
    }

    /// Takes over the motion of a body, which may be new, and predicts anew when it leaves its box.
    pub(crate) fn renew_stay(&mut self, body: BodyId) {
        self.search.lanes[body.index()].follow(self.assembly.trajectory(body));
        self.forget_contacts_ahead(body);
        self.predict_leaving(body);
    }

    fn predict_leaving(&mut self, body: BodyId) {
        let (trajectory, room) = (self.assembly.trajectory(body), &self.search.rooms[body.index()]);
        let lane = &mut self.search.lanes[body.index()];
        let fat_box = self.search.broad.bounds(body);
        let stay =
            fat_box.and_then(|fat_box| room.stays_until(lane, trajectory, fat_box, self.assembly.now()));
        lane.stay = stay.unwrap_or(Time::NEVER);
        let source = Source::Box(body);
        match stay {
            Some(time) => self.agenda.set(source, time),
            None => self.agenda.clear(source),
        }
    }

    /// Pairs a body with all bodies whose boxes overlap its own, and with no others.
    fn find_neighbours(&mut self, body: BodyId) {
        let Some(fat_box) = self.search.broad.bounds(body).copied() else { return };
        let mut near = std::mem::take(&mut self.search.neighbours);
        self.search.broad.find_overlapping(&fat_box, &mut near);
        self.search.marks.begin(self.assembly.trajectories().len());
        near.iter().for_each(|&other| self.search.marks.set(other));
        self.search.links.clear();
        self.search.links.extend_from_slice(self.pairs.of_body(body));
        for index in 0..self.search.links.len() {
            let Link { pair, other } = self.search.links[index];
            // Bodies that stay marked are new neighbours.
            if !self.search.marks.take(other) {
                self.note_prediction(pair, (Prediction::Quiet, self.assembly.now()));
                self.pairs.remove(pair);
            }
        }
        near.retain(|&other| self.search.marks.take(other));
        near.retain(|&other| other != body && self.may_collide(body, other));
        near.sort_unstable();
        for &other in &near {
            self.pairs.add(body, other, self.assembly.now());
        }
        self.search.rooms[body.index()].adapt(self.pairs.of_body(body).len());
        self.search.neighbours = near;
    }

    fn may_collide(&self, a: BodyId, b: BodyId) -> bool {
        let any_movable = self.assembly.is_movable(a) || self.assembly.is_movable(b);
        any_movable && self.search.excluded.binary_search(&(a.min(b), a.max(b))).is_err()
    }

    /// Time until which the present motion of a body is known and stays in its box.
    fn known_until(&self, body: BodyId) -> Time {
        let stay = self.search.lanes[body.index()].stay;
        self.assembly.segment_end(body).map_or(stay, |end| stay.min(end))
    }

    /// Continues the search for a pair's next contact, from where it is known to be clear, while both motions are
    /// known.
    pub(crate) fn predict(&mut self, pair: PairId) {
        let [a, b] = self.pairs.bodies(pair);
        let from = self.pairs.get(pair).clear().max(self.assembly.now());
        let disc = self.disc_at(a, from);
        self.predict_from(from, disc.as_ref(), Link { pair, other: b });
    }

    /// Searches from a time on for the next contact of a pair; `disc` is the flight of the body that the link starts
    /// from, if that is a disc.
    #[inline]
    fn predict_from(&mut self, from: Time, disc: Option<&DiscAt>, link: Link) {
        match disc.and_then(|disc| self.look_at_discs(from, disc, link)) {
            Some(outlook) => self.note_prediction(link.pair, outlook),
            None => self.predict_any(link.pair, from),
        }
    }

    /// Flight of a body from a time on, if it is a disc.
    #[inline]
    fn disc_at(&self, body: BodyId, from: Time) -> Option<DiscAt> {
        let lane = &self.search.lanes[body.index()];
        let is_plain = lane.kind == LaneKind::Disc && self.assembly.settings().search.depth == 0.0;
        let Lane { radius, trigger_gap, stay, .. } = *lane;
        is_plain.then(|| DiscAt { parabola: lane.parabola_from(from), radius, trigger_gap, stay })
    }

    /// Prediction of a pair of free discs and the time until which they are clear; `None` for other pairs.
    #[inline]
    fn look_at_discs(&self, from: Time, own: &DiscAt, link: Link) -> Option<(Prediction, Time)> {
        let lane = &self.search.lanes[link.other.index()];
        let tolerances = self.assembly.settings().tolerances;
        let is_lowered = own.trigger_gap.min(lane.trigger_gap) < tolerances.target_gap;
        if lane.kind != LaneKind::Disc || is_lowered || self.pairs.get(link.pair).has_rules() {
            return None;
        }
        // A motion in flight is known until the body leaves its box.
        look_ahead(from, own.stay.min(lane.stay), |span| {
            let other = (lane.parabola_from(from), lane.radius);
            disc_contact((own.parabola, own.radius), other, span, &tolerances)
        })
    }

    /// Searches from a time on for the next contact of any pair. Not inlined: most pairs do not come here.
    #[inline(never)]
    fn predict_any(&mut self, pair: PairId, from: Time) {
        let [a, b] = self.pairs.bodies(pair);
        let until = self.known_until(a).min(self.known_until(b));
        if self.assembly.share_step([a, b]) {
            self.note_prediction(pair, (Prediction::Quiet, until));
            return;
        }
        if self.stays_apart(pair, from, until) {
            self.note_prediction(pair, (Prediction::Quiet, until));
            return;
        }
        self.drop_rules(pair, from);
        let horizon = self.searched_until([a, b], from, until);
        let search = |span| Some(self.search_pair(pair, from, span));
        let Some((prediction, clear)) = look_ahead(from, horizon, search) else { return };
        match prediction {
            Prediction::Contact(_) => self.note_contact_ahead([a, b], from, clear),
            Prediction::Quiet if clear < until => {
                return self.note_prediction(pair, (Prediction::SearchOn, clear));
            }
            Prediction::Quiet | Prediction::SearchOn => {}
        }
        self.note_prediction(pair, (prediction, clear));
    }

    /// True if the bodies of a pair, at least one of which follows an integrator, surely do not come near each other:
    /// in a heap, where steps are short, few neighbours do.
    fn stays_apart(&self, pair: PairId, from: Time, until: Time) -> bool {
        let [a, b] = self.pairs.bodies(pair).map(|body| &self.search.lanes[body.index()]);
        let span = until.since(from);
        let any_integrated = a.kind == LaneKind::Other || b.kind == LaneKind::Other;
        if self.pairs.get(pair).has_rules() || !any_integrated || span <= 0.0 || span >= LONGEST_SPAN {
            return false;
        }
        let (p, q) = (a.course_from(from, span), b.course_from(from, span));
        let far = p.radius + q.radius + a.reach + b.reach + self.assembly.settings().tolerances.target_gap;
        (p.center - q.center).length_squared() > far * far
    }

    #[inline]
    pub(crate) fn note_prediction(&mut self, pair: PairId, (prediction, clear): (Prediction, Time)) {
        let was_quiet = self.pairs.foresee(pair, prediction, clear) == Prediction::Quiet;
        if prediction != Prediction::Quiet {
            self.agenda.set(Source::Pair(pair), clear);
        } else if !was_quiet {
            self.agenda.clear(Source::Pair(pair));
        }
    }

    /// Drops the rules of contacts that have opened beyond their target zone: they may fire at their target again.
    fn drop_rules(&mut self, pair: PairId, time: Time) {
        let may_open = |rule: &FeatureRule| rule.target.is_some();
        if !self.pairs.get(pair).has_rules() || !self.pairs.rules(pair).iter().any(may_open) {
            return;
        }
        let [a, b] = self.pairs.bodies(pair);
        let (pose_a, pose_b) = (
            self.assembly.trajectory(a).moving_at(time).pose,
            self.assembly.trajectory(b).moving_at(time).pose,
        );
        let (shape_a, shape_b) =
            (&self.assembly.trajectory(a).body().shape, &self.assembly.trajectory(b).body().shape);
        let tolerances = &self.assembly.settings().tolerances;
        let is_closed = |[feature_a, feature_b]: [FeatureId; 2], mode: Mode| {
            let features = [shape_a.feature(feature_a), shape_b.feature(feature_b)];
            let sample = GapSample::measure_unbounded(features[0], &pose_a, features[1], &pose_b);
            !matches!(mode, Mode::Open(_))
                || sample.is_some_and(|sample| Zone::of(sample.gap, tolerances) >= Zone::Target)
        };
        self.pairs.retain_modes(pair, is_closed);
    }

    /// Searches for a contact of two bodies in the given span [s] from a time on.
    fn search_pair(&self, pair: PairId, from: Time, span: f64) -> Search {
        let [a, b] = self.pairs.bodies(pair);
        let (trajectory_a, trajectory_b) = (self.assembly.trajectory(a), self.assembly.trajectory(b));
        let (offset_a, offset_b) = (trajectory_a.offset(from), trajectory_b.offset(from));
        let rules = self.pairs.rules(pair);
        let target_gap =
            self.search.lanes[a.index()].trigger_gap.min(self.search.lanes[b.index()].trigger_gap);
        let tolerances = Tolerances { target_gap, ..self.assembly.settings().tolerances };
        let sunk = may_have_sunk_by(self.assembly, self.sinking, [a, b]);
        let shapes = [&trajectory_a.body().shape, &trajectory_b.body().shape];
        let (Some(flight_a), Some(flight_b)) = (trajectory_a.flight(), trajectory_b.flight()) else {
            let path_a: Path<'_> = trajectory_a.path();
            let path_b: Path<'_> = trajectory_b.path();
            let side_a = MovingShape { shape: shapes[0], motion: &path_a, offset: offset_a };
            let side_b = MovingShape { shape: shapes[1], motion: &path_b, offset: offset_b };
            return self.search_shapes(&side_a, &side_b, (rules, &tolerances), sunk, span);
        };
        let side_a = MovingShape { shape: shapes[0], motion: flight_a, offset: offset_a };
        let side_b = MovingShape { shape: shapes[1], motion: flight_b, offset: offset_b };
        self.search_shapes(&side_a, &side_b, (rules, &tolerances), sunk, span)
    }

    fn search_shapes<A: Motion, B: Motion>(
        &self,
        a: &MovingShape<'_, A>,
        b: &MovingShape<'_, B>,
        (rules, tolerances): (&[FeatureRule], &Tolerances),
        sunk: f64,
        span: f64,
    ) -> Search {
        // A target below zero does not lessen the depth: it makes no feature lie on the far side of its body.
        let depth = tolerances.target_gap.max(0.0) + self.assembly.settings().tolerances.target_gap + sunk;
        let search = self.assembly.settings().search;
        let settings = &SearchSettings { depth, ..search };
        PairSearch { a, b, tolerances, settings, rules }.step(0.0, span)
    }

    pub(crate) fn leave_box(&mut self, body: BodyId) {
        self.place_box(body);
        self.find_neighbours(body);
        self.predict_all_of(&[body], false);
    }

    /// Predicts the pairs of some bodies: all of them if their motions changed, else the quiet ones, whose search has
    /// come to the end of the motions known before.
    pub(crate) fn predict_all_of(&mut self, bodies: &[BodyId], changed: bool) {
        self.pairs.begin_batch();
        let now = self.assembly.now();
        for &body in bodies {
            let disc = self.disc_at(body, now);
            self.pairs.enter_batch(body, !changed, &mut self.search.links);
            for index in 0..self.search.links.len() {
                let link = self.search.links[index];
                if changed {
                    self.predict_from(now, disc.as_ref(), link);
                } else {
                    self.predict(link.pair);
                }
            }
        }
    }
}

/// A disc in flight at the time from which its pairs are searched.
struct DiscAt {
    parabola: Polynomial,
    /// Radius [m].
    radius: f64,
    /// Gap [m] at which it fires.
    trigger_gap: f64,
    /// Time until which it surely stays in its box.
    stay: Time,
}

/// Prediction of a pair from a time on while its motions are known, and the time until which it is clear; `None` if the
/// search finds no answer.
#[inline]
fn look_ahead(
    from: Time,
    until: Time,
    search: impl FnOnce(f64) -> Option<Search>,
) -> Option<(Prediction, Time)> {
    if until <= from {
        return Some((Prediction::Quiet, from));
    }
    let span = until.since(from).min(LONGEST_SPAN);
    Some(match search(span)? {
        Search::Contact(contact) => {
            (Prediction::Contact([contact.feature_a, contact.feature_b]), from.plus(contact.time))
        }
        Search::NoneBefore(time) if time >= span && span < LONGEST_SPAN => (Prediction::Quiet, until),
        Search::NoneBefore(time) => (Prediction::SearchOn, from.plus(time)),
    })
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::rigid::bodies::trajectory::FreeMotion;

    use crate::rigid::group::groups::group_of;

    use crate::rigid::parts::{BodyPart, RigidParts};
    use crate::rigid::test_scene::{FINE, resting_discs, rooms_of};
    use glam::DVec2;
    use halfgap_collision::{Body, BodyState};
    use halfgap_geometry::Shape;

    #[test]
    fn bodies_that_follow_an_integrator_far_from_each_other_stay_apart() {
        let mut rooms = resting_discs(&[0.0, 1.5, 2.5 + 1e-9]);
        let now = rooms.assembly.now();
        let mut apart = |a, b| {
            let pair = rooms.pairs.between(BodyId(a), BodyId(b)).expect("they are near each other");
            assert!(group_of(&rooms.assembly, &rooms.groups, BodyId(a)).is_some(), "it is held by the floor");
            rooms.searching().stays_apart(pair, now, now.plus(1e-3))
        };
        assert!(apart(1, 2));
        assert!(!apart(2, 3), "the gap is less than the target");
    }

    #[test]
    fn bodies_that_fire_deep_within_each_other_still_meet() {
        let block = |side: f64, spin: f64| {
            let shape = Shape::block(1.0, 1.0).expect("a fine size");
            let body = Body { shape, inverse_mass: 1.0, inverse_moment: 1.0, elasticity: 1.0 };
            let (position, velocity) = (DVec2::new(side, 0.1 * side), DVec2::new(-side, 0.0));
            let state = BodyState { position, velocity, angular_velocity: spin, ..BodyState::default() };
            BodyPart::new(body, FreeMotion::default(), state)
        };
        let parts = RigidParts { bodies: vec![block(-1.0, 0.3), block(1.0, 0.4)], ..RigidParts::default() };
        let mut rooms = rooms_of(parts, FINE, Time::from_seconds(10.0));
        let pair = rooms.pairs.between(BodyId(0), BodyId(1)).expect("they are near each other");
        let expected = rooms.pairs.get(pair).clear();
        for lowered in [0.4, 0.0, -1.0, -4.4] {
            rooms.search.lanes[0].trigger_gap = lowered * FINE.tolerances.target_gap;
            rooms.searching().predict_all_of(&[BodyId(0)], true);
            let entry = rooms.pairs.get(pair);
            let (prediction, clear) = (entry.prediction(), entry.clear());
            assert!(matches!(prediction, Prediction::Contact(_)), "{lowered}: {prediction:?}");
            assert!((clear.since(expected)).abs() < 1e-9, "{lowered}");
        }
    }
}
