//! Candidates that are excluded because as equations they would depend on others.

use crate::rigid::active_set::jammed::is_jam;
use crate::rigid::active_set::redundant::{Redundant, Rows};
use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::group::stage::Stage;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::touching::Region;
use crate::rigid::remedies::Remedy;

/// Excludes candidates until none depends on the others, such that the remaining contacts do not pull if none pulled
/// in the solution found. In a jam, whose rows contradict each other, none is excluded; nor at the start, unless a
/// contact would pull by elimination. The problem must be that of the candidates.
pub(crate) fn exclude_dependent(
    assembly: &Assembly,
    region: &mut Region,
    settling: &mut Settling,
    stage: &Stage,
) {
    let Settling { candidates, redundant, problem, .. } = settling;
    let Redundant { rows, active, as_active, .. } = redundant;
    list_candidates(assembly, region, candidates, rows);
    let largest = rows.largest_force();
    if is_jam(assembly, region, stage, largest) {
        return;
    }
    let is_start = region.cause() == Cause::Start;
    if is_start && (rows.factorize(active) == 0 || !rows.pulls(active, problem.offset(), as_active)) {
        return;
    }
    assembly.remedies().act(Remedy::DependentRows);
    rows.exclude_dependent(active, region, candidates);
}

/// Lists the rows of the candidates and their forces.
fn list_candidates(assembly: &Assembly, region: &Region, candidates: &[usize], rows: &mut Rows) {
    let Rows { inertia, sides, thirds, jacobians, forces, bilateral, .. } = rows;
    inertia.clear();
    inertia.extend(region.bodies().iter().map(|&body| assembly.inertia(body)));
    let records = || candidates.iter().map(|&index| &region.records()[index]);
    sides.clear();
    let place = |body| region.place(body).and_then(|place| u32::try_from(place).ok());
    sides.extend(records().map(|record| record.bodies().map(place)));
    thirds.clear();
    thirds.extend(records().map(|record| {
        let (body, coefficient) = record.parties.third?;
        Some((place(body)?, coefficient))
    }));
    jacobians.clear();
    jacobians.extend(records().map(|record| record.motion.kinematics.jacobian));
    forces.clear();
    forces.extend(records().map(|record| record.response.force.unwrap_or_default()));
    bilateral.clear();
    bilateral.extend(records().map(|record| record.parties.bilateral));
}
