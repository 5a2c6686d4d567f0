//! The life of groups: made after an event from held rows and force laws, extended step by step, cut by the next event.

use crate::ode::Method;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::{Connectors, is_rope};
use crate::rigid::contacts::gaps::gap_at;
use crate::rigid::contacts::pairs::Prediction;
use crate::rigid::contacts::rows::{HeldRow, RowSource, mechanism, with_lean};
use crate::rigid::contacts::touch::Touch;
use crate::rigid::error::AdvanceError;
use crate::rigid::event::life::{drop_group, is_unwatched, start_group};
use crate::rigid::event::members::Members;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::group::brief::{BRIEF, BRIEFEST, CUT_SHARE};
use crate::rigid::group::groups::{Groups, group_of, put_group};
use crate::rigid::group::state::{Group, Work};
use crate::rigid::group::stiffness::Stiffness;
use crate::rigid::held::settling::Settling;
use crate::rigid::region::touching::Region;
use halfgap_collision::{BodyId, ConnectorId};

/// Makes groups of the bodies of a region that held rows or force laws couple; the others stay in flight.
pub(crate) fn regroup(rooms: &mut Rooms, region: &Region, settling: &Settling) -> Result<(), AdvanceError> {
    couple(&rooms.assembly, &rooms.connectors, &mut rooms.groups, region, settling);
    rooms.groups.made.clear();
    let mut members = std::mem::take(&mut rooms.members);
    members.list(region, settling, |place| rooms.groups.coupled.root(place));
    for place in 0..region.bodies().len() {
        if rooms.groups.integrated[place] && rooms.groups.coupled.root(place) == place {
            let group = make_group(rooms, (region, settling), &members, place);
            let leader = group.leader();
            for &body in &group.bodies {
                rooms.assembly.lead(body, leader);
            }
            rooms.groups.made.push(leader);
            put_group(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, group);
        }
    }
    rooms.members = members;
    let mut outcome = Ok(());
    for index in 0..rooms.groups.made.len() {
        let leader = rooms.groups.made[index];
        if outcome.is_ok() {
            outcome = start_group(rooms, leader);
        } else {
            drop_group(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, leader);
        }
    }
    outcome
}

/// Joins the places of a region that share their steps.
fn couple(
    assembly: &Assembly,
    connectors: &Connectors,
    groups: &mut Groups,
    region: &Region,
    settling: &Settling,
) {
    let count = region.bodies().len();
    groups.coupled.reset(count);
    groups.integrated.clear();
    groups.integrated.resize(count, false);
    for (_, row) in settling.held() {
        couple_bodies(groups, region, row.bodies.iter().copied());
    }
    for place in 0..count {
        for index in 0..assembly.laws().of(region.bodies()[place]).len() {
            let law = assembly.laws().all[assembly.laws().of(region.bodies()[place])[index]].clone();
            couple_bodies(groups, region, law.bodies().iter().copied());
        }
    }
    for place in 0..count {
        let mut tied = connectors.of(region.bodies()[place]).iter();
        groups.integrated[place] |= tied.any(|&id| connectors.connector(id).is_stop());
    }
    couple_touching(assembly, groups, region, settling);
    // A set is integrated if any of its places is.
    for place in 0..count {
        if groups.integrated[place] {
            let root = groups.coupled.root(place);
            groups.integrated[root] = true;
        }
    }
}

/// Joins bodies that touch without force, neither closing nor opening, if they are integrated or one of them turns:
/// a group watches such a contact from step to step, where the search would go on in steps as short as the contact
/// takes to sink by next to nothing.
fn couple_touching(assembly: &Assembly, groups: &mut Groups, region: &Region, settling: &Settling) {
    if assembly.settings().impulse_step.is_some() {
        return;
    }
    let rest = assembly.rest_speed();
    for (&touch, &(_, rate)) in region.touches().iter().zip(region.motions()) {
        if rate.abs() > rest || settling.holds_touch(touch) {
            continue;
        }
        let mut places = touch.bodies.into_iter().filter_map(|body| region.place(body));
        let are_integrated = places.all(|place| groups.integrated[place]);
        if are_integrated || touch.bodies.iter().any(|&body| assembly.turns_about(body)) {
            couple_bodies(groups, region, touch.bodies.into_iter());
        }
    }
}

fn couple_bodies(groups: &mut Groups, region: &Region, bodies: impl Iterator<Item = BodyId>) {
    let mut first = None;
    for place in bodies.filter_map(|body| region.place(body)) {
        groups.integrated[place] = true;
        let first = *first.get_or_insert(place);
        groups.coupled.join(first, place);
    }
}

