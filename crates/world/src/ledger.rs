//! Where the energy of a run went.

use crate::world::Energy;

/// Every joule since the start, by what changed it.
///
/// Kinetic plus potential energy is the energy at the start plus all changes; what the booked ones leave of that is the
/// error of the integration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Kinetic and potential energy now.
    pub now: Energy,
    /// Total energy at the start, after the corrections there [J].
    pub start: f64,
    /// What the corrections at the start have changed the total by [J]: not a part of the changes since.
    pub start_correction: f64,
    /// Impacts [J].
    pub impacts: f64,
    /// Slow contacts caught without elasticity [J].
    pub captures: f64,
    /// Projections onto contacts and connectors [J].
    pub projections: f64,
    /// [Interventions](crate::World::intervene) [J]: what they change before anything responds to them.
    pub interventions: f64,
    /// Work of linear and angular damping [J].
    pub damping: f64,
    /// Work of each force law that has no potential, in the order of the laws [J].
    pub laws: Vec<LawWork>,
}

/// The work of a force law.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "scene", derive(serde::Serialize))]
pub struct LawWork {
    /// What the law is called.
    pub law: String,
    /// Its work since the start [J].
    pub work: f64,
}

impl Ledger {
    /// All changes that are booked [J].
    #[must_use]
    pub fn booked(&self) -> f64 {
        let laws: f64 = self.laws.iter().map(|law| law.work).sum();
        self.impacts + self.captures + self.projections + self.interventions + self.damping + laws
    }

    /// What remains: the error of the integration [J].
    #[must_use]
    pub fn integration_error(&self) -> f64 {
        Books::from(self).error()
    }
}

/// Sums of the ledger: enough to tell whether the books close.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Books {
    /// Kinetic and potential energy now.
    pub(crate) now: Energy,
    /// Total energy at the start [J].
    pub(crate) start: f64,
    /// All changes that are booked [J].
    pub(crate) booked: f64,
    /// That of captures among them [J].
    pub(crate) captures: f64,
    /// That of projections among them [J].
    pub(crate) projections: f64,
    /// What interventions have put in [J].
    pub(crate) given: f64,
    /// Sum of the sizes of the works of force laws that have no potential [J].
    pub(crate) works: f64,
}

impl Books {
    /// What remains: the error of the integration [J].
    pub(crate) fn error(&self) -> f64 {
        (self.now.total() - self.start) - self.booked
    }
}

impl From<&Ledger> for Books {
    fn from(ledger: &Ledger) -> Self {
        let works = ledger.laws.iter().map(|law| law.work.abs()).sum();
        let Ledger { now, start, captures, projections, interventions: given, .. } = *ledger;
        Self { now, start, booked: ledger.booked(), captures, projections, given, works }
    }
}

/// The energy that a run has turned over, as far as somebody looked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Turnover {
    start_potential: f64,
    /// The largest sum of kinetic energy, change of the potential energy, and work of force laws that was seen [J].
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

    /// Notes a kinetic energy [J] that there was in between.
    pub(crate) fn note_kinetic(&mut self, kinetic: f64) {
        self.energy = self.energy.max(kinetic);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_booked_is_the_error() {
        let ledger = Ledger {
            now: Energy { kinetic: 3.0, potential: -1.0 },
            start: 5.0,
            start_correction: 100.0,
            impacts: -2.0,
            captures: -0.5,
            projections: 0.25,
            interventions: 10.0,
            damping: -1.0,
            laws: vec![LawWork { law: "motor".to_owned(), work: 0.5 }],
        };
        assert_eq!(ledger.booked(), 7.25);
        assert_eq!(ledger.integration_error(), -10.25);
    }
}
