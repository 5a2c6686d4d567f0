//! The work of what drives a group: forces of rows whose gap would change by itself if the bodies did not move.
//!
//! With J the coefficients of a row on the bodies that can move and w the part of its rate that is prescribed, the rate J v + w is 0
//! and the force f does the power f J v = -f w.

use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::state::{Group, Work};

impl Dynamics<'_> {
    /// Writes the power [W] of drives. The stage has the forces of all rows, of a group that is stepped as a tree of those beside its pins.
    pub(crate) fn note_driving_power(&self, powers: &mut [f64]) {
        let Group { works, rows, tree, .. } = &*self.group;
        let Some(place) = works.iter().position(|&work| work == Work::Drives) else { return };
        let of_row = |(row, force): (usize, &f64)| {
            // Without a drive the sum must not be of signed zeros.
            let rate = self.physics.mechanism.prescribed_rate(&rows[row]);
            if rate == 0.0 { 0.0 } else { -force * rate }
        };
        powers[place] = if tree.is_used() {
            tree.rows_beside().zip(&self.stage.forces).map(of_row).sum()
        } else {
            self.stage.forces.iter().enumerate().map(of_row).sum()
        };
    }
}
