//! Candidates that are spared: as equations they would depend on others.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::group::stage::Stage;
use crate::rigid::held::jammed::is_jam;
use crate::rigid::held::redundant::{Redundant, Rows};
use crate::rigid::held::settling::Settling;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::touching::Region;
use crate::rigid::remedies::Remedy;

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
    let is_start = region.cause() == Cause::Start;
    if is_start && (rows.factorize(held) == 0 || !rows.pulls(held, problem.offset(), as_held)) {
        return;
    }
    assembly.remedies().act(Remedy::Sparing);
    rows.spare(held, region, candidates);
}

/// Lists the rows of the candidates and their forces.
fn list_candidates(assembly: &Assembly, region: &Region, candidates: &[usize], rows: &mut Rows) {
    let Rows { inertia, sides, jacobians, forces, bilateral, .. } = rows;
    inertia.clear();
    inertia.extend(region.bodies().iter().map(|&body| assembly.inertia(body)));
    let records = || candidates.iter().map(|&index| &region.records()[index]);
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
