//! Handling of an event: cut the groups that it touches at its time, resolve the impact, find the held rows, go on.

use super::cause::{Cause, EventWork};
use super::impacts::{ImpactReport, Manner};
use super::region::{Region, Touch, sorted};
use crate::rigid::error::AdvanceError;
use crate::rigid::limits::bounces::closes_fast;
use crate::rigid::limits::repeats::{CALM_REPEATS, is_same_time};
use crate::rigid::search::pairs::PairId;
use crate::rigid::step::group::SegmentEnd;
use crate::rigid::step::rows::RowSource;
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use halfgap_collision::{
    Body, BodyId, BodyState, Collision, ConnectorId, Detector, GapKinematics, Tolerances, Zone,
};
use halfgap_geometry::{Feature, FeatureId, GapSample};

/// Angle [rad] within which joints are smooth: twice that by which their features reach beyond them, and some rounding.
const SEAM_ANGLE: f64 = 4e-9;
/// Largest change of the velocities of bodies' points by an impact that stops contacts, as a multiple of the rates that
/// were stopped.
const MODEST: f64 = 100.0;
/// Largest impulse of such an impact, as a multiple of the largest change of momentum of a body.
const MOST_CANCELLING: f64 = 10.0;
/// Largest number of rounds in which the low hops of one event are stilled.
const HOP_ROUNDS: u32 = 4;

/// Entry of the ledger in which the energy of an impact is booked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Booking {
    /// As an impact, unless it is slow.
    BySpeed,
    /// As a capture: rows were stopped without elasticity, whatever their speed.
    Capture,
}

impl RigidSystem {
    /// Finds the rows that are held at the start.
    pub(crate) fn establish(&mut self) -> Result<(), AdvanceError> {
        self.with_work(Cause::Start, |system, work| {
            work.seeds.clear();
            work.seeds.extend(system.bodies());
            system.note_corners();
            system.collect_region(&mut work.region, &work.seeds, system.now);
            if !system.closes_slowly(&work.region) {
                return system.go_on(work);
            }
            // Contacts that close fast fire in their own time, unless they are in their target zone now.
            let fast = |record: &Collision| closes_fast(record) && record.zone() < Zone::Target;
            work.region.records.retain(|record| !fast(record));
            system.collide(work)
        })
    }

    /// Largest rate [m/s] at which a touching contact counts as resting at the start: with it, a contact leaves the
    /// target zone more slowly than forces can be resolved. Bodies that have come to rest elsewhere may come with that
    /// much.
    pub(crate) fn start_rest(&self) -> f64 {
        let Tolerances { accuracy, velocity_tol, .. } = self.settings.tolerances;
        (accuracy / self.settings.resolution_time).min(velocity_tol).max(self.rest_speed())
    }

    /// Largest rate [m/s] at which one contact counts as resting at the start. A contact that slides faster than
    /// `start_rest` has not come to rest, and would be stopped where normals differ: for it this is the rest speed.
    pub(crate) fn start_rest_of(&self, record: &Collision) -> f64 {
        let rest = self.start_rest();
        if record.motion.lateral_velocity.abs() <= rest { rest } else { self.rest_speed() }
    }

    /// True if any contact of a region closes so slowly that it is to be captured, but is not at rest yet.
    fn closes_slowly(&self, region: &Region) -> bool {
        let closes = |record: &Collision| {
            record.motion.normal_velocity < -self.start_rest_of(record) && !closes_fast(record)
        };
        let mut records = region.records.iter().filter(|record| !record.parties.bilateral);
        self.settings.impulse_step.is_none() && records.any(closes)
    }

    /// Handles the contact of two features of a pair.
    pub(crate) fn handle_contact(
        &mut self,
        pair: PairId,
        features: [FeatureId; 2],
    ) -> Result<(), AdvanceError> {
        let bodies = self.pairs.bodies(pair);
        if self.sinks(pair, features) || self.passes_over(pair, features) || self.grazes(pair, features) {
            return Ok(());
        }
        let touch = Touch::new(bodies, features);
        self.note_pressed(touch)?;
        let repeats = self.note_repeat(pair)?;
        self.with_work(Cause::Fired(touch), |system, work| {
            work.repeats = repeats.saturating_sub(CALM_REPEATS);
            work.seeds.clear();
            work.seeds.extend(bodies);
            system.handle_impact(work)
        })
    }

