//! Corrections at the start of a run: gaps that are too small are lifted to the target gap, connectors that are a
//! little off are put together, and velocities are made to fit the connectors; deeper overlaps and larger errors are
//! refused.
//!
//! The displacement is the least one, weighted by mass, that lifts every gap below target - accuracy to the target and
//! closes the gaps of all connectors: with rows J and b = gap - wanted, the complementarity problem A f + b >= 0, f >=
//! 0 (connectors: A f + b = 0) has the displacement M^-1 J^T f. Gaps are curved in the displacement, so this is
//! repeated until they fit, in steps along which they are not curved by much. `tight` lists the pairs that cannot be
//! lifted: they keep their gap, and all others are lifted from their given positions. `regain` brings back gaps that
//! the least displacement carries beyond their target: the result is the least displacement that puts all lifted gaps
//! at their target. `touching` finds the places where bodies touch, `joined` the rows of connectors, `correction`
//! solves for displacements and for velocities.

mod correction;
mod joined;
mod regain;
mod tight;
mod touching;

use crate::builder::Joints;
use crate::near::NearPairs;
use crate::world::Named;
use crate::world_error::{ConnectorName, WorldError};
use correction::{correct_positions, correct_velocities};
use halfgap_advance::rigid::BodyPart;
use halfgap_collision::{BodyId, BodyState, Collision, Moving, Tolerances};
use joined::{ConnectorOff, require_small_errors, worst_connector};
use regain::regain_touches;
use tight::TightPairs;
use touching::{
    KnownTouches, Touch, deep_overlap, is_below_zone, lowest_below_zone, require_shallow, touch, touching,
};

/// Largest number of full rounds of correction; each leaves an error of second order in the displacement.
const MOST_ROUNDS: u32 = 12;
/// Largest number of further rounds that go only a fraction of the way, lest bodies turn by too much.
const MOST_SHORT_ROUNDS: u32 = 100;
/// Fraction of the connectors' error that a full round must at least remove; else the error counts as irreducible.
const LEAST_GAIN: f64 = 0.5;
/// Longest way of a body, as a multiple of the sum of what all gaps lack. A body that goes farther has been carried
/// past the end of a face: to first order faces have no ends.
const FARTHEST: f64 = 10.0;
/// Longest way of a body, as a fraction of its reach, if that is more.
const FARTHEST_OF_REACH: f64 = 0.1;

/// Errors accepted at the start, and thresholds that the correction is to reach.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StartRules<'a> {
    pub(crate) tolerances: &'a Tolerances,
    /// Pairs that pass through each other.
    pub(crate) excluded: &'a [(BodyId, BodyId)],
    /// Whether bodies collide at all.
    pub(crate) collisions: bool,
    /// Largest overlap accepted [m].
    pub(crate) overlap: f64,
    /// Largest connector error accepted [m].
    pub(crate) connector_error: f64,
    /// Largest error that may be left in connectors that contradict each other [m].
    pub(crate) contradiction: f64,
    /// Errors of connectors and overlaps that are rounding [m].
    pub(crate) rounding: f64,
}

impl StartRules<'_> {
    /// Returns the pairs of bodies near enough to touch.
    fn near_pairs<'a>(&self, near: &'a mut NearPairs, bodies: &[BodyPart]) -> &'a [(BodyId, BodyId)] {
        if !self.collisions {
            return &[];
        }
        let skin = self.tolerances.distance_tol();
        let boxes = bodies.iter().map(|BodyPart { body, state, .. }| {
            (body.shape.bounds_at(&state.pose()).grown(skin), body.is_fixed())
        });
        near.find(boxes, self.excluded)
    }
}

/// Result of the correction at the start.
#[derive(Debug)]
pub(crate) struct Corrected {
    /// Largest displacement [m].
    pub(crate) displacement: f64,
    /// The connector that came apart fastest by the velocities given, and how fast [m/s].
    pub(crate) apart: Option<(ConnectorName, f64)>,
}

