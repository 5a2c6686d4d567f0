//! Events by their source: the start, a contact, the end of a segment, a rope.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::corners::{go_along, note_corners};
use crate::rigid::contacts::friction::Grip;
use crate::rigid::contacts::gaps::leaves;
use crate::rigid::contacts::pairs::PairId;
use crate::rigid::contacts::pulls::Pull;
use crate::rigid::contacts::rows::RowSource;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::due::joints::{meet_stop, pass_joint};
use crate::rigid::error::AdvanceError;
use crate::rigid::event::changing::handle_change;
use crate::rigid::event::going_on::go_on;
use crate::rigid::event::groups::release_parted;
use crate::rigid::event::impacting::{collide, handle_impact};
use crate::rigid::event::life::{continue_group, look_further};
use crate::rigid::event::rooms::{Rooms, with_work};
use crate::rigid::event::work::EventWork;
use crate::rigid::group::groups::group_of;
use crate::rigid::group::state::SegmentEnd;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::collecting::collect_region;
use crate::rigid::region::touching::Region;
use crate::rigid::ticks::{note_pressed, sinks};
use crate::rigid::zeno::repeats::note_repeat;
use halfgap_collision::{BodyId, Collision, ConnectorId, GapState, Zone};
use halfgap_geometry::FeatureId;

/// Finds the rows that are active at the start.
pub(crate) fn establish(rooms: &mut Rooms) -> Result<(), AdvanceError> {
    with_work(rooms, Cause::Start, |rooms, work| {
        work.seed(rooms.assembly.bodies());
        note_corners(&rooms.assembly, &mut rooms.connectors);
        collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now());
        if !closes_slowly(&rooms.assembly, &work.region) {
            return go_on(rooms, work);
        }
        // Contacts that close fast fire in their own time, unless they are in their target zone now.
        let fast = |gap: GapState| gap.rebounds() && gap.zone() < Zone::Target;
        work.region.retain_records(|record| !fast(record.gap_state()));
        collide(rooms, work)
    })
}

/// True if any contact of a region closes so slowly that it is to be captured, but is not at rest yet.
fn closes_slowly(assembly: &Assembly, region: &Region) -> bool {
    let closes = |record: &Collision| {
        let gap = record.gap_state();
        gap.is_colliding(assembly.start_rest_of(record)) && !gap.rebounds()
    };
    assembly.settings().impulse_step.is_none() && region.records().iter().any(closes)
}

/// Handles the contact of two features of a pair.
pub(crate) fn handle_contact(
    rooms: &mut Rooms,
    pair: PairId,
    features: [FeatureId; 2],
) -> Result<(), AdvanceError> {
    let bodies = rooms.pairs.bodies(pair);
    if sinks(rooms, pair, features)
        || rooms.searching().passes_over(pair, features)
        || rooms.searching().turns_back(pair, features)
    {
        return Ok(());
    }
    let touch = Touch::new(bodies, features);
    note_pressed(&rooms.assembly, &mut rooms.sinking, touch)?;
    let repeats = note_repeat(&rooms.assembly, &mut rooms.pairs, &mut rooms.zeno, pair)?;
    with_work(rooms, Cause::Fired(touch), |rooms, work| {
        work.note_repeats(repeats);
        work.seed(bodies);
        handle_impact(rooms, work)
    })
}

/// Handles the end of a group's segment, natural or early.
pub(crate) fn handle_group(rooms: &mut Rooms, leader: BodyId) -> Result<(), AdvanceError> {
    if group_of(&rooms.assembly, &rooms.groups, leader).is_none()
        && rooms.zeno.collapsed(leader, rooms.assembly.now()).is_some()
    {
        return with_work(rooms, Cause::Collapsed, |rooms, work| {
            let bodies = rooms.zeno.collapsed(leader, rooms.assembly.now());
            work.seed(bodies.into_iter().flatten().copied());
            handle_change(rooms, work)
        });
    }
    if group_of(&rooms.assembly, &rooms.groups, leader).is_some_and(|group| group.look().is_some()) {
        look_further(
            &mut rooms.assembly,
            &mut rooms.connectors,
            &mut rooms.groups,
            &mut rooms.agenda,
            leader,
        );
        return Ok(());
    }
    if group_of(&rooms.assembly, &rooms.groups, leader).is_some_and(|group| group.event().is_none()) {
        return extend_naturally(rooms, leader);
    }
    with_work(rooms, Cause::Other, |rooms, work| handle_group_with(rooms, leader, work))
}

