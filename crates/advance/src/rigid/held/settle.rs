//! Choice of the rows that are held after an event: those that carry a force.
//!
//! All touching rows that neither close nor open are candidates and enter one complementarity problem a = A f + b. A
//! row that carries a force is held as an equation from then on; one that does not is left to the search for contacts,
//! which watches its gap. Forces of redundant rows are not unique: a row that the solution leaves without force follows
//! from the others.

use super::settling::{SMALL_CONTRADICTION, Settling};
use super::squeezed::{HOPELESS_MASS_RATIO, LARGEST_MASS_RATIO};
use crate::rigid::error::{AdvanceError, Between};
use crate::rigid::event::cause::{Cause, EventWork};
use crate::rigid::event::jams::JAM;
use crate::rigid::event::region::{Region, Touch};
use crate::rigid::step::dynamics::{LEVEL, Physics, Stage};
use crate::rigid::step::rows::{HeldRow, RowSource};
use crate::rigid::step::segment::LONGEST_STEP;
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, Collision, Spin, Tolerances};
use halfgap_contact::SolveError;

/// Half-width of a target zone above which it can be seen, as a fraction of the larger body's reach.
const SEEN: f64 = 1e-4;
/// Depth below its zone from which a row is lifted, as a multiple of the distance by which a contact sinks at a time: a
/// row that has just been lifted may sink once.
const SUNK: f64 = 1.5;
/// Largest penetration of a held contact whose zone cannot be seen, as a multiple of the target gap: a deeper one is
/// lifted to it.
pub(crate) const DEEPEST: f64 = 0.5;
/// Distance beyond its end at which a rope or a stop is held when it is lifted, as a fraction of its `accuracy`.
const ROPE_SHARE: f64 = 0.5;

/// Least force of a contact to be held again just after its release, as a fraction of the loads of its bodies. With
/// less it sinks so slowly that it may as well be touched again.
const RELEASED_SHARE: f64 = 1e-3;

/// Force of a contact that is rounding, as a fraction of the loads of its bodies; such a contact need not be held. A
/// little more may keep a body in balance: a brick on the joint of two others, which stands on corners next to each
/// other, would fall over without it.
const IDLE_SHARE: f64 = 1e-13;

/// Largest opening rate of a held contact in a hasty group, as a fraction of the rate at rest.
pub(crate) const HASTY_SHARE: f64 = 1e-3;

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

impl RigidSystem {
    /// Finds the rows of a region to hold; `with_hops` includes contacts that open in a low hop. Records must be up to
    /// date; their forces are written into them.
    pub(crate) fn settle(
        &self,
        region: &mut Region,
        settling: &mut Settling,
        stage: &mut Stage,
        time: Time,
        with_hops: bool,
    ) -> Result<(), AdvanceError> {
        settling.held.clear();
        settling.touches.clear();
        settling.passing.clear();
        settling.candidates.clear();
        let is_start = region.cause == Cause::Start;
        settling.is_start = is_start;
        let rest = match (is_start, region.in_storm) {
            (true, _) => self.start_rest(),
            (false, true) => self.storm_rest(),
            (false, false) => self.rest_speed(),
        };
        let share = if region.is_hasty { HASTY_SHARE } else { 1.0 };
        let is_candidate = |record: &Collision| {
            let rest = if is_start { self.start_rest_of(record) } else { rest };
            let is_slow = (-rest..=share * rest).contains(&record.motion.normal_velocity);
            record.parties.bilateral || (self.holds(record) && is_slow)
        };
        let records = || region.records.iter().enumerate();
        settling
            .candidates
            .extend(records().filter(|(_, record)| is_candidate(record)).map(|(index, _)| index));
        let may_hop = |settling: &Settling| records().any(|record| self.could_hop(region, settling, record));
        if settling.candidates.is_empty() && !(with_hops && may_hop(settling)) {
            return Ok(());
        }
        self.accelerate_region(region, settling, stage, time);
        let mut solved = self.solve_candidates(region, settling, stage, (time, rest))?;
        // Held contacts may press others back, or keep those that open from coming back.
        while with_hops && solved != Solved::Somehow && self.add_hops(region, settling, stage) {
            solved = self.solve_candidates(region, settling, stage, (time, rest))?;
        }
        if solved == Solved::Nothing {
            return Ok(());
        }
        // A contact that carries too little to be held is given no force: the others are solved without it.
        while self.drop_idle(region, settling, stage) {
            self.solve_candidates(region, settling, stage, (time, rest))?;
        }
        if region.is_unsound || (!is_start && (settling.is_shared() || self.has_pulled(time))) {
            self.spare_nearly_redundant(region, settling);
        }
        if is_start || self.has_pulled(time) {
            // The last problem may still have had candidates that were then dropped without a force.
            self.pose_problem(region, settling, stage);
            self.spare_redundant(region, settling, stage);
        }
        self.choose_rows(region, settling, time);
        self.refuse_squeezed(settling.held.iter().map(|(_, row)| row.bodies), HOPELESS_MASS_RATIO, time)
    }

