//! Connectors in the region of an event.

use super::region::Region;
use super::rows::RowSource;
use super::system::RigidSystem;
use crate::time::Time;
use halfgap_collision::Collision;

impl RigidSystem {
    /// Adds the records of the connectors of a body of the region.
    pub(crate) fn collect_connectors(&self, region: &mut Region, place: usize, time: Time) {
        let _ = (region, place, time);
    }

    pub(crate) fn source_of(&self, record: &Collision) -> RowSource {
        RowSource::Contact([record.parties.primary.feature, record.parties.normal.feature])
    }
}
