//! The methods of integration.

use super::dop853::DOP853;
use super::dormand_prince5::DORMAND_PRINCE5;
use super::tableau::{EULER, MODIFIED_EULER, RK4, Tableau};

/// A method of integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub enum Method {
    /// Dormand and Prince, order 8 with error estimates, dense output of order 7; 12 derivatives a step, 3 more for the
    /// dense output.
    #[default]
    Dop853,
    /// Dormand and Prince, order 5 with an error estimate, dense output of order 4; 7 derivatives a step.
    DormandPrince5,
    /// The classical method of Runge and Kutta, order 4, 4 derivatives a step; the dense output is a cubic, as with the
    /// methods below.
    Rk4,
    /// Heun's method, order 2: along the mean of the rates at the start and at the end of a step of Euler.
    ModifiedEuler,
    /// Euler's method, order 1: along the rates at the start.
    Euler,
    /// The implicit method of Radau IIA with three stages, order 5 with an error estimate, dense output of order 3: for
    /// systems parts of which decay much faster than anything moves.
    RadauIia5,
}

impl Method {
    /// True if the method estimates its error, so that its steps can follow a tolerance.
    #[must_use]
    #[inline]
    pub fn is_adaptive(self) -> bool {
        self.error_order().is_some()
    }

    /// Order of the method: the error over a fixed time falls with this power of the step.
    #[must_use]
    #[inline]
    pub fn order(self) -> u32 {
        match self {
            Method::Dop853 => 8,
            Method::DormandPrince5 | Method::RadauIia5 => 5,
            Method::Rk4 => 4,
            Method::ModifiedEuler => 2,
            Method::Euler => 1,
        }
    }

    /// Order of the error estimate, which for one step falls with this power of the step plus one; `None` for a method
    /// without an estimate.
    #[must_use]
    #[inline]
    pub fn error_order(self) -> Option<u32> {
        match self {
            Method::Dop853 => Some(7),
            Method::DormandPrince5 => Some(4),
            Method::RadauIia5 => Some(3),
            Method::Rk4 | Method::ModifiedEuler | Method::Euler => None,
        }
    }

    /// Largest product [-] of a system's fastest rate of decay and the step, roughly: beyond it a decaying part grows.
    /// `None` for a method that damps such parts whatever the step. See
    /// [`Stepper::stiffness`](super::Stepper::stiffness).
    ///
    /// Source: the boundaries on the real axis of the stability domains, HNW II.4 and E. Hairer, G. Wanner, Solving
    /// Ordinary Differential Equations II, IV.2.
    #[must_use]
    #[inline]
    pub fn stability_limit(self) -> Option<f64> {
        match self {
            Method::Dop853 => Some(6.1),
            Method::DormandPrince5 => Some(3.25),
            Method::Rk4 => Some(2.7),
            Method::ModifiedEuler | Method::Euler => Some(2.0),
            Method::RadauIia5 => None,
        }
    }

    /// Middle, as a fraction of a step, of the widest interval in which none of the step's rates is evaluated, dense
    /// output included; `None` for methods without error estimate and implicit ones.
    #[must_use]
    pub fn middle_between_stages(self) -> Option<f64> {
        let tableau = self.tableau().filter(|_| self.is_adaptive())?;
        let stages = tableau.stages.iter().chain(tableau.dense_stages);
        let nodes = || [0.0, 1.0].into_iter().chain(stages.clone().map(|stage| stage.node));
        let next = |node: f64| nodes().filter(|&other| other > node).fold(1.0, f64::min);
        let gaps = nodes().map(|node| (node, next(node)));
        gaps.max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0))).map(|(from, to)| 0.5 * (from + to))
    }

    /// Coefficients of an explicit method.
    pub(super) fn tableau(self) -> Option<&'static Tableau> {
        Some(match self {
            Method::Dop853 => &DOP853,
            Method::DormandPrince5 => &DORMAND_PRINCE5,
            Method::Rk4 => &RK4,
            Method::ModifiedEuler => &MODIFIED_EULER,
            Method::Euler => &EULER,
            Method::RadauIia5 => return None,
        })
    }
}
