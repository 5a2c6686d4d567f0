//! The ledger of energy: its changes in events and steps, by cause.

use super::step::group::Work;
use super::system::RigidSystem;
use crate::time::Time;
use halfgap_collision::{BodyId, BodyState};

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

impl RigidSystem {
    /// Energy ledger at a time within the present segments.
    #[must_use]
    pub fn ledger_at(&self, time: Time) -> Ledger {
        let mut ledger = Ledger::default();
        self.write_ledger(time, &mut ledger);
        ledger
    }

    /// Writes the energy ledger at a time within the present segments over `ledger`, whose buffer is used again.
    pub fn write_ledger(&self, time: Time, ledger: &mut Ledger) {
        let Ledger { impacts, captures, projections, interventions, damping, ref laws } = self.ledger;
        let mut room = std::mem::take(&mut ledger.laws);
        room.clone_from(laws);
        *ledger = Ledger { impacts, captures, projections, interventions, damping, laws: room };
        for group in self.groups.by_leader.iter().flatten() {
            let offset = time.since(group.start);
            for (&work, path) in group.works.iter().zip(group.work_paths()) {
                ledger.book(work, path.value_at(offset));
            }
        }
        for body in self.bodies() {
            ledger.damping += self.damping_loss(body, time);
        }
    }

    /// Change of energy [J], not positive, by the damping of a body in flight since the start of its segment.
    fn damping_loss(&self, body: BodyId, time: Time) -> f64 {
        let flyer = self.flyer(body);
        let Some(start) = flyer.flight_start().filter(|_| flyer.law().is_damped()) else { return 0.0 };
        let body = flyer.body();
        let energy = |state: &BodyState| {
            body.kinetic_energy(state) - flyer.law().acceleration.dot(state.position) / body.inverse_mass
        };
        energy(&flyer.unwound_at(time)) - energy(start)
    }

    /// Books the work of damping on a body in flight, which starts another segment at a time.
    pub(crate) fn book_damping(&mut self, body: BodyId, time: Time) {
        if self.flyer(body).law().is_damped() {
            self.ledger.damping += self.damping_loss(body, time);
            let state = self.flyer(body).unwound_at(time);
            self.flyers[body.index()].fly_from(time, state);
        }
    }
}
