//! All books of a system.

use crate::rigid::books::counts::Counts;
use crate::rigid::books::heat::Heat;
use crate::rigid::books::ledger::Ledger;
use crate::rigid::books::report::{ImpactReport, RowForce, Told};
use crate::rigid::contacts::rows::ActiveRow;
use crate::rigid::error::AdvanceError;
use crate::rigid::group::state::Work;
use crate::time::Time;

/// Counts, ledger and report of a system.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Books {
    pub(super) counts: Counts,
    pub(super) ledger: Ledger,
    pub(super) told: Told,
    pub(super) heat: Heat,
}

impl Books {
    /// The counts.
    #[inline]
    pub(crate) fn counts(&self) -> Counts {
        self.counts
    }

    /// The told.
    #[inline]
    pub(crate) fn told(&self) -> &Told {
        &self.told
    }
}

impl Books {
    /// Empty books of a system with so many bodies in flight and so many force laws.
    pub(crate) fn new(movable: usize, force_laws: usize) -> Self {
        Self {
            counts: Counts { segments: movable as u64, ..Counts::default() },
            ledger: Ledger { force_laws: vec![0.0; force_laws], ..Ledger::default() },
            told: Told::default(),
            heat: Heat::default(),
        }
    }

    /// Begins an event at a time, of which nothing is told yet.
    pub(crate) fn begin_event(&mut self, time: Time) {
        self.counts.events += 1;
        self.heat.close(&self.told.changes.end);
        self.told.begin(time);
    }

    /// Corrects the time of the present event.
    pub(crate) fn set_told_time(&mut self, time: Time) {
        self.told.changes.time = time;
    }

    /// Notes the error of the present event, if it could not be handled.
    pub(crate) fn note_outcome(&mut self, outcome: &Result<(), AdvanceError>) {
        self.told.failure = outcome.as_ref().err().cloned();
    }

    /// Notes that the present event contains an impact.
    pub(crate) fn note_impact(&mut self) {
        self.told.has_hit = true;
        self.counts.impacts += 1;
    }

    /// Notes that so many contacts have come fast within a step of their region.
    pub(crate) fn note_impacts_in_steps(&mut self, count: u64) {
        self.counts.impacts += count;
    }

    /// Takes out the report of the last impact, to be written anew.
    pub(crate) fn take_report(&mut self) -> ImpactReport {
        std::mem::take(&mut self.told.last_impact)
    }

    /// Puts in the report of the last impact.
    pub(crate) fn put_report(&mut self, report: ImpactReport) {
        self.told.last_impact = report;
    }

    /// Notes a unilateral row that is active from now on.
    pub(crate) fn begin_contact(&mut self, row: RowForce) {
        self.told.changes.begin.push(row);
    }

    /// Tells a contact at which velocities have jumped.
    pub(crate) fn tell_jam(&mut self, row: RowForce) {
        self.told.changes.jam.push(row);
    }

    /// Tells a contact whose motion is not unique.
    pub(crate) fn tell_undecided(&mut self, row: RowForce) {
        self.told.changes.undecided.push(row);
    }

    /// Drops rows that end only to begin at once, and tells the heat of the others.
    pub(crate) fn drop_continued(&mut self) {
        self.told.drop_continued();
        self.heat.tell(&mut self.told.changes);
    }

    /// Notes a gap [m] between bodies.
    pub(crate) fn note_gap(&mut self, gap: f64) {
        self.counts.note_gap(gap);
    }

    /// Notes the error [m] of a connector.
    pub(crate) fn note_connector_error(&mut self, error: f64) {
        self.counts.note_connector_error(error);
    }

    /// Counts a segment.
    pub(crate) fn note_segment(&mut self) {
        self.counts.segments += 1;
    }

    /// Counts a motion that is cut short.
    pub(crate) fn note_backup(&mut self) {
        self.counts.backups += 1;
    }

    /// Counts solved problems.
    pub(crate) fn note_solves(&mut self, solves: u64) {
        self.counts.contact_solves += solves;
    }

    /// Counts an accumulation that is ended.
    pub(crate) fn note_accumulation(&mut self) {
        self.counts.accumulations += 1;
    }

    /// Counts a step of a region whose events accumulate.
    pub(crate) fn note_region_step(&mut self) {
        self.counts.region_steps += 1;
    }

    /// Books a change of energy [J] by steps of a region whose events accumulate.
    pub(crate) fn book_steps(&mut self, change: f64) {
        self.ledger.steps += change;
    }

    /// Books a change of energy [J] by a jump of velocities where contacts that slip have no forces.
    pub(crate) fn book_jam(&mut self, change: f64) {
        self.ledger.jams += change;
        self.counts.jams += 1;
    }

    /// Books a change of energy [J] by a projection.
    pub(crate) fn book_projection(&mut self, change: f64) {
        self.ledger.projections += change;
    }

    /// Books the work [J] of a force law without a potential, of damping or of friction, of a group with these rows.
    pub(crate) fn book_work(&mut self, work: Work, value: f64, rows: &[ActiveRow]) {
        self.ledger.book(work, value);
        if let Work::Friction(row) = work {
            self.heat.book(&rows[row as usize], value);
        }
    }

    /// Opens an account for the work of a law that was added.
    pub(crate) fn add_force_law(&mut self) {
        self.ledger.force_laws.push(0.0);
    }

    /// Books a change of energy [J] by the caller.
    pub(crate) fn book_intervention(&mut self, change: f64) {
        self.ledger.interventions += change;
    }
}
