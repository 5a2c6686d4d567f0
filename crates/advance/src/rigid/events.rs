//! The handling of an event: cut what it touches at its time, resolve the impact, find what is held, go on.

use super::error::{AdvanceError, Between};
use super::group::SegmentEnd;
use super::impacts::ImpactReport;
use super::pairs::PairId;
use super::region::Region;
use super::rows::RowSource;
use super::settle::Settling;
use super::system::RigidSystem;
use crate::time::Time;
use halfgap_collision::{BodyId, ConnectorId, FeatureRule, GapKinematics};
use halfgap_contact::Impact;
use halfgap_geometry::{FeatureId, GapSample};

/// Part of the accuracy by which a body that touches something fires later elsewhere: more than rounding.
const SEAM_SHARE: f64 = 1.0 / 32.0;
/// An event's time is corrected while the gap is off by more than this part of the accuracy.
const TIME_SHARE: f64 = 1e-2;

/// What fired: a pair of features, or nothing that has a gap.
type Fired = Option<([BodyId; 2], [FeatureId; 2])>;

/// Buffers of the handling of events, kept from one to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct EventWork {
    pub(crate) region: Region,
    impact: Impact,
    pub(crate) settling: Settling,
    pub(crate) seeds: Vec<BodyId>,
}

impl RigidSystem {
    /// Finds what is held at the start, where nothing has happened yet.
    pub(crate) fn establish(&mut self) -> Result<(), AdvanceError> {
        let mut work = self.work.take().unwrap_or_default();
        work.seeds.clear();
        work.seeds.extend(self.bodies());
        work.region.at_start = true;
        self.collect_region(&mut work.region, &work.seeds, self.now);
        let outcome = self.go_on(&mut work);
        work.region.at_start = false;
        self.work = Some(work);
        outcome
    }

    /// Two bodies come into contact; true if there was an impact.
    pub(crate) fn handle_contact(
        &mut self,
        pair: PairId,
        features: [FeatureId; 2],
    ) -> Result<bool, AdvanceError> {
        let bodies = self.pairs.get(pair).bodies;
        if self.sinks(pair, features) {
            return Ok(false);
        }
        self.note_repeat(pair)?;
        let mut work = self.work.take().unwrap_or_default();
        work.seeds.clear();
        work.seeds.extend(bodies);
        let outcome = self.handle_impact(&mut work, Some((bodies, features)));
        self.work = Some(work);
        outcome
    }

    /// A group's segment ends, or something ends it early; true if that is an impact: at a stop or a corner of a rail.
    pub(crate) fn handle_group(&mut self, leader: BodyId) -> Result<bool, AdvanceError> {
        if self.group_of(leader).is_some_and(|group| group.event.is_none()) {
            return self.extend_naturally(leader).map(|()| false);
        }
        let mut work = self.work.take().unwrap_or_default();
        let outcome = self.handle_group_with(leader, &mut work);
        self.work = Some(work);
        outcome
    }

    fn handle_group_with(&mut self, leader: BodyId, work: &mut EventWork) -> Result<bool, AdvanceError> {
        let Some(group) = self.group_of(leader) else { return Ok(false) };
        work.seeds.clear();
        work.seeds.extend(&group.bodies);
        let Some((_, end)) = group.event else { return Ok(false) };
        let changed_row = match end {
            SegmentEnd::Change(row) => Some(group.rows[row]),
            SegmentEnd::Release(_) | SegmentEnd::Stop | SegmentEnd::Switch => None,
        };
        work.region.run_off = None;
        match changed_row.map(|row| (row.bodies, row.source)) {
            Some((bodies, RowSource::Contact(features))) => work.region.run_off = Some((bodies, features)),
            Some((_, RowSource::Connector(id, _))) => return self.pass_joint(work, id),
            None => {}
        }
        if end == SegmentEnd::Stop {
            return self.handle_impact(work, None);
        }
        let outcome = self.handle_change(work);
        work.region.run_off = None;
        outcome.map(|()| false)
    }

