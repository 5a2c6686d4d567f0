//! Handling of an event: cut the groups that it touches at its time, resolve the impact, find the held rows, go on.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::Books;
use crate::rigid::books::energy::note_kinetic_energy_before;
use crate::rigid::books::report::{ImpactReport, note_begins};
use crate::rigid::connectors::corners::{go_along, note_corners};
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::bounces::{closes_fast, note_seen};
use crate::rigid::contacts::gaps::{features_in, gap_at, leaves};
use crate::rigid::contacts::pairs::{PairId, is_likely};
use crate::rigid::contacts::rows::RowSource;
use crate::rigid::contacts::touch::{Touch, sorted};
use crate::rigid::error::AdvanceError;
use crate::rigid::event::corners::leave_loose_corner;
use crate::rigid::event::cutting::cut_groups;
use crate::rigid::event::groups::let_go;
use crate::rigid::event::harm::regroup_soundly;
use crate::rigid::event::joints::{meet_stop, pass_joint};
use crate::rigid::event::life::{continue_group, look_further};
use crate::rigid::event::lift::put_back;
use crate::rigid::event::rails::note_rails;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::rules::{lower_insistent, set_rules};
use crate::rigid::event::ticks::{note_pressed, sinks};
use crate::rigid::event::with_work::with_work;
use crate::rigid::event::work::EventWork;
use crate::rigid::group::group::SegmentEnd;
use crate::rigid::group::groups::group_of;
use crate::rigid::held::hops::{any_held_hops, still_hops};
use crate::rigid::held::leaving::retain_staying;
use crate::rigid::held::settle::settle;
use crate::rigid::held::settling::Settling;
use crate::rigid::impact::impacts::{Manner, resolve_impact};
use crate::rigid::region::cause::Cause;
use crate::rigid::region::collecting::collect_region;
use crate::rigid::region::records::remeasure;
use crate::rigid::region::region::{Region, measure_touches};
use crate::rigid::search::neighbourhood::Neighbourhood;
use crate::rigid::zeno::pace::{forget_paces, take_haste};
use crate::rigid::zeno::repeats::{CALM_REPEATS, has_pulled, is_same_time, note_repeat};
use crate::rigid::zeno::storms::note_events;
use crate::time::Time;
use halfgap_collision::{Body, BodyId, BodyState, Collision, ConnectorId, Detector, Zone};
use halfgap_geometry::{FeatureId, GapSample};

/// Angle [rad] within which joints are smooth: twice that by which their features reach beyond them, and some rounding.
const SEAM_ANGLE: f64 = 4e-9;
/// Largest change of the velocities of bodies' points by an impact that stops contacts, as a multiple of the rates that
/// were stopped.
const MODEST: f64 = 100.0;
/// Largest impulse of such an impact, as a multiple of the largest change of momentum of a body.
const MOST_CANCELLING: f64 = 10.0;
/// Largest number of rounds in which the low hops of one event are stilled.
const HOP_ROUNDS: u32 = 4;

/// Entry of the ledger in which the energy of an impact is booked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Booking {
    /// As an impact, unless it is slow.
    BySpeed,
    /// As a capture: rows were stopped without elasticity, whatever their speed.
    Capture,
}

/// Finds the rows that are held at the start.
pub(crate) fn establish(rooms: &mut Rooms) -> Result<(), AdvanceError> {
    with_work(rooms, Cause::Start, |rooms, work| {
        work.seeds.clear();
        work.seeds.extend(rooms.assembly.bodies());
        note_corners(&rooms.assembly, &mut rooms.connectors);
        collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now);
        if !closes_slowly(&rooms.assembly, &work.region) {
            return go_on(rooms, work);
        }
        // Contacts that close fast fire in their own time, unless they are in their target zone now.
        let fast = |record: &Collision| closes_fast(record) && record.zone() < Zone::Target;
        work.region.records.retain(|record| !fast(record));
        collide(rooms, work)
    })
}