    /// Finds the forces of the candidates; leaves some of them out if they jam or no solution is found.
    fn solve_candidates(
        &self,
        region: &Region,
        settling: &mut Settling,
        stage: &Stage,
        (time, rest): (Time, f64),
    ) -> Result<Solved, AdvanceError> {
        self.pose_problem(region, settling, stage);
        let scale = settling.problem.offset().iter().fold(0.0f64, |most, b| most.max(b.abs()));
        if scale == 0.0 && !settling.problem.bilateral().contains(&true) {
            settling.solution.force.clear();
            settling.solution.force.resize(settling.candidates.len(), 0.0);
            return Ok(Solved::Nothing);
        }
        let mut is_sound = settling.solve_strictly().is_ok();
        if is_sound && !self.is_jammed(region, settling, stage) {
            return Ok(Solved::Soundly);
        }
        if self.let_pass(region, settling) {
            self.pose_problem(region, settling, stage);
            is_sound = settling.solve_strictly().is_ok();
            if is_sound && !self.is_jammed(region, settling, stage) {
                return Ok(Solved::Soundly);
            }
        }
        self.drop_distant(region, settling, stage);
        let mut found = settling.solve_strictly();
        while is_sound && found.is_ok() && self.take_back_pressed(region, settling, stage) {
            self.pose_problem(region, settling, stage);
            found = settling.solve_strictly();
        }
        if found.is_err() && self.drop_leaving(region, settling, stage) {
            self.pose_problem(region, settling, stage);
            found = settling.solve_strictly();
        }
        let solved = if is_sound && settling.dropped.is_empty() { Solved::Soundly } else { Solved::Somehow };
        if let Err(source) = found.or_else(|_| settling.solve_leniently()) {
            // Bodies at rest on each other turn by up to `rest` over their size, which may be rounding. As they go along or
            // round each other, gaps accelerate by twice the product of that spin and the speed between them.
            let velocity = |body: BodyId| self.moving_at(body, time).velocity;
            let is_free = |body: BodyId| self.is_movable(body);
            let drifts = region.records.iter().flat_map(Collision::bodies).all(is_free);
            let frame = region.bodies.first().filter(|_| drifts).map_or(DVec2::ZERO, |&body| velocity(body));
            let speeds = region.bodies.iter().map(|&body| (velocity(body) - frame).length());
            let fastest = speeds.fold(rest, f64::max);
            if scale > 2.0 * rest * fastest / self.settings.steps.length {
                return Err(self.settle_error(region, settling, time, source));
            }
            settling.solution.force.clear();
            settling.solution.force.resize(settling.candidates.len(), 0.0);
        }
        Ok(solved)
    }

    /// Adds the contacts that open in no more than a low hop under the forces of the candidates; true if there are any.
    fn add_hops(&self, region: &Region, settling: &mut Settling, stage: &Stage) -> bool {
        let mut records = region.records.iter().enumerate();
        if !records.any(|record| self.could_hop(region, settling, record)) {
            return false;
        }
        self.push_bodies(region, settling, stage);
        let before = settling.candidates.len();
        for (index, record) in region.records.iter().enumerate() {
            if !self.could_hop(region, settling, (index, record)) {
                continue;
            }
            let is_new = settling.candidates[..before].binary_search(&index).is_err();
            let offset = offset_under(region, record, &settling.pushed);
            if is_new && self.is_low_hop(record, offset) {
                settling.candidates.push(index);
            }
        }
        settling.candidates.sort_unstable();
        settling.candidates.len() > before
    }

