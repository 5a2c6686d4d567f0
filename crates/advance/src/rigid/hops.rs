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
        let (rate, back) = (record.motion.normal_velocity, -free_offset(region, record, stage));
        back > 0.0 && rate * rate <= 2.0 * back * HOP_SHARE * record.tolerances.accuracy
    }

    /// Stops the held contacts that open, in no more than a low hop; true if there are any.
    pub(crate) fn still_hops(&mut self, work: &mut EventWork) -> bool {
        let rest = self.rest_speed();
        let records = &mut work.region.records;
        work.hopping.clear();
        work.hopping.extend(work.settling.held.iter().map(|&(index, _)| index));
        work.hopping.retain(|&index| {
            !records[index].parties.bilateral && records[index].motion.normal_velocity > rest
        });
        if work.hopping.is_empty() {
            return false;
        }
        work.hopping.iter().for_each(|&index| records[index].parties.bilateral = true);
        self.stop_bilaterally(work);
        true
    }
}
