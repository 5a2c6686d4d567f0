//! Settings of a world: accuracy, thresholds of touching, impact law, integrator.

use halfgap_advance::rigid::RemedySet;
use halfgap_contact::{ImpactLaw, ImpactOrder, Restitution};

/// Default of [`WorldSettings::tolerance`] [-].
pub const DEFAULT_TOLERANCE: f64 = 1e-8;
/// Longest step [s] of those that are chosen by a tolerance: what a force law does in less than two of them is not seen.
pub const LONGEST_STEP: f64 = 1.0 / 60.0;
/// Default length [s] of fixed steps.
const DEFAULT_FIXED_STEP: f64 = 0.025;

/// Thresholds of touching, each given instead of being derived from the tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToleranceOverrides {
    /// Gap [m] at which an approaching pair fires.
    pub target_gap: Option<f64>,
    /// Half-width [m] of the target zone, less than the target gap.
    pub accuracy: Option<f64>,
    /// Normal speed [m/s] below which bodies that meet come into contact without an impact.
    pub velocity_tol: Option<f64>,
}

/// How a world advances.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AdvanceBy {
    /// Each event at its own time.
    #[default]
    Events,
    /// Steps, in which contacts are problems of velocities: with friction, and for piles.
    Steps {
        /// Length of the steps [s]; if `None`, it is chosen, up to [`LONGEST_STEP`], so that the ways of bodies in two steps are off by no
        /// more than `residual` times the radius of the smallest movable body, as far as one step of twice the length can tell.
        step: Option<f64>,
        /// Rate that sweeps over large islands may leave, as a fraction of the speed that forces give in a step [-].
        residual: f64,
    },
}

/// Settings of a world, fixed when it is built.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldSettings {
    /// Time at the start [s].
    pub start_time: f64,
    /// Planned length of the run [s]; lets hopelessly short steps end in [`RunError::Crawls`](crate::RunError::Crawls).
    /// The longer of this and the present `advance_to` counts.
    pub duration: Option<f64>,
    /// Relative accuracy asked for [-], above 0 and at most 1.
    pub tolerance: f64,
    /// How the world advances.
    pub strategy: AdvanceBy,
    /// What elasticity means where there is friction.
    pub restitution: Restitution,
    /// Typical speed [m/s] of the world, for worlds whose start does not show it: thresholds and errors of
    /// velocity are relative to it, or to the speed that the start shows if that is higher.
    pub usual_speed: Option<f64>,
    /// Thresholds given in place of derived ones.
    pub overrides: ToleranceOverrides,
    /// Largest overlap of two bodies that is accepted at the start [m]; 1e-6 of the smallest movable body's radius if
    /// `None`.
    pub start_overlap: Option<f64>,
    /// The impact law.
    pub impact_law: ImpactLaw,
    /// The order in which the serial impact laws take the rows.
    pub impact_order: ImpactOrder,
    /// Whether bodies collide; if false, they pass through each other.
    pub collisions: bool,
    /// Whether contacts carry forces. If false, they carry impulses only: a slow pair gets an inelastic impulse and is
    /// put back to the target gap once a step. Connectors carry forces all the same.
    pub contacts: bool,
    /// Integrator of motion that has no closed form.
    pub integrator: Integrator,
    /// Largest step [s], or the length of fixed steps; see [`WorldSettings::fixed_step`].
    pub time_step: Option<f64>,
    /// Method that keeps contacts and connectors from drifting.
    pub stabilization: Stabilization,
    /// Whether small impulses, too, keep connectors together.
    pub joint_small_impacts: bool,
    /// Largest error of a connector that is accepted at the start [m]; 1e-6 of the smallest movable body's radius if
    /// `None`.
    pub start_connector_error: Option<f64>,
    /// Remedies of the advance that are switched off: for tests of what each is for.
    pub without: RemedySet,
}

