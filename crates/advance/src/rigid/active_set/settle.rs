//! Choice of the rows that are active after an event: those that carry a force.
//!
//! All touching rows that neither close nor open are candidates and enter one complementarity problem a = A f + b. A
//! row that carries a force is active, an equation, from then on; one that does not is left to the search for contacts,
//! which watches its gap. Forces of redundant rows are not unique: a row that the solution leaves without force follows
//! from the others.

use crate::rigid::active_set::choosing::{choose_rows, deactivate_idle};
use crate::rigid::active_set::dependent::exclude_dependent;
use crate::rigid::active_set::exclusion::{Excluded, Exclusion};
use crate::rigid::active_set::hops::{is_low_hop, may_hop};
use crate::rigid::active_set::jammed::is_jammed;
use crate::rigid::active_set::leverless::exclude_leverless;
use crate::rigid::active_set::painleve::note_undecided;
use crate::rigid::active_set::posing::{accelerate_region, offset_under, pose_problem};
use crate::rigid::active_set::pulls::{choose_pulls, give_up_holding, list_pulls};
use crate::rigid::active_set::relaxing::relax;
use crate::rigid::active_set::settling::Settling;
use crate::rigid::active_set::slips::give_way;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::bodies::squeezed::{HOPELESS_MASS_RATIO, LARGEST_MASS_RATIO};
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::touch::Touch;
use crate::rigid::error::{AdvanceError, Between};
use crate::rigid::group::groups::Groups;
use crate::rigid::group::stage::Stage;
use crate::rigid::region::cause::Cause;
use crate::rigid::region::touching::Region;
use crate::rigid::region::view::View;
use crate::rigid::remedies::Remedy;
use crate::rigid::shares::NEGLIGIBLE;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, Collision};
use halfgap_contact::SolveError;

/// Outcome of the solve for the forces of the candidates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Solved {
    /// There are no forces, since no gap accelerates.
    Nothing,
    /// Forces of all candidates, but those that pass by next to no lever, to full accuracy.
    Soundly,
    /// Forces of fewer candidates, or to a lesser accuracy.
    Somehow,
}

/// Finds the rows of a region to hold; `with_hops` includes contacts that open in a low hop. Records must be up to
/// date; their forces are written into them.
pub(crate) fn settle(
    view: &View<'_>,
    region: &mut Region,
    settling: &mut Settling,
    stage: &mut Stage,
    time: Time,
    with_hops: bool,
) -> Result<(), AdvanceError> {
    settling.active.clear();
    settling.touches.clear();
    settling.excluded.clear();
    settling.undecided.clear();
    settling.candidates.clear();
    settling.given_way.clone_from(&settling.yielding);
    settling.given_up.clear();
    settling.held.clear();
    settling.pulled.clear();
    let is_start = region.cause() == Cause::Start;
    settling.is_start = is_start;
    let rest = match (is_start, region.is_accumulating()) {
        (true, _) => view.assembly.start_rest(),
        (false, true) => view.assembly.accumulation_rest(),
        (false, false) => view.assembly.rest_speed(),
    };
    let share = if region.is_hasty() { NEGLIGIBLE } else { 1.0 };
    let is_candidate = |record: &Collision| {
        let rest = if is_start { view.assembly.start_rest_of(record) } else { rest };
        may_carry_force(view.assembly, record) && record.is_contact(-rest..=share * rest)
    };
    let records = || region.records().iter().enumerate();
    let Settling { candidates, loose, .. } = &mut *settling;
    let wanted = records().filter(|(index, record)| is_candidate(record) && !loose.contains(index));
    candidates.extend(wanted.map(|(index, _)| index));
    let may_hop =
        |settling: &Settling| records().any(|record| could_hop(view.assembly, region, settling, record));
    list_pulls(view.assembly, view.connectors, region, settling, time);
    if settling.candidates.is_empty() && settling.pulls.is_empty() && !(with_hops && may_hop(settling)) {
        return Ok(());
    }
    accelerate_region(view.assembly, view.connectors, region, settling, stage, time);
    let mut solved = solve_giving_way(view, region, settling, stage, (time, rest))?;
    // Active contacts may press others back, or keep those that open from coming back.
    while with_hops && solved != Solved::Somehow && add_hops(view.assembly, region, settling, stage) {
        solved = solve_giving_way(view, region, settling, stage, (time, rest))?;
    }
    if solved == Solved::Nothing {
        choose_pulls(view.assembly, region, settling);
        return Ok(());
    }
    note_undecided(view.assembly, region, settling);
    if region.is_strained() {
        relax(view, region, settling, stage);
    }
    // A contact that carries too little to be active is given no force: the others are solved without it.
    while deactivate_idle(view.assembly, view.pairs, region, settling, stage) {
        solve_giving_way(view, region, settling, stage, (time, rest))?;
    }
    // Forces of contacts with friction are shared otherwise.
    let is_smooth = settling.slips.is_empty() && settling.pulls.is_empty();
    if is_smooth && (is_start || settling.has_pulled) && view.assembly.remedies().is_on(Remedy::DependentRows)
    {
        // The last problem may still have had candidates that then became inactive without a force.
        pose_problem(view.assembly, view.connectors, region, settling, stage);
        exclude_dependent(view.assembly, region, settling, stage);
    }
    choose_pulls(view.assembly, region, settling);
    choose_rows(view.assembly, view.connectors, view.pairs, region, settling, time);
    view.assembly.refuse_squeezed(
        settling.active.iter().map(|(_, row)| row.bodies),
        HOPELESS_MASS_RATIO,
        time,
    )
}