/// True if any contact of a region closes so slowly that it is to be captured, but is not at rest yet.
fn closes_slowly(assembly: &Assembly, region: &Region) -> bool {
    let closes = |record: &Collision| {
        record.motion.normal_velocity < -assembly.start_rest_of(record) && !closes_fast(record)
    };
    let mut records = region.records.iter().filter(|record| !record.parties.bilateral);
    assembly.settings.impulse_step.is_none() && records.any(closes)
}

/// Handles the contact of two features of a pair.
pub(crate) fn handle_contact(
    rooms: &mut Rooms,
    pair: PairId,
    features: [FeatureId; 2],
) -> Result<(), AdvanceError> {
    let bodies = rooms.pairs.bodies(pair);
    if sinks(rooms, pair, features)
        || rooms.searching().passes_over(pair, features)
        || rooms.searching().grazes(pair, features)
    {
        return Ok(());
    }
    let touch = Touch::new(bodies, features);
    note_pressed(&rooms.assembly, &mut rooms.sinking, touch)?;
    let repeats = note_repeat(&rooms.assembly, &mut rooms.pairs, &mut rooms.zeno, pair)?;
    with_work(rooms, Cause::Fired(touch), |rooms, work| {
        work.repeats = repeats.saturating_sub(CALM_REPEATS);
        work.seeds.clear();
        work.seeds.extend(bodies);
        handle_impact(rooms, work)
    })
}

/// Handles the end of a group's segment, natural or early.
pub(crate) fn handle_group(rooms: &mut Rooms, leader: BodyId) -> Result<(), AdvanceError> {
    if group_of(&rooms.assembly, &rooms.groups, leader).is_some_and(|group| group.look.is_some()) {
        look_further(
            &mut rooms.assembly,
            &mut rooms.connectors,
            &mut rooms.groups,
            &mut rooms.agenda,
            leader,
        );
        return Ok(());
    }
    if group_of(&rooms.assembly, &rooms.groups, leader).is_some_and(|group| group.event.is_none()) {
        return extend_naturally(rooms, leader);
    }
    with_work(rooms, Cause::Other, |rooms, work| handle_group_with(rooms, leader, work))
}

fn handle_group_with(rooms: &mut Rooms, leader: BodyId, work: &mut EventWork) -> Result<(), AdvanceError> {
    let Some(group) = group_of(&rooms.assembly, &rooms.groups, leader) else { return Ok(()) };
    work.seeds.clear();
    work.seeds.extend(&group.bodies);
    let Some((_, end)) = group.event else { return Ok(()) };
    match end {
        SegmentEnd::Release(row) => {
            if let Some(touch) = group.rows[row].touch() {
                work.region.cause = Cause::Released(touch);
            }
            let source = group.rows[row].source;
            if group.made == rooms.assembly.now {
                rooms.zeno.last_pull = Some(rooms.assembly.now);
            }
            if let RowSource::Connector(id, side @ (0 | 1)) = source {
                go_along(&mut rooms.connectors, id, 1 - side);
            }
            handle_change(rooms, work)
        }
        SegmentEnd::Change(row) => match (group.rows[row].touch(), group.rows[row].source) {
            (_, RowSource::Connector(id, _)) => pass_joint(rooms, work, id),
            (touch, RowSource::Contact(_)) => {
                let left = touch.filter(|&touch| leaves(&rooms.assembly, &rooms.connectors, touch));
                work.region.cause = left.map_or(Cause::Other, Cause::RunOff);
                if let Some(pair) = left.and_then(|left| rooms.pairs.between(left.bodies[0], left.bodies[1]))
                {
                    work.repeats = note_repeat(&rooms.assembly, &mut rooms.pairs, &mut rooms.zeno, pair)?
                        .saturating_sub(CALM_REPEATS);
                }
                handle_change(rooms, work)
            }
        },
        SegmentEnd::Sink(row) => {
            // A contact that was touched without force has sunk.
            let Some(touch) = group.idle[row].touch() else { return Ok(()) };
            work.region.cause = Cause::Fired(touch);
            handle_impact(rooms, work)
        }
        SegmentEnd::Stop(id) => meet_stop(rooms, work, id),
        SegmentEnd::Switch => handle_change(rooms, work),
    }
}

