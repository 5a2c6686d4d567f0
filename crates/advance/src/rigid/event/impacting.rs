//! An event in which bodies collide: groups are cut at its time, the impact is resolved.

use crate::rigid::books::impacts::{Booking, book_impact, fastest_row};
use crate::rigid::contacts::gaps::gap_at;
use crate::rigid::error::AdvanceError;
use crate::rigid::event::cutting::cut_groups;
use crate::rigid::event::going_on::go_on;
use crate::rigid::event::lift::put_back;
use crate::rigid::event::resolving::resolve_impact;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::steps::has_gone_by_steps;
use crate::rigid::event::work::EventWork;
use crate::rigid::impact::impacts::Manner;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::collecting::collect_region;
use crate::rigid::region::records::remeasure;
use crate::rigid::remedies::Remedy;
use crate::rigid::zeno::accumulation::note_events;
use crate::rigid::zeno::pace::forget_paces;

pub(crate) fn handle_impact(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    let fired = work.region.cause().fired();
    collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now());
    if work.region.is_led() {
        cut_groups(rooms, &mut work.region);
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now());
    }
    let rest = rooms.assembly.rest_speed();
    work.fired_open =
        fired.is_some_and(|fired| !gap_at(&rooms.assembly, fired, rooms.assembly.now()).closes(rest));
    if work.region.cause() == Cause::Tick {
        put_back(rooms, work);
    }
    collide(rooms, work)
}

/// Resolves the impact of a region whose bodies are in flight, and goes on.
pub(crate) fn collide(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    if has_gone_by_steps(rooms, work)? {
        return Ok(());
    }
    // One event too many in a short time is resolved without elasticity.
    let is_accumulating = {
        let of = (work.region.bodies(), work.region.records());
        note_events(&rooms.assembly, &mut rooms.zeno, &mut rooms.books, of)
    };
    work.region.set_accumulating(is_accumulating && rooms.assembly.remedies().act(Remedy::Accumulation));
    strike(rooms, work)
}

/// Resolves the impact of a region whose bodies are in flight, without elasticity if its events accumulate, and goes on.
pub(crate) fn strike(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    let is_accumulating = work.region.is_accumulating();
    let mut report = rooms.books.take_report();
    let now = rooms.assembly.now();
    let is_lawful = !is_accumulating && work.region.cause() != Cause::Tick;
    let manner = if is_lawful { Manner::Lawful(rooms.books.counts().impacts) } else { Manner::Inelastic };
    let outcome = resolve_impact(rooms, &mut work.region, &mut work.impact, &mut report, now, manner);
    if outcome.is_ok() {
        book_impact(
            &rooms.assembly,
            &mut rooms.books,
            &report,
            if is_accumulating { Booking::Capture } else { Booking::BySpeed },
        );
    }
    rooms.books.put_report(report);
    outcome?;
    // A row that comes to rest without having closed is a contact that begins, not an impact.
    let at_joint = work.region.cause() == Cause::SmoothJoint;
    let fastest = fastest_row(rooms.books.told().last_impact(), !at_joint);
    if fastest > rooms.assembly.rest_speed() {
        rooms.books.note_impact();
    }
    // Slower impacts may be of contacts that take turns.
    if fastest > rooms.assembly.settings().tolerances.velocity_tol {
        forget_paces(&mut rooms.zeno, work.region.bodies());
    }
    remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now());
    go_on(rooms, work)
}

/// Collects the region of bodies in flight anew. The groups that have been cut no longer tell which bodies belong
/// together; others may have come in, and are cut, too.
pub(crate) fn collect_again(rooms: &mut Rooms, work: &mut EventWork) {
    work.seeds.clear();
    work.seeds.extend(work.region.bodies());
    collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now());
    if work.region.is_led() {
        cut_groups(rooms, &mut work.region);
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now());
    }
}
