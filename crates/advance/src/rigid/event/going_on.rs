//! How an event goes on once velocities are known: active rows, groups, predictions.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::instant::is_same_time;
use crate::rigid::books::all::Books;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::bounces::note_seen;
use crate::rigid::contacts::gaps::features_in;
use crate::rigid::contacts::rows::RowSource;
use crate::rigid::error::AdvanceError;
use crate::rigid::event::corners::leave_loose_corner;
use crate::rigid::event::groups::regroup;
use crate::rigid::event::one_gap::bring_to_one_gap;
use crate::rigid::event::rails::note_rails;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::rules::{lower_insistent, set_rules};
use crate::rigid::event::settling::settle_and_still;
use crate::rigid::event::telling::note_begins;
use crate::rigid::event::work::EventWork;
use crate::rigid::region::touching::{Region, measure_touches};
use crate::rigid::remedies::Remedy;
use crate::rigid::zeno::pace::take_haste;
use crate::rigid::zeno::repeats::has_pulled;
use halfgap_geometry::GapSample;

/// Finds the active rows, makes groups, and predicts: the bodies of the region are in flight with their new
/// velocities.
pub(crate) fn go_on(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    for &body in work.region.bodies() {
        rooms.assembly.trajectory_mut(body).unwind();
    }
    note_rails(&rooms.assembly, &mut rooms.connectors, &work.region, rooms.assembly.now());
    // Contacts that open slowly become inactive, too, where their group pulled: active, they move others along.
    let is_hasty =
        take_haste(&mut rooms.zeno, work.region.bodies()) || has_pulled(&rooms.zeno, rooms.assembly.now());
    let is_hasty = is_hasty && rooms.assembly.remedies().act(Remedy::Haste);
    work.region.set_hasty(is_hasty);
    settle_and_still(rooms, work)?;
    while leave_loose_corner(rooms, work)? {
        settle_and_still(rooms, work)?;
    }
    bring_to_one_gap(rooms, work);
    measure_touches(&rooms.assembly, &mut work.region);
    note_gaps(&rooms.assembly, &mut rooms.books, &work.region);
    let touching = work.region.touches().iter().copied().zip(work.region.motions().iter().copied());
    let fired = work.region.cause().fired().map(|touch| (touch, work.fired_open));
    note_seen(&rooms.assembly, &mut rooms.pairs, touching, fired);
    let outcome = regroup(rooms, &work.region, &work.settling);
    note_begins(&rooms.assembly, &rooms.connectors, &mut rooms.books, &work.region, &work.settling);
    outcome?;
    set_rules(&rooms.assembly, &mut rooms.pairs, &mut rooms.search, &rooms.groups, work);
    let insists = rooms.zeno.last_insistent().is_some_and(|last| is_same_time(last, rooms.assembly.now()));
    if insists && rooms.assembly.remedies().act(Remedy::Insistence) {
        lower_insistent(&rooms.assembly, &mut rooms.pairs, &mut rooms.search, &work.region);
    }
    for &body in work.region.bodies() {
        rooms.searching().renew_stay(body);
    }
    rooms.searching().predict_all_of(work.region.bodies(), true);
    note_unilateral_connectors(&rooms.assembly, &mut rooms.connectors, &work.region, &work.settling);
    rooms.searching().predict_ropes(work.region.bodies());
    Ok(())
}

/// Notes the least gap of features of a region that lie opposite each other: beyond their ends a gap is no distance
/// between bodies.
fn note_gaps(assembly: &Assembly, books: &mut Books, region: &Region) {
    for (&touch, gap) in region.touches().iter().zip(region.motions()) {
        if books.counts().smallest_gap.is_some_and(|least| least <= gap.distance) {
            continue;
        }
        let [a, b] = features_in(assembly, touch);
        let pose = touch.bodies.map(|body| assembly.trajectory(body).moving_at(assembly.now()).pose);
        let is_opposite =
            |sample: GapSample| sample.excess_primary.max(sample.excess_normal).max(sample.overrun) <= 0.0;
        if GapSample::measure(a, &pose[0], b, &pose[1]).is_some_and(is_opposite) {
            books.note_gap(gap.distance);
        }
    }
}

/// Notes which unilateral connectors of a region are active from now on, and the rows of those that are touched.
fn note_unilateral_connectors(
    assembly: &Assembly,
    connectors: &mut Connectors,
    region: &Region,
    settling: &Settling,
) {
    for &body in region.bodies() {
        for index in 0..connectors.of(body).len() {
            let id = connectors.of(body)[index];
            if !connectors.connector(id).is_bilateral() {
                let mut active = settling.active().iter();
                let is_active = active.any(|(_, row)| row.source == RowSource::Connector(id, 0));
                connectors.set_active(id, is_active);
            }
            if connectors.connector(id).is_unilateral() {
                connectors.note_seen(assembly, id);
            }
        }
    }
}
