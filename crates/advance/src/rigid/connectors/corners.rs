//! Points of rails that come to a corner of their path, and the side along which they go on.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::ends::end_rooms;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::settings::RigidSettings;
use halfgap_collision::{BodyId, Collision, ConnectorId, ConnectorKind, GapState, Zone};

/// Notes which points of rails are in a corner at the start. A moving point is put on the side along which it
/// moves: if that leads through the corner, the point comes to it at once.
pub(crate) fn note_corners(assembly: &Assembly, connectors: &mut Connectors) {
    let (now, fast) = (assembly.now(), assembly.settings().tolerances.velocity_tol);
    for index in 0..connectors.all.len() {
        let id = ConnectorId(u32::try_from(index).unwrap_or(u32::MAX));
        let ConnectorKind::Rail { path, .. } = &connectors.connector(id).kind else { continue };
        let within = assembly.settings().tolerances.accuracy;
        let corner = path.corner_at(connectors.point_on_rail(assembly, id, now), within);
        connectors.states[index].corner = corner;
        let [before, after] = [0, 1].map(|side| match corner {
            Some(_) => connectors.measure_connector(assembly, id, side, now).kinematics.rate.abs(),
            None => 0.0,
        });
        if before.max(after) > fast {
            go_along(connectors, id, usize::from(after < before));
        }
    }
}

/// Takes the points of other rails of some bodies along, too, if they come to their joints now: what happens at one
/// time is one event. True if any comes to a corner. A point with a stop in its corner meets that.
pub(crate) fn pass_joints_beside(
    assembly: &Assembly,
    connectors: &mut Connectors,
    bodies: &[BodyId],
    passed: ConnectorId,
) -> bool {
    let mut any = false;
    for &body in bodies {
        for index in 0..connectors.of(body).len() {
            let id = connectors.of(body)[index];
            if id != passed
                && comes_to_joint(assembly, connectors, id)
                && stop_in_corner(assembly, connectors, id).is_none()
            {
                any |= connectors.pass_knot(assembly, id, assembly.now());
            }
        }
    }
    any
}

/// True if the point of a rail that is in no corner comes to the end of its piece, but for the error of a step.
fn comes_to_joint(assembly: &Assembly, connectors: &Connectors, id: ConnectorId) -> bool {
    let ConnectorKind::Rail { a, path } = &connectors.connector(id).kind else { return false };
    let state = &connectors.states[id.index()];
    if state.corner.is_some() {
        return false;
    }
    let moving = assembly.moving_at(a.body, assembly.now());
    let arm = moving.pose.vector_to_world(a.point);
    let place = path.nearest(moving.pose.position + arm, state.hint.as_ref());
    let along = moving.velocity_at(arm).dot(place.tangent());
    let ahead = end_rooms(path, &place).into_iter().flatten().find(|end| end.is_forward == (along > 0.0));
    let RigidSettings { steps, tolerances, .. } = assembly.settings();
    let error = tolerances.accuracy.min(steps.local_error * steps.length);
    along != 0.0 && ahead.is_some_and(|end| end.room <= error)
}

/// Finds the stop that keeps the point of a rail on the piece along which it comes, where that ends in a corner.
pub(crate) fn stop_in_corner(
    assembly: &Assembly,
    connectors: &Connectors,
    rail: ConnectorId,
) -> Option<ConnectorId> {
    let hint = connectors.states[rail.index()].hint?;
    let moving = connectors.connector(rail).bodies().map(|body| assembly.moving_at(body, assembly.now()));
    let rest = assembly.rest_speed();
    let mut beside = connectors.of(connectors.connector(rail).bodies()[0]).iter().copied();
    beside.find(|&id| {
        let stop = connectors.connector(id);
        if !stop.is_stop_of(connectors.connector(rail)) || !connectors.is_at_end(id, &hint) {
            return false;
        }
        let left = connectors.hint_at(assembly, id, 0, assembly.now()).and_then(|hint| hint.before_stop());
        let sample = stop.measure_near(0, &moving[0], &moving[1], Some(&hint.with_before_stop(left)));
        let gap = GapState::of_rope(&sample, &assembly.settings().tolerances);
        gap.zone() == Zone::Target && !gap.opens(rest)
    })
}

/// True for a side from which the point of a rail parts slowly: the force that presses it into the corner keeps it
/// there, for rounding of positions produces such speeds again and again.
pub(crate) fn stays_in_corner(connectors: &Connectors, record: &Collision) -> bool {
    let is_slow = !record.gap_state().opens(record.tolerances.velocity_tol);
    is_slow && record.connector().is_some_and(|id| connectors.states[id.index()].corner.is_some())
}

/// Takes the point of a rail along a side of the corner in which it is, if it is in one.
pub(crate) fn go_along(connectors: &mut Connectors, id: ConnectorId, side: usize) {
    let state = &mut connectors.states[id.index()];
    let Some(sides) = state.corner.take() else { return };
    connectors.set_hint(id, sides[side].facing_left());
}
