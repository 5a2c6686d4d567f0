//! The start of a run: gaps that are too small are lifted to the target gap, connectors that are a little off are put
//! together, and velocities are made to fit the connectors; deeper overlaps and larger errors are refused.
//!
//! The displacement is the least one, weighted by mass, that lifts every gap below target - accuracy to the target and
//! closes the gaps of all connectors: with rows J and b = gap - wanted, the complementarity problem A f + b >= 0, f >= 0
//! (connectors: A f + b = 0) has the displacement M^-1 J^T f. Gaps are curved in the displacement, so this is repeated
//! until they fit. `tight` knows the pairs for which that cannot be: they keep their gap. `touching` finds the places where bodies touch, `joined` the rows of connectors, `correction` solves
//! for displacements and for velocities.

mod correction;
mod joined;
mod tight;
mod touching;

use crate::near::NearPairs;
use crate::world::Named;
use crate::world_error::{ConnectorName, WorldError};
use correction::{correct_positions, correct_velocities};
use glam::DVec2;
use halfgap_advance::rigid::FlightLaw;
use halfgap_collision::{Body, BodyId, BodyState, Collision, Connector, Moving, Tolerances};
use joined::{ConnectorOff, require_small_errors, worst_connector};
use tight::TightPairs;
use touching::{is_below_zone, lowest_below_zone, require_shallow, touching};

/// Rounds of correction; each leaves an error of second order in the displacement.
const MOST_ROUNDS: u32 = 12;
/// A round that leaves more than this part of the connectors' error has come to the end of what can be had.
const LEAST_GAIN: f64 = 0.5;

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
    /// How far off they are for rounding [m].
    pub(crate) rounding: f64,
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
    let pairs = if rules.collisions {
        let skin = rules.tolerances.distance_tol();
        let boxes = bodies
            .iter()
            .map(|(body, _, state)| (body.shape.bounds_at(&state.pose()).grown(skin), body.is_fixed()));
        NearPairs::default().find(boxes, rules.excluded).to_vec()
    } else {
        Vec::new()
    };
    require_shallow(bodies, named, &pairs, rules.overlap)?;
    require_small_errors(bodies, named, connectors, rules.connector_error)?;
    let given: Vec<DVec2> = bodies.iter().map(|(_, _, state)| state.position).collect();
    let mut last_error = f64::INFINITY;
    let mut tight = TightPairs::default();
    let mut round = 0;
    loop {
        let mut records = touching(bodies, &pairs, rules.tolerances, rules.overlap);
        records.retain(|record| !tight.keeps(record) || record.geometry.distance < -rules.rounding);
        let (too_near, off) = (lowest_below_zone(&records), worst_connector(bodies, connectors));
        let error = off.map_or(0.0, |off| off.error);
        let has_stalled = error > LEAST_GAIN * last_error;
        if too_near.is_none() && fits(error, has_stalled, rules) {
            break;
        }
        let is_stuck = round == MOST_ROUNDS || !correct_positions(bodies, &records, connectors);
        round += 1;
        if is_stuck {
            let is_near =
                |record: &&Collision| is_below_zone(record) && record.geometry.distance >= -rules.rounding;
            let near: Vec<_> = records.iter().filter(is_near).collect();
            if !tight.widen(bodies, connectors, &near) {
                return Err(cannot_correct(too_near, off, named, connectors));
            }
            round = 0;
        }
        last_error = error;
    }
    let apart = correct_velocities(bodies, named, connectors)?;
    Ok(Corrected { displacement: largest_move(bodies, &given), apart })
}

/// True if the connectors are together: to rounding, or as near as they come if that is near enough.
fn fits(error: f64, has_stalled: bool, rules: &StartRules<'_>) -> bool {
    error <= rules.rounding || (has_stalled && error <= rules.tolerances.accuracy)
}

fn moving(bodies: &[StartParts], body: BodyId) -> Moving {
    if body.is_world() { Moving::BACKGROUND } else { Moving::from(&bodies[body.index()].2) }
}

fn largest_move(bodies: &[StartParts], given: &[DVec2]) -> f64 {
    let move_of = |((_, _, state), &from): (&StartParts, &DVec2)| (state.position - from).length();
    bodies.iter().zip(given).map(move_of).fold(0.0, f64::max)
}

/// What is to blame: a gap if one is too small, else the connector that is off most.
fn cannot_correct(
    too_near: Option<&Collision>,
    off: Option<ConnectorOff>,
    named: &[Named],
    connectors: &[Connector],
) -> WorldError {
    let blamed = off.map(|off| off.name(named, connectors));
    match (too_near, blamed, off) {
        (None, Some(connector), Some(off)) => WorldError::CannotConnect { connector, error: off.error },
        (too_near, ..) => {
            let name = |body: fn(&Collision) -> BodyId| {
                too_near.map_or_else(String::new, |record| named[body(record).index()].name.clone())
            };
            WorldError::CannotLift {
                first: name(|record| record.parties.primary.body),
                second: name(|record| record.parties.normal.body),
                gap: too_near.map_or(0.0, |record| record.geometry.distance),
            }
        }
    }
}
