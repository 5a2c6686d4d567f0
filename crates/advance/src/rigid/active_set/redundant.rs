//! Redundant contacts: where rows depend on each other, their forces are not unique. The forces of active rows are found
//! by elimination, which gives one of the dependent rows no force; if that is the wrong one, other contacts pull.

use crate::rigid::region::touching::Region;
use crate::rigid::shares::ROUNDED_FORCE;
use halfgap_contact::{ActiveRows, InverseInertia, ThirdSide};

/// The candidates as equations, with buffers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Redundant {
    pub(super) rows: Rows,
    pub(super) active: ActiveRows,
    /// Forces [N] that elimination finds for active rows.
    pub(super) as_active: Vec<f64>,
}

/// The rows of the candidates and their forces.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    pub(super) inertia: Vec<InverseInertia>,
    pub(super) sides: Vec<[Option<u32>; 2]>,
    /// Third bodies of the rows, with their coefficients [m].
    pub(super) thirds: Vec<Option<(u32, f64)>>,
    pub(super) jacobians: Vec<[f64; 6]>,
    pub(super) forces: Vec<f64>,
    /// True for rows of connectors, which may pull.
    pub(super) bilateral: Vec<bool>,
    /// Rows to be excluded.
    pub(super) excluded: Vec<usize>,
}

impl Rows {
    /// Largest force [N] of a contact.
    pub(crate) fn largest_force(&self) -> f64 {
        let contacts = self.forces.iter().zip(&self.bilateral).filter(|(_, bilateral)| !**bilateral);
        contacts.fold(0.0, |most, (force, _)| f64::max(most, force.abs()))
    }

    /// Factors the rows; returns the number of those that depend on others.
    pub(crate) fn factorize(&self, active: &mut ActiveRows) -> usize {
        let third = |(row, third): (u32, &Option<(u32, f64)>)| {
            third.map(|(body, coefficient)| ThirdSide { row, body, coefficient })
        };
        let thirds: Vec<ThirdSide> = (0..).zip(&self.thirds).filter_map(third).collect();
        active.set_structure_with_thirds(&self.inertia, &self.sides, &thirds);
        active.factorize(&self.jacobians)
    }

    /// True if a contact pulls by more than rounding with the forces that elimination finds. The rows must be factored;
    /// `offset` holds the accelerations [m/s^2] of their gaps without forces.
    pub(crate) fn pulls(&self, active: &mut ActiveRows, offset: &[f64], as_active: &mut Vec<f64>) -> bool {
        as_active.clear();
        as_active.resize(self.forces.len(), 0.0);
        active.solve(offset, as_active);
        let least = -ROUNDED_FORCE * self.largest_force();
        as_active.iter().zip(&self.bilateral).any(|(&force, &bilateral)| !bilateral && force < least)
    }

    /// Excludes candidates until `active` finds none that depends on the others, and writes the forces into their records.
    pub(crate) fn exclude_dependent(
        &mut self,
        active: &mut ActiveRows,
        region: &mut Region,
        candidates: &mut Vec<usize>,
    ) {
        while self.factorize(active) > 0 {
            let Self { sides, thirds, jacobians, forces, bilateral, excluded, .. } = self;
            active.find_redundant(forces, |row| bilateral[row], excluded);
            if excluded.is_empty() {
                break;
            }
            excluded.sort_unstable();
            for &row in &*excluded {
                region.set_force(candidates[row], 0.0);
            }
            remove_rows(candidates, excluded);
            remove_rows(sides, excluded);
            remove_rows(thirds, excluded);
            remove_rows(jacobians, excluded);
            remove_rows(forces, excluded);
            remove_rows(bilateral, excluded);
        }
        for (&index, &force) in candidates.iter().zip(&self.forces) {
            region.set_force(index, force);
        }
    }
}

/// Removes the entries at the given places, which are sorted.
fn remove_rows<T>(list: &mut Vec<T>, rows: &[usize]) {
    let mut next = 0;
    let mut place = 0;
    list.retain(|_| {
        let is_removed = rows.get(next) == Some(&place);
        next += usize::from(is_removed);
        place += 1;
        !is_removed
    });
}
