//! What spare rows add to the forces of locks, by statics.
//!
//! Spare rows act between bodies that locks hold together, and move nothing: what they push, the locks hold. Three rows of each lock tell all
//! forces between its bodies, so that what they hold is unique, whatever other rows depend on them.

use crate::rigid::contacts::rows::moving_of;
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::state::Group;
use halfgap_contact::{ActiveRows, InverseInertia};

impl Dynamics<'_> {
    /// What spare rows add to the force of each row [N] at the group's start; 0 of those that are no locks. Rows must be measured.
    pub(super) fn find_stress(&self) -> Vec<f64> {
        let Group { bodies, rows, sides, spares, locks, .. } = &*self.group;
        let mechanism = &self.physics.mechanism;
        let inertias: Vec<InverseInertia> = bodies
            .iter()
            .map(|body| {
                let body = mechanism.trajectories[body.index()].body();
                InverseInertia { inverse_mass: body.inverse_mass, inverse_moment: body.inverse_moment }
            })
            .collect();
        let mut pushed = vec![[0.0; 3]; bodies.len()];
        for spare in spares {
            let movings = spare.bodies.map(|body| moving_of(self.stage.movings(), body));
            let jacobian = mechanism.measure_between(spare, movings).kinematics.jacobian;
            for (side, body) in spare.bodies.iter().enumerate() {
                let Ok(place) = bodies.binary_search(body) else { continue };
                let InverseInertia { inverse_mass, inverse_moment } = inertias[place];
                for (k, inverse) in [inverse_mass, inverse_mass, inverse_moment].into_iter().enumerate() {
                    pushed[place][k] += inverse * jacobian[3 * side + k] * spare.load[0];
                }
            }
        }
        let held: Vec<usize> = (0..rows.len()).filter(|&row| locks[row]).collect();
        let jacobians: Vec<[f64; 6]> = held.iter().map(|&row| self.stage.jacobians[row]).collect();
        let places: Vec<[Option<u32>; 2]> = held.iter().map(|&row| sides[row]).collect();
        let rate = |(jacobian, sides): (&[f64; 6], &[Option<u32>; 2])| -> f64 {
            let of_side = |(side, place): (usize, u32)| {
                (0..3).map(|k| jacobian[3 * side + k] * pushed[place as usize][k]).sum::<f64>()
            };
            sides.iter().enumerate().filter_map(|(side, place)| Some((side, (*place)?))).map(of_side).sum()
        };
        let offsets: Vec<f64> = jacobians.iter().zip(&places).map(rate).collect();
        let mut active = ActiveRows::default();
        active.set_structure(&inertias, &places);
        active.factorize(&jacobians);
        let mut forces = vec![0.0; held.len()];
        active.solve(&offsets, &mut forces);
        let mut stress = vec![0.0; rows.len()];
        held.iter().zip(forces).for_each(|(&row, force)| stress[row] = force);
        stress
    }
}