    /// True if a record of a region, given with its index, may hop, and has not been released or left out.
    fn could_hop(&self, region: &Region, settling: &Settling, (index, record): (usize, &Collision)) -> bool {
        let passes = || Touch::of(record).is_some_and(|touch| settling.lets_pass(touch));
        !settling.leaves(index) && self.holds(record) && self.may_hop(region, record) && !passes()
    }

    /// Finds the accelerations of a region's bodies under the forces of the candidates.
    fn push_bodies(&self, region: &Region, settling: &mut Settling, stage: &Stage) {
        let mut pushed = std::mem::take(&mut settling.pushed);
        pushed.clear();
        pushed.extend_from_slice(&stage.accelerations);
        settling.add_responses(region, &settling.candidates, |body| self.inertia(body), &mut pushed);
        settling.pushed = pushed;
    }

    /// Accelerations [m/s^2] of the gaps of some records under the forces found last.
    pub(crate) fn accelerations_of(&self, work: &mut EventWork, records: [usize; 2]) -> [f64; 2] {
        let EventWork { region, settling, .. } = work;
        self.push_bodies(region, settling, &self.stage);
        records.map(|record| offset_under(region, &region.records[record], &settling.pushed))
    }

    /// True if a unilateral row may carry a force: connectors always do.
    fn holds(&self, record: &Collision) -> bool {
        self.settings.impulse_step.is_none() || record.parties.primary.site.is_none()
    }

    /// True if contact forces are so much larger than the loads of the bodies that rows seem to work against each
    /// other, as those on both sides of a body that just fits. Connectors do not count: those with long arms have such
    /// forces anyway.
    fn is_jammed(&self, region: &Region, settling: &Settling, stage: &Stage) -> bool {
        let forces = settling.candidates.iter().zip(&settling.solution.force);
        let of_contacts = forces.filter(|&(&index, _)| !region.records[index].parties.bilateral);
        self.is_jam(region, stage, of_contacts.fold(0.0, |most, (_, force)| most.max(force.abs())))
    }

    /// True if a largest contact force [N] is that of a jam.
    pub(super) fn is_jam(&self, region: &Region, stage: &Stage, largest: f64) -> bool {
        let loads = region.bodies.iter().zip(&stage.accelerations).map(|(&body, a)| self.flyer(body).load(a));
        largest > JAM * loads.sum::<f64>()
    }

    /// Leaves out contacts beyond their target gap, which need not be in contact: a body that fits between two others
    /// with little room touches at most one of them.
    fn drop_distant(&self, region: &Region, settling: &mut Settling, stage: &Stage) {
        let Settling { candidates, dropped, .. } = settling;
        let may_stay = |index: &usize| self.is_close(&region.records[*index]);
        dropped.clear();
        dropped.extend(candidates.iter().copied().filter(|index| !may_stay(index)));
        candidates.retain(may_stay);
        self.pose_problem(region, settling, stage);
    }

    /// Takes back the contacts left out that the forces found without them press together; true if there are any. A
    /// body that fits with little room is pressed on one side only. In an arch that is nearly straight all contacts
    /// carry forces far larger than all loads: if the remaining candidates jam, too, all contacts are taken back.
    fn take_back_pressed(&self, region: &Region, settling: &mut Settling, stage: &Stage) -> bool {
        if settling.dropped.is_empty() {
            return false;
        }
        if self.is_jammed(region, settling, stage) {
            settling.take_back(|_| true);
            return true;
        }
        self.push_bodies(region, settling, stage);
        let scale = settling.problem.offset().iter().fold(0.0f64, |most, b| most.max(b.abs()));
        let pushed = std::mem::take(&mut settling.pushed);
        let is_pressed = |index: usize| {
            offset_under(region, &region.records[index], &pushed) < -SMALL_CONTRADICTION * scale
        };
        let any = settling.take_back(is_pressed);
        settling.pushed = pushed;
        any
    }

    fn accelerate_region(&self, region: &Region, settling: &mut Settling, stage: &mut Stage, time: Time) {
        for &body in &region.bodies {
            stage.movings[body.index()] = self.flyer(body).moving_at(time);
        }
        self.laws.list(&region.bodies, &mut settling.laws);
        let physics = self.physics();
        let of_region = (region.bodies.as_slice(), settling.laws.as_slice());
        stage.accelerate(&physics, of_region, time.seconds(), &[], &mut []);
    }

