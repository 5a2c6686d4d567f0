//! The way on for contacts that slip and whose forces have no solution: velocities jump, without any collision.

use crate::rigid::active_set::painleve::change_along;
use crate::rigid::active_set::posing::{accelerate_region, pose_problem};
use crate::rigid::active_set::settle::may_carry_force;
use crate::rigid::active_set::settling::Settling;
use crate::rigid::active_set::slips::Slip;
use crate::rigid::group::stage::Stage;
use crate::rigid::region::touching::Region;
use crate::rigid::region::view::View;
use crate::rigid::shares::MOVES;
use crate::rigid::shares::ROUNDED;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, Collision};
use halfgap_contact::Jump;

/// Moments over which impulses are sought, as shares of the time scale of the scene [-]. In the first, forces give a velocity that
/// solutions can tell from rounding, and no other. In the second, forces that are larger than all others by far stop a slip.
const MOMENTS: [f64; 2] = [1e-7, 1e-4];

/// What follows where the candidates have no forces.
#[derive(Debug)]
pub(crate) enum WayOn<'a> {
    /// The velocities (x, y, angle) of the region's bodies change at once.
    Jump(&'a [[f64; 3]]),
    /// There are forces after all, once some of the candidates open or slip.
    FewerSticks,
    /// None is known.
    Nothing,
}

/// Finds the way on for a region whose candidates have no forces. Records must be up to date.
pub(crate) fn find_way_on<'a>(
    view: &View<'_>,
    region: &Region,
    settling: &'a mut Settling,
    stage: &mut Stage,
) -> WayOn<'a> {
    for share in MOMENTS {
        match find_within(view, region, settling, stage, share) {
            Found::Jump => return WayOn::Jump(&settling.pushed),
            Found::FewerSticks => return WayOn::FewerSticks,
            Found::Nothing => {}
        }
    }
    WayOn::Nothing
}

/// What a moment tells; a jump has left the changes of velocities in `pushed`.
enum Found {
    Jump,
    FewerSticks,
    Nothing,
}

/// Finds the way on by the impulses over a moment, given as a share of the time scale.
fn find_within(
    view: &View<'_>,
    region: &Region,
    settling: &mut Settling,
    stage: &mut Stage,
    share: f64,
) -> Found {
    let Some((impulses, largest)) = find_impulses(view, region, settling, stage, share) else {
        return Found::Nothing;
    };
    let of_forces = std::mem::replace(&mut settling.solution.force, impulses);
    find_changes(view, region, settling);
    if gain_of(view, region, settling) > 0.0 {
        // Modes differ over the moment and its half, and what remains of both is no impulse of contacts; that of the half is.
        settling.solution.force.clone_from(&of_forces);
        find_changes(view, region, settling);
        // Loads act in the moment, too.
        if gain_of(view, region, settling) > gain_by_loads(view, region, stage, 0.5 * moment_of(view, share))
        {
            return Found::Nothing;
        }
    }
    let rest = view.assembly.slip_rest();
    if settling.slips.iter().any(|slip| change_of(region, slip, &settling.pushed).abs() > rest) {
        return Found::Jump;
    }
    settling.solution.force = of_forces;
    let least = MOVES * largest;
    let any_opens = drop_loose(settling, least);
    let any_slips = let_slip(settling, rest, least);
    if any_opens || any_slips { Found::FewerSticks } else { Found::Nothing }
}

/// Change of the slip speed [m/s] of a candidate by those of the velocities of the region's bodies.
fn change_of(region: &Region, slip: &Slip, changes: &[[f64; 3]]) -> f64 {
    change_along(region, &region.records()[slip.record], &slip.row.jacobian, changes)
}

/// Leaves the changes of the velocities of the region's bodies by the impulses of the last solution in `pushed`.
fn find_changes(view: &View<'_>, region: &Region, settling: &mut Settling) {
    let mut changes = std::mem::take(&mut settling.pushed);
    changes.clear();
    changes.resize(region.bodies().len(), [0.0; 3]);
    settling.add_responses(region, &settling.candidates, |body| view.assembly.inertia(body), &mut changes);
    settling.pushed = changes;
}

/// Energy [J] that the region's bodies get by the impulses of the last solution and the changes of their velocities that these cause, beyond
/// rounding, and without the work of surfaces that run and of bodies that are moved.
fn gain_of(view: &View<'_>, region: &Region, settling: &Settling) -> f64 {
    let (mut gain, mut terms) = (0.0, 0.0);
    let mut velocities = Vec::with_capacity(region.bodies().len());
    for (&body, &change) in region.bodies().iter().zip(&settling.pushed) {
        let state = view.assembly.trajectory(body).unwound_at(view.assembly.now());
        velocities.push([state.velocity.x, state.velocity.y, state.angular_velocity]);
        let [before, after] = energies(view, body, change);
        (gain, terms) = (gain + after - before, terms + after + before);
    }
    for slip in &settling.slips {
        // What the bodies have beyond the slip is the speed of the surfaces.
        let running = change_of(region, slip, &velocities) - slip.row.rate;
        let impulse = slip.number.and_then(|number| settling.solution.force.get(number));
        gain -= impulse.map_or(0.0, |impulse| impulse * running);
    }
    if view.assembly.any_moved() {
        let candidates = settling.candidates.iter().zip(&settling.solution.force);
        for (record, impulse) in candidates.map(|(&index, impulse)| (&region.records()[index], impulse)) {
            let own = change_along(region, record, &record.motion.kinematics.jacobian, &velocities);
            gain -= impulse * (own - record.motion.normal_velocity);
        }
    }
    gain - ROUNDED * terms
}

