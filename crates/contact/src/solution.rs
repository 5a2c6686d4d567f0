//! The answer to a contact problem.

use crate::check::Residuals;
use crate::solver::Method;

/// Forces and accelerations (or impulses and velocities) of every row, with their residuals.
///
/// A solver fills it; reused for later problems, it keeps the memory of its buffers.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub struct Solution {
    /// Force f_i of each row \[N\], or impulse [N·s] in an impact problem.
    pub force: Vec<f64>,
    /// Acceleration a = A f + b of each row [m/s²], or velocity [m/s] in an impact problem, from the original data.
    pub acceleration: Vec<f64>,
    /// Rows that the method ended with as closed (a = 0 enforced), ascending. With redundant contacts these are a
    /// subset of the rows at a = 0, and some of them may carry no force.
    pub active: Vec<usize>,
    /// Residuals of the forces in the original data.
    pub residuals: Residuals,
    /// Number of pivots (active-set method, Lemke) or of Newton and interior-point steps.
    pub iterations: usize,
    /// Largest contradiction between dependent rows, in units of the scale max|b/s|; 0 when they agree. Where it is not
    /// 0, the forces solve these rows in the least-squares sense, and the natural residual includes it.
    pub inconsistency: f64,
    /// The method that found the answer.
    pub method: Method,
}

impl Solution {
    /// Makes an empty solution, to be filled by a solver.
    #[must_use]
    #[inline]
    pub fn new() -> Self {
        Solution {
            force: Vec::new(),
            acceleration: Vec::new(),
            active: Vec::new(),
            residuals: Residuals::default(),
            iterations: 0,
            inconsistency: 0.0,
            method: Method::DualActiveSet,
        }
    }

    /// Number of rows answered.
    #[must_use]
    #[inline]
    pub fn len(&self) -> usize {
        self.force.len()
    }

    /// Whether the problem had no rows.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.force.is_empty()
    }

    /// Resizes to `rows` rows and sets all numbers to zero.
    pub(crate) fn reset(&mut self, rows: usize, method: Method) {
        self.force.clear();
        self.force.resize(rows, 0.0);
        self.acceleration.clear();
        self.acceleration.resize(rows, 0.0);
        self.active.clear();
        self.active.reserve(rows);
        self.residuals = Residuals::default();
        self.iterations = 0;
        self.inconsistency = 0.0;
        self.method = method;
    }
}

impl Default for Solution {
    fn default() -> Self {
        Self::new()
    }
}
