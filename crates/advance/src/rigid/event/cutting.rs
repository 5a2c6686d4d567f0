//! Groups are cut at the time of an event: where their bodies are then, and when that is.
//!
//! The search for contacts sees dense output. Where that may err by much of what a step may, the step is made
//! anew up to the event, so that the restart has full order; what fired, a contact, a rope or a stop, is then a
//! little off, and the time is corrected until it is where the search saw it. Where that does not bring all
//! that touches to where it was seen, as of what closes slowly, or brings a body into another, the event stays
//! on the dense output, along which nothing penetrates.

use super::cause::Cause;
use super::region::{Region, Touch};
use crate::rigid::search::pairs::{Link, Prediction};
use crate::rigid::sources::Source as EventSource;
use crate::rigid::step::dynamics::body_state;
use crate::rigid::step::group::SegmentEnd;
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::BodyId;
use halfgap_geometry::Relation;

/// An event's time is corrected while the gap is off by more than this part of the accuracy.
const TIME_SHARE: f64 = 1e-2;
/// Cap on the corrections of an event's time.
const MOST_CORRECTIONS: usize = 2;
/// Part of the accuracy by which a step made anew may have what touches nearer or farther than the search saw it.
const SEEN_SHARE: f64 = 0.5;

/// Where the bodies of a group that is cut are taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    /// A step made anew, or dense output that errs by little.
    Exact,
    /// What the search for contacts has seen.
    Dense,
}

impl RigidSystem {
    /// Cuts the groups of a region at the present time, or a little off, and ends them: their bodies fly on from there.
    pub(crate) fn cut_groups(&mut self, region: &mut Region) {
        self.complete_dense();
        region.groups.iter().for_each(|&leader| self.note_ways(leader));
        let seen = self.now;
        self.measure_touches(region);
        let gap = self.gap_of_cause(region.cause, seen).map(|(gap, _)| gap);
        let time = self.cut_exactly(region, gap);
        if self.is_off(region, gap, time) {
            for &leader in &region.groups {
                self.cut_group(leader, seen, Source::Dense);
            }
        } else {
            self.now = time;
        }
        for &leader in &region.groups {
            self.dissolve(leader);
        }
    }

    /// Cuts the groups of a region where steps made anew bring what fired to the gap [m] that it was seen with;
    /// the answer is when.
    fn cut_exactly(&mut self, region: &Region, gap: Option<f64>) -> Time {
        let mut time = self.now;
        for round in 0..=MOST_CORRECTIONS {
            for &leader in &region.groups {
                self.cut_group(leader, time, Source::Exact);
            }
            if round == MOST_CORRECTIONS {
                break;
            }
            let corrected = self.passed(region, time).or_else(|| self.corrected(region.cause, gap, time));
            let Some(corrected) = corrected else { break };
            let starts =
                region.groups.iter().filter_map(|&leader| self.groups.by_leader[leader.index()].as_deref());
            let latest = starts.map(|group| group.start).max().unwrap_or(time);
            if corrected <= latest {
                break;
            }
            time = corrected;
        }
        time
    }

    /// When what fired has the gap [m] that it had by dense output, if the time given is off and that can be told.
    fn corrected(&self, cause: Cause, wanted: Option<f64>, time: Time) -> Option<Time> {
        let (gap, rate) = self.gap_of_cause(cause, time)?;
        let error = gap - wanted?;
        let counts = error.abs() > TIME_SHARE * self.settings.tolerances.accuracy;
        (counts && rate < -self.settings.tolerances.velocity_tol).then(|| time.plus(-error / rate))
    }

    /// The earliest contact of the bodies of a region that was predicted for a time before this one, to which
    /// the present event has been corrected, if it has been passed: what has sunk that deep is not found
    /// again.
    fn passed(&self, region: &Region, time: Time) -> Option<Time> {
        if time <= self.now {
            return None;
        }
        let least = self.settings.tolerances.target_gap - self.settings.tolerances.accuracy;
        let links = region.bodies.iter().flat_map(|&body| self.pairs.of_body(body));
        let contacts = links.filter_map(|link| {
            let Prediction::Contact(features) = self.pairs.get(link.pair).prediction else { return None };
            let predicted = self.queue.time_of(self.source_id(EventSource::Pair(link.pair)))?;
            let bodies = self.pairs.bodies(link.pair);
            let has_sunk = || self.gap_at(Touch { bodies, features }, time).0 < least;
            (predicted < time && has_sunk()).then_some(predicted)
        });
        contacts.min()
    }

