//! What impulses have done to the bodies of an impact.

use super::FrictionRow;
use crate::problem::InverseInertia;
use crate::row::CollisionRow;
use halfgap_collision::BodyId;

/// Changes of the velocities of bodies.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct BodyMotions {
    bodies: Vec<BodyId>,
    /// Changes of velocity [m/s, m/s, rad/s].
    change: Vec<[f64; 3]>,
    inertia: Vec<InverseInertia>,
    /// Places of the primary and the normal body of each row; `None` for one that the row does not move.
    sides: Vec<[Option<u32>; 2]>,
    /// Place of the third body of each row.
    thirds: Vec<Option<u32>>,
}

impl BodyMotions {
    /// Takes the bodies of rows, at no change yet. Inverse masses are those by which rows respond to impulses; a body that no
    /// row turns has none of rotation.
    pub(super) fn load(&mut self, rows: &[CollisionRow], friction: &[Option<FrictionRow>]) {
        self.bodies.clear();
        self.bodies.extend(rows.iter().flat_map(CollisionRow::movable_bodies).flatten());
        self.bodies.extend(rows.iter().filter_map(CollisionRow::movable_third));
        for (row, friction) in rows.iter().zip(friction) {
            let turned = friction.iter().flat_map(|friction| friction.response.chunks(3));
            let moves = turned.map(|part| part.iter().any(|&x| x != 0.0));
            self.bodies
                .extend(row.bodies.iter().zip(moves).filter(|(_, moves)| *moves).map(|(body, _)| *body));
        }
        self.bodies.sort_unstable();
        self.bodies.dedup();
        self.change.clear();
        self.change.resize(self.bodies.len(), [0.0; 3]);
        self.inertia.clear();
        let none = InverseInertia { inverse_mass: 0.0, inverse_moment: 0.0 };
        self.inertia.resize(self.bodies.len(), none);
        let mut largest = vec![[0.0_f64; 2]; self.bodies.len()];
        self.sides.clear();
        self.thirds.clear();
        for (row, friction) in rows.iter().zip(friction) {
            let sides = row.bodies.map(|body| self.bodies.binary_search(&body).ok());
            self.sides.push(sides.map(|side| side.map(|place| place as u32)));
            let pairs = std::iter::once((&row.jacobian, &row.response))
                .chain(friction.iter().map(|friction| (&friction.jacobian, &friction.response)));
            for (jacobian, response) in pairs {
                for (side, place) in sides.into_iter().enumerate() {
                    let Some(place) = place else { continue };
                    for k in 0..3 {
                        let (entry, at) = (jacobian[3 * side + k], usize::from(k == 2));
                        // The largest coefficient has the least rounding.
                        if entry.abs() > largest[place][at] {
                            largest[place][at] = entry.abs();
                            let inverse = response[3 * side + k] / entry;
                            match at {
                                0 => self.inertia[place].inverse_mass = inverse,
                                _ => self.inertia[place].inverse_moment = inverse,
                            }
                        }
                    }
                }
            }
            self.load_third(row, &mut largest);
        }
    }

    /// Takes the third side of a row.
    fn load_third(&mut self, row: &CollisionRow, largest: &mut [[f64; 2]]) {
        let place = row.third.and_then(|third| self.bodies.binary_search(&third.body).ok());
        self.thirds.push(place.map(|place| place as u32));
        if let (Some(place), Some(third)) = (place, &row.third)
            && third.jacobian.abs() > largest[place][1]
        {
            largest[place][1] = third.jacobian.abs();
            self.inertia[place].inverse_moment = third.response / third.jacobian;
        }
    }

    /// Inverse inertia of the bodies.
    pub(super) fn inertia(&self) -> &[InverseInertia] {
        &self.inertia
    }

    /// Places of the bodies of a row.
    pub(super) fn sides(&self, row: usize) -> [Option<u32>; 2] {
        self.sides[row]
    }

    /// Place of the third body of a row.
    pub(super) fn third(&self, row: usize) -> Option<u32> {
        self.thirds[row]
    }

    /// Adds an impulse along a row to changes of the velocities of all bodies.
    pub(super) fn push(&self, row: usize, data: &CollisionRow, impulse: f64, change: &mut [[f64; 3]]) {
        add(self.sides[row], &data.response, impulse, change);
        if let (Some(place), Some(third)) = (self.thirds[row], &data.third) {
            change[place as usize][2] += third.response * impulse;
        }
    }

    /// Change of the rate of a row by changes of the velocities of all bodies.
    pub(super) fn rate_by(&self, row: usize, data: &CollisionRow, change: &[[f64; 3]]) -> f64 {
        let of_two = rate(self.sides[row], &data.jacobian, change);
        match (self.thirds[row], &data.third) {
            (Some(place), Some(third)) => of_two + third.jacobian * change[place as usize][2],
            _ => of_two,
        }
    }

    /// Adds an impulse along a row.
    pub(super) fn add_row(&mut self, row: usize, data: &CollisionRow, impulse: f64) {
        let mut change = std::mem::take(&mut self.change);
        self.push(row, data, impulse, &mut change);
        self.change = change;
    }

    /// Change of the rate of a row.
    pub(super) fn rate_of(&self, row: usize, data: &CollisionRow) -> f64 {
        self.rate_by(row, data, &self.change)
    }

    /// Changes of the velocities of all bodies.
    pub(super) fn changes(&mut self) -> &mut [[f64; 3]] {
        &mut self.change
    }

    /// Adds an impulse on the two bodies of a row, with a response.
    pub(super) fn add(&mut self, row: usize, response: &[f64; 6], impulse: f64) {
        add(self.sides[row], response, impulse, &mut self.change);
    }

    /// Change of a rate of the two bodies of a row, with a Jacobian.
    pub(super) fn rate(&self, row: usize, jacobian: &[f64; 6]) -> f64 {
        rate(self.sides[row], jacobian, &self.change)
    }
}

/// Adds an impulse on two bodies along a response to changes of velocities.
pub(super) fn add(sides: [Option<u32>; 2], response: &[f64; 6], impulse: f64, change: &mut [[f64; 3]]) {
    for (side, place) in sides.into_iter().enumerate() {
        let Some(place) = place else { continue };
        for k in 0..3 {
            change[place as usize][k] += response[3 * side + k] * impulse;
        }
    }
}

/// Change of a rate of two bodies by changes of velocities.
pub(super) fn rate(sides: [Option<u32>; 2], jacobian: &[f64; 6], change: &[[f64; 3]]) -> f64 {
    let of_side = |side: usize| {
        sides[side].map_or(0.0, |place| {
            let change = &change[place as usize];
            (0..3).map(|k| jacobian[3 * side + k] * change[k]).sum::<f64>()
        })
    };
    of_side(0) + of_side(1)
}
