//! The forces of active rows, for callers.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::all::Books;
use crate::rigid::books::report::RowForce;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::friction::{Axis, Grip};
use crate::rigid::contacts::rows::{ActiveRow, RowSource, mechanism, moving_of};
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::groups::Groups;
use crate::rigid::group::physics::physics;
use crate::rigid::group::state::{Group, Work};
use crate::rigid::surface::RowFriction;
use crate::time::Time;
use halfgap_collision::Moving;

/// Evaluates the forces of all active rows at a time within the present segments. Allocates.
#[must_use]
pub(crate) fn row_forces(
    assembly: &Assembly,
    connectors: &Connectors,
    groups: &Groups,
    books: &Books,
    time: Time,
) -> Vec<RowForce> {
    let mut found = Vec::new();
    let groups_with_rows = || {
        groups
            .by_leader()
            .iter()
            .flatten()
            .filter(|group| group.rows().len() + group.spares().len() + group.pulls().len() > 0)
    };
    if groups_with_rows().next().is_none() {
        return found;
    }
    let mut stage = groups.stage().clone();
    for group in groups_with_rows() {
        let (start, mut group) = (group.start(), group.clone());
        let mut dynamics =
            Dynamics { physics: physics(assembly, connectors), group: &mut group, stage: &mut stage, start };
        dynamics.evaluate_at(time.since(start));
        let first = found.len();
        found.extend(told_rows(assembly, connectors, &group, (stage.forces(), stage.movings())));
        tell_heat(books, &group, time, &mut found[first..]);
        let mechanism = mechanism(assembly, connectors);
        found.extend(group.pulls().iter().map(|pull| {
            let sides = pull.bodies.map(|body| moving_of(stage.movings(), body));
            let place = mechanism.locate_pull(pull.id, sides);
            RowForce::along(pull.bodies, (Some(pull.id), None), place, pull.force)
        }));
    }
    found
}

/// Tells the heat of the contacts of a group at a time within its segment, whose rows were told in their order.
fn tell_heat(books: &Books, group: &Group, time: Time, told: &mut [RowForce]) {
    if !group.is_rough() {
        return;
    }
    told.iter_mut().for_each(|row| row.heat = books.heat.told(row));
    let offset = time.since(group.start());
    let mut recent = vec![0.0; group.rows().len()];
    for (&work, path) in group.works().iter().zip(group.work_paths()) {
        if let Work::Friction(row) = work {
            recent[row as usize] = path.value_at(offset);
        }
    }
    let own = group.rows().iter().zip(recent).filter(|(row, _)| !is_anchor(row));
    for (told, (_, work)) in told.iter_mut().zip(own) {
        told.heat = told.heat.map(|heat| heat - work);
    }
}

fn is_anchor(row: &ActiveRow) -> bool {
    matches!(row.source, RowSource::Anchor(_))
}

/// What callers are told of the rows of a group, but anchors: these are told with the contacts that they keep.
fn told_rows<'a>(
    assembly: &'a Assembly,
    connectors: &'a Connectors,
    group: &'a Group,
    (forces, movings): (&'a [f64], &'a [Moving]),
) -> impl Iterator<Item = RowForce> + use<'a> {
    let mechanism = mechanism(assembly, connectors);
    let rows = group.rows().iter().zip(forces);
    let with_spares = move || rows.clone().chain(group.spares().iter().map(|row| (row, &row.load[0])));
    // What the contacts of each anchor bear together.
    let anchors = group.rows().len() + group.spare_anchors();
    let mut bounds = vec![0.0; if group.is_rough() { anchors } else { 0 }];
    for (row, force) in with_spares() {
        for (anchor, coefficient) in row.kept_by() {
            bounds[anchor] += coefficient * force;
        }
    }
    let along = move |anchor: usize| {
        forces.get(anchor).copied().unwrap_or_else(|| group.spares()[anchor - forces.len()].load[0])
    };
    with_spares().filter(|(row, _)| !is_anchor(row)).map(move |(row, &force)| {
        // Of what an anchor bears, a contact has the share of what it may bear.
        let shared = |most: f64, anchor: usize| {
            let share = if bounds[anchor] > 0.0 { most / bounds[anchor] } else { 0.0 };
            share * along(anchor)
        };
        let friction = match row.grip(Axis::Slip) {
            Grip::Slips { side, coefficient, .. } => row.touch().map(|_| {
                let sides = row.bodies.map(|body| moving_of(movings, body));
                let most = coefficient * force;
                let slip_speed = mechanism.slip_speed(row, Axis::Slip, sides);
                RowFriction { force: -side * most, slip_speed, most, sticks: false }
            }),
            Grip::Sticks { coefficient, anchor: Some(anchor) } => {
                let most = coefficient * force;
                Some(RowFriction {
                    force: shared(most, anchor as usize),
                    slip_speed: 0.0,
                    most,
                    sticks: true,
                })
            }
            _ => None,
        };
        let turning = match row.grip(Axis::Turn) {
            Grip::Sticks { coefficient, anchor: Some(anchor) } => {
                shared(coefficient * force, anchor as usize)
            }
            _ => 0.0,
        };
        let rolling = mechanism.told_rolling(row, force, turning);
        let origin = match row.source {
            RowSource::Connector(id, _) | RowSource::Pull(id) => (Some(id), None),
            RowSource::Contact(features) | RowSource::Anchor(features) => (None, Some(features)),
        };
        let place = mechanism.locate(row, movings);
        RowForce { friction, rolling, ..RowForce::along(row.bodies, origin, place, force) }
    })
}

/// Notes the unilateral rows of a group that is cut, with their forces at the cut.
pub(crate) fn note_ends(
    assembly: &Assembly,
    connectors: &Connectors,
    groups: &Groups,
    books: &mut Books,
    group: &Group,
) {
    let unilateral =
        group.rows().iter().chain(group.spares()).filter(|row| !is_anchor(row)).map(|row| !row.bilateral);
    let told = told_rows(assembly, connectors, group, (group.end_forces(), groups.stage().movings()));
    let ends = told.zip(unilateral).filter(|(_, is_unilateral)| *is_unilateral).map(|(told, _)| told);
    books.told.changes.end.extend(ends);
}