    fn pose_problem(&self, region: &Region, settling: &mut Settling, stage: &Stage) {
        let problem = &mut settling.problem;
        let least = f64::EPSILON * self.settings.tolerances.accuracy / (LONGEST_STEP * LONGEST_STEP);
        region.begin(problem, |body| self.inertia(body));
        for &index in &settling.candidates {
            let record = &region.records[index];
            // Accelerations that move nothing in the longest time are rounding, as are those that remain of
            // accelerations across the normal.
            let offset = free_offset(region, record, stage);
            let least = least.max(LEVEL * largest_acceleration(region, record, stage));
            let offset = if offset.abs() > least { offset } else { 0.0 };
            let Some(row) = region.row_of(record, offset) else { continue };
            problem.add_row(&row).expect("a row of finite numbers on bodies of the problem");
        }
    }

    /// Drops the contacts that carry next to no force; true if any of them carries some at all.
    fn drop_idle(&self, region: &mut Region, settling: &mut Settling, stage: &Stage) -> bool {
        let Settling { candidates, solution, gross, .. } = settling;
        // Loads [N] of each body: its own and those of its rows.
        gross.clear();
        let bodies = region.bodies.iter().zip(&stage.accelerations);
        gross.extend(bodies.map(|(&body, acceleration)| self.flyer(body).load(acceleration)));
        for (&index, force) in candidates.iter().zip(&solution.force) {
            for place in places_of(region, &region.records[index]) {
                gross[place] += force.abs();
            }
        }
        let mut any = false;
        let mut forces = solution.force.iter();
        candidates.retain(|&index| {
            let force = forces.next().copied().unwrap_or_default();
            let record = region.records[index];
            let loads = places_of(region, &record).map(|place| gross[place]);
            let is_released = Touch::of(&record).is_some_and(|touch| region.cause == Cause::Released(touch));
            let share = if is_released { RELEASED_SHARE } else { IDLE_SHARE };
            let least = share * loads.fold(f64::INFINITY, f64::min);
            let lies_deep = !region.is_unsound && self.lifted(&record).is_some();
            let stays = record.parties.bilateral || force > least || lies_deep;
            region.records[index].response.force = Some(if stays { force } else { 0.0 });
            any |= !stays && force > 0.0;
            stays
        });
        any
    }

    /// Makes held rows of the remaining candidates.
    fn choose_rows(&self, region: &Region, settling: &mut Settling, time: Time) {
        for &index in &settling.candidates {
            let record = &region.records[index];
            let lifted = if region.is_unsound { None } else { self.lifted(record) };
            settling.held.extend(self.held_row(record, lifted, time).map(|row| (index, row)));
        }
        settling.list_touches();
    }

    /// A row with `leans` set as it is at a time.
    pub(crate) fn with_lean(&self, row: HeldRow, time: Time) -> HeldRow {
        let movings = row.bodies.map(|body| self.moving_at(body, time));
        HeldRow { leans: self.mechanism().leans(&row, [&movings[0], &movings[1]]), ..row }
    }

    /// The row of a record, held at its present gap or at the one [m] to which it is `lifted`.
    fn held_row(&self, record: &Collision, lifted: Option<f64>, time: Time) -> Option<HeldRow> {
        let source = self.source_of(record)?;
        let bodies = record.bodies();
        let hint = match source {
            RowSource::Connector(id, index) => self.connectors.states[id.index()].hint_of(index).copied(),
            RowSource::Contact(_) => None,
        };
        // Bilateral rows are kept at gap 0, the others where they are, unless they have sunk too deep: moving a rope to
        // its length would move a body that hangs on it by a long arm by much more.
        let bilateral = record.parties.bilateral;
        let gap = if bilateral { 0.0 } else { lifted.unwrap_or(record.geometry.distance) };
        let is_lifted = lifted.is_some() && self.is_seen(record);
        let row = HeldRow { source, bodies, bilateral, gap, hint, leans: false, is_lifted };
        Some(self.with_lean(row, time))
    }

