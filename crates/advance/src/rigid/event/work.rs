//! The buffers of an event.

use crate::rigid::books::report::ImpactReport;
use crate::rigid::event::shift::Lift;
use crate::rigid::held::settling::Settling;
use crate::rigid::region::touching::Region;
use halfgap_collision::{BodyId, BodyState};
use halfgap_contact::Impact;

/// Buffers of the handling of events, kept from one to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct EventWork {
    pub(crate) region: Region,
    pub(crate) impact: Impact,
    pub(crate) settling: Settling,
    pub(crate) seeds: Vec<BodyId>,
    /// Impulses that the contacts of the region carry until its low hops have come down [N s].
    pub(crate) carried: Vec<f64>,
    /// States of bodies to restore, from before contacts were stopped as bilateral ones or groups were cut.
    pub(crate) before: Vec<BodyState>,
    /// Report of the last impact without elasticity that stopped contacts or stilled hops.
    pub(crate) stop: ImpactReport,
    pub(super) lift: Lift,
    /// Number of times, beyond `CALM_REPEATS`, that the pair that fired has done so without time going by.
    pub(super) repeats: u32,
    /// True if the contact that fired does not close: the search took its rounding for motion.
    pub(super) fired_open: bool,
}
