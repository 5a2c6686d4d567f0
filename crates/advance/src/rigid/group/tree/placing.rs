//! Poses and velocities of the bodies of a tree from its coordinates.

use crate::rigid::group::tree::{Hinge, JointTree, Link, Numbers, Stance};
use glam::DVec2;
use halfgap_collision::{BodyId, Moving};
use halfgap_geometry::{Pose, Rotation};

impl JointTree {
    /// Places the bodies according to the coordinates and their velocities, with which `state` begins.
    pub(super) fn place(&mut self, state: &[f64], bodies: &[BodyId], movings: &mut [Moving]) {
        let (coordinates, rates) = state.split_at(self.count());
        let mut at = 0;
        for index in 0..self.links.len() {
            let link = &self.links[index];
            let (angle, angular_velocity) = (coordinates[at], rates[at]);
            let rotation = Rotation::from_angle(angle);
            let own = rotation.apply(link.own);
            let mut of_parent = DVec2::ZERO;
            let (pin, velocity) = match link.hinge {
                Hinge::Free => {
                    let place = DVec2::new(coordinates[at + 1], coordinates[at + 2]);
                    let velocity = DVec2::new(rates[at + 1], rates[at + 2]);
                    at += 2;
                    (place, velocity)
                }
                Hinge::World(pin) => (pin, DVec2::ZERO),
                Hinge::Link { parent, arm, offset } => {
                    let on = &movings[bodies[self.links[parent].place].index()];
                    let arm = on.pose.rotation.apply(arm);
                    of_parent = arm - self.stances[parent].own;
                    (on.pose.position + arm + offset, on.velocity_at(arm))
                }
            };
            at += 1;
            self.stances[index] = Stance { own, of_parent, spin_square: angular_velocity * angular_velocity };
            movings[bodies[link.place].index()] = Moving {
                pose: Pose { position: pin - own, rotation },
                angle,
                velocity: velocity - own.perp() * angular_velocity,
                angular_velocity,
            };
        }
    }

    /// Finds the stances of bodies that are in place.
    pub(super) fn find_stances(&mut self, bodies: &[BodyId], movings: &[Moving]) {
        for (index, link) in self.links.iter().enumerate() {
            let moving_of = |link: &Link| &movings[bodies[link.place].index()];
            let Moving { pose, angular_velocity, .. } = moving_of(link);
            let of_parent = match link.hinge {
                Hinge::Link { parent, arm, .. } => {
                    let rotation = moving_of(&self.links[parent]).pose.rotation;
                    rotation.apply(arm) - self.stances[parent].own
                }
                Hinge::Free | Hinge::World(_) => DVec2::ZERO,
            };
            let own = pose.rotation.apply(link.own);
            self.stances[index] = Stance { own, of_parent, spin_square: angular_velocity * angular_velocity };
        }
    }
}

impl Numbers {
    /// Extracts the coordinates, their velocities, and the works from a group's state.
    pub(super) fn gather(&self, whole: &[f64], velocities: usize, out: &mut Vec<f64>) {
        out.clear();
        out.extend(self.0.iter().map(|&number| whole[number]));
        out.extend(self.0.iter().map(|&number| whole[velocities + number]));
        out.extend_from_slice(&whole[2 * velocities..]);
    }
}
