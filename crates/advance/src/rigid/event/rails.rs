//! Hints for the places of points on rails, noted as regions are handled and groups go from segment to segment.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::rows::{ActiveRow, RowSource, mechanism};
use crate::rigid::group::groups::Groups;
use crate::rigid::group::stage::body_state;
use crate::rigid::group::state::Group;
use crate::rigid::region::touching::Region;
use crate::time::Time;
use halfgap_collision::{BodyId, ConnectorId, RailHint};

/// Notes the distances left before all stops that a group watches, whose segment ends now.
pub(crate) fn note_ways(
    assembly: &Assembly,
    connectors: &mut Connectors,
    groups: &mut Groups,
    leader: BodyId,
) {
    for place in 0.. {
        let group = groups.by_leader()[leader.index()].as_deref();
        let Some(id) = group.and_then(|group| group.stops().get(place)).map(|stop| stop.id) else { break };
        connectors.note_left(assembly, id, assembly.now());
        groups.note_stop(leader, place);
        connectors.stop_following(id);
    }
}

/// Notes the places on their rails of the points of a region's connectors.
pub(crate) fn note_rails(assembly: &Assembly, connectors: &mut Connectors, region: &Region, time: Time) {
    for &body in region.bodies() {
        for index in 0..connectors.of(body).len() {
            let id = connectors.of(body)[index];
            let Some(path) = connectors.connector(id).path() else { continue };
            let state = &connectors.states()[id.index()];
            if state.corner().is_some() {
                continue;
            }
            let point = connectors.point_on_rail(assembly, id, time);
            let hint = path.hint_near(point, state.hint().as_ref());
            // A stop may lie on any piece: its hint must follow its point over the joints before it.
            if !connectors.connector(id).is_stop() {
                connectors.set_hint(id, hint.staying());
            } else if !connectors.is_led(id) {
                connectors.set_stop_hint(id, hint);
            }
        }
        for index in 0..connectors.of(body).len() {
            connectors.note_left(assembly, connectors.of(body)[index], time);
        }
    }
}

/// Notes the places on their rails of a group's points at its start: laps of an arc are told apart by the last
/// place. Rows on splines were followed to it.
pub(crate) fn renew_hints(assembly: &Assembly, connectors: &mut Connectors, group: &mut Group) {
    let found = |bodies: &[BodyId], state: &[f64], id: ConnectorId, hint: Option<&RailHint>| {
        let (anchor, path) = connectors.connector(id).on_rail()?;
        let place = bodies.binary_search(&anchor.body).ok()?;
        let point = body_state(state, bodies.len(), place).pose().point_to_world(anchor.point);
        Some(path.hint_near(point, hint))
    };
    // Ropes that are watched like stops have no hints.
    let of_stop = |id: ConnectorId, hint: Option<RailHint>| {
        let left = connectors.states()[id.index()].hint().and_then(|hint| hint.before_stop());
        let hint = hint.map(|hint| hint.with_before_stop(left));
        hint.map(|hint| if connectors.is_led(id) { hint.staying() } else { hint })
    };
    let has_knots = |row: &ActiveRow| match row.source {
        RowSource::Connector(id, _) => {
            connectors.connector(id).path().is_some_and(|path| !path.knots().is_empty())
        }
        RowSource::Contact(_) | RowSource::Anchor(_) | RowSource::Pull(_) => false,
    };
    let mechanism = mechanism(assembly, connectors);
    group.renew_hints(|row| !mechanism.is_in_corner(row) && has_knots(row), found, of_stop);
    note_hints(assembly, connectors, group.rows());
}

/// Notes the hints of rows for their rails, except for points that rest in a corner.
pub(crate) fn note_hints(assembly: &Assembly, connectors: &mut Connectors, rows: &[ActiveRow]) {
    for row in rows {
        if let (RowSource::Connector(id, _), Some(hint)) = (row.source, row.hint)
            && !mechanism(assembly, connectors).is_in_corner(row)
        {
            connectors.set_hint(id, hint);
        }
    }
}
