//! Cutting of groups at an event: the states of their bodies there, and the exact time.
//!
//! The search for contacts reads dense output. Where that may err by much of what a step may, the step is repeated up
//! to the event, so that the restart has full order; the contact, rope or stop that fired is then a little off, and the
//! time is corrected until its gap is the one that the search saw. Where that does not bring all touching features to
//! where they were seen, as some that close slowly, or brings a body into another, the event stays on the dense output,
//! along which nothing penetrates.

use crate::rigid::agenda::{Agenda, Source};
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::gaps::gap_at;
use crate::rigid::contacts::pairs::{Link, Pairs, Prediction};
use crate::rigid::contacts::touch::Touch;
use crate::rigid::event::life::{complete_dense, dissolve};
use crate::rigid::event::rails::note_ways;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::group::groups::{Groups, put_group, with_group};
use crate::rigid::group::stage::body_state;
use crate::rigid::group::state::SegmentEnd;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::records::{gap_of_cause, seen_gap_of_cause};
use crate::rigid::region::touching::{Region, measure_touches};
use crate::rigid::region::view::View;
use crate::rigid::remedies::Remedy;
use crate::rigid::shares::{HALF_ZONE, MINOR};
use crate::rigid::stepping::ending::end_step;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, Zone};
use halfgap_geometry::Relation;

/// Largest number of corrections of an event's time.
const MOST_CORRECTIONS: usize = 2;

/// Source of the states of the bodies of a group that is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CutBy {
    /// A repeated step, or dense output that errs by little.
    Exact,
    /// Dense output, as the search for contacts has seen it.
    Dense,
}

/// Cuts the groups of a region at the present time, or a little off it, and ends them; their bodies are in flight
/// from there.
pub(crate) fn cut_groups(rooms: &mut Rooms, region: &mut Region) {
    complete_dense(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups);
    region
        .groups()
        .iter()
        .for_each(|&leader| note_ways(&rooms.assembly, &mut rooms.connectors, &mut rooms.groups, leader));
    let seen = rooms.assembly.now();
    measure_touches(&rooms.assembly, region);
    let gap = seen_gap_of_cause(&rooms.assembly, &rooms.connectors, region, seen);
    let time = cut_exactly(rooms, region, gap);
    if is_off(&rooms.view(), region, gap, time) && rooms.assembly.remedies().act(Remedy::CutByDense) {
        place_groups(rooms, region, seen, CutBy::Dense);
    } else {
        rooms.assembly.set_now(time);
    }
    for &leader in region.groups() {
        dissolve(rooms, leader);
    }
    let Rooms { assembly, zeno, books, agenda, .. } = rooms;
    for &leader in region.steps() {
        end_step((assembly, zeno), (books, agenda), leader);
    }
}

/// Cuts the groups of a region by repeated steps, at the time at which the contact, rope or stop that fired has the
/// gap [m] that the search saw; returns this time.
fn cut_exactly(rooms: &mut Rooms, region: &Region, gap: Option<f64>) -> Time {
    let mut time = rooms.assembly.now();
    for round in 0..=MOST_CORRECTIONS {
        place_groups(rooms, region, time, CutBy::Exact);
        if round == MOST_CORRECTIONS {
            break;
        }
        let corrected = passed(&rooms.assembly, &rooms.pairs, &rooms.agenda, region, time)
            .or_else(|| corrected(&rooms.assembly, &rooms.connectors, region.cause(), gap, time));
        let Some(corrected) = corrected else { break };
        let starts =
            region.groups().iter().filter_map(|&leader| rooms.groups.by_leader()[leader.index()].as_deref());
        let latest = starts.map(|group| group.start()).max().unwrap_or(time);
        if corrected <= latest {
            break;
        }
        time = corrected;
    }
    time
}

/// Corrected time, at which the contact, rope or stop that fired has the gap wanted [m]; `None` if it has nearly
/// that at the given time, or closes too slowly to tell.
fn corrected(
    assembly: &Assembly,
    connectors: &Connectors,
    cause: Cause,
    wanted: Option<f64>,
    time: Time,
) -> Option<Time> {
    let gap = gap_of_cause(assembly, connectors, cause, time)?;
    let error = gap.distance - wanted?;
    let counts = error.abs() > MINOR * assembly.settings().tolerances.accuracy;
    (counts && gap.rebounds()).then(|| time.plus(-error / gap.normal_velocity))
}

/// Time of the earliest contact of a region's bodies that was predicted for before the given time, to which the
/// present event has been corrected, if that contact has sunk below its zone meanwhile: it would not be found
/// again.
pub(crate) fn passed(
    assembly: &Assembly,
    pairs: &Pairs,
    agenda: &Agenda,
    region: &Region,
    time: Time,
) -> Option<Time> {
    if time <= assembly.now() {
        return None;
    }
    let links = region.bodies().iter().flat_map(|&body| pairs.of_body(body));
    let contacts = links.filter_map(|link| {
        let Prediction::Contact(features) = pairs.get(link.pair).prediction() else { return None };
        let predicted = agenda.time_of(Source::Pair(link.pair))?;
        let bodies = pairs.bodies(link.pair);
        let has_sunk = || gap_at(assembly, Touch { bodies, features }, time).zone() > Zone::Target;
        (predicted < time && has_sunk()).then_some(predicted)
    });
    contacts.min().filter(|_| assembly.remedies().act(Remedy::Overtaken))
}

