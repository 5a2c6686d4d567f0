//! Contacts of bodies at the start, and the depths of their overlaps.

use super::StartRules;
use crate::overlap::overlap_depth;
use crate::world::Named;
use crate::world_error::WorldError;
use halfgap_advance::rigid::BodyPart;
use halfgap_collision::{BodyId, Collision, Moment, Moving, detect_pair, record_features};
use halfgap_geometry::FeatureId;

/// Refuses the first overlap deeper than allowed [m].
pub(super) fn require_shallow(
    bodies: &[BodyPart],
    named: &[Named],
    pairs: &[(BodyId, BodyId)],
    allowed: f64,
) -> Result<(), WorldError> {
    for &(a, b) in pairs {
        let depth = depth_between([a, b].map(|body| &bodies[body.index()]));
        if let Some(depth) = depth.filter(|depth| *depth > allowed) {
            let (first, second) = (named[a.index()].name.clone(), named[b.index()].name.clone());
            return Err(WorldError::Overlap { first, second, depth, allowed });
        }
    }
    Ok(())
}

/// Returns two bodies that a correction has moved into each other by more than rounding [m], and the depth [m]. `ways`
/// holds the distance that each body has been moved.
pub(super) fn deep_overlap(
    bodies: &[BodyPart],
    pairs: &[(BodyId, BodyId)],
    rounding: f64,
    ways: &[f64],
) -> Option<([BodyId; 2], f64)> {
    let moved =
        pairs.iter().map(|&(a, b)| [a, b]).filter(|pair| pair.iter().any(|body| ways[body.index()] > 0.0));
    let mut deep = moved.filter_map(|pair| {
        let depth = depth_between(pair.map(|body| &bodies[body.index()]))?;
        (depth > rounding).then_some((pair, depth))
    });
    deep.next()
}

/// Depth [m] of the overlap of two bodies in their states, as by [`overlap_depth`]; `None` if they are apart.
fn depth_between([a, b]: [&BodyPart; 2]) -> Option<f64> {
    overlap_depth(&a.body.shape, &a.state.pose(), &b.body.shape, &b.state.pose())
}

/// Returns records of all places where bodies touch, including overlaps no deeper than the overlap accepted at the
/// start plus the `ways` [m] that both bodies have been moved since.
pub(super) fn touching(
    bodies: &[BodyPart],
    pairs: &[(BodyId, BodyId)],
    rules: &StartRules<'_>,
    ways: &[f64],
) -> Vec<Collision> {
    let mut records = Vec::new();
    for &(a, b) in pairs {
        let depth = rules.overlap + ways[a.index()] + ways[b.index()];
        detect_pair(&moment(bodies, a), &moment(bodies, b), rules.tolerances, depth, 0.0, &mut records);
    }
    records
}

fn moment(bodies: &[BodyPart], id: BodyId) -> Moment<'_> {
    let BodyPart { body, state, .. } = &bodies[id.index()];
    Moment { id, body, moving: Moving::from(state) }
}

/// Two features that touched in some round of a correction, the lesser body's first.
pub(super) type Touch = ([BodyId; 2], [FeatureId; 2]);

/// Returns the record of a known place at the present positions of the bodies.
pub(super) fn record_of(
    bodies: &[BodyPart],
    ([a, b], features): Touch,
    rules: &StartRules<'_>,
) -> Option<Collision> {
    record_features([&moment(bodies, a), &moment(bodies, b)], features, rules.tolerances, 0.0)
}

/// Features that touched in the rounds of a correction so far. A body lifted at one corner comes down on another: if
/// the first were forgotten, the next round would lower it again as far as it lifts the second, and so on.
#[derive(Clone, Debug, Default)]
pub(super) struct KnownTouches(Vec<Touch>);

impl KnownTouches {
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Adds to the records of a round those of features that touched before and are farther apart by now, and remembers
    /// all.
    pub(super) fn complete(
        &mut self,
        records: &mut Vec<Collision>,
        bodies: &[BodyPart],
        rules: &StartRules<'_>,
    ) {
        let mut present: Vec<Touch> = records.iter().filter_map(touch).collect();
        for &known in self.0.iter().filter(|known| !present.contains(known)) {
            records.extend(record_of(bodies, known, rules));
        }
        present.retain(|touch| !self.0.contains(touch));
        self.0.append(&mut present);
    }
}

/// Returns the features of a record; `None` for a connector.
pub(super) fn touch(record: &Collision) -> Option<Touch> {
    let mut sides = [&record.parties.primary, &record.parties.normal];
    sides.sort_by_key(|side| side.body);
    let [a, b] = sides;
    Some(([a.body, b.body], [a.feature()?, b.feature()?]))
}

/// True for a place where two bodies are nearer than the target zone.
pub(super) fn is_below_zone(record: &Collision) -> bool {
    record.distance_to_target() < -record.tolerances.accuracy
}

pub(super) fn lowest_below_zone(records: &[Collision]) -> Option<&Collision> {
    let by_gap = |p: &&Collision, q: &&Collision| p.distance_to_target().total_cmp(&q.distance_to_target());
    records.iter().filter(|record| is_below_zone(record)).min_by(by_gap)
}