fn extend_naturally(rooms: &mut Rooms, leader: BodyId) -> Result<(), AdvanceError> {
    let_go(rooms, leader);
    continue_group(rooms, leader)?;
    let mut bodies = std::mem::take(&mut rooms.groups.extended);
    bodies.clear();
    bodies
        .extend(group_of(&rooms.assembly, &rooms.groups, leader).into_iter().flat_map(|group| &group.bodies));
    for &body in &bodies {
        rooms.searching().renew_stay(body);
    }
    rooms.searching().predict_all_of(&bodies, false);
    rooms.searching().search_ropes_on(&bodies);
    rooms.groups.extended = bodies;
    Ok(())
}

/// Handles a rope that goes taut.
pub(crate) fn handle_rope(rooms: &mut Rooms, id: ConnectorId) -> Result<(), AdvanceError> {
    with_work(rooms, Cause::Taut(id), |rooms, work| {
        work.seeds.clear();
        work.seeds.extend(rooms.connectors.connector(id).bodies());
        handle_impact(rooms, work)
    })
}

/// Handles a change of the held rows. Other contacts that close within their target zones make it an impact.
fn handle_change(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now);
    cut_groups(rooms, &mut work.region);
    remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now);
    if neighbour_closes(&rooms.assembly, &work.region) {
        // Cutting moves bodies a little, and a corner that was passed a moment ago may be ahead again: it takes
        // over only if it is nearest now.
        collect_again(rooms, work);
    }
    hand_over(rooms, work);
    let region = &mut work.region;
    if work.repeats > 0 {
        // Two corners that pass each other may hand over to each other without end.
        retain_staying(&rooms.assembly, &rooms.connectors, region);
    }
    // Beside a seam a corner may be as near to the next corner, and pass over it.
    region.records.retain(|record| !(closes_fast(record) && passes_by(&rooms.search, record)));
    let rest = rooms.assembly.rest_speed();
    if work.region.records.iter().any(|record| record.motion.normal_velocity < -rest) {
        return collide(rooms, work);
    }
    go_on(rooms, work)
}

/// True if two corners pass each other before they come to the gap at which their bodies fire.
pub(crate) fn passes_by(search: &Neighbourhood, record: &Collision) -> bool {
    if record.parties.detector != Detector::CornerCorner {
        return false;
    }
    let halo = |body: BodyId| search.lanes[body.index()].halo;
    let halos = halo(record.parties.primary.body).min(halo(record.parties.normal.body));
    let (along, across) = (record.motion.normal_velocity, record.motion.lateral_velocity);
    let nearest = record.geometry.distance * across.abs() / libm::hypot(along, across);
    nearest > halos.min(record.tolerances.target_gap)
}

/// True if another contact closes of the two bodies whose contact has run off its features.
fn neighbour_closes(assembly: &Assembly, region: &Region) -> bool {
    let Some(run_off) = region.cause.run_off() else { return false };
    let rest = assembly.rest_speed();
    let mut closing = region.records.iter().filter(|record| record.motion.normal_velocity < -rest);
    closing.any(|record| Touch::of(record).is_some_and(|touch| touch.bodies == run_off.bodies))
}

/// Continues a contact that goes from one feature to the next along a smooth joint: the rate of its neighbour comes
/// only from the angle up to which joints are smooth, and is stopped. Where another contact closes fast at the same
/// moment, the impact does that.
fn hand_over(rooms: &mut Rooms, work: &mut EventWork) {
    let Some(run_off) = work.region.cause.run_off() else { return };
    let is_neighbour = |record: &Collision| {
        let bodies = sorted(record.parties.primary.body, record.parties.normal.body);
        let (rate, speed) = (record.motion.normal_velocity, record.motion.center_velocity.length());
        bodies == run_off.bodies && rate.abs() <= SEAM_ANGLE * speed
    };
    let records = &mut work.region.records;
    if records.iter().any(|record| closes_fast(record) && !is_neighbour(record)) {
        return;
    }
    let mut any = false;
    for record in records.iter_mut().filter(|record| is_neighbour(record)) {
        record.parties.bilateral = true;
        any = true;
    }
    if any {
        stop_bilaterally(rooms, work);
    }
}

