//! The life of a group: started after an event, extended step by step, ended by the next event.

use crate::rigid::agenda::{Agenda, Source};
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::all::Books;
use crate::rigid::books::energy::{book_damping, note_kinetic_energy};
use crate::rigid::books::forces::note_ends;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::rows::{ActiveRow, mechanism};
use crate::rigid::error::AdvanceError;
use crate::rigid::event::rails::{note_hints, note_ways, renew_hints};
use crate::rigid::event::rooms::Rooms;
use crate::rigid::group::attempt::StepFailure;
use crate::rigid::group::groups::{Groups, part, put_group, with_group};
use crate::rigid::group::physics::physics;
use crate::rigid::group::stage::body_state;
use crate::rigid::group::state::Group;
use crate::rigid::remedies::Remedy;
use crate::rigid::search::neighbourhood::Neighbourhood;
use crate::rigid::watch::extending::extend_watched;
use crate::rigid::watch::releases::look_for_release;
use crate::rigid::zeno::pace::{names_of_force_laws, note_pace};
use crate::rigid::zeno::repeats::has_pulled;
use halfgap_collision::BodyId;

/// Ends a group, whose bodies are in flight; its works are booked.
pub(crate) fn dissolve(rooms: &mut Rooms, leader: BodyId) {
    note_ways(&rooms.assembly, &mut rooms.connectors, &mut rooms.groups, leader);
    let Some(mut group) = rooms.groups.take(leader) else { return };
    book_works(&mut rooms.books, &group);
    if group.rows().iter().any(|row| !row.bilateral) {
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, _| {
            dynamics.evaluate_end()
        });
        note_ends(&rooms.assembly, &rooms.connectors, &rooms.groups, &mut rooms.books, &group);
    }
    for &body in group.bodies() {
        rooms.assembly.note_sunk(body, group.depth());
        rooms.groups.note_past(body, &group, rooms.assembly.now());
        rooms.books.note_backup();
    }
    part(&mut rooms.assembly, &mut rooms.connectors, &group);
    rooms.agenda.clear(Source::Group(leader));
    rooms.groups.recycle(group);
}

fn book_works(books: &mut Books, group: &Group) {
    if group.rows().iter().any(ActiveRow::is_joint) {
        books.note_connector_error(group.largest_error());
    }
    if let Some(gap) = group.least_gap() {
        books.note_gap(gap);
    }
    books.book_projection(group.projected());
    let first = 2 * group.velocities();
    for (&work, &value) in group.works().iter().zip(&group.end_state()[first..]) {
        books.book_work(work, value, group.rows());
    }
}

/// Forgets a group that was never started, or is made anew: its bodies are in flight.
pub(crate) fn drop_group(
    assembly: &mut Assembly,
    connectors: &mut Connectors,
    groups: &mut Groups,
    leader: BodyId,
) {
    let Some(group) = groups.take(leader) else { return };
    part(assembly, connectors, &group);
}

/// Starts a group's first segment from the states of its bodies.
pub(crate) fn start_group(rooms: &mut Rooms, leader: BodyId) -> Result<(), AdvanceError> {
    let Some(mut group) = rooms.groups.take(leader) else { return Ok(()) };
    let now = rooms.assembly.now();
    let mut inertias = rooms.groups.take_inertias();
    inertias.extend(group.bodies().iter().map(|&body| rooms.assembly.inertia(body)));
    let is_patient = has_pulled(&rooms.zeno, now) && rooms.assembly.remedies().act(Remedy::Patience);
    let assembly = &rooms.assembly;
    group.add_friction(&mechanism(assembly, &rooms.connectors), |body| {
        assembly.trajectory(body).unwound_at(now)
    });
    group.prepare(now, is_patient, (rooms.connectors.all(), &inertias));
    rooms.groups.put_inertias(inertias);
    for place in 0..group.bodies().len() {
        let body = group.bodies()[place];
        book_damping(&mut rooms.assembly, &mut rooms.books, body, now);
        group.set_end(place, &rooms.assembly.trajectory(body).unwound_at(now));
    }
    with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, tools| {
        dynamics.soften_dependent();
        dynamics.end_on_rows(tools);
    });
    rooms.books.book_projection(group.set_off());
    with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, tools| {
        dynamics.find_tree_and_loops(tools.settings);
        dynamics.set_out();
        if dynamics.leave_singular_tree() {
            dynamics.set_out();
        }
        if dynamics.prescribe_if_dependent() {
            dynamics.set_out();
        }
        dynamics.note_stress();
    });
    extend_group(rooms, group)
}

