//! Redundant contacts: where rows depend on each other, their forces are not unique. The forces of held rows are found
//! by elimination, which gives one of the dependent rows no force; if that is the wrong one, other contacts pull.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::group::dynamics::Stage;
use crate::rigid::held::settle::is_jam;
use crate::rigid::held::settling::Settling;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::region::Region;
use halfgap_contact::{HeldRows, InverseInertia, Settings};

/// The candidates as equations, with buffers.
#[derive(Clone, Debug)]
pub(super) struct Redundant {
    rows: Rows,
    held: HeldRows,
    /// Takes rows for dependent that are so nearly.
    nearly: HeldRows,
    /// Forces [N] that elimination finds for held rows.
    as_held: Vec<f64>,
}

/// The rows of the candidates and their forces.
#[derive(Clone, Debug, Default)]
struct Rows {
    inertia: Vec<InverseInertia>,
    sides: Vec<[Option<u32>; 2]>,
    jacobians: Vec<[f64; 6]>,
    forces: Vec<f64>,
    /// True for rows of connectors, which may pull.
    bilateral: Vec<bool>,
    /// Rows to be spared.
    spared: Vec<usize>,
}

/// Fraction of the largest contact force by which a contact may pull by rounding.
const ROUNDING: f64 = 1e-9;
/// Fraction of a row's square, left by other rows, up to which the row nearly depends on them.
const NEARLY: f64 = 1e-6;

impl Default for Redundant {
    fn default() -> Self {
        let nearly = Settings { dependence: NEARLY, ..Settings::default() };
        Self {
            rows: Rows::default(),
            held: HeldRows::default(),
            nearly: HeldRows::new(&nearly),
            as_held: Vec::new(),
        }
    }
}

/// Spares candidates until none depends on the others, such that the remaining contacts do not pull if none pulled
/// in the solution found. In a jam, whose rows contradict each other, none is spared; nor at the start, unless a
/// contact would pull by elimination. The problem must be that of the candidates.
pub(crate) fn spare_redundant(
    assembly: &Assembly,
    region: &mut Region,
    settling: &mut Settling,
    stage: &Stage,
) {
    let Settling { candidates, redundant, problem, .. } = settling;
    let Redundant { rows, held, as_held, .. } = redundant;
    list_candidates(assembly, region, candidates, rows);
    let largest = rows.largest_force();
    if is_jam(assembly, region, stage, largest) {
        return;
    }
    let is_start = region.cause == Cause::Start;
    if is_start && (rows.factorize(held) == 0 || !rows.pulls(held, problem.offset(), as_held)) {
        return;
    }
    rows.spare(held, region, candidates);
}

/// Spares candidates until none nearly depends on the others, if any does. Forces that are spread over such rows
/// are modest; as equations, the rows would have immense ones.
pub(crate) fn spare_nearly_redundant(assembly: &Assembly, region: &mut Region, settling: &mut Settling) {
    let Settling { candidates, redundant, .. } = settling;
    let Redundant { rows, held, nearly, .. } = redundant;
    list_candidates(assembly, region, candidates, rows);
    let dependent = rows.factorize(held);
    if held.kept_beyond(dependent) <= NEARLY {
        rows.spare(nearly, region, candidates);
    }
}

/// Lists the rows of the candidates and their forces.
fn list_candidates(assembly: &Assembly, region: &Region, candidates: &[usize], rows: &mut Rows) {
    let Rows { inertia, sides, jacobians, forces, bilateral, .. } = rows;
    inertia.clear();
    inertia.extend(region.bodies.iter().map(|&body| assembly.inertia(body)));
    let records = || candidates.iter().map(|&index| &region.records[index]);
    sides.clear();
    let place = |body| region.place(body).and_then(|place| u32::try_from(place).ok());
    sides.extend(records().map(|record| record.bodies().map(place)));
    jacobians.clear();
    jacobians.extend(records().map(|record| record.motion.kinematics.jacobian));
    forces.clear();
    forces.extend(records().map(|record| record.response.force.unwrap_or_default()));
    bilateral.clear();
    bilateral.extend(records().map(|record| record.parties.bilateral));
}

impl Rows {
    /// Largest force [N] of a contact.
    fn largest_force(&self) -> f64 {
        let contacts = self.forces.iter().zip(&self.bilateral).filter(|(_, bilateral)| !**bilateral);
        contacts.fold(0.0, |most, (force, _)| f64::max(most, force.abs()))
    }

    /// Factors the rows; returns the number of those that depend on others.
    fn factorize(&self, held: &mut HeldRows) -> usize {
        held.set_structure(&self.inertia, &self.sides);
        held.factorize(&self.jacobians)
    }

    /// True if a contact pulls by more than rounding with the forces that elimination finds. The rows must be factored;
    /// `offset` holds the accelerations [m/s^2] of their gaps without forces.
    fn pulls(&self, held: &mut HeldRows, offset: &[f64], as_held: &mut Vec<f64>) -> bool {
        as_held.clear();
        as_held.resize(self.forces.len(), 0.0);
        held.solve(offset, as_held);
        let least = -ROUNDING * self.largest_force();
        as_held.iter().zip(&self.bilateral).any(|(&force, &bilateral)| !bilateral && force < least)
    }

    /// Spares candidates until `held` finds none that depends on the others, and writes the forces into their records.
    fn spare(&mut self, held: &mut HeldRows, region: &mut Region, candidates: &mut Vec<usize>) {
        while self.factorize(held) > 0 {
            let Self { sides, jacobians, forces, bilateral, spared, .. } = self;
            held.spare(forces, |row| bilateral[row], spared);
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
            drop_rows(bilateral, spared);
        }
        for (&index, &force) in candidates.iter().zip(&self.forces) {
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
