//! The impact of an event.

use crate::rigid::books::report::ImpactReport;
use crate::rigid::error::AdvanceError;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::impact::corners::hold_back;
use crate::rigid::impact::impacts::{Manner, conclude_impact, find_impulses, impact_error};
use crate::rigid::impact::jams::{exclude_jammed, find_impulses_of_pressed};
use crate::rigid::region::touching::Region;
use crate::time::Time;
use halfgap_contact::Impact;

/// Resolves the impact of a region's rows and writes the report. The bodies, which must be in flight, go on with
/// changed velocities, and the records get their impulses.
pub(crate) fn resolve_impact(
    rooms: &mut Rooms,
    region: &mut Region,
    impact: &mut Impact,
    report: &mut ImpactReport,
    time: Time,
    manner: Manner,
) -> Result<(), AdvanceError> {
    let outcome = find_impulses(&rooms.view(), region, impact, manner);
    outcome.map_err(|source| impact_error(&rooms.assembly, region, time, source))?;
    if exclude_jammed(&rooms.assembly, region, impact) {
        let outcome = find_impulses_of_pressed(&rooms.view(), region, impact, manner);
        outcome.map_err(|source| impact_error(&rooms.assembly, region, time, source))?;
    }
    while hold_back(&rooms.assembly, &mut rooms.connectors, region, impact.rates()) {
        let outcome = find_impulses(&rooms.view(), region, impact, manner);
        outcome.map_err(|source| impact_error(&rooms.assembly, region, time, source))?;
    }
    conclude_impact(&mut rooms.assembly, &mut rooms.books, region, impact, report, time);
    Ok(())
}
