//! The work of what drives a group, and the heat of joints with dry friction.
//!
//! With J the coefficients of a row on the bodies that can move and w the part of its rate that is prescribed, the rate J v + w is 0
//! and the force f does the power f J v = -f w. What pulls with all its force is no row: its rate is not 0.

use crate::rigid::contacts::pulls::Pull;
use crate::rigid::contacts::rows::moving_of;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::state::{Group, Work};

impl Dynamics<'_> {
    /// Writes the powers [W] of drives and of rubbing joints. The stage has the forces of all rows, or of those beside the pins of a tree.
    pub(crate) fn note_driving_powers(&self, powers: &mut [f64]) {
        let Group { works, rows, tree, pulls, .. } = &*self.group;
        let mechanism = &self.physics.mechanism;
        let of_row = |(row, force): (usize, &f64)| {
            let rate = mechanism.prescribed_rate(&rows[row]);
            if rate == 0.0 { 0.0 } else { -force * rate }
        };
        let of_pull = |pull: &Pull| {
            let movings = pull.bodies.map(|body| moving_of(&self.stage.movings, body));
            let prescribed = mechanism.connectors[pull.id.index()].prescribed_rate(mechanism.time);
            (prescribed != 0.0, pull.force * (mechanism.pull_kinematics(pull.id, movings).rate - prescribed))
        };
        let of_pulls = |driven: bool| {
            let powers = pulls.iter().map(of_pull).filter(|&(is_driven, _)| is_driven == driven);
            powers.map(|(_, power)| power).sum::<f64>()
        };
        for (power, work) in powers.iter_mut().zip(works) {
            match work {
                Work::Drives => {
                    let forces = &self.stage.forces;
                    let of_rows: f64 = if forces.len() < rows.len() {
                        tree.rows_beside().zip(forces).map(of_row).sum()
                    } else {
                        forces.iter().enumerate().map(of_row).sum()
                    };
                    *power = of_rows + of_pulls(true);
                }
                Work::Rubbing => *power = of_pulls(false),
                Work::Law(_) | Work::Damping | Work::Friction(_) | Work::Surfaces => {}
            }
        }
    }
}
