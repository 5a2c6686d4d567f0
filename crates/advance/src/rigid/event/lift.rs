//! Bodies that have sunk, where contacts carry impulses only, are put back by the least displacement.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::force_law::Snapshot;
use crate::rigid::books::energy::book_damping;
use crate::rigid::event::cutting::cut_groups;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::shift::Lift;
use crate::rigid::event::work::EventWork;
use crate::rigid::group::groups::Groups;
use crate::rigid::region::collecting::collect_region;
use crate::rigid::region::records::remeasure;
use crate::rigid::region::touching::Region;
use crate::rigid::shares::{ROUNDS, SMALL};
use crate::rigid::sinking::depth::Sinking;
use glam::DVec2;
use halfgap_collision::BodyState;

/// Moves the bodies of a region, which are in flight, so that no gap is less than its target; bodies that they come
/// to touch join the region.
pub(crate) fn put_back(rooms: &mut Rooms, work: &mut EventWork) {
    let (mut full, mut rounds) = (0, 0);
    while full < FULL_ROUNDS && rounds < ROUNDS {
        let Some((way, share)) = find_way_apart(&rooms.assembly, work) else { break };
        rooms.sinking.note_move(way);
        let change = displace(rooms, &work.region, &work.lift.shifts);
        rooms.books.book_projection(change);
        rounds += 1;
        full += u32::from(share == 1.0);
        work.seeds.clear();
        work.seeds.extend(work.region.bodies());
        collect_region(&rooms.view(), &mut work.region, &work.seeds, rooms.assembly.now());
        cut_groups(rooms, &mut work.region);
        remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, rooms.assembly.now());
    }
    rooms.sinking.end_moves();
    // Touching contacts may yet sink when connectors are put together again afterwards.
    for &touch in work.region.touches() {
        rooms.sinking.wait(touch);
    }
}

/// Displaces the bodies of a region, which are in flight; returns the change of their potential energy [J].
pub(super) fn displace(rooms: &mut Rooms, region: &Region, shifts: &[[f64; 3]]) -> f64 {
    let now = rooms.assembly.now();
    for &body in region.bodies() {
        book_damping(&mut rooms.assembly, &mut rooms.books, body, now);
    }
    let before = potential_of(&rooms.assembly, &mut rooms.groups, &mut rooms.sinking, region);
    for (&body, &[x, y, turn]) in region.bodies().iter().zip(shifts) {
        let state = rooms.assembly.trajectory(body).unwound_at(now);
        let position = state.position + DVec2::new(x, y);
        let moved = BodyState { position, angle: state.angle + turn, ..state };
        rooms.assembly.trajectory_mut(body).fly_from(now, moved);
        rooms.search.follow(rooms.assembly.trajectory(body), body);
    }
    potential_of(&rooms.assembly, &mut rooms.groups, &mut rooms.sinking, region) - before
}

/// Finds the displacement of one round: leaves it in the buffers, and returns its longest way [m] and the fraction of the whole
/// displacement that it is; `None` if nothing has to move.
fn find_way_apart(assembly: &Assembly, work: &mut EventWork) -> Option<(f64, f64)> {
    let EventWork { region, settling, lift, .. } = work;
    if !pose_lift(assembly, region, lift) || settling.solve(&lift.problem).is_err() {
        return None;
    }
    lift.find_shifts(assembly, region, settling);
    let longest = longest_way(assembly, region, &lift.shifts);
    // Farther, gaps are not nearly linear in the displacement.
    let share = if longest.1 > SMALL { SMALL / longest.1 } else { 1.0 };
    lift.shifts.iter_mut().flatten().for_each(|shift| *shift *= share);
    Some((share * longest.0, share))
}

/// Longest way of a point of a region's bodies along a displacement (x, y, angle) of each: in metres, and as a
/// fraction of the body's reach.
pub(super) fn longest_way(assembly: &Assembly, region: &Region, shifts: &[[f64; 3]]) -> (f64, f64) {
    let ways = region.bodies().iter().zip(shifts).map(|(&body, [x, y, turn])| {
        let reach = assembly.trajectory(body).reach();
        let way = libm::hypot(*x, *y) + turn.abs() * reach;
        (way, way / reach)
    });
    ways.fold((0.0, 0.0), |most, way| (most.0.max(way.0), most.1.max(way.1)))
}

/// Sets up the least displacement of a region's bodies that leaves no gap below its target; false if none is.
fn pose_lift(assembly: &Assembly, region: &Region, Lift { problem, rows, .. }: &mut Lift) -> bool {
    region.begin(problem, |body| assembly.inertia(body));
    rows.clear();
    let mut any_sunk = false;
    for (index, record) in region.records().iter().enumerate() {
        let offset = record.distance_to_target();
        any_sunk |= record.gap_state().is_sunk_below(record.tolerances.target_gap);
        let Some(row) = region.row_of(record, offset) else { continue };
        problem.add_row(&row).expect("a row of finite numbers on bodies of the problem");
        rows.push(index);
    }
    any_sunk
}

/// Potential energy [J] of the bodies of a region under uniform accelerations and laws that have a potential.
fn potential_of(assembly: &Assembly, groups: &mut Groups, sinking: &mut Sinking, region: &Region) -> f64 {
    let mut energy = 0.0;
    for &body in region.bodies() {
        groups.place(body, assembly.trajectory(body).moving_at(assembly.now()));
        let trajectory = assembly.trajectory(body);
        let position = groups.stage().movings()[body.index()].pose.position;
        energy -= trajectory.free_motion().acceleration.dot(position) / trajectory.body().inverse_mass;
    }
    let mut force_laws = sinking.take_force_laws();
    assembly.force_laws().list(region.bodies(), &mut force_laws);
    let now =
        Snapshot::of_unwound(assembly.now().seconds(), groups.stage().movings(), assembly.trajectories());
    let of_force_laws =
        force_laws.iter().filter_map(|&law| assembly.force_laws().all[law].potential(&now)).sum::<f64>();
    sinking.put_force_laws(force_laws);
    energy + of_force_laws
}

/// Number of rounds of putting back that go all the way: gaps are not linear in the displacement, but nearly.
const FULL_ROUNDS: u32 = 3;
