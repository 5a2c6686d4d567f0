//! An event in which active rows change without an impact, unless other contacts close.

use crate::rigid::active_set::leaving::retain_staying;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::error::AdvanceError;
use crate::rigid::event::cutting::cut_groups;
use crate::rigid::event::going_on::go_on;
use crate::rigid::event::impacting::{collect_again, collide};
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::steps::has_gone_by_steps;
use crate::rigid::event::work::EventWork;
use crate::rigid::region::collecting::{collect_region, passes_by};
use crate::rigid::region::records::remeasure;
use crate::rigid::region::touching::Region;
use crate::rigid::remedies::Remedy;

/// Handles a change of the active rows. Other contacts that close within their target zones make it an impact.
pub(crate) fn handle_change(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now());
    cut_groups(rooms, &mut work.region);
    remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now());
    if neighbour_closes(&rooms.assembly, &work.region) {
        // Cutting moves bodies a little, and a corner that was passed a moment ago may be ahead again: it takes
        // over only if it is nearest now.
        collect_again(rooms, work);
    }
    let region = &mut work.region;
    if work.repeats > 0 && rooms.assembly.remedies().act(Remedy::LeavingNeighbours) {
        // Two corners that pass each other may hand over to each other without end.
        retain_staying(&rooms.assembly, &rooms.connectors, region);
    }
    // Beside a seam a corner may be as near to the next corner, and pass over it.
    let remedies = rooms.assembly.remedies();
    region.retain_records(|record| {
        let may_pass = !record.must_handle && record.gap_state().rebounds();
        !(may_pass && passes_by(&rooms.search, record) && remedies.act(Remedy::PassingBy))
    });
    // A joint that closes takes an impact, too.
    let rest = rooms.assembly.rest_speed();
    if work.region.records().iter().any(|record| record.gap_state().closes(rest)) {
        return collide(rooms, work);
    }
    if has_gone_by_steps(rooms, work)? {
        return Ok(());
    }
    go_on(rooms, work)
}

/// True if another contact closes of the two bodies whose contact has run off its features.
fn neighbour_closes(assembly: &Assembly, region: &Region) -> bool {
    let Some(run_off) = region.cause().run_off() else { return false };
    let rest = assembly.rest_speed();
    let mut colliding = region.records().iter().filter(|record| record.gap_state().is_colliding(rest));
    colliding.any(|record| Touch::of(record).is_some_and(|touch| touch.bodies == run_off.bodies))
}
