//! How a world is to be simulated.

use halfgap_contact::{ImpactLaw, ImpactOrder};

/// Relative accuracy asked for unless said otherwise.
pub const DEFAULT_TOLERANCE: f64 = 1e-8;
/// The step [s] where it is fixed, unless said otherwise.
const DEFAULT_FIXED_STEP: f64 = 0.025;

/// Thresholds that the user gives in place of the derived ones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ToleranceOverrides {
    /// Gap [m] at which an approaching pair fires.
    pub target_gap: Option<f64>,
    /// Half-width [m] of the target zone.
    pub accuracy: Option<f64>,
    /// Normal speed [m/s] below which a collision is a contact.
    pub velocity_tol: Option<f64>,
}

/// How a world is to be simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldSettings {
    /// Time at the start [s].
    pub start_time: f64,
    /// How long the world will run [s], if that is known: steps that would never come to its end are told as
    /// an error. No less than a single advance asks for.
    pub duration: Option<f64>,
    /// Relative accuracy asked for.
    pub tolerance: f64,
    /// A speed [m/s] that is usual in the world, where its start does not tell: thresholds and errors of
    /// velocity are relative to it, or to what the start tells if that is more.
    pub usual_speed: Option<f64>,
    /// Thresholds given in place of derived ones.
    pub overrides: ToleranceOverrides,
    /// How deep bodies may overlap at the start [m]; 1e-6 of the smallest movable body's radius if `None`.
    pub start_overlap: Option<f64>,
    /// The impact law.
    pub impact_law: ImpactLaw,
    /// The order in which serial laws take the rows.
    pub impact_order: ImpactOrder,
    /// False if bodies pass through each other.
    pub collisions: bool,
    /// False if contacts carry impulses only: a slow pair then gets an inelastic impulse, and is put back to the target
    /// gap once a step. Connectors carry forces all the same.
    pub contacts: bool,
    /// How motion without a closed form is integrated.
    pub integrator: Integrator,
    /// Largest step [s], or the step where it is fixed; see [`WorldSettings::fixed_step`].
    pub time_step: Option<f64>,
    /// What keeps contacts and connectors from drifting.
    pub stabilization: Stabilization,
    /// Connectors are also kept together by small impulses.
    pub joint_small_impacts: bool,
    /// How far off connectors may be at the start [m]; 1e-6 of the smallest movable body's radius if `None`.
    pub start_connector_error: Option<f64>,
}

/// How motion under forces is integrated where it has no closed form.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Dormand and Prince, order 8, adaptive; where a higher order gains nothing, between events that come
    /// fast one after another and along rails through points, order 5 in its place.
    #[default]
    Dop853,
    /// Dormand and Prince, order 5, adaptive.
    DormandPrince5,
    /// The classical method of order 4, fixed steps.
    Rk4,
    /// Order 2, fixed steps.
    ModifiedEuler,
    /// Order 1, fixed steps.
    Euler,
}

impl Integrator {
    /// True if it does not choose its steps itself.
    #[must_use]
    pub fn has_fixed_step(self) -> bool {
        match self {
            Self::Dop853 | Self::DormandPrince5 => false,
            Self::Rk4 | Self::ModifiedEuler | Self::Euler => true,
        }
    }
}

/// What keeps contacts and connectors from drifting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stabilization {
    /// States are projected onto the constraints.
    #[default]
    Projection,
    /// Nothing.
    None,
    /// Extra acceleration against the velocity error of contacts and connectors.
    Velocity,
    /// The same, of connectors only.
    VelocityJoints,
    /// Extra acceleration against velocity and distance errors.
    VelocityAndDistance,
    /// The same, of connectors only.
    VelocityAndDistanceJoints,
}

impl Stabilization {
    /// True for the policies that add accelerations, whose size depends on the step.
    #[must_use]
    pub fn depends_on_step(self) -> bool {
        !matches!(self, Self::Projection | Self::None)
    }
}

impl WorldSettings {
    /// The step [s], if it is fixed: with an integrator that has no other, without contact forces, and where the
    /// stabilization depends on it.
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