/// Finds the forces of the candidates; contacts whose friction has reached its static bound slip.
fn solve_giving_way(
    view: &View<'_>,
    region: &Region,
    settling: &mut Settling,
    stage: &Stage,
    (time, rest): (Time, f64),
) -> Result<Solved, AdvanceError> {
    loop {
        let solved = solve_candidates(view.assembly, view.connectors, region, settling, stage, (time, rest))?;
        if solved == Solved::Nothing || !give_way(region, settling) {
            give_up_holding(view.assembly, region, settling);
            return Ok(solved);
        }
    }
}

/// Finds the forces of the candidates; excludes some of them if they jam or no solution is found.
fn solve_candidates(
    assembly: &Assembly,
    connectors: &Connectors,
    region: &Region,
    settling: &mut Settling,
    stage: &Stage,
    (time, rest): (Time, f64),
) -> Result<Solved, AdvanceError> {
    pose_problem(assembly, connectors, region, settling, stage);
    let scale = settling.problem.offset().iter().fold(0.0f64, |most, b| most.max(b.abs()));
    if scale == 0.0 && settling.pulls.is_empty() && !settling.problem.bilateral().contains(&true) {
        settling.solution.force.clear();
        settling.solution.force.resize(settling.candidates.len(), 0.0);
        return Ok(Solved::Nothing);
    }
    let mut is_sound = settling.solve_strictly().is_ok();
    if is_sound && !is_jammed(assembly, region, settling, stage) {
        return Ok(Solved::Soundly);
    }
    if assembly.remedies().is_on(Remedy::Leverless)
        && exclude_leverless(assembly, connectors, region, settling)
    {
        assembly.remedies().act(Remedy::Leverless);
        pose_problem(assembly, connectors, region, settling, stage);
        is_sound = settling.solve_strictly().is_ok();
        if is_sound && !is_jammed(assembly, region, settling, stage) {
            return Ok(Solved::Soundly);
        }
    }
    let remedies = assembly.remedies();
    settling.excluded.retain(|excluded| excluded.why != Exclusion::Distant);
    if remedies.act(Remedy::JammedForces) {
        exclude_distant((assembly, connectors), region, settling, stage);
    }
    let mut found = settling.solve_strictly();
    while is_sound && found.is_ok() && readmit_pressed(assembly, region, settling, stage) {
        pose_problem(assembly, connectors, region, settling, stage);
        found = settling.solve_strictly();
    }
    let solved = if is_sound && !settling.any_excluded(Exclusion::Distant) {
        Solved::Soundly
    } else {
        Solved::Somehow
    };
    if found.is_err() && remedies.act(Remedy::LenientForces) {
        found = found.or_else(|error| settling.solve_leniently().map_err(|_| error));
    }
    if let Err(source) = found {
        // Bodies at rest on each other turn by up to `rest` over their size, which may be rounding. As they go along or
        // round each other, gaps accelerate by twice the product of that spin and the speed between them.
        let velocity = |body: BodyId| assembly.moving_at(body, time).velocity;
        let is_free = |body: BodyId| assembly.is_movable(body);
        let drifts = region.records().iter().flat_map(Collision::bodies).all(is_free);
        let frame = region.bodies().first().filter(|_| drifts).map_or(DVec2::ZERO, |&body| velocity(body));
        let speeds = region.bodies().iter().map(|&body| (velocity(body) - frame).length());
        let fastest = speeds.fold(rest, f64::max);
        let is_rounding = scale <= 2.0 * rest * fastest / assembly.settings().steps.length;
        if !(is_rounding && assembly.remedies().act(Remedy::RestingContradiction)) {
            return Err(settle_error(assembly, region, settling, time, source));
        }
        settling.solution.force.clear();
        settling.solution.force.resize(settling.candidates.len(), 0.0);
    }
    Ok(solved)
}

