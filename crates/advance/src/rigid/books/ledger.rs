//! The ledger of energy: its changes in events and steps, by cause.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::Books;
use crate::rigid::group::group::Work;
use crate::rigid::group::groups::Groups;
use crate::time::Time;

/// Changes of energy [J] since the start by cause, each negative where energy was lost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Impacts with elasticity.
    pub impacts: f64,
    /// Slow closing contacts that were brought to rest, and storms of impacts that were ended without elasticity.
    pub captures: f64,
    /// Projections onto held rows.
    pub projections: f64,
    /// Velocity changes by the caller, see [`RigidSystem::intervene`].
    pub interventions: f64,
    /// Work of damping.
    pub damping: f64,
    /// Work of each force law that has no potential, in the order of [`RigidSystem::laws`]; 0 for the others.
    pub laws: Vec<f64>,
}

impl Ledger {
    pub(crate) fn book(&mut self, work: Work, value: f64) {
        match work {
            Work::Law(law) => self.laws[law] += value,
            Work::Damping => self.damping += value,
        }
    }
}

/// Writes the energy ledger at a time within the present segments over `ledger`, whose buffer is used again.
pub(crate) fn write_ledger(
    assembly: &Assembly,
    groups: &Groups,
    books: &Books,
    time: Time,
    ledger: &mut Ledger,
) {
    let Ledger { impacts, captures, projections, interventions, damping, ref laws } = books.ledger;
    let mut room = std::mem::take(&mut ledger.laws);
    room.clone_from(laws);
    *ledger = Ledger { impacts, captures, projections, interventions, damping, laws: room };
    for group in groups.by_leader.iter().flatten() {
        let offset = time.since(group.start);
        for (&work, path) in group.works.iter().zip(group.work_paths()) {
            ledger.book(work, path.value_at(offset));
        }
    }
    for body in assembly.bodies() {
        ledger.damping += assembly.damping_loss(body, time);
    }
}