/// Kinetic energies [J] of a body before and after a change (x, y, angle) of its velocity.
fn energies(view: &View<'_>, body: BodyId, [x, y, spin]: [f64; 3]) -> [f64; 2] {
    let before = view.assembly.trajectory(body).unwound_at(view.assembly.now());
    let after = BodyState {
        velocity: before.velocity + DVec2::new(x, y),
        angular_velocity: before.angular_velocity + spin,
        ..before
    };
    [before, after].map(|state| view.assembly.kinetic_energy(body, &state))
}

/// Energy [J] that loads give the region's bodies, or take from them, in a time [s].
fn gain_by_loads(view: &View<'_>, region: &Region, stage: &Stage, moment: f64) -> f64 {
    let gains = region.bodies().iter().zip(stage.accelerations()).map(|(&body, acceleration)| {
        let [before, after] = energies(view, body, acceleration.map(|rate| moment * rate));
        (after - before).abs()
    });
    gains.sum()
}

/// A moment [s], given as a share of the time scale of the scene.
fn moment_of(view: &View<'_>, share: f64) -> f64 {
    let steps = &view.assembly.settings().steps;
    share * steps.length / steps.speed
}

/// Notes the records that have no force in the last solution, in which there were forces, and open at more than a speed `least` [m/s].
/// False if they were known.
fn drop_loose(settling: &mut Settling, least: f64) -> bool {
    let Settling { candidates, solution, problem, loose, .. } = settling;
    if solution.force.len() < candidates.len() {
        return false;
    }
    let before = loose.len();
    for (place, &record) in candidates.iter().enumerate() {
        let opens = solution.force[place] == 0.0 && solution.acceleration[place] > least;
        let is_loose = opens && !problem.bilateral()[place];
        if is_loose && !loose.contains(&record) {
            loose.push(record);
        }
    }
    loose.len() > before
}

/// Notes the contacts without slip, up to a speed `rest` [m/s], that slip by more than a speed `least` in the last solution, in which
/// friction has its kinetic bounds only. False if they were known.
fn let_slip(settling: &mut Settling, rest: f64, least: f64) -> bool {
    let Settling { solution, slips, yielding, .. } = settling;
    let before = yielding.len();
    for slip in slips.iter().filter(|slip| slip.row.rate.abs() <= rest) {
        let side = slip.side_in(solution, slip.kinetic, least);
        let is_known = yielding.iter().any(|(record, axis, _)| (*record, *axis) == (slip.record, slip.axis));
        yielding.extend(side.filter(|_| !is_known).map(|side| (slip.record, slip.axis, side)));
    }
    yielding.len() > before
}

/// The impulses of a jump, zero up to rounding if there is none: then the last solution has forces, up to a factor. `None` if no impulses
/// were found. Also the largest rate [m/s] with which the last solution began.
fn find_impulses(
    view: &View<'_>,
    region: &Region,
    settling: &mut Settling,
    stage: &mut Stage,
    share: f64,
) -> Option<(Vec<f64>, f64)> {
    let assembly = view.assembly;
    settling.candidates.clear();
    let records = || region.records().iter().enumerate();
    let takes_part = |record: &Collision| may_carry_force(assembly, record);
    settling.candidates.extend(records().filter(|(_, record)| takes_part(record)).map(|(index, _)| index));
    accelerate_region(assembly, view.connectors, region, settling, stage, assembly.now());
    settling.jumps = true;
    pose_problem(assembly, view.connectors, region, settling, stage);
    settling.jumps = false;
    let Settling { problem, solution, solver, candidates, slips, .. } = settling;
    let normal = candidates.iter().map(|&index| region.records()[index].motion.normal_velocity);
    // Rates that are rounding count as much as what forces do in so short a moment.
    let sound = |rate: f64| if rate.abs() > assembly.slip_rest() { rate } else { 0.0 };
    let rates: Vec<f64> = normal.chain(slips.iter().map(|slip| slip.row.rate)).map(sound).collect();
    let moment = moment_of(view, share);
    let mut find = |moment: f64| {
        let found = Jump::find(problem, &rates, moment, solver, solution);
        found.ok().map(|_| solution.force.clone())
    };
    // What forces do in the moment is no part of the jump. What opens in the shorter moment has no force.
    let (whole, half) = (find(moment)?, find(0.5 * moment)?);
    let ends = rates.iter().zip(problem.offset()).map(|(rate, b)| (rate + 0.5 * moment * b).abs());
    let largest = ends.fold(0.0, f64::max);
    Some((half.iter().zip(whole).map(|(half, whole)| 2.0 * half - whole).collect(), largest))
}
