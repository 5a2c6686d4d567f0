//! Buffers of the least displacement that moves bodies apart.

use halfgap_contact::Problem;

/// Buffers of the least displacement that moves bodies apart.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lift {
    pub(crate) problem: Problem,
    /// Index of the record of each row of the problem.
    pub(crate) rows: Vec<usize>,
    /// Displacement (x, y, angle) of each body of the region [m, m, rad].
    pub(crate) shifts: Vec<[f64; 3]>,
}