/// Corrects positions and velocities at the start.
pub(crate) fn correct_start(
    bodies: &mut [BodyPart],
    named: &[Named],
    connectors: &Joints,
    rules: &StartRules<'_>,
) -> Result<Corrected, WorldError> {
    let mut near = NearPairs::default();
    let pairs = rules.near_pairs(&mut near, bodies);
    require_shallow(bodies, named, pairs, rules.overlap)?;
    require_small_errors(bodies, named, connectors, rules.connector_error)?;
    let given: Vec<BodyState> = bodies.iter().map(|part| part.state).collect();
    let mut tight = TightPairs::default();
    let (mut rounds, mut known) = (Rounds::default(), KnownTouches::default());
    let mut lifted: Vec<Touch> = Vec::new();
    let mut farthest = f64::INFINITY;
    loop {
        // Bodies that have been moved may have come near others, and deeper into them.
        let pairs = rules.near_pairs(&mut near, bodies);
        let ways = ways(bodies, &given);
        let mut records = touching(bodies, pairs, rules, &ways);
        records.retain(|record| !tight.keeps(record) || record.gap_state().is_illegal(rules.rounding));
        let (too_near, off) = (lowest_below_zone(&records), worst_connector(bodies, connectors));
        let error = off.map_or(0.0, |off| off.error);
        if rounds.are_at_first() {
            lifted.clear();
            lifted.extend(records.iter().filter(|record| is_below_zone(record)).filter_map(touch));
            // Errors of connectors may be at the end of a long lever, and move bodies far.
            farthest = if error > rules.rounding { f64::INFINITY } else { FARTHEST * all_lacking(&records) };
        }
        let is_done = too_near.is_none() && fits(error, rounds.have_stalled(error), rules);
        let overlap = if is_done { deep_overlap(bodies, pairs, rules.rounding, &ways) } else { None };
        if is_done && overlap.is_none() {
            break;
        }
        let goes_on = !is_done && rounds.are_left();
        let may_stay = too_near.is_none() && error <= rules.contradiction;
        let failure = cannot_correct(too_near, overlap, off, named, connectors);
        if goes_on {
            known.complete(&mut records, bodies, rules);
            let share = correct_positions(bodies, &records, connectors);
            if let Some(share) = share.filter(|_| are_near(bodies, &given, farthest)) {
                rounds.note(share, error);
                continue;
            }
            // Connectors that contradict each other by no more than this are as near together as they come.
            if may_stay && deep_overlap(bodies, pairs, rules.rounding, &ways).is_none() {
                break;
            }
        }
        // The result is of no use: start anew from the given positions, without the pairs that cannot be lifted.
        bodies.iter_mut().zip(&given).for_each(|(part, given)| part.state = *given);
        if !widen(&mut tight, bodies, connectors, (rules, &mut near)) {
            return Err(failure);
        }
        rounds = Rounds::default();
        known.clear();
    }
    regain_touches(bodies, (&lifted, &given), connectors, (rules, &mut near));
    let apart = correct_velocities(bodies, named, connectors, rules.tolerances)?;
    let moves = bodies.iter().zip(&given).map(|(part, given)| part.state.position.distance(given.position));
    Ok(Corrected { displacement: moves.fold(0.0, f64::max), apart })
}

/// The rounds of a correction so far.
#[derive(Clone, Copy, Debug, Default)]
struct Rounds {
    /// Number of full rounds.
    full: u32,
    /// Number of rounds that went only a fraction of the way.
    short: u32,
    /// The connectors' error [m] before the last round, if that was a full one.
    before: Option<f64>,
}

impl Rounds {
    fn are_at_first(&self) -> bool {
        self.full == 0 && self.short == 0
    }

    fn are_left(&self) -> bool {
        self.full < MOST_ROUNDS && self.short < MOST_SHORT_ROUNDS
    }

