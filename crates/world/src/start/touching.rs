//! Which bodies touch at the start, and how deep they overlap.

use super::{StartParts, StartRules};
use crate::overlap::overlap_depth;
use crate::world::Named;
use crate::world_error::WorldError;
use halfgap_collision::{BodyId, Collision, Moment, Moving, detect_pair};

/// Refuses overlaps deeper than allowed [m].
pub(super) fn require_shallow(
    bodies: &[StartParts],
    named: &[Named],
    pairs: &[(BodyId, BodyId)],
    allowed: f64,
) -> Result<(), WorldError> {
    for &(a, b) in pairs {
        let [(body_a, _, state_a), (body_b, _, state_b)] = [&bodies[a.index()], &bodies[b.index()]];
        let depth = overlap_depth(&body_a.shape, &state_a.pose(), &body_b.shape, &state_b.pose());
        if let Some(depth) = depth.filter(|depth| *depth > allowed) {
            let (first, second) = (named[a.index()].name.clone(), named[b.index()].name.clone());
            return Err(WorldError::Overlap { first, second, depth, allowed });
        }
    }
    Ok(())
}

/// Two bodies that a correction has brought into each other, deeper than rounding [m], and how deep [m]. For each body how far
/// it has been moved.
pub(super) fn deep_overlap(
    bodies: &[StartParts],
    pairs: &[(BodyId, BodyId)],
    rounding: f64,
    ways: &[f64],
) -> Option<([BodyId; 2], f64)> {
    let moved =
        pairs.iter().map(|&(a, b)| [a, b]).filter(|pair| pair.iter().any(|body| ways[body.index()] > 0.0));
    let mut deep = moved.filter_map(|pair| {
        let [(body_a, _, state_a), (body_b, _, state_b)] = pair.map(|body| &bodies[body.index()]);
        let depth = overlap_depth(&body_a.shape, &state_a.pose(), &body_b.shape, &state_b.pose())?;
        (depth > rounding).then_some((pair, depth))
    });
    deep.next()
}

/// Records of all places where bodies touch, overlaps included that are no deeper than they may have been and than bodies have
/// been moved since [m].
pub(super) fn touching(
    bodies: &[StartParts],
    pairs: &[(BodyId, BodyId)],
    rules: &StartRules<'_>,
    ways: &[f64],
) -> Vec<Collision> {
    let moment = |id: BodyId| {
        let (body, _, state) = &bodies[id.index()];
        Moment { id, body, moving: Moving::from(state) }
    };
    let mut records = Vec::new();
    for &(a, b) in pairs {
        let depth = rules.overlap + ways[a.index()] + ways[b.index()];
        detect_pair(&moment(a), &moment(b), rules.tolerances, depth, 0.0, &mut records);
    }
    records
}

/// True for a place where two bodies are nearer than the target zone.
pub(super) fn is_below_zone(record: &Collision) -> bool {
    record.distance_to_target() < -record.tolerances.accuracy
}

pub(super) fn lowest_below_zone(records: &[Collision]) -> Option<&Collision> {
    let by_gap = |p: &&Collision, q: &&Collision| p.distance_to_target().total_cmp(&q.distance_to_target());
    records.iter().filter(|record| is_below_zone(record)).min_by(by_gap)
}
