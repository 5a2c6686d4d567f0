//! Redundant contacts: where rows depend on each other, their forces are not unique. The forces of held rows are found
//! by elimination, which gives one of the dependent rows no force; if that is the wrong one, other contacts pull.

use super::settling::Settling;
use crate::rigid::event::cause::Cause;
use crate::rigid::event::region::Region;
use crate::rigid::step::dynamics::Stage;
use crate::rigid::system::RigidSystem;
use halfgap_contact::{HeldRows, InverseInertia};

/// Buffers for the rows of the candidates and their forces.
#[derive(Clone, Debug, Default)]
pub(super) struct Redundant {
    held: HeldRows,
    inertia: Vec<InverseInertia>,
    sides: Vec<[Option<u32>; 2]>,
    jacobians: Vec<[f64; 6]>,
    forces: Vec<f64>,
    /// Forces [N] that elimination finds for held rows.
    as_held: Vec<f64>,
    /// Rows to be spared.
    spared: Vec<usize>,
}

/// Fraction of the largest contact force by which a contact may pull by rounding.
const ROUNDING: f64 = 1e-9;

impl RigidSystem {
    /// Spares candidates until none depends on the others, such that the remaining contacts do not pull if none pulled
    /// in the solution found. In a jam, whose rows contradict each other, none is spared; nor at the start, unless a
    /// contact would pull by elimination.
    pub(super) fn spare_redundant(&self, region: &mut Region, settling: &mut Settling, stage: &Stage) {
        let Settling { candidates, redundant, problem, .. } = settling;
        let Redundant { held, inertia, sides, jacobians, forces, as_held, spared } = redundant;
        inertia.clear();
        inertia.extend(region.bodies.iter().map(|&body| self.inertia(body)));
        let records = || candidates.iter().map(|&index| &region.records[index]);
        sides.clear();
        let place = |body| region.place(body).and_then(|place| u32::try_from(place).ok());
        sides.extend(records().map(|record| record.bodies().map(place)));
        jacobians.clear();
        jacobians.extend(records().map(|record| record.motion.kinematics.jacobian));
        forces.clear();
        forces.extend(records().map(|record| record.response.force.unwrap_or_default()));
        let of_contacts = records().zip(&*forces).filter(|(record, _)| !record.parties.bilateral);
        let largest = of_contacts.fold(0.0, |most, (_, force)| f64::max(most, force.abs()));
        if self.is_jam(region, stage, largest) {
            return;
        }
        let mut is_seen = region.cause != Cause::Start;
        loop {
            held.set_structure(inertia, sides);
            if held.factorize(jacobians) == 0 {
                break;
            }
            if !is_seen {
                as_held.clear();
                as_held.resize(candidates.len(), 0.0);
                held.solve(problem.offset(), as_held);
                let mut pulls = candidates.iter().zip(&*as_held);
                is_seen = pulls.any(|(&index, &force)| {
                    !region.records[index].parties.bilateral && force < -ROUNDING * largest
                });
                if !is_seen {
                    return;
                }
            }
            let may_pull = |row: usize| region.records[candidates[row]].parties.bilateral;
            held.spare(forces, may_pull, spared);
            if spared.is_empty() {
                break;
            }
            spared.sort_unstable();
            for &row in &*spared {
                region.records[candidates[row]].response.force = Some(0.0);
            }
            drop_rows(candidates, spared);
            drop_rows(sides, spared);
            drop_rows(jacobians, spared);
            drop_rows(forces, spared);
        }
        for (&index, &force) in candidates.iter().zip(&*forces) {
            region.records[index].response.force = Some(force);
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
