//! Contacts that carry impulses only: slow ones sink, and are put back once a step.
//!
//! A pair that closes more slowly than `velocity_tol`, or has not left its target zone since it was last seen, does not
//! fire. At the next tick of the step an impulse stops its velocity, and it is moved back to its target gap by the
//! least displacement in the metric of the masses. A pair that is pressed so hard that it sinks deep before the tick is
//! stopped there, too.
//!
//! Until then the two bodies are searched, and take part in impacts, as deep as they may have sunk: another impact may
//! drive one further into the other, and a body that has turned meanwhile touches at other places.

use super::cause::{Cause, EventWork};
use super::region::{Region, Touch};
use crate::rigid::error::{AdvanceError, Between};
use crate::rigid::motion::law::Snapshot;
use crate::rigid::search::pairs::PairId;
use crate::rigid::sources::Source;
use crate::rigid::system::RigidSystem;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, Tolerances};
use halfgap_contact::Problem;
use halfgap_geometry::FeatureId;

/// Number of rounds of putting back that go all the way: gaps are not linear in the displacement, but nearly.
const ROUNDS: usize = 3;
/// Number of further rounds of putting back that go a fraction of the way.
const SHORT_ROUNDS: usize = 5;
/// Longest way of a body in one round, as a fraction of its reach: farther, gaps are not nearly linear.
const LONGEST_WAY: f64 = 0.1;
/// Depth to which a pair may sink, as a fraction of the reach of the smaller body, beside the way that it slowly closes
/// by in a step.
const SUNK_SHARE: f64 = 1e-2;
/// Bound of that depth, as a fraction of area over reach of the thinner body.
const THIN_SHARE: f64 = 1e-1;
/// Fraction of the room to sink at which a pair fires again.
const FIRST_SHARE: f64 = 0.6;
/// Fraction of the room beyond which a pair sinks no further, unless others drive it.
const DEEPEST_SHARE: f64 = 0.9;
/// Fraction of the room by which a pair may sink further whenever it fires again, slowly.
const FURTHER_SHARE: f64 = 1.0 / 96.0;
/// Multiple of the room: features that are deeper lie on the far side of a body.
const BEHIND: f64 = 1.25;
/// Fraction of the room beyond which a fast pair has sunk, rather than just been seen.
const DEEP_SHARE: f64 = 0.3;

/// Largest number of collisions of sunk contacts within a step.
const MOST_PRESSED: u32 = 100_000;

/// Contacts that wait for the next tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ticks {
    /// Touches that have sunk, sorted.
    waiting: Vec<Touch>,
    /// Distance [m] by which bodies have been moved in being put back; zero except during a tick.
    pub(crate) moved: f64,
    /// Number of ticks that have gone by.
    count: f64,
    /// Number of collisions of sunk contacts since the last tick.
    pressed: u32,
    /// Buffer: indices of the laws of a region's bodies.
    laws: Vec<usize>,
}

/// Buffers of the least displacement that moves bodies apart.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lift {
    problem: Problem,
    /// Index of the record of each row of the problem.
    rows: Vec<usize>,
    /// Displacement (x, y, angle) of each body of the region [m, m, rad].
    shifts: Vec<[f64; 3]>,
}

impl Ticks {
    fn wait(&mut self, touch: Touch) {
        if let Err(place) = self.waiting.binary_search(&touch) {
            self.waiting.insert(place, touch);
        }
    }

    /// Waiting touches of two bodies, the lesser first.
    pub(super) fn waiting_of(&self, bodies: [BodyId; 2]) -> &[Touch] {
        let start = self.waiting.partition_point(|touch| touch.bodies < bodies);
        let count = self.waiting[start..].partition_point(|touch| touch.bodies == bodies);
        &self.waiting[start..start + count]
    }
}

impl RigidSystem {
    /// Leaves a pair that fires to sink until the next tick; false if it has to be handled now.
    pub(crate) fn sinks(&mut self, pair: PairId, features: [FeatureId; 2]) -> bool {
        let Some(step) = self.settings.impulse_step else { return false };
        let bodies = self.pairs.bodies(pair);
        let touch = Touch::new(bodies, features);
        let (gap, rate) = self.gap_at(touch, self.now);
        if gap == f64::INFINITY {
            return false;
        }
        let tolerances = &self.settings.tolerances;
        let room = self.room_to_sink(bodies);
        let is_deep = gap < tolerances.target_gap - DEEP_SHARE * room;
        let is_fast = -rate > tolerances.velocity_tol;
        let is_deepest = gap < tolerances.target_gap - DEEPEST_SHARE * room;
        if is_deepest || is_fast && (is_deep || !self.has_stayed_low(pair, features, -rate, tolerances)) {
            return false;
        }
        let lowest = (tolerances.target_gap - FIRST_SHARE * room).min(gap - FURTHER_SHARE * room);
        let tick = self.next_tick(step);
        self.pairs.change_rules(pair, |rules| {
            rules.retain(|rule| rule.features != features);
            rules.push(touch.lowered_to(lowest));
        });
        self.ticks.wait(touch);
        // The search goes on for the other features of the two bodies.
        self.predict(pair);
        self.queue.set(self.source_id(Source::Tick), tick);
        true
    }

