//! What a step remembers of its rows for the next one.

use crate::rigid::ContactChanges;
use crate::stepping::contacts::Hold;
use crate::stepping::report::Change;
use crate::stepping::rows::{Line, Mover, Rows, Source};
use crate::stepping::step::Scene;

/// Remembers what a row carries at given velocities, in a step whose kick lasts `kick` [s], and tells callers if it begins or ends to.
pub(super) fn remember(
    scene: &mut Scene,
    rows: &Rows,
    index: usize,
    (movers, kick): (&[Mover], f64),
    changes: &mut ContactChanges,
) {
    let row = &rows.all[index];
    let [normal, slip] = [&row.normal, &row.slip.line].map(|line| line.impulse);
    let presses = row.is_bilateral || normal > 0.0;
    let share = if row.touches { 1.0 / kick } else { 0.0 };
    let change = match row.source {
        Source::Connector { connector, direction } => {
            let tie = &mut scene.ties.memory[connector as usize];
            let last = std::mem::replace(&mut tie.forces[direction as usize], share * normal);
            (tie.presses, tie.arrival) = (presses, row.arrives);
            if row.is_bilateral || row.pulls() {
                None
            } else {
                Change::of(&mut tie.is_told, last, share * normal)
            }
        }
        Source::Contact { pair, contact } => {
            let contact = &mut scene.pairs.all_mut()[pair as usize].contacts[contact as usize];
            let roll = row.roll.map_or(0.0, |roll| rows.rolls[roll as usize].line.impulse);
            let last = contact.forces[0];
            contact.forces = [normal, slip, roll].map(|impulse| share * impulse);
            (contact.presses, contact.arrival) = (presses, row.arrives);
            let sticks = presses && row.slip.line.is_some() && {
                let [p, q] = row.ends().map(|place| &movers[place]);
                let stopping = slip - row.slip.line.wanted(p, q);
                !Line::slips(slip, row.slip.bounds[1] * normal, stopping)
            };
            contact.hold = match (sticks, contact.hold) {
                (false, _) => Hold::Slips,
                (true, Hold::Slips) => Hold::Here,
                (true, hold) => hold,
            };
            Change::of(&mut contact.is_told, last, share * normal)
        }
    };
    let told = |force: f64| row.told((&scene.bodies, &scene.pairs), force);
    match change {
        Some(Change::Begins(force)) => changes.begin.push(told(force)),
        Some(Change::Ends(force)) => changes.end.push(told(force)),
        None => {}
    }
}
