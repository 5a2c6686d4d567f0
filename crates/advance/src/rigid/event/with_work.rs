//! Runs an event with its buffers.

use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::work::EventWork;
use crate::rigid::region::cause::Cause;

/// Runs an action on an event of the given cause, with the buffers of events.
pub(crate) fn with_work<T>(
    rooms: &mut Rooms,
    cause: Cause,
    act: impl FnOnce(&mut Rooms, &mut EventWork) -> T,
) -> T {
    let mut work = rooms.work.take().unwrap_or_default();
    work.region.set_cause(cause);
    let outcome = act(rooms, &mut work);
    work.region.set_cause(Cause::Other);
    work.region.set_in_storm(false);
    (work.repeats, work.fired_open) = (0, false);
    rooms.work = Some(work);
    outcome
}
