//! Hops too low to be told from contact: a contact opens so slowly that what acts on its bodies brings it back before it
//! has opened by much. Such a contact is held at once, instead of being caught again a moment later.

use super::dynamics::Stage;
use super::events::EventWork;
use super::region::Region;
use super::settle::free_offset;
use super::system::RigidSystem;
use halfgap_collision::Collision;

/// Part of the accuracy by which a contact may open and come back, and count as closed all the while.
const HOP_SHARE: f64 = 1e-4;

impl RigidSystem {
    /// True if a contact opens so slowly that it may be no more than a low hop.
    pub(crate) fn may_hop(&self, record: &Collision) -> bool {
        (0.0..=record.tolerances.velocity_tol).contains(&record.motion.normal_velocity)
    }

    /// True if what acts on the bodies of a contact that opens brings them back before it has opened by much.
    pub(crate) fn hops_low(&self, region: &Region, record: &Collision, stage: &Stage) -> bool {
        is_low_hop(record, free_offset(region, record, stage))
    }

    /// True if any held contact opens.
    pub(crate) fn any_held_hops(&self, work: &EventWork) -> bool {
        let records = &work.region.records;
        let mut held = work.settling.held.iter().map(|&(index, _)| &records[index]);
        held.any(|record| !record.parties.bilateral && record.motion.normal_velocity > self.rest_speed())
    }

    /// Stops the held contacts, all of them at once: what stops some only lets others open. False if they contradict each
    /// other.
    pub(crate) fn still_hops(&mut self, work: &mut EventWork) -> bool {
        let records = &mut work.region.records;
        work.stilled.clear();
        work.stilled.extend(work.settling.held.iter().map(|&(index, _)| index));
        work.stilled.retain(|&index| !records[index].parties.bilateral);
        work.stilled.iter().for_each(|&index| records[index].parties.bilateral = true);
        let is_stilled = self.stop_bilaterally(work);
        work.stilled.iter().for_each(|&index| work.region.records[index].parties.bilateral = false);
        is_stilled
    }
}

/// True if a contact that opens with an acceleration [m/s^2] of its gap comes back before it has opened by much.
pub(crate) fn is_low_hop(record: &Collision, acceleration: f64) -> bool {
    let rate = record.motion.normal_velocity;
    acceleration < 0.0 && rate * rate <= -2.0 * acceleration * HOP_SHARE * record.tolerances.accuracy
}