/// Adds the contacts that open in no more than a low hop under the forces of the candidates; true if there are any.
fn add_hops(assembly: &Assembly, region: &Region, settling: &mut Settling, stage: &Stage) -> bool {
    let mut records = region.records().iter().enumerate();
    if !records.any(|record| could_hop(assembly, region, settling, record)) {
        return false;
    }
    push_bodies(assembly, region, settling, stage);
    let before = settling.candidates.len();
    for (index, record) in region.records().iter().enumerate() {
        if !could_hop(assembly, region, settling, (index, record)) {
            continue;
        }
        let is_new = settling.candidates[..before].binary_search(&index).is_err();
        let offset = offset_under(assembly, region, record, &settling.pushed);
        if is_new && is_low_hop(assembly, record, offset) {
            settling.candidates.push(index);
        }
    }
    settling.candidates.sort_unstable();
    settling.candidates.len() > before && assembly.remedies().act(Remedy::LowHops)
}

/// True if a record of a region, given with its index, may hop, and has not been released or excluded.
fn could_hop(
    assembly: &Assembly,
    region: &Region,
    settling: &Settling,
    (index, record): (usize, &Collision),
) -> bool {
    let is_excluded =
        || Touch::of(record).is_some_and(|touch| settling.is_excluded(touch, Exclusion::Leverless));
    !settling.leaves(index)
        && !settling.loose.contains(&index)
        && may_carry_force(assembly, record)
        && may_hop(assembly, region, record)
        && !is_excluded()
}

/// Finds the accelerations of a region's bodies under the forces of the candidates.
fn push_bodies(assembly: &Assembly, region: &Region, settling: &mut Settling, stage: &Stage) {
    let mut pushed = std::mem::take(&mut settling.pushed);
    pushed.clear();
    pushed.extend_from_slice(stage.accelerations());
    settling.add_responses(region, &settling.candidates, |body| assembly.inertia(body), &mut pushed);
    settling.pushed = pushed;
}

/// Accelerations [m/s^2] of the gaps of some records under the forces found last.
pub(crate) fn accelerations_of(
    assembly: &Assembly,
    groups: &Groups,
    (region, settling): (&Region, &mut Settling),
    records: [usize; 2],
) -> [f64; 2] {
    push_bodies(assembly, region, settling, groups.stage());
    records.map(|record| offset_under(assembly, region, &region.records()[record], &settling.pushed))
}

