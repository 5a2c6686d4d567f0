//! The start of a run: gaps that are too small are lifted to the target gap, connectors that are a little off are put
//! together, and velocities are made to fit the connectors; deeper overlaps and larger errors are refused.
//!
//! The displacement is the least one, weighted by mass, that lifts every gap below target - accuracy to the
//! target and closes the gaps of all connectors: with rows J and b = gap - wanted, the complementarity
//! problem A f + b >= 0, f >= 0 (connectors: A f + b = 0) has the displacement M^-1 J^T f. Gaps are curved in
//! the displacement, so this is repeated until they fit, by steps along which they are not curved by much.
//! `tight` knows the pairs for which that cannot be: they keep their gap, and all others are lifted from
//! where they were given. What the least displacement carries beyond its target, `regain` brings back: then it
//! is the least that puts all that was lifted at its target. `touching` finds the places where bodies touch,
//! `joined` the rows of connectors, `correction` solves for displacements and for velocities.

mod correction;
mod joined;
mod regain;
mod tight;
mod touching;

use crate::near::NearPairs;
use crate::world::Named;
use crate::world_error::{ConnectorName, WorldError};
use correction::{correct_positions, correct_velocities};
use halfgap_advance::rigid::FlightLaw;
use halfgap_collision::{Body, BodyId, BodyState, Collision, Connector, Moving, Tolerances};
use joined::{ConnectorOff, require_small_errors, worst_connector};
use regain::regain_touches;
use tight::TightPairs;
use touching::{
    KnownTouches, Touch, deep_overlap, is_below_zone, lowest_below_zone, require_shallow, touch, touching,
};

/// Rounds of correction that go all the way; each leaves an error of second order in the displacement.
const MOST_ROUNDS: u32 = 12;
/// Rounds beside these that go a part of the way, lest bodies turn by too much.
const MOST_SHORT_ROUNDS: u32 = 100;
/// A round all the way that leaves more than this part of the connectors' error has come to the end of what can be had.
const LEAST_GAIN: f64 = 0.5;
/// What carries a body farther than so many times all that gaps lack, and than this part of its reach, has left where it
/// was to be: to first order faces have no ends, and it has passed one.
const FARTHEST: f64 = 10.0;
const FARTHEST_OF_REACH: f64 = 0.1;

/// A body, what acts on it in flight, and its state at the start.
pub(crate) type StartParts = (Body, FlightLaw, BodyState);

/// What is allowed, and what is to be reached.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StartRules<'a> {
    pub(crate) tolerances: &'a Tolerances,
    /// Pairs that pass through each other.
    pub(crate) excluded: &'a [(BodyId, BodyId)],
    /// Bodies collide at all.
    pub(crate) collisions: bool,
    /// How deep bodies may overlap [m].
    pub(crate) overlap: f64,
    /// How far off connectors may be [m].
    pub(crate) connector_error: f64,
    /// How far off they may be left where they contradict each other [m].
    pub(crate) contradiction: f64,
    /// How far off they are for rounding [m].
    pub(crate) rounding: f64,
}

impl StartRules<'_> {
    /// Pairs of bodies that are so near each other that they may touch.
    fn near_pairs<'a>(&self, near: &'a mut NearPairs, bodies: &[StartParts]) -> &'a [(BodyId, BodyId)] {
        if !self.collisions {
            return &[];
        }
        let skin = self.tolerances.distance_tol();
        let boxes = bodies
            .iter()
            .map(|(body, _, state)| (body.shape.bounds_at(&state.pose()).grown(skin), body.is_fixed()));
        near.find(boxes, self.excluded)
    }
}

/// What was corrected at the start.
#[derive(Debug)]
pub(crate) struct Corrected {
    /// Largest displacement [m].
    pub(crate) displacement: f64,
    /// The connector that came apart fastest by the velocities given, and how fast [m/s].
    pub(crate) apart: Option<(ConnectorName, f64)>,
}