fn make_group(rooms: &mut Rooms, of: (&Region, &Settling), members: &Members, root: usize) -> Box<Group> {
    let (region, settling) = of;
    let mut group = rooms.groups.pool.pop().unwrap_or_default();
    group.clear();
    group.bodies.extend(members.places(root).map(|place| region.bodies()[place]));
    group.bodies.sort_unstable();
    // Bilateral rows first: a contact that depends on them gives way.
    let rows = members.held(settling, root);
    group.rows.extend(rows.clone().filter(|row| row.bilateral));
    group.rows.extend(rows.filter(|row| !row.bilateral));
    list_idle(&rooms.assembly, &rooms.connectors, &mut group, of, members.touches(root));
    list_stops(&rooms.assembly, &rooms.connectors, &mut group);
    rooms.assembly.laws().list(&group.bodies, &mut group.laws);
    list_works(&rooms.assembly, &mut group);
    foresee(&rooms.assembly, &rooms.connectors, &rooms.groups, &mut group);
    group.is_unwatched = is_unwatched(&rooms.assembly, &rooms.connectors, &rooms.search, &group);
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
        let (touch, (gap, rate)) = (region.touches()[index], region.motions()[index]);
        let is_inside = |body: BodyId| group.bodies.binary_search(&body).is_ok();
        let belongs = |body: BodyId| is_inside(body) || !assembly.is_movable(body);
        if !touch.bodies.iter().all(|&body| belongs(body)) || settling.holds_touch(touch) {
            continue;
        }
        if rate.abs() <= assembly.rest_speed() {
            let gap = assembly.refire_gap(gap);
            let source = RowSource::Contact(touch.features);
            let bodies = touch.bodies;
            let (hint, leans, is_lifted) = (None, false, false);
            let row = HeldRow { source, bodies, bilateral: false, gap, hint, leans, is_lifted };
            group.idle.push(with_lean(assembly, connectors, row, assembly.now()));
        }
    }
}

/// True if a contact that is touched without force is watched by the group of one of its bodies.
pub(crate) fn is_watched(assembly: &Assembly, groups: &Groups, touch: Touch) -> bool {
    let source = RowSource::Contact(touch.features);
    let groups = touch.bodies.into_iter().filter_map(|body| group_of(assembly, groups, body));
    let mut idle = groups.flat_map(|group| &group.idle);
    idle.any(|row| row.bodies == touch.bodies && row.source == source)
}

/// Hands back to the search the idle contacts of a group that have opened beyond the target zone, have run as far
/// off their features, or have gone round their bodies and lie behind them, and the ropes that have slackened as
/// much.
pub(crate) fn let_go(rooms: &mut Rooms, leader: BodyId) {
    let Some(mut group) = rooms.groups.take(leader) else { return };
    let opened =
        rooms.assembly.settings().tolerances.target_gap + rooms.assembly.settings().tolerances.accuracy;
    let mut touched = rooms.search.take_touched();
    group.idle.retain(|row| {
        let RowSource::Contact(features) = row.source else { return true };
        let touch = Touch { bodies: row.bodies, features };
        let [a, b] = row.bodies.map(|body| rooms.assembly.moving_at(body, rooms.assembly.now()));
        let has_run_off =
            mechanism(&rooms.assembly, &rooms.connectors).overrun(row.bodies, features, [&a, &b]) > opened;
        let gap = gap_at(&rooms.assembly, touch, rooms.assembly.now()).0;
        let stays =
            gap < opened && gap > -rooms.assembly.settings().tolerances.distance_tol() && !has_run_off;
        if !stays && let Some(pair) = rooms.pairs.between(touch.bodies[0], touch.bodies[1]) {
            rooms.pairs.change_rules(pair, |rules| rules.retain(|rule| rule.features != features));
            // The contact has left the target zone: its return is no low bounce.
            rooms.pairs.seen_mut(pair).retain(|seen| seen.features != features);
            touched.push(pair);
        }
        stays
    });
    let slack = rooms.assembly.settings().tolerances.accuracy;
    for stop in &group.stops {
        rooms.connectors.unwatch(stop.id);
    }
    group.stops.retain(|stop| {
        let connector = rooms.connectors.connector(stop.id);
        let [a, b] = connector.bodies().map(|body| rooms.assembly.moving_at(body, rooms.assembly.now()));
        !is_rope(connector) || connector.measure(0, &a, &b).gap <= slack
    });
    put_group(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, group);
    let now = rooms.assembly.now();
    for &pair in &touched {
        rooms.searching().note_prediction(pair, (Prediction::Quiet, now));
    }
    rooms.search.put_touched(touched);
}

