//! An event in which held rows change without an impact, unless other contacts close.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::impacts::{Booking, book_impact};
use crate::rigid::books::report::ImpactReport;
use crate::rigid::contacts::bounces::closes_fast;
use crate::rigid::contacts::touch::{Touch, sorted};
use crate::rigid::error::AdvanceError;
use crate::rigid::event::cutting::cut_groups;
use crate::rigid::event::going_on::go_on;
use crate::rigid::event::impacting::{collect_again, collide};
use crate::rigid::event::resolving::resolve_impact;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::work::EventWork;
use crate::rigid::held::leaving::retain_staying;
use crate::rigid::impact::impacts::Manner;
use crate::rigid::region::collecting::{collect_region, passes_by};
use crate::rigid::region::records::remeasure;
use crate::rigid::region::touching::Region;
use crate::rigid::remedies::Remedy;
use halfgap_collision::{Body, BodyState, Collision};

/// Angle [rad] within which joints are smooth: twice that by which their features reach beyond them, and some rounding.
const SEAM_ANGLE: f64 = 4e-9;

/// Largest change of the velocities of bodies' points by an impact that stops contacts, as a multiple of the rates that
/// were stopped.
const MODEST: f64 = 100.0;

/// Largest impulse of such an impact, as a multiple of the largest change of momentum of a body.
const MOST_CANCELLING: f64 = 10.0;

/// Handles a change of the held rows. Other contacts that close within their target zones make it an impact.
pub(crate) fn handle_change(rooms: &mut Rooms, work: &mut EventWork) -> Result<(), AdvanceError> {
    collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now());
    cut_groups(rooms, &mut work.region);
    remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now());
    if neighbour_closes(&rooms.assembly, &work.region) {
        // Cutting moves bodies a little, and a corner that was passed a moment ago may be ahead again: it takes
        // over only if it is nearest now.
        collect_again(rooms, work);
    }
    hand_over(rooms, work);
    let region = &mut work.region;
    if work.repeats > 0 && rooms.assembly.remedies().act(Remedy::LeavingNeighbours) {
        // Two corners that pass each other may hand over to each other without end.
        retain_staying(&rooms.assembly, &rooms.connectors, region);
    }
    // Beside a seam a corner may be as near to the next corner, and pass over it.
    let remedies = rooms.assembly.remedies();
    region.retain_records(|record| {
        !(closes_fast(record) && passes_by(&rooms.search, record) && remedies.act(Remedy::PassingBy))
    });
    let rest = rooms.assembly.rest_speed();
    if work.region.records().iter().any(|record| record.motion.normal_velocity < -rest) {
        return collide(rooms, work);
    }
    go_on(rooms, work)
}

/// True if another contact closes of the two bodies whose contact has run off its features.
fn neighbour_closes(assembly: &Assembly, region: &Region) -> bool {
    let Some(run_off) = region.cause().run_off() else { return false };
    let rest = assembly.rest_speed();
    let mut closing = region.records().iter().filter(|record| record.motion.normal_velocity < -rest);
    closing.any(|record| Touch::of(record).is_some_and(|touch| touch.bodies == run_off.bodies))
}

/// Continues a contact that goes from one feature to the next along a smooth joint: the rate of its neighbour comes
/// only from the angle up to which joints are smooth, and is stopped. Where another contact closes fast at the same
/// moment, the impact does that.
fn hand_over(rooms: &mut Rooms, work: &mut EventWork) {
    let Some(run_off) = work.region.cause().run_off() else { return };
    let is_neighbour = |record: &Collision| {
        let bodies = sorted(record.parties.primary.body, record.parties.normal.body);
        let (rate, speed) = (record.motion.normal_velocity, record.motion.center_velocity.length());
        bodies == run_off.bodies && rate.abs() <= SEAM_ANGLE * speed
    };
    if work.region.records().iter().any(|record| closes_fast(record) && !is_neighbour(record)) {
        return;
    }
    let any = work.region.records().iter().any(is_neighbour);
    if any && rooms.assembly.remedies().act(Remedy::HandOver) {
        work.region.mark(is_neighbour);
        stop_bilaterally(rooms, work);
    }
}

/// Resolves an impact without elasticity in which some contacts are marked as bilateral, and removes the marks.
/// Where such rows contradict each other, nothing is done: as unilateral ones they need not.
fn stop_bilaterally(rooms: &mut Rooms, work: &mut EventWork) {
    let now = rooms.assembly.now();
    work.before.clear();
    work.before
        .extend(work.region.bodies().iter().map(|&body| rooms.assembly.trajectory(body).unwound_at(now)));
    // A stop that may as well be left out is not worth a long solve.
    let manner = Manner::Trial;
    let outcome = resolve_impact(rooms, &mut work.region, &mut work.impact, &mut work.stop, now, manner);
    if outcome.is_ok() {
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, now);
    }
    let is_stopped = outcome.is_ok()
        && has_stopped(&rooms.assembly, &work.region)
        && is_modest(&rooms.assembly, &work.stop, &work.region, &work.before);
    work.region.unmark();
    if is_stopped {
        book_impact(&rooms.assembly, &mut rooms.books, &work.stop, Booking::Capture);
    } else if outcome.is_ok() {
        for (&body, &state) in work.region.bodies().iter().zip(&work.before) {
            rooms.assembly.trajectory_mut(body).fly_from(now, state);
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
    for (&body, before) in region.bodies().iter().zip(before) {
        let trajectory = assembly.trajectory(body);
        let after = trajectory.unwound_at(assembly.now());
        let moved = after.velocity.distance(before.velocity);
        let turned = (after.angular_velocity - before.angular_velocity).abs();
        fastest = fastest.max(moved + turned * trajectory.reach());
        let Body { inverse_mass, inverse_moment, .. } = *trajectory.body();
        largest = largest.max(moved / inverse_mass).max(turned / (inverse_moment * trajectory.reach()));
    }
    fastest <= MODEST * stopped && impulse <= MOST_CANCELLING * largest
}

/// True if the contacts of a region that are marked as bilateral rest, and no other closes.
fn has_stopped(assembly: &Assembly, region: &Region) -> bool {
    let rest = assembly.rest_speed();
    let mut contacts = region.records().iter().filter(|record| record.parties.primary.site.is_some());
    contacts.all(|record| {
        let rate = record.motion.normal_velocity;
        rate >= -rest && (rate <= rest || !record.parties.bilateral)
    })
}
