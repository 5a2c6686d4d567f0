//! The ledger within the present segments.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::all::Books;
use crate::rigid::books::ledger::Ledger;
use crate::rigid::group::groups::Groups;
use crate::time::Time;

/// Writes the energy ledger at a time within the present segments over `ledger`, whose buffer is used again.
pub(crate) fn write_ledger(
    assembly: &Assembly,
    groups: &Groups,
    books: &Books,
    time: Time,
    ledger: &mut Ledger,
) {
    ledger.clone_from(&books.ledger);
    for group in groups.by_leader().iter().flatten() {
        let offset = time.since(group.start());
        for (&work, path) in group.works().iter().zip(group.work_paths()) {
            ledger.book(work, path.value_at(offset));
        }
    }
    for body in assembly.bodies() {
        ledger.damping += assembly.damping_loss(body, time);
    }
}
