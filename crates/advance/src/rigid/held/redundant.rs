//! Redundant contacts: where rows depend on each other, their forces are not unique. The forces of held rows are found
//! by elimination, which gives one of the dependent rows no force; if that is the wrong one, other contacts pull.

use crate::rigid::region::touching::Region;
use crate::rigid::shares::ROUNDED_FORCE;
use halfgap_contact::{HeldRows, InverseInertia};

/// The candidates as equations, with buffers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Redundant {
    pub(super) rows: Rows,
    pub(super) held: HeldRows,
    /// Forces [N] that elimination finds for held rows.
    pub(super) as_held: Vec<f64>,
}

/// The rows of the candidates and their forces.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    pub(super) inertia: Vec<InverseInertia>,
    pub(super) sides: Vec<[Option<u32>; 2]>,
    pub(super) jacobians: Vec<[f64; 6]>,
    pub(super) forces: Vec<f64>,
    /// True for rows of connectors, which may pull.
    pub(super) bilateral: Vec<bool>,
    /// Rows to be spared.
    pub(super) spared: Vec<usize>,
}

impl Rows {
    /// Largest force [N] of a contact.
    pub(crate) fn largest_force(&self) -> f64 {
        let contacts = self.forces.iter().zip(&self.bilateral).filter(|(_, bilateral)| !**bilateral);
        contacts.fold(0.0, |most, (force, _)| f64::max(most, force.abs()))
    }

    /// Factors the rows; returns the number of those that depend on others.
    pub(crate) fn factorize(&self, held: &mut HeldRows) -> usize {
        held.set_structure(&self.inertia, &self.sides);
        held.factorize(&self.jacobians)
    }

    /// True if a contact pulls by more than rounding with the forces that elimination finds. The rows must be factored;
    /// `offset` holds the accelerations [m/s^2] of their gaps without forces.
    pub(crate) fn pulls(&self, held: &mut HeldRows, offset: &[f64], as_held: &mut Vec<f64>) -> bool {
        as_held.clear();
        as_held.resize(self.forces.len(), 0.0);
        held.solve(offset, as_held);
        let least = -ROUNDED_FORCE * self.largest_force();
        as_held.iter().zip(&self.bilateral).any(|(&force, &bilateral)| !bilateral && force < least)
    }

    /// Spares candidates until `held` finds none that depends on the others, and writes the forces into their records.
    pub(crate) fn spare(&mut self, held: &mut HeldRows, region: &mut Region, candidates: &mut Vec<usize>) {
        while self.factorize(held) > 0 {
            let Self { sides, jacobians, forces, bilateral, spared, .. } = self;
            held.spare(forces, |row| bilateral[row], spared);
            if spared.is_empty() {
                break;
            }
            spared.sort_unstable();
            for &row in &*spared {
                region.set_force(candidates[row], 0.0);
            }
            drop_rows(candidates, spared);
            drop_rows(sides, spared);
            drop_rows(jacobians, spared);
            drop_rows(forces, spared);
            drop_rows(bilateral, spared);
        }
        for (&index, &force) in candidates.iter().zip(&self.forces) {
            region.set_force(index, force);
        }
    }
}

/// Removes the entries at the given places, which are sorted.
fn drop_rows<T>(list: &mut Vec<T>, rows: &[usize]) {
    let mut next = 0;
    let mut place = 0;
    list.retain(|_| {
        let is_dropped = rows.get(next) == Some(&place);
        next += usize::from(is_dropped);
        place += 1;
        !is_dropped
    });
}
