//! Contacts that are excluded because they act by next to no lever, near a dead point.

use crate::rigid::active_set::exclusion::{Excluded, Exclusion};
use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::region::touching::Region;
use crate::rigid::search::dead_point::{dead_point_gap, is_tied};
use crate::rigid::shares::NEGLIGIBLE;

/// Excludes the contacts that act by next to no lever on a body held by connectors: near a dead point they would
/// need forces far larger than all loads, while the body does not lie on its other supports yet. True if any are
/// excluded.
pub(crate) fn exclude_leverless(
    assembly: &Assembly,
    connectors: &Connectors,
    region: &Region,
    settling: &mut Settling,
) -> bool {
    let Settling { candidates, excluded, levers, .. } = settling;
    levers.load(region, |body| assembly.inertia(body));
    candidates.retain(|&index| {
        let record = &region.records()[index];
        let bodies = record.bodies();
        let is_leverless = Touch::of(record).is_some()
            && !record.gap_state().is_sunk_below(dead_point_gap(assembly, bodies))
            && bodies.iter().any(|&body| is_tied(connectors, body))
            && levers.left_of(region, record, |body| assembly.inertia(body)) < NEGLIGIBLE * NEGLIGIBLE;
        excluded.extend(is_leverless.then(|| Excluded::of(region, index, Exclusion::Leverless)));
        !is_leverless
    });
    settling.any_excluded(Exclusion::Leverless)
}
