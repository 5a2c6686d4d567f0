//! The rows that are active after an event, once low hops are stilled.

use crate::rigid::active_set::hops::any_active_hops;
use crate::rigid::active_set::settle::settle;
use crate::rigid::contacts::pairs::is_likely;
use crate::rigid::error::AdvanceError;
use crate::rigid::event::hops::still_hops;
use crate::rigid::event::jamming::unjam;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::work::EventWork;
use crate::rigid::region::cause::Cause;
use crate::rigid::remedies::Remedy;
use crate::rigid::shares::ROUNDS;
use crate::rigid::zeno::repeats::has_pulled;

/// Finds the active rows, and stills those that hop: stopping some contacts makes others hop.
pub(crate) fn settle_and_still(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    let EventWork { region, settling, .. } = &mut *work;
    settling.set_likely(region.records().iter().map(|record| is_likely(&rooms.pairs, record)));
    settling.expect_forces(region, &rooms.books.told().changes().end);
    // Where a slip has come to a stop, those that did so at the same time just before do not go on either; anything else changes all.
    let is_stop = matches!(region.cause(), Cause::Stopped(..));
    settling.set_stopped(if is_stop { rooms.zeno.stopped(rooms.assembly.now()) } else { &[] });
    let is_on = rooms.assembly.remedies().is_on(Remedy::LowHops);
    let may_hop = is_on && work.region.cause() != Cause::Start && !work.region.is_hasty();
    settle_region(rooms, work, may_hop)?;
    for round in 1..=ROUNDS {
        if !is_on || !any_active_hops(&rooms.assembly, &work.region, &work.settling) {
            break;
        }
        let is_stilled =
            still_hops(&mut rooms.assembly, &rooms.connectors, &rooms.pairs, &mut rooms.books, work);
        let with_hops = is_stilled && may_hop && round < ROUNDS;
        settle_region(rooms, work, with_hops)?;
    }
    Ok(())
}

/// Number of jumps at one time: afterwards forces mostly have a solution, or contacts have come to rest.
const MOST_JUMPS: usize = 20;

fn settle_region(rooms: &mut Rooms, work: &mut EventWork, with_hops: bool) -> Result<(), AdvanceError> {
    work.settling.forget_loose();
    if work.region.cause() == Cause::Collapsed {
        unjam(rooms, work);
    }
    for _ in 0..MOST_JUMPS {
        match settle_once(rooms, work, with_hops) {
            Err(AdvanceError::Contacts { .. }) if work.settling.any_slips() && unjam(rooms, work) => {}
            outcome => return outcome,
        }
    }
    settle_once(rooms, work, with_hops)
}

fn settle_once(rooms: &mut Rooms, work: &mut EventWork, with_hops: bool) -> Result<(), AdvanceError> {
    let mut stage = rooms.groups.take_stage();
    work.settling.note_pull(has_pulled(&rooms.zeno, rooms.assembly.now()));
    let outcome = settle(
        &rooms.view(),
        &mut work.region,
        &mut work.settling,
        &mut stage,
        rooms.assembly.now(),
        with_hops,
    );
    rooms.groups.put_stage(stage);
    outcome
}