/// Corrects positions and velocities at the start.
pub(crate) fn correct_start(
    bodies: &mut [StartParts],
    named: &[Named],
    connectors: &[Connector],
    rules: &StartRules<'_>,
) -> Result<Corrected, WorldError> {
    let mut near = NearPairs::default();
    let pairs = rules.near_pairs(&mut near, bodies);
    require_shallow(bodies, named, pairs, rules.overlap)?;
    require_small_errors(bodies, named, connectors, rules.connector_error)?;
    let given: Vec<BodyState> = bodies.iter().map(|(_, _, state)| *state).collect();
    let mut tight = TightPairs::default();
    let (mut rounds, mut known) = (Rounds::default(), KnownTouches::default());
    let mut lifted: Vec<Touch> = Vec::new();
    let mut farthest = f64::INFINITY;
    loop {
        // What has been moved may have come near others, and deeper into them.
        let pairs = rules.near_pairs(&mut near, bodies);
        let ways = ways(bodies, &given);
        let mut records = touching(bodies, pairs, rules, &ways);
        records.retain(|record| !tight.keeps(record) || record.geometry.distance < -rules.rounding);
        let (too_near, off) = (lowest_below_zone(&records), worst_connector(bodies, connectors));
        let error = off.map_or(0.0, |off| off.error);
        if rounds.are_at_first() {
            lifted.clear();
            lifted.extend(records.iter().filter(|record| is_below_zone(record)).filter_map(touch));
            // What connectors lack may be at the end of a long lever.
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
            // Connectors that contradict each other by so little are as near together as they come.
            if may_stay && deep_overlap(bodies, pairs, rules.rounding, &ways).is_none() {
                break;
            }
        }
        // Where it has led is of no use: what can be lifted is lifted anew, without what cannot.
        bodies.iter_mut().zip(&given).for_each(|((_, _, state), given)| *state = *given);
        if !widen(&mut tight, bodies, connectors, (rules, &mut near)) {
            return Err(failure);
        }
        rounds = Rounds::default();
        known.clear();
    }
    regain_touches(bodies, (&lifted, &given), connectors, (rules, &mut near));
    let apart = correct_velocities(bodies, named, connectors, rules.tolerances)?;
    let moves =
        bodies.iter().zip(&given).map(|((_, _, state), given)| state.position.distance(given.position));
    Ok(Corrected { displacement: moves.fold(0.0, f64::max), apart })
}

/// The rounds of a correction so far.
#[derive(Clone, Copy, Debug, Default)]
struct Rounds {
    /// All the way, and a part of it.
    full: u32,
    short: u32,
    /// The connectors' error [m] before the last round, if that went all the way.
    before: Option<f64>,
}

impl Rounds {
    fn are_at_first(&self) -> bool {
        self.full == 0 && self.short == 0
    }

    fn are_left(&self) -> bool {
        self.full < MOST_ROUNDS && self.short < MOST_SHORT_ROUNDS
    }

    /// Notes a round that went so large a part of the way, from an error of the connectors [m].
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

/// Lets the pairs that are too near where the bodies were given keep their gaps; false if none is left that can.
fn widen(
    tight: &mut TightPairs,
    bodies: &[StartParts],
    connectors: &[Connector],
    (rules, near): (&StartRules<'_>, &mut NearPairs),
) -> bool {
    let pairs = rules.near_pairs(near, bodies);
    let mut records = touching(bodies, pairs, rules, &vec![0.0; bodies.len()]);
    let is_near = |record: &Collision| is_below_zone(record) && record.geometry.distance >= -rules.rounding;
    records.retain(|record| is_near(record) && !tight.keeps(record));
    tight.widen(bodies, connectors, &records)
}

/// True if the connectors are together: to rounding, or as near as they come if that is near enough.
fn fits(error: f64, has_stalled: bool, rules: &StartRules<'_>) -> bool {
    error <= rules.rounding || (has_stalled && error <= rules.contradiction)
}

/// Sum [m] of all that gaps below the zone lack.
fn all_lacking(records: &[Collision]) -> f64 {
    let gaps = records.iter().filter(|record| is_below_zone(record));
    gaps.map(|record| record.distance_to_target().abs()).sum()
}

/// True if no body has gone farther than so far [m], or than a part of its reach.
fn are_near(bodies: &[StartParts], given: &[BodyState], farthest: f64) -> bool {
    let is_near = |reach: f64, way: f64| way <= farthest.max(FARTHEST_OF_REACH * reach);
    bodies.iter().zip(ways(bodies, given)).all(|((body, _, _), way)| is_near(body.shape.reach(), way))
}

/// How far [m] points of each body have moved at most.
fn ways(bodies: &[StartParts], given: &[BodyState]) -> Vec<f64> {
    let way = |((body, _, state), given): (&StartParts, &BodyState)| {
        state.position.distance(given.position) + (state.angle - given.angle).abs() * body.shape.reach()
    };
    bodies.iter().zip(given).map(way).collect()
}

fn moving(bodies: &[StartParts], body: BodyId) -> Moving {
    if body.is_world() { Moving::BACKGROUND } else { Moving::from(&bodies[body.index()].2) }
}

/// What is to blame: an overlap that comes of the correction, else a gap if one is too small, else the
/// connector that is off most.
fn cannot_correct(
    too_near: Option<&Collision>,
    overlap: Option<([BodyId; 2], f64)>,
    off: Option<ConnectorOff>,
    named: &[Named],
    connectors: &[Connector],
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
