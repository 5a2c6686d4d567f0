//! Forces of the rows of a tree, whose accelerations are found without those of its pins. The force of a body's own pin
//! is its mass times the acceleration beyond that of its loads, plus the forces of the pins on which others hang. One
//! sweep from the tips to the roots finds them, where the pins' rows of a body with many arms would make a full matrix.

use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::state::Group;
use crate::rigid::group::tree::Hinge;
use glam::DVec2;

/// Force on the body of a side per newton of a row's force, from the row's Jacobian.
fn direction(jacobian: &[f64; 6], side: usize) -> DVec2 {
    DVec2::new(jacobian[3 * side], jacobian[3 * side + 1])
}

impl Dynamics<'_> {
    /// Turns the accelerations in the stage, which are without forces of rows, into those with them, and finds the
    /// forces [N] of all rows; bodies are in place.
    pub(crate) fn hang_and_tell(&mut self) {
        let free = self.stage.accelerations.clone();
        self.hang();
        let Group { tree, sides, rows, bodies, .. } = &*self.group;
        let mut forces = vec![0.0; rows.len()];
        // Force [N] of all rows on each body of the group; at the end that of its own pin.
        let mut given = vec![DVec2::ZERO; bodies.len()];
        for link in &tree.links {
            let [with, without] = [&self.stage.accelerations, &free].map(|of| of[link.place]);
            given[link.place] = link.mass * DVec2::new(with[0] - without[0], with[1] - without[1]);
        }
        if !tree.loop_rows.rows.is_empty() {
            let beside = tree.loop_rows.rows.iter().zip(&self.stage.forces).zip(&self.stage.jacobians);
            for ((&row, &force), jacobian) in beside {
                forces[row] = force;
                for (side, place) in sides[row].iter().enumerate() {
                    if let Some(place) = place {
                        given[*place as usize] -= force * direction(jacobian, side);
                    }
                }
            }
        }
        for link in tree.links.iter().rev() {
            if let Hinge::Link { parent, .. } = link.hinge {
                let passed_on = given[link.place];
                given[tree.links[parent].place] += passed_on;
            }
        }
        let mut twin = None;
        for &row in &tree.hung {
            let moment = self.physics.mechanism.measure_next(&rows[row], &self.stage.movings, &mut twin);
            // Of the two bodies of a pin, the one that comes later in the tree hangs on the other.
            let link_of = |side: usize| sides[row][side].and_then(|place| tree.link_of[place as usize]);
            let side = usize::from(link_of(1) > link_of(0));
            if let Some(place) = sides[row][side] {
                forces[row] = given[place as usize].dot(direction(&moment.kinematics.jacobian, side));
            }
        }
        self.stage.forces = forces;
    }
}
