//! Points of rails that rest in a corner and are not held there by two forces: they leave it along one of its sides.

use crate::rigid::active_set::settle::accelerations_of;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::books::impacts::{Booking, book_impact};
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::rows::RowSource;
use crate::rigid::error::AdvanceError;
use crate::rigid::event::resolving::resolve_impact;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::work::EventWork;
use crate::rigid::impact::corners::{Corner, corners, take_side, take_slower};
use crate::rigid::impact::impacts::Manner;
use crate::rigid::region::records::remeasure;
use crate::rigid::region::touching::Region;
use crate::rigid::remedies::Remedy;
use glam::DVec2;
use halfgap_collision::{Collision, ConnectorId};

/// Puts a point that two forces do not hold in its corner on one of the sides, and stops its velocity across that
/// side. True if there is such a point: forces are to be found anew.
pub(crate) fn leave_loose_corner(rooms: &mut Rooms, work: &mut EventWork) -> Result<bool, AdvanceError> {
    let active = work.settling.active();
    let sides = |id: ConnectorId| {
        [0, 1].map(|side| active.iter().any(|(_, row)| row.source == RowSource::Connector(id, side)))
    };
    let is_loose = |corner: &Corner| {
        sides(corner.id) != [true; 2]
            && !is_left_alone(&rooms.assembly, &rooms.connectors, &work.region, *corner)
    };
    let Some(corner) = corners(&work.region).find(is_loose) else { return Ok(false) };
    if !rooms.assembly.remedies().act(Remedy::LooseCorner) {
        return Ok(false);
    }
    if let Some(side) = sides(corner.id).iter().position(|is_active| *is_active) {
        take_side(&rooms.assembly, &mut rooms.connectors, &mut work.region, corner, side);
    } else {
        let rates = corner.rates(&work.region);
        let opens = rates.into_iter().any(|rate| rate > rooms.assembly.rest_speed());
        let opening = if opens {
            rates
        } else {
            accelerations_of(
                &rooms.assembly,
                &rooms.groups,
                (&work.region, &mut work.settling),
                corner.records,
            )
        };
        take_slower(&rooms.assembly, &mut rooms.connectors, &mut work.region, corner, opening);
    }
    stop_across(rooms, work, corner.id)?;
    Ok(true)
}

/// True for a point at rest in a corner on whose body nothing acts: it stays there until something does.
pub(crate) fn is_left_alone(
    assembly: &Assembly,
    connectors: &Connectors,
    region: &Region,
    corner: Corner,
) -> bool {
    let [body, _] = connectors.connector(corner.id).bodies();
    let record = &region.records()[corner.records[0]];
    let kinematics = &record.motion.kinematics;
    let is_still = corner.rates(region) == [0.0; 2] && kinematics.gamma == 0.0;
    let only_rows = region
        .records()
        .iter()
        .all(|other| !other.involves_body(body) || other.connector() == Some(corner.id));
    let trajectory = assembly.trajectory(body);
    is_still
        && only_rows
        && assembly.force_laws().of(body).is_empty()
        && trajectory.free_motion().acceleration == DVec2::ZERO
}

/// Stops the velocity of a point across the side along which it leaves a corner; that velocity is too slow for an
/// impact.
fn stop_across(rooms: &mut Rooms, work: &mut EventWork, id: ConnectorId) -> Result<(), AdvanceError> {
    let (now, rest) = (rooms.assembly.now(), rooms.assembly.rest_speed());
    let mut records = work.region.records().iter();
    let moves = |record: &Collision| record.connector() == Some(id) && !record.gap_state().rests(rest);
    if !records.any(moves) {
        return Ok(());
    }
    resolve_impact(rooms, &mut work.region, &mut work.impact, &mut work.stop, now, Manner::Inelastic)?;
    remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, now);
    book_impact(&rooms.assembly, &mut rooms.books, &work.stop, Booking::Capture);
    Ok(())
}