/// Extends a group whose segment has come to its natural end by another segment.
pub(crate) fn continue_group(rooms: &mut Rooms, leader: BodyId) -> Result<(), AdvanceError> {
    note_ways(&rooms.assembly, &mut rooms.connectors, &mut rooms.groups, leader);
    let Some(mut group) = rooms.groups.take(leader) else { return Ok(()) };
    book_works(&mut rooms.books, &group);
    group.turn_over(rooms.assembly.settings().method);
    renew_hints(&rooms.assembly, &mut rooms.connectors, &mut group);
    extend_group(rooms, group)
}

/// Extends a group by a segment and puts it back.
fn extend_group(rooms: &mut Rooms, mut group: Box<Group>) -> Result<(), AdvanceError> {
    note_hints(&rooms.assembly, &mut rooms.connectors, group.rows());
    let leader = group.leader();
    skip_dense(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, leader);
    let next_step = group.next_step();
    let mut outcome =
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, tools| {
            extend_watched(dynamics, tools)
        });
    if outcome.is_err() && group.stiffness().is_stiff() {
        group.retry_explicitly(next_step, rooms.assembly.settings().method);
        outcome =
            with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, extend_watched);
    }
    rooms.books.note_segment();
    if let Err(failure) = outcome {
        let error = step_error(&rooms.assembly, &rooms.connectors, &group, failure);
        give_up(&mut rooms.assembly, &mut rooms.connectors, &group);
        let may_jump = matches!(failure, StepFailure::Collapsed(_)) && group.slips();
        if may_jump && rooms.zeno.note_collapse(leader, group.bodies(), group.start()) {
            rooms.agenda.set(Source::Group(leader), group.start());
            return Ok(());
        }
        return Err(error);
    }
    note_pace(&rooms.assembly, &mut rooms.zeno, &group);
    note_kinetic_energy(&rooms.assembly, &mut rooms.books, &group);
    rooms.agenda.set(Source::Group(leader), group.due());
    if group.is_unwatched() {
        defer_dense(&mut rooms.groups, leader);
    } else {
        fly_along(&mut rooms.assembly, &group);
    }
    put_group(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, group);
    Ok(())
}

/// Searches the rest of a group's segment for a contact that loses its force.
pub(crate) fn look_further(
    assembly: &mut Assembly,
    connectors: &mut Connectors,
    groups: &mut Groups,
    agenda: &mut Agenda,
    leader: BodyId,
) {
    let Some(mut group) = groups.take(leader) else { return };
    with_group(assembly, connectors, groups, &mut group, |dynamics, _| look_for_release(dynamics));
    agenda.set(Source::Group(leader), group.due());
    put_group(assembly, connectors, groups, group);
}

/// Forgets a group that cannot be stepped: its bodies are where its last segment ended.
fn give_up(assembly: &mut Assembly, connectors: &mut Connectors, group: &Group) {
    for (place, &body) in group.bodies().iter().enumerate() {
        let state = body_state(group.state(), group.bodies().len(), place);
        assembly.trajectory_mut(body).fly_from(group.start(), state);
    }
    part(assembly, connectors, group);
}

