//! Buffers of the least displacement that moves bodies apart.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::region::touching::Region;
use halfgap_contact::Problem;

/// Buffers of the least displacement that moves bodies apart.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lift {
    pub(super) problem: Problem,
    /// Index of the record of each row of the problem.
    pub(super) rows: Vec<usize>,
    /// Whether each record of the region belongs to an active row.
    pub(super) active: Vec<bool>,
    /// Displacement (x, y, angle) of each body of the region [m, m, rad].
    pub(super) shifts: Vec<[f64; 3]>,
}

impl Lift {
    /// Sets the displacements to those of the solution of the problem.
    pub(super) fn find_shifts(&mut self, assembly: &Assembly, region: &Region, settling: &Settling) {
        self.shifts.clear();
        self.shifts.resize(region.bodies().len(), [0.0; 3]);
        settling.add_responses(region, &self.rows, |body| assembly.inertia(body), &mut self.shifts);
    }
}
