//! The cause of an event, and the buffers of its handling.

use super::impacts::ImpactReport;
use super::region::{Region, Touch};
use super::ticks::Lift;
use crate::rigid::held::settling::Settling;
use crate::rigid::system::RigidSystem;
use halfgap_collision::{BodyId, BodyState, ConnectorId};
use halfgap_contact::Impact;

/// Cause of an event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Cause {
    /// The start: contacts at rest within `distance_tol` count as touching.
    Start,
    /// A contact fires: it takes part, however near it is to the ends of its features.
    Fired(Touch),
    /// A rope goes taut, or the point of a rail comes to its stop.
    Taut(ConnectorId),
    /// A contact has run off its features: its neighbours take over, if they touch.
    RunOff(Touch),
    /// A contact has lost its force: a small force found on it now may come from the motion of other bodies meanwhile.
    Released(Touch),
    /// Sunk contacts are put back, where contacts carry impulses only.
    Tick,
    /// The point of a rail goes over a smooth joint: velocities stopped by its connectors are rounding, not an impact.
    SmoothJoint,
    /// Any other cause: a corner of a rail, a force law, an intervention of the caller.
    #[default]
    Other,
}

impl Cause {
    /// The contact that fired, if one did.
    pub(crate) fn fired(self) -> Option<Touch> {
        if let Self::Fired(touch) = self { Some(touch) } else { None }
    }

    /// The contact that has run off its features, if one has.
    pub(crate) fn run_off(self) -> Option<Touch> {
        if let Self::RunOff(touch) = self { Some(touch) } else { None }
    }
}

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

impl RigidSystem {
    /// Runs an action on an event of the given cause, with the buffers of events.
    pub(crate) fn with_work<T>(
        &mut self,
        cause: Cause,
        act: impl FnOnce(&mut Self, &mut EventWork) -> T,
    ) -> T {
        let mut work = self.work.take().unwrap_or_default();
        work.region.cause = cause;
        let outcome = act(self, &mut work);
        (work.region.cause, work.region.in_storm) = (Cause::Other, false);
        (work.repeats, work.fired_open) = (0, false);
        self.work = Some(work);
        outcome
    }
}
