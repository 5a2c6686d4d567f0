//! Margins of a group's rows: how much force each may lose before an event. A contact's is its force; an anchor's is what the
//! contacts that it keeps may bear along its axis, less its force. That of a motor counts the square of its force, which has no corner
//! where the force changes its side: searches follow quartics.

use crate::rigid::group::dynamics::Dynamics;
use crate::rigid::group::state::Group;

/// Lists the margin [N] of each row with forces [N], raised by the force that counts as none, and then of each spare anchor; infinite for
/// connectors that always act.
pub(super) fn list_margins(group: &Group, forces: &[f64], least: &[f64], margins: &mut Vec<f64>) {
    let rows = group.rows();
    margins.clear();
    margins.extend(rows.iter().zip(forces).zip(least).map(
        |((row, force), least)| match row.anchor_bound() {
            Some(most) if row.is_pull() && most > 0.0 => least + (most - force * (force / most)) / 2.0,
            Some(bound) => least + bound - force.abs(),
            None if row.bilateral => f64::INFINITY,
            None => force + least,
        },
    ));
    let spares = group.spares().iter();
    margins.extend(spares.map_while(|row| Some(row.anchor_bound()? - row.load[0].abs())));
    for (row, force) in rows.iter().zip(forces) {
        for (anchor, coefficient) in row.kept_by() {
            margins[anchor] += coefficient * force;
        }
    }
}

/// Evaluates the margins at an offset [s] of the segment, and leaves them in the stage.
pub(super) fn evaluate_margins_at(dynamics: &mut Dynamics<'_>, offset: f64) {
    dynamics.evaluate_at(offset);
    let mut margins = dynamics.stage.lend_margins();
    let (forces, least) = (dynamics.stage.forces(), dynamics.stage.least());
    list_margins(dynamics.group, forces, least, &mut margins);
    dynamics.stage.take_back_margins(margins);
}