    /// Depth [m] by which a pair of bodies may sink below the target gap until it is put back; zero where contacts
    /// carry forces.
    ///
    /// # Panics
    /// If there is no such body.
    #[must_use]
    #[inline]
    pub fn room_to_sink(&self, bodies: [BodyId; 2]) -> f64 {
        let Some(step) = self.settings.impulse_step else { return 0.0 };
        let reach = bodies.map(|body| self.flyer(body).reach());
        let Tolerances { accuracy, velocity_tol, .. } = self.settings.tolerances;
        let of_bodies = (SUNK_SHARE * reach[0].min(reach[1])).min(self.thinness(bodies));
        // Contacts may be anywhere in the target zone, and sink from there: a first firing lies no higher than its end.
        of_bodies.max(accuracy / FIRST_SHARE) + velocity_tol * step
    }

    /// Gap [m] at which a contact without force that does not open fires, by its present gap [m]. Forces on its bodies,
    /// or their turning, may press on at once a contact that was stopped below its zone until it is put back: it may go
    /// a fraction of the way that is left to the depth beyond which it sinks no further.
    pub(crate) fn sinks_to(&self, touch: Touch, gap: f64) -> f64 {
        let Tolerances { target_gap, accuracy, .. } = self.settings.tolerances;
        if self.settings.impulse_step.is_none() || gap >= target_gap - accuracy {
            return self.refire_gap(gap);
        }
        let left = gap - target_gap + DEEPEST_SHARE * self.room_to_sink(touch.bodies);
        gap - self.sink().max(FURTHER_SHARE * left)
    }

    /// Depth [m] up to which a body that lies in another is told from one that has gone through it.
    pub(crate) fn thinness(&self, bodies: [BodyId; 2]) -> f64 {
        let shares = bodies.map(|body| {
            let flyer = self.flyer(body);
            THIN_SHARE * flyer.body().shape.mass_properties().area / flyer.reach()
        });
        shares[0].min(shares[1])
    }

    /// Depth [m] to which two bodies, the lesser first, may lie in one another. Where contacts carry impulses only,
    /// they have been left to sink, have been moved, or would sink within a step; where contacts carry forces, held
    /// ones may lie deep.
    pub(crate) fn may_have_sunk_by(&self, bodies: [BodyId; 2]) -> f64 {
        if self.settings.impulse_step.is_none() {
            return self.held_depth(bodies);
        }
        // Either may have been moved against the other.
        let moved = 2.0 * self.ticks.moved;
        if !self.ticks.waiting_of(bodies).is_empty() {
            // A body that is turned as it is put back sinks at other places.
            return BEHIND * self.room_to_sink(bodies) + moved.min(self.thinness(bodies));
        }
        self.settings.search.depth.max(moved).min(self.thinness(bodies))
    }

    /// Counts a collision of a touch, if it has sunk.
    ///
    /// # Errors
    /// More than `MOST_PRESSED` such collisions since the last tick.
    pub(crate) fn note_pressed(&mut self, touch: Touch) -> Result<(), AdvanceError> {
        let Some(step) = self.settings.impulse_step else { return Ok(()) };
        let sunk = self.settings.tolerances.target_gap - DEEP_SHARE * self.room_to_sink(touch.bodies);
        if self.gap_at(touch, self.now).0 >= sunk {
            return Ok(());
        }
        self.ticks.pressed += 1;
        if self.ticks.pressed <= MOST_PRESSED {
            return Ok(());
        }
        let [primary, normal] = touch.bodies;
        let (time, events) = (self.now.seconds(), self.ticks.pressed);
        Err(AdvanceError::Pressed { time, between: Between { primary, normal }, events, step })
    }

