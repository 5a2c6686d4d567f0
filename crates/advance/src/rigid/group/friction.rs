//! Friction in a group's equations of motion: anchors of contacts that stick, normal rows whose forces slip turns, and the
//! powers of both.
//!
//! A contact that sticks has a further row, its anchor, which is an equation as any. A contact that slips has the force
//! D^T f with D = J_n + s J_t, s its share along an axis: C M^-1 D^T f = -(C v' + gamma), and `TurnedRows` solves that with the symmetric
//! factor of C M^-1 C^T.

use crate::rigid::contacts::friction::{Axis, Grip};
use crate::rigid::contacts::rows::{ActiveRow, Mechanism};
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::stage::Stage;
use crate::rigid::group::state::{Group, Work};
use halfgap_collision::TangentRow;
use halfgap_contact::TurnedRows;

/// The contacts that slip at a moment.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Slipping {
    /// Row of each one, and by what the direction of its force differs from its normal.
    turns: Vec<(u32, [f64; 6])>,
    /// For each axis of each one its row, its speed [m/s] along it, and its share.
    slips: Vec<(u32, f64, f64)>,
    turned: TurnedRows,
}

impl Slipping {
    pub(super) fn clear(&mut self) {
        self.turns.clear();
        self.slips.clear();
    }

    /// Adds what a contact's row does along an axis along which it slips, the rows in their order.
    pub(super) fn add(&mut self, row: usize, slip: &TangentRow, share: f64) {
        let row = u32::try_from(row).unwrap_or(u32::MAX);
        let turn = slip.jacobian.map(|entry| share * entry);
        match self.turns.last_mut().filter(|(other, _)| *other == row) {
            Some((_, sum)) => sum.iter_mut().zip(turn).for_each(|(sum, entry)| *sum += entry),
            None => self.turns.push((row, turn)),
        }
        self.slips.push((row, slip.rate, share));
    }

    /// By what the direction of the force of the only row differs from its normal, if it slips.
    pub(super) fn only_turn(&self) -> Option<&[f64; 6]> {
        self.turns.first().map(|(_, turn)| turn)
    }

    /// By what the direction of the force of each one's row differs from its normal.
    pub(super) fn turns(&self) -> &[(u32, [f64; 6])] {
        &self.turns
    }

    pub(super) fn is_empty(&self) -> bool {
        self.turns.is_empty()
    }
}

impl Dynamics<'_> {
    /// Solves the factorised rows with the forces of slipping contacts turned, and leaves the response in `changes`.
    pub(super) fn respond_turned(&mut self) {
        let Stage { offsets, forces, changes, solves, slipping, .. } = &mut *self.stage;
        let Slipping { turns, turned, .. } = slipping;
        let active = &mut self.group.active;
        turned.factorize(active, turns.iter().copied());
        forces.resize(offsets.len(), 0.0);
        turned.solve(active, offsets, forces);
        changes.resize(self.group.bodies.len(), [0.0; 3]);
        changes.fill([0.0; 3]);
        turned.respond(active, forces, changes);
        *solves += 1;
    }

    /// Writes the powers [W] of friction: of each contact that slips, the heat that it makes, less than 0; and what running
    /// surfaces do.
    pub(super) fn note_friction_powers(&self, powers: &mut [f64]) {
        let Group { works, rows, spares, .. } = &*self.group;
        let Stage { slipping, forces, .. } = &*self.stage;
        for (power, work) in powers.iter_mut().zip(works) {
            match *work {
                Work::Friction(row) => {
                    let own = slipping.slips.iter().filter(|(other, ..)| *other == row);
                    let heat = own.map(|(_, speed, share)| share * forces[row as usize] * speed);
                    *power = heat.reduce(|sum, heat| sum + heat).unwrap_or(0.0);
                }
                Work::Surfaces => {
                    let of_row = |(row, force): (&ActiveRow, &f64)| {
                        let share = match row.grip(Axis::Slip) {
                            Grip::Anchor { axis: Axis::Slip, .. } => 1.0,
                            Grip::Slips { side, coefficient, .. } => -side * coefficient,
                            Grip::Smooth
                            | Grip::Sticks { .. }
                            | Grip::Anchor { .. }
                            | Grip::Bounded { .. } => return 0.0,
                        };
                        share * force * self.physics.mechanism.running_speed(row)
                    };
                    let of_spares = spares.iter().map(|row| of_row((row, &row.load[0])));
                    *power = rows.iter().zip(forces).map(of_row).chain(of_spares).sum();
                }
                Work::Law(_) | Work::Damping | Work::Drives | Work::Rubbing => {}
            }
        }
    }
}

