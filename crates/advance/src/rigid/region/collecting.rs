//! Gathers the region of an event.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::is_rope;
use crate::rigid::contacts::pairs::{Link, is_active_contact};
use crate::rigid::contacts::touch::{Touch, sorted, touch_of};
use crate::rigid::group::groups::{Groups, group_of};
use crate::rigid::region::cause::Cause;
use crate::rigid::region::touching::Region;
use crate::rigid::region::view::View;
use crate::rigid::remedies::Remedy;
use crate::rigid::search::dead_point::{is_near_dead_point, rope_is_near_dead_point};
use crate::rigid::search::ghost_corner::is_ghost_corner;
use crate::rigid::search::lane::LaneKind;
use crate::rigid::search::neighbourhood::Neighbourhood;
use crate::rigid::sinking::depth::may_have_sunk_by;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{
    BodyId, Collision, Detector, Moment, detect_features_of_pair, merge_collisions, record_features,
};

/// Adds the records of the connectors of a body of the region, and the bodies at their other ends.
fn collect_connectors(view: &View<'_>, region: &mut Region, place: usize, time: Time) {
    let body = region.bodies[place];
    for &id in view.connectors.of(body) {
        let connector = view.connectors.connector(id);
        let others = || connector.all_bodies().filter(|&other| other != body);
        if others().any(|other| region.place(other).is_some_and(|earlier| earlier < place)) {
            continue;
        }
        // Bodies between which something pulls, or a stop is to be met, are moved together.
        if connector.is_pull() || connector.is_stop() {
            others().filter(|&other| view.assembly.is_movable(other)).for_each(|other| region.add(other));
        }
        // What pulls does nothing in an instant.
        if connector.is_pull() {
            continue;
        }
        let moving = connector.bodies().map(|body| view.assembly.moving_at(body, time));
        for row in 0..view.connectors.row_count(id) {
            let mut record = view.connectors.connector_record(view.assembly, id, row, &moving, time);
            let is_active = connector.is_bilateral() || view.connectors.is_active_unilaterally(id);
            // A rope that is active is taut, however far dense output has its ends from its length.
            record.must_handle |= is_active;
            if !record.must_handle && !record.gap_state().is_touching() {
                continue;
            }
            // A row at rest is active, or may become so; an active rope is at no dead point, though dense output may have it
            // closing.
            let collides = !is_active && record.gap_state().is_colliding(view.assembly.rest_speed());
            if is_rope(connector) && collides && rope_is_near_dead_point(view.assembly, view.connectors, id) {
                continue;
            }
            region.records.push(record);
            others().filter(|&other| view.assembly.is_movable(other)).for_each(|other| region.add(other));
        }
    }
}

/// Collects the region around some bodies at a time, along their present segments.
pub(crate) fn collect_region(view: &View<'_>, region: &mut Region, seeds: &[BodyId], time: Time) {
    region.clear(view.assembly.body_count());
    for &seed in seeds.iter().filter(|seed| view.assembly.is_movable(**seed)) {
        region.add(seed);
    }
    let mut next = 0;
    while next < region.bodies.len() {
        let body = region.bodies[next];
        collect_mates(view, region, body);
        collect_connectors(view, region, next, time);
        collect_touches(view, region, next, time);
        next += 1;
    }
}

/// Adds the bodies that share a group or a step with a body of the region.
pub(super) fn collect_mates(view: &View<'_>, region: &mut Region, body: BodyId) {
    let Some(leader) = view.assembly.leader_of()[body.index()] else { return };
    if let Some(group) = group_of(view.assembly, view.groups, body)
        && !region.groups.contains(&leader)
    {
        region.groups.push(leader);
        group.bodies().iter().for_each(|&mate| region.add(mate));
    } else if let Some(stepped) = view.zeno.stepped().led_by(leader)
        && !region.steps.contains(&leader)
    {
        region.steps.push(leader);
        stepped.bodies().iter().for_each(|&mate| region.add(mate));
    }
}

/// Adds the records of a body of the region with all bodies that it touches, and these bodies.
fn collect_touches(view: &View<'_>, region: &mut Region, place: usize, time: Time) {
    let body = region.bodies[place];
    let moving = view.assembly.trajectory(body).moving_at(time);
    for &Link { other, .. } in view.pairs.of_body(body) {
        // A pair within the region was looked at with its first body.
        if region.place(other).is_some_and(|earlier| earlier < place) {
            continue;
        }
        let lanes = [&view.search.lanes()[body.index()], &view.search.lanes()[other.index()]];
        let reach = lanes[0].reach() + lanes[1].reach() + view.assembly.settings().tolerances.distance_tol();
        let offset = moving.pose.position - position_of(view.assembly, view.search, other, time);
        // A contact that has fired may be farther apart by rounding.
        let has_fired = region.cause.fired().is_some_and(|fired| fired.bodies == sorted(body, other));
        if offset.length_squared() > reach * reach && !has_fired {
            continue;
        }
        let (trajectory, other_trajectory) =
            (view.assembly.trajectory(body), view.assembly.trajectory(other));
        let other_moving = other_trajectory.moving_at(time);
        // The lesser body first: records do not depend on which of the two was found first.
        let mut moments = [
            Moment { id: body, body: trajectory.body(), moving },
            Moment { id: other, body: other_trajectory.body(), moving: other_moving },
        ];
        if other < body {
            moments.swap(0, 1);
        }
        if collect_pair(view, region, &moments, time) && view.assembly.is_movable(other) {
            region.add(other);
        }
    }
}