    /// The gap [m] to which a row that has sunk too deep is lifted; `None` for others. A contact without force sinks a
    /// little each time it is touched. It is lifted before the search takes it for the far side of a body; where zones
    /// can be seen, it is lifted into its zone, lest bodies overlap, unless it formed lower.
    #[inline]
    fn lifted(&self, record: &Collision) -> Option<f64> {
        let is_contact = record.connector().is_none();
        let lies_deep = |lowest: f64| !record.parties.bilateral && record.geometry.distance < lowest;
        let (lowest, sunk) = (lower_end(record), SUNK * record.tolerances.sink());
        if !lies_deep(lowest - sunk) {
            return None;
        }
        let deepest = -DEEPEST * record.tolerances.target_gap;
        if !self.is_seen(record) {
            return (is_contact && lies_deep(deepest)).then_some(deepest);
        }
        let formed = if is_contact { self.formed_at(record).max(deepest) } else { lowest };
        let lowest = lowest.min(formed);
        lies_deep(lowest - sunk).then_some(lowest)
    }

    /// True if the target zone of a record is so wide relative to its bodies that their place in it can be seen.
    fn is_seen(&self, record: &Collision) -> bool {
        self.is_zone_seen(record.bodies())
    }

    /// True if the target zone between two bodies is so wide relative to them that their place in it can be seen.
    pub(crate) fn is_zone_seen(&self, bodies: [BodyId; 2]) -> bool {
        self.settings.tolerances.accuracy > SEEN * self.largest_reach(bodies)
    }

    fn settle_error(
        &self,
        region: &Region,
        settling: &Settling,
        time: Time,
        source: SolveError,
    ) -> AdvanceError {
        let touching = region.records.iter().map(Collision::bodies);
        if let Err(squeezed) = self.refuse_squeezed(touching, LARGEST_MASS_RATIO, time) {
            return squeezed;
        }
        let mut bodies: Vec<BodyId> =
            settling.candidates.iter().flat_map(|&index| region.records[index].bodies()).collect();
        bodies.sort_unstable();
        bodies.dedup();
        let row = source.row().and_then(|row| settling.candidates.get(row));
        AdvanceError::Contacts {
            time: time.seconds(),
            bodies,
            between: row.map(|&index| Between::of(&region.records[index])),
            problem: Box::new(settling.problem.clone()),
            source: Box::new(source),
        }
    }

    /// The parts of the system from which the motion of groups is computed.
    pub(crate) fn physics(&self) -> Physics<'_> {
        Physics::of(&self.flyers, &self.connectors.all, &self.laws.all, &self.settings)
    }
}

/// The lower end [m] of the zone in which a row is held. Ropes and stops, which are taut at 0, must not exceed their
/// ends by more than `accuracy`, however they sink.
fn lower_end(record: &Collision) -> f64 {
    let Tolerances { target_gap, accuracy, .. } = record.tolerances;
    if record.connector().is_some() { -ROPE_SHARE * accuracy } else { target_gap - accuracy }
}

/// Acceleration [m/s^2] of a record's gap without the forces of rows.
pub(crate) fn free_offset(region: &Region, record: &Collision, stage: &Stage) -> f64 {
    offset_under(region, record, &stage.accelerations)
}

/// Acceleration [m/s^2] of a record's gap under given accelerations of the region's bodies.
fn offset_under(region: &Region, record: &Collision, accelerations: &[[f64; 3]]) -> f64 {
    let sides = record.bodies();
    let spins =
        sides.map(|body| region.place(body).map_or(Spin::default(), |place| spin(accelerations[place])));
    record.motion.kinematics.acceleration(&spins[0], &spins[1])
}

/// Largest acceleration [m/s^2] of the centre of a record's bodies without the forces of rows.
fn largest_acceleration(region: &Region, record: &Collision, stage: &Stage) -> f64 {
    let linear = places_of(region, record).map(|place| spin(stage.accelerations[place]).linear.length());
    linear.fold(0.0, f64::max)
}

/// Places of the movable bodies of a record.
fn places_of<'a>(region: &'a Region, record: &Collision) -> impl Iterator<Item = usize> + use<'a> {
    let bodies = record.bodies();
    bodies.into_iter().filter_map(|body| region.place(body))
}

