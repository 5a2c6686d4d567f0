//! The buffers of an event.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::books::report::ImpactReport;
use crate::rigid::event::shift::Lift;
use crate::rigid::region::touching::Region;
use crate::rigid::stepping::step::Stepper;
use crate::rigid::zeno::repeats::CALM_REPEATS;
use halfgap_collision::{BodyId, BodyState};
use halfgap_contact::Impact;

/// Buffers of the handling of events, kept from one to the next.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct EventWork {
    #[cfg_attr(feature = "save", serde(skip))]
    pub(crate) region: Region,
    pub(crate) impact: Impact,
    pub(crate) settling: Settling,
    #[cfg_attr(feature = "save", serde(skip))]
    pub(crate) seeds: Vec<BodyId>,
    /// Impulses that the contacts of the region carry until its low hops have come down [N s].
    #[cfg_attr(feature = "save", serde(skip))]
    pub(crate) carried: Vec<f64>,
    /// States of bodies to restore, from before contacts were stopped as bilateral ones or groups were cut.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(crate) before: Vec<BodyState>,
    /// Report of the last impact without elasticity that stopped contacts or stilled hops.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(crate) stop: ImpactReport,
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) lift: Lift,
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) stepper: Stepper,
    /// Number of times, beyond `CALM_REPEATS`, that the pair that fired has done so without time going by.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) repeats: u32,
    /// True if the contact that fired does not close: the search took its rounding for motion.
    #[cfg_attr(feature = "save", serde(skip))]
    pub(super) fired_open: bool,
}

impl EventWork {
    /// Sets the bodies from which the region of the event is collected.
    pub(crate) fn seed(&mut self, bodies: impl IntoIterator<Item = BodyId>) {
        self.seeds.clear();
        self.seeds.extend(bodies);
    }

    /// Sorts the bodies from which the region is collected, and leaves each there once.
    pub(crate) fn sort_seeds(&mut self) {
        self.seeds.sort_unstable();
        self.seeds.dedup();
    }

    /// Notes how many times the pair that fired has done so without time going by.
    pub(crate) fn note_repeats(&mut self, repeats: u32) {
        self.repeats = repeats.saturating_sub(CALM_REPEATS);
    }
}
