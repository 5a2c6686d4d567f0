//! Groups are made of the bodies of a region that active rows or force laws couple, and hand back what they watch in vain.

use crate::rigid::active_set::settling::Settling;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::{Connectors, is_rope};
use crate::rigid::contacts::friction::Grip;
use crate::rigid::contacts::gaps::gap_at;
use crate::rigid::contacts::pairs::Prediction;
use crate::rigid::contacts::rows::{ActiveRow, RowSource, mechanism, with_lean};
use crate::rigid::contacts::touch::Touch;
use crate::rigid::error::AdvanceError;
use crate::rigid::event::coupling::couple;
use crate::rigid::event::life::{drop_group, is_unwatched, start_group};
use crate::rigid::event::members::Members;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::group::groups::{Groups, group_of, put_group};
use crate::rigid::group::state::Group;
use crate::rigid::region::touching::Region;
use halfgap_collision::{BodyId, GapState, Zone};

/// Makes groups of the bodies of a region that active rows or force laws couple; the others stay in flight.
pub(crate) fn regroup(rooms: &mut Rooms, region: &Region, settling: &Settling) -> Result<(), AdvanceError> {
    let mut coupling = std::mem::take(&mut rooms.coupling);
    couple(&rooms.assembly, &rooms.connectors, &mut coupling, region, settling);
    rooms.groups.begin_making();
    let mut members = std::mem::take(&mut rooms.members);
    members.list(region, settling, |place| coupling.root(place));
    for place in 0..region.bodies().len() {
        if coupling.leads_group(place) {
            let group = make_group(rooms, (region, settling), &members, place);
            let leader = group.leader();
            for &body in group.bodies() {
                rooms.assembly.lead(body, leader);
            }
            rooms.groups.note_made(leader);
            put_group(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, group);
        }
    }
    (rooms.members, rooms.coupling) = (members, coupling);
    let mut outcome = Ok(());
    for index in 0..rooms.groups.made().len() {
        let leader = rooms.groups.made()[index];
        if outcome.is_ok() {
            outcome = start_group(rooms, leader);
        } else {
            drop_group(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, leader);
        }
    }
    outcome
}

fn make_group(rooms: &mut Rooms, of: (&Region, &Settling), members: &Members, root: usize) -> Box<Group> {
    let (region, settling) = of;
    let mut group = rooms.groups.take_empty();
    let (assembly, connectors) = (&rooms.assembly, &rooms.connectors);
    group.set_members(
        members.places(root).map(|place| region.bodies()[place]),
        members.active(settling, root),
    );
    group.add_pulls(members.pulled(settling, root));
    list_idle(assembly, connectors, &mut group, of, members.touches(root));
    group.list_stops(assembly, connectors);
    group.list_laws(assembly, connectors);
    group.foresee(assembly, connectors, &rooms.groups);
    let is_unwatched = is_unwatched(assembly, connectors, &rooms.search, &group);
    group.set_unwatched(is_unwatched);
    group
}

/// Lists the idle contacts of a group: touched without force, neither closing nor opening.
fn list_idle(
    assembly: &Assembly,
    connectors: &Connectors,
    group: &mut Group,
    (region, settling): (&Region, &Settling),
    touches: impl Iterator<Item = usize>,
) {
    if assembly.settings().impulse_step.is_some() {
        // Without contact forces the rules of the search tell of contacts that sink, once a step.
        return;
    }
    for index in touches {
        let (touch, gap) = (region.touches()[index], region.motions()[index]);
        let is_inside = |body: BodyId| group.bodies().binary_search(&body).is_ok();
        let belongs = |body: BodyId| is_inside(body) || !assembly.is_movable(body);
        if !touch.bodies.iter().all(|&body| belongs(body)) || settling.is_active(touch) {
            continue;
        }
        if gap.rests(assembly.rest_speed()) {
            let gap = assembly.refire_gap(gap.distance);
            let source = RowSource::Contact(touch.features);
            let bodies = touch.bodies;
            let (hint, leans, grips) = (None, false, [Grip::Smooth; 2]);
            let row = ActiveRow {
                source,
                bodies,
                third: None,
                bilateral: false,
                gap,
                hint,
                leans,
                grips,
                load: [0.0; 3],
            };
            group.add_idle(with_lean(assembly, connectors, row, assembly.now()));
        }
    }
}

