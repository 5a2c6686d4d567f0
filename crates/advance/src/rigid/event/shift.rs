//! Buffers of the least displacement that moves bodies apart.

use halfgap_contact::Problem;

/// Buffers of the least displacement that moves bodies apart.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lift {
    pub(super) problem: Problem,
    /// Index of the record of each row of the problem.
    pub(super) rows: Vec<usize>,
    /// Displacement (x, y, angle) of each body of the region [m, m, rad].
    pub(super) shifts: Vec<[f64; 3]>,
}