/// Position [m] of a body's centre of mass at a time of its present segment.
fn position_of(assembly: &Assembly, search: &Neighbourhood, body: BodyId, time: Time) -> DVec2 {
    let lane = &search.lanes()[body.index()];
    let flown = || assembly.trajectory(body).moving_at(time).pose.position;
    if lane.kind() == LaneKind::Other {
        return flown();
    }
    debug_assert_eq!(lane.position_at(time), flown(), "lanes are renewed with their bodies");
    lane.position_at(time)
}

/// Adds the records of two bodies that take part in an event; true if there are any.
fn collect_pair(view: &View<'_>, region: &mut Region, [first, second]: &[Moment<'_>; 2], time: Time) -> bool {
    let tolerances = view.assembly.settings().tolerances;
    let mut fresh = std::mem::take(&mut region.fresh);
    fresh.clear();
    let bodies = [first.id, second.id];
    let depth = tolerances.distance_tol().max(may_have_sunk_by(view.assembly, view.sinking, bodies));
    detect_features_of_pair(first, second, &tolerances, depth, time.seconds(), &mut fresh);
    let takes_over = region.cause.run_off().is_some_and(|run_off| run_off.bodies == bodies);
    fresh.retain(|record| {
        counts_as_touching(view, record, bodies, region.cause == Cause::Start, takes_over)
            && (!(is_ghost_corner(view.assembly, record)
                || is_near_dead_point(view.assembly, view.connectors, record))
                || is_carried(view.assembly, view.groups, record))
    });
    // A contact that has fired takes part, and one that is put back at a tick, though it may have been moved out of
    // its zone or have turned a little since: where a block lies flat, putting back one of its corners would sink
    // the other.
    let moved = view.sinking.moved();
    let fired = region.cause.fired();
    let waiting = if region.cause == Cause::Tick { view.sinking.waiting_of(bodies) } else { &[] };
    for known in fired.iter().filter(|fired| fired.bodies == bodies).chain(waiting) {
        if !fresh.iter().any(|record| touch_of(record, bodies) == Some(*known)) {
            let record = record_features([first, second], known.features, &tolerances, time.seconds());
            let farthest = tolerances.distance_tol() + 2.0 * moved;
            let is_near = |record: &Collision| record.geometry.distance <= farthest;
            fresh.extend(record.filter(|record| fired == Some(*known) || is_near(record)));
        }
    }
    view.assembly.surfaces().set_elasticity(bodies, &mut fresh);
    for record in &mut fresh {
        record.must_handle |= fired.is_some() && touch_of(record, bodies) == fired;
    }
    region.touches.extend(fresh.iter().filter_map(|record| touch_of(record, [first.id, second.id])));
    if let Some(run_off) = region.cause.run_off() {
        fresh.retain(|record| touch_of(record, [first.id, second.id]) != Some(run_off));
    }
    if fresh.len() > 1 {
        merge_collisions(&mut fresh);
    }
    region.records.append(&mut fresh);
    region.fresh = fresh;
    let last = region.records.last();
    last.is_some_and(|record| record.involves_body(first.id) && record.involves_body(second.id))
}

/// True if a record takes part in an event: a contact at its target or nearer, one that closes within the target
/// zone, one that is active already, or touches at the start, or takes over from a contact that has run off its
/// features; and one that carries a force, though dense output may have it closing or opening faster than a contact
/// at rest. Other contacts have room, and fire in their own time if they close.
fn counts_as_touching(
    view: &View<'_>,
    record: &Collision,
    bodies: [BodyId; 2],
    at_start: bool,
    takes_over: bool,
) -> bool {
    let (gap, rest) = (record.gap_state(), view.assembly.rest_speed());
    if !gap.is_touching() {
        return false;
    }
    // Corners that pass each other before they come to their target do not meet.
    let passes = gap.is_colliding(rest)
        && passes_by(view.search, record)
        && view.assembly.remedies().act(Remedy::PassingBy);
    gap.is_at_target(view.assembly.sink())
        || (!passes && (at_start || record.is_close_enough(view.assembly.sink(), rest)))
        || (gap.rests(rest) && (takes_over || is_active_contact(view.pairs, record, bodies)))
        || is_carried(view.assembly, view.groups, record)
}

/// True if a contact is a row of the group of its bodies.
fn is_carried(assembly: &Assembly, groups: &Groups, record: &Collision) -> bool {
    let Some(touch) = Touch::of(record) else { return false };
    let mut groups = touch.bodies.into_iter().filter_map(|body| group_of(assembly, groups, body));
    groups.any(|group| group.rows().iter().any(|row| row.touch() == Some(touch)))
}

/// True if two corners pass each other before they come to the gap at which their bodies fire.
pub(crate) fn passes_by(search: &Neighbourhood, record: &Collision) -> bool {
    if record.parties.detector != Detector::CornerCorner {
        return false;
    }
    let trigger_gap = |body: BodyId| search.lanes()[body.index()].trigger_gap();
    let trigger_gaps = trigger_gap(record.parties.primary.body).min(trigger_gap(record.parties.normal.body));
    let (along, across) = (record.motion.normal_velocity, record.motion.lateral_velocity);
    let nearest = record.geometry.distance * across.abs() / libm::hypot(along, across);
    nearest > trigger_gaps.min(record.tolerances.target_gap)
}
