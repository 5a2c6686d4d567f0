//! Settings of a system: how contacts are judged, impacts resolved, and motions integrated.

use crate::ode::Method;
use crate::rigid::remedies::RemedySet;
use halfgap_collision::{SearchSettings, Tolerances};
use halfgap_contact::{ImpactLaw, ImpactOrder, Restitution};

/// Settings of a system: how contacts are judged, impacts resolved, and motions integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct RigidSettings {
    /// Thresholds of touching.
    pub tolerances: Tolerances,
    /// Impact law.
    pub impact_law: ImpactLaw,
    /// Order in which serial impact laws take the rows.
    pub order: ImpactOrder,
    /// What elasticity means where there is friction.
    pub restitution: Restitution,
    /// True if bodies collide; false if they pass through each other.
    pub collisions: bool,
    /// Limits of the search for contacts.
    pub search: SearchSettings,
    /// Integrator of bodies that are not in free flight.
    pub method: Method,
    /// Choice of the integrator's steps.
    pub steps: StepControl,
    /// True if the ends of steps are moved onto the active rows, in position and velocity.
    pub projection: bool,
    /// Accelerations against the errors of active rows; `None` for none.
    pub extra: Option<ExtraAcceleration>,
    /// Time [s] after which sunk contacts are put back, if contacts carry impulses only; `None` if they carry forces.
    /// Connectors carry forces either way.
    pub impulse_step: Option<f64>,
    /// True if the velocities of connectors are made to fit at the ends of steps where `projection` is false.
    pub joint_small_impacts: bool,
    /// Rows with |rate| up to this [m/s] are at rest. Must exceed the rounding of a solve, but lie far below any
    /// approach speed that counts: two rows that oppose each other at a small angle stop a body that slides between
    /// them, if both are taken to rest.
    pub rest_speed: f64,
    /// Time [s] in which forces produce `velocity_tol`, or move a body through half of the target zone, whichever is
    /// longer. Bodies with more events than allowed within it are stopped without elasticity (an accumulation).
    pub resolution_time: f64,
    /// Steps of regions whose events accumulate; `None` if all events are handled one by one.
    pub region_steps: Option<RegionSteps>,
    /// Remedies that are switched off, for tests of what they are for.
    pub without: RemedySet,
}

/// Steps of a region whose events accumulate beyond its budget: what lies within them is not told apart.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct RegionSteps {
    /// Length [s] of a step: the resolution time of the region.
    pub span: f64,
    /// Way [m] that forces move a body from rest within a step; what a step may be off.
    pub slack: f64,
    /// Speed [m/s] that forces give a body in a step, or that of a slow contact where there are none.
    pub slow: f64,
}

/// Control of the steps of groups: their acceptable errors and their bound.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct StepControl {
    /// Error that one step may make, relative to `length` and to the speed of the group.
    pub local_error: f64,
    /// Length [m] to which errors of position are relative.
    pub length: f64,
    /// Speed [m/s] to which errors of velocity are relative in a group that is at rest.
    pub speed: f64,
    /// Upper bound [s] of steps, and the very length of all steps of a method without error estimate; `None` for no
    /// bound.
    pub largest_step: Option<f64>,
}

/// Correction of drift by an additional acceleration of each active gap: an older remedy, kept for scenes recorded with
/// it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct ExtraAcceleration {
    /// Time constant [s] of the decay: critically damped for gaps, if they are corrected; else exponential for their
    /// rates.
    pub time: f64,
    /// Corrects the gaps too, not only their rates.
    pub distance: bool,
    /// Corrects bilateral rows only.
    pub joints_only: bool,
}

impl ExtraAcceleration {
    /// Acceleration [m/s^2] that is added to a gap's own, for a gap too large by `gap` [m] that grows at `rate` [m/s].
    ///
    /// Not inlined: in a loop over rows the compiler would compute with `time` even where there is no correction, and
    /// the memory then often holds a denormal number, with which arithmetic is slow.
    #[inline(never)]
    pub(crate) fn acceleration(&self, gap: f64, rate: f64) -> f64 {
        if self.distance {
            (2.0 * rate * self.time + gap) / (self.time * self.time)
        } else {
            rate / self.time
        }
    }
}
