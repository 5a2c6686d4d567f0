//! Candidates that an event excludes from the active set without asking for their force, each with the reason.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::region::touching::Region;

/// Why a candidate is excluded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exclusion {
    /// The forces of the candidates jam, and it is beyond its target gap: it need not be in contact.
    Distant,
    /// It acts by next to no lever; it may come as near as contacts near a dead point.
    Leverless,
}

/// An excluded candidate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Excluded {
    /// Index of its record in the region.
    pub(super) record: usize,
    pub(super) touch: Option<Touch>,
    pub(super) why: Exclusion,
}

impl Excluded {
    /// A record of a region, by its index there.
    pub(super) fn of(region: &Region, record: usize, why: Exclusion) -> Self {
        Self { record, touch: Touch::of(&region.records()[record]), why }
    }
}

impl Settling {
    /// Admits again the records excluded as distant that are wanted as candidates; true if there are any.
    pub(super) fn readmit_distant(&mut self, is_wanted: impl Fn(usize) -> bool) -> bool {
        let before = self.excluded.len();
        let Self { candidates, excluded, .. } = self;
        excluded.retain(|&Excluded { record, why, .. }| {
            let is_wanted = why == Exclusion::Distant && is_wanted(record);
            candidates.extend(is_wanted.then_some(record));
            !is_wanted
        });
        candidates.sort_unstable();
        excluded.len() < before
    }

    /// True if any record is excluded for a reason.
    pub(super) fn any_excluded(&self, why: Exclusion) -> bool {
        self.excluded.iter().any(|excluded| excluded.why == why)
    }

    /// True if a contact is excluded for a reason.
    pub(crate) fn is_excluded(&self, touch: Touch, why: Exclusion) -> bool {
        self.excluded.iter().any(|excluded| excluded.touch == Some(touch) && excluded.why == why)
    }
}
