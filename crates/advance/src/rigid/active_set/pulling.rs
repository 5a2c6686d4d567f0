//! A motor, or dry friction in a joint, as an event sees it: its row, its bounds, and whether it gives way.
//!
//! Invariant: one that has a side acts with all its force against it; one without may hold.

use crate::rigid::shares::{NARROWED, ROUNDED_FORCE};
use halfgap_collision::{BodyId, ConnectorId, ConnectorSample};
use halfgap_contact::Solution;

/// A motor, or dry friction in a joint, of a region's bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pulling {
    pub(super) id: ConnectorId,
    pub(super) bodies: [BodyId; 2],
    pub(super) row: ConnectorSample,
    /// Largest force along its row [N].
    pub(super) most: f64,
    /// Acceleration along its row by a unit of force along it [1/kg].
    pub(super) mobility: f64,
    /// The side to which its rate is off, 1 or -1; `None` for one that may hold.
    pub(super) side: Option<f64>,
    /// Number of its row in the problem, if it has one.
    pub(super) number: Option<usize>,
}

impl Pulling {
    /// Bounds [N] of its row, which are less by a share `slack` [-] where it may hold.
    pub(super) fn bounds(&self, slack: f64) -> [f64; 2] {
        match self.side {
            Some(side) => [-side * self.most; 2],
            None => {
                let most = (1.0 - slack.max(NARROWED)) * self.most;
                [-most, most]
            }
        }
    }

    /// Force and acceleration along its row, of one that may hold, in a solution; and true if the force is at its bound.
    pub(super) fn held(&self, solution: &Solution, slack: f64) -> Option<(f64, bool)> {
        let number = self.number.filter(|_| self.side.is_none())?;
        let (force, along) = (solution.force.get(number)?, solution.acceleration.get(number)?);
        Some((*along, force.abs() >= (1.0 - ROUNDED_FORCE) * self.bounds(slack)[1]))
    }

    /// Side to which one that may hold gives way in a solution: it is at its bound, and its rate changes by more than the `least`
    /// acceleration [m/s^2] that counts. `None` if it holds.
    pub(super) fn gives_way(&self, solution: &Solution, (least, slack): (f64, f64)) -> Option<f64> {
        let (along, is_at_bound) = self.held(solution, slack)?;
        (is_at_bound && along.abs() > least).then(|| along.signum())
    }
}
