//! Hops too low to be told from contact: a contact opens so slowly that what acts on its bodies brings it
//! back before it has opened by much. Such a contact is held at once, instead of being caught again a moment
//! later.
//!
//! A hop takes T = 2 v/|a|, and what it lands with is stopped: it stays within the target zone. If the row's
//! coefficients and its acceleration a are constant meanwhile, a contact that is stopped when it opens comes
//! to the same places and velocities at T. So a hop may be the higher the less its bodies move in T, up to
//! the half-width of the target zone.

use super::bounces::closes_fast;
use crate::rigid::event::cause::EventWork;
use crate::rigid::event::events::Booking;
use crate::rigid::event::region::Region;
use crate::rigid::system::RigidSystem;
use halfgap_collision::{BodyId, Collision};

/// Part of the accuracy by which a contact may open and come back, and count as closed all the while.
const HOP_SHARE: f64 = 1e-4;
/// The same of a hop in which nothing moves much.
const SHORT_HOP_SHARE: f64 = 0.5;
/// Angle [rad] by which bodies may turn in such a hop, and the part of their reach by which they may slide;
/// more where that is less than the same share of the accuracy, which is all that is asked of where they are.
const HOP_TURN: f64 = 1e-4;

/// A hop that comes down may make others hop: all of them together take no more than so many times the longest.
const HOPS_IN_TURN: f64 = 10.0;

impl RigidSystem {
    /// True if a contact of a region opens so slowly that it may be no more than a low hop. Of a contact
    /// without others it is told how long it bounces: that is stopped when it lands.
    pub(crate) fn may_hop(&self, region: &Region, record: &Collision) -> bool {
        let is_slow = record.motion.normal_velocity <= record.tolerances.velocity_tol;
        self.opens(record) && (region.records.len() > 1 || is_slow)
    }

    /// True if a contact that opens with an acceleration [m/s^2] of its gap comes back before it has opened by much.
    pub(crate) fn is_low_hop(&self, record: &Collision, acceleration: f64) -> bool {
        let rate = record.motion.normal_velocity;
        let accuracy = record.tolerances.accuracy;
        let is_within = |share: f64| rate * rate <= -2.0 * acceleration * share * accuracy;
        let is_short = || {
            let bodies = record.bodies();
            let turn = HOP_TURN.max(SHORT_HOP_SHARE * accuracy / self.largest_reach(bodies));
            2.0 * rate * self.turning(record) <= -acceleration * turn
        };
        acceleration < 0.0 && (is_within(HOP_SHARE) || (is_within(SHORT_HOP_SHARE) && is_short()))
    }

    /// How fast [1/s] the bodies of a contact turn, and slide by their reach.
    fn turning(&self, record: &Collision) -> f64 {
        let of_body = |body: BodyId| {
            if body.is_world() {
                return 0.0;
            }
            let flyer = self.flyer(body);
            let sliding =
                if flyer.body().is_fixed() { 0.0 } else { record.motion.lateral_velocity / flyer.reach() };
            sliding.abs() + flyer.moving_at(self.now).angular_velocity.abs()
        };
        let parties = &record.parties;
        record.geometry.normal_rate.length() + of_body(parties.primary.body) + of_body(parties.normal.body)
    }

    /// Reach [m] of the larger of the movable ones of two bodies.
    pub(crate) fn largest_reach(&self, bodies: [BodyId; 2]) -> f64 {
        let movable = bodies.into_iter().filter(|&body| self.is_movable(body));
        movable.fold(0.0, |most, body| most.max(self.flyer(body).reach()))
    }

    /// True if a contact opens.
    fn opens(&self, record: &Collision) -> bool {
        !record.parties.bilateral && record.motion.normal_velocity > self.rest_speed()
    }

    /// True if any held contact opens.
    pub(crate) fn any_held_hops(&self, work: &EventWork) -> bool {
        let records = &work.region.records;
        work.settling.held.iter().any(|&(index, _)| self.opens(&records[index]))
    }

    /// Brings the bodies of held contacts that open in low hops to the velocities with which they will have
    /// landed, and lets those leave that open all the same. False if nothing is changed.
    ///
    /// The forces at which contacts are held say what impulses they carry until then. Without these the hops
    /// come down, and an impact without elasticity gives as much of them back as is needed. So contacts are
    /// stopped by no more than what presses on them: where normals hardly differ, large impulses that cancel
    /// each other would stop whatever slides over them, too.
    pub(crate) fn still_hops(&mut self, work: &mut EventWork) -> bool {
        // At the start there may be blows to come, which are not to be stopped along with the rest.
        if work.region.records.iter().any(closes_fast) {
            return false;
        }
        let Some(wait) = self.time_of_hops(work) else { return false };
        let EventWork { region, impact, settling, carried, stop, .. } = &mut *work;
        carried.clear();
        carried.resize(region.records.len(), 0.0);
        for &(index, _) in &settling.held {
            let record = &region.records[index];
            carried[index] = if record.parties.bilateral { 0.0 } else { force_of(record) * wait };
        }
        self.set_rows(region, impact);
        impact.unload(carried);
        if impact.try_inelastic().is_err() {
            return false;
        }
        self.conclude_impact(region, impact, stop, self.now);
        self.remeasure(region, self.now);
        self.book_impact(stop, Booking::Capture);
        settling.let_leave(|index| {
            let record = &region.records[index];
            self.opens(record) && !self.stays_in_corner(record)
        });
        true
    }

    /// How long [s] it takes until what hops is at rest, one after another; `None` if none of those that open
    /// comes down by itself.
    fn time_of_hops(&self, work: &EventWork) -> Option<f64> {
        let records = &work.region.records;
        let held = work.settling.held.iter().map(|&(index, _)| &records[index]);
        let times = held.filter(|record| self.opens(record)).filter_map(|record| {
            let rate = record.motion.normal_velocity;
            let row = self.row_of(record);
            // All forces together leave its gap as it is: without its own it closes.
            let closing = force_of(record) * row.coupling(&row);
            self.is_low_hop(record, -closing).then(|| 2.0 * rate / closing)
        });
        times.max_by(f64::total_cmp).map(|time| HOPS_IN_TURN * time)
    }
}

/// Force [N] at which a contact is held.
fn force_of(record: &Collision) -> f64 {
    record.response.force.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::rigid::test_scene::resting_discs;
    use halfgap_collision::BodyId;

    #[test]
    fn bodies_may_move_in_a_hop_by_as_much_as_is_asked_of_where_they_are() {
        const GRAVITY: f64 = 9.81;
        let mut system = resting_discs(&[0.0]);
        let mut work = system.work.take().expect("the start has made it");
        system.dissolve(BodyId(1));
        system.collect_region(&mut work.region, &[BodyId(1)], system.now);
        let [record] = &mut work.region.records[..] else { panic!("one disc, one contact") };
        // It is down again after 1 ms.
        record.motion.normal_velocity = 5e-4 * GRAVITY;
        for (accuracy, slide, is_low) in
            [(1e-4, 1e-5, true), (1e-4, 1e-4, false), (1e-3, 1e-4, true), (1e-3, 1e-3, false)]
        {
            record.motion.lateral_velocity = slide / 1e-3;
            record.tolerances.accuracy = accuracy;
            assert_eq!(system.is_low_hop(record, -GRAVITY), is_low, "{slide} m of {accuracy} m");
        }
    }
}
