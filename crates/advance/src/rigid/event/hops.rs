//! Hops that are stilled: their bodies get the velocities that they will have after the landing.

use crate::rigid::active_set::hops::{force_of, opens, time_of_hops};
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::all::Books;
use crate::rigid::books::impacts::{Booking, book_impact};
use crate::rigid::connectors::corners::stays_in_corner;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::pairs::Pairs;
use crate::rigid::event::work::EventWork;
use crate::rigid::impact::impacts::{conclude_impact, set_rows};
use crate::rigid::region::records::remeasure;
use crate::rigid::remedies::Remedy;

/// Gives the bodies of active contacts that open in low hops the velocities that they will have after the landing,
/// and lets contacts leave that open all the same. False if nothing is changed.
///
/// The impulse of each active contact until the landing follows from its force. These impulses are taken away, so
/// that the hops come down at once, and an impact without elasticity returns as much of them as is needed. So a
/// contact is stopped by no more than what presses on it: where normals hardly differ, large impulses that cancel
/// each other would also stop a body that slides over the contacts.
pub(crate) fn still_hops(
    assembly: &mut Assembly,
    connectors: &Connectors,
    pairs: &Pairs,
    books: &mut Books,
    work: &mut EventWork,
) -> bool {
    // At the start some contacts may be about to collide; their impacts must not be stopped along with the hops.
    if work.region.records().iter().any(|record| record.gap_state().rebounds()) {
        return false;
    }
    let Some(wait) = time_of_hops(assembly, &work.region, &work.settling) else { return false };
    assembly.remedies().act(Remedy::LowHops);
    let EventWork { region, impact, settling, carried, stop, .. } = &mut *work;
    carried.clear();
    carried.resize(region.records().len(), 0.0);
    for &(index, _) in settling.active() {
        let record = &region.records()[index];
        carried[index] = if record.parties.bilateral { 0.0 } else { force_of(record) * wait };
    }
    set_rows(assembly, connectors, pairs, region, impact);
    impact.unload(carried);
    if impact.try_inelastic().is_err() {
        return false;
    }
    conclude_impact(assembly, books, region, impact, stop, assembly.now());
    remeasure(assembly, connectors, region, assembly.now());
    book_impact(assembly, books, stop, Booking::Capture);
    settling.let_leave(|index| {
        let record = &region.records()[index];
        opens(assembly, record) && !stays_in_corner(connectors, record)
    });
    true
}
