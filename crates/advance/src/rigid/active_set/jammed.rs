//! Contact forces so large that rows seem to work against each other.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::group::stage::Stage;
use crate::rigid::region::touching::Region;
use crate::rigid::shares::MAJOR;

/// True if contact forces are so much larger than the loads of the bodies that rows seem to work against each
/// other, as those on both sides of a body that just fits. Connectors do not count: those with long arms have such
/// forces anyway.
pub(crate) fn is_jammed(assembly: &Assembly, region: &Region, settling: &Settling, stage: &Stage) -> bool {
    let forces = settling.candidates.iter().zip(&settling.solution.force);
    let of_contacts = forces.filter(|&(&index, _)| !region.records()[index].parties.bilateral);
    is_jam(assembly, region, stage, of_contacts.fold(0.0, |most, (_, force)| most.max(force.abs())))
}

/// True if a largest contact force [N] is that of a jam.
pub(crate) fn is_jam(assembly: &Assembly, region: &Region, stage: &Stage, largest: f64) -> bool {
    let loads =
        region.bodies().iter().zip(stage.accelerations()).map(|(&body, a)| assembly.trajectory(body).load(a));
    largest > MAJOR * loads.sum::<f64>()
}