/// True if touching features of a region are not where the search saw them: those that fired, seen at a gap [m],
/// or, if the time is not corrected, any; or if a body lies within another that it did not touch.
fn is_off(view: &View<'_>, region: &Region, gap: Option<f64>, time: Time) -> bool {
    let allowed = HALF_ZONE * view.assembly.settings().tolerances.accuracy;
    let fired = gap_of_cause(view.assembly, view.connectors, region.cause(), time).zip(gap);
    if fired.is_some_and(|(gap, seen)| (gap.distance - seen).abs() > allowed) {
        return true;
    }
    let mut seen = region.touches().iter().zip(region.motions());
    let moves_touches = seen.any(|(&touch, seen)| {
        let way = || gap_at(view.assembly, touch, time).distance - seen.distance;
        time == view.assembly.now() && way().abs() > allowed
    });
    moves_touches
        || strayed(view.assembly, view.groups, region, time)
            .any(|body| is_in_another(view.assembly, view.pairs, body, region, time))
}

/// True if a body crosses one near it that it does not touch in a region.
fn is_in_another(assembly: &Assembly, pairs: &Pairs, body: BodyId, region: &Region, time: Time) -> bool {
    let pose = |body: BodyId| assembly.trajectory(body).moving_at(time).pose;
    let shape = |body: BodyId| &assembly.trajectory(body).body().shape;
    pairs.of_body(body).iter().any(|&Link { pair, other }| {
        let touches = |touch: &Touch| touch.bodies == pairs.bodies(pair);
        let finite = [body, other].iter().all(|&body| pose(body).position.is_finite());
        finite
            && !region.touches().iter().any(touches)
            && shape(body).relation(&pose(body), shape(other), &pose(other)) == Relation::Crossing
    })
}

/// Places the bodies of all groups of a region where they are at a time.
fn place_groups(rooms: &mut Rooms, region: &Region, time: Time, source: CutBy) {
    let Rooms { assembly, connectors, groups, .. } = rooms;
    for &leader in region.groups() {
        place_group(assembly, connectors, groups, leader, time, source);
    }
}

/// Places the bodies of a group where they are at a time; the group stays as it was, so that it can be cut again.
fn place_group(
    assembly: &mut Assembly,
    connectors: &mut Connectors,
    groups: &mut Groups,
    leader: BodyId,
    time: Time,
    source: CutBy,
) {
    let Some(mut group) = groups.take(leader) else { return };
    let offset = time.since(group.start()).max(0.0);
    if offset < 0.5 * group.span() {
        // The middle of the segment, at which the error was read, is not reached.
        group.forget_error();
    }
    // Along a step over the kink of a force dense output errs by more than the estimate of the step's error; a step that
    // ends just before the kink leads over it.
    let is_switch = matches!(group.event(), Some((_, SegmentEnd::Switch)));
    if offset != group.span() || source == CutBy::Dense {
        with_group(assembly, connectors, groups, &mut group, |dynamics, tools| {
            let leads_over = is_switch && offset > dynamics.group.span();
            let is_exact = leads_over || (!is_switch && dynamics.is_dense_exact(offset));
            let by_dense = source == CutBy::Dense || is_exact;
            if by_dense || !dynamics.repeat_to(tools, offset) {
                dynamics.end_by_dense(offset);
            }
            dynamics.end_on_rows(tools);
        });
    }
    for (place, &body) in group.bodies().iter().enumerate() {
        let state = body_state(group.end_state(), group.bodies().len(), place);
        assembly.trajectory_mut(body).fly_from(time, state);
    }
    put_group(assembly, connectors, groups, group);
}

/// Bodies of a region that are farther from their dense output than the accuracy of contacts.
fn strayed<'a>(
    assembly: &'a Assembly,
    groups: &'a Groups,
    region: &'a Region,
    time: Time,
) -> impl Iterator<Item = BodyId> + 'a {
    let allowed = assembly.settings().tolerances.accuracy;
    let groups = region.groups().iter().filter_map(|&leader| groups.by_leader()[leader.index()].as_deref());
    groups.flat_map(move |group| {
        let offset = time.since(group.start()).max(0.0);
        let places = group.bodies().iter().zip(group.paths());
        places.filter_map(move |(&body, path)| {
            let [x, y, angle] = [0, 1, 2].map(|k: usize| path[k].value_at(offset));
            let state = assembly.trajectory(body).unwound_at(time);
            let way = state.position.distance(DVec2::new(x, y));
            (way + (state.angle - angle).abs() * assembly.trajectory(body).reach() > allowed).then_some(body)
        })
    })
}