/// True if a contact that is touched without force is watched by the group of one of its bodies.
pub(crate) fn is_watched(assembly: &Assembly, groups: &Groups, touch: Touch) -> bool {
    let source = RowSource::Contact(touch.features);
    let groups = touch.bodies.into_iter().filter_map(|body| group_of(assembly, groups, body));
    let mut idle = groups.flat_map(|group| group.idle());
    idle.any(|row| row.bodies == touch.bodies && row.source == source)
}

/// Hands back to the search the idle contacts of a group that have opened beyond the target zone, have run as far
/// off their features, or have gone round their bodies and lie behind them, and the ropes that have slackened as
/// much.
pub(crate) fn release_parted(rooms: &mut Rooms, leader: BodyId) {
    let Some(mut group) = rooms.groups.take(leader) else { return };
    let opened =
        rooms.assembly.settings().tolerances.target_gap + rooms.assembly.settings().tolerances.accuracy;
    let mut touched = rooms.search.take_touched();
    group.retain_idle(|row| {
        let RowSource::Contact(features) = row.source else { return true };
        let touch = Touch { bodies: row.bodies, features };
        let [a, b] = row.bodies.map(|body| rooms.assembly.moving_at(body, rooms.assembly.now()));
        let has_run_off =
            mechanism(&rooms.assembly, &rooms.connectors).overrun(row.bodies, features, [&a, &b]) > opened;
        let gap = gap_at(&rooms.assembly, touch, rooms.assembly.now());
        let stays =
            gap.zone() >= Zone::Target && !gap.is_illegal(gap.tolerances.distance_tol()) && !has_run_off;
        if !stays && let Some(pair) = rooms.pairs.between(touch.bodies[0], touch.bodies[1]) {
            rooms.pairs.forget_contact(pair, features);
            touched.push(pair);
        }
        stays
    });
    let tolerances = rooms.assembly.settings().tolerances;
    for stop in group.stops() {
        rooms.connectors.unwatch(stop.id);
    }
    group.retain_stops(|stop| {
        let connector = rooms.connectors.connector(stop.id);
        let [a, b] = connector.bodies().map(|body| rooms.assembly.moving_at(body, rooms.assembly.now()));
        !is_rope(connector) || GapState::of_rope(&connector.measure(0, &a, &b), &tolerances).is_touching()
    });
    put_group(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, group);
    let now = rooms.assembly.now();
    for &pair in &touched {
        rooms.searching().note_prediction(pair, (Prediction::Quiet, now));
    }
    rooms.search.put_touched(touched);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::event::life::dissolve;
    use crate::rigid::group::groups::with_group;
    use crate::rigid::test_scene::resting_discs;

    #[test]
    fn how_deep_a_contact_has_sunk_holds_of_its_bodies_until_something_else_happens() {
        let mut rooms = resting_discs(&[0.0, 1.5]);
        let gap = rooms.assembly.settings().tolerances.target_gap;
        let mut group = rooms.groups.take(BodyId(1)).expect("it is in a group");
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, tools| {
            dynamics.extend(tools).expect("it rests");
            dynamics.group.state_mut()[1] -= 4.0 * gap;
            dynamics.group.end_state_mut()[1] -= 4.0 * gap;
            dynamics.make_dense(tools.stepper);
            dynamics.inner_excess(tools.settings.tolerances.accuracy, &tools.settings.steps);
        });
        put_group(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, group);
        let [floor, sunk, other] = [0, 1, 2].map(BodyId);
        assert!((rooms.assembly.active_depth([floor, sunk]) / gap - 6.0).abs() < 1e-6);
        assert_eq!(rooms.assembly.active_depth([floor, other]), 0.0);
        dissolve(&mut rooms, sunk);
        assert!((rooms.assembly.active_depth([floor, sunk]) / gap - 6.0).abs() < 1e-6);
        let later = rooms.assembly.now().plus(1e-3);
        rooms.assembly.set_now(later);
        assert_eq!(rooms.assembly.active_depth([floor, sunk]), 0.0);
    }
}
