//! The ledger of energy: its changes in events and steps, by cause.

use crate::rigid::group::state::Work;

/// Changes of energy [J] since the start by cause, each negative where energy was lost.
#[derive(Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Ledger {
    /// Impacts with elasticity.
    pub impacts: f64,
    /// Slow closing contacts that were brought to rest, and accumulations of impacts that were ended without elasticity.
    pub captures: f64,
    /// Projections onto active rows.
    pub projections: f64,
    /// Steps of regions whose events accumulated.
    pub steps: f64,
    /// Velocity changes by the caller, see [`RigidSystem::intervene`].
    pub interventions: f64,
    /// Work of damping.
    pub damping: f64,
    /// Jumps of velocities where contacts that slip have no forces.
    pub jams: f64,
    /// Friction in impacts and captures: what of them is no loss by elasticity.
    pub impact_friction: f64,
    /// Work of friction while contacts slip: the heat, negative.
    pub friction: f64,
    /// Work of surfaces that run on what they touch.
    pub surfaces: f64,
    /// Work of drives, of motors, and of bodies that are moved.
    pub drives: f64,
    /// Work of each force law that has no potential, in the order of [`RigidSystem::laws`]; 0 for the others.
    pub force_laws: Vec<f64>,
}

impl Clone for Ledger {
    fn clone(&self) -> Self {
        Self { force_laws: self.force_laws.clone(), ..*self }
    }

    /// Uses the buffer again.
    fn clone_from(&mut self, source: &Self) {
        let mut force_laws = std::mem::take(&mut self.force_laws);
        force_laws.clone_from(&source.force_laws);
        *self = Self { force_laws, ..*source };
    }
}

impl Ledger {
    pub(crate) fn book(&mut self, work: Work, value: f64) {
        match work {
            Work::Law(law) => self.force_laws[law] += value,
            Work::Damping => self.damping += value,
            Work::Friction(_) | Work::Rubbing => self.friction += value,
            Work::Surfaces => self.surfaces += value,
            Work::Drives => self.drives += value,
        }
    }
}
