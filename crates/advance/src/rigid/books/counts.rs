//! Counts and extremes of a system since its start.

/// Counts and extremes of a system since its start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Counts {
    /// Segments started: flights of bodies, and steps of groups.
    pub segments: u64,
    /// Events handled, of all kinds.
    pub events: u64,
    /// Impacts resolved, each contact that came fast within a step of a region counted as one.
    pub impacts: u64,
    /// Times that an event cut the motion of a body short, in flight or in a group.
    pub backups: u64,
    /// Complementarity problems solved, and solves for the forces of active rows.
    pub contact_solves: u64,
    /// Evaluations of forces by the integrator.
    pub evaluations: u64,
    /// Accumulations of impacts that were ended without elasticity.
    pub accumulations: u64,
    /// Steps of regions whose events accumulated.
    pub region_steps: u64,
    /// Jumps of velocities where contacts that slip had no forces.
    pub jams: u64,
    /// Smallest gap [m] seen, negative for overlap; `None` if none was measured.
    pub smallest_gap: Option<f64>,
    /// Largest error of a connector's gap [m] seen; `None` if none was measured.
    pub largest_connector_error: Option<f64>,
    /// Largest kinetic energy [J] seen: of a group at the end of a step, or of the bodies of an impact before it.
    pub largest_kinetic_energy: f64,
}

impl Counts {
    pub(crate) fn note_gap(&mut self, gap: f64) {
        self.smallest_gap = Some(self.smallest_gap.map_or(gap, |least| least.min(gap)));
    }

    pub(crate) fn note_connector_error(&mut self, error: f64) {
        self.largest_connector_error =
            Some(self.largest_connector_error.map_or(error, |most| most.max(error)));
    }
}
