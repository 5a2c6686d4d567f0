//! Where energy went, as far as events and steps know.

/// Changes of energy [J] since the start, each negative where energy was lost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Impacts with elasticity.
    pub impacts: f64,
    /// Slow closing contacts that were brought to rest, and storms of impacts that were ended.
    pub captures: f64,
    /// Projections onto held rows.
    pub projections: f64,
    /// What somebody outside did by changing velocities.
    pub interventions: f64,
    /// Work of damping.
    pub damping: f64,
    /// Work of each force law that has no potential, in their order; 0 for the others.
    pub laws: Vec<f64>,
}