    /// A point on a rail goes on along the next piece; where that is at a corner, the velocity across it is stopped.
    fn pass_joint(&mut self, work: &mut EventWork, id: ConnectorId) -> Result<bool, AdvanceError> {
        let is_corner = self.pass_knot(id, self.now);
        self.handle_impact(work, None).map(|happened| happened && is_corner)
    }

    fn extend_naturally(&mut self, leader: BodyId) -> Result<(), AdvanceError> {
        self.continue_group(leader)?;
        let mut bodies = std::mem::take(&mut self.extended);
        bodies.clear();
        bodies.extend(self.group_of(leader).into_iter().flat_map(|group| &group.bodies));
        for &body in &bodies {
            self.renew_stay(body);
        }
        self.predict_all_of(&bodies, false);
        self.search_ropes_on(&bodies);
        self.extended = bodies;
        Ok(())
    }

    /// A rope goes taut; true if there was an impact.
    pub(crate) fn handle_rope(&mut self, id: ConnectorId) -> Result<bool, AdvanceError> {
        let mut work = self.work.take().unwrap_or_default();
        work.seeds.clear();
        work.seeds.extend(self.connector(id).bodies());
        let outcome = self.handle_impact(&mut work, None);
        self.work = Some(work);
        outcome
    }

    /// What is held changes, but nothing closes.
    fn handle_change(&mut self, work: &mut EventWork) -> Result<(), AdvanceError> {
        self.collect_region(&mut work.region, &work.seeds, self.now);
        self.cut_groups(&work.region, self.now, |_, _| None);
        self.remeasure(&mut work.region, self.now);
        self.go_on(work)
    }

    pub(crate) fn handle_impact(&mut self, work: &mut EventWork, fired: Fired) -> Result<bool, AdvanceError> {
        self.collect_region(&mut work.region, &work.seeds, self.now);
        if !work.region.groups.is_empty() {
            let gap = fired.map(|(bodies, features)| self.gap_at(bodies, features, self.now).0);
            self.now =
                self.cut_groups(&work.region, self.now, |system, time| system.time_error(fired, gap, time));
            self.remeasure(&mut work.region, self.now);
        }
        if self.at_tick {
            self.put_back(work);
        }
        // What was slow when it fired stays inelastic, whatever the speed it has gained since.
        let is_storm = self.at_tick || self.note_events(&work.region);
        let mut report = std::mem::take(&mut self.last_impact);
        let now = self.now;
        let outcome = self.resolve_impact(&mut work.region, &mut work.impact, &mut report, now, is_storm);
        self.book_impact(&report, is_storm);
        self.last_impact = report;
        let happened = outcome?;
        self.counts.impacts += u64::from(happened);
        self.remeasure(&mut work.region, self.now);
        self.go_on(work)?;
        Ok(happened)
    }

    /// Finds what is held, makes groups, and predicts: the bodies of the region are in flight with their new velocities.
    fn go_on(&mut self, work: &mut EventWork) -> Result<(), AdvanceError> {
        self.note_rails(&work.region, self.now);
        let mut stage = std::mem::take(&mut self.stage);
        let outcome = self.settle(&mut work.region, &mut work.settling, &mut stage, self.now);
        self.stage = stage;
        outcome?;
        self.note_begins(&work.region, &work.settling);
        self.set_rules(&work.region, &work.settling);
        self.regroup(&work.region, &work.settling)?;
        for &body in &work.region.bodies {
            self.renew_stay(body);
        }
        self.predict_all_of(&work.region.bodies, true);
        self.predict_ropes(&work.region, &work.settling);
        Ok(())
    }

    /// Distance [m] by which a contact without force may sink before it fires again.
    pub(crate) fn sink(&self) -> f64 {
        self.settings.tolerances.sink()
    }