/// Sets the bodies of a group on its dense output.
fn fly_along(assembly: &mut Assembly, group: &Group) {
    let span = group.end().since(group.start());
    for (&body, paths) in group.bodies().iter().zip(group.paths()) {
        assembly.trajectory_mut(body).follow(group.start(), paths, span);
    }
}

fn step_error(
    assembly: &Assembly,
    connectors: &Connectors,
    group: &Group,
    failure: StepFailure,
) -> AdvanceError {
    let (time, bodies) = (group.start().seconds(), group.bodies().to_vec());
    let force_laws = names_of_force_laws(assembly, group);
    match failure {
        StepFailure::Collapsed(step) => match group.drive(connectors).filter(|_| group.is_near_singular()) {
            Some(drive) => AdvanceError::DeadPoint { time, drive, bodies },
            None => AdvanceError::StepCollapsed { time, step, bodies, force_laws },
        },
        StepFailure::RanOut(pulley, body) => AdvanceError::RanOut { time, pulley, body },
        StepFailure::RanAway(speed) => AdvanceError::RanAway { time, speed, bodies },
        StepFailure::Unresolved(length) => {
            let bodies = so_far_apart(assembly, group, length).map_or(bodies, Vec::from);
            AdvanceError::Unresolved { time, length, bodies, force_laws }
        }
    }
}

/// Two bodies whose centres are at a given distance [m], among those that a law of a group names together; `None`
/// if there are none. Where forces vary over that length, these are to blame.
fn so_far_apart(assembly: &Assembly, group: &Group, length: f64) -> Option<[BodyId; 2]> {
    let center = |body: BodyId| match group.bodies().binary_search(&body) {
        Ok(place) => body_state(group.state(), group.bodies().len(), place).position,
        Err(_) => assembly.moving_at(body, group.start()).pose.position,
    };
    let bodies = group.force_laws().iter().map(|&law| assembly.force_laws().all[law].bodies());
    let mut pairs = bodies
        .flat_map(|bodies| bodies.iter().enumerate().map(move |(at, &body)| (body, &bodies[at + 1..])))
        .flat_map(|(body, others)| others.iter().map(move |&other| [body, other]));
    pairs.find(|&[a, b]| (center(a) - center(b)).length() == length)
}

/// True if no event can end the segments of a group early.
pub(crate) fn is_unwatched(
    assembly: &Assembly,
    connectors: &Connectors,
    search: &Neighbourhood,
    group: &Group,
) -> bool {
    let mechanism = mechanism(assembly, connectors);
    let mut tied = group.bodies().iter().flat_map(|&body| connectors.of(body));
    group.bodies().iter().all(|body| search.loners()[body.index()])
        && tied.all(|&id| connectors.connector(id).is_bilateral())
        && group.pulls().is_empty()
        && group
            .rows()
            .iter()
            .all(|row| row.bilateral && row.anchor_bound().is_none() && !mechanism.can_change(row))
        && group.force_laws().iter().all(|&law| assembly.force_laws().all[law].switches() == 0)
        && group.next_kink(&physics(assembly, connectors), group.start().seconds()).is_none()
}

/// Postpones the dense output of the group with this leader.
fn defer_dense(groups: &mut Groups, leader: BodyId) {
    groups.defer(leader);
}

/// Drops the postponed dense output of a group that goes on without having been asked for it; makes that of another
/// group.
fn skip_dense(assembly: &mut Assembly, connectors: &mut Connectors, groups: &mut Groups, leader: BodyId) {
    groups.skip(leader);
    complete_dense(assembly, connectors, groups);
}

/// Makes the postponed dense output, if there is any: then all motions can be evaluated.
pub(crate) fn complete_dense(assembly: &mut Assembly, connectors: &mut Connectors, groups: &mut Groups) {
    let Some(mut group) = groups.take_waiting() else {
        return;
    };
    with_group(assembly, connectors, groups, &mut group, |dynamics, tools| dynamics.complete(tools));
    fly_along(assembly, &group);
    put_group(assembly, connectors, groups, group);
}
