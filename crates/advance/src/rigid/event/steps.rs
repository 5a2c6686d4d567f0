//! Regions whose events accumulate go on by steps, and by events again once their budget is whole.

use crate::rigid::agenda::Source;
use crate::rigid::books::report::RowForce;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::error::AdvanceError;
use crate::rigid::event::cutting::cut_groups;
use crate::rigid::event::impacting::{collect_again, strike};
use crate::rigid::event::lift::displace;
use crate::rigid::event::rooms::{Rooms, with_work};
use crate::rigid::event::work::EventWork;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::collecting::collect_region;
use crate::rigid::region::records::remeasure;
use crate::rigid::region::touching::Region;
use crate::rigid::region::wide::{JOINED, collect_wide, collect_wide_among, is_plain};
use crate::rigid::settings::RegionSteps;
use crate::rigid::shares::{HALF_ZONE, MINOR, ROUNDS, SMALL};
use crate::rigid::stepping::displacements::find_way_to_target;
use crate::rigid::stepping::ending::end_step;
use crate::rigid::stepping::step::step_on;
use crate::rigid::zeno::budget::{charge_event, spend_all};
use crate::rigid::zeno::memory::Zeno;
use crate::rigid::zeno::stepped::{Dragged, Pressed};
use halfgap_collision::{BodyId, Tolerances};

/// Handles the end of the step that a body leads.
pub(crate) fn handle_step(rooms: &mut Rooms, leader: BodyId) -> Result<(), AdvanceError> {
    let Some(steps) = rooms.assembly.settings().region_steps else { return Ok(()) };
    with_work(rooms, Cause::Other, |rooms, work| {
        let stepped = rooms.zeno.stepped().led_by(leader);
        work.seed(stepped.into_iter().flat_map(|stepped| stepped.bodies()).copied());
        let Rooms { assembly, zeno, books, agenda, .. } = &mut *rooms;
        end_step((assembly, zeno), (books, agenda), leader);
        go_by_steps(rooms, work, steps)
    })
}

/// Charges an event to the bodies of its region, which are in flight; true if they have gone on by steps. Where a step has
/// ended and none follows, contacts are brought to their target first.
pub(crate) fn has_gone_by_steps(rooms: &mut Rooms, work: &mut EventWork) -> Result<bool, AdvanceError> {
    let Some(steps) = rooms.assembly.settings().region_steps else { return Ok(false) };
    let region = &work.region;
    let is_plain = region.bodies().iter().all(|&body| is_plain(&rooms.view(), body));
    let has_stepped = !region.steps().is_empty();
    let is_due = charge_event(&rooms.assembly, &mut rooms.zeno, region.bodies(), region.records());
    let goes_on = is_plain && (is_due || has_stepped);
    if goes_on || has_stepped {
        work.seeds.clear();
        work.seeds.extend(work.region.bodies());
    }
    if goes_on {
        go_by_steps(rooms, work, steps)?;
    } else if has_stepped {
        gather(rooms, work, steps);
        bring_to_target(rooms, work, steps);
        collect_again(rooms, work);
    }
    Ok(goes_on)
}

/// Takes the seeds, and all that touch them, from one step to the next.
fn go_by_steps(rooms: &mut Rooms, work: &mut EventWork, steps: RegionSteps) -> Result<(), AdvanceError> {
    gather(rooms, work, steps);
    let Rooms { assembly, connectors, books, zeno, .. } = &mut *rooms;
    expect_forces(zeno, &books.told().changes().end, steps);
    step_on((assembly, connectors), (books, zeno), &mut work.region, &mut work.stepper, steps);
    follow(rooms, &work.region);
    predict_coasting(rooms, &work.region);
    let leaving = work.stepper.take_leaving();
    let outcome = leaving.parts().try_for_each(|part| {
        work.seeds.clear();
        work.seeds.extend(part);
        leave(rooms, work, steps)
    });
    work.stepper.put_leaving(leaving);
    outcome
}

/// Collects the seeds and all that touch them, in flight, for a step.
fn gather(rooms: &mut Rooms, work: &mut EventWork, steps: RegionSteps) {
    work.region.set_cause(Cause::Other);
    loop {
        let longest = rooms.zeno.stepped().longest_next();
        let span = if longest.is_finite() { longest } else { steps.span };
        collect_wide(&rooms.view(), &mut work.region, &work.seeds, RegionSteps { span, ..steps });
        work.seeds.clear();
        work.seeds.extend(work.region.bodies());
        if !work.region.is_led() {
            return;
        }
        cut_groups(rooms, &mut work.region);
    }
}