/// Collects the region of bodies in flight anew. The groups that have been cut no longer tell which bodies belong
/// together; others may have come in, and are cut, too.
pub(crate) fn collect_again(rooms: &mut Rooms, work: &mut EventWork) {
    work.seeds.clear();
    work.seeds.extend(&work.region.bodies);
    collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now);
    if !work.region.groups.is_empty() {
        cut_groups(rooms, &mut work.region);
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now);
    }
}

pub(crate) fn handle_impact(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    let fired = work.region.cause.fired();
    collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now);
    if !work.region.groups.is_empty() {
        cut_groups(rooms, &mut work.region);
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now);
    }
    let rest = rooms.assembly.rest_speed();
    work.fired_open = fired.is_some_and(|fired| gap_at(&rooms.assembly, fired, rooms.assembly.now).1 > -rest);
    if work.region.cause == Cause::Tick {
        put_back(rooms, work);
    }
    collide(rooms, work)
}

/// Resolves the impact of a region whose bodies are in flight, and goes on.
pub(crate) fn collide(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    // One event too many in a short time, or of one pair without time going by, is resolved without elasticity.
    work.region.in_storm = note_events(&rooms.assembly, &mut rooms.zeno, &mut rooms.books, &work.region);
    let is_storm = work.region.in_storm || work.repeats > 0;
    let mut report = std::mem::take(&mut rooms.books.told.last_impact);
    let now = rooms.assembly.now;
    let is_lawful = !is_storm && work.region.cause != Cause::Tick;
    let manner = if is_lawful { Manner::Lawful } else { Manner::Inelastic };
    let outcome = resolve_impact(rooms, &mut work.region, &mut work.impact, &mut report, now, manner);
    if outcome.is_ok() {
        book_impact(
            &rooms.assembly,
            &mut rooms.books,
            &report,
            if is_storm { Booking::Capture } else { Booking::BySpeed },
        );
    }
    rooms.books.told.last_impact = report;
    outcome?;
    // A row that comes to rest without having closed is a contact that begins, not an impact.
    let at_joint = work.region.cause == Cause::SmoothJoint;
    let fastest = fastest_row(&rooms.books.told.last_impact, !at_joint);
    if fastest > rooms.assembly.rest_speed() {
        rooms.books.told.has_hit = true;
        rooms.books.counts.impacts += 1;
    }
    // Slower impacts may be of contacts that take turns.
    if fastest > rooms.assembly.settings.tolerances.velocity_tol {
        forget_paces(&mut rooms.zeno, &work.region.bodies);
    }
    remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now);
    go_on(rooms, work)
}

/// Finds the held rows, makes groups, and predicts: the bodies of the region are in flight with their new
/// velocities.
fn go_on(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    for &body in &work.region.bodies {
        rooms.assembly.flyers[body.index()].unwind();
    }
    note_rails(&rooms.assembly, &mut rooms.connectors, &work.region, rooms.assembly.now);
    // Contacts that open slowly are let go, too, where the group that held them pulled: held, they move others along.
    work.region.is_hasty =
        take_haste(&mut rooms.zeno, &work.region) || has_pulled(&rooms.zeno, rooms.assembly.now);
    settle_and_still(rooms, work)?;
    while leave_loose_corner(rooms, work)? {
        settle_and_still(rooms, work)?;
    }
    measure_touches(&rooms.assembly, &mut work.region);
    note_gaps(&rooms.assembly, &mut rooms.books, &work.region);
    note_seen(&rooms.assembly, &mut rooms.pairs, &work.region, work.fired_open);
    let outcome = regroup_soundly(rooms, work);
    note_begins(&rooms.assembly, &mut rooms.books, &work.region, &work.settling);
    outcome?;
    set_rules(&rooms.assembly, &mut rooms.pairs, &mut rooms.search, &rooms.groups, work);
    if rooms.zeno.last_insistent.is_some_and(|last| is_same_time(last, rooms.assembly.now)) {
        lower_insistent(&rooms.assembly, &mut rooms.pairs, &mut rooms.search, &work.region);
    }
    for &body in &work.region.bodies {
        rooms.searching().renew_stay(body);
    }
    rooms.searching().predict_all_of(&work.region.bodies, true);
    note_held_connectors(&mut rooms.connectors, &work.region, &work.settling);
    rooms.searching().predict_ropes(&work.region);
    Ok(())
}

