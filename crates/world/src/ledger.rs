//! The energy ledger: changes of the energy of a run by their causes.

use crate::world::Energy;

/// Changes of the energy since the start [J], by their causes; negative where energy was lost.
///
/// The present energy less that at the start is the sum of the booked changes plus the error of the integration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Present kinetic and potential energy.
    pub now: Energy,
    /// Total energy at the start [J], after the corrections there.
    pub start: f64,
    /// Change of the total energy by the corrections at the start [J], which precede `start` and are not among the
    /// booked changes.
    pub start_correction: f64,
    /// Change by impacts [J], negative where energy was lost.
    pub impacts: f64,
    /// Change by captures [J], a loss: slow contacts whose closing speed was stopped without elasticity.
    pub captures: f64,
    /// Change by projections onto contacts and connectors [J], negative where energy was lost.
    pub projections: f64,
    /// Change by steps of bodies whose events accumulated [J]: see [`Statistics::region_steps`](crate::Statistics::region_steps).
    pub steps: f64,
    /// Change by [interventions](crate::World::intervene) [J], before contacts and connectors respond to them; negative
    /// where they slow bodies down.
    pub interventions: f64,
    /// Work of linear and angular damping [J], a loss.
    pub damping: f64,
    /// Change by jams [J], a loss: contacts whose slip leaves no forces stop at once.
    pub jams: f64,
    /// Loss by friction in impacts and captures [J], which count what elasticity loses.
    pub impact_friction: f64,
    /// Heat of contacts that slip [J], negative. An advance by steps counts it among its `steps`.
    pub friction: f64,
    /// Work of surfaces that run [J].
    pub surfaces: f64,
    /// Work of drives, of motors and of bodies that are moved [J].
    pub drives: f64,
    /// Work of each force law that has no potential, in the order of the laws.
    pub force_laws: Vec<LawWork>,
}

/// The work of a force law.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "scene", derive(serde::Serialize))]
pub struct LawWork {
    /// Name of the law.
    pub law: String,
    /// Work of the law since the start [J], negative where it took energy.
    pub work: f64,
}

impl Ledger {
    /// Returns the sum of all booked changes [J].
    #[must_use]
    pub fn booked(&self) -> f64 {
        let force_laws: f64 = self.force_laws.iter().map(|law| law.work).sum();
        let by_events = self.impacts + self.captures + self.projections + self.steps;
        let by_friction = self.jams + self.impact_friction + self.friction + self.surfaces;
        by_events + by_friction + self.drives + self.interventions + self.damping + force_laws
    }

    /// Returns the error of the integration [J]: the change of the energy since the start less the booked changes.
    #[must_use]
    pub fn integration_error(&self) -> f64 {
        Books::from(self).error()
    }
}

/// Sums of the ledger, from which it follows whether the books close.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Books {
    /// Present kinetic and potential energy.
    pub(crate) now: Energy,
    /// Total energy at the start [J].
    pub(crate) start: f64,
    /// Sum of all booked changes [J].
    pub(crate) booked: f64,
    /// Booked change by captures [J].
    pub(crate) captures: f64,
    /// Booked change by projections [J].
    pub(crate) projections: f64,
    /// Booked change by interventions [J].
    pub(crate) given: f64,
    /// Sum of the sizes of the works of force laws that have no potential, of surfaces and of drives [J].
    pub(crate) works: f64,
}

impl Books {
    /// Error of the integration [J]: the change since the start less the booked changes.
    pub(crate) fn error(&self) -> f64 {
        (self.now.total() - self.start) - self.booked
    }
}

impl From<&Ledger> for Books {
    fn from(ledger: &Ledger) -> Self {
        let of_laws: f64 = ledger.force_laws.iter().map(|law| law.work.abs()).sum();
        let works = of_laws + ledger.surfaces.abs() + ledger.drives.abs();
        let Ledger { now, start, captures, projections, interventions: given, .. } = *ledger;
        Self { now, start, booked: ledger.booked(), captures, projections, given, works }
    }
}

/// The energy in play in a run, as far as it was looked at: see [`World::findings`](crate::World::findings).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Turnover {
    start_potential: f64,
    /// Largest sum seen of the kinetic energy, the change of the potential energy and the work of force laws [J].
    pub(crate) energy: f64,
}

impl Turnover {
    pub(crate) fn new(start: Energy) -> Self {
        Self { start_potential: start.potential, energy: start.kinetic }
    }

    pub(crate) fn note(&mut self, books: &Books) {
        let lifted = (books.now.potential - self.start_potential).abs();
        self.energy = self.energy.max(books.now.kinetic + lifted + books.works);
    }

    /// Notes a kinetic energy [J] between two looks.
    pub(crate) fn note_kinetic(&mut self, kinetic: f64) {
        self.energy = self.energy.max(kinetic);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_change_that_is_not_booked_is_the_error() {
        let ledger = Ledger {
            now: Energy { kinetic: 3.0, potential: -1.0 },
            start: 5.0,
            start_correction: 100.0,
            impacts: -2.0,
            captures: -0.5,
            projections: 0.25,
            steps: 0.0,
            interventions: 10.0,
            jams: 0.0,
            impact_friction: 0.0,
            friction: 0.0,
            surfaces: 0.0,
            drives: 0.0,
            damping: -1.0,
            force_laws: vec![LawWork { law: "motor".to_owned(), work: 0.5 }],
        };
        assert_eq!(ledger.booked(), 7.25);
        assert_eq!(ledger.integration_error(), -10.25);
    }
}