    /// Handles the end of a group's segment, natural or early.
    pub(crate) fn handle_group(&mut self, leader: BodyId) -> Result<(), AdvanceError> {
        if self.group_of(leader).is_some_and(|group| group.look.is_some()) {
            self.look_further(leader);
            return Ok(());
        }
        if self.group_of(leader).is_some_and(|group| group.event.is_none()) {
            return self.extend_naturally(leader);
        }
        self.with_work(Cause::Other, |system, work| system.handle_group_with(leader, work))
    }

    fn handle_group_with(&mut self, leader: BodyId, work: &mut EventWork) -> Result<(), AdvanceError> {
        let Some(group) = self.group_of(leader) else { return Ok(()) };
        work.seeds.clear();
        work.seeds.extend(&group.bodies);
        let Some((_, end)) = group.event else { return Ok(()) };
        match end {
            SegmentEnd::Release(row) => {
                if let Some(touch) = group.rows[row].touch() {
                    work.region.cause = Cause::Released(touch);
                }
                let source = group.rows[row].source;
                if group.made == self.now {
                    self.limits.last_pull = Some(self.now);
                }
                if let RowSource::Connector(id, side @ (0 | 1)) = source {
                    self.go_along(id, 1 - side);
                }
                self.handle_change(work)
            }
            SegmentEnd::Change(row) => match (group.rows[row].touch(), group.rows[row].source) {
                (_, RowSource::Connector(id, _)) => self.pass_joint(work, id),
                (touch, RowSource::Contact(_)) => {
                    let left = touch.filter(|&touch| self.leaves(touch));
                    work.region.cause = left.map_or(Cause::Other, Cause::RunOff);
                    if let Some(pair) =
                        left.and_then(|left| self.pairs.between(left.bodies[0], left.bodies[1]))
                    {
                        work.repeats = self.note_repeat(pair)?.saturating_sub(CALM_REPEATS);
                    }
                    self.handle_change(work)
                }
            },
            SegmentEnd::Sink(row) => {
                // A contact that was touched without force has sunk.
                let Some(touch) = group.idle[row].touch() else { return Ok(()) };
                work.region.cause = Cause::Fired(touch);
                self.handle_impact(work)
            }
            SegmentEnd::Stop(id) => self.meet_stop(work, id),
            SegmentEnd::Switch => self.handle_change(work),
        }
    }

    /// True if a contact that has come to the end of its features has left them.
    fn leaves(&self, Touch { bodies, features }: Touch) -> bool {
        let moving = bodies.map(|body| self.flyer(body).moving_at(self.now));
        self.mechanism().has_left(bodies, features, [&moving[0], &moving[1]])
    }

