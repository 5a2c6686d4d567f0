//! Without contact forces: slow contacts sink, and are put back once a step.
//!
//! A pair that closes more slowly than `velocity_tol`, or has not left its target zone since it was seen last, does not fire.
//! At the next tick of the step its velocity is stopped by an impulse and it is moved back to its target gap, by the least
//! displacement in the metric of the masses. What is pressed so hard that it sinks deep meanwhile is stopped there, too.

use super::events::EventWork;
use super::pairs::PairId;
use super::region::Region;
use super::system::RigidSystem;
use crate::time::Time;
use glam::DVec2;
use halfgap_collision::{BodyId, BodyState, FeatureRule, GapKinematics};
use halfgap_contact::{BodyId as RowBody, Problem, Row};
use halfgap_geometry::{FeatureId, GapSample};

/// Rounds of putting back: gaps are not linear in the displacement, but nearly. And so many more that go a part of the way.
const ROUNDS: usize = 3;
const SHORT_ROUNDS: usize = 5;
/// Part of its reach by which a body is moved in a round at most: farther, gaps are not nearly linear.
const LONGEST_WAY: f64 = 0.1;
/// Part of the reach of the smaller body by which a pair may sink before it fires again.
const SUNK_SHARE: f64 = 1e-2;
/// Of that, what tells a pair that has sunk from one that has just been seen.
const DEEP_SHARE: f64 = 0.5;

/// The pairs that wait for the next tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ticks {
    waiting: Vec<PairId>,
    /// Ticks that have gone by.
    count: f64,
    /// By how much bodies are to be moved apart, and the records of its rows.
    problem: Problem,
    rows: Vec<usize>,
    shifts: Vec<[f64; 3]>,
    /// The laws of a region's bodies.
    laws: Vec<usize>,
}

impl RigidSystem {
    /// True if a pair that fires is left to sink until the next tick.
    pub(crate) fn sinks(&mut self, pair: PairId, features: [FeatureId; 2]) -> bool {
        let Some(step) = self.settings.impulse_step else { return false };
        let bodies = self.pairs.bodies(pair);
        let moving = bodies.map(|body| self.flyer(body).moving_at(self.now));
        let [a, b] = [0, 1].map(|side: usize| self.flyer(bodies[side]).body().shape.feature(features[side]));
        let sample = GapSample::measure_unbounded(a, &moving[0].pose, b, &moving[1].pose);
        let Some(sample) = sample else { return false };
        let (primary, normal) = if sample.primary_is_a { (0, 1) } else { (1, 0) };
        let rate = GapKinematics::of(&sample, &moving[primary], &moving[normal]).rate;
        let tolerances = &self.settings.tolerances;
        let is_fast = -rate > tolerances.velocity_tol;
        let reach = bodies.map(|body| self.flyer(body).reach());
        let room = SUNK_SHARE * reach[0].min(reach[1]);
        let seen = self.pairs.seen(pair).iter().find(|seen| seen.features == features);
        let is_deep = seen.is_some_and(|seen| seen.gap - sample.gap > DEEP_SHARE * room);
        if is_fast && (is_deep || !self.has_stayed_low(pair, features, -rate, tolerances)) {
            return false;
        }
        let tick = self.next_tick(step);
        self.pairs.change_rules(pair, |rules| {
            rules.retain(|rule| rule.features != features);
            rules.push(FeatureRule { features, target: Some(sample.gap - room) });
        });
        // The search goes on for the other features of the two bodies.
        self.predict(pair);
        if !self.ticks.waiting.contains(&pair) {
            self.ticks.waiting.push(pair);
        }
        self.queue.set(self.tick_source(), tick);
        true
    }

    /// The first tick after the present time.
    fn next_tick(&mut self, step: f64) -> Time {
        let passed = (self.now.since(self.start) / step).floor();
        self.ticks.count = passed.max(self.ticks.count);
        let tick = self.start.plus((self.ticks.count + 1.0) * step);
        if tick > self.now { tick } else { self.start.plus((self.ticks.count + 2.0) * step) }
    }

    /// Stops and puts back what has sunk; true if there was an impact.
    pub(crate) fn handle_tick(&mut self) -> Result<bool, super::AdvanceError> {
        self.queue.clear(self.tick_source());
        let mut work = self.work.take().unwrap_or_default();
        work.seeds.clear();
        work.seeds.extend(self.ticks.waiting.iter().flat_map(|&pair| self.pairs.bodies(pair)));
        self.ticks.waiting.clear();
        work.seeds.sort_unstable();
        work.seeds.dedup();
        self.at_tick = true;
        let outcome = self.handle_impact(&mut work);
        self.at_tick = false;
        self.work = Some(work);
        outcome
    }

