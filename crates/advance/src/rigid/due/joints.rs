//! Points of rails that come to a joint, and ropes and stops that fire.

use crate::rigid::connectors::corners::{pass_joints_beside, stop_in_corner};
use crate::rigid::error::AdvanceError;
use crate::rigid::event::impacting::handle_impact;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::work::EventWork;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::collecting::collect_region;
use halfgap_collision::ConnectorId;

/// Takes the point of a rail along the next piece of its path; at a corner, its velocity across that is stopped.
pub(crate) fn pass_joint(
    rooms: &mut Rooms,
    work: &mut EventWork,
    id: ConnectorId,
) -> Result<(), AdvanceError> {
    // A point that meets the stop again at once rests there, in the corner, which holds it as well.
    if let Some(stop) = stop_in_corner(&rooms.assembly, &rooms.connectors, id)
        && rooms.connectors.states()[stop.index()].repeats_at(rooms.assembly.now()) < MOST_AGAIN
    {
        return meet_stop(rooms, work, stop);
    }
    collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now());
    let is_corner = rooms.connectors.pass_knot(&rooms.assembly, id, rooms.assembly.now())
        | pass_joints_beside(&rooms.assembly, &mut rooms.connectors, work.region.bodies(), id);
    work.region.set_cause(if is_corner { Cause::Other } else { Cause::SmoothJoint });
    handle_impact(rooms, work)
}

/// Handles a rope that goes taut, or a point that comes to the stop of its rail.
pub(crate) fn meet_stop(
    rooms: &mut Rooms,
    work: &mut EventWork,
    id: ConnectorId,
) -> Result<(), AdvanceError> {
    work.region.set_cause(Cause::Taut(id));
    if rooms.connectors.connector(id).is_stop() {
        rooms.connectors.note_taut(id, rooms.assembly.now());
    }
    handle_impact(rooms, work)
}

/// Number of times that a stop in a corner is met without time going by.
const MOST_AGAIN: u32 = 2;