fn list_stops(assembly: &Assembly, connectors: &Connectors, group: &mut Group) {
    for index in 0..group.bodies.len() {
        for &id in connectors.of(group.bodies[index]) {
            let source = RowSource::Connector(id, 0);
            let is_held = group.rows.iter().any(|row| row.source == source);
            let is_known = || group.stops.iter().any(|stop| stop.id == id);
            if (connectors.connector(id).is_stop() || is_idly_taut(assembly, connectors, group, id))
                && !is_held
                && !is_known()
            {
                group.stops.push(connectors.stop(assembly, id));
            }
        }
    }
}

/// True for a rope within a group that is taut and neither slackens nor tightens. Without a force it is watched
/// like a stop, where the search would go on in steps as short as it takes to lengthen by next to nothing.
fn is_idly_taut(assembly: &Assembly, connectors: &Connectors, group: &Group, id: ConnectorId) -> bool {
    let connector = connectors.connector(id);
    let bodies = connector.bodies();
    let belongs = |body: BodyId| !assembly.is_movable(body) || group.bodies.binary_search(&body).is_ok();
    if !is_rope(connector) || !bodies.iter().all(|&body| belongs(body)) {
        return false;
    }
    let [a, b] = bodies.map(|body| assembly.moving_at(body, assembly.now()));
    let sample = connector.measure(0, &a, &b);
    sample.gap <= assembly.settings().tolerances.accuracy
        && sample.kinematics.rate.abs() <= assembly.rest_speed()
}

/// Lists the works that are integrated with a group: those of laws without potential in their order, then that of
/// damping.
fn list_works(assembly: &Assembly, group: &mut Group) {
    group.works.clear();
    let works = group.laws.iter().copied().filter(|&law| !assembly.laws().has_potential[law]).map(Work::Law);
    group.works.extend(works);
    if group.bodies.iter().any(|&body| assembly.flyer(body).law().is_damped()) {
        group.works.push(Work::Damping);
    }
}

/// Chooses the first step of a group, and whether its steps are brief, by the last groups of its bodies.
fn foresee(assembly: &Assembly, connectors: &Connectors, groups: &Groups, group: &mut Group) {
    let pasts = group.bodies.iter().map(|body| groups.past_of[body.index()]);
    group.next_step = pasts.clone().filter_map(|past| past.step).min_by(f64::total_cmp);
    group.stiffness = pasts.clone().map(|past| past.stiffness).fold(Stiffness::default(), Stiffness::or);
    if assembly.settings().method != Method::default() {
        return;
    }
    group.has_kinks = group.rows.iter().any(|row| match row.source {
        RowSource::Connector(id, _) => connectors.connector(id).path().is_some_and(|path| path.is_spline()),
        RowSource::Contact(_) => false,
    });
    let lasted = pasts.map(|past| past.lasted).fold(0.0, f64::max);
    let soon = BRIEF * lasted;
    let is_brief = |step: f64| !group.has_kinks && BRIEF * soon < step && group.stiffness.allows(soon);
    if let Some(step) = group.next_step.filter(|&step| is_brief(step)) {
        group.is_brief = true;
        (group.next_step, group.full_step) = (Some(soon.max(BRIEFEST * step)), Some(step));
    } else if let Some(step) = group.next_step.filter(|&step| lasted < step) {
        group.next_step = Some(CUT_SHARE * step);
    }
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
        let mut group = rooms.groups.take(BodyId(1)).expect("it is held");
        with_group(&rooms.assembly, &rooms.connectors, &mut rooms.groups, &mut group, |dynamics, tools| {
            dynamics.extend(tools).expect("it rests");
            dynamics.group.state[1] -= 4.0 * gap;
            dynamics.group.end_state[1] -= 4.0 * gap;
            dynamics.make_dense(tools.stepper);
            dynamics.inner_excess(tools.settings.tolerances.accuracy, &tools.settings.steps);
        });
        put_group(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups, group);
        let [floor, sunk, other] = [0, 1, 2].map(BodyId);
        assert!((rooms.assembly.held_depth([floor, sunk]) / gap - 6.0).abs() < 1e-6);
        assert_eq!(rooms.assembly.held_depth([floor, other]), 0.0);
        dissolve(&mut rooms, sunk);
        assert!((rooms.assembly.held_depth([floor, sunk]) / gap - 6.0).abs() < 1e-6);
        let later = rooms.assembly.now().plus(1e-3);
        rooms.assembly.set_now(later);
        assert_eq!(rooms.assembly.held_depth([floor, sunk]), 0.0);
    }
}
