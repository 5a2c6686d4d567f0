//! Why an event is handled, and the buffers of doing so.

use super::impacts::ImpactReport;
use super::region::{Region, Touch};
use super::ticks::Lift;
use crate::rigid::held::settling::Settling;
use crate::rigid::system::RigidSystem;
use halfgap_collision::{BodyId, BodyState, ConnectorId};
use halfgap_contact::Impact;

/// Why an event is handled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Cause {
    /// Nothing has happened yet: what rests within `distance_tol` counts as touching.
    Start,
    /// A contact fires: it takes part, however near it is to the ends of its features.
    Fired(Touch),
    /// A rope goes taut, or the point of a rail comes to its stop.
    Taut(ConnectorId),
    /// A contact has run off its features: its neighbours take over, if they touch.
    RunOff(Touch),
    /// A contact has lost its force: what is found of it again may be what others were moved by meanwhile.
    Released(Touch),
    /// What has sunk is put back, where contacts carry impulses only.
    Tick,
    /// A point on a rail goes over a smooth joint, where what stops connectors is rounding and no impact.
    SmoothJoint,
    /// None of these: a corner of a rail, a force law, somebody outside.
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
    /// States of bodies to go back to: before contacts were stopped as bilateral ones, or groups were cut.
    pub(crate) before: Vec<BodyState>,
    /// How contacts were stopped as bilateral ones.
    pub(crate) stop: ImpactReport,
    pub(super) lift: Lift,
    /// How often the pair that fired has done so without time going by, beyond what is calm.
    pub(super) repeats: u32,
    /// The contact that fired does not close: the search takes its rounding for motion.
    pub(super) fired_open: bool,
}

impl RigidSystem {
    /// Handles an event, with the buffers for it.
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