    /// By how much [s] the time is off at which a pair has the gap [m] that it had by dense output, if that can be told.
    fn time_error(&self, fired: Fired, wanted: Option<f64>, time: Time) -> Option<f64> {
        let (bodies, features) = fired?;
        let (gap, rate) = self.gap_at(bodies, features, time);
        let error = gap - wanted?;
        let counts = error.abs() > TIME_SHARE * self.settings.tolerances.accuracy;
        (counts && rate < -self.settings.tolerances.velocity_tol).then(|| -error / rate)
    }

    /// Tells the search which touching features to leave alone: those that are held, and, while they do not sink, those
    /// that touch without force.
    fn set_rules(&mut self, region: &Region, settling: &Settling) {
        for &body in &region.bodies {
            for index in 0..self.pairs.of_body(body).len() {
                let pair = self.pairs.of_body(body)[index];
                self.pairs.rules_mut(pair).clear();
            }
        }
        let sink = self.sink();
        let rest = self.rest_speed();
        self.set_halos(region);
        for touch in &region.touches {
            let Some(pair) = self.pairs.between(touch.bodies[0], touch.bodies[1]) else { continue };
            let is_held = settling.held.iter().any(|(_, row)| match row.source {
                RowSource::Contact([p, n]) => {
                    (row.bodies == touch.bodies && [p, n] == touch.features)
                        || (row.bodies == [touch.bodies[1], touch.bodies[0]] && [n, p] == touch.features)
                }
                RowSource::Connector(..) => false,
            });
            let rule: Option<FeatureRule> = if is_held {
                Some(touch.skipped())
            } else {
                let (gap, rate) = self.gap_at(touch.bodies, touch.features, self.now);
                (rate <= rest)
                    .then(|| touch.lowered_to((gap - sink).min(self.settings.tolerances.target_gap)))
            };
            self.pairs.rules_mut(pair).extend(rule);
        }
    }

    /// Gives each body of a region the gap at which it fires: its target, or a little less than what it touches already.
    ///
    /// So a body that slides along at less than its target does not run against the seam of the next floor.
    fn set_halos(&mut self, region: &Region) {
        let target = self.settings.tolerances.target_gap;
        for &body in &region.bodies {
            self.halos[body.index()] = target;
        }
        let seam = SEAM_SHARE * self.settings.tolerances.accuracy;
        let least = target - self.settings.tolerances.accuracy;
        for touch in &region.touches {
            let (gap, rate) = self.gap_at(touch.bodies, touch.features, self.now);
            if rate > self.rest_speed() {
                continue;
            }
            for body in touch.bodies.into_iter().filter(|&body| region.place(body).is_some()) {
                let halo = &mut self.halos[body.index()];
                *halo = halo.min((gap - seam).max(least));
            }
        }
    }

    /// Gap [m] and rate [m/s] of two features at a time.
    fn gap_at(&self, bodies: [BodyId; 2], features: [FeatureId; 2], time: Time) -> (f64, f64) {
        let moving = bodies.map(|body| self.flyer(body).moving_at(time));
        let [a, b] = [0, 1].map(|side: usize| self.flyer(bodies[side]).body().shape.feature(features[side]));
        let Some(sample) = GapSample::measure_unbounded(a, &moving[0].pose, b, &moving[1].pose) else {
            return (f64::INFINITY, 0.0);
        };
        let (primary, normal) = if sample.primary_is_a { (0, 1) } else { (1, 0) };
        (sample.gap, GapKinematics::of(&sample, &moving[primary], &moving[normal]).rate)
    }

    fn book_impact(&mut self, report: &ImpactReport, is_storm: bool) {
        let fastest = report.rows.iter().fold(0.0f64, |most, row| most.max(-row.rate_before));
        let is_capture = is_storm || fastest <= self.settings.tolerances.velocity_tol;
        let booked = if is_capture { &mut self.ledger.captures } else { &mut self.ledger.impacts };
        *booked += report.energy_change;
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

/// A pair may collide so many times without time going by before the advance is stuck.
const MOST_REPEATS: u32 = 100;
/// Two contacts are at one time when they differ by at most this many machine epsilons of the clock.
const SAME_TIME: f64 = 4.0;
