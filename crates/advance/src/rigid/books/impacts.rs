//! The energy of impacts in the books.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::all::Books;
use crate::rigid::books::energy::note_kinetic_energy_before;
use crate::rigid::books::report::ImpactReport;

/// Entry of the ledger in which the energy of an impact is booked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Booking {
    /// As an impact, unless it is slow.
    BySpeed,
    /// As a capture: rows were stopped without elasticity, whatever their speed.
    Capture,
}

/// Books the change of energy of an impact in the ledger.
pub(crate) fn book_impact(assembly: &Assembly, books: &mut Books, report: &ImpactReport, booking: Booking) {
    let fastest = fastest_row(report, true);
    let is_capture = booking == Booking::Capture || fastest <= assembly.settings().tolerances.velocity_tol;
    let booked = if is_capture { &mut books.ledger.captures } else { &mut books.ledger.impacts };
    *booked += report.energy_change - report.friction_change - report.surface_work - report.drive_work;
    books.ledger.impact_friction += report.friction_change;
    books.ledger.surfaces += report.surface_work;
    books.ledger.drives += report.drive_work;
    note_kinetic_energy_before(assembly, books, report);
}

/// Largest rate [m/s] that an impact has stopped: of rows that closed and, `with_connectors`, of connectors, whichever
/// way they moved. A corner of a rail that turns to either side is an impact.
pub(crate) fn fastest_row(report: &ImpactReport, with_connectors: bool) -> f64 {
    let stopped = report.rows.iter().map(|row| match row.collision.parties.bilateral {
        true if with_connectors => row.rate_before.abs(),
        true => 0.0,
        false => -row.rate_before,
    });
    stopped.fold(0.0, f64::max)
}
