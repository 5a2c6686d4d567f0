//! Which bodies touch at the start, and how deep they overlap.

use super::StartParts;
use crate::overlap::overlap_depth;
use crate::world::Named;
use crate::world_error::WorldError;
use halfgap_collision::{BodyId, Collision, Moment, Moving, Tolerances, detect_pair};

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

/// Records of all places where bodies touch, overlaps up to `depth` [m] included.
pub(super) fn touching(
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

/// True for a place where two bodies are nearer than the target zone.
pub(super) fn is_below_zone(record: &Collision) -> bool {
    record.distance_to_target() < -record.tolerances.accuracy
}

pub(super) fn lowest_below_zone(records: &[Collision]) -> Option<&Collision> {
    let by_gap = |p: &&Collision, q: &&Collision| p.distance_to_target().total_cmp(&q.distance_to_target());
    records.iter().filter(|record| is_below_zone(record)).min_by(by_gap)
}
