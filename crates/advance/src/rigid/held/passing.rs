//! Contacts that are let pass: near a dead point they act by next to no lever.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::held::settling::Settling;
use crate::rigid::region::touching::Region;
use crate::rigid::search::dead_point::{dead_point_gap, is_tied};
use crate::rigid::shares::NEGLIGIBLE;

/// Leaves out the contacts that act by next to no lever on a body held by connectors: near a dead point they would
/// need forces far larger than all loads, while the body does not lie on its other supports yet. True if any have
/// been left out.
pub(crate) fn let_pass(
    assembly: &Assembly,
    connectors: &Connectors,
    region: &Region,
    settling: &mut Settling,
) -> bool {
    let Settling { candidates, passing, levers, .. } = settling;
    levers.load(region, |body| assembly.inertia(body));
    candidates.retain(|&index| {
        let record = &region.records()[index];
        let bodies = record.bodies();
        let passes = !record.parties.bilateral
            && !record.gap_state().is_sunk_below(dead_point_gap(assembly, bodies))
            && bodies.iter().any(|&body| is_tied(connectors, body))
            && levers.left_of(region, record, |body| assembly.inertia(body)) < NEGLIGIBLE * NEGLIGIBLE;
        let touch = Touch::of(record).filter(|_| passes);
        passing.extend(touch);
        touch.is_none()
    });
    !settling.passing.is_empty()
}