    /// Time of the first tick after the present time.
    fn next_tick(&mut self, step: f64) -> Time {
        let passed = (self.now.since(self.start) / step).floor();
        self.ticks.count = passed.max(self.ticks.count);
        let tick = self.start.plus((self.ticks.count + 1.0) * step);
        if tick > self.now { tick } else { self.start.plus((self.ticks.count + 2.0) * step) }
    }

    /// Stops and puts back bodies that have sunk.
    pub(crate) fn handle_tick(&mut self) -> Result<(), AdvanceError> {
        self.queue.clear(self.source_id(Source::Tick));
        self.ticks.pressed = 0;
        for index in 0..self.ticks.waiting.len() {
            let (gap, _) = self.gap_at(self.ticks.waiting[index], self.now);
            self.counts.note_gap(gap);
        }
        let outcome = self.with_work(Cause::Tick, |system, work| {
            work.seeds.clear();
            work.seeds.extend(system.ticks.waiting.iter().flat_map(|touch| touch.bodies));
            work.seeds.sort_unstable();
            work.seeds.dedup();
            system.handle_impact(work)
        });
        self.keep_what_is_sunk();
        outcome
    }

    /// Keeps waiting the touches that could not be put back altogether, and sets the next tick for them.
    fn keep_what_is_sunk(&mut self) {
        let mut waiting = std::mem::take(&mut self.ticks.waiting);
        let Tolerances { target_gap, accuracy, .. } = self.settings.tolerances;
        waiting.retain(|touch| {
            let gap = self.gap_at(*touch, self.now).0;
            gap < target_gap - accuracy && gap >= -BEHIND * self.room_to_sink(touch.bodies)
        });
        self.ticks.waiting = waiting;
        if let Some(step) = self.settings.impulse_step.filter(|_| !self.ticks.waiting.is_empty()) {
            let tick = self.next_tick(step);
            self.queue.set(self.source_id(Source::Tick), tick);
        }
    }

    /// Moves the bodies of a region, which are in flight, so that no gap is less than its target; bodies that they come
    /// to touch join the region.
    pub(crate) fn put_back(&mut self, work: &mut EventWork) {
        let (mut full, mut short) = (0, 0);
        while full < ROUNDS && short < SHORT_ROUNDS {
            for &body in &work.region.bodies {
                self.book_damping(body, self.now);
            }
            let before = self.potential_of(&work.region);
            let Some(share) = self.move_apart(work) else { break };
            *(if share == 1.0 { &mut full } else { &mut short }) += 1;
            self.ledger.projections += self.potential_of(&work.region) - before;
            for &body in &work.region.bodies {
                self.search.lanes[body.index()].follow(&self.flyers[body.index()]);
            }
            work.seeds.clear();
            work.seeds.extend(&work.region.bodies);
            self.collect_region(&mut work.region, &work.seeds, self.now);
            self.cut_groups(&mut work.region);
            self.remeasure(&mut work.region, self.now);
        }
        self.ticks.moved = 0.0;
        // Touching contacts may yet sink when connectors are put together again afterwards.
        for &touch in &work.region.touches {
            self.ticks.wait(touch);
        }
    }

    /// Makes one round; returns the fraction of the displacement that was made, or `None` if nothing had to move.
    fn move_apart(&mut self, work: &mut EventWork) -> Option<f64> {
        let EventWork { region, settling, lift, .. } = work;
        if !self.pose_lift(region, lift) || settling.solve(&lift.problem).is_err() {
            return None;
        }
        let Lift { shifts, rows, .. } = lift;
        shifts.clear();
        shifts.resize(region.bodies.len(), [0.0; 3]);
        settling.add_responses(region, rows, |body| self.inertia(body), shifts);
        let longest = self.longest_way(region, shifts);
        let share = if longest.1 > LONGEST_WAY { LONGEST_WAY / longest.1 } else { 1.0 };
        self.ticks.moved += share * longest.0;
        for (&body, &[x, y, turn]) in region.bodies.iter().zip(shifts.iter()) {
            let state = self.flyer(body).unwound_at(self.now);
            let position = state.position + share * DVec2::new(x, y);
            let moved = BodyState { position, angle: state.angle + share * turn, ..state };
            self.flyers[body.index()].fly_from(self.now, moved);
        }
        Some(share)
    }

    /// Longest way of a point of a region's bodies along a displacement (x, y, angle) of each: in metres, and as a
    /// fraction of the body's reach.
    fn longest_way(&self, region: &Region, shifts: &[[f64; 3]]) -> (f64, f64) {
        let ways = region.bodies.iter().zip(shifts).map(|(&body, [x, y, turn])| {
            let reach = self.flyer(body).reach();
            let way = libm::hypot(*x, *y) + turn.abs() * reach;
            (way, way / reach)
        });
        ways.fold((0.0, 0.0), |most, way| (most.0.max(way.0), most.1.max(way.1)))
    }