    /// Notes a round that went a fraction of the way, and the connectors' error [m] before it.
    fn note(&mut self, share: f64, error: f64) {
        let is_full = share == 1.0;
        *(if is_full { &mut self.full } else { &mut self.short }) += 1;
        self.before = is_full.then_some(error);
    }

    /// True if the last round has not made the connectors' error [m] much less.
    fn have_stalled(&self, error: f64) -> bool {
        self.before.is_some_and(|before| error > LEAST_GAIN * before)
    }
}

/// Lets pairs that are too near at the given positions keep their gaps; returns false if there are none left that can.
fn widen(
    tight: &mut TightPairs,
    bodies: &[BodyPart],
    connectors: &Joints,
    (rules, near): (&StartRules<'_>, &mut NearPairs),
) -> bool {
    let pairs = rules.near_pairs(near, bodies);
    let mut records = touching(bodies, pairs, rules, &vec![0.0; bodies.len()]);
    let is_near =
        |record: &Collision| is_below_zone(record) && !record.gap_state().is_illegal(rules.rounding);
    records.retain(|record| is_near(record) && !tight.keeps(record));
    tight.widen(bodies, connectors, &records)
}

/// True if the connectors are together: to rounding, or, where rounds gain nothing more, within the contradiction
/// allowed.
fn fits(error: f64, has_stalled: bool, rules: &StartRules<'_>) -> bool {
    error <= rules.rounding || (has_stalled && error <= rules.contradiction)
}

/// Sum of the distances to the target gap of all gaps below the zone [m].
fn all_lacking(records: &[Collision]) -> f64 {
    let gaps = records.iter().filter(|record| is_below_zone(record));
    gaps.map(|record| record.distance_to_target().abs()).sum()
}

/// True if no body has gone farther than `farthest` [m], or than a fraction of its reach if that is more.
fn are_near(bodies: &[BodyPart], given: &[BodyState], farthest: f64) -> bool {
    let is_near = |reach: f64, way: f64| way <= farthest.max(FARTHEST_OF_REACH * reach);
    bodies.iter().zip(ways(bodies, given)).all(|(part, way)| is_near(part.body.shape.reach(), way))
}

/// Upper bounds of the distance [m] that the points of each body have moved.
fn ways(bodies: &[BodyPart], given: &[BodyState]) -> Vec<f64> {
    let way = |(BodyPart { body, state, .. }, given): (&BodyPart, &BodyState)| {
        state.position.distance(given.position) + (state.angle - given.angle).abs() * body.shape.reach()
    };
    bodies.iter().zip(given).map(way).collect()
}

fn moving(bodies: &[BodyPart], body: BodyId) -> Moving {
    if body.is_world() { Moving::BACKGROUND } else { Moving::from(&bodies[body.index()].state) }
}

/// Returns the error of a failed correction: an overlap that it caused, else the smallest gap if one is too small, else
/// the connector with the largest error.
fn cannot_correct(
    too_near: Option<&Collision>,
    overlap: Option<([BodyId; 2], f64)>,
    off: Option<ConnectorOff>,
    named: &[Named],
    connectors: &Joints,
) -> WorldError {
    let of_gap = |record: &Collision| (record.bodies(), record.geometry.distance);
    let gap = overlap.map(|(bodies, depth)| (bodies, -depth)).or(too_near.map(of_gap));
    match (gap, off) {
        (None, Some(off)) => {
            WorldError::CannotConnect { connector: off.name(named, connectors), error: off.error }
        }
        (gap, _) => {
            let name =
                |body: BodyId| named.get(body.index()).map_or_else(String::new, |one| one.name.clone());
            let (bodies, gap) = gap.unwrap_or(([BodyId::WORLD; 2], 0.0));
            let [first, second] = bodies.map(name);
            WorldError::CannotLift { first, second, gap }
        }
    }
}