    /// True if what touches in a region is not where the search saw it: of an event whose time was corrected,
    /// what fired, seen with a gap [m]. So it is where a body lies within another that it did not touch.
    fn is_off(&self, region: &Region, gap: Option<f64>, time: Time) -> bool {
        let allowed = SEEN_SHARE * self.settings.tolerances.accuracy;
        let fired = self.gap_of_cause(region.cause, time).zip(gap);
        if fired.is_some_and(|((gap, _), seen)| (gap - seen).abs() > allowed) {
            return true;
        }
        let mut seen = region.touches.iter().zip(&region.motions);
        let moves_touches = seen.any(|(&touch, &(gap, _))| {
            time == self.now && (self.gap_at(touch, time).0 - gap).abs() > allowed
        });
        moves_touches || self.strayed(region, time).any(|body| self.is_in_another(body, region, time))
    }

    /// The bodies of a region that are farther from where the search saw them than contacts may be.
    fn strayed<'a>(&'a self, region: &'a Region, time: Time) -> impl Iterator<Item = BodyId> + 'a {
        let allowed = self.settings.tolerances.accuracy;
        let groups =
            region.groups.iter().filter_map(|&leader| self.groups.by_leader[leader.index()].as_deref());
        groups.flat_map(move |group| {
            let offset = time.since(group.start).max(0.0);
            let places = group.bodies.iter().zip(&group.paths);
            places.filter_map(move |(&body, path)| {
                let [x, y, angle] = [0, 1, 2].map(|k: usize| path[k].value_at(offset));
                let state = self.flyer(body).unwound_at(time);
                let way = state.position.distance(DVec2::new(x, y));
                (way + (state.angle - angle).abs() * self.flyer(body).reach() > allowed).then_some(body)
            })
        })
    }

    /// True if a body lies within one near it, deeper than contacts may be, that it does not touch in a region.
    fn is_in_another(&self, body: BodyId, region: &Region, time: Time) -> bool {
        let pose = |body: BodyId| self.flyer(body).moving_at(time).pose;
        let shape = |body: BodyId| &self.flyers[body.index()].body().shape;
        self.pairs.of_body(body).iter().any(|&Link { pair, other }| {
            let touches = |touch: &Touch| touch.bodies == self.pairs.bodies(pair);
            let finite = [body, other].iter().all(|&body| pose(body).position.is_finite());
            finite
                && !region.touches.iter().any(touches)
                && shape(body).relation(&pose(body), shape(other), &pose(other)) == Relation::Crossing
        })
    }

    /// Places the bodies of a group where they are at a time; the group stays as it was, so that it can be cut again.
    fn cut_group(&mut self, leader: BodyId, time: Time, source: Source) {
        let Some(mut group) = self.groups.take(leader) else { return };
        let offset = time.since(group.start).max(0.0);
        if offset < 0.5 * group.span {
            // What was read there is not reached.
            group.largest_error = 0.0;
        }
        // Along a step over the kink of a force dense output errs by more than the step's estimate knows.
        let is_smooth = !matches!(group.event, Some((_, SegmentEnd::Switch)));
        if offset != group.span || source == Source::Dense {
            self.with_group(&mut group, |dynamics, tools| {
                let by_dense = source == Source::Dense || (is_smooth && dynamics.is_dense_exact(offset));
                if by_dense || !dynamics.repeat_to(tools, offset) {
                    dynamics.end_by_dense(offset);
                }
                dynamics.end_on_rows(tools);
            });
        }
        for (place, &body) in group.bodies.iter().enumerate() {
            let state = body_state(&group.end_state, group.bodies.len(), place);
            self.flyers[body.index()].fly_from(time, state);
        }
        self.groups.put(group);
    }
}