/// Finds the held rows, and stills those that hop: stopping some contacts makes others hop.
pub(crate) fn settle_and_still(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    let EventWork { region, settling, .. } = &mut *work;
    settling.set_likely(region.records.iter().map(|record| is_likely(&rooms.pairs, record)));
    settling.expect_forces(region, &rooms.books.told.changes.end);
    let may_hop = work.region.cause != Cause::Start && !work.region.is_hasty;
    settle_region(rooms, work, may_hop)?;
    for round in 1..=HOP_ROUNDS {
        if !any_held_hops(&rooms.assembly, work) {
            break;
        }
        let is_stilled =
            still_hops(&mut rooms.assembly, &rooms.connectors, &rooms.pairs, &mut rooms.books, work);
        let with_hops = is_stilled && may_hop && round < HOP_ROUNDS;
        settle_region(rooms, work, with_hops)?;
    }
    Ok(())
}

fn settle_region(rooms: &mut Rooms, work: &mut EventWork, with_hops: bool) -> Result<(), AdvanceError> {
    let mut stage = std::mem::take(&mut rooms.groups.stage);
    let outcome = settle(
        &rooms.view(),
        &mut work.region,
        &mut work.settling,
        &mut stage,
        rooms.assembly.now,
        with_hops,
    );
    rooms.groups.stage = stage;
    outcome
}

/// Resolves an impact without elasticity in which some contacts are marked as bilateral, and removes the marks.
/// Where such rows contradict each other, nothing is done: as unilateral ones they need not.
fn stop_bilaterally(rooms: &mut Rooms, work: &mut EventWork) {
    let now = rooms.assembly.now;
    work.before.clear();
    work.before.extend(work.region.bodies.iter().map(|&body| rooms.assembly.flyer(body).unwound_at(now)));
    // A stop that may as well be left out is not worth a long solve.
    let manner = Manner::Trial;
    let outcome = resolve_impact(rooms, &mut work.region, &mut work.impact, &mut work.stop, now, manner);
    if outcome.is_ok() {
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, now);
    }
    let is_stopped = outcome.is_ok()
        && has_stopped(&rooms.assembly, &work.region)
        && is_modest(&rooms.assembly, &work.stop, &work.region, &work.before);
    unmark(&mut work.region);
    if is_stopped {
        book_impact(&rooms.assembly, &mut rooms.books, &work.stop, Booking::Capture);
    } else if outcome.is_ok() {
        for (&body, &state) in work.region.bodies.iter().zip(&work.before) {
            rooms.assembly.flyers[body.index()].fly_from(now, state);
        }
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, now);
    }
}

/// True if an impact changed the velocities of its bodies by about the rates that were stopped, with impulses of
/// about the change of momentum. Contacts whose normals hardly differ hold all of a body: to stop the rate that
/// their angle leaves would stop the body altogether, by large impulses that cancel each other on every body.
fn is_modest(assembly: &Assembly, report: &ImpactReport, region: &Region, before: &[BodyState]) -> bool {
    let stopped = report.rows.iter().fold(0.0f64, |most, row| most.max(row.rate_before.abs()));
    let impulse = report.rows.iter().fold(0.0f64, |most, row| most.max(row.impulse.abs()));
    let (mut fastest, mut largest) = (0.0f64, 0.0f64);
    for (&body, before) in region.bodies.iter().zip(before) {
        let flyer = assembly.flyer(body);
        let after = flyer.unwound_at(assembly.now);
        let moved = after.velocity.distance(before.velocity);
        let turned = (after.angular_velocity - before.angular_velocity).abs();
        fastest = fastest.max(moved + turned * flyer.reach());
        let Body { inverse_mass, inverse_moment, .. } = *flyer.body();
        largest = largest.max(moved / inverse_mass).max(turned / (inverse_moment * flyer.reach()));
    }
    fastest <= MODEST * stopped && impulse <= MOST_CANCELLING * largest
}