/// True if a unilateral row may carry a force: connectors always do.
pub(crate) fn may_carry_force(assembly: &Assembly, record: &Collision) -> bool {
    assembly.settings().impulse_step.is_none() || record.parties.primary.site.is_none()
}

/// Excludes contacts beyond their target gap, which need not be in contact: a body that fits between two others
/// with little room touches at most one of them.
fn exclude_distant(
    (assembly, connectors): (&Assembly, &Connectors),
    region: &Region,
    settling: &mut Settling,
    stage: &Stage,
) {
    let Settling { candidates, excluded, .. } = settling;
    let may_stay = |index: &usize| region.records()[*index].gap_state().is_at_target(assembly.sink());
    let distant = candidates.iter().copied().filter(|index| !may_stay(index));
    excluded.extend(distant.map(|record| Excluded::of(region, record, Exclusion::Distant)));
    candidates.retain(may_stay);
    pose_problem(assembly, connectors, region, settling, stage);
}

/// Admits again the excluded contacts that the forces found without them press together; true if there are any. A
/// body that fits with little room is pressed on one side only. In an arch that is nearly straight all contacts
/// carry forces far larger than all loads: if the remaining candidates jam, too, all contacts are admitted.
fn readmit_pressed(assembly: &Assembly, region: &Region, settling: &mut Settling, stage: &Stage) -> bool {
    if !settling.any_excluded(Exclusion::Distant) {
        return false;
    }
    if is_jammed(assembly, region, settling, stage) {
        settling.readmit_distant(|_| true);
        return true;
    }
    push_bodies(assembly, region, settling, stage);
    let scale = settling.problem.offset().iter().fold(0.0f64, |most, b| most.max(b.abs()));
    let pushed = std::mem::take(&mut settling.pushed);
    let is_pressed = |index: usize| {
        offset_under(assembly, region, &region.records()[index], &pushed) < -NEGLIGIBLE * scale
    };
    let any = settling.readmit_distant(is_pressed);
    settling.pushed = pushed;
    any
}

