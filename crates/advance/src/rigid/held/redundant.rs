//! Contacts of which one can be spared: where rows depend on each other, their forces leave open which of them
//! carries how much. The forces of what is held are found by elimination, which leaves out one of them; if
//! that is the wrong one, others pull.

use super::settling::Settling;
use crate::rigid::event::cause::Cause;
use crate::rigid::event::region::Region;
use crate::rigid::step::dynamics::Stage;
use crate::rigid::system::RigidSystem;
use halfgap_contact::{HeldRows, InverseInertia};

/// Buffers: the rows of the candidates, and their forces [N].
#[derive(Clone, Debug, Default)]
pub(super) struct Redundant {
    held: HeldRows,
    inertia: Vec<InverseInertia>,
    sides: Vec<[Option<u32>; 2]>,
    jacobians: Vec<[f64; 6]>,
    forces: Vec<f64>,
    /// Forces [N] as they are found of what is held.
    as_held: Vec<f64>,
    /// Rows to be left out.
    spared: Vec<usize>,
}

/// Part of the largest force of a contact that another may pull by rounding.
const ROUNDING: f64 = 1e-9;

impl RigidSystem {
    /// Spares candidates until none depends on the others, such that the forces of those that are left do
    /// not pull, if those that were found did not. What jams contradicts itself: of that none is spared. At the
    /// start, where nobody has seen them pull, none is spared unless one would.
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

/// Leaves out what belongs to the given rows, which are sorted.
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
