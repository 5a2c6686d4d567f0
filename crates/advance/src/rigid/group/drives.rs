//! What drives a group, and the bodies that are moved beside it: where these are, how they accelerate rows, and what work is done; and
//! the heat of joints with dry friction.
//!
//! With J the coefficients of a row on the bodies that can move and w the part of its rate that is prescribed, the rate J v + w is 0
//! and the force f does the power f J v = -f w. A body that is moved has a share in w, and in the acceleration of the row.
//! Friction does a power on it, too, and so do force laws. What pulls with all its force is no row: its rate is not 0.

use crate::rigid::bodies::force_law::Wrench;
use crate::rigid::bodies::moved::rate_on;
use crate::rigid::contacts::pulls::Pull;
use crate::rigid::contacts::rows::moving_of;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::stage::Stage;
use crate::rigid::group::state::{Group, Work};
use halfgap_collision::BodyId;

impl Dynamics<'_> {
    /// Writes the powers [W] of drives and of rubbing joints. The stage has the forces of all rows, or of those beside the pins of a tree.
    pub(crate) fn note_driving_powers(&self, powers: &mut [f64]) {
        let Group { works, rows, driven, tree, pulls, moved, .. } = &*self.group;
        let mechanism = &self.physics.mechanism;
        let of_row = |row: usize, force: f64| -force * mechanism.prescribed_rate(&rows[row]);
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
                        let beside = tree.rows_beside().zip(forces);
                        let driven = beside.filter(|(row, _)| driven.contains(row));
                        driven.map(|(row, &force)| of_row(row, force)).sum()
                    } else {
                        driven.iter().map(|&row| of_row(row, forces[row])).sum()
                    };
                    let of_moved = if moved.is_empty() { 0.0 } else { self.power_of_moved() };
                    *power = of_rows + of_pulls(true) + of_moved;
                }
                Work::Rubbing => *power = of_pulls(false),
                Work::Law(_) | Work::Damping | Work::Friction(_) | Work::Surfaces => {}
            }
        }
    }

    /// Power [W] of the moved bodies on the others. What pulls is among the wrenches of laws.
    fn power_of_moved(&self) -> f64 {
        let Group { rows, spares, moved, .. } = &*self.group;
        let Stage { jacobians, forces, slipping, wrenches, movings, .. } = &*self.stage;
        let rate = |bodies: [BodyId; 2], coefficients: &[f64; 6]| {
            let sides = bodies.into_iter().zip(coefficients.as_chunks::<3>().0);
            let of_moved = sides.filter(|(body, _)| moved.contains(body));
            of_moved.map(|(body, j)| rate_on(j, &movings[body.index()])).sum::<f64>()
        };
        let along = rows.iter().zip(jacobians).zip(forces);
        let along = along.map(|((row, jacobian), force)| {
            let of_third = row.third.filter(|(body, _)| moved.contains(body));
            let of_third = of_third.map_or(0.0, |(body, j)| j * movings[body.index()].angular_velocity);
            force * (rate(row.bodies, jacobian) + of_third)
        });
        let across = slipping.turns().iter().map(|(row, turn)| {
            let row = *row as usize;
            forces[row] * rate(rows[row].bodies, turn)
        });
        let of_spares = spares.iter().map(|row| {
            let jacobian = self.physics.mechanism.measure(row, movings).kinematics.jacobian;
            row.load[0] * rate(row.bodies, &jacobian)
        });
        let by_laws = moved.iter().map(|body| {
            let (wrench, moving) = (&wrenches[body.index()], &movings[body.index()]);
            wrench.force.dot(moving.velocity) + wrench.torque * moving.angular_velocity
        });
        -(along.chain(across).chain(of_spares).chain(by_laws).sum::<f64>())
    }

    /// Places the moved bodies at an offset [s] of the segment.
    pub(super) fn place_moved(&mut self, offset: f64) {
        let time = self.start.plus(offset);
        for body in &self.group.moved {
            let moving = self.physics.mechanism.trajectories[body.index()].moving_at(time);
            self.stage.movings[body.index()] = moving;
            // Laws are summed up anew wherever bodies have been placed.
            self.stage.wrenches[body.index()] = Wrench::default();
        }
    }

    /// Adds to the accelerations of rows what moved bodies make of them; these must be placed, and the rows measured.
    pub(super) fn follow_moved(&mut self) {
        if self.group.moved.is_empty() {
            return;
        }
        let time = self.start.plus(self.physics.mechanism.time - self.start.seconds());
        let Stage { offsets, jacobians, .. } = &mut *self.stage;
        for &body in &self.group.moved {
            let acceleration =
                self.physics.mechanism.trajectories[body.index()].prescribed_acceleration(time);
            let rows = self.group.rows.iter().zip(jacobians.iter()).zip(offsets.iter_mut());
            for ((row, jacobian), offset) in rows {
                let sides = row.bodies.into_iter().zip(jacobian.as_chunks::<3>().0);
                for (_, [x, y, turn]) in sides.filter(|(other, _)| *other == body) {
                    *offset +=
                        x * acceleration.linear.x + y * acceleration.linear.y + turn * acceleration.angular;
                }
                if let Some((_, turn)) = row.third.filter(|(other, _)| *other == body) {
                    *offset += turn * acceleration.angular;
                }
            }
        }
    }
}