fn settle_error(
    assembly: &Assembly,
    region: &Region,
    settling: &Settling,
    time: Time,
    source: SolveError,
) -> AdvanceError {
    let touching = region.records().iter().map(Collision::bodies);
    if let Err(squeezed) = assembly.refuse_squeezed(touching, LARGEST_MASS_RATIO, time) {
        return squeezed;
    }
    let mut bodies: Vec<BodyId> =
        settling.candidates.iter().flat_map(|&index| region.records()[index].bodies()).collect();
    bodies.sort_unstable();
    bodies.dedup();
    let row = source.row().and_then(|row| settling.candidates.get(row));
    AdvanceError::Contacts {
        time: time.seconds(),
        bodies,
        between: row.map(|&index| Between::of(&region.records()[index])),
        problem: Box::new(settling.problem.clone()),
        source: Box::new(source),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::bodies::trajectory::FreeMotion;
    use crate::rigid::books::energy::interrupt;
    use crate::rigid::event::life::dissolve;
    use crate::rigid::event::work::EventWork;
    use crate::rigid::group::groups::group_of;
    use crate::rigid::parts::{BodyPart, RigidParts};
    use crate::rigid::region::collecting::collect_region;
    use crate::rigid::test_scene::{FINE, rooms_of};
    use halfgap_collision::{Body, BodyState};
    use halfgap_geometry::Shape;

    /// True if the contact of a disc is active that touches a beam on two posts from below, departs at 1e-8 m/s, and is
    /// pushed up with an acceleration [m/s^2].
    fn beam_holds_disc_below(push: f64) -> bool {
        let gap: f64 = FINE.tolerances.target_gap;
        let shape = |shape: Result<Shape, _>| shape.expect("a fine size");
        let post = |x: f64| {
            let tall = shape(Shape::block(0.2, 1.0));
            let body = Body { shape: tall, inverse_mass: 0.0, inverse_moment: 0.0, elasticity: 0.0 };
            let state = BodyState { position: DVec2::new(x, -0.5 - gap), ..BodyState::default() };
            BodyPart::new(body, FreeMotion::default(), state)
        };
        let mover = |shape: Shape, y: f64, acceleration: f64| {
            let body = Body { shape, inverse_mass: 1.0, inverse_moment: 3.0, elasticity: 0.0 };
            let free_motion =
                FreeMotion { acceleration: DVec2::new(0.0, acceleration), ..FreeMotion::default() };
            let state = BodyState { position: DVec2::new(0.0, y), ..BodyState::default() };
            BodyPart::new(body, free_motion, state)
        };
        let beam = mover(shape(Shape::block(2.4, 0.2)), 0.1, -9.81);
        let disc = mover(shape(Shape::disc(0.1)), -0.1 - gap, push);
        let bodies = vec![post(-1.0), post(1.0), beam, disc];
        let parts = RigidParts { bodies, ..RigidParts::default() };
        let mut rooms = rooms_of(parts, FINE, Time::ZERO);
        let mut work = rooms.work.take().expect("the start has made it");
        dissolve(&mut rooms, BodyId(2));
        let position = rooms.assembly.trajectory(BodyId(3)).state_at(rooms.assembly.now()).position;
        let leaving = BodyState { position, velocity: DVec2::new(0.0, -1e-8), ..BodyState::default() };
        interrupt(&mut rooms.assembly, &mut rooms.books, BodyId(3)).fly_from(Time::ZERO, leaving);
        let EventWork { region, settling, .. } = &mut *work;
        region.set_cause(Cause::Start);
        collect_region(&rooms.view(), region, &[BodyId(2), BodyId(3)], rooms.assembly.now());
        region.set_cause(Cause::Other);
        let touch = |record: &&Collision| record.involves_body(BodyId(3));
        let touch = region.records().iter().find(touch).and_then(Touch::of).expect("they touch");
        settling.set_likely(region.records().iter().map(|_| None));
        let mut stage = rooms.groups.take_stage();
        settle(&rooms.view(), region, settling, &mut stage, rooms.assembly.now(), true).expect("it rests");
        assert!(settling.active.len() >= 2, "the posts hold the beam");
        settling.is_active(touch)
    }

    #[test]
    fn the_rounding_of_a_pull_across_the_normal_presses_nothing() {
        // A block falls along two walls that it just fits between, and that narrow by rounding.
        let body = |shape: Result<Shape, _>, inverse: f64| Body {
            shape: shape.expect("a fine size"),
            inverse_mass: inverse,
            inverse_moment: inverse,
            elasticity: 0.0,
        };
        let at = |x: f64, angle: f64| {
            let position = DVec2::new(x, 0.0);
            BodyState { position, angle, ..BodyState::default() }
        };
        let wall = |side: f64| {
            let apart = 1.0 + FINE.tolerances.target_gap;
            let state = at(side * apart, -1e-14 * side);
            BodyPart::new(body(Shape::block(1.0, 8.0), 0.0), FreeMotion::default(), state)
        };
        let free_motion = FreeMotion { acceleration: DVec2::new(0.0, -9.81), ..FreeMotion::default() };
        let block = BodyPart::new(body(Shape::block(1.0, 1.0), 1.0), free_motion, at(0.0, 0.0));
        let parts = RigidParts { bodies: vec![wall(-1.0), wall(1.0), block], ..RigidParts::default() };
        let rooms = rooms_of(parts, FINE, Time::ZERO);
        assert!(group_of(&rooms.assembly, &rooms.groups, BodyId(2)).is_none(), "nothing holds it");
    }

    #[test]
    fn a_contact_that_others_keep_from_coming_back_does_not_hop() {
        assert!(beam_holds_disc_below(1.0));
        // Without the posts the beam would come down on the disc at once.
        assert!(!beam_holds_disc_below(1e-7));
    }
}