impl Mechanism<'_> {
    /// Sum of the speeds [m/s] at which the surfaces of a contact run.
    pub(crate) fn running_speed(&self, row: &ActiveRow) -> f64 {
        row.bodies.iter().map(|&body| self.surfaces.speed(body)).sum()
    }
}

impl Dynamics<'_> {
    /// Adds what rows of prescribed forces do to the accelerations without those of the others. Rows must be measured.
    pub(super) fn push_as_prescribed(&mut self) {
        if self.group.prescribed.is_empty() {
            return;
        }
        let Group { bodies, sides, thirds, prescribed, .. } = &*self.group;
        let Stage { jacobians, offsets, accelerations, changes, slipping, .. } = &mut *self.stage;
        changes.clear();
        changes.resize(bodies.len(), [0.0; 3]);
        for &(row, force) in prescribed {
            let turn = slipping.turns.iter().find(|(other, _)| *other == row).map(|(_, turn)| turn);
            for (side, place) in sides[row as usize].into_iter().enumerate() {
                let Some(place) = place.map(|place| place as usize) else { continue };
                let inertia = self.physics.mechanism.trajectories[bodies[place].index()].body();
                let inverse = [inertia.inverse_mass, inertia.inverse_mass, inertia.inverse_moment];
                for (k, inverse) in inverse.into_iter().enumerate() {
                    let at = 3 * side + k;
                    let direction = jacobians[row as usize][at] + turn.map_or(0.0, |turn| turn[at]);
                    changes[place][k] += inverse * direction * force;
                }
            }
            if let Some(third) = thirds.iter().find(|third| third.row == row) {
                let place = third.body as usize;
                let inertia = self.physics.mechanism.trajectories[bodies[place].index()].body();
                changes[place][2] += inertia.inverse_moment * third.coefficient * force;
            }
        }
        for third in thirds {
            offsets[third.row as usize] += third.coefficient * changes[third.body as usize][2];
        }
        for ((offset, jacobian), sides) in offsets.iter_mut().zip(jacobians.iter()).zip(sides) {
            for (side, place) in sides.iter().enumerate() {
                let Some(place) = place else { continue };
                *offset += (0..3).map(|k| jacobian[3 * side + k] * changes[*place as usize][k]).sum::<f64>();
            }
        }
        for (acceleration, change) in accelerations.iter_mut().zip(changes) {
            (0..3).for_each(|k| acceleration[k] += change[k]);
        }
    }

    /// Lets the forces of all rows be those that the event found, and what changes them, if some depend on others at the group's start:
    /// then forces are not unique, and where contacts slip motions depend on them. True if that is so.
    pub(crate) fn prescribe_if_dependent(&mut self) -> bool {
        if !self.group.is_rough() || self.group.rows.len() < 2 {
            return false;
        }
        let Group { rows, active, spares, .. } = &*self.group;
        if !(0..rows.len()).any(|index| active.is_dependent(index)) {
            return false;
        }
        // What locks bear for spare rows is no part of the motion.
        let stress = if spares.is_empty() { vec![0.0; rows.len()] } else { self.find_stress() };
        let own = rows.iter().zip(stress).map(|(row, stress)| row.load[0] - stress);
        let own: Vec<_> = (0..).zip(own).collect();
        self.group.prescribed.extend(own);
        true
    }

    /// Notes what spare rows add to the forces of locks, which are those at the group's start.
    pub(crate) fn note_stress(&mut self) {
        let Group { rows, spares, locks, forces, stress, .. } = &mut *self.group;
        if spares.is_empty() {
            return;
        }
        let told = |((row, force), &locks): ((&ActiveRow, &f64), &bool)| {
            if locks { row.load[0] - force } else { 0.0 }
        };
        stress.extend(rows.iter().zip(&*forces).zip(&*locks).map(told));
        forces.iter_mut().zip(&*stress).for_each(|(force, stress)| *force += stress);
    }
}