    /// Sets up the least displacement of a region's bodies that leaves no gap below its target; false if none is.
    fn pose_lift(&self, region: &Region, Lift { problem, rows, .. }: &mut Lift) -> bool {
        region.begin(problem, |body| self.inertia(body));
        rows.clear();
        let mut any_sunk = false;
        for (index, record) in region.records.iter().enumerate() {
            let target =
                if record.parties.primary.site.is_some() { record.tolerances.target_gap } else { 0.0 };
            let offset = record.geometry.distance - target;
            any_sunk |= offset < 0.0 && !record.parties.bilateral;
            let Some(row) = region.row_of(record, offset) else { continue };
            problem.add_row(&row).expect("a row of finite numbers on bodies of the problem");
            rows.push(index);
        }
        any_sunk
    }

    /// Potential energy [J] of the bodies of a region under uniform accelerations and laws that have a potential.
    fn potential_of(&mut self, region: &Region) -> f64 {
        let mut energy = 0.0;
        for &body in &region.bodies {
            self.stage.movings[body.index()] = self.flyer(body).moving_at(self.now);
            let flyer = self.flyer(body);
            let position = self.stage.movings[body.index()].pose.position;
            energy -= flyer.law().acceleration.dot(position) / flyer.body().inverse_mass;
        }
        let mut laws = std::mem::take(&mut self.ticks.laws);
        self.laws.list(&region.bodies, &mut laws);
        let now = Snapshot::of_unwound(self.now.seconds(), &self.stage.movings, &self.flyers);
        let of_laws = laws.iter().filter_map(|&law| self.laws.all[law].potential(&now)).sum::<f64>();
        self.ticks.laws = laws;
        energy + of_laws
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::test_scene::resting_discs;

    #[test]
    fn a_contact_stopped_deep_sinks_a_part_of_the_depth_left() {
        let mut system = resting_discs(&[0.0]);
        let Tolerances { target_gap, .. } = system.settings.tolerances;
        let bodies = [BodyId(0), BodyId(1)];
        let touch = Touch { bodies, features: [FeatureId(5), FeatureId(0)] };
        // With contact forces the contact sinks by no more than can be told.
        assert_eq!(system.sinks_to(touch, -1e-3), -1e-3 - system.sink());
        system.settings.impulse_step = Some(1e-3);
        let room = system.room_to_sink(bodies);
        let sinks_by = |depth: f64| {
            let gap = target_gap - depth * room;
            (gap - system.sinks_to(touch, gap)) / room
        };
        assert!((sinks_by(0.0) * room / system.sink() - 1.0).abs() < 1e-9, "it has not sunk yet");
        for depth in [0.5, 0.75] {
            assert!((sinks_by(depth) - (DEEPEST_SHARE - depth) * FURTHER_SHARE).abs() < 1e-9);
        }
        assert!((sinks_by(DEEPEST_SHARE) * room / system.sink() - 1.0).abs() < 1e-9, "no farther than that");
    }
    #[test]
    fn a_pressed_contact_collides_only_so_often_in_a_step() {
        let mut system = resting_discs(&[0.0]);
        let bodies = [BodyId(0), BodyId(1)];
        let touch = Touch { bodies, features: [FeatureId(5), FeatureId(0)] };
        let step = 1e-3;
        system.settings.impulse_step = Some(step);
        let notes =
            |system: &mut RigidSystem, times: u32| (0..times).find_map(|_| system.note_pressed(touch).err());
        assert_eq!(notes(&mut system, 2 * MOST_PRESSED), None, "nothing has sunk");
        system.dissolve(bodies[1]);
        let mut state = system.flyer(bodies[1]).state_at(system.now);
        state.position.y -= 0.5 * system.room_to_sink(bodies);
        system.flyers[1].fly_from(system.now, state);
        assert_eq!(notes(&mut system, MOST_PRESSED), None);
        let between = Between { primary: bodies[0], normal: bodies[1] };
        let (time, events) = (system.now.seconds(), MOST_PRESSED + 1);
        let expected = AdvanceError::Pressed { time, between, events, step };
        assert_eq!(notes(&mut system, 1), Some(expected));
        system.handle_tick().expect("it can be put back");
        assert_eq!(system.ticks.pressed, 0);
    }
}