/// True if the contacts of a region that are marked as bilateral rest, and no other closes.
fn has_stopped(assembly: &Assembly, region: &Region) -> bool {
    let rest = assembly.rest_speed();
    let mut contacts = region.records.iter().filter(|record| record.parties.primary.site.is_some());
    contacts.all(|record| {
        let rate = record.motion.normal_velocity;
        rate >= -rest && (rate <= rest || !record.parties.bilateral)
    })
}

/// Notes the least gap of features of a region that lie opposite each other: beyond their ends a gap is no distance
/// between bodies.
fn note_gaps(assembly: &Assembly, books: &mut Books, region: &Region) {
    for (&touch, &(gap, _)) in region.touches.iter().zip(&region.motions) {
        if books.counts.smallest_gap.is_some_and(|least| least <= gap) {
            continue;
        }
        let [a, b] = features_in(assembly, touch);
        let pose = touch.bodies.map(|body| assembly.flyer(body).moving_at(assembly.now).pose);
        let is_opposite =
            |sample: GapSample| sample.excess_primary.max(sample.excess_normal).max(sample.overrun) <= 0.0;
        if GapSample::measure(a, &pose[0], b, &pose[1]).is_some_and(is_opposite) {
            books.counts.note_gap(gap);
        }
    }
}

/// Gap [m] and rate [m/s] at a time of the contact, rope or stop that fires an event; `None` for other causes.
pub(crate) fn gap_of_cause(
    assembly: &Assembly,
    connectors: &Connectors,
    cause: Cause,
    time: Time,
) -> Option<(f64, f64)> {
    match cause {
        Cause::Fired(touch) => Some(gap_at(assembly, touch, time)),
        Cause::Taut(id) => {
            let sample = connectors.measure_connector(assembly, id, 0, time);
            Some((sample.gap, sample.kinematics.rate))
        }
        _ => None,
    }
}

/// Books the change of energy of an impact in the ledger.
pub(crate) fn book_impact(assembly: &Assembly, books: &mut Books, report: &ImpactReport, booking: Booking) {
    let fastest = fastest_row(report, true);
    let is_capture = booking == Booking::Capture || fastest <= assembly.settings.tolerances.velocity_tol;
    let booked = if is_capture { &mut books.ledger.captures } else { &mut books.ledger.impacts };
    *booked += report.energy_change;
    note_kinetic_energy_before(assembly, books, report);
}

/// Largest rate [m/s] that an impact has stopped: of rows that closed and, `with_connectors`, of connectors, whichever
/// way they moved. A corner of a rail that turns to either side is an impact.
fn fastest_row(report: &ImpactReport, with_connectors: bool) -> f64 {
    let stopped = report.rows.iter().map(|row| match row.collision.parties.bilateral {
        true if with_connectors => row.rate_before.abs(),
        true => 0.0,
        false => -row.rate_before,
    });
    stopped.fold(0.0, f64::max)
}

/// Removes the marks as bilateral from the contacts of a region.
fn unmark(region: &mut Region) {
    for record in &mut region.records {
        record.parties.bilateral = record.parties.primary.site.is_none() && record.parties.bilateral;
    }
}

/// Notes which unilateral connectors of a region are held from now on.
fn note_held_connectors(connectors: &mut Connectors, region: &Region, settling: &Settling) {
    for &body in &region.bodies {
        for index in 0..connectors.of(body).len() {
            let id = connectors.of(body)[index];
            if !connectors.connector(id).is_bilateral() {
                let mut held = settling.held.iter();
                let is_held = held.any(|(_, row)| row.source == RowSource::Connector(id, 0));
                connectors.states[id.index()].held = is_held;
            }
        }
    }
}