fn handle_group_with(rooms: &mut Rooms, leader: BodyId, work: &mut EventWork) -> Result<(), AdvanceError> {
    let Some(group) = group_of(&rooms.assembly, &rooms.groups, leader) else { return Ok(()) };
    work.seed(group.bodies().iter().copied());
    let Some((_, end)) = group.event() else { return Ok(()) };
    match end {
        SegmentEnd::Release(row) => {
            work.region.set_strained(group.shares_forces());
            // Beyond the rows there are spare anchors.
            let Some(row) = group.rows().get(row) else { return handle_change(rooms, work) };
            if let Some(touch) = row.touch() {
                work.region.set_cause(Cause::Released(touch));
            }
            let source = row.source;
            let is_anchor = matches!(source, RowSource::Anchor(_) | RowSource::Pull(_));
            if group.made() == rooms.assembly.now() && !is_anchor {
                rooms.zeno.note_pull(rooms.assembly.now());
            }
            if let RowSource::Connector(id, side @ (0 | 1)) = source {
                go_along(&mut rooms.connectors, id, 1 - side);
            }
            handle_change(rooms, work)
        }
        SegmentEnd::Change(row) => match (group.rows()[row].touch(), group.rows()[row].source) {
            (_, RowSource::Connector(id, _)) => pass_joint(rooms, work, id),
            (touch, RowSource::Contact(_) | RowSource::Anchor(_) | RowSource::Pull(_)) => {
                let left = touch.filter(|&touch| leaves(&rooms.assembly, &rooms.connectors, touch));
                work.region.set_cause(left.map_or(Cause::Other, Cause::RunOff));
                if let Some(pair) = left.and_then(|left| rooms.pairs.between(left.bodies[0], left.bodies[1]))
                {
                    work.note_repeats(note_repeat(&rooms.assembly, &mut rooms.pairs, &mut rooms.zeno, pair)?);
                }
                handle_change(rooms, work)
            }
        },
        SegmentEnd::Sink(row) => {
            // A contact that was touched without force has sunk.
            let Some(touch) = group.idle()[row].touch() else { return Ok(()) };
            work.region.set_cause(Cause::Fired(touch));
            handle_impact(rooms, work)
        }
        SegmentEnd::Stop(id) => meet_stop(rooms, work, id),
        SegmentEnd::SlipStop(row, axis) => {
            let row = &group.rows()[row];
            if let (Some(touch), Grip::Slips { side, .. }) = (row.touch(), row.grip(axis)) {
                work.region.set_cause(Cause::Stopped(touch, axis));
                rooms.zeno.note_stop((touch.bodies, axis, side > 0.0), rooms.assembly.now());
            }
            handle_change(rooms, work)
        }
        SegmentEnd::PullStop(place) => {
            let Pull { id, force, .. } = group.pulls()[place];
            work.region.set_cause(Cause::Rests(id, force < 0.0));
            handle_change(rooms, work)
        }
        SegmentEnd::Switch => handle_change(rooms, work),
    }
}

fn extend_naturally(rooms: &mut Rooms, leader: BodyId) -> Result<(), AdvanceError> {
    release_parted(rooms, leader);
    continue_group(rooms, leader)?;
    let mut bodies = rooms.groups.take_extended();
    bodies.extend(
        group_of(&rooms.assembly, &rooms.groups, leader).into_iter().flat_map(|group| group.bodies()),
    );
    for &body in &bodies {
        rooms.searching().renew_stay(body);
    }
    rooms.searching().predict_all_of(&bodies, false);
    rooms.searching().search_ropes_on(&bodies);
    rooms.groups.put_extended(bodies);
    Ok(())
}

/// Handles a rope that goes taut.
pub(crate) fn handle_rope(rooms: &mut Rooms, id: ConnectorId) -> Result<(), AdvanceError> {
    with_work(rooms, Cause::Taut(id), |rooms, work| {
        work.seed(rooms.connectors.connector(id).bodies());
        handle_impact(rooms, work)
    })
}