/// Lets the solves begin with the forces at which contacts were cut.
fn expect_forces(zeno: &mut Zeno, ended: &[RowForce], steps: RegionSteps) {
    zeno.stepped_mut().expect(ended.iter().filter_map(|row| {
        let impulse = 0.5 * steps.span * row.force;
        let touch = Touch::new(row.bodies, row.features?);
        let friction = row.friction.map(|friction| (0.5 * steps.span * friction.force, friction));
        let dragged = friction.map(|(impulse, friction)| Dragged {
            impulse,
            stopped_by: impulse,
            side: if friction.sticks { 0.0 } else { -impulse.signum() },
        });
        let dragged = dragged.unwrap_or_default();
        (impulse > 0.0).then_some(Pressed { touch, approach: 0.0, impulse, stopped_by: impulse, dragged })
    }));
}

/// Predicts what bodies meet that have begun a step, and its end.
fn predict_coasting(rooms: &mut Rooms, region: &Region) {
    let mut bodies = std::mem::take(&mut rooms.coasting);
    bodies.clear();
    bodies.extend(region.bodies().iter().filter(|&&body| rooms.assembly.trajectory(body).is_coasting()));
    for &body in &bodies {
        for index in 0..rooms.pairs.of_body(body).len() {
            let link = rooms.pairs.of_body(body)[index];
            if rooms.assembly.share_step([body, link.other]) && rooms.pairs.get(link.pair).has_rules() {
                rooms.pairs.retain_modes(link.pair, |_, _| false);
            }
        }
        rooms.searching().renew_stay(body);
        if rooms.assembly.leader_of()[body.index()] == Some(body)
            && let Some(end) = rooms.assembly.segment_end(body)
        {
            rooms.agenda.set(Source::Step(body), end);
        }
    }
    rooms.searching().predict_all_of(&bodies, true);
    rooms.coasting = bodies;
}

/// Lets the seeds, which touch each other, go on by events: what touches is brought to its target, and is stopped there
/// without elasticity. If that cannot be done, they go on by steps after all.
fn leave(rooms: &mut Rooms, work: &mut EventWork, steps: RegionSteps) -> Result<(), AdvanceError> {
    let now = rooms.assembly.now();
    if !bring_to_target(rooms, work, steps) {
        spend_all(&mut rooms.zeno, work.seeds.iter().copied());
        return go_by_steps(rooms, work, steps);
    }
    collect_region(&rooms.view(), &mut work.region, &work.seeds, now);
    if work.region.is_led() {
        cut_groups(rooms, &mut work.region);
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, now);
    }
    work.region.set_accumulating(true);
    let outcome = strike(rooms, work);
    work.region.set_accumulating(false);
    outcome
}

/// Moves the seeds, which are in flight, by the least displacement that leaves no gap below its target and brings contacts to it that
/// are a little above. False if some bodies then
/// overlap by more than contacts may sink; where bodies fit in more tightly than the target asks, gaps stay less.
fn bring_to_target(rooms: &mut Rooms, work: &mut EventWork, steps: RegionSteps) -> bool {
    let Tolerances { target_gap, accuracy, .. } = rooms.assembly.settings().tolerances;
    let deepest = -(1.0 + SMALL) * target_gap;
    for round in 0..=ROUNDS {
        collect_wide_among(&rooms.view(), &mut work.region, &work.seeds, steps);
        let rows = (JOINED * steps.slack, MINOR * MINOR * accuracy);
        let least = find_way_to_target(&rooms.assembly, &work.region, &mut work.stepper, rows);
        if least >= -HALF_ZONE * accuracy || round == ROUNDS {
            return least >= deepest;
        }
        let shifts = work.stepper.shifts();
        let longest = shifts.iter().map(|[x, y, _]| libm::hypot(*x, *y)).fold(0.0, f64::max);
        // Others may be as near as that, or come as near from their side.
        if longest > 0.5 * JOINED * steps.slack {
            return false;
        }
        let change = displace(rooms, &work.region, shifts);
        rooms.books.book_steps(change);
    }
    false
}

/// Tells the search how the bodies of a region move now.
fn follow(rooms: &mut Rooms, region: &Region) {
    for &body in region.bodies() {
        rooms.search.follow(rooms.assembly.trajectory(body), body);
    }
}