    /// Moves the bodies of a region, which are in flight, so that no gap is less than its target.
    pub(crate) fn put_back(&mut self, work: &mut EventWork) {
        for &body in &work.region.bodies {
            self.restart_flight(body, self.now);
        }
        let (mut full, mut short) = (0, 0);
        while full < ROUNDS && short < SHORT_ROUNDS {
            let before = self.potential_of(&work.region);
            let Some(share) = self.move_apart(work) else { break };
            *(if share == 1.0 { &mut full } else { &mut short }) += 1;
            self.remeasure(&mut work.region, self.now);
            self.ledger.projections += self.potential_of(&work.region) - before;
        }
    }

    /// One round: tells which part of the way it went; `None` if nothing had to move.
    fn move_apart(&mut self, work: &mut EventWork) -> Option<f64> {
        let mut ticks = std::mem::take(&mut self.ticks);
        let moves = self.is_sunk(&work.region, &mut ticks) && work.settling.solve(&ticks.problem).is_ok();
        let mut moved = None;
        if moves {
            let Ticks { shifts, rows, .. } = &mut ticks;
            shifts.clear();
            shifts.resize(work.region.bodies.len(), [0.0; 3]);
            work.settling.add_responses(&work.region, rows, |body| self.inertia(body), shifts);
            let share = self.sound_share(&work.region, shifts);
            moved = Some(share);
            for (&body, &[x, y, turn]) in work.region.bodies.iter().zip(shifts.iter()) {
                let state = self.flyer(body).unwound_at(self.now);
                let position = state.position + share * DVec2::new(x, y);
                let moved = BodyState { position, angle: state.angle + share * turn, ..state };
                self.flyers[body.index()].fly_from(self.now, moved);
            }
        }
        self.ticks = ticks;
        moved
    }

    /// The part of a displacement (x, y, angle) of each of a region's bodies along which gaps are nearly linear.
    fn sound_share(&self, region: &Region, shifts: &[[f64; 3]]) -> f64 {
        let shares = region.bodies.iter().zip(shifts).map(|(&body, [x, y, turn])| {
            let longest = LONGEST_WAY * self.flyer(body).reach();
            let way = x.hypot(*y) + turn.abs() * self.flyer(body).reach();
            if way > longest { longest / way } else { 1.0 }
        });
        shares.fold(1.0, f64::min)
    }

    /// Sets up the least displacement of a region's bodies that leaves no gap less than its target; false if none is.
    fn is_sunk(&self, region: &Region, Ticks { problem, rows, .. }: &mut Ticks) -> bool {
        problem.clear();
        rows.clear();
        for &body in &region.bodies {
            problem.add_body(self.inertia(body)).expect("inertias were checked when the body was made");
        }
        let place_of = |body: BodyId| Some(RowBody(u32::try_from(region.place(body)?).ok()?));
        let mut any_sunk = false;
        for (index, record) in region.records.iter().enumerate() {
            let bilateral = record.parties.bilateral;
            let target =
                if record.parties.primary.site.is_some() { record.tolerances.target_gap } else { 0.0 };
            let offset = record.geometry.distance - target;
            any_sunk |= offset < 0.0 && !bilateral;
            let j = &record.motion.kinematics.jacobian;
            let sides = [
                (place_of(record.parties.primary.body), [j[0], j[1], j[2]]),
                (place_of(record.parties.normal.body), [j[3], j[4], j[5]]),
            ];
            let mut movable = sides.into_iter().filter_map(|(place, j)| Some((place?, j)));
            let Some((first, coefficients)) = movable.next() else { continue };
            let mut row = Row::new(first, coefficients, offset);
            if let Some((second, coefficients)) = movable.next() {
                row = row.against(second, coefficients);
            }
            let row = if bilateral { row.bilateral() } else { row };
            problem.add_row(&row).expect("a row of finite numbers on bodies of the problem");
            rows.push(index);
        }
        any_sunk
    }

    /// Potential energy [J] of the bodies of a region, as far as it has one.
    fn potential_of(&mut self, region: &Region) -> f64 {
        let mut energy = 0.0;
        for &body in &region.bodies {
            self.stage.movings[body.index()] = self.flyer(body).moving_at(self.now);
            let flyer = self.flyer(body);
            let position = self.stage.movings[body.index()].pose.position;
            energy -= flyer.law().acceleration.dot(position) / flyer.body().inverse_mass;
        }
        let mut laws = std::mem::take(&mut self.ticks.laws);
        laws.clear();
        laws.extend(region.bodies.iter().flat_map(|&body| self.laws_of(body)));
        laws.sort_unstable();
        laws.dedup();
        let now = super::Snapshot::new(self.now.seconds(), &self.stage.movings);
        let of_laws = laws.iter().filter_map(|&law| self.laws[law].potential(&now)).sum::<f64>();
        self.ticks.laws = laws;
        energy + of_laws
    }
}
