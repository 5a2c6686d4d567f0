//! The start of a run: gaps that are too small are lifted to the target gap, deeper overlaps are refused.
//!
//! The displacement is the least one, weighted by mass, that lifts every gap below target - accuracy to the target: with
//! the rows J of all touching pairs and b = gap - wanted, the complementarity problem A f + b >= 0, f >= 0 has the
//! displacement M^-1 J^T f. Gaps are curved in the displacement, so this is repeated until they fit.

use crate::overlap::overlap_depth;
use crate::world::Named;
use crate::world_error::WorldError;
use glam::DVec2;
use halfgap_advance::rigid::FlightLaw;
use halfgap_collision::{
    Body, BodyId, BodyState, BroadPhase, Collision, Moment, Moving, Tolerances, detect_pair,
};
use halfgap_contact::{DualActiveSet, Inertia, Problem, Row, Solution, Solver};

/// Rounds of lifting; each leaves an error of second order in the displacement.
const MOST_ROUNDS: u32 = 12;

/// A body, what acts on it in flight, and its state at the start.
pub(crate) type StartParts = (Body, FlightLaw, BodyState);

/// Lifts gaps below the target zone to the target gap; returns the largest displacement [m].
pub(crate) fn lift_overlaps(
    bodies: &mut [StartParts],
    named: &[Named],
    excluded: &[(BodyId, BodyId)],
    tolerances: &Tolerances,
    allowed: f64,
) -> Result<f64, WorldError> {
    let pairs = near_pairs(bodies, excluded, tolerances.distance_tol());
    for &(a, b) in &pairs {
        let depth = overlap_depth(
            &bodies[a.index()].0.shape,
            &pose(bodies, a),
            &bodies[b.index()].0.shape,
            &pose(bodies, b),
        );
        if let Some(depth) = depth.filter(|depth| *depth > allowed) {
            let (first, second) = (named[a.index()].name.clone(), named[b.index()].name.clone());
            return Err(WorldError::Overlap { first, second, depth, allowed });
        }
    }
    let start: Vec<DVec2> = bodies.iter().map(|(_, _, state)| state.position).collect();
    for _ in 0..MOST_ROUNDS {
        let records = touching(bodies, &pairs, tolerances, allowed);
        let Some(worst) = lowest_below_zone(&records) else {
            return Ok(largest_move(bodies, &start));
        };
        if !lift(bodies, &records) {
            return Err(cannot_lift(worst, named));
        }
    }
    match lowest_below_zone(&touching(bodies, &pairs, tolerances, allowed)) {
        Some(worst) => Err(cannot_lift(worst, named)),
        None => Ok(largest_move(bodies, &start)),
    }
}

fn pose(bodies: &[StartParts], body: BodyId) -> halfgap_geometry::Pose {
    bodies[body.index()].2.pose()
}

/// Pairs that may collide and whose boxes come within `skin` [m].
fn near_pairs(bodies: &[StartParts], excluded: &[(BodyId, BodyId)], skin: f64) -> Vec<(BodyId, BodyId)> {
    let mut broad = BroadPhase::new();
    let boxes: Vec<_> =
        bodies.iter().map(|(body, _, state)| body.shape.bounds_at(&state.pose()).grown(skin)).collect();
    let mut pairs = Vec::new();
    for (index, bounds) in boxes.iter().enumerate() {
        let body = BodyId(u32::try_from(index).unwrap_or(u32::MAX));
        broad.visit_overlapping(bounds, &mut |other| {
            let both_fixed = bodies[index].0.is_fixed() && bodies[other.index()].0.is_fixed();
            let passes = excluded.iter().any(|&(a, b)| (a, b) == (other, body) || (a, b) == (body, other));
            if !both_fixed && !passes {
                pairs.push((other, body));
            }
        });
        broad.set(body, *bounds);
    }
    pairs.sort_unstable();
    pairs
}

/// Records of all places where bodies touch, overlaps up to `depth` [m] included.
fn touching(
    bodies: &[StartParts],
    pairs: &[(BodyId, BodyId)],
    tolerances: &Tolerances,
    depth: f64,
) -> Vec<Collision> {
    let moment = |id: BodyId| {
        let (body, _, state) = &bodies[id.index()];
        Moment { id, body, moving: Moving::from(state) }
    };
    let mut records = Vec::new();
    for &(a, b) in pairs {
        detect_pair(&moment(a), &moment(b), tolerances, depth, 0.0, &mut records);
    }
    records
}

fn lowest_below_zone(records: &[Collision]) -> Option<&Collision> {
    let too_near = |record: &&Collision| record.distance_to_target() < -record.tolerances.accuracy;
    let by_gap = |p: &&Collision, q: &&Collision| p.distance_to_target().total_cmp(&q.distance_to_target());
    records.iter().filter(too_near).min_by(by_gap)
}

/// Moves the bodies so that every gap that is too small becomes the target gap; false if that cannot be done.
fn lift(bodies: &mut [StartParts], records: &[Collision]) -> bool {
    let mut problem = Problem::new();
    for (body, _, _) in bodies.iter() {
        let inertia = Inertia { inverse_mass: body.inverse_mass, inverse_moment: body.inverse_moment };
        if problem.add_body(inertia).is_err() {
            return false;
        }
    }
    for record in records {
        let tolerances = &record.tolerances;
        let above = record.distance_to_target();
        // What lies in the zone already may move within it.
        let offset = if above < -tolerances.accuracy { above } else { above + tolerances.accuracy };
        let j = record.motion.kinematics.jacobian;
        let [primary, normal] =
            [record.parties.primary, record.parties.normal].map(|side| halfgap_contact::BodyId(side.body.0));
        let row = Row::new(primary, [j[0], j[1], j[2]], offset).against(normal, [j[3], j[4], j[5]]);
        if problem.add_row(&row).is_err() {
            return false;
        }
    }
    let mut solution = Solution::new();
    if DualActiveSet::default().solve(&problem, &mut solution).is_err() {
        return false;
    }
    for (record, &force) in records.iter().zip(&solution.force) {
        let j = &record.motion.kinematics.jacobian;
        for (side, at) in [(record.parties.primary, 0), (record.parties.normal, 3)] {
            let (body, _, state) = &mut bodies[side.body.index()];
            state.position += DVec2::new(j[at], j[at + 1]) * (body.inverse_mass * force);
            state.angle += j[at + 2] * body.inverse_moment * force;
        }
    }
    true
}

fn largest_move(bodies: &[StartParts], start: &[DVec2]) -> f64 {
    bodies
        .iter()
        .zip(start)
        .map(|((_, _, state), &from)| (state.position - from).length())
        .fold(0.0, f64::max)
}

fn cannot_lift(record: &Collision, named: &[Named]) -> WorldError {
    let name = |side: halfgap_collision::Participant| named[side.body.index()].name.clone();
    WorldError::CannotLift {
        first: name(record.parties.primary),
        second: name(record.parties.normal),
        gap: record.geometry.distance,
    }
}
