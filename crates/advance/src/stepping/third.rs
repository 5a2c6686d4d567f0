//! Third sides of rows, as of gears on a carrier.

use crate::stepping::bodies::Motion3;
use crate::stepping::rows::Mover;

/// The third side of a row: the rotation of one more body.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Third {
    /// Place of the body.
    pub(super) place: u32,
    /// Coefficient of its angular velocity [m].
    pub(super) arm: f64,
}

impl Third {
    /// Its part of the rate [m/s].
    #[inline]
    pub(super) fn rate(&self, velocities: &[Motion3]) -> f64 {
        self.arm * velocities[self.place as usize][2]
    }

    /// Adds what an impulse changes to the velocities.
    #[inline]
    pub(super) fn push(&self, movers: &mut [Mover], impulse: f64) {
        let mover = &mut movers[self.place as usize];
        mover.velocity[2] += mover.inverse_moment * self.arm * impulse;
    }
}