fn spin([x, y, angular]: [f64; 3]) -> Spin {
    Spin { linear: DVec2::new(x, y), angular }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::event::cause::EventWork;
    use crate::rigid::motion::flyer::FlightLaw;
    use crate::rigid::test_scene::{FINE, resting_discs};
    use crate::rigid::{BodyPart, RigidParts};
    use halfgap_collision::{Body, BodyState};
    use halfgap_geometry::Shape;

    /// True if the contact of a disc is held that touches a beam on two posts from below, departs at 1e-8 m/s, and is
    /// pushed up with an acceleration [m/s^2].
    fn beam_holds_disc_below(push: f64) -> bool {
        const GAP: f64 = FINE.tolerances.target_gap;
        let shape = |shape: Result<Shape, _>| shape.expect("a fine size");
        let post = |x: f64| {
            let tall = shape(Shape::block(0.2, 1.0));
            let body = Body { shape: tall, inverse_mass: 0.0, inverse_moment: 0.0, elasticity: 0.0 };
            let state = BodyState { position: DVec2::new(x, -0.5 - GAP), ..BodyState::default() };
            BodyPart { body, law: FlightLaw::default(), state }
        };
        let mover = |shape: Shape, y: f64, acceleration: f64| {
            let body = Body { shape, inverse_mass: 1.0, inverse_moment: 3.0, elasticity: 0.0 };
            let law = FlightLaw { acceleration: DVec2::new(0.0, acceleration), ..FlightLaw::default() };
            let state = BodyState { position: DVec2::new(0.0, y), ..BodyState::default() };
            BodyPart { body, law, state }
        };
        let beam = mover(shape(Shape::block(2.4, 0.2)), 0.1, -9.81);
        let disc = mover(shape(Shape::disc(0.1)), -0.1 - GAP, push);
        let bodies = vec![post(-1.0), post(1.0), beam, disc];
        let parts = RigidParts { bodies, ..RigidParts::default() };
        let mut system = RigidSystem::new(parts, FINE, Time::ZERO).expect("it rests");
        let mut work = system.work.take().expect("the start has made it");
        system.dissolve(BodyId(2));
        let position = system.flyer(BodyId(3)).state_at(system.now).position;
        let leaving = BodyState { position, velocity: DVec2::new(0.0, -1e-8), ..BodyState::default() };
        system.interrupt(BodyId(3)).fly_from(Time::ZERO, leaving);
        let EventWork { region, settling, .. } = &mut *work;
        region.cause = Cause::Start;
        system.collect_region(region, &[BodyId(2), BodyId(3)], system.now);
        region.cause = Cause::Other;
        let touch = |record: &&Collision| record.involves_body(BodyId(3));
        let touch = region.records.iter().find(touch).and_then(Touch::of).expect("they touch");
        settling.set_likely(region.records.iter().map(|_| None));
        let mut stage = std::mem::take(&mut system.stage);
        system.settle(region, settling, &mut stage, system.now, true).expect("it rests");
        assert!(settling.held.len() >= 2, "the posts hold the beam");
        settling.holds_touch(touch)
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
            BodyPart { body: body(Shape::block(1.0, 8.0), 0.0), law: FlightLaw::default(), state }
        };
        let law = FlightLaw { acceleration: DVec2::new(0.0, -9.81), ..FlightLaw::default() };
        let block = BodyPart { body: body(Shape::block(1.0, 1.0), 1.0), law, state: at(0.0, 0.0) };
        let parts = RigidParts { bodies: vec![wall(-1.0), wall(1.0), block], ..RigidParts::default() };
        let system = RigidSystem::new(parts, FINE, Time::ZERO).expect("it falls");
        assert!(system.group_of(BodyId(2)).is_none(), "nothing holds it");
    }

    #[test]
    fn a_contact_that_opens_as_slowly_as_one_at_rest_is_let_go_where_contacts_take_turns() {
        let mut system = resting_discs(&[0.0]);
        let mut work = system.work.take().expect("the start has made it");
        system.dissolve(BodyId(1));
        let EventWork { region, settling, .. } = &mut *work;
        system.collect_region(region, &[BodyId(1)], system.now);
        let mut stage = std::mem::take(&mut system.stage);
        for (share, is_hasty, rows) in [(0.5, false, 1), (0.5, true, 0), (1e-4, true, 1), (-0.5, true, 1)] {
            region.is_hasty = is_hasty;
            region.records[0].motion.normal_velocity = share * system.rest_speed();
            settling.set_likely([None].into_iter());
            system.settle(region, settling, &mut stage, system.now, false).expect("it rests");
            assert_eq!(settling.held.len(), rows, "{share} of what counts as rest, hasty: {is_hasty}");
        }
    }

    #[test]
    fn a_contact_that_others_keep_from_coming_back_does_not_hop() {
        assert!(beam_holds_disc_below(1.0));
        // Without the posts the beam would come down on the disc at once.
        assert!(!beam_holds_disc_below(1e-7));
    }
}