    fn extend_naturally(&mut self, leader: BodyId) -> Result<(), AdvanceError> {
        self.let_go(leader);
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

    /// Handles a rope that goes taut.
    pub(crate) fn handle_rope(&mut self, id: ConnectorId) -> Result<(), AdvanceError> {
        self.with_work(Cause::Taut(id), |system, work| {
            work.seeds.clear();
            work.seeds.extend(system.connector(id).bodies());
            system.handle_impact(work)
        })
    }

    /// Handles a change of the held rows. Other contacts that close within their target zones make it an impact.
    fn handle_change(&mut self, work: &mut EventWork) -> Result<(), AdvanceError> {
        self.collect_region(&mut work.region, &work.seeds, self.now);
        self.cut_groups(&mut work.region);
        self.remeasure(&mut work.region, self.now);
        if self.neighbour_closes(&work.region) {
            // Cutting moves bodies a little, and a corner that was passed a moment ago may be ahead again: it takes
            // over only if it is nearest now.
            self.collect_again(work);
        }
        self.hand_over(work);
        let region = &mut work.region;
        if work.repeats > 0 {
            // Two corners that pass each other may hand over to each other without end.
            self.retain_staying(region);
        }
        // Beside a seam a corner may be as near to the next corner, and pass over it.
        region.records.retain(|record| !(closes_fast(record) && self.passes_by(record)));
        let rest = self.rest_speed();
        if work.region.records.iter().any(|record| record.motion.normal_velocity < -rest) {
            return self.collide(work);
        }
        self.go_on(work)
    }

    /// True if two corners pass each other before they come to the gap at which their bodies fire.
    pub(super) fn passes_by(&self, record: &Collision) -> bool {
        if record.parties.detector != Detector::CornerCorner {
            return false;
        }
        let halo = |body: BodyId| self.search.lanes[body.index()].halo;
        let halos = halo(record.parties.primary.body).min(halo(record.parties.normal.body));
        let (along, across) = (record.motion.normal_velocity, record.motion.lateral_velocity);
        let nearest = record.geometry.distance * across.abs() / libm::hypot(along, across);
        nearest > halos.min(record.tolerances.target_gap)
    }

    /// True if another contact closes of the two bodies whose contact has run off its features.
    fn neighbour_closes(&self, region: &Region) -> bool {
        let Some(run_off) = region.cause.run_off() else { return false };
        let rest = self.rest_speed();
        let mut closing = region.records.iter().filter(|record| record.motion.normal_velocity < -rest);
        closing.any(|record| Touch::of(record).is_some_and(|touch| touch.bodies == run_off.bodies))
    }

    /// Continues a contact that goes from one feature to the next along a smooth joint: the rate of its neighbour comes
    /// only from the angle up to which joints are smooth, and is stopped. Where another contact closes fast at the same
    /// moment, the impact does that.
    fn hand_over(&mut self, work: &mut EventWork) {
        let Some(run_off) = work.region.cause.run_off() else { return };
        let is_neighbour = |record: &Collision| {
            let bodies = sorted(record.parties.primary.body, record.parties.normal.body);
            let (rate, speed) = (record.motion.normal_velocity, record.motion.center_velocity.length());
            bodies == run_off.bodies && rate.abs() <= SEAM_ANGLE * speed
        };
        let records = &mut work.region.records;
        if records.iter().any(|record| closes_fast(record) && !is_neighbour(record)) {
            return;
        }
        let mut any = false;
        for record in records.iter_mut().filter(|record| is_neighbour(record)) {
            record.parties.bilateral = true;
            any = true;
        }
        if any {
            self.stop_bilaterally(work);
        }
    }

    /// Collects the region of bodies in flight anew. The groups that have been cut no longer tell which bodies belong
    /// together; others may have come in, and are cut, too.
    pub(crate) fn collect_again(&mut self, work: &mut EventWork) {
        work.seeds.clear();
        work.seeds.extend(&work.region.bodies);
        self.collect_region(&mut work.region, &work.seeds, self.now);
        if !work.region.groups.is_empty() {
            self.cut_groups(&mut work.region);
            self.remeasure(&mut work.region, self.now);
        }
    }

    pub(crate) fn handle_impact(&mut self, work: &mut EventWork) -> Result<(), AdvanceError> {
        let fired = work.region.cause.fired();
        self.collect_region(&mut work.region, &work.seeds, self.now);
        if !work.region.groups.is_empty() {
            self.cut_groups(&mut work.region);
            self.remeasure(&mut work.region, self.now);
        }
        let rest = self.rest_speed();
        work.fired_open = fired.is_some_and(|fired| self.gap_at(fired, self.now).1 > -rest);
        if work.region.cause == Cause::Tick {
            self.put_back(work);
        }
        self.collide(work)
    }

    /// Resolves the impact of a region whose bodies are in flight, and goes on.
    pub(crate) fn collide(&mut self, work: &mut EventWork) -> Result<(), AdvanceError> {
        // One event too many in a short time, or of one pair without time going by, is resolved without elasticity.
        work.region.in_storm = self.note_events(&work.region);
        let is_storm = work.region.in_storm || work.repeats > 0;
        let mut report = std::mem::take(&mut self.told.last_impact);
        let now = self.now;
        let is_lawful = !is_storm && work.region.cause != Cause::Tick;
        let manner = if is_lawful { Manner::Lawful } else { Manner::Inelastic };
        let outcome = self.resolve_impact(&mut work.region, &mut work.impact, &mut report, now, manner);
        if outcome.is_ok() {
            self.book_impact(&report, if is_storm { Booking::Capture } else { Booking::BySpeed });
        }
        self.told.last_impact = report;
        outcome?;
        // A row that comes to rest without having closed is a contact that begins, not an impact.
        let at_joint = work.region.cause == Cause::SmoothJoint;
        let fastest = fastest_row(&self.told.last_impact, !at_joint);
        if fastest > self.rest_speed() {
            self.told.has_hit = true;
            self.counts.impacts += 1;
        }
        // Slower impacts may be of contacts that take turns.
        if fastest > self.settings.tolerances.velocity_tol {
            self.forget_paces(&work.region.bodies);
        }
        self.remeasure(&mut work.region, self.now);
        self.go_on(work)
    }

    /// Finds the held rows, makes groups, and predicts: the bodies of the region are in flight with their new
    /// velocities.
    fn go_on(&mut self, work: &mut EventWork) -> Result<(), AdvanceError> {
        for &body in &work.region.bodies {
            self.flyers[body.index()].unwind();
        }
        self.note_rails(&work.region, self.now);
        // Contacts that open slowly are let go, too, where the group that held them pulled: held, they move others along.
        work.region.is_hasty = self.take_haste(&work.region) || self.has_pulled(self.now);
        self.settle_and_still(work)?;
        while self.leave_loose_corner(work)? {
            self.settle_and_still(work)?;
        }
        self.measure_touches(&mut work.region);
        self.note_gaps(&work.region);
        self.note_seen(&work.region, work.fired_open);
        let outcome = self.regroup_soundly(work);
        self.note_begins(&work.region, &work.settling);
        outcome?;
        self.set_rules(work);
        if self.limits.last_insistent.is_some_and(|last| is_same_time(last, self.now)) {
            self.lower_insistent(&work.region);
        }
        for &body in &work.region.bodies {
            self.renew_stay(body);
        }
        self.predict_all_of(&work.region.bodies, true);
        self.note_held_connectors(&work.region, &work.settling);
        self.predict_ropes(&work.region);
        Ok(())
    }

    /// Finds the held rows, and stills those that hop: stopping some contacts makes others hop.
    pub(super) fn settle_and_still(&mut self, work: &mut EventWork) -> Result<(), AdvanceError> {
        let EventWork { region, settling, .. } = &mut *work;
        settling.set_likely(region.records.iter().map(|record| self.is_likely(record)));
        settling.expect_forces(region, &self.told.changes.end);
        let may_hop = work.region.cause != Cause::Start && !work.region.is_hasty;
        self.settle_region(work, may_hop)?;
        for round in 1..=HOP_ROUNDS {
            if !self.any_held_hops(work) {
                break;
            }
            let is_stilled = self.still_hops(work);
            let with_hops = is_stilled && may_hop && round < HOP_ROUNDS;
            self.settle_region(work, with_hops)?;
        }
        Ok(())
    }

    fn settle_region(&mut self, work: &mut EventWork, with_hops: bool) -> Result<(), AdvanceError> {
        let mut stage = std::mem::take(&mut self.stage);
        let outcome = self.settle(&mut work.region, &mut work.settling, &mut stage, self.now, with_hops);
        self.stage = stage;
        outcome
    }

    /// Resolves an impact without elasticity in which some contacts are marked as bilateral, and removes the marks.
    /// Where such rows contradict each other, nothing is done: as unilateral ones they need not.
    fn stop_bilaterally(&mut self, work: &mut EventWork) {
        let now = self.now;
        work.before.clear();
        work.before.extend(work.region.bodies.iter().map(|&body| self.flyer(body).unwound_at(now)));
        // A stop that may as well be left out is not worth a long solve.
        let manner = Manner::Trial;
        let outcome = self.resolve_impact(&mut work.region, &mut work.impact, &mut work.stop, now, manner);
        if outcome.is_ok() {
            self.remeasure(&mut work.region, now);
        }
        let is_stopped = outcome.is_ok()
            && self.has_stopped(&work.region)
            && self.is_modest(&work.stop, &work.region, &work.before);
        unmark(&mut work.region);
        if is_stopped {
            self.book_impact(&work.stop, Booking::Capture);
        } else if outcome.is_ok() {
            for (&body, &state) in work.region.bodies.iter().zip(&work.before) {
                self.flyers[body.index()].fly_from(now, state);
            }
            self.remeasure(&mut work.region, now);
        }
    }

    /// True if an impact changed the velocities of its bodies by about the rates that were stopped, with impulses of
    /// about the change of momentum. Contacts whose normals hardly differ hold all of a body: to stop the rate that
    /// their angle leaves would stop the body altogether, by large impulses that cancel each other on every body.
    fn is_modest(&self, report: &ImpactReport, region: &Region, before: &[BodyState]) -> bool {
        let stopped = report.rows.iter().fold(0.0f64, |most, row| most.max(row.rate_before.abs()));
        let impulse = report.rows.iter().fold(0.0f64, |most, row| most.max(row.impulse.abs()));
        let (mut fastest, mut largest) = (0.0f64, 0.0f64);
        for (&body, before) in region.bodies.iter().zip(before) {
            let flyer = self.flyer(body);
            let after = flyer.unwound_at(self.now);
            let moved = after.velocity.distance(before.velocity);
            let turned = (after.angular_velocity - before.angular_velocity).abs();
            fastest = fastest.max(moved + turned * flyer.reach());
            let Body { inverse_mass, inverse_moment, .. } = *flyer.body();
            largest = largest.max(moved / inverse_mass).max(turned / (inverse_moment * flyer.reach()));
        }
        fastest <= MODEST * stopped && impulse <= MOST_CANCELLING * largest
    }

    /// True if the contacts of a region that are marked as bilateral rest, and no other closes.
    fn has_stopped(&self, region: &Region) -> bool {
        let rest = self.rest_speed();
        let mut contacts = region.records.iter().filter(|record| record.parties.primary.site.is_some());
        contacts.all(|record| {
            let rate = record.motion.normal_velocity;
            rate >= -rest && (rate <= rest || !record.parties.bilateral)
        })
    }

    /// Measures gaps and rates of the touching features of a region at the present time.
    pub(crate) fn measure_touches(&self, region: &mut Region) {
        let Region { touches, motions, .. } = region;
        motions.clear();
        motions.extend(touches.iter().map(|&touch| self.gap_at(touch, self.now)));
    }

    /// Notes the least gap of features of a region that lie opposite each other: beyond their ends a gap is no distance
    /// between bodies.
    fn note_gaps(&mut self, region: &Region) {
        for (&touch, &(gap, _)) in region.touches.iter().zip(&region.motions) {
            if self.counts.smallest_gap.is_some_and(|least| least <= gap) {
                continue;
            }
            let [a, b] = self.features_in(touch);
            let pose = touch.bodies.map(|body| self.flyer(body).moving_at(self.now).pose);
            let is_opposite = |sample: GapSample| {
                sample.excess_primary.max(sample.excess_normal).max(sample.overrun) <= 0.0
            };
            if GapSample::measure(a, &pose[0], b, &pose[1]).is_some_and(is_opposite) {
                self.counts.note_gap(gap);
            }
        }
    }

    /// Gap [m] and rate [m/s] at a time of the contact, rope or stop that fires an event; `None` for other causes.
    pub(super) fn gap_of_cause(&self, cause: Cause, time: Time) -> Option<(f64, f64)> {
        match cause {
            Cause::Fired(touch) => Some(self.gap_at(touch, time)),
            Cause::Taut(id) => {
                let sample = self.measure_connector(id, 0, time);
                Some((sample.gap, sample.kinematics.rate))
            }
            _ => None,
        }
    }

    fn features_in(&self, Touch { bodies, features }: Touch) -> [&Feature; 2] {
        [0, 1].map(|side: usize| self.flyer(bodies[side]).body().shape.feature(features[side]))
    }

    /// Gap [m] and rate [m/s] of two features at a time, also beyond their ends; without end where there is none.
    pub(crate) fn gap_at(&self, touch: Touch, time: Time) -> (f64, f64) {
        let moving = touch.bodies.map(|body| self.flyer(body).moving_at(time));
        let [a, b] = self.features_in(touch);
        let Some(sample) = GapSample::measure_unbounded(a, &moving[0].pose, b, &moving[1].pose) else {
            return (f64::INFINITY, 0.0);
        };
        let (primary, normal) = if sample.primary_is_a { (0, 1) } else { (1, 0) };
        (sample.gap, GapKinematics::of(&sample, &moving[primary], &moving[normal]).rate)
    }

    /// Books the change of energy of an impact in the ledger.
    pub(crate) fn book_impact(&mut self, report: &ImpactReport, booking: Booking) {
        let fastest = fastest_row(report, true);
        let is_capture = booking == Booking::Capture || fastest <= self.settings.tolerances.velocity_tol;
        let booked = if is_capture { &mut self.ledger.captures } else { &mut self.ledger.impacts };
        *booked += report.energy_change;
        self.note_kinetic_energy_before(report);
    }
}

/// Largest rate [m/s] that an impact has stopped: of rows that closed and, `with_connectors`, of connectors, whichever
/// way they moved. A corner of a rail that turns to either side is an impact.
fn fastest_row(report: &ImpactReport, with_connectors: bool) -> f64 {
    let stopped = report.rows.iter().map(|row| match row.collision.parties.bilateral {
        true if with_connectors => row.rate_before.abs(),
        true => 0.0,
        false => -row.rate_before,
    });
    stopped.fold(0.0, f64::max)
}

/// Removes the marks as bilateral from the contacts of a region.
fn unmark(region: &mut Region) {
    for record in &mut region.records {
        record.parties.bilateral = record.parties.primary.site.is_none() && record.parties.bilateral;
    }
}
