//! The forces of active rows, for callers.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::all::Books;
use crate::rigid::books::report::RowForce;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::rows::{ActiveRow, RowSource, mechanism};
use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::groups::Groups;
use crate::rigid::group::physics::physics;
use crate::rigid::group::state::Group;
use crate::time::Time;
use halfgap_collision::Moving;

/// Evaluates the forces of all active rows at a time within the present segments. Allocates.
#[must_use]
pub(crate) fn row_forces(
    assembly: &Assembly,
    connectors: &Connectors,
    groups: &Groups,
    time: Time,
) -> Vec<RowForce> {
    let mut stage = groups.stage().clone();
    let mut found = Vec::new();
    for group in groups.by_leader().iter().flatten() {
        let (start, mut group) = (group.start(), group.clone());
        let mut dynamics =
            Dynamics { physics: physics(assembly, connectors), group: &mut group, stage: &mut stage, start };
        dynamics.evaluate_at(time.since(start));
        let rows = group.rows().iter().zip(stage.forces());
        found.extend(rows.map(|(row, &force)| row_force(assembly, connectors, row, stage.movings(), force)));
    }
    found
}

fn row_force(
    assembly: &Assembly,
    connectors: &Connectors,
    row: &ActiveRow,
    movings: &[Moving],
    force: f64,
) -> RowForce {
    let (point, normal) = mechanism(assembly, connectors).locate(row, movings);
    let (connector, features) = match row.source {
        RowSource::Connector(id, _) => (Some(id), None),
        RowSource::Contact(features) => (None, Some(features)),
    };
    RowForce { bodies: row.bodies, connector, features, point, normal, force, bouncing: None }
}

/// Notes the unilateral rows of a group that is cut, with their forces at the cut.
pub(crate) fn note_ends(
    assembly: &Assembly,
    connectors: &Connectors,
    groups: &Groups,
    books: &mut Books,
    group: &Group,
) {
    for (row, &force) in group.rows().iter().zip(group.end_forces()).filter(|(row, _)| !row.bilateral) {
        let told = row_force(assembly, connectors, row, groups.stage().movings(), force);
        books.told.changes.end.push(told);
    }
}