/// Integrator of motion under forces, where it has no closed form.
///
/// With the adaptive ones, a group of coupled bodies whose forces are stiff goes over to implicit steps on its own
/// (Radau IIA of order 5), as long as these cost less; groups whose state has more than 600 numbers (100 free bodies)
/// do not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "scene", derive(serde::Deserialize, serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Integrator {
    /// Dormand and Prince, order 8, adaptive. Between events that follow each other fast, and along rails through
    /// points, whose curvature has a kink at each, [`Integrator::DormandPrince5`] takes its place.
    #[default]
    Dop853,
    /// Dormand and Prince, order 5, adaptive.
    DormandPrince5,
    /// The classical Runge-Kutta method, order 4, fixed steps.
    Rk4,
    /// Modified Euler method, order 2, fixed steps.
    ModifiedEuler,
    /// Explicit Euler method, order 1, fixed steps.
    Euler,
}

impl Integrator {
    /// Returns true if the steps have a given length, false if the integrator chooses it from their error.
    #[must_use]
    pub fn has_fixed_step(self) -> bool {
        match self {
            Self::Dop853 | Self::DormandPrince5 => false,
            Self::Rk4 | Self::ModifiedEuler | Self::Euler => true,
        }
    }
}

/// Method that keeps contacts and connectors from drifting off their target gaps.
///
/// With the extra accelerations of the velocity policies, errors of rates decay with a time constant of one step, those of
/// gaps as well, critically damped. So the motion depends on the step, and errors fall with a lower power of it than the
/// order of the integrator: with [`Integrator::Rk4`] with the third power (velocity) or the second (velocity and distance).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "scene", derive(serde::Deserialize, serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Stabilization {
    /// The state at the end of each step is projected onto the active contacts and connectors.
    #[default]
    Projection,
    /// No stabilization.
    None,
    /// Extra acceleration against velocity errors of contacts and connectors.
    Velocity,
    /// Extra acceleration against velocity errors of connectors only.
    VelocityJoints,
    /// Extra acceleration against velocity and distance errors of contacts and connectors.
    VelocityAndDistance,
    /// Extra acceleration against velocity and distance errors of connectors only.
    VelocityAndDistanceJoints,
}

impl Stabilization {
    /// Returns true for the policies that add accelerations, whose size depends on the step.
    #[must_use]
    pub fn depends_on_step(self) -> bool {
        !matches!(self, Self::Projection | Self::None)
    }
}

impl WorldSettings {
    /// Returns the length [s] of the steps if it is fixed: by the integrator, because contacts carry impulses only, or
    /// because the stabilization depends on it. Integrators without fixed steps of their own take no longer ones, but shorter
    /// ones where errors ask for it.
    #[must_use]
    pub fn fixed_step(&self) -> Option<f64> {
        let is_fixed =
            self.integrator.has_fixed_step() || !self.contacts || self.stabilization.depends_on_step();
        is_fixed.then(|| self.time_step.unwrap_or(DEFAULT_FIXED_STEP))
    }
}

impl Default for WorldSettings {
    fn default() -> Self {
        Self {
            start_time: 0.0,
            duration: None,
            tolerance: DEFAULT_TOLERANCE,
            strategy: AdvanceBy::default(),
            restitution: Restitution::default(),
            usual_speed: None,
            overrides: ToleranceOverrides::default(),
            start_overlap: None,
            impact_law: ImpactLaw::default(),
            impact_order: ImpactOrder::default(),
            collisions: true,
            contacts: true,
            integrator: Integrator::default(),
            time_step: None,
            stabilization: Stabilization::default(),
            joint_small_impacts: false,
            start_connector_error: None,
            without: RemedySet::NONE,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_is_fixed_where_something_depends_on_it() {
        let settings = WorldSettings::default();
        assert_eq!(settings.fixed_step(), None);
        assert_eq!(WorldSettings { time_step: Some(0.1), ..settings.clone() }.fixed_step(), None);
        assert_eq!(WorldSettings { contacts: false, ..settings.clone() }.fixed_step(), Some(0.025));
        let euler = WorldSettings { integrator: Integrator::Euler, time_step: Some(0.1), ..settings.clone() };
        assert_eq!(euler.fixed_step(), Some(0.1));
        let none = WorldSettings { stabilization: Stabilization::None, ..settings.clone() };
        assert_eq!(none.fixed_step(), None);
        let velocity = WorldSettings { stabilization: Stabilization::VelocityJoints, ..settings };
        assert_eq!(velocity.fixed_step(), Some(0.025));
    }
}
